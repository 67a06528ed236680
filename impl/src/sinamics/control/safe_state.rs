//! The signal Safe State of a drive group: some enabled function is active on every drive of the group.
//!
//! Also how any signal of a group goes to an F-DO: the AND over its drives.

pub use crate::contract::Stateless as State;

use crate::kernel::ConfigError;

/// The most drives of a TM54F (p10010\[0..5\]).
pub const DRIVES: usize = 6;

config! {
    /// The functions and the drives of the group.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        pub(crate) functions: u8,
        pub(crate) drives: u8,
    }
}

impl Config {
    /// `functions`: those enabled in p10039, by bit: STO, SS1, SS2, SOS, SLS, SDI+, SDI-, SLP. `drives`: the number of drives, 1 to 6;
    /// 1 on a CU310-2.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] for another number of drives.
    pub const fn new(functions: u8, drives: u8) -> Result<Self, ConfigError> {
        if drives == 0 || drives as usize > DRIVES {
            return Err(ConfigError::ValueOutOfRange);
        }
        Ok(Self { functions, drives })
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The active functions of each drive, by bit as in the configuration; those of drives beyond the number do not count.
        pub active: [u8; 6],
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Safe State.
        pub safe: bool,
        /// The functions that are active on every drive of the group.
        pub group: u8,
    }
}

monitor! { sinamics::safe_state;
    /// A function is active in the group only if it is on each of its drives.
    group_is_every_drive ["S120-FDO-503", "S120-TM54F-503"]:
        when |s| s.outputs.group != 0
            => s.inputs.active.iter().take(s.config.drives as usize).all(|active| active & s.outputs.group == s.outputs.group);

    /// What is active on each drive is active in the group.
    common_function_is_the_groups ["S120-FDO-503"]:
        when |s| s.inputs.active.iter().all(|active| *active & 1 == 1)
            => s.outputs.group & 1 == 1;

    /// The state is safe exactly where an enabled function is active on every drive.
    enabled_function_makes_it_safe ["S120-FDO-502", "S120-PC-15"]:
        when |s| s.outputs.safe
            => s.outputs.group & s.config.functions != 0;

    /// Functions that are not enabled do not.
    other_functions_do_not ["S120-FDO-502", "S120-PC-15"]:
        when |s| !s.outputs.safe
            => s.outputs.group & s.config.functions == 0;

    /// Different functions on different drives are no safe state: first AND over the drives, then OR over the functions.
    order_matters ["S120-FDO-502"]:
        when |s| s.config.drives > 1 && s.inputs.active[0] & s.inputs.active[1] == 0
            => !s.outputs.safe;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let drives = inputs.active.iter().take(config.drives as usize);
    let group = drives.fold(u8::MAX, |all, active| all & active);
    let outputs = Outputs {
        safe: group & config.functions != 0,
        group,
    };
    (state, outputs)
}
