//! Monitors of SINAMICS S120: the step functions under test, and properties over several steps and of its telegrams, one file per topic.

pub mod braking;
pub mod limits;
pub mod telegram;

stillpoint_monitors::sinamics_monitors! { subject }
