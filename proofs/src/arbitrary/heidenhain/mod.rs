//! Monitors of HEIDENHAIN Functional Safety.

mod composing;
mod safe_plc;
mod watching;

pub use composing::*;
pub use safe_plc::*;
pub use watching::*;
