//! Comparison of the actual values of both channels, in one of them: position difference, or slip of synchronised values.
//!
//! Both channels measure the same axis. Without synchronisation their positions may differ by p9542 since they were last aligned; with
//! it (p9501.3) both take the mean in each cross-check cycle, and what is compared is how far they came apart since: the slip, against
//! p9549. A step is one cross-check cycle (r9724). While a gear stage changes the tolerance is multiplied by p9543.

use crate::kernel::{ConfigError, Distance, Position};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        position: Distance,
        slip: Distance,
        synchronised: bool,
        factor: u16,
    }
}

impl Config {
    /// `position`: p9542. `slip`: p9549, as the way in a cross-check cycle. `synchronised`: p9501.3, which `absolute` excludes: SLP
    /// or a transferred position. `factor`: p9543, at least 1.
    ///
    /// # Errors
    /// [`ConfigError::FactorOutOfRange`] for a factor of 0.
    pub const fn new(
        position: Distance,
        slip: Distance,
        synchronised: bool,
        factor: u16,
    ) -> Result<Self, ConfigError> {
        if factor == 0 {
            return Err(ConfigError::FactorOutOfRange);
        }
        Ok(Self {
            position,
            slip,
            synchronised,
            factor,
        })
    }

    /// The same for a drive with SLP (p9501.1) or a transferred position (p9501.25), for which no position may be a mean.
    ///
    /// # Errors
    /// As [`Config::new`], and [`ConfigError::SynchronisationNotAllowed`] with synchronisation: F01688 (S120-SLP-002, S120-SP-002).
    pub const fn with_position(
        position: Distance,
        slip: Distance,
        synchronised: bool,
        factor: u16,
    ) -> Result<Self, ConfigError> {
        if synchronised {
            return Err(ConfigError::SynchronisationNotAllowed);
        }
        Self::new(position, slip, synchronised, factor)
    }

    /// By how far the channels may have come apart: exact.
    const fn tolerance(&self, raised: bool) -> u64 {
        let tolerance = if self.synchronised {
            self.slip
        } else {
            self.position
        };
        let factor = if raised { self.factor as u64 } else { 1 };
        tolerance.0 as u64 * factor
    }
}

fields! {
    /// The state between two cross-check cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The difference of both measurements, own less other, when they were last aligned.
        pub aligned: i64,
    }
}

/// The greatest difference of two positions.
const WIDEST: i64 = u32::MAX as i64;

impl State {
    /// Nothing to be taken off.
    pub const INITIAL: Self = Self { aligned: 0 };

    /// It is a difference of two positions.
    pub fn invariant(&self, _config: &Config) -> bool {
        (-WIDEST..=WIDEST).contains(&self.aligned)
    }
}

fields! {
    /// The inputs of one cross-check cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The measurement of this channel.
        pub own: Position,
        /// That of the other channel.
        pub other: Position,
        /// The increased tolerance is selected ([`crate::sinamics::gear`]).
        pub raised: bool,
        /// The gear stage has changed: align once.
        pub synchronise: bool,
    }
}

fields! {
    /// The outputs of one cross-check cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// How far the channels have come apart since they were aligned.
        pub apart: i64,
        /// More than tolerated: cross-check error, STOP F with C01711.
        pub exceeded: bool,
    }
}

/// The difference of the measurements of a step.
fn measured(inputs: &Inputs) -> i64 {
    i64::from(inputs.own.0) - i64::from(inputs.other.0)
}

monitor! { sinamics::actual_value;
    /// Channels that are further apart than p9542 are a cross-check error in the same cycle.
    position_is_compared ["S120-ENC-011", "S120-ENC-012"]:
        when |s| !s.config.synchronised && !s.inputs.raised && !s.inputs.synchronise
            => s.outputs.exceeded
                == (measured(&s.inputs) - s.before.aligned > i64::from(s.config.position.0)
                    || s.before.aligned - measured(&s.inputs) > i64::from(s.config.position.0));

    /// Synchronised, the slip of one cycle is compared with p9549.
    slip_is_compared ["S120-ENC-011", "S120-ENC-012"]:
        when |s| s.config.synchronised && !s.inputs.raised && !s.inputs.synchronise
            => s.outputs.exceeded
                == (measured(&s.inputs).abs_diff(s.before.aligned) > u64::from(s.config.slip.0));

    /// While a gear stage changes the tolerance is p9543 times as great.
    gear_raises_the_tolerance ["S120-GEAR-003"]:
        when |s| s.inputs.raised && !s.inputs.synchronise
            => s.outputs.exceeded == (measured(&s.inputs).abs_diff(s.before.aligned)
                > u64::from(if s.config.synchronised { s.config.slip } else { s.config.position }.0)
                    * u64::from(s.config.factor));

    /// Both channels find the same: it does not matter which one compares.
    comparison_is_even ["S120-ENC-011", "S120-PF-27"]:
        when |s| s.inputs.own != s.inputs.other
            => {
                let inputs = Inputs { own: s.inputs.other, other: s.inputs.own, ..s.inputs };
                let (after, outputs) = transition(State { aligned: -s.before.aligned }, &s.config, &inputs);
                outputs.exceeded == s.outputs.exceeded && outputs.apart == -s.outputs.apart
                    && after.aligned == -s.after.aligned
            };

    /// A change of the gear stage aligns them once: what it brought is forgotten.
    gear_change_aligns ["S120-GEAR-002", "S120-GEAR-003"]:
        when |s| s.inputs.synchronise
            => s.after.aligned == measured(&s.inputs) && !s.outputs.exceeded && s.outputs.apart == 0;

    /// Synchronised, each cycle does.
    each_cycle_aligns ["S120-ENC-011"]:
        when |s| s.config.synchronised && !s.inputs.raised
            => s.after.aligned == measured(&s.inputs);

    /// Without, and while the tolerance is increased, nothing else does.
    nothing_else_aligns ["S120-ENC-011", "S120-GEAR-003"]:
        when |s| (!s.config.synchronised || s.inputs.raised) && !s.inputs.synchronise
            => s.after.aligned == s.before.aligned;

    /// The state stays consistent.
    state_stays_consistent ["S120-ENC-011"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let difference = measured(inputs);
    let aligned = if inputs.synchronise {
        difference
    } else {
        state.aligned
    };
    let apart = difference.saturating_sub(aligned);
    let outputs = Outputs {
        apart,
        exceeded: apart.unsigned_abs() > config.tolerance(inputs.raised),
    };
    let aligns = config.synchronised && !inputs.raised;
    let after = State {
        aligned: if aligns { difference } else { aligned },
    };
    (after, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-ENC-011, S120-SLP-002, S120-SP-002: slow slip is tolerated by synchronised channels alone, which excludes SLP and SP.
    #[test]
    fn slip_adds_up_without_synchronisation() {
        for (synchronised, after) in [(false, true), (true, false)] {
            let (ten, four) = (Distance(10), Distance(4));
            let config = Config::new(ten, four, synchronised, 3).expect("accepted");
            let mut monitor = Monitor::new(config);
            let mut exceeded = |own| {
                let inputs = Inputs {
                    own: Position(own),
                    ..Inputs::default()
                };
                monitor.step(&inputs).exceeded
            };
            assert!(!exceeded(4) && !exceeded(8));
            assert_eq!(exceeded(12), after);
            let refused = Config::with_position(ten, four, synchronised, 3);
            assert_eq!(refused.is_err(), synchronised);
        }
    }
}
