//! Monitors of HEIDENHAIN Functional Safety: the step functions under test, and properties over several steps, one
//! file per topic.

pub mod units;
pub mod watching;

stillpoint_monitors::heidenhain_monitors! { subject }
