//! The marker of one safe input from its two contacts.
//!
//! Each contact may be inverted (SMP585 in channel A, SMP586 in channel B, at most eight inputs each); both then have to be 1.
//! So the antivalent contacts of a handwheel (HR 410 FS, HR 420 FS, HR 520 FS: one normally open, one normally closed) are
//! inverted in one channel, those of the panel and of the HR 550 FS (two normally open) in none, and a stop key with normally
//! closed contacts in none: one open contact stops. A marker of 0 activates the safety function (HFS-HW-003, HFS-PB-007,
//! HFS-MKEY-002).

use crate::kernel::ConfigError;

pub use crate::contract::Stateless as State;

config! {
    /// How the input is wired.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        invert_a: bool,
        invert_b: bool,
        missing: bool,
    }
}

impl Config {
    /// `invert_a`, `invert_b`: SMP585 and SMP586 list the input. `missing`: the machine has no such input; its marker is 0.
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(invert_a: bool, invert_b: bool, missing: bool) -> Result<Self, ConfigError> {
        Ok(Self {
            invert_a,
            invert_b,
            missing,
        })
    }
}

fields! {
    /// The contacts.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Level at the terminal of channel A.
        pub contact_a: bool,
        /// Level at the terminal of channel B.
        pub contact_b: bool,
    }
}

fields! {
    /// What the safe PLC sees.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The marker of the input.
        pub marker: bool,
    }
}

monitor! { heidenhain::safe_input;
    /// The marker needs both contacts, after their inversion.
    marker_needs_both_contacts ["HFS-IO-001", "HFS-IO-002", "HFS-HW-003", "HFS-PB-007"]:
        when |s| s.outputs.marker
            => s.inputs.contact_a != s.config.invert_a && s.inputs.contact_b != s.config.invert_b;

    /// An input that the machine does not have is 0.
    missing_input_is_0 ["HFS-SPLC-005"]:
        when |s| s.config.missing
            => !s.outputs.marker;

    /// With both contacts the marker is 1.
    both_contacts_set_the_marker ["HFS-IO-001", "HFS-IO-002", "HFS-MKEY-002"]:
        when |s| !s.config.missing && s.inputs.contact_a != s.config.invert_a && s.inputs.contact_b != s.config.invert_b
            => s.outputs.marker;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let a = inputs.contact_a ^ config.invert_a;
    let b = inputs.contact_b ^ config.invert_b;
    let marker = !config.missing && a && b;
    (state, Outputs { marker })
}
