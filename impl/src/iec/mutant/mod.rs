//! Deliberately wrong step functions: see [`crate::mutant`].

mod places;
mod temperature;
mod values;

pub use places::*;
pub use temperature::*;
pub use values::*;

iec_monitors! { list_mutants }
