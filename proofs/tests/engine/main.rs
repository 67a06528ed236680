//! What the proofs rest on: the engine that tries every choice, what it tries for a number, and what is read of an answer of Kani.

mod enumeration;
mod log;
mod sources;
mod total;
mod tries;
