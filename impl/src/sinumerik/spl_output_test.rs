//! Forced check of a two-channel output of the safe logic by one test input (machine `spl_output_test`, 3-terminal concept).
//!
//! Both programs run it with the same inputs. The test input is 1 only when both output channels are 0; so one bit shows that
//! both have switched, and a load that one of them has switched off already is without power while it is awaited.
//! If the answer does not come, the outputs stay off until somebody acknowledges and the answer shows that the fault is gone.
//!
//! A test input that is 1 while an output is 1 is broken: it would let every test pass.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// How long the test input may take.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        delay: Cycles,
    }
}

impl Config {
    /// `delay`: how long the test input may take to follow the outputs; at most ten seconds, for which `CMDSI` lets the
    /// channels differ.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when it is zero, [`ConfigError::DelayTooLong`] above ten seconds.
    pub fn new(delay: Cycles) -> Result<Self, ConfigError> {
        if delay.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            delay: delay.at_most(Cycles::TEN_SECONDS)?,
        })
    }

    /// How long the test input may take.
    pub const fn delay(&self) -> Cycles {
        self.delay
    }
}

fields! {
    /// What is done with the outputs.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Use {
        /// They are what the logic makes of them.
        #[default]
        Free,
        /// They are 0 for the test.
        Tested,
        /// They are 0 because a test has failed.
        Locked,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is done with the outputs.
        pub check: Use,
        /// Cycles for which the test input has not followed the outputs.
        pub wrong: Cycles,
    }
}

impl State {
    /// Nothing tested, nothing failed.
    pub const INITIAL: Self = Self {
        check: Use::Free,
        wrong: Cycles::ZERO,
    };

    const LOCKED: Self = Self {
        check: Use::Locked,
        wrong: Cycles::ZERO,
    };

    /// The answer is never waited for longer than it may take, and of locked outputs not at all.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.wrong <= config.delay && (self.check != Use::Locked || self.wrong.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// The test is asked for.
        pub trigger: bool,
        /// The logic switches the load on.
        pub wanted: bool,
        /// The test input.
        pub answer: bool,
        /// A failed test is acknowledged.
        pub ack: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The output of this channel.
        pub driven: bool,
        /// The test has passed in this cycle.
        pub passed: bool,
        /// A test has failed: the program asks for external STOP D or E (S840D-SPLTEST-005).
        pub failed: bool,
    }
}

monitor! { sinumerik::spl_output_test;
    /// The outputs are on only while neither a test runs nor one has failed.
    off_while_tested_or_locked ["S840D-SPLTEST-002", "S840D-SPLTEST-004"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.driven == (s.inputs.wanted && s.after.check == Use::Free);

    /// A test passes with the answer, which comes after the outputs were 0 in a cycle before.
    passes_with_the_answer ["S840D-SPLTEST-004"]:
        when |s| s.outputs.passed
            => s.before.check == Use::Tested && s.inputs.answer && !s.inputs.power_on;

    /// The answer in time is enough.
    answer_in_time_passes ["S840D-SPLTEST-002", "S840D-SPLTEST-004"]:
        when |s| s.before.check == Use::Tested && s.inputs.answer && !s.inputs.power_on
            => s.outputs.passed && !s.outputs.failed;

    /// Without it the test fails when the delay is over, and waits until then.
    missing_answer_locks ["S840D-SPLTEST-004", "S840D-SPLTEST-005"]:
        when |s| s.before.check == Use::Tested && !s.inputs.answer && !s.inputs.power_on
            => s.outputs.failed == (s.before.wrong == s.config.delay)
                && (s.outputs.failed || s.after.wrong.count() == s.before.wrong.count() + 1);

    /// A failed test locks until it is acknowledged with the answer there.
    locked_until_acknowledged ["S840D-SPLTEST-008"]:
        when |s| s.before.check == Use::Locked && !s.inputs.power_on
            => s.outputs.failed != (s.inputs.ack && s.inputs.answer) && (!s.outputs.failed || !s.outputs.driven);

    /// A trigger begins a test of outputs in use with the whole delay.
    trigger_begins ["S840D-SPLTEST-002", "S840D-SPLTEST-005"]:
        when |s| s.before.check == Use::Free && s.inputs.trigger && !s.inputs.power_on
            => s.after == (State { check: Use::Tested, wrong: Cycles::ZERO }) && !s.outputs.driven;

    /// An answer of 1 beside outputs that are to be 1 is tolerated for the delay.
    stuck_answer_locks ["S840D-SPLTEST-008"]:
        when |s| s.before.check == Use::Free && !s.inputs.trigger && s.inputs.wanted && s.inputs.answer && !s.inputs.power_on
            => s.outputs.failed == (s.before.wrong == s.config.delay)
                && (s.outputs.failed || s.after.wrong.count() == s.before.wrong.count() + 1);

    /// Outputs in use are locked for no other reason.
    no_lock_without_reason ["S840D-SPLTEST-004"]:
        when |s| s.before.check == Use::Free && !(s.inputs.wanted && s.inputs.answer)
            => !s.outputs.failed;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-SPLTEST-004"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.failed == (s.after.check == Use::Locked);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    // One cycle more in which the answer is the wrong one.
    let wrong = if state.wrong < config.delay {
        State {
            wrong: Cycles::new(state.wrong.count().saturating_add(1)),
            ..state
        }
    } else {
        State::LOCKED
    };
    let after = match (inputs.power_on, state.check) {
        (true, _) => State::INITIAL,
        (false, Use::Locked) if inputs.ack && inputs.answer => State::INITIAL,
        (false, Use::Locked) => State::LOCKED,
        (false, Use::Tested) if inputs.answer => State::INITIAL,
        (false, Use::Tested) => wrong,
        (false, Use::Free) if inputs.trigger => State {
            check: Use::Tested,
            wrong: Cycles::ZERO,
        },
        (false, Use::Free) if inputs.wanted && inputs.answer => wrong,
        (false, Use::Free) => State::INITIAL,
    };
    let outputs = Outputs {
        driven: inputs.wanted && after.check == Use::Free,
        passed: !inputs.power_on && state.check == Use::Tested && after.check == Use::Free,
        failed: after.check == Use::Locked,
    };
    (after, outputs)
}
