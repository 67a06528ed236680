//! The properties, one file per monitor, and the step functions they are stated about.

pub mod axis;
pub mod checking;
pub mod contracts;
pub mod fault;
pub mod selection;
pub mod stop;
pub mod units;
pub mod watching;

use stillpoint_monitors::channel;
use stillpoint_monitors::{agreement, external, fault as fault_monitor, gear, group, reference};
use stillpoint_monitors::{cam, limit_switch, motion, ramp, results, speed, standstill, threshold};
use stillpoint_monitors::{compare, forced_check, history, pulses, shutdown_test, slip, test_stop};
use stillpoint_monitors::{selection as selection_monitor, stop as stop_monitor};

/// The step functions under test: the production ones, or some replaced by mutants.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// Arbitration.
    pub stop: stop_monitor::Next,
    /// External stops.
    pub external: external::Next,
    /// STOP F.
    pub fault: fault_monitor::Next,
    /// Selection.
    pub selection: selection_monitor::Next,
    /// Referencing.
    pub reference: reference::Next,
    /// User agreement.
    pub agreement: agreement::Next,
    /// Gear stage.
    pub gear: gear::Next,
    /// Effect on other axes.
    pub group: group::Next,
    /// Test of the shutdown path.
    pub test_stop: test_stop::Next,
    /// Test of the external shutdown.
    pub shutdown_test: shutdown_test::Next,
    /// Pulse cancellation.
    pub pulses: pulses::Next,
    /// Cross comparison.
    pub compare: compare::Next,
    /// Synchronisation of actual values.
    pub slip: slip::Next,
    /// Standstill position.
    pub history: history::Next,
    /// Forced checking.
    pub forced_check: forced_check::Next,
    /// Actual position.
    pub motion: motion::Next,
    /// Window of the operating stop.
    pub standstill: standstill::Next,
    /// Limit of the speed.
    pub speed: speed::Next,
    /// Limit switches.
    pub limit_switch: limit_switch::Next,
    /// Braking ramp.
    pub ramp: ramp::Next,
    /// Threshold.
    pub threshold: threshold::Next,
    /// Cam.
    pub cam: cam::Next,
    /// Result lists.
    pub results: results::Next,
    /// The channel.
    pub channel: channel::Next,
}

impl Subject {
    /// The production monitors.
    pub const PRODUCTION: Self = Self {
        stop: stop_monitor::next,
        external: external::next,
        fault: fault_monitor::next,
        selection: selection_monitor::next,
        reference: reference::next,
        agreement: agreement::next,
        gear: gear::next,
        group: group::next,
        test_stop: test_stop::next,
        shutdown_test: shutdown_test::next,
        pulses: pulses::next,
        compare: compare::next,
        slip: slip::next,
        history: history::next,
        forced_check: forced_check::next,
        motion: motion::next,
        standstill: standstill::next,
        speed: speed::next,
        limit_switch: limit_switch::next,
        ramp: ramp::next,
        threshold: threshold::next,
        cam: cam::next,
        results: results::next,
        channel: channel::next,
    };
}
