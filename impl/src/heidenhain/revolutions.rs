//! Restricted spindle operation: the two revolutions that a spindle may turn with a door open.
//!
//! The angle counts from the activation of restricted operation, with its sign: what the spindle turns back does not add up.
//! More than the permitted angle raises SS1; the limit of 50 rpm is the business of [`crate::heidenhain::speed`].
//!
//! Recommended readings of the manual implemented here: AMB-32 AT_START.

use crate::heidenhain::types::{GroupState, Stop};
use crate::kernel::ConfigError;

config! {
    /// The limit.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        turns: i32,
    }
    accepted |config| u32::try_from(config.turns).is_ok_and(|turns| Config::new(turns).is_ok())
}

impl Config {
    /// `turns`: the permitted angle in increments, in either direction: two revolutions.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] when `turns` is 0 or needs more than 30 bits.
    pub const fn new(turns: u32) -> Result<Self, ConfigError> {
        if turns == 0 || turns >= 1 << 30 {
            Err(ConfigError::ValueOutOfRange)
        } else {
            Ok(Self {
                turns: turns as i32,
            })
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The angle turned in restricted operation, held at one increment beyond the permitted one; 0 outside.
        pub angle: i32,
    }
}

impl State {
    /// Nothing turned.
    pub const INITIAL: Self = Self { angle: 0 };

    /// The angle is held at one increment beyond the permitted one.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        -config.turns - 1 <= self.angle && self.angle <= config.turns + 1
    }

    /// Whether more than the permitted angle has been turned.
    pub const fn exceeds(&self, config: &Config) -> bool {
        self.angle.unsigned_abs() > config.turns.unsigned_abs()
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The monitoring state of the group of the spindle.
        pub state: GroupState,
        /// The angle turned since the last cycle, in increments, with its sign.
        pub step: i32,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::revolutions;
    /// The angle of the activation and everything turned since: further than permitted is stopped in the same cycle.
    too_far_is_stopped ["HFS-P-39", "HFS-MODE-013", "HFS-SLI-004"]:
        when |s| s.inputs.state == GroupState::SlsS
            && (s.before.angle as i64 + s.inputs.step as i64).abs() > s.config.turns as i64
            => s.outputs.demand == Stop::Ss1;

    /// Within the permitted angle the spindle turns freely, and what it turns back does not add up.
    permitted_angle_is_free ["HFS-MODE-013", "HFS-MODE-014"]:
        when |s| s.inputs.state == GroupState::SlsS
            && (s.before.angle as i64 + s.inputs.step as i64).abs() <= s.config.turns as i64
            => s.outputs.demand == Stop::None && s.after.angle as i64 == s.before.angle as i64 + s.inputs.step as i64;

    /// Outside restricted operation nothing is limited, and the next one counts from its own beginning.
    angle_counts_from_the_activation ["HFS-MODE-014"]:
        when |s| s.inputs.state != GroupState::SlsS
            => s.outputs.demand == Stop::None && s.after == State::INITIAL;

    /// The angle stays in its range.
    angle_is_held_at_the_ends ["HFS-MODE-013"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if inputs.state != GroupState::SlsS {
        return (State::INITIAL, Outputs::default());
    }
    // Two numbers of 32 bits have a sum of 33, and the ends of the range fit 31.
    let end = config.turns as i64 + 1;
    let sum = (state.angle as i64 + inputs.step as i64).max(-end).min(end);
    let after = State { angle: sum as i32 };
    let demand = if after.exceeds(config) {
        Stop::Ss1
    } else {
        Stop::None
    };
    (after, Outputs { demand })
}
