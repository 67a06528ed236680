//! Safe speed monitor (SSM) of one channel: whether the speed is below a limit. It stops nothing.
//!
//! With hysteresis the speed is a filtered one (p9501.16 switches on both): the filter, a first-order lag of p9545, comes before this
//! monitor. Without an encoder there is no speed once the pulses are suppressed: the answer is then 0, or frozen (p9509.0).

use crate::kernel::{ConfigError, Speed};

config! {
    /// The parameters; speeds in increments per cycle.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        limit: Speed,
        hysteresis: Option<Speed>,
        encoder: bool,
        frozen: bool,
    }
}

impl Config {
    /// `limit`: p9546; 0 switches SSM off. `hysteresis`: p9547 where p9501.16 is set. `encoder`: p9506 is 0 or 2. `frozen`: p9509.0
    /// is 0.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] when the hysteresis is above three quarters of the limit (S120-SSM-005).
    pub const fn new(
        limit: Speed,
        hysteresis: Option<Speed>,
        encoder: bool,
        frozen: bool,
    ) -> Result<Self, ConfigError> {
        if let Some(hysteresis) = hysteresis {
            if hysteresis.0 as u64 * 4 > limit.0 as u64 * 3 {
                return Err(ConfigError::ValueOutOfRange);
            }
        }
        Ok(Self {
            limit,
            hysteresis,
            encoder,
            frozen,
        })
    }

    /// Whether the slip tolerance p9549 of synchronised channels fits the hysteresis (S120-SSM-005, S120-SSM-004).
    pub fn fits_slip(&self, slip: Speed) -> bool {
        self.hysteresis.is_none_or(|hysteresis| slip <= hysteresis)
    }

    /// Whether both channels give the same answer in spite of a difference of their speeds: it is within the hysteresis and
    /// within what is left of the limit below it (S120-SSM-004, the printed and the safe reading together).
    pub fn channels_agree(&self, difference: Speed) -> bool {
        self.hysteresis.is_none_or(|hysteresis| {
            difference <= hysteresis && difference.0 <= self.limit.0.saturating_sub(hysteresis.0)
        })
    }

    /// SSM is switched on (S120-SSM-001).
    pub const fn on(&self) -> bool {
        self.limit.0 > 0
    }

    /// From 0 to 1 the speed must be below this: p9546, less p9547.
    fn lower(&self) -> Speed {
        // The hysteresis is at most the limit.
        Speed(
            self.limit
                .0
                .saturating_sub(self.hysteresis.unwrap_or(Speed(0)).0),
        )
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The last answer.
        pub below: bool,
    }
}

impl State {
    /// Not known to be below.
    pub const INITIAL: Self = Self { below: false };

    /// A monitor that is off has no answer.
    pub fn invariant(&self, config: &Config) -> bool {
        config.on() || !self.below
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Magnitude of the actual speed, filtered where there is a hysteresis.
        pub speed: Speed,
        /// The pulses are enabled.
        pub pulses: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The speed is below the limit (r9722.15, S_ZSW.15).
        pub below: bool,
        /// SSM counts as an active monitoring function: STOP F is followed by STOP B.
        pub counts: bool,
    }
}

/// The speed is known: there is an encoder, or the drive is fed.
fn known(s: &Step) -> bool {
    s.config.on() && (s.config.encoder || s.inputs.pulses)
}

monitor! { sinamics::ssm;
    /// At the limit and above it the answer is 0, with and without hysteresis.
    limit_is_not_below ["S120-SSM-002", "S120-SSM-003", "S120-PF-19"]:
        when |s| known(&s) && s.inputs.speed >= s.config.limit
            => !s.outputs.below;

    /// Without hysteresis it is 1 below the limit.
    below_without_hysteresis ["S120-SSM-002"]:
        when |s| known(&s) && s.config.hysteresis.is_none() && s.inputs.speed < s.config.limit
            => s.outputs.below;

    /// With it the answer becomes 1 below p9546 - p9547, and nowhere else.
    rise_wants_the_hysteresis ["S120-SSM-003", "S120-PF-19"]:
        when |s| known(&s) && !s.before.below
            => match s.config.hysteresis {
                Some(hysteresis) => s.outputs.below
                    == (u64::from(s.inputs.speed.0) + u64::from(hysteresis.0) < u64::from(s.config.limit.0)),
                None => s.outputs.below == (s.inputs.speed < s.config.limit),
            };

    /// Between the two it is what it was.
    hysteresis_holds ["S120-SSM-003", "S120-PF-19"]:
        when |s| known(&s) && s.before.below && s.inputs.speed < s.config.limit
            => s.outputs.below;

    /// Without encoder and pulses p9509.0 says what it is: frozen, or 0.
    nothing_is_known_without_pulses ["S120-SSM-008", "S120-SSM-009", "S120-SSM-010"]:
        when |s| s.config.on() && !known(&s)
            => s.outputs.below == (s.config.frozen && s.before.below);

    /// A new enable of the pulses brings the monitoring back by itself.
    pulses_bring_it_back ["S120-SSM-010"]:
        when |s| s.config.on() && !s.config.encoder && s.inputs.pulses && s.inputs.speed == Speed(0)
            => s.outputs.below;

    /// A limit of 0 switches SSM off.
    no_limit_is_off ["S120-SSM-001"]:
        when |s| s.config.limit == Speed(0)
            => s.outputs == Outputs::default();

    /// SSM counts as a monitoring function exactly with hysteresis.
    counts_with_hysteresis ["S120-SSM-006"]:
        when |s| s.config.on()
            => s.outputs.counts == s.config.hysteresis.is_some();

    /// The hysteresis is at most three quarters of the limit.
    hysteresis_fits ["S120-SSM-005"]:
        when |s| s.config.hysteresis.is_some()
            => s.config.hysteresis.is_some_and(|hysteresis| u64::from(hysteresis.0) * 4 <= u64::from(s.config.limit.0) * 3);

    /// The state stays consistent.
    state_stays_consistent ["S120-SSM-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.below == s.outputs.below;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let below = if !config.on() {
        false
    } else if !config.encoder && !inputs.pulses {
        config.frozen && state.below
    } else if state.below {
        inputs.speed < config.limit
    } else {
        inputs.speed < config.lower()
    };
    let outputs = Outputs {
        below,
        counts: config.on() && config.hysteresis.is_some(),
    };
    (State { below }, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-SSM-003 with p9546 = 20 and p9547 = 10 (Table A-5); S120-SSM-002, Table 5-8: the limit itself is not below it.
    #[test]
    fn the_printed_limits() {
        let config = Config::new(Speed(20), Some(Speed(10)), true, false).expect("accepted");
        let mut monitor = Monitor::new(config);
        let mut below = |speed| {
            let inputs = Inputs {
                speed: Speed(speed),
                pulses: true,
            };
            monitor.step(&inputs).below
        };
        let answers = [9, 10, 19, 20, 19, 10, 9].map(&mut below);
        assert_eq!(answers, [true, true, true, false, false, false, true]);
    }

    /// S120-SSM-005, S120-SSM-004: 15 of 20 is the greatest hysteresis.
    #[test]
    fn the_hysteresis_has_its_rules() {
        let new = |hysteresis| Config::new(Speed(20), Some(Speed(hysteresis)), true, false);
        assert_eq!(new(16), Err(ConfigError::ValueOutOfRange));
        let config = new(15).expect("accepted");
        assert!(config.fits_slip(Speed(15)) && !config.fits_slip(Speed(16)));
        assert!(config.channels_agree(Speed(5)) && !config.channels_agree(Speed(6)));
    }
}
