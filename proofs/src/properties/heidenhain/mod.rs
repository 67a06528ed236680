//! Monitors of HEIDENHAIN Functional Safety: the step functions under test, their contracts, and properties over several steps, one
//! file per topic.

monitors! { heidenhain:
    /// Take-over from the safe PLC.
    gate
    /// Requests of both channels.
    both_channels
    /// Stop reaction.
    stop
    /// Requests, operating mode and permissive.
    judge
    /// Monitoring state.
    group
    /// Start-up protection.
    startup
    /// Feed enable of an axis.
    axis_release
    /// Safe operating mode.
    som
    /// Permissive.
    button
    /// Control voltage on.
    switch_on
    /// Permission of the outputs.
    output_enable
    /// The channel.
    channel
}
