//! Monitors of HEIDENHAIN Functional Safety: the step functions under test, their contracts, and properties over several steps, one
//! file per topic.

monitors! { heidenhain:
    /// Take-over from the safe PLC.
    gate
    /// Requests of both channels.
    both_channels
}
