//! The sequence that the two tests of a shutdown path share: [`crate::sinumerik::test_stop`] and [`crate::sinumerik::shutdown_test`].
//!
//! Selecting the test cancels the pulses over one path only and starts t_chk. The feedback "pulses cancelled" must come
//! before t_chk has passed; the cancellation is held until then and until the selection is withdrawn.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The test as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_chk: Cycles,
    }
}

impl Config {
    /// `t_chk`: the time in which the pulses must be cancelled (PULSE_DIS_CHECK_TIME). 0 makes every test fail at once.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] above [`Cycles::TEN_SECONDS`].
    pub fn new(t_chk: Cycles) -> Result<Self, ConfigError> {
        Ok(Self {
            t_chk: t_chk.at_most(Cycles::TEN_SECONDS)?,
        })
    }

    /// The time in which the pulses must be cancelled.
    pub const fn t_chk(&self) -> Cycles {
        self.t_chk
    }
}

fields! {
    /// How far the test is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// No test.
        #[default]
        Idle,
        /// The pulses are to be cancelled; the feedback is awaited.
        Run,
        /// The feedback has come; the cancellation is held.
        RunOk,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the test is.
        pub phase: Phase,
        /// What is left of t_chk; 0 without test.
        pub timer: Cycles,
        /// The selection in the last cycle: only its rise starts a test.
        pub selected: bool,
    }
}

impl State {
    /// No test, nothing selected.
    pub const INITIAL: Self = Self {
        phase: Phase::Idle,
        timer: Cycles::ZERO,
        selected: false,
    };

    /// The timer runs for at most t_chk, not without test, and the feedback is awaited only while it runs.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_chk
            && match self.phase {
                Phase::Idle => self.timer.is_zero(),
                Phase::Run => !self.timer.is_zero(),
                Phase::RunOk => true,
            }
    }

    /// Whether a test runs.
    pub const fn active(&self) -> bool {
        !matches!(self.phase, Phase::Idle)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: a test ends without result, and a selection that is already there starts none.
        pub power_on: bool,
        /// The test is selected (1 = selected, unlike the "de-select" signals).
        pub select: bool,
        /// Feedback: the pulses are cancelled.
        pub pulses_cancelled: bool,
        /// An internal STOP A or B was latched in this channel after the last cycle.
        pub internal_ab: bool,
    }
}

/// What one cycle has brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Event {
    /// Nothing to report.
    None,
    /// Selected while the pulses were already cancelled: no test.
    AlreadyOff,
    /// No feedback within t_chk.
    Failed,
    /// The path is tested.
    Passed,
}

/// One cycle of the sequence.
pub(crate) fn advance(state: State, config: &Config, inputs: &Inputs) -> (State, Event) {
    let before = if inputs.power_on {
        State {
            selected: inputs.select,
            ..State::INITIAL
        }
    } else {
        state
    };
    let timer = before.timer.tick();
    let rises = inputs.select && !before.selected;
    let ended = (Phase::Idle, Cycles::ZERO);
    let ((phase, timer), event) = match before.phase {
        // The higher stop takes over: no result.
        Phase::Run | Phase::RunOk if inputs.internal_ab => (ended, Event::None),
        // The feedback of the cycle in which the time is up comes too late.
        Phase::Run if timer.is_zero() => (ended, Event::Failed),
        Phase::Run if inputs.pulses_cancelled => ((Phase::RunOk, timer), Event::None),
        Phase::Run => ((Phase::Run, timer), Event::None),
        Phase::RunOk if timer.is_zero() && !inputs.select => (ended, Event::Passed),
        Phase::RunOk => ((Phase::RunOk, timer), Event::None),
        Phase::Idle if !rises || inputs.internal_ab => (ended, Event::None),
        Phase::Idle if inputs.pulses_cancelled => (ended, Event::AlreadyOff),
        Phase::Idle if config.t_chk.is_zero() => (ended, Event::Failed),
        Phase::Idle => ((Phase::Run, config.t_chk), Event::None),
    };
    let after = State {
        phase,
        timer,
        selected: inputs.select,
    };
    (after, event)
}
