//! Deliberately wrong step functions: see [`crate::mutant`].

mod axis;
mod checking;
mod composing;
mod pair;
mod profisafe;
mod service;
mod spl;
mod stops;
mod watching;

pub use axis::*;
pub use checking::*;
pub use composing::*;
pub use pair::*;
pub use profisafe::*;
pub use service::*;
pub use spl::*;
pub use stops::*;
pub use watching::*;

sinumerik_monitors! { list_mutants pair }
