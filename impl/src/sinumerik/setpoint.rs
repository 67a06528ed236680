//! Limit of the speed setpoint (MD36933): a help of the interpolator for its user, in one channel only, and no safety function.
//!
//! It follows what the signals of both channels select ([`crate::sinumerik::selection::Outputs::goal`]), not what is monitored:
//! an axis must have slowed down when the delay to a lower limit is over. The channels may change over at different times, so
//! the limit falls with the first of them and rises with the last.

pub use crate::contract::Stateless as State;
use crate::kernel::{ConfigError, Percent, Speed};
use crate::sinumerik::selection::Monitored;

config! {
    /// The share of the speed limits.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        percent: Percent,
    }
    accepted |config| config.percent.get() <= 100
}

impl Config {
    /// `percent`: the setpoint limit in percent of the selected speed limit (`SAFE_DES_VELO_LIMIT`, 36933), 0 to 100; 0: none.
    ///
    /// # Errors
    /// [`ConfigError::FactorOutOfRange`] above 100.
    pub fn new(percent: u8) -> Result<Self, ConfigError> {
        Ok(Self {
            percent: Percent::new(percent)?,
        })
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What the signals of the NCK lead to.
        pub nck_goal: Monitored,
        /// The speed limit they lead to, override included.
        pub nck_limit: Speed,
        /// What the signals of the drive lead to.
        pub drive_goal: Monitored,
        /// The speed limit they lead to.
        pub drive_limit: Speed,
    }
}

impl Inputs {
    /// A channel selects something.
    fn any_goal(&self) -> bool {
        self.nck_goal != Monitored::Nothing || self.drive_goal != Monitored::Nothing
    }

    /// The lower of the speeds that the channels leave; one that selects nothing leaves any.
    fn lowest(&self) -> Speed {
        let ceiling = |goal, limit| match goal {
            Monitored::Nothing => Speed(u32::MAX),
            Monitored::Speed => limit,
            Monitored::Standstill => Speed(0),
        };
        ceiling(self.nck_goal, self.nck_limit).min(ceiling(self.drive_goal, self.drive_limit))
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The setpoint is limited; where it is not, the service display shows -1.
        pub limited: bool,
        /// The highest setpoint where it is limited, else 0.
        pub limit: Speed,
    }
}

monitor! { sinumerik::setpoint;
    /// One channel that selects the operating stop is enough for a setpoint of 0.
    operating_stop_of_one_channel_is_zero ["S840D-INTERACT-701", "S840D-INTERACT-703", "S840D-INTERACT-707", "S840D-INTERACT-708",
        "S840D-PARAM-012", "S840D-SBH-013"]:
        when |s| s.config.percent.get() > 0
            && (s.inputs.nck_goal == Monitored::Standstill || s.inputs.drive_goal == Monitored::Standstill)
            => s.outputs.limited && s.outputs.limit == Speed(0);

    /// Both select a speed: the lower one counts, so one channel is enough to lower the limit and it takes both to raise it.
    lower_of_both_counts ["S840D-INTERACT-701", "S840D-INTERACT-703", "S840D-INTERACT-705", "S840D-INTERACT-706", "S840D-PARAM-012"]:
        when |s| s.config.percent.get() > 0
            && s.inputs.nck_goal == Monitored::Speed && s.inputs.drive_goal == Monitored::Speed
            => s.outputs.limited
                && s.outputs.limit == s.inputs.nck_limit.min(s.inputs.drive_limit).reduced(s.config.percent)
                && s.outputs.limit <= s.inputs.nck_limit && s.outputs.limit <= s.inputs.drive_limit;

    /// A channel that selects nothing lifts no limit of the other one.
    selection_of_one_channel_limits ["S840D-INTERACT-703", "S840D-INTERACT-704", "S840D-INTERACT-708"]:
        when |s| s.config.percent.get() > 0 && s.inputs.nck_goal != s.inputs.drive_goal
            && (s.inputs.nck_goal == Monitored::Speed || s.inputs.drive_goal == Monitored::Speed)
            && (s.inputs.nck_goal == Monitored::Nothing || s.inputs.drive_goal == Monitored::Nothing)
            => s.outputs.limited
                && s.outputs.limit == if s.inputs.nck_goal == Monitored::Speed {
                    s.inputs.nck_limit.reduced(s.config.percent)
                } else {
                    s.inputs.drive_limit.reduced(s.config.percent)
                };

    /// Neither channel selects anything, or the function is off: no limit.
    free_without_selection ["S840D-INTERACT-701", "S840D-INTERACT-708", "S840D-PARAM-012"]:
        when |s| s.config.percent.get() == 0
            || (s.inputs.nck_goal == Monitored::Nothing && s.inputs.drive_goal == Monitored::Nothing)
            => !s.outputs.limited && s.outputs.limit == Speed(0);
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let outputs = if config.percent.get() > 0 && inputs.any_goal() {
        Outputs {
            limited: true,
            limit: inputs.lowest().reduced(config.percent),
        }
    } else {
        Outputs::default()
    };
    (State, outputs)
}
