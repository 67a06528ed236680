//! What the stop of one axis group makes of another one in the same channel.
//!
//! SS0 and SS1F concern the whole machine; an SS1 does when the emergency stop or the kernel is its cause; a group that waits
//! for the ones SMP610 lists brakes these by SS2. Nothing else crosses from group to group (HFS-AXG-016). The result is for
//! one pair of groups; a group takes the highest of all others.

pub use crate::contract::Stateless as State;
use crate::heidenhain::types::{Phase, Stop};
use crate::kernel::ConfigError;

config! {
    /// What SMP610 says of the pair.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config {
        listed: bool,
    }
}

impl Config {
    /// `listed`: SMP610 of the other group lists this one, which is to stand before the other one brakes.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(listed: bool) -> Result<Self, ConfigError> {
        Ok(Self { listed })
    }
}

fields! {
    /// The stop of the other group at the start of the cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Its level.
        pub level: Stop,
        /// What it is doing.
        pub phase: Phase,
        /// Its SS1 concerns the whole machine.
        pub wide: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop of this group that follows.
        pub demand: Stop,
    }
}

monitor! { heidenhain::neighbour;
    /// SS0 or SS1F of one group is SS1F of all others.
    hard_stop_spreads ["HFS-SS0-004", "HFS-SS1F-001", "HFS-SS1F-002", "HFS-P-03"]:
        when |s| s.inputs.level >= Stop::Ss1F
            => s.outputs.demand == Stop::Ss1F;

    /// An SS1 of the whole machine that brakes one group brakes the others.
    wide_stop_spreads ["HFS-SS1-001", "HFS-MAG-006/c"]:
        when |s| s.inputs.wide && matches!(s.inputs.phase, Phase::EmergencyBrake | Phase::BrakeCloses)
            => s.outputs.demand >= Stop::Ss1;

    /// A group that waits brakes the ones that it waits for.
    wait_brakes_the_listed ["HFS-GRP-003", "HFS-SS1D-001", "HFS-SS2-010"]:
        when |s| s.config.listed && matches!(s.inputs.phase, Phase::Ss2Wait | Phase::Ss1DWait)
            => s.outputs.demand >= Stop::Ss2;

    /// Nothing else crosses: what is asked of one group, and an SS1 of its own, leave the others alone.
    groups_are_apart ["HFS-AXG-016", "HFS-P-36"]:
        when |s| s.inputs.level < Stop::Ss1F && !s.inputs.wide
            && !(s.config.listed && matches!(s.inputs.phase, Phase::Ss2Wait | Phase::Ss1DWait))
            => s.outputs.demand == Stop::None;
}

pub(crate) fn transition(_: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let waits = matches!(inputs.phase, Phase::Ss2Wait | Phase::Ss1DWait);
    let brakes = matches!(inputs.phase, Phase::EmergencyBrake | Phase::BrakeCloses);
    let demand = if inputs.level >= Stop::Ss1F {
        Stop::Ss1F
    } else if inputs.wide && brakes {
        Stop::Ss1
    } else if config.listed && waits {
        Stop::Ss2
    } else {
        Stop::None
    };
    (State, Outputs { demand })
}
