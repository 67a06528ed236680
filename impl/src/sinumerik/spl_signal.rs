//! One signal of the safe logic in the comparison of NCK-SPL and PLC-SPL, as one channel makes it (machine `spl_signal`).
//!
//! Each of the 320 signals has a monitor of its own in each channel: the clock of one signal knows nothing of the others, so a
//! contract over one of them is a contract over all (see [`crate::sinumerik::spl`], which steps them, and
//! [`crate::sinumerik::spl_comparison`], which makes the alarm and the stop of what they find).
//!
//! A difference is found in the first cycle that lies more than the discrepancy time after the one in which it appeared. The time
//! is 1 s, or 10 s in the cycles in which `CMDSI` of this channel is 1: a difference that has lasted for longer than 1 s is
//! found when `CMDSI` returns to 0.
//!
//! Readings: B-02 CMDSI_OWN, B-03 DISC_CONT, B-39 CMDSI_DYNAMIC.

use core::num::NonZeroU32;

use crate::kernel::{ConfigError, Cycles, DurationTooLong};
use crate::sinumerik::relay::ONE_SECOND;

config! {
    /// How long a signal may differ.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        plain: Cycles,
        extended: Cycles,
    }
}

impl Config {
    /// `plain`: one second, `extended`: ten, both in whole cycles of the comparison (S840D-SPLKDV-001). Halves that are one cycle of
    /// each apart are no difference that lasts as long (S840D-TIMING-703/c).
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] without a time, [`ConfigError::DelayTooLong`] for more cycles than the times have in the
    /// shortest cycle, [`ConfigError::LimitsCrossed`] where the extended time is the shorter one.
    pub const fn new(plain: Cycles, extended: Cycles) -> Result<Self, ConfigError> {
        if plain.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        if plain.count() > ONE_SECOND.count() || extended.count() > Cycles::TEN_SECONDS.count() {
            return Err(ConfigError::DelayTooLong);
        }
        if extended.count() < plain.count() {
            return Err(ConfigError::LimitsCrossed);
        }
        Ok(Self { plain, extended })
    }

    /// The times for a cycle of `cycle_us` microseconds, rounded down: a difference of one cycle more is longer than the time,
    /// one of as many cycles may not be (S840D-SPLKDV-001, S840D-SPLKDV-002).
    ///
    /// # Errors
    /// Those of [`Config::new`]: the cycle is longer than a second or shorter than 31.25 us.
    pub const fn of_cycle(cycle_us: NonZeroU32) -> Result<Self, ConfigError> {
        match (
            Cycles::from_millis_down(1_000, cycle_us),
            Cycles::from_millis_down(10_000, cycle_us),
        ) {
            (Ok(plain), Ok(extended)) => Self::new(plain, extended),
            (Err(DurationTooLong), _) | (_, Err(DurationTooLong)) => Err(ConfigError::DelayTooLong),
        }
    }

    /// The time without `CMDSI`.
    pub const fn plain(&self) -> Cycles {
        self.plain
    }

    /// The time with `CMDSI`.
    pub const fn extended(&self) -> Cycles {
        self.extended
    }

    /// What must be left of the extended time so that the time in force is not over.
    const fn reserve(&self, cmd: bool) -> Cycles {
        if cmd {
            Cycles::ZERO
        } else {
            Cycles::new(self.extended.count().saturating_sub(self.plain.count()))
        }
    }
}

fields! {
    /// What is known of the signal.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// Both channels have the same.
        #[default]
        Equal,
        /// They differ, not for too long yet.
        Differs,
        /// They have differed for too long, and nobody has acknowledged it.
        Found,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is known of the signal.
        pub phase: Phase,
        /// What is left of the extended time in `Differs`, else 0.
        pub left: Cycles,
    }
}

impl State {
    /// Nothing compared.
    pub const INITIAL: Self = Self {
        phase: Phase::Equal,
        left: Cycles::ZERO,
    };

    /// A difference has no more than the whole time left, and what does not differ none.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.extended && (self.phase == Phase::Differs || self.left.is_zero())
    }

    /// A comparison that begins now.
    const fn fresh(config: &Config, differs: bool) -> Self {
        if differs {
            Self {
                phase: Phase::Differs,
                left: config.extended,
            }
        } else {
            Self::INITIAL
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of the control.
        pub power_on: bool,
        /// NC-RESET.
        pub reset: bool,
        /// The comparison has been started.
        pub running: bool,
        /// The signal in this channel.
        pub own: bool,
        /// The signal of the other channel as this one has it.
        pub other: bool,
        /// `CMDSI` of this channel.
        pub cmd: bool,
    }
}

impl Inputs {
    const fn differs(&self) -> bool {
        self.own != self.other
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The signal differs now: its bit of `SPL_DELTA` (S840D-SPLKDV-010).
        pub unequal: bool,
        /// It has become an error in this cycle.
        pub found: bool,
        /// It is an error that nobody has acknowledged.
        pub error: bool,
    }
}

monitor! { sinumerik::spl_signal;
    /// A difference is an error exactly when it has lasted for longer than the time in force now.
    error_exactly_beyond_the_time ["S840D-SPLKDV-001", "S840D-SPLKDV-002", "S840D-SPLKDV-013", "S840D-SPLKDV-019",
        "S840D-TIMING-701", "S840D-KDV-727"]:
        when |s| s.before.phase == Phase::Differs && s.inputs.differs() && s.inputs.running && !s.inputs.power_on
            => {
                // In whole numbers of 64 bits: how long it has lasted in this cycle.
                let lasted = u64::from(s.config.extended.count()) - u64::from(s.before.left.count()) + 1;
                let limit = if s.inputs.cmd { s.config.extended } else { s.config.plain };
                s.outputs.found == (lasted > u64::from(limit.count()))
            };

    /// A difference that is no error yet has one cycle less left; RESET gives it no more.
    difference_uses_its_time_up ["S840D-SPLKDV-001", "S840D-SPLKDV-011", "S840D-SPL-015"]:
        when |s| s.before.phase == Phase::Differs && s.after.phase == Phase::Differs && s.inputs.running && !s.inputs.power_on
            => s.before.left > s.after.left && s.after.left == s.before.left.tick();

    /// What appears in a cycle has the whole time, whatever was before.
    difference_begins_whole ["S840D-SPLKDV-001", "S840D-SPLKDV-016"]:
        when |s| s.before.phase == Phase::Equal && s.inputs.differs() && s.inputs.running && !s.inputs.power_on
            => s.after == (State { phase: Phase::Differs, left: s.config.extended }) && !s.outputs.found;

    /// Signals that are equal again end the time of a difference.
    equality_ends_the_time ["S840D-SPLKDV-016"]:
        when |s| !s.inputs.differs() && s.before.phase != Phase::Found
            => s.after == State::INITIAL && !s.outputs.found;

    /// An error stays until RESET, also when the signals have become equal.
    error_stays ["S840D-SPLKDV-011"]:
        when |s| s.before.phase == Phase::Found && s.inputs.running && !s.inputs.power_on && !s.inputs.reset
            => s.outputs.error && !s.outputs.found;

    /// After RESET what still differs has a new time.
    reset_begins_anew ["S840D-SPLKDV-011"]:
        when |s| s.before.phase == Phase::Found && s.inputs.running && s.inputs.reset
            => !s.outputs.error && (s.after.phase == Phase::Differs) == s.inputs.differs()
                && (!s.inputs.differs() || s.after.left == s.config.extended);

    /// Before the comparison runs nothing is an error, and no time passes.
    nothing_before_the_start ["S840D-SPLKDV-015"]:
        when |s| !s.inputs.running
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// Power-on forgets every difference and every error.
    power_on_begins_anew ["S840D-SPLKDV-015"]:
        when |s| s.inputs.power_on
            => !s.outputs.error && (s.after.phase == Phase::Equal || s.after.left == s.config.extended);

    /// The bit of the signal shows the present difference, whether it is an error or not.
    delta_shows_the_present ["S840D-SPLKDV-010"]:
        when |s| s.inputs.running
            => s.outputs.unequal == (s.inputs.own != s.inputs.other);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-SPLKDV-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.error == (s.after.phase == Phase::Found)
                && (!s.outputs.found || s.outputs.error);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let differs = inputs.running && inputs.differs();
    let known = if inputs.power_on || !inputs.running {
        Phase::Equal
    } else {
        state.phase
    };
    let (after, found) = match (known, differs) {
        (Phase::Found, _) if !inputs.reset => (
            State {
                phase: Phase::Found,
                left: Cycles::ZERO,
            },
            false,
        ),
        (Phase::Differs, true) if state.left <= config.reserve(inputs.cmd) => (
            State {
                phase: Phase::Found,
                left: Cycles::ZERO,
            },
            true,
        ),
        (Phase::Differs, true) => (
            State {
                phase: Phase::Differs,
                left: state.left.tick(),
            },
            false,
        ),
        _ => (State::fresh(config, differs), false),
    };
    let outputs = Outputs {
        unequal: differs,
        found,
        error: after.phase == Phase::Found,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(cycle_us: u32) -> Result<Config, ConfigError> {
        Config::of_cycle(NonZeroU32::new(cycle_us).expect("not 0"))
    }

    /// S840D-SPLKDV-001, S840D-SPLKDV-002: in a cycle of 12 ms a difference may last 83 cycles, 996 ms; with `CMDSI` 833.
    #[test]
    fn times_in_cycles() {
        let config = of(12_000).expect("a cycle");
        assert_eq!(config.plain(), Cycles::new(83));
        assert_eq!(config.extended(), Cycles::new(833));
        let config = of(8_000).expect("a cycle");
        assert_eq!(config.plain(), Cycles::new(125));
        assert_eq!(of(1_000_001), Err(ConfigError::NoDelay));
        assert_eq!(of(31), Err(ConfigError::DelayTooLong));
    }

    #[test]
    fn times_in_order() {
        let new = |plain, extended| Config::new(Cycles::new(plain), Cycles::new(extended));
        assert_eq!(new(0, 1), Err(ConfigError::NoDelay));
        assert_eq!(new(2, 1), Err(ConfigError::LimitsCrossed));
        assert_eq!(new(32_001, 320_000), Err(ConfigError::DelayTooLong));
        assert_eq!(new(1, 320_001), Err(ConfigError::DelayTooLong));
        assert!(new(32_000, 320_000).is_ok());
    }
}
