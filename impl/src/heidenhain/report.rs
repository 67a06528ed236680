//! What one channel tells the other of a group: its running stop, and every cause that it finds itself (HFS-STOP-012).
//!
//! The telegram arrives a cycle later, and what it tells is a cause there. What a channel has been told it does not tell back,
//! or no cause would ever end. A channel whose torque is off, and that needs no main switch, has no stop running any more; it
//! still tells of a further cause, because the other one may have its torque.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::{Phase, Stop};
use crate::kernel::ConfigError;

config! {
    /// Nothing to configure.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

impl Config {
    /// The only configuration.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new() -> Result<Self, ConfigError> {
        Ok(Self)
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The stop of the group, after its step.
        pub level: Stop,
        /// What it is doing.
        pub phase: Phase,
        /// The highest cause that this channel has found in this cycle; what the other one has told is none.
        pub found: Stop,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// What the other channel is told.
        pub told: Stop,
    }
}

monitor! { heidenhain::report;
    /// Every cause that this channel finds is told, whatever its own stop is doing.
    every_finding_is_told ["HFS-STOP-012", "HFS-ARCH-001"]:
        when |s| s.inputs.found != Stop::None
            => s.outputs.told >= s.inputs.found;

    /// A running stop is told, and one that only the main switch ends for as long as it lasts.
    running_stop_is_told ["HFS-STOP-012", "HFS-SS1-007"]:
        when |s| s.inputs.phase != Phase::TorqueOff || s.inputs.level >= Stop::Ss1F
            => s.outputs.told >= s.inputs.level;

    /// A stop that has ended and is asked for no more is not told, so that both channels can be switched on again.
    ended_stop_is_not_told ["HFS-ACK-001", "HFS-SS1-010"]:
        when |s| s.inputs.phase == Phase::TorqueOff && s.inputs.level < Stop::Ss1F
            => s.outputs.told == s.inputs.found;

    /// Nothing is told that is neither running nor found.
    nothing_is_made_up ["HFS-STOP-012"]:
        when |s| s.outputs.told != Stop::None
            => s.outputs.told == s.inputs.level || s.outputs.told == s.inputs.found;
}

pub(crate) fn transition(_: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let ended = inputs.phase == Phase::TorqueOff && inputs.level < Stop::Ss1F;
    let told = if ended {
        inputs.found
    } else {
        inputs.level.max(inputs.found)
    };
    (State, Outputs { told })
}
