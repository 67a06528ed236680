//! Deliberately wrong step functions: see [`crate::mutant`].

mod composing;
mod groups;
mod interface;
mod link;
mod machine;
mod safe_plc;
mod service;
mod stops;
mod testing;
mod watching;

pub use composing::*;
pub use groups::*;
pub use interface::*;
pub use link::*;
pub use machine::*;
pub use safe_plc::*;
pub use service::*;
pub use stops::*;
pub use testing::*;
pub use watching::*;

heidenhain_monitors! { list_mutants }
