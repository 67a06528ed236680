//! Deliberately wrong step functions: see [`crate::mutant`].

mod brakes;
mod braking;
mod encoders;
mod endzone;
mod functions;
mod load;
mod range;

pub use brakes::*;
pub use braking::*;
pub use encoders::*;
pub use endzone::*;
pub use functions::*;
pub use load::*;
pub use range::*;

srm_monitors! { list_mutants }
