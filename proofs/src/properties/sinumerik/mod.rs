//! Monitors of the SINUMERIK 840D: the step functions under test, their contracts, and properties over several steps, one file
//! per topic.

pub mod axis;
pub mod checking;
pub mod fault;
pub mod initial;
pub mod selection;
pub mod stop;
pub mod units;
pub mod watching;

monitors! { sinumerik:
    /// Arbitration.
    stop
    /// External stops.
    external
    /// STOP F.
    fault
    /// Selection.
    selection
    /// Referencing.
    reference
    /// User agreement.
    agreement
    /// Gear stage.
    gear
    /// Effect on other axes.
    group
    /// Test of the shutdown path.
    test_stop
    /// Test of the external shutdown.
    shutdown_test
    /// Pulse cancellation.
    pulses
    /// Cross comparison.
    compare
    /// Synchronisation of actual values.
    slip
    /// Standstill position.
    history
    /// Forced checking.
    forced_check
    /// Actual position.
    motion
    /// Window of the operating stop.
    standstill
    /// Limit of the speed.
    speed
    /// Limit switches.
    limit_switch
    /// Braking ramp.
    ramp
    /// Threshold.
    threshold
    /// Cam.
    cam
    /// Result lists.
    results
    /// The channel.
    channel
}
