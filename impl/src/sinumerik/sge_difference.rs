//! Alarm 27004: one safety-related input that both channels see differently (machine `sge_difference`).
//!
//! The comparison itself raises STOP F through the results that follow from the input; this alarm names the input.

use crate::kernel::{ConfigError, Cycles};

/// The inputs that the alarm names, as its second parameter does (S840D-KDV-725).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// De-select safe operating stop and safely-reduced speed.
    OperatingStopAndSpeed,
    /// De-select safe operating stop.
    OperatingStop,
    /// Select safely-reduced speed.
    Speed,
    /// Select safe limit positions.
    LimitPositions,
    /// Select the correction of the speed.
    Correction,
}

impl Signal {
    /// Every one.
    pub const ALL: [Self; 5] = [
        Self::OperatingStopAndSpeed,
        Self::OperatingStop,
        Self::Speed,
        Self::LimitPositions,
        Self::Correction,
    ];

    /// What the alarm calls it.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::OperatingStopAndSpeed => "SS/SV",
            Self::OperatingStop => "SS",
            Self::Speed => "SV",
            Self::LimitPositions => "SP",
            Self::Correction => "SVOVR",
        }
    }
}

config! {
    /// The tolerance.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_chg: Cycles,
    }
}

impl Config {
    /// `t_chg`: for how long the channels may differ (MODE_SWITCH_TIME).
    ///
    /// # Errors
    /// [`ConfigError::DelayTooLong`] above [`Cycles::TEN_SECONDS`].
    pub fn new(t_chg: Cycles) -> Result<Self, ConfigError> {
        Ok(Self {
            t_chg: t_chg.at_most(Cycles::TEN_SECONDS)?,
        })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// For how many cycles the channels have differed, up to t_chg.
        pub lasted: Cycles,
    }
}

impl State {
    /// No difference.
    pub const INITIAL: Self = Self {
        lasted: Cycles::ZERO,
    };

    /// What is counted ends with the tolerance.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.lasted <= config.t_chg
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// The input in this channel.
        pub own: bool,
        /// The same in the other one.
        pub other: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Alarm 27004.
        pub alarm: bool,
    }
}

monitor! { sinumerik::sge_difference;
    /// An input that has differed for the tolerance is told, as long as it does.
    lasting_difference_is_told ["S840D-KDV-725"]:
        when |s| s.inputs.own != s.inputs.other && !s.inputs.power_on && s.before.lasted == s.config.t_chg
            => s.outputs.alarm;

    /// No sooner.
    tolerance_is_kept ["S840D-KDV-725"]:
        when |s| s.before.lasted < s.config.t_chg
            => !s.outputs.alarm;

    /// Each cycle counts.
    difference_counts ["S840D-KDV-725"]:
        when |s| s.inputs.own != s.inputs.other && !s.inputs.power_on && s.before.lasted < s.config.t_chg
            => s.after.lasted.count() == s.before.lasted.count() + 1;

    /// Channels that agree are no alarm, and what was counted is forgotten.
    agreement_forgets ["S840D-KDV-725"]:
        when |s| s.inputs.own == s.inputs.other
            => !s.outputs.alarm && s.after == State::INITIAL;

    /// The step keeps the invariant.
    state_stays_consistent ["S840D-KDV-725"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if inputs.own == inputs.other {
        return (State::INITIAL, Outputs { alarm: false });
    }
    let lasted = if inputs.power_on {
        Cycles::ZERO
    } else {
        state.lasted
    };
    let after = State {
        lasted: Cycles::new(lasted.count().saturating_add(1)).min(config.t_chg),
    };
    let alarm = lasted >= config.t_chg;
    (after, Outputs { alarm })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S840D-KDV-725.
    #[test]
    fn the_alarm_names_five_inputs() {
        let names = Signal::ALL.map(Signal::keyword);
        assert_eq!(names, ["SS/SV", "SS", "SV", "SP", "SVOVR"]);
    }
}
