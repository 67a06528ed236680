//! Deliberately wrong step functions: see [`crate::mutant`].

mod axis;
mod checking;
mod composing;
mod pair;
mod spl;
mod profisafe;
mod service;
mod stops;
mod watching;

pub use axis::*;
pub use checking::*;
pub use composing::*;
pub use pair::*;
pub use spl::*;
pub use profisafe::*;
pub use service::*;
pub use stops::*;
pub use watching::*;

sinumerik_monitors! { list_mutants pair }
