//! Monitors of HEIDENHAIN Functional Safety: the step functions under test, their contracts, and properties over several steps, one
//! file per topic.

pub mod units;
pub mod watching;

monitors! { heidenhain:
    /// Take-over from the safe PLC.
    gate
    /// Requests of both channels.
    both_channels
    /// General fields of both channels.
    both_fields
    /// Programs, run-time systems and outputs of both channels.
    both_status
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
    /// Telegrams between controller computers.
    cc_link
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
    /// Filter of the keys.
    key_filter
    /// Requests for NC axes.
    axes_logic
    /// Requests for a spindle.
    spindle_logic
    /// Requests for a magazine.
    magazine_logic
    /// Marker of a safe input.
    safe_input
    /// Working space.
    working_space
    /// Control voltage asked for.
    control_voltage
    /// Jog increments.
    jog_increment
    /// General fields.
    general_fields
    /// Program of a safe PLC.
    program_check
    /// Table of the safety functions.
    availability
    /// Functions with the door open.
    allowed_functions
    /// F LIMITED.
    f_limited
    /// Motion of a group.
    group_motion
    /// Safe output.
    safe_output
}
