//! Filter of one fail-safe input against test pulses of the output that feeds it (p9651, p10017).
//!
//! The input changes when its terminal has had the other level for longer than the filter time. A pulse that is not longer
//! changes nothing.

use crate::kernel::{Cycles, DurationTooLong};
use core::num::NonZeroU32;

config! {
    /// The filter time in cycles; 0: none.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) time: Cycles,
    } accepted |_config| true
}

impl Config {
    /// `time`: the longest pulse, in cycles, that is no change.
    pub const fn new(time: Cycles) -> Self {
        Self { time }
    }

    /// A time in microseconds, first rounded up to whole milliseconds, then to whole cycles: no filter is shorter than it was
    /// set (S120-FDI-505).
    ///
    /// # Errors
    /// [`DurationTooLong`] when 32 bits do not hold it.
    pub const fn from_micros(micros: u32, cycle_us: NonZeroU32) -> Result<Self, DurationTooLong> {
        match Cycles::from_millis_up(micros.div_ceil(1000), cycle_us) {
            Ok(time) => Ok(Self { time }),
            Err(error) => Err(error),
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The filtered level.
        pub level: bool,
        /// For how many cycles the terminal has had the other one.
        pub other: Cycles,
    }
}

impl State {
    /// Low: selected, which is the safe state (S120-CTRL-504).
    pub const INITIAL: Self = Self {
        level: false,
        other: Cycles::ZERO,
    };

    /// A terminal that has had the other level for longer is not waited for.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.other <= config.time
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The level at the terminal.
        pub terminal: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The filtered level.
        pub level: bool,
    }
}

monitor! { sinamics::input_filter;
    /// The level changes only to that of the terminal, and only when the terminal has had it for longer than the time.
    short_pulses_change_nothing ["S120-CTRL-516", "S120-FDI-505"]:
        when |s| s.outputs.level != s.before.level
            => s.outputs.level == s.inputs.terminal && s.before.other == s.config.time;

    /// A level that lasts longer than the time is taken over in the next cycle.
    lasting_level_is_taken_over ["S120-CTRL-516", "S120-FDI-505"]:
        when |s| s.inputs.terminal != s.before.level && s.before.other == s.config.time
            => s.outputs.level == s.inputs.terminal;

    /// The cycles with the other level are counted from the first one in a row.
    row_is_counted ["S120-CTRL-516"]:
        when |s| s.outputs.level == s.before.level
            => s.after.other == if s.inputs.terminal == s.before.level {
                Cycles::ZERO
            } else {
                Cycles::new(s.before.other.count().saturating_add(1))
            };

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S120-CTRL-516"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.level == s.after.level;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = if inputs.terminal == state.level {
        State {
            other: Cycles::ZERO,
            ..state
        }
    } else if state.other >= config.time {
        State {
            level: inputs.terminal,
            other: Cycles::ZERO,
        }
    } else {
        State {
            other: Cycles::new(state.other.count().saturating_add(1)),
            ..state
        }
    };
    let outputs = Outputs { level: after.level };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-FDI-505, S120-CTRL-516: a filter of 1.2 ms is one of 2 ms, and a test pulse of 2 ms passes it by.
    #[test]
    fn a_filter_is_never_shorter_than_it_was_set() {
        let cycle = NonZeroU32::new(1_000).expect("not zero");
        let config = Config::from_micros(1_200, cycle).expect("short");
        assert_eq!(config, Config::new(Cycles::new(2)));
        let mut filter = Monitor::new(config);
        let mut step = |terminal| filter.step(&Inputs { terminal }).level;
        assert!([true; 3].map(&mut step).ends_with(&[false, true]));
        assert_eq!([false, false, true].map(&mut step), [true; 3]);
        assert_eq!([false; 3].map(&mut step), [true, true, false]);
    }
}
