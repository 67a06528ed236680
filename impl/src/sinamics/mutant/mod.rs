//! Deliberately wrong step functions: see [`crate::mutant`].

mod brakes;
mod control;
mod encoder;
mod limits;
mod stops;
mod testing;

pub use brakes::*;
pub use control::*;
pub use encoder::*;
pub use limits::*;
pub use stops::*;
pub use testing::*;

sinamics_monitors! { list_mutants }
