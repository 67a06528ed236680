//! Test stop of the drive, of the Extended Functions, in one channel: whether both switch-off paths still suppress the pulses
//! (machine B11).
//!
//! A test is due after POWER ON and when the time since the last passed one is over; only a passed one changes that. A request is an
//! edge; a test that cannot begin is not remembered. The test selects STO by itself, so nothing is delayed by it.

use crate::kernel::{ConfigError, Cycles};
use crate::sinamics::types::rises;

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        interval: Cycles,
        longest: Cycles,
        automatic: bool,
    }
}

impl Config {
    /// `interval`: p9559. `longest`: p9557, the time for the pulses to be suppressed. `automatic`: p9507.6, a test at POWER ON.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when a time is 0.
    pub const fn new(
        interval: Cycles,
        longest: Cycles,
        automatic: bool,
    ) -> Result<Self, ConfigError> {
        if interval.is_zero() || longest.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            interval,
            longest,
            automatic,
        })
    }
}

fields! {
    /// What the test does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Nothing.
        #[default]
        Idle,
        /// It runs.
        Running,
        /// An automatic one was aborted and waits for the problem to go.
        Retry,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What the test does.
        pub phase: Phase,
        /// The running test is an automatic one.
        pub by_itself: bool,
        /// A test is due.
        pub due: bool,
        /// What is left of the interval; 0 while a test is due.
        pub left: Cycles,
        /// What is left of the time for the pulses.
        pub pulses_left: Cycles,
        /// The request in the cycle before.
        pub request_held: bool,
    }
}

impl State {
    /// Before POWER ON: nothing has been tested.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        by_itself: false,
        due: true,
        left: Cycles::ZERO,
        pulses_left: Cycles::ZERO,
        request_held: true,
    };

    /// Times run in their phases; only a test knows by what it began; an automatic one is retried only where there is one.
    pub fn invariant(&self, config: &Config) -> bool {
        let running = self.phase == Phase::Running;
        self.due == self.left.is_zero()
            && self.left <= config.interval
            && running != self.pulses_left.is_zero()
            && self.pulses_left <= config.longest
            && (config.automatic || !self.by_itself)
            && (self.phase != Phase::Idle || !self.by_itself)
            && (self.phase != Phase::Retry || self.by_itself)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON or warm restart.
        pub power_on: bool,
        /// The request: p9705 or S_STW1B.8.
        pub request: bool,
        /// STO or a stop that suppresses pulses is asked for by something else than the test.
        pub stop: bool,
        /// The pulses may be enabled: power-up is complete, no fault.
        pub allowed: bool,
        /// The pulses are suppressed, over both paths.
        pub pulses_off: bool,
        /// A path has not done what it was told.
        pub path_error: bool,
        /// A problem such as a failure of the communication.
        pub disturbed: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The test selects STO.
        pub sto: bool,
        /// A test is due: A01697, r9723.0.
        pub due: bool,
        /// The test was passed: the timer of the Basic Functions begins anew too.
        pub passed: bool,
        /// It has failed: a path error, or pulses that were not suppressed in time.
        pub failed: bool,
    }
}

/// A test is asked for: by an edge, at POWER ON, or again after a problem.
fn asked(s: &Step) -> bool {
    s.inputs.request && !s.before.request_held && !s.inputs.power_on
        || s.inputs.power_on && s.config.automatic
        || s.before.phase == Phase::Retry && !s.inputs.power_on
}

monitor! { sinamics::drive_test;
    /// A test begins when it is asked for and STO is not, in a drive that may have pulses; it selects STO.
    test_begins ["S120-TEST-007", "S120-TEST-008"]:
        when |s| s.before.phase != Phase::Running && asked(&s) && !s.inputs.stop && s.inputs.allowed && !s.inputs.disturbed
            => s.outputs.sto && s.after.phase == Phase::Running && s.after.pulses_left == s.config.longest;

    /// Never beside STO or a stop: then it stays due.
    test_never_begins_beside_sto ["S120-TEST-007", "S120-TEST-013", "S120-PF-22"]:
        when |s| s.inputs.stop
            => !s.outputs.sto && !s.outputs.passed && s.after.phase != Phase::Running
                && (s.after.due || !s.before.due);

    /// A level asks for nothing.
    request_is_an_edge ["S120-TEST-007"]:
        when |s| s.before.phase == Phase::Idle && s.before.request_held && !s.inputs.power_on
            => !s.outputs.sto && !s.outputs.passed && !s.outputs.failed;

    /// A test is passed exactly when both paths suppress the pulses in time and nothing disturbs it.
    test_is_passed ["S120-TEST-007", "S120-TEST-002"]:
        when |s| s.before.phase == Phase::Running && !s.inputs.power_on && !s.inputs.stop && !s.inputs.path_error
            && !s.inputs.disturbed && s.inputs.pulses_off
            => s.outputs.passed && !s.outputs.failed && !s.outputs.due && s.after.left == s.config.interval
                && s.after.phase == Phase::Idle;

    /// Nothing else passes.
    nothing_else_passes ["S120-TEST-007", "S120-TEST-013"]:
        when |s| s.outputs.passed
            => s.before.phase == Phase::Running && s.inputs.pulses_off && !s.inputs.stop && !s.inputs.path_error
                && !s.inputs.disturbed;

    /// A path error, and pulses that are still there when the time is over, fail it.
    test_fails ["S120-TEST-007"]:
        when |s| s.before.phase == Phase::Running && !s.inputs.power_on && !s.inputs.stop && !s.inputs.disturbed
            && (s.inputs.path_error || !s.inputs.pulses_off && s.before.pulses_left == Cycles::new(1))
            => s.outputs.failed && !s.outputs.passed && !s.outputs.sto && s.outputs.due;

    /// Until then it goes on.
    test_goes_on ["S120-TEST-007"]:
        when |s| s.before.phase == Phase::Running && !s.inputs.power_on && !s.inputs.stop && !s.inputs.disturbed
            && !s.inputs.path_error && !s.inputs.pulses_off && s.before.pulses_left > Cycles::new(1)
            => s.outputs.sto && s.after.pulses_left.count() + 1 == s.before.pulses_left.count();

    /// An aborted automatic test comes back by itself when the problem has gone; one that was asked for does not.
    automatic_test_comes_back ["S120-TEST-008", "S120-TEST-004"]:
        when |s| s.before.phase == Phase::Running && s.inputs.disturbed && !s.inputs.power_on && !s.inputs.stop
            => !s.outputs.sto && !s.outputs.failed && (s.after.phase == Phase::Retry) == s.before.by_itself;

    /// The automatic test needs no request.
    power_on_tests ["S120-TEST-004", "S120-TEST-007"]:
        when |s| s.inputs.power_on && s.config.automatic && s.inputs.allowed && !s.inputs.stop && !s.inputs.disturbed
            && s.before.phase != Phase::Running
            => s.outputs.sto && s.after.by_itself;

    /// A test that is due stays so until one is passed.
    due_until_passed ["S120-TEST-006", "S120-PF-35"]:
        when |s| s.before.due && !s.outputs.passed
            => s.outputs.due;

    /// POWER ON makes one due.
    power_on_makes_it_due ["S120-TEST-006"]:
        when |s| s.inputs.power_on
            => s.outputs.due;

    /// So does the end of the interval; it affects nothing else.
    interval_makes_it_due ["S120-TEST-006"]:
        when |s| s.before.left == Cycles::new(1) && !s.outputs.passed
            => s.outputs.due;

    /// The interval runs down, test or not.
    interval_runs_down ["S120-TEST-006"]:
        when |s| s.before.left > Cycles::new(1) && !s.inputs.power_on && !s.outputs.passed && !s.outputs.failed
            => s.after.left.count() + 1 == s.before.left.count() && !s.outputs.due;

    /// The state stays consistent.
    state_stays_consistent ["S120-TEST-006"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.due == s.after.due
                && s.outputs.sto == (s.after.phase == Phase::Running);
}

/// What a cycle does to a running test.
enum Progress {
    Goes,
    Passed,
    Failed,
    Aborted,
}

fn progress(state: &State, inputs: &Inputs) -> Progress {
    if inputs.stop || inputs.disturbed {
        Progress::Aborted
    } else if inputs.path_error {
        Progress::Failed
    } else if inputs.pulses_off {
        Progress::Passed
    } else if state.pulses_left.tick().is_zero() {
        Progress::Failed
    } else {
        Progress::Goes
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let state = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let mut after = State {
        left: state.left.tick(),
        request_held: inputs.request,
        ..state
    };
    let mut outputs = Outputs::default();
    let idle = |after: &mut State| {
        after.phase = Phase::Idle;
        after.by_itself = false;
        after.pulses_left = Cycles::ZERO;
    };
    if state.phase == Phase::Running {
        match progress(&state, inputs) {
            Progress::Goes => after.pulses_left = state.pulses_left.tick(),
            Progress::Passed => {
                outputs.passed = true;
                after.left = config.interval;
                idle(&mut after);
            }
            Progress::Failed => {
                outputs.failed = true;
                after.left = Cycles::ZERO;
                idle(&mut after);
            }
            Progress::Aborted if state.by_itself => {
                after.phase = Phase::Retry;
                after.pulses_left = Cycles::ZERO;
            }
            Progress::Aborted => idle(&mut after),
        }
    } else {
        let automatic = state.phase == Phase::Retry || inputs.power_on && config.automatic;
        let asked = automatic || rises(inputs.request, state.request_held);
        let possible = !inputs.stop && inputs.allowed && !inputs.disturbed;
        if asked && possible {
            after.phase = Phase::Running;
            after.by_itself = automatic;
            after.pulses_left = config.longest;
        } else if automatic {
            after.phase = Phase::Retry;
            after.by_itself = true;
        }
    }
    after.due = after.left.is_zero();
    outputs.due = after.due;
    outputs.sto = after.phase == Phase::Running;
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-TEST-008, S120-TEST-006: the automatic test at POWER ON is aborted by a problem, comes back and clears the alarm.
    #[test]
    fn an_automatic_test_comes_back() {
        let time = Cycles::new(5);
        let mut monitor = Monitor::new(Config::new(time, time, true).expect("accepted"));
        let mut inputs = Inputs {
            power_on: true,
            allowed: true,
            ..Inputs::default()
        };
        assert!(monitor.step(&inputs).sto);
        inputs.power_on = false;
        inputs.disturbed = true;
        assert!(!monitor.step(&inputs).sto);
        inputs.disturbed = false;
        assert!(monitor.step(&inputs).sto);
        inputs.pulses_off = true;
        let outputs = monitor.step(&inputs);
        assert!(outputs.passed && !outputs.due);
        let due: [bool; 5] = core::array::from_fn(|_| monitor.step(&inputs).due);
        assert_eq!(due, [false, false, false, false, true]);
    }
}
