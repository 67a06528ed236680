//! Cross-check of the channels, in one of them: the results of both, and what else says that a channel is defective. What it finds is
//! STOP F with C01711.
//!
//! A channel hears of the other one a cycle later, and samples its inputs apart from it: results may differ for less than a time.
//! What a monitor of this channel finds of itself needs no comparison.

use crate::kernel::{ConfigError, Cycles};
use crate::sinamics::level::{Function, Stop};

config! {
    /// The parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) apart: Cycles,
    }
}

impl Config {
    /// `apart`: so many cycles of different results are a defect.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] when it is 0: the channels would have to be equal in each cycle.
    pub const fn new(apart: Cycles) -> Result<Self, ConfigError> {
        if apart.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self { apart })
    }
}

fields! {
    /// What a channel tells the other one of itself: its stop, what runs and monitors, level and gear stage (S120-CTRL-503). Numbers with a
    /// tolerance, positions and speeds, are compared elsewhere.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Results {
        /// The latched stop.
        pub stop: Stop,
        /// The function that decides.
        pub function: Function,
        /// SOS monitors.
        pub sos: bool,
        /// SLS monitors.
        pub sls: bool,
        /// Its level, 0 to 3.
        pub sls_level: u8,
        /// SDI monitors: positive and negative.
        pub sdi: [bool; 2],
        /// SLP monitors.
        pub slp: bool,
        /// The gear stage.
        pub stage: u8,
    }
}

fields! {
    /// What is defective.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Defect {
        /// Nothing was found yet.
        #[default]
        None,
        /// The channels differ.
        Channels,
        /// The tolerance of the gear is increased for too long.
        Gear,
        /// The position does not fit 16 bits.
        Wide,
        /// Without encoder the actual value is not plausible.
        Implausible,
    }
}

impl Defect {
    /// The value of C01711 that the manual prints; 0 where it prints none.
    pub const fn value(self) -> u16 {
        match self {
            Self::None | Self::Channels => 0,
            Self::Gear => 1_015,
            Self::Wide => 7_001,
            Self::Implausible => 1_040,
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// For so many cycles the results have differed, at most the time.
        pub since: Cycles,
        /// What was found last.
        pub defect: Defect,
    }
}

impl State {
    /// The results are equal.
    pub const INITIAL: Self = Self {
        since: Cycles::ZERO,
        defect: Defect::None,
    };

    /// The time ends.
    pub fn invariant(&self, config: &Config) -> bool {
        self.since <= config.apart
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// POWER ON.
        pub power_on: bool,
        /// The tolerance time of the terminals runs: what depends on them is not compared (S120-CTRL-507).
        pub tolerated: bool,
        /// The results of this channel in the cycle before.
        pub own: Results,
        /// Those of the other one.
        pub other: Results,
        /// The actual values of the channels have come too far apart ([`crate::sinamics::actual_value`]).
        pub values_apart: bool,
        /// The tolerance of the gear is increased for too long ([`crate::sinamics::gear`]).
        pub gear_too_long: bool,
        /// The transferred position does not fit 16 bits ([`crate::sinamics::safe_position`]).
        pub too_wide: bool,
        /// Without encoder the actual value is not plausible ([`crate::sinamics::start_phase`]).
        pub implausible: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// A defect is found in this cycle: STOP F.
        pub found: bool,
        /// What was found last.
        pub defect: Defect,
        /// Its value of C01711.
        pub value: u16,
    }
}

/// A monitor of this channel finds a defect, whatever the other one tells.
pub(crate) const fn alone(s: &Inputs) -> bool {
    s.values_apart || s.gear_too_long || s.too_wide || s.implausible
}

/// The results of the channels are not the same, and nothing says that they may differ.
fn counts(s: &Inputs) -> bool {
    differ(s) && !s.tolerated && !s.power_on
}

/// The results of the channels are not the same.
fn differ(s: &Inputs) -> bool {
    let (own, other) = (&s.own, &s.other);
    own.stop != other.stop
        || own.function != other.function
        || own.sos != other.sos
        || own.sls != other.sls
        || own.sls_level != other.sls_level
        || own.sdi[0] != other.sdi[0]
        || own.sdi[1] != other.sdi[1]
        || own.slp != other.slp
        || own.stage != other.stage
}

monitor! { sinamics::cross_check;
    /// Results that have differed for the time are a defect of the channels, whichever result it is.
    difference_is_found ["S120-CTRL-503", "S120-STOP-505", "S120-PF-27"]:
        when |s| counts(&s.inputs) && s.after.since == s.config.apart
            => s.outputs.found && s.outputs.defect == Defect::Channels;

    /// Each cycle of a difference counts, up to the time.
    difference_counts ["S120-STOP-505"]:
        when |s| counts(&s.inputs) && s.before.since < s.config.apart
            => s.after.since.count() == s.before.since.count() + 1;

    /// Equal results begin the time anew: channels that are apart by a cycle are no defect.
    agreement_begins_anew ["S120-CTRL-503"]:
        when |s| !differ(&s.inputs) || s.inputs.power_on
            => s.after.since.is_zero();

    /// So does the tolerance time of the terminals, in which one channel stops and the other one does not.
    tolerance_compares_nothing ["S120-CTRL-507"]:
        when |s| s.inputs.tolerated
            => s.after.since.is_zero() && (s.outputs.found == alone(&s.inputs));

    /// What a monitor of this channel finds acts at once.
    own_finding_acts_at_once ["S120-STOP-505", "S120-GEAR-004", "S120-SP-005"]:
        when |s| alone(&s.inputs)
            => s.outputs.found;

    /// Nothing is found without a cause.
    nothing_is_found_without_a_cause ["S120-STOP-505"]:
        when |s| s.outputs.found
            => alone(&s.inputs) || counts(&s.inputs) && s.after.since == s.config.apart;

    /// The defect says what it was, and stays until another one is found.
    defect_is_told ["S120-GEAR-004", "S120-SP-005"]:
        when |s| s.outputs.found || !s.inputs.power_on
            => s.outputs.defect == s.after.defect && s.outputs.value == s.after.defect.value()
                && if s.outputs.found {
                    match s.outputs.defect {
                        Defect::None => false,
                        Defect::Channels => s.inputs.values_apart || s.after.since == s.config.apart,
                        Defect::Gear => s.inputs.gear_too_long,
                        Defect::Wide => s.inputs.too_wide,
                        Defect::Implausible => s.inputs.implausible,
                    }
                } else {
                    s.outputs.defect == s.before.defect
                };

    /// A difference of the channels is told before all others.
    channels_come_first ["S120-STOP-505"]:
        when |s| s.inputs.values_apart
            => s.outputs.defect == Defect::Channels;

    /// The state stays consistent.
    state_stays_consistent ["S120-STOP-505"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let since = if inputs.own != inputs.other && !inputs.tolerated && !inputs.power_on {
        Cycles::new(before.since.count().saturating_add(1)).min(config.apart)
    } else {
        Cycles::ZERO
    };
    let found = if since == config.apart || inputs.values_apart {
        Defect::Channels
    } else if inputs.gear_too_long {
        Defect::Gear
    } else if inputs.too_wide {
        Defect::Wide
    } else if inputs.implausible {
        Defect::Implausible
    } else {
        Defect::None
    };
    let defect = match found {
        Defect::None => before.defect,
        found => found,
    };
    let outputs = Outputs {
        found: found != Defect::None,
        defect,
        value: defect.value(),
    };
    (State { since, defect }, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S120-CTRL-503, S120-STOP-505: two cycles apart are none, three are; each result counts. S120-CTRL-507: none while terminals may
    /// differ.
    #[test]
    fn each_result_counts_after_the_time() {
        let none = Results::default();
        let others = [
            Results {
                stop: Stop::E,
                ..none
            },
            Results {
                function: Function::Sos,
                ..none
            },
            Results { sos: true, ..none },
            Results { sls: true, ..none },
            Results {
                sls_level: 1,
                ..none
            },
            Results {
                sdi: [true, false],
                ..none
            },
            Results {
                sdi: [false, true],
                ..none
            },
            Results { slp: true, ..none },
            Results { stage: 1, ..none },
        ];
        for other in others {
            let config = Config::new(Cycles::new(3)).expect("accepted");
            let mut check = Monitor::new(config);
            let mut found = |other| {
                let inputs = Inputs {
                    other,
                    ..Inputs::default()
                };
                check.step(&inputs).found
            };
            let courses = [other, other, none, other, other, other, other, none].map(&mut found);
            assert_eq!(
                courses,
                [false, false, false, false, false, true, true, false],
                "{other:?}"
            );
            let tolerated = Inputs {
                tolerated: true,
                other,
                ..Inputs::default()
            };
            assert!((0..9).all(|_| !check.step(&tolerated).found));
        }
        assert_eq!(Config::new(Cycles::ZERO), Err(ConfigError::NoDelay));
    }
}
