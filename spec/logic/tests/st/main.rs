//! Programs in Structured Text as tables: blocks against the definitions of the standard, statements against cases worked by hand,
//! and what is refused.

mod blocks;
#[path = "../common/mod.rs"]
mod common;
mod refused;
mod rig;
mod statements;
