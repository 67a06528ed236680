//! Monitors of SINAMICS S120: the step functions under test, and properties of its telegrams.

pub mod telegram;

stillpoint_monitors::sinamics_monitors! { subject }
