//! Test stop (forced dormant error detection) of the F-DO of a CU310-2, or of the F-DI and one F-DO of a TM54F.
//!
//! The supply of the F-DI is taken away, first L1+, then L2+, and they must be seen at 0 V; then the two switches of the F-DO go
//! through five positions, each with the level that must be read back within p10001. An error ends the test with its step.
//!
//! That the test is due is a message only; it stays until a test has passed.
//!
//! Readings: AC-09 T2_ON_OFF, AC-10, AC-28 TTIMER_ON_SUCCESS, AC-29.

use crate::kernel::{ConfigError, Cycles};

fields! {
    /// What is read back, p10047.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Mode {
        /// 1: the internal diagnostic signal, DIAG; a passive load (S120-TESTSTOP-503).
        #[default]
        Diagnostic,
        /// 2: a relay at a digital input (S120-TESTSTOP-504).
        Relay,
        /// 3: an actuator with feedback at a digital input (S120-TESTSTOP-505).
        Actuator,
    }
}

fields! {
    /// The step of the test.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum TestStep {
        /// No test.
        #[default]
        Idle,
        /// L1+ is off: F-DI 0 to 4.
        FirstInputs,
        /// L2+ is off: F-DI 5 to 9.
        SecondInputs,
        /// Both switches are off.
        Output1,
        /// Both are on.
        Output2,
        /// Plus is off, minus is on.
        Output3,
        /// Plus is on, minus is off.
        Output4,
        /// Both are off again.
        Output5,
    }
}

impl TestStep {
    /// The switches DO+ and DO- (S120-TESTSTOP-503).
    pub const fn switches(self) -> (bool, bool) {
        match self {
            Self::Output2 => (true, true),
            Self::Output3 => (false, true),
            Self::Output4 => (true, false),
            _ => (false, false),
        }
    }

    /// The level that must be read back; of the inputs 0 V.
    pub const fn expected(self, mode: Mode) -> bool {
        matches!(
            (self, mode),
            (Self::Output4, Mode::Diagnostic | Mode::Actuator)
                | (Self::Output3, Mode::Actuator)
                | (Self::Output1 | Self::Output5, Mode::Relay | Mode::Actuator)
        )
    }

    /// The next one; after the last one no test.
    const fn following(self) -> Self {
        match self {
            Self::FirstInputs => Self::SecondInputs,
            Self::SecondInputs => Self::Output1,
            Self::Output1 => Self::Output2,
            Self::Output2 => Self::Output3,
            Self::Output3 => Self::Output4,
            Self::Output4 => Self::Output5,
            Self::Output5 | Self::Idle => Self::Idle,
        }
    }
}

config! {
    /// What is tested, how, and when.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) tm54f: bool,
        pub(crate) mode: Mode,
        pub(crate) read: Cycles,
        pub(crate) interval: Cycles,
        pub(crate) automatic: bool,
    }
}

impl Config {
    /// `tm54f`: a TM54F, whose inputs are tested too. `mode`: p10047. `read`: p10001. `interval`: p10003. `automatic`: at POWER ON,
    /// p10048 of a TM54F, p9507.6 of a CU310-2.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when one of the times is 0.
    pub const fn new(
        tm54f: bool,
        mode: Mode,
        read: Cycles,
        interval: Cycles,
        automatic: bool,
    ) -> Result<Self, ConfigError> {
        if read.is_zero() || interval.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            tm54f,
            mode,
            read,
            interval,
            automatic,
        })
    }

    const fn first(&self) -> TestStep {
        if self.tm54f {
            TestStep::FirstInputs
        } else {
            TestStep::Output1
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The step of the test, or that in which it has failed.
        pub step: TestStep,
        /// The test has failed.
        pub failed: bool,
        /// What is left of the time to read the level.
        pub timer: Cycles,
        /// What is left until the test is due; 0: it is.
        pub interval: Cycles,
        /// The start signal in the last cycle.
        pub started: bool,
    }
}

impl State {
    /// POWER ON: the test is due; a start signal that is there is no edge.
    pub const INITIAL: Self = Self {
        step: TestStep::Idle,
        failed: false,
        timer: Cycles::ZERO,
        interval: Cycles::ZERO,
        started: true,
    };

    /// The timer runs exactly during a test; a test that has failed is due.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        let running = self.step != TestStep::Idle && !self.failed;
        running != self.timer.is_zero()
            && self.timer <= config.read
            && self.interval <= config.interval
            && (!self.failed || (self.step != TestStep::Idle && self.interval.is_zero()))
            && (config.tm54f
                || !matches!(self.step, TestStep::FirstInputs | TestStep::SecondInputs))
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The start signal, p10007.
        pub start: bool,
        /// Ready, and not being commissioned.
        pub ready: bool,
        /// A registered one of F-DI 0 to 4 has a level above 0 V.
        pub first_inputs: bool,
        /// A registered one of F-DI 5 to 9 has a level above 0 V.
        pub second_inputs: bool,
        /// What is read back of the F-DO.
        pub read_back: bool,
        /// A safe acknowledgement.
        pub acknowledge: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The test runs, A01772 or A35012; F-DI are frozen, F-DO not registered off. Not longer than the manual grants
        /// (S120-TESTSTOP-502, S120-TESTSTOP-510).
        pub running: bool,
        /// The test is due, A01774 or A35014.
        pub due: bool,
        /// The test has failed, F01773 or F35013.
        pub fault: bool,
        /// The step that has failed.
        pub fault_step: TestStep,
        /// L1+ is on.
        pub l1: bool,
        /// L2+ is on.
        pub l2: bool,
        /// The switch DO+.
        pub plus: bool,
        /// The switch DO-.
        pub minus: bool,
    }
}

/// Whether the step reads what it must.
const fn seen(state: &State, config: &Config, inputs: &Inputs) -> bool {
    let level = match state.step {
        TestStep::FirstInputs => inputs.first_inputs,
        TestStep::SecondInputs => inputs.second_inputs,
        _ => inputs.read_back,
    };
    level == state.step.expected(config.mode)
}

monitor! { sinamics::io_test;
    /// A test begins by the rising edge of a ready module, or at POWER ON where that is configured.
    test_begins_by_an_edge ["S120-TESTSTOP-501", "S120-TESTSTOP-506"]:
        when |s| s.outputs.running && (s.before.timer.is_zero() || s.inputs.power_on)
            => s.after.step == s.config.first() && s.after.timer == s.config.read
                && if s.inputs.power_on {
                    s.config.automatic
                } else {
                    s.inputs.start && !s.before.started && s.inputs.ready && !s.before.failed
                };

    /// Such an edge begins it.
    edge_begins_the_test ["S120-TESTSTOP-501", "S120-TESTSTOP-506"]:
        when |s| s.inputs.start && !s.before.started && s.inputs.ready && !s.inputs.power_on && s.before.step == TestStep::Idle
            => s.outputs.running;

    /// The steps follow each other in their order, each once its level was seen.
    steps_keep_their_order ["S120-TESTSTOP-503", "S120-TESTSTOP-504", "S120-TESTSTOP-505", "S120-TESTSTOP-509", "S120-PC-17"]:
        when |s| s.before.timer > Cycles::ZERO && s.after.step != s.before.step && !s.inputs.power_on
            => s.after.step == s.before.step.following() && seen(&s.before, &s.config, &s.inputs);

    /// A level that is not seen within p10001 ends the test with its step.
    wrong_level_fails ["S120-TESTSTOP-501", "S120-TESTSTOP-503", "S120-TESTSTOP-504", "S120-TESTSTOP-505", "S120-TESTSTOP-508",
        "S120-PC-17"]:
        when |s| s.before.timer == Cycles::new(1) && !s.inputs.power_on && !seen(&s.before, &s.config, &s.inputs)
            => s.outputs.fault && s.outputs.fault_step == s.before.step && !s.outputs.running && s.outputs.due;

    /// Until then it is waited for.
    level_is_waited_for ["S120-TESTSTOP-503"]:
        when |s| s.before.timer > Cycles::new(1) && !s.inputs.power_on && !seen(&s.before, &s.config, &s.inputs)
            => s.after.step == s.before.step && s.outputs.running && s.after.timer == s.before.timer.tick();

    /// Only a test that has passed ends its being due, and begins the interval.
    passed_test_is_not_due ["S120-TESTSTOP-500", "S120-TESTSTOP-507", "S120-TESTSTOP-520", "S120-PC-22"]:
        when |s| s.before.interval.is_zero() && !s.outputs.due
            => s.before.step == TestStep::Output5 && !s.before.failed && !s.inputs.power_on && !s.outputs.running
                && seen(&s.before, &s.config, &s.inputs) && s.after.interval == s.config.interval;

    /// The interval ends in its time, and each POWER ON ends it.
    interval_ends ["S120-TESTSTOP-500", "S120-TESTSTOP-507", "S120-TESTSTOP-513"]:
        when |s| s.before.interval > Cycles::ZERO && s.after.step == s.before.step && !s.after.failed
            => s.after.interval == if s.inputs.power_on { Cycles::ZERO } else { s.before.interval.tick() };

    /// A failed test stays due and failed until a safe acknowledgement, or POWER ON.
    failed_test_needs_an_acknowledgement ["S120-TESTSTOP-520", "S120-TM54F-507"]:
        when |s| s.before.failed && !s.outputs.fault
            => s.outputs.due && (s.inputs.acknowledge || s.inputs.power_on);

    /// Switches and supplies are those of the step; without a test the supplies are on.
    switches_belong_to_the_step ["S120-TESTSTOP-503", "S120-TESTSTOP-504", "S120-TESTSTOP-505", "S120-TESTSTOP-509"]:
        when |s| s.outputs.running
            => (s.outputs.plus, s.outputs.minus) == s.after.step.switches()
                && s.outputs.l1 == (s.after.step != TestStep::FirstInputs)
                && s.outputs.l2 == (s.after.step != TestStep::SecondInputs);

    /// Without a running test nothing is switched, whatever is due or has failed.
    due_test_changes_nothing ["S120-TESTSTOP-513", "S120-PC-22"]:
        when |s| !s.outputs.running
            => !s.outputs.plus && !s.outputs.minus && s.outputs.l1 && s.outputs.l2;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-TESTSTOP-500"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.fault == s.after.failed
                && s.outputs.due == s.after.interval.is_zero() && s.after.started == s.inputs.start;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let mut after = before;
    after.interval = before.interval.tick();
    after.started = inputs.start;
    let begins = if inputs.power_on {
        config.automatic
    } else {
        inputs.start && !before.started && inputs.ready
    };
    if before.failed {
        if inputs.acknowledge {
            after.failed = false;
            after.step = TestStep::Idle;
        }
    } else if before.step == TestStep::Idle {
        if begins {
            after.step = config.first();
            after.timer = config.read;
        }
    } else if seen(&before, config, inputs) {
        after.step = before.step.following();
        after.timer = config.read;
        if after.step == TestStep::Idle {
            after.timer = Cycles::ZERO;
            after.interval = config.interval;
        }
    } else {
        after.timer = before.timer.tick();
        after.failed = after.timer.is_zero();
    }
    if after.failed {
        after.interval = Cycles::ZERO;
    }
    (after, outputs(&after))
}

fn outputs(state: &State) -> Outputs {
    let running = state.step != TestStep::Idle && !state.failed;
    let (plus, minus) = state.step.switches();
    Outputs {
        running,
        due: state.interval.is_zero(),
        fault: state.failed,
        fault_step: if state.failed {
            state.step
        } else {
            TestStep::Idle
        },
        l1: !running || state.step != TestStep::FirstInputs,
        l2: !running || state.step != TestStep::SecondInputs,
        plus: running && plus,
        minus: running && minus,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-TESTSTOP-503, S120-TESTSTOP-504, S120-TESTSTOP-505: the printed tables of the test steps.
    #[test]
    fn the_printed_steps() {
        let steps = [
            (TestStep::Output1, (false, false), [false, true, true]),
            (TestStep::Output2, (true, true), [false, false, false]),
            (TestStep::Output3, (false, true), [false, false, true]),
            (TestStep::Output4, (true, false), [true, false, true]),
            (TestStep::Output5, (false, false), [false, true, true]),
        ];
        for (step, switches, levels) in steps {
            assert_eq!(step.switches(), switches);
            assert_eq!(
                Mode::ALL.map(|mode| step.expected(mode)),
                levels,
                "{step:?}"
            );
        }
    }

    /// S120-TESTSTOP-500, S120-TESTSTOP-520: a welded switch is found, and the test stays due.
    #[test]
    fn a_welded_switch_is_found() {
        let [read, interval] = [3, 100].map(Cycles::new);
        let config = Config::new(false, Mode::Diagnostic, read, interval, false).expect("times");
        let run = |welded: bool| {
            let mut test = Monitor::new(config);
            test.step(&Inputs::default());
            let start = Inputs {
                start: true,
                ready: true,
                ..Inputs::default()
            };
            let mut outputs = test.step(&start);
            while outputs.running {
                let plus = outputs.plus || welded;
                outputs = test.step(&Inputs {
                    // A passive load: the signal is there when plus feeds it and minus does not take it away.
                    read_back: plus && !outputs.minus,
                    ..start
                });
            }
            outputs
        };
        assert!(!run(false).due && !run(false).fault);
        assert!(run(true).due && run(true).fault_step == TestStep::Output1);
    }
}
