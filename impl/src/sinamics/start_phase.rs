//! The start phase of a drive without encoder: from the pulses until its actual value is evaluated (p9586).
//!
//! While the motor is magnetised the currents say nothing of the speed. So for p9586 after the pulses have come nothing is evaluated: SLS
//! and SDI find nothing, and a value that is not plausible is no message. After it an implausible value is a STOP F (C01711 with 1040 and
//! higher). Pulses that are suppressed meanwhile begin all of it again.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        delay: Cycles,
    }
}

/// The longest p9586: 600 s at the shortest p9500, 500 us.
const LONGEST: Cycles = Cycles::new(1_200_000);

impl Config {
    /// `delay`: p9586; 0 evaluates from the first cycle on.
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] above 600 s.
    pub fn new(delay: Cycles) -> Result<Self, ConfigError> {
        Ok(Self {
            delay: delay.at_most(LONGEST)?,
        })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The pulses are enabled.
        pub enabled: bool,
        /// What is left of p9586.
        pub left: Cycles,
    }
}

impl State {
    /// POWER ON: no pulses.
    pub const INITIAL: Self = Self {
        enabled: false,
        left: Cycles::ZERO,
    };

    /// The time runs under pulses only.
    pub fn invariant(&self, config: &Config) -> bool {
        self.left <= config.delay && (self.enabled || self.left.is_zero())
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The pulses are enabled.
        pub pulses: bool,
        /// Current and voltage agree on an actual value.
        pub plausible: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// There is an actual value for SLS and SDI to monitor.
        pub known: bool,
        /// STOP F: the actual value is not plausible.
        pub stop_f: bool,
    }
}

monitor! { sinamics::start_phase;
    /// The pulses begin the whole time.
    pulses_begin_the_delay ["S120-TIMING-507"]:
        when |s| s.inputs.pulses && !s.before.enabled
            => s.after.left == s.config.delay && s.outputs.known == s.config.delay.is_zero();

    /// It runs to its end while they stay.
    delay_has_an_end ["S120-TIMING-507"]:
        when |s| s.inputs.pulses && s.before.enabled && s.before.left > Cycles::ZERO
            => s.after.left.count() + 1 == s.before.left.count() && s.outputs.known == s.after.left.is_zero();

    /// From then on the actual value is evaluated in each cycle.
    evaluated_from_then_on ["S120-TIMING-507"]:
        when |s| s.inputs.pulses && s.before.enabled && s.before.left.is_zero()
            => s.outputs.known && s.after == s.before;

    /// Without pulses there is none, and nothing is left of the time.
    nothing_without_pulses ["S120-TIMING-507", "S120-ENC-005"]:
        when |s| !s.inputs.pulses
            => s.outputs == Outputs::default() && s.after == State::INITIAL;

    /// A value that is evaluated and not plausible is STOP F in the same cycle.
    wrong_value_is_stop_f ["S120-ENC-005", "S120-TIMING-507"]:
        when |s| s.outputs.known && !s.inputs.plausible
            => s.outputs.stop_f;

    /// Nothing else is: neither a plausible value nor what the start phase hides.
    nothing_else_is_told ["S120-ENC-005", "S120-TIMING-507"]:
        when |s| s.inputs.plausible || !s.outputs.known
            => !s.outputs.stop_f;

    /// The state stays consistent.
    state_stays_consistent ["S120-TIMING-507"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.enabled == s.inputs.pulses;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if !inputs.pulses {
        return (State::INITIAL, Outputs::default());
    }
    let left = if state.enabled {
        state.left.tick()
    } else {
        config.delay
    };
    let known = left.is_zero();
    let after = State {
        enabled: true,
        left,
    };
    let outputs = Outputs {
        known,
        stop_f: known && !inputs.plausible,
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-TIMING-507: p9586 = 100 ms (Table A-5) at p9500 = 12 ms; a start that is broken off counts for nothing.
    #[test]
    fn start_phase_of_100_ms() {
        let cycle = core::num::NonZeroU32::new(12_000).expect("not zero");
        let delay = Cycles::from_millis_up(100, cycle).expect("short");
        let mut monitor = Monitor::new(Config::new(delay).expect("short"));
        let run = Inputs {
            pulses: true,
            plausible: false,
        };
        for _ in 0..5 {
            assert_eq!(monitor.step(&run), Outputs::default());
        }
        assert_eq!(monitor.step(&Inputs::default()), Outputs::default());
        for _ in 0..9 {
            assert_eq!(monitor.step(&run), Outputs::default());
        }
        let outputs = monitor.step(&run);
        assert!(outputs.known && outputs.stop_f);
    }
}
