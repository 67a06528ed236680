//! One safe output of a safe PLC: what can trigger or permit a motion is off while the kernel does not enable outputs.
//!
//! No stop and no emergency stop switches an output off by itself; the program has to, and `NN_GenOutputEnable` tells it when
//! (see [`output_enable`](crate::heidenhain::output_enable)). Other outputs, such as those that exchange information, stay.

use crate::kernel::ConfigError;

pub use crate::contract::Stateless as State;

config! {
    /// What the output is for.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        motion: bool,
    }
}

impl Config {
    /// `motion`: the output can trigger or permit a motion.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(motion: bool) -> Result<Self, ConfigError> {
        Ok(Self { motion })
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// What the program wants.
        pub wanted: bool,
        /// `NN_GenOutputEnable`.
        pub enabled: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The output marker: 0 is the safe state.
        pub on: bool,
    }
}

monitor! { heidenhain::safe_output;
    /// Without the enable no output for a motion is on.
    motion_needs_the_enable ["HFS-STOP-007", "HFS-IO-005", "HFS-API-032"]:
        when |s| s.config.motion && !s.inputs.enabled
            => !s.outputs.on;

    /// Nothing else switches an output off, and nothing switches it on by itself.
    program_decides ["HFS-STOP-007", "HFS-IO-005"]:
        when |s| s.inputs.enabled || !s.config.motion
            => s.outputs.on == s.inputs.wanted;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let on = inputs.wanted && (inputs.enabled || !config.motion);
    (state, Outputs { on })
}
