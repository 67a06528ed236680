//! Speed threshold n < n_x of one channel: a signal for the user's logic, for instance to release a door.
//!
//! No stop follows from it, and it does not count as an active safety function for STOP F.
//!
//! Recommended reading of the manual implemented here: A-04 (settled), 1 means below. At exactly n_x the axis is not below
//! it, the side on which a door stays locked.

pub use crate::contract::Stateless as State;
use crate::kernel::{ConfigError, Speed};

config! {
    /// The threshold.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        velo_x: Speed,
    }
}

impl Config {
    /// `velo_x`: the threshold (`SAFE_VELO_X`, 36946 / 1346), rounded down; 0 switches the signal off.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(velo_x: Speed) -> Result<Self, ConfigError> {
        Ok(Self { velo_x })
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The magnitude of the actual speed.
        pub speed: Speed,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// SGA "n < n_x".
        pub below: bool,
    }
}

monitor! { sinumerik::threshold;
    /// The signal is 1 below the threshold.
    slower_is_below ["S840D-NX-001"]:
        when |s| s.inputs.speed < s.config.velo_x
            => s.outputs.below;

    /// At the threshold and above the signal is 0, so it always is where the threshold is 0.
    not_slower_is_not_below ["S840D-NX-001", "S840D-PARAM-017"]:
        when |s| s.inputs.speed >= s.config.velo_x
            => !s.outputs.below;
}

pub(crate) const fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let below = inputs.speed.0 < config.velo_x.0;
    (State, Outputs { below })
}
