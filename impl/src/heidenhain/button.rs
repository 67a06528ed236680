//! A permissive button or key of one safe PLC: valid from the edge of both contacts while it is held, for a limited time.
//!
//! A button held at power-up, held for too long, or held over a change of the operating unit does not count until it has been
//! released and pressed again.

use crate::kernel::{ConfigError, Cycles};

config! {
    /// How long a press counts.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_max: Cycles,
    }
}

impl Config {
    /// The longest time of one press: 30 min in cycles of 3 ms.
    pub const LONGEST: Cycles = Cycles::new(600_000);

    /// `t_max`: how long one press counts (SMP535 of its timer), 1 cycle to [`Config::LONGEST`].
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] for 0, [`ConfigError::DelayTooLong`] above [`Config::LONGEST`].
    pub fn new(t_max: Cycles) -> Result<Self, ConfigError> {
        if t_max.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            t_max: t_max.at_most(Self::LONGEST)?,
        })
    }

    /// How long one press counts.
    pub const fn t_max(&self) -> Cycles {
        self.t_max
    }
}

fields! {
    /// What is known of the button.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Button {
        /// Not pressed.
        Released,
        /// Pressed, and the permission counts.
        Valid,
        /// Pressed, but the permission does not count.
        #[default]
        Jammed,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is known of the button.
        pub button: Button,
        /// What is left of the time of this press while it is valid, else 0.
        pub timer: Cycles,
    }
}

impl State {
    /// Held at power-up until the contacts tell otherwise.
    pub const INITIAL: Self = Self {
        button: Button::Jammed,
        timer: Cycles::ZERO,
    };

    /// A timer runs exactly while the press is valid.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.timer <= config.t_max && (self.button == Button::Valid) != self.timer.is_zero()
    }
}

fields! {
    /// The inputs of one cycle of the safe PLC.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub power_on: bool,
        /// Contact of channel A, after the inversion of SMP585.
        pub contact_a: bool,
        /// Contact of channel B, after the inversion of SMP586.
        pub contact_b: bool,
        /// The operating unit changes in this cycle.
        pub unit_changes: bool,
    }
}

impl Inputs {
    /// Both contacts have switched.
    const fn pressed(&self) -> bool {
        self.contact_a && self.contact_b
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// What is known of the button.
        pub button: Button,
        /// The permission counts.
        pub valid: bool,
        /// Warning of the PLC: the button is pressed and does not count.
        pub jammed: bool,
    }
}

monitor! { heidenhain::button;
    /// The permission needs both contacts, and an edge of them since power-up.
    permission_needs_both_contacts ["HFS-PB-001", "HFS-HW-002"]:
        when |s| s.outputs.valid
            => s.inputs.pressed() && !s.inputs.power_on && s.before.button != Button::Jammed;

    /// An open contact ends the permission at once.
    open_contact_ends_it ["HFS-PB-001", "HFS-PB-006", "HFS-ARCH-007"]:
        when |s| !s.inputs.pressed() && !s.inputs.power_on
            => s.after.button == Button::Released && !s.outputs.valid && !s.outputs.jammed;

    /// A press that is not valid stays so until it is released.
    jammed_until_released ["HFS-P-26", "HFS-PB-001", "HFS-PB-006"]:
        when |s| s.before.button == Button::Jammed && s.inputs.pressed()
            => s.after.button == Button::Jammed;

    /// A press ends in time: its timer is lower in each cycle, and from its end on it does not count.
    press_ends_in_time ["HFS-P-26", "HFS-PB-001"]:
        when |s| s.before.button == Button::Valid && s.inputs.pressed() && !s.inputs.power_on
            => (s.after.button == Button::Valid && s.after.timer < s.before.timer)
                || s.after.button == Button::Jammed;

    /// A press is not cut short: only the end of its time or a change of the operating unit ends it while it is held.
    press_is_not_cut_short ["HFS-PB-001"]:
        when |s| s.before.button == Button::Valid && s.inputs.pressed() && !s.inputs.power_on
            && !s.inputs.unit_changes && s.before.timer.count() > 1
            => s.outputs.valid;

    /// A press counts from its edge on, for its whole time.
    press_starts_its_time ["HFS-PB-001"]:
        when |s| s.before.button == Button::Released && s.inputs.pressed() && !s.inputs.power_on && !s.inputs.unit_changes
            => s.outputs.valid && s.after.timer == s.config.t_max;

    /// After power-up the button counts as held until its contacts have told otherwise.
    power_up_needs_an_edge ["HFS-PB-006", "HFS-PB-001"]:
        when |s| s.inputs.power_on
            => s.after == State::INITIAL;

    /// No permission lives through a change of the operating unit.
    unit_change_ends_it ["HFS-PB-006", "HFS-HW-001"]:
        when |s| s.inputs.unit_changes
            => !s.outputs.valid;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-PB-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.button == s.after.button
                && s.outputs.valid == (s.after.button == Button::Valid)
                && s.outputs.jammed == (s.after.button == Button::Jammed);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let left = match state.button {
        Button::Released => config.t_max,
        Button::Valid => state.timer.tick(),
        Button::Jammed => Cycles::ZERO,
    };
    let (button, timer) = if inputs.power_on {
        (Button::Jammed, Cycles::ZERO)
    } else if !inputs.pressed() {
        (Button::Released, Cycles::ZERO)
    } else if left.is_zero() || inputs.unit_changes {
        (Button::Jammed, Cycles::ZERO)
    } else {
        (Button::Valid, left)
    };
    let outputs = Outputs {
        button,
        valid: button == Button::Valid,
        jammed: button == Button::Jammed,
    };
    (State { button, timer }, outputs)
}
