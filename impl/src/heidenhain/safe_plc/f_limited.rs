//! The soft key F LIMITED: the speed that the NC software asks of a drive, by the mode that the safe PLC has selected
//! (`PP_GenSOM`).
//!
//! One channel, no safety function: it brings the drive within the limit before a door is opened, so that opening it needs no
//! stop.

use crate::heidenhain::types::Som;
use crate::kernel::{ConfigError, Speed};

pub use crate::contract::Stateless as State;

config! {
    /// The limits of the modes.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        limits: [Speed; 3],
    }
}

impl Config {
    /// `limits`: limited speed of SOM_2, SOM_3 and SOM_4 in increments per cycle, without the 5 % that the kernel adds.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(limits: [Speed; 3]) -> Result<Self, ConfigError> {
        Ok(Self { limits })
    }

    /// The limit of a mode; SOM_1 is standstill.
    const fn limit(&self, som: Som) -> Speed {
        let [second, third, fourth] = self.limits;
        match som {
            Som::Som1 => Speed(0),
            Som::Som2 => second,
            Som::Som3 => third,
            Som::Som4 => fourth,
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The soft key is on.
        pub pressed: bool,
        /// The safe operating mode.
        pub som: Som,
        /// The speed of the program.
        pub wanted: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The speed asked of the drive.
        pub speed: Speed,
    }
}

monitor! { heidenhain::f_limited;
    /// With the key on no drive is asked for more than the limit of its mode.
    limit_of_the_mode ["HFS-SLS-007", "HFS-MODE-023"]:
        when |s| s.inputs.pressed
            => s.outputs.speed <= s.config.limit(s.inputs.som) && s.outputs.speed <= s.inputs.wanted;

    /// In SOM_1 it stands.
    som_1_is_standstill ["HFS-SLS-007", "HFS-MODE-022"]:
        when |s| s.inputs.pressed && s.inputs.som == Som::Som1
            => s.outputs.speed == Speed(0);

    /// A slower program is not slowed down, and without the key none is.
    slower_programs_are_left_alone ["HFS-SLS-007"]:
        when |s| !s.inputs.pressed || s.inputs.wanted <= s.config.limit(s.inputs.som)
            => s.outputs.speed == s.inputs.wanted;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let speed = if inputs.pressed {
        inputs.wanted.min(config.limit(inputs.som))
    } else {
        inputs.wanted
    };
    (state, Outputs { speed })
}
