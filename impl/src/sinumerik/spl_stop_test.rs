//! Test of the shutdown paths and of the external stops of an axis, one channel after the other (machine `spl_stop_test`).
//!
//! The channels exchange the stops that are asked for, so that a channel which does not stop by itself would not be noticed while
//! both are tested at once. Each signal is therefore switched in one channel, its answer awaited, then in the other one:
//! first the shutdown path, for which both channels have one feedback, then each external stop that is used.
//!
//! An answer counts when it becomes 1 in its step.

use crate::kernel::{ConfigError, Cycles};
use crate::sinumerik::level::ExternalStop;

config! {
    /// How long an answer may take.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        delay: Cycles,
    }
}

impl Config {
    /// `delay`: how long each answer may take; at most ten seconds, for which `CMDSI` lets the channels differ.
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

    /// How long each answer may take.
    pub const fn delay(&self) -> Cycles {
        self.delay
    }
}

fields! {
    /// What is tested.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Item {
        /// Nothing.
        #[default]
        None,
        /// The shutdown path.
        Path,
        /// External STOP A.
        A,
        /// External STOP C.
        C,
        /// External STOP D.
        D,
        /// External STOP E.
        E,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is tested.
        pub item: Item,
        /// In the drive; before that in the NCK.
        pub drive: bool,
        /// The answer has been 0 in this step.
        pub low: bool,
        /// What is left of the delay.
        pub left: Cycles,
        /// The last test has failed.
        pub failed: bool,
    }
}

impl State {
    /// Nothing tested.
    pub const INITIAL: Self = Self {
        item: Item::None,
        drive: false,
        low: false,
        left: Cycles::ZERO,
        failed: false,
    };

    /// Outside a test nothing runs, and in one nothing has failed.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        if self.item == Item::None {
            !self.drive && !self.low && self.left.is_zero()
        } else {
            !self.failed && self.left <= config.delay
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// The test is asked for.
        pub start: bool,
        /// "Pulses cancelled" of the channel, or its SGA of the stop.
        pub answer: bool,
        /// External STOP A is enabled and used.
        pub used_a: bool,
        /// External STOP C is.
        pub used_c: bool,
        /// External STOP D is.
        pub used_d: bool,
        /// External STOP E is.
        pub used_e: bool,
    }
}

impl Inputs {
    const fn uses(&self, item: Item) -> bool {
        match item {
            Item::None | Item::Path => false,
            Item::A => self.used_a,
            Item::C => self.used_c,
            Item::D => self.used_d,
            Item::E => self.used_e,
        }
    }

    /// The next item after this one that is used.
    fn after(&self, item: Item) -> Item {
        let mut later = Item::ALL.into_iter().filter(|other| *other > item);
        later.find(|other| self.uses(*other)).unwrap_or(Item::None)
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The signal of the NCK is switched.
        pub nck: bool,
        /// That of the drive is.
        pub drive: bool,
        /// It is the test stop.
        pub path: bool,
        /// Which external stop it is.
        pub stop: ExternalStop,
        /// The test has passed in this cycle.
        pub passed: bool,
    }
}

monitor! { sinumerik::spl_stop_test;
    /// One channel is tested at a time, with one signal.
    one_after_the_other ["S840D-SPLTEST-006"]:
        when |s| s.before.invariant(&s.config)
            => (!s.outputs.nck || !s.outputs.drive) && (!s.outputs.path || s.outputs.stop == ExternalStop::None)
                && (s.outputs.nck || s.outputs.drive) == (s.after.item != Item::None);

    /// A step ends with an edge of its answer, or it fails.
    edge_or_failure ["S840D-SPLTEST-007"]:
        when |s| s.before.item != Item::None && !s.inputs.power_on
            && (s.after.item != s.before.item || s.after.drive != s.before.drive)
            => (s.before.low && s.inputs.answer) || s.after.failed;

    /// The drive follows the NCK for the same item.
    drive_follows ["S840D-SPLTEST-006", "S840D-SPLTEST-007"]:
        when |s| s.before.item != Item::None && !s.before.drive && s.before.low && s.inputs.answer && !s.inputs.power_on
            => s.after.item == s.before.item && s.outputs.drive;

    /// After the drive comes the next stop that is used, in the NCK.
    next_stop_is_used ["S840D-SPLTEST-006", "S840D-SPLTEST-007"]:
        when |s| s.before.drive && s.before.low && s.inputs.answer && !s.inputs.power_on
            => !s.outputs.drive && s.after.item == s.inputs.after(s.before.item)
                && (s.after.item == Item::None || s.inputs.uses(s.after.item) && s.after.item > s.before.item);

    /// It passes when none is left, after the drive has answered for the last one.
    passes_at_the_end ["S840D-SPLTEST-007"]:
        when |s| s.outputs.passed
            => s.before.drive && s.before.low && s.inputs.answer && s.after == State::INITIAL
                && s.inputs.after(s.before.item) == Item::None;

    /// Without an edge a step fails when its delay is over, and waits until then.
    missing_answer_fails ["S840D-SPLTEST-006", "S840D-SPLTEST-007"]:
        when |s| s.before.item != Item::None && !(s.before.low && s.inputs.answer) && !s.inputs.power_on
            => s.after.failed == s.before.left.is_zero() && s.after.left == s.before.left.tick()
                && (s.after.failed || s.after.item == s.before.item && s.after.low == (s.before.low || !s.inputs.answer));

    /// A test begins with the path of the NCK.
    path_first ["S840D-SPLTEST-007"]:
        when |s| s.before.item == Item::None && s.inputs.start && !s.inputs.power_on
            => s.outputs.nck && s.outputs.path && s.after.left == s.config.delay && !s.after.low;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-SPLTEST-007"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.drive == s.after.drive && s.outputs.path == (s.after.item == Item::Path);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let step = |item, drive| State {
        item,
        drive,
        low: false,
        left: config.delay,
        failed: false,
    };
    let running = state.item != Item::None && !inputs.power_on;
    let answered = running && state.low && inputs.answer;
    let after = match (running, answered, state.drive) {
        _ if inputs.power_on => State::INITIAL,
        (false, ..) if inputs.start => step(Item::Path, false),
        (false, ..) => state,
        (true, true, false) => step(state.item, true),
        (true, true, true) => match inputs.after(state.item) {
            Item::None => State::INITIAL,
            item => step(item, false),
        },
        (true, false, _) if state.left.is_zero() => State {
            failed: true,
            ..State::INITIAL
        },
        (true, false, _) => State {
            low: state.low || !inputs.answer,
            left: state.left.tick(),
            ..state
        },
    };
    let outputs = Outputs {
        nck: after.item != Item::None && !after.drive,
        drive: after.drive,
        path: after.item == Item::Path,
        stop: match after.item {
            Item::None | Item::Path => ExternalStop::None,
            Item::A => ExternalStop::A,
            Item::C => ExternalStop::C,
            Item::D => ExternalStop::D,
            Item::E => ExternalStop::E,
        },
        passed: answered && after.item == Item::None,
    };
    (after, outputs)
}
