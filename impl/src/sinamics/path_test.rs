//! Test of the switch-off paths of the Basic Functions in one channel: when it runs, and when it is due again.
//!
//! The paths are tested whenever they are used: after POWER ON, with each selection of STO or SS1, and within the test stop of the
//! Extended Functions. The time p9659 counts from the last use that has ended.

use crate::kernel::{ConfigError, Cycles};
use crate::sinamics::types::{falls, rises};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        interval: Cycles,
    }
}

impl Config {
    /// `interval`: p9659.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when it is 0.
    pub const fn new(interval: Cycles) -> Result<Self, ConfigError> {
        if interval.is_zero() {
            Err(ConfigError::NoDelay)
        } else {
            Ok(Self { interval })
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is left of the interval (r9660); 0: a test is due.
        pub left: Cycles,
        /// STO or SS1 was selected in the cycle before.
        pub selected_held: bool,
    }
}

impl State {
    /// Nothing has been tested.
    pub const INITIAL: Self = Self {
        left: Cycles::ZERO,
        selected_held: false,
    };

    /// The interval is never exceeded.
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.interval
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// STO or SS1 is selected.
        pub selected: bool,
        /// The test stop of the Extended Functions runs.
        pub test_stop: bool,
        /// It was passed in this cycle.
        pub passed: bool,
        /// Changed settings were activated.
        pub activated: bool,
        /// A path has not done what it was told.
        pub path_error: bool,
        /// STO is set by the Extended Functions: the terminals are not compared.
        pub extended_sto: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The paths are tested in this cycle.
        pub tested: bool,
        /// A test is due: A01699, r9773.31.
        pub due: bool,
        /// A path failed its test.
        pub failed: bool,
        /// What is left of the interval (r9660).
        pub left: Cycles,
        /// The discrepancy of the terminals is checked.
        pub terminals_checked: bool,
    }
}

/// Something begins the interval anew: STO or SS1 is deselected, a passed test stop, new settings.
fn renews(s: &Step) -> bool {
    s.before.selected_held && !s.inputs.selected && !s.inputs.power_on
        || s.inputs.passed
        || s.inputs.activated
}

monitor! { sinamics::path_test;
    /// The paths are tested after POWER ON, with each selection, and in the test stop of the Extended Functions; at no other time.
    paths_are_tested_when_used ["S120-TEST-003"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.tested
                == (s.inputs.power_on || s.inputs.selected && !s.before.selected_held || s.inputs.test_stop);

    /// A path that fails is found then.
    failure_is_found_in_the_test ["S120-TEST-003"]:
        when |s| s.inputs.path_error
            => s.outputs.failed == s.outputs.tested;

    /// The end of a use, a passed test stop and new settings begin the interval anew and clear the alarm.
    use_begins_the_interval ["S120-TEST-002", "S120-TEST-001"]:
        when |s| renews(&s) && !s.inputs.path_error
            => s.after.left == s.config.interval && !s.outputs.due;

    /// A path error does not: the alarm is cleared by a completed test.
    failed_test_renews_nothing ["S120-TEST-001"]:
        when |s| s.inputs.path_error && s.before.left.is_zero()
            => s.outputs.due;

    /// Else the interval runs down and is told.
    interval_runs_down ["S120-TEST-001"]:
        when |s| !renews(&s) && !s.inputs.power_on
            => s.after.left == s.before.left.tick() && s.outputs.left == s.after.left;

    /// After POWER ON one is due until the first use has ended.
    power_on_makes_it_due ["S120-TEST-001", "S120-TEST-003"]:
        when |s| s.inputs.power_on && !renews(&s)
            => s.outputs.due;

    /// Its end makes a test due, for as long as none is made; nothing else is affected.
    end_makes_it_due ["S120-TEST-001", "S120-PF-35"]:
        when |s| s.before.left <= Cycles::new(1) && !renews(&s)
            => s.outputs.due;

    /// While the Extended Functions hold STO the terminals are not compared.
    terminals_wait_for_extended_sto ["S120-TEST-005"]:
        when |s| s.inputs.extended_sto
            => !s.outputs.terminals_checked;

    /// At any other time they are.
    terminals_are_checked ["S120-TEST-005"]:
        when |s| !s.inputs.extended_sto
            => s.outputs.terminals_checked;

    /// The state stays consistent.
    state_stays_consistent ["S120-TEST-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.due == s.after.left.is_zero()
                && s.after.selected_held == s.inputs.selected;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let state = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let tested = inputs.power_on || rises(inputs.selected, state.selected_held) || inputs.test_stop;
    let renewed = falls(inputs.selected, state.selected_held) || inputs.passed || inputs.activated;
    let left = if renewed && !inputs.path_error {
        config.interval
    } else {
        state.left.tick()
    };
    let outputs = Outputs {
        tested,
        due: left.is_zero(),
        failed: tested && inputs.path_error,
        left,
        terminals_checked: !inputs.extended_sto,
    };
    let after = State {
        left,
        selected_held: inputs.selected,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-TEST-001, S120-TEST-002 with p9659 = 8 h (factory setting), in minutes.
    #[test]
    fn eight_hours_from_the_last_use() {
        let mut monitor = Monitor::new(Config::new(Cycles::new(480)).expect("accepted"));
        let idle = Inputs::default();
        let used = Inputs {
            selected: true,
            ..idle
        };
        assert!(monitor.step(&idle).due);
        assert!(monitor.step(&used).tested);
        assert_eq!(monitor.step(&idle).left, Cycles::new(480));
        for _ in 1..480 {
            assert!(!monitor.step(&idle).due);
        }
        assert!(monitor.step(&idle).due);
    }
}
