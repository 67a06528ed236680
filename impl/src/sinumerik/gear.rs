//! Gear stage of a selector gearbox in one channel and the event of its change (machine M12).
//!
//! The change of the stage uncouples encoder and load: where position monitors (SE, SN) are enabled the user agreement is
//! withdrawn (see [`crate::sinumerik::agreement`]).

use crate::kernel::ConfigError;

fields! {
    /// A gear index as three signals give it: 0 to 7, meaning stage 1 to 8.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub struct GearIndex(u8) in 0..=7;
}

impl GearIndex {
    /// Index 0: the first stage.
    pub const FIRST: Self = Self(0);

    /// The index of a number; `None` above 7.
    pub const fn new(index: u8) -> Option<Self> {
        if index <= 7 { Some(Self(index)) } else { None }
    }

    /// The index of the signals "ratio selection bit 2, 1, 0" (S840D-GEAR-501, S840D-SIGNAL-005, S840D-GEAR-701).
    pub const fn from_bits(bit2: bool, bit1: bool, bit0: bool) -> Self {
        Self(((bit2 as u8) << 2) | ((bit1 as u8) << 1) | bit0 as u8)
    }

    /// The number, 0 to 7.
    pub const fn get(self) -> u8 {
        self.0
    }
}

config! {
    /// The gearbox as configured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        gear_max: GearIndex,
        se_sn_enabled: bool,
    }
    accepted |config| Config::new(config.gear_max.get(), config.se_sn_enabled).is_ok()
}

impl Config {
    /// `gear_max`: the highest index with a parameterised ratio, 0 to 7. `se_sn_enabled`: limit switches or cams are
    /// enabled on the axis (bit 1 or a bit 8 to 15 of the enable word).
    ///
    /// # Errors
    /// [`ConfigError::GearIndexTooHigh`] when `gear_max` is above 7.
    pub fn new(gear_max: u8, se_sn_enabled: bool) -> Result<Self, ConfigError> {
        match GearIndex::new(gear_max) {
            Some(gear_max) => Ok(Self {
                gear_max,
                se_sn_enabled,
            }),
            None => Err(ConfigError::GearIndexTooHigh),
        }
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The selected stage.
        pub stage: GearIndex,
        /// A stage has been taken since power-on.
        pub known: bool,
    }
}

impl State {
    /// No stage taken yet.
    pub const INITIAL: Self = Self {
        stage: GearIndex::FIRST,
        known: false,
    };

    /// Every state is consistent: the type keeps the range.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        true
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control: the stage is taken without an event.
        pub power_on: bool,
        /// The stage selected by the signals.
        pub index: GearIndex,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The selected stage.
        pub stage: GearIndex,
        /// The stage has changed and position monitors are enabled: the user agreement must be withdrawn in this cycle.
        pub changed: bool,
        /// The selected stage has no parameterised ratio (beyond the interface of the specification tables; a message only).
        pub unconfigured: bool,
    }
}

monitor! { sinumerik::gear;
    /// A change of the stage on an axis with position monitors is an event in the same cycle.
    change_is_an_event ["S840D-P-37", "S840D-GEAR-505"]:
        when |s| s.before.known && !s.inputs.power_on && s.inputs.index != s.before.stage && s.config.se_sn_enabled
            => s.outputs.changed;

    /// No event without a change, without position monitors, or when the first stage is taken.
    event_means_change ["S840D-GEAR-505"]:
        when |s| !s.before.known || s.inputs.power_on || s.inputs.index == s.before.stage || !s.config.se_sn_enabled
            => !s.outputs.changed;

    /// The stage is the selected one, whatever was before; no index has a special meaning.
    stage_follows_the_signals ["S840D-GEAR-501", "S840D-SIGNAL-005", "S840D-GEAR-701"]:
        when |s| s.inputs.index.get() <= 7
            => s.after.stage == s.inputs.index && s.after.known && s.outputs.stage == s.inputs.index;

    /// A stage without parameterised ratio is reported, and only such a one.
    unconfigured_stage_is_reported ["S840D-GEAR-501"]:
        when |s| s.inputs.index > s.config.gear_max || s.outputs.unconfigured
            => s.outputs.unconfigured && s.inputs.index > s.config.gear_max;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let after = State {
        stage: inputs.index,
        known: true,
    };
    let outputs = Outputs {
        stage: after.stage,
        changed: before.known && before.stage != after.stage && config.se_sn_enabled,
        unconfigured: after.stage > config.gear_max,
    };
    (after, outputs)
}
