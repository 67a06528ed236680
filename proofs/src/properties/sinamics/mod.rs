//! Monitors of SINAMICS S120: the step functions under test, and properties over several steps, one file per topic.

pub mod braking;

stillpoint_monitors::sinamics_monitors! { subject }
