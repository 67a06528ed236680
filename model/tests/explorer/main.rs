//! The explorer, tested. One binary: what the tests share, and the explorer for it, is compiled once.

mod common;

mod aiger;
mod checkpoint;
mod cycles;
#[cfg(feature = "distributed")]
mod distributed;
mod faults;
mod known;
mod larger;
mod limits;
mod liveness;
mod parts;
mod proof;
mod random;
mod recoverable;
mod scale;
mod states;
mod twin;
