//! Which limit SLS monitors: requests, and how they take effect. No step of its own.

use super::{Config, Inputs, Phase, State};
use crate::kernel::{Cycles, Speed};

fields! {
    /// A level of SLS as its two bits give it: 0 is SLS1, 3 is SLS4 (S120-SLS-006).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub struct Level(u8) in 0..=3;
}

impl Level {
    /// SLS1: parameters with index 0.
    pub const FIRST: Self = Self(0);

    /// The level of the bits 10 and 9 of a control word (S120-SLS-006).
    pub const fn from_bits(bit1: bool, bit0: bool) -> Self {
        Self((bit1 as u8) << 1 | bit0 as u8)
    }

    /// The index of its parameters, 0 to 3.
    pub const fn index(self) -> u8 {
        self.0
    }

    /// The one of four parameters that belongs to the level.
    pub(in crate::sinamics) const fn of<T: Copy>(
        self,
        [first, second, third, fourth]: [T; 4],
    ) -> T {
        match self.0 {
            0 => first,
            1 => second,
            2 => third,
            _ => fourth,
        }
    }
}

fields! {
    /// Reading AF-30: what a further change does while a lower limit waits.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Slsd {
        /// A still lower limit takes the place of the waiting one, whose delay goes on.
        #[default]
        Keep,
        /// It restarts the delay: limits that go down again and again keep the old one for ever.
        Restart,
    }
}

fields! {
    /// A level with its limit.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Request {
        /// The level.
        pub level: Level,
        /// Its limit, in increments per cycle.
        pub limit: Speed,
    }
}

impl Request {
    /// None: the first level with limit 0.
    pub const NONE: Self = Self {
        level: Level::FIRST,
        limit: Speed(0),
    };
}

/// The denominator of the limit in a telegram: 100 % (S120-SLS-009).
pub(in crate::sinamics) const WHOLE: u64 = 32_767;

/// The limit of a telegram, rounded down; none where the value is outside 1 to 32767 (S120-SLS-009).
pub(super) const fn of_telegram(value: i16, first: Speed) -> Option<Speed> {
    if value < 1 {
        return None;
    }
    // At most the limit itself, since the value is at most the whole.
    Some(Speed((first.0 as u64 * value as u64 / WHOLE) as u32))
}

/// A level with its limit as a parameter, or with the part of it that a telegram gives; and whether the telegram's value is wrong: then
/// no limit but 0 is safe.
pub(in crate::sinamics) const fn asked(
    parameter: Request,
    by_telegram: bool,
    telegram: i16,
) -> (Request, bool) {
    if !by_telegram || parameter.level.0 != Level::FIRST.0 {
        return (parameter, false);
    }
    match of_telegram(telegram, parameter.limit) {
        Some(limit) => (
            Request {
                level: parameter.level,
                limit,
            },
            false,
        ),
        None => (Request::NONE, true),
    }
}

/// What is asked for, and whether the telegram's value is wrong.
pub(super) fn request(config: &Config, inputs: &Inputs) -> (Request, bool) {
    let level = if config.unselected {
        Level::FIRST
    } else {
        inputs.level
    };
    let parameter = Request {
        level,
        limit: config.limit(level),
    };
    let by_telegram = config.by_telegram && !config.unselected;
    asked(parameter, by_telegram, inputs.telegram)
}

/// The state after a cycle in which this is asked for.
pub(super) fn next(state: &State, config: &Config, request: Request) -> State {
    let active = State {
        phase: Phase::Active,
        left: Cycles::ZERO,
        now: request,
        next: Request::NONE,
    };
    if config.unselected {
        return active;
    }
    let restarts = match state.phase {
        Phase::Idle => true,
        Phase::Delay => false,
        _ if request.limit >= state.now.limit => return active,
        Phase::Active => true,
        Phase::Lower => config.slsd == Slsd::Restart && request.limit < state.next.limit,
    };
    let left = if restarts {
        config.delay
    } else {
        state.left.tick()
    };
    if left.is_zero() {
        return active;
    }
    match state.phase {
        Phase::Idle | Phase::Delay => State {
            phase: Phase::Delay,
            left,
            now: Request::NONE,
            next: Request::NONE,
        },
        Phase::Active | Phase::Lower => State {
            phase: Phase::Lower,
            left,
            now: state.now,
            next: request,
        },
    }
}
