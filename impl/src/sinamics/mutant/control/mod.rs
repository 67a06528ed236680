//! Wrong monitors of the control part.

mod inputs;
mod service;
mod stops;

pub use inputs::*;
pub use service::*;
pub use stops::*;
