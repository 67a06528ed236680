//! Deliberately wrong step functions: see [`crate::mutant`].

mod control;

pub use control::*;

sinamics_monitors! { list_mutants }
