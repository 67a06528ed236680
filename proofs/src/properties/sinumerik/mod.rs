//! Monitors of the SINUMERIK 840D: the step functions under test, and properties over several steps, one file
//! per topic.

pub mod axis;
pub mod checking;
pub mod fault;
pub mod initial;
pub mod profisafe;
pub mod selection;
pub mod stop;
pub mod units;
pub mod watching;

stillpoint_monitors::sinumerik_monitors! { subject }
