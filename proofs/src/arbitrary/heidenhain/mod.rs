//! Monitors of HEIDENHAIN Functional Safety.

mod composing;
mod groups;
mod interface;
mod link;
mod machine;
mod safe_plc;
mod service;
mod watching;

pub use composing::*;
pub use groups::*;
pub use interface::*;
pub use link::*;
pub use machine::*;
pub use safe_plc::*;
pub use service::*;
pub use watching::*;

use stillpoint_monitors::heidenhain::types::Kind;

use crate::source::Source;

/// Any kind of group.
pub fn kind<S: Source>(source: &mut S) -> Kind {
    source.any_of(&Kind::ALL)
}
