//! Forced checking: how long ago each shutdown path of an axis was tested (machine `test_interval`).
//!
//! Both paths, through the drive channel and through the NCK channel, must have been tested within the interval, at most
//! 8 hours. After power-on a test is due. A failed test counts for neither path. What follows from a due test, such as not
//! releasing a protective door, is decided outside.

use crate::kernel::{ConfigError, Cycles};

/// Eight hours in cycles of 31.25 us, the shortest possible ones: the longest interval.
pub const EIGHT_HOURS: Cycles = Cycles::new(921_600_000);

config! {
    /// The interval as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        interval: Cycles,
    }
}

impl Config {
    /// `interval`: how long a test counts.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when it is zero, [`ConfigError::DelayTooLong`] above [`EIGHT_HOURS`].
    pub fn new(interval: Cycles) -> Result<Self, ConfigError> {
        if interval.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            interval: interval.at_most(EIGHT_HOURS)?,
        })
    }

    /// How long a test counts.
    pub const fn interval(&self) -> Cycles {
        self.interval
    }
}

fields! {
    /// The state between two cycles: how long the last test of each path still counts; 0 where a test is due.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// For the path of the drive channel.
        pub drive: Cycles,
        /// For the path of the NCK channel.
        pub nck: Cycles,
    }
}

impl State {
    /// Nothing tested.
    pub const INITIAL: Self = Self {
        drive: Cycles::ZERO,
        nck: Cycles::ZERO,
    };

    /// No test counts longer than the interval.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.drive <= config.interval && self.nck <= config.interval
    }

    /// A test is due: a path has not been tested within the interval.
    pub const fn due(&self) -> bool {
        self.drive.is_zero() || self.nck.is_zero()
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: nothing is tested.
        pub power_on: bool,
        /// The path of the drive channel has passed its test in this cycle (see [`crate::sinumerik::test_stop`]).
        pub passed_drive: bool,
        /// The path of the NCK channel has passed its test in this cycle.
        pub passed_nck: bool,
        /// A test has failed in this cycle.
        pub failed: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A test is due.
        pub due: bool,
        /// Exactly one path is tested: the test is half done.
        pub half: bool,
        /// The test of the axis became or stayed complete by a passed test in this cycle.
        pub tested: bool,
    }
}

monitor! { sinumerik::forced_check;
    /// After power-on a test is due, whatever was before.
    due_after_power_on ["S840D-TEST-024", "S840D-TEST-003"]:
        when |s| s.inputs.power_on
            => s.outputs.due && !s.outputs.tested;

    /// A failed test counts for neither path.
    failure_makes_due ["S840D-TEST-012", "S840D-TEST-026"]:
        when |s| s.inputs.failed
            => s.outputs.due && !s.outputs.half && !s.outputs.tested;

    /// A passed test counts for the whole interval from its end.
    test_counts_for_the_interval ["S840D-TEST-001/a"]:
        when |s| !s.inputs.power_on && !s.inputs.failed && (s.inputs.passed_drive || s.inputs.passed_nck)
            => (!s.inputs.passed_drive || s.after.drive == s.config.interval())
                && (!s.inputs.passed_nck || s.after.nck == s.config.interval());

    /// Without a test each path runs down, so that a test becomes due after the interval.
    paths_run_down ["S840D-TEST-001/a", "S840D-TIMING-513"]:
        when |s| !s.inputs.passed_drive || !s.inputs.passed_nck
            => (s.inputs.passed_drive || s.after.drive <= s.before.drive.tick())
                && (s.inputs.passed_nck || s.after.nck <= s.before.nck.tick());

    /// The test of one path does not help the other one.
    both_paths_are_needed ["S840D-TEST-005"]:
        when |s| !s.outputs.due
            => !s.after.drive.is_zero() && !s.after.nck.is_zero() && !s.outputs.half;

    /// Complete means: a test passed in this cycle, and the other path counts too.
    tested_means_both ["S840D-TEST-005", "S840D-TEST-002"]:
        when |s| s.outputs.tested
            => (s.inputs.passed_drive || s.inputs.passed_nck) && !s.outputs.due && !s.inputs.failed && !s.inputs.power_on;

    /// A passed test that leaves none due is reported.
    complete_test_is_reported ["S840D-TEST-002", "S840D-TEST-005"]:
        when |s| (s.inputs.passed_drive || s.inputs.passed_nck) && !s.outputs.due
            => s.outputs.tested;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-TEST-001/a", "S840D-TEST-005"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.due == s.after.due()
                && s.outputs.half == (s.after.drive.is_zero() != s.after.nck.is_zero());
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let path = |left: Cycles, passed: bool| {
        if passed { config.interval } else { left.tick() }
    };
    let void = inputs.power_on || inputs.failed;
    let after = if void {
        State::INITIAL
    } else {
        State {
            drive: path(state.drive, inputs.passed_drive),
            nck: path(state.nck, inputs.passed_nck),
        }
    };
    let outputs = Outputs {
        due: after.due(),
        half: after.drive.is_zero() != after.nck.is_zero(),
        tested: !void && (inputs.passed_drive || inputs.passed_nck) && !after.due(),
    };
    (after, outputs)
}
