//! The safe operating mode that one safe PLC selects from its keylock inputs.
//!
//! Exactly one active input selects its mode, everything else SOM_1. SOM_4 is entered from SOM_1 and left to SOM_1 only; a
//! direct change is refused until no input is active. Whatever else stands for a mode (a code number, a chip, more switches) is an
//! input like its key, under the same rules (HFS-KSW-005).
//!
//! Recommended reading of the manual implemented here: AMB-70 UNTIL_NEUTRAL.

use crate::heidenhain::types::Som;
use crate::kernel::ConfigError;

config! {
    /// Which modes there are.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        som_4: bool,
    }
}

impl Config {
    /// `som_4`: SMP560 bit 0, SOM_4 is enabled.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(som_4: bool) -> Result<Self, ConfigError> {
        Ok(Self { som_4 })
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// The selected mode.
        pub som: Som,
        /// The last mode other than SOM_1 granted since no input was active; SOM_1 for none.
        pub last: Som,
        /// SOM_4 was left by soft key and its key is still turned.
        pub refused: bool,
    }
}

impl State {
    /// SOM_1.
    pub const INITIAL: Self = Self {
        som: Som::Som1,
        last: Som::Som1,
        refused: false,
    };

    /// A mode that is selected was granted; SOM_4 only where it is enabled.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        (self.som == Som::Som1 || self.som == self.last)
            && (config.som_4 || (self.last != Som::Som4 && !self.refused))
            && !(self.refused && self.som == Som::Som4)
    }
}

fields! {
    /// The inputs of one cycle of the safe PLC.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub power_on: bool,
        /// Keylock input for SOM_2, both contacts.
        pub key_2: bool,
        /// Keylock input for SOM_3, both contacts.
        pub key_3: bool,
        /// Keylock input for SOM_4, both contacts.
        pub key_4: bool,
        /// The soft key that leaves SOM_4.
        pub deselected: bool,
    }
}

impl Inputs {
    /// The mode that the inputs stand for.
    const fn wish(&self) -> Som {
        match (self.key_2, self.key_3, self.key_4) {
            (true, false, false) => Som::Som2,
            (false, true, false) => Som::Som3,
            (false, false, true) => Som::Som4,
            _ => Som::Som1,
        }
    }

    /// Whether no keylock input is active.
    const fn neutral(&self) -> bool {
        !self.key_2 && !self.key_3 && !self.key_4
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The selected mode (`PP_GenSOM`).
        pub som: Som,
        /// It has changed: with an open door an SS2 for the groups of its space.
        pub changed: bool,
    }
}

monitor! { heidenhain::som;
    /// A mode other than SOM_1 needs its input, and no other one.
    mode_needs_its_key_alone ["HFS-P-22", "HFS-KSW-001"]:
        when |s| s.outputs.som != Som::Som1
            => s.outputs.som == s.inputs.wish();

    /// SOM_4 is selected only where it is enabled, and only from SOM_1 with the keys neutral since any other mode.
    som_4_comes_from_som_1 ["HFS-P-21", "HFS-KSW-002", "HFS-MODE-006", "HFS-MODE-007", "HFS-FAULT-015"]:
        when |s| s.outputs.som == Som::Som4
            => s.config.som_4 && !(s.inputs.deselected && s.before.som == Som::Som4) && !s.inputs.power_on
                && matches!(s.before.som, Som::Som1 | Som::Som4)
                && matches!(s.before.last, Som::Som1 | Som::Som4) && !s.before.refused;

    /// After SOM_4 comes SOM_1 and nothing else.
    after_som_4_comes_som_1 ["HFS-P-21", "HFS-KSW-002", "HFS-MODE-006", "HFS-MODE-020"]:
        when |s| s.before.som == Som::Som4 && s.outputs.som != Som::Som4 && !s.inputs.power_on
            => s.outputs.som == Som::Som1;

    /// A refused direct change stays refused while an input is active.
    refusal_lasts_until_neutral ["HFS-KSW-006", "HFS-P-21"]:
        when |s| !s.inputs.power_on && !s.inputs.neutral() && s.before.last != Som::Som1
            => (s.outputs.som == Som::Som1 || (s.outputs.som == Som::Som4) == (s.before.last == Som::Som4))
                && s.after.last != Som::Som1 && (s.after.last == Som::Som4) == (s.before.last == Som::Som4);

    /// With neutral keys the mode is SOM_1 and nothing is refused any more.
    neutral_keys_give_som_1 ["HFS-P-22", "HFS-KSW-001", "HFS-KSW-006"]:
        when |s| s.inputs.neutral() || s.inputs.power_on
            => s.after == State::INITIAL;

    /// The soft key leaves SOM_4 until its key has been turned back.
    soft_key_leaves_som_4 ["HFS-MODE-006", "HFS-MODE-020"]:
        when |s| !s.inputs.power_on && (s.before.refused || (s.before.som == Som::Som4 && s.inputs.deselected))
            && s.inputs.wish() == Som::Som4
            => s.outputs.som == Som::Som1 && s.after.refused;

    /// An input alone selects its mode when nothing stands against it.
    key_selects_its_mode ["HFS-KSW-005", "HFS-KSW-001", "HFS-P-46"]:
        when |s| !s.inputs.power_on && s.before == State::INITIAL
            && (s.config.som_4 || s.inputs.wish() != Som::Som4)
            => s.outputs.som == s.inputs.wish();

    /// Every change is reported, whatever it is.
    every_change_is_reported ["HFS-KSW-003/a", "HFS-KSW-003/b", "HFS-MODE-019", "HFS-API-021"]:
        when |s| s.outputs.som != s.before.som || s.outputs.changed
            => s.outputs.changed == (s.outputs.som != s.before.som);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-KSW-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.som == s.after.som;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = if inputs.power_on || inputs.neutral() {
        State::INITIAL
    } else {
        select(state, config, inputs)
    };
    let outputs = Outputs {
        som: after.som,
        changed: after.som != state.som,
    };
    (after, outputs)
}

/// The mode while an input is active.
fn select(before: State, config: &Config, inputs: &Inputs) -> State {
    let wish = inputs.wish();
    // The soft key leaves SOM_4; where the keylock leaves it already there is nothing to refuse.
    let left = wish == Som::Som4 && before.som == Som::Som4 && inputs.deselected;
    let refused = inputs.key_4 && (before.refused || left);
    let granted = match wish {
        Som::Som1 => false,
        Som::Som2 | Som::Som3 => before.last != Som::Som4,
        Som::Som4 => config.som_4 && !refused && matches!(before.last, Som::Som1 | Som::Som4),
    };
    let som = if granted { wish } else { Som::Som1 };
    let last = if granted { som } else { before.last };
    State { som, last, refused }
}
