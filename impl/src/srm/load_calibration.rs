//! The test of the measuring equipment of F_LOAD_MONITOR (FB204): a constant load or a load step, at regular intervals.
//!
//! An edge at CALIBRATE starts. When the settling time is over both channels have to be at the expected value, and to stay there until
//! the end of the test; both times count from the start. What the load does otherwise is supervised all the time, by
//! [`crate::srm::load_monitor`].
//!
//! The interval (TIME, measured by F_TP) is given in calls. Readings: AMB-19 ONE, AMB-57, AMB-58, AMB-60: after a restart
//! a test is due.

use crate::kernel::Cycles;
use crate::srm::common::{calls, diag, latch, rises, within};

config! {
    /// The parameters: any DInt, as the block takes them; wrong ones are reported by `DIAG`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// T_INTERVAL, in calls: how long a passed test counts.
        pub t_interval: Cycles,
        /// Time between two calls, ms.
        pub t_sample: i32,
        /// Duration of a test, ms.
        pub t_test: i32,
        /// In it the time until the load has settled, ms.
        pub t_settle: i32,
        /// Expected load or load step, hundredths of a percent.
        pub cal_value: i32,
        /// Its tolerance.
        pub maxtol_cal: i32,
        /// 1: a load step, 0: a constant load.
        pub cal_mode: bool,
        /// Other parameters of the block are wrong: no test starts.
        pub wrong_elsewhere: bool,
    }
    accepted |_config| true
}

impl Config {
    /// Both times are right, in calls: test and settling.
    pub const fn times(&self) -> Option<(i32, i32)> {
        match (
            calls(self.t_test, self.t_sample),
            calls(self.t_settle, self.t_sample),
        ) {
            (Some(test), Some(settle)) if test > settle => Some((test, settle)),
            _ => None,
        }
    }
}

fields! {
    /// Where a test is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// None runs.
        #[default]
        Idle,
        /// The load settles.
        Settle,
        /// The load has to stay.
        Hold,
    }
}

fields! {
    /// The state between two calls.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// Where the test is.
        pub phase: Phase,
        /// Calls since its start.
        pub calls: i32,
        /// Load of channel 1 at its start.
        pub from1: i32,
        /// Load of channel 2 at its start.
        pub from2: i32,
        /// The load has not settled: bit 4.
        pub unsettled: bool,
        /// The load has not stayed: bit 5.
        pub unsteady: bool,
        /// A result was no DInt: bit 11.
        pub overflowed: bool,
        /// The last test was passed and counts.
        pub passed: bool,
        /// What is left of the interval.
        pub left: Cycles,
        /// CALIBRATE in the call before.
        pub calibrate_held: bool,
        /// ACK in the call before.
        pub ack_held: bool,
    }
}

impl State {
    /// Before the first call.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        calls: 0,
        from1: 0,
        from2: 0,
        unsettled: false,
        unsteady: false,
        overflowed: false,
        passed: false,
        left: Cycles::ZERO,
        calibrate_held: true,
        ack_held: true,
    };

    /// A test runs with right parameters for at most its time and has nothing to report; what was passed counts for at most the
    /// interval.
    pub fn invariant(&self, config: &Config) -> bool {
        let fits = match (self.phase, config.times()) {
            (Phase::Idle, _) => true,
            (_, None) => false,
            (Phase::Settle, Some((_, settle))) => within(0, self.calls, settle.saturating_sub(1)),
            (Phase::Hold, Some((test, settle))) => {
                within(settle, self.calls, test.saturating_sub(1))
            }
        };
        let runs = self.phase != Phase::Idle;
        let silent = !self.unsettled && !self.unsteady && !self.passed && !config.wrong_elsewhere;
        fits && (!runs || silent)
            && self.left <= config.t_interval
            && !(self.passed && (self.unsettled || self.unsteady))
            && !(self.unsettled && self.unsteady)
    }
}

fields! {
    /// The inputs of one call (SRM-LOAD-003).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Load, channel 1.
        pub load1: i32,
        /// Load, channel 2.
        pub load2: i32,
        /// Starts a test.
        pub calibrate: bool,
        /// Acknowledgement.
        pub ack: bool,
    }
}

fields! {
    /// The outputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A test is due.
        pub test_req: bool,
        /// A test runs.
        pub busy: bool,
        /// The last test was passed and its interval is not over.
        pub test_ok: bool,
        /// A calculation fault can be acknowledged.
        pub ack_req: bool,
        /// The load has not settled or not stayed, or a calculation fault is latched.
        pub error: bool,
        /// Bits 4, 5 and 11 of the diagnostic word.
        pub diag: u16,
    }
}

/// CALIBRATE has become 1.
fn starts(s: &Step) -> bool {
    s.inputs.calibrate && !s.before.calibrate_held
}

/// Both channels are at the expected value or step, exact.
fn on_value(s: &Step) -> bool {
    let near = |load: i32, from: i32| {
        let measured = i64::from(load)
            - if s.config.cal_mode {
                i64::from(from)
            } else {
                0
            };
        (measured - i64::from(s.config.cal_value)).abs() <= i64::from(s.config.maxtol_cal)
    };
    near(s.inputs.load1, s.before.from1) && near(s.inputs.load2, s.before.from2)
}

monitor! { srm::load_calibration;
    /// An edge at CALIBRATE starts a test: nothing is passed any more, the faults of the last one are forgotten.
    edge_starts_a_test ["SRM-LOADCAL-002", "SRM-LOADCAL-008"]:
        when |s| s.before.phase == Phase::Idle && starts(&s) && s.config.times().is_some() && !s.config.wrong_elsewhere
            => s.outputs.busy && !s.outputs.test_ok && s.outputs.diag & 0x30 == 0
                && s.after.from1 == s.inputs.load1 && s.after.from2 == s.inputs.load2;

    /// Nothing else starts one, and none starts beside wrong parameters.
    nothing_else_starts ["SRM-LOADCAL-002", "SRM-ACK-006"]:
        when |s| s.before.phase == Phase::Idle && s.outputs.busy
            => starts(&s) && s.config.times().is_some() && !s.config.wrong_elsewhere;

    /// An edge while a test runs is lost: the test goes on in its time.
    second_edge_is_ignored ["SRM-LOADCAL-011"]:
        when |s| s.before.phase != Phase::Idle && s.outputs.busy
            => s.after.calls == s.before.calls + 1 && s.after.from1 == s.before.from1 && s.after.from2 == s.before.from2;

    /// A load that is not there when the settling time is over fails the test by bit 4.
    unsettled_fails ["SRM-LOADCAL-003", "SRM-LOADCAL-005", "SRM-LOADCAL-010"]:
        when |s| s.before.phase == Phase::Settle && s.config.times().is_some_and(|(_, settle)| s.before.calls + 1 == settle)
            && !on_value(&s)
            => !s.outputs.busy && s.outputs.error && s.outputs.diag & 0x30 == 0x10 && !s.outputs.test_ok;

    /// While it settles the load may be anywhere.
    settling_is_free ["SRM-LOADCAL-003", "SRM-LOADCAL-005"]:
        when |s| s.before.phase == Phase::Settle && s.config.times().is_some_and(|(_, settle)| s.before.calls + 1 < settle)
            => s.after.phase == Phase::Settle && s.outputs.busy;

    /// A load that leaves the tolerance afterwards fails the test by bit 5, also in its last call.
    unsteady_fails ["SRM-LOADCAL-004", "SRM-LOADCAL-006", "SRM-LOADCAL-010", "SRM-LOADCAL-011"]:
        when |s| s.before.phase == Phase::Hold && !on_value(&s)
            => !s.outputs.busy && s.outputs.error && s.outputs.diag & 0x30 == 0x20 && !s.outputs.test_ok;

    /// A load that has stayed until the end passes it; the interval begins anew.
    steady_passes ["SRM-LOADCAL-007", "SRM-LOADCAL-011"]:
        when |s| s.before.phase == Phase::Hold && on_value(&s) && !s.after.overflowed
            && s.config.times().is_some_and(|(test, _)| s.before.calls + 1 == test)
            => s.outputs.test_ok && !s.outputs.busy && !s.outputs.test_req && s.after.left == s.config.t_interval;

    /// A test is passed in no other way.
    passed_is_earned ["SRM-LOADCAL-007", "SRM-P-63"]:
        when |s| s.outputs.test_ok && !s.before.passed
            => s.before.phase == Phase::Hold && on_value(&s)
                && s.config.times().is_some_and(|(test, _)| s.before.calls + 1 == test);

    /// What was passed counts for the interval, a call of it passes with each call.
    interval_runs_down ["SRM-LOADCAL-001", "SRM-P-63"]:
        when |s| s.before.passed && s.outputs.test_ok
            => s.after.left.count() + 1 == s.before.left.count() && !s.after.left.is_zero();

    /// When it is over a test is due and nothing is passed; so after a restart.
    due_is_not_passed ["SRM-LOADCAL-001", "SRM-LOADCAL-007"]:
        when |s| s.outputs.test_req
            => !s.outputs.test_ok;

    /// A test is due until one is passed.
    due_until_passed ["SRM-LOADCAL-001", "SRM-LOADCAL-007"]:
        when |s| s.before.left.is_zero() && !s.outputs.test_ok
            => s.outputs.test_req;

    /// A difference that is no DInt fails the test and is latched until it is acknowledged.
    overflow_is_a_fault ["SRM-LOAD-025", "SRM-LFMATH-003", "SRM-P-70"]:
        when |s| s.after.overflowed && !s.before.overflowed
            => !s.outputs.busy && !s.outputs.test_ok && s.outputs.error && s.outputs.diag & 0x800 == 0x800;

    /// Faults of a test end by the next one only; the calculation fault by an edge at ACK.
    faults_have_their_ends ["SRM-LOADCAL-008", "SRM-P-75"]:
        when |s| s.before.unsettled && !s.after.unsettled || s.before.unsteady && !s.after.unsteady
            || s.before.overflowed && !s.after.overflowed
            => if s.before.overflowed && !s.after.overflowed {
                s.inputs.ack && !s.before.ack_held
            } else {
                s.outputs.busy
            };

    /// Reports are what is latched; the other bits are 0.
    reports_are_exact ["SRM-DIAG-001", "SRM-LOAD-020", "SRM-ACK-003"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.diag == u16::from(s.after.unsettled) << 4 | u16::from(s.after.unsteady) << 5
                    | u16::from(s.after.overflowed) << 11
                && s.outputs.error == (s.outputs.diag != 0)
                && (!s.outputs.ack_req || s.after.overflowed);

    /// The step keeps the invariant and remembers the commands.
    state_stays_consistent ["SRM-LOADCAL-002"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.ack_held == s.inputs.ack
                && s.after.calibrate_held == s.inputs.calibrate;
}

/// Whether a channel is at the expected value or step; none where a difference is no DInt.
const fn near(config: &Config, load: i32, from: i32) -> Option<bool> {
    let measured = if config.cal_mode {
        load.checked_sub(from)
    } else {
        Some(load)
    };
    match measured {
        Some(measured) => match measured.checked_sub(config.cal_value) {
            Some(off) => Some((off as i64).abs() <= config.maxtol_cal as i64),
            None => None,
        },
        None => None,
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let acknowledged = rises(inputs.ack, state.ack_held);
    let begins = rises(inputs.calibrate, state.calibrate_held) && !config.wrong_elsewhere;
    let left = state.left.tick();
    let mut overflow = false;
    let mut after = State {
        left,
        passed: state.passed && !left.is_zero(),
        calibrate_held: inputs.calibrate,
        ack_held: inputs.ack,
        ..state
    };
    let idle = State {
        phase: Phase::Idle,
        calls: 0,
        from1: 0,
        from2: 0,
        ..after
    };
    match (state.phase, config.times()) {
        (Phase::Idle, Some(_)) if begins => {
            after = State {
                phase: Phase::Settle,
                calls: 0,
                from1: inputs.load1,
                from2: inputs.load2,
                unsettled: false,
                unsteady: false,
                passed: false,
                ..after
            };
        }
        (Phase::Idle, _) => {}
        (_, None) => after = idle,
        (phase, Some((test, settle))) => {
            let now = state.calls.saturating_add(1);
            after.calls = now;
            let settling = phase == Phase::Settle;
            if !settling || now >= settle {
                let both = (
                    near(config, inputs.load1, state.from1),
                    near(config, inputs.load2, state.from2),
                );
                overflow = both.0.is_none() || both.1.is_none();
                let stays = both == (Some(true), Some(true));
                if !stays {
                    after = State {
                        unsettled: settling,
                        unsteady: !settling,
                        ..idle
                    };
                } else if now >= test {
                    after = State {
                        passed: true,
                        left: config.t_interval,
                        ..idle
                    };
                } else {
                    after.phase = Phase::Hold;
                }
            }
        }
    }
    after.overflowed = latch(state.overflowed, overflow, acknowledged, true);
    let diag = diag(&[
        (4, after.unsettled),
        (5, after.unsteady),
        (11, after.overflowed),
    ]);
    let outputs = Outputs {
        test_req: !after.passed && after.left.is_zero(),
        busy: after.phase != Phase::Idle,
        test_ok: after.passed,
        ack_req: after.overflowed && !overflow,
        error: diag != 0,
        diag,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(cal_mode: bool) -> Config {
        Config {
            t_interval: Cycles::new(3),
            t_sample: 20,
            t_test: 80,
            t_settle: 40,
            cal_value: 5_000,
            maxtol_cal: 100,
            cal_mode,
            wrong_elsewhere: false,
        }
    }

    fn load(load: i32, calibrate: bool) -> Inputs {
        Inputs {
            load1: load,
            load2: load,
            calibrate,
            ack: false,
        }
    }

    /// SRM-LOADCAL-001 to SRM-LOADCAL-007: settles in two calls, stays for two more, counts for three.
    #[test]
    fn a_test_with_a_load_step() {
        let mut monitor = Monitor::new(config(true));
        assert!(monitor.step(&load(1_000, false)).test_req);
        assert!(monitor.step(&load(1_000, true)).busy);
        assert!(monitor.step(&load(3_000, true)).busy);
        assert!(monitor.step(&load(6_100, true)).busy);
        assert!(monitor.step(&load(5_900, false)).busy);
        let outputs = monitor.step(&load(6_000, false));
        assert!(outputs.test_ok && !outputs.busy && !outputs.test_req);
        assert!(monitor.step(&load(0, false)).test_ok);
        assert!(monitor.step(&load(0, false)).test_ok);
        let outputs = monitor.step(&load(0, false));
        assert!(!outputs.test_ok && outputs.test_req && !outputs.error);
    }

    /// SRM-LOADCAL-003, SRM-LOADCAL-004, SRM-LOADCAL-008.
    #[test]
    fn faults_have_their_bits() {
        let mut monitor = Monitor::new(config(false));
        monitor.step(&load(0, false));
        monitor.step(&load(0, true));
        monitor.step(&load(0, false));
        let outputs = monitor.step(&load(5_101, false));
        assert_eq!((outputs.diag, outputs.busy), (0x10, false));
        assert!(monitor.step(&load(5_000, true)).busy);
        monitor.step(&load(5_000, false));
        monitor.step(&load(4_900, false));
        let outputs = monitor.step(&load(4_899, false));
        assert_eq!((outputs.diag, outputs.error), (0x20, true));
    }
}
