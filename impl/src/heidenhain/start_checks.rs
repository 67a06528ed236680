//! Checks of the configuration while the control boots.
//!
//! Axes of different kind in one group are found by both channels; drive parameters that are not plausible by channel B. Any
//! of them is SS1F, and the control does not go into service before the main switch has been off and on. The
//! cycle of the main switch is a reset and nothing else: the boot follows it.

use crate::heidenhain::types::Stop;
use crate::kernel::ConfigError;

config! {
    /// The channel.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        cc: bool,
    }
}

impl Config {
    /// `cc`: channel B, which checks the drive parameters.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(cc: bool) -> Result<Self, ConfigError> {
        Ok(Self { cc })
    }
}

fields! {
    /// How far the start is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Start {
        /// The control boots.
        #[default]
        Booting,
        /// The control is in service.
        InService,
        /// A check has failed: main switch.
        Refused,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the start is.
        pub start: Start,
    }
}

impl State {
    /// The control boots.
    pub const INITIAL: Self = Self {
        start: Start::Booting,
    };

    /// Every state is consistent.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub power_on: bool,
        /// The boot has come to its end.
        pub booted: bool,
        /// Axes of different kind (MP100) are in one group.
        pub mixed: bool,
        /// Motor speed at rated speed in 1000 rpm (MP3210), 0 to 100.
        pub motor_speed: i32,
        /// Rated speed for gear ranges (MP3510) in rpm, above 0.
        pub rated_speed: i32,
        /// The feed constant (SMP1054.x) is not 0.
        pub feed_constant: bool,
    }
}

impl Inputs {
    /// Whether the drive parameters are plausible.
    fn plausible(&self) -> bool {
        0 <= self.motor_speed
            && self.motor_speed <= 100
            && self.rated_speed > 0
            && self.feed_constant
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::start_checks;
    /// Axes of different kind in one group, found while booting by either channel: SS1F.
    mixed_group_is_refused ["HFS-FAULT-005", "HFS-LIM-003", "HFS-GRP-001"]:
        when |s| s.inputs.mixed && s.before.start == Start::Booting && !s.inputs.power_on
            => s.outputs.demand == Stop::Ss1F && s.after.start == Start::Refused;

    /// Drive parameters that are not plausible are found by channel B: SS1F.
    implausible_drive_is_refused ["HFS-FAULT-009"]:
        when |s| s.config.cc && s.before.start == Start::Booting && !s.inputs.power_on
            && (s.inputs.motor_speed < 0 || s.inputs.motor_speed > 100 || s.inputs.rated_speed <= 0
                || !s.inputs.feed_constant)
            => s.outputs.demand == Stop::Ss1F && s.after.start == Start::Refused;

    /// A control whose checks passed goes into service at the end of its boot, not before.
    service_begins_after_the_boot ["HFS-ARCH-011"]:
        when |s| s.outputs.demand == Stop::None && s.before.start == Start::Booting && !s.inputs.power_on
            => (s.after.start == Start::InService) == s.inputs.booted;

    /// What was refused stays refused until the main switch.
    refusal_lasts_until_the_main_switch ["HFS-FAULT-005", "HFS-FAULT-009", "HFS-SS1F-003"]:
        when |s| s.before.start == Start::Refused && !s.inputs.power_on
            => s.after.start == Start::Refused;

    /// The main switch starts the boot anew.
    main_switch_boots ["HFS-ACK-001", "HFS-ARCH-011"]:
        when |s| s.inputs.power_on
            => s.after == State::INITIAL && s.outputs.demand == Stop::None;

    /// In service nothing is checked any more; plausible parameters pass.
    no_stop_without_cause ["HFS-FAULT-009"]:
        when |s| s.before.start != Start::Booting || (!s.inputs.mixed && s.inputs.plausible())
            => s.outputs.demand == Stop::None;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    if inputs.power_on {
        return (State::INITIAL, Outputs::default());
    }
    if state.start != Start::Booting {
        return (state, Outputs::default());
    }
    let (start, demand) = if inputs.mixed || (config.cc && !inputs.plausible()) {
        (Start::Refused, Stop::Ss1F)
    } else if inputs.booted {
        (Start::InService, Stop::None)
    } else {
        (Start::Booting, Stop::None)
    };
    (State { start }, Outputs { demand })
}
