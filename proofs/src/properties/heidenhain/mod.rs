//! Monitors of HEIDENHAIN Functional Safety: the step functions under test, their contracts, and properties over several steps, one
//! file per topic.

pub mod units;

monitors! { heidenhain:
    /// Take-over from the safe PLC.
    gate
    /// Requests of both channels.
    both_channels
    /// Limited speed.
    speed
    /// Operating stop.
    operating_stop
    /// Path of an SS2.
    stop_path
    /// Limited position.
    position_limit
    /// Two revolutions.
    revolutions
    /// Nominal and actual value.
    comparison
    /// dv/dt.
    deceleration
    /// Number of moving axes.
    axis_count
    /// Referencing.
    reference
    /// Comparison between the channels.
    agreement
    /// Brake outputs.
    brakes
    /// Tool holder.
    tool_holder
    /// Acceptance of parameters.
    acceptance
    /// Self-test.
    self_test
    /// Test of the cut-out channels.
    cut_out
    /// Test of a holding brake.
    holding_brake
    /// Status bits.
    status_bits
    /// Forced dynamic sampling.
    sampling
    /// Checks of the kernel.
    self_checks
    /// Checks while booting.
    start_checks
    /// Stop reaction.
    stop
    /// What the other channel is told.
    report
    /// What a stop makes of other groups.
    neighbour
    /// -STO.A.G after an SS0.
    global_sto
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
