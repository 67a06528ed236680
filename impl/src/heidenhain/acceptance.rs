//! Acceptance of changed safe machine parameters (SMP).
//!
//! While the control boots, the kernel compares the checksum of the set with the stored one. A changed set puts the control
//! into service only after the password of the machine builder and a confirmation of each changed parameter, by the
//! permissive key; then its checksum is the stored one. A checksum that becomes wrong in service is SS1F.

use crate::heidenhain::types::Stop;
use crate::kernel::ConfigError;

config! {
    /// The length of the list.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        most: u16,
    }
}

impl Config {
    /// `most`: the largest number of changed parameters; more are confirmed as this many.
    ///
    /// # Errors
    /// [`ConfigError::ValueOutOfRange`] when `most` is 0.
    pub const fn new(most: u16) -> Result<Self, ConfigError> {
        if most == 0 {
            Err(ConfigError::ValueOutOfRange)
        } else {
            Ok(Self { most })
        }
    }

    /// How many confirmations this many changes need: a changed set at least one.
    fn confirmations(&self, changes: u16) -> u16 {
        changes.min(self.most).max(1)
    }
}

fields! {
    /// How far the acceptance is.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Phase {
        /// The set is as it was accepted.
        Valid,
        /// The set is another one.
        #[default]
        Changed,
        /// The password has been given: the changes are confirmed one by one.
        Confirming,
        /// Refused until the next boot.
        Interrupted,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the acceptance is.
        pub phase: Phase,
        /// How many changes are still to be confirmed; 0 outside [`Phase::Changed`] and [`Phase::Confirming`].
        pub open: u16,
    }
}

impl State {
    /// Nothing accepted, at least one confirmation missing: what holds until the first boot has compared the checksums.
    pub const INITIAL: Self = Self {
        phase: Phase::Changed,
        open: 1,
    };

    /// Something is left to be confirmed exactly while the set is changed and not refused.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, config: &Config) -> bool {
        matches!(self.phase, Phase::Changed | Phase::Confirming) == (self.open > 0)
            && self.open <= config.most
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The control boots.
        pub boot: bool,
        /// The checksum of the set equals the stored one.
        pub matches: bool,
        /// The number of changed parameters.
        pub changes: u16,
        /// The password of the machine builder, with the permissive key.
        pub password: bool,
        /// A wrong password, or the dialogue was cancelled.
        pub cancel: bool,
        /// The permissive key confirms the parameter shown: one press, one parameter.
        pub permissive: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// The control may be put into service.
        pub in_service: bool,
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::acceptance;
    /// A boot with the stored checksum is accepted as it is.
    accepted_set_starts ["HFS-PARAM-004", "HFS-PARAM-007"]:
        when |s| s.inputs.boot && s.inputs.matches
            => s.after.phase == Phase::Valid && s.outputs.in_service && s.outputs.demand == Stop::None;

    /// A boot with another checksum is not, whatever was accepted before.
    changed_set_waits ["HFS-PARAM-004", "HFS-PARAM-007"]:
        when |s| s.inputs.boot && !s.inputs.matches
            => s.after.phase == Phase::Changed && s.after.open >= 1 && !s.outputs.in_service;

    /// A changed set gets into service through the password and one confirmation for each change, and in no other way.
    no_service_without_confirmation ["HFS-PARAM-004"]:
        when |s| s.before.phase != Phase::Valid && s.outputs.in_service && !s.inputs.boot
            => s.before.phase == Phase::Confirming && s.before.open == 1 && s.inputs.permissive && !s.inputs.cancel;

    /// The list begins with the password only.
    list_needs_the_password ["HFS-PARAM-004"]:
        when |s| s.before.phase == Phase::Changed && !s.inputs.boot && !s.inputs.cancel
            => (s.after.phase == Phase::Confirming) == s.inputs.password && s.after.open == s.before.open;

    /// One press confirms one change.
    one_press_confirms_one_change ["HFS-PARAM-004"]:
        when |s| s.before.phase == Phase::Confirming && !s.inputs.boot && !s.inputs.cancel
            => s.after.open as u32 + s.inputs.permissive as u32 == s.before.open as u32;

    /// A wrong password, or no answer, keeps the control out of service until the next boot.
    refusal_lasts_until_the_next_boot ["HFS-PARAM-005"]:
        when |s| !s.inputs.boot && (s.before.phase == Phase::Interrupted
            || (s.inputs.cancel && matches!(s.before.phase, Phase::Changed | Phase::Confirming)))
            => s.after.phase == Phase::Interrupted && !s.outputs.in_service;

    /// A checksum that becomes wrong in service is SS1F and takes the control out of service until the next boot.
    wrong_checksum_in_service_stops ["HFS-FAULT-004", "HFS-PARAM-001"]:
        when |s| s.before.phase == Phase::Valid && !s.inputs.boot && !s.inputs.matches
            => s.outputs.demand == Stop::Ss1F && s.after.phase == Phase::Interrupted && !s.outputs.in_service;

    /// Nothing else raises a stop here.
    no_stop_while_out_of_service ["HFS-PARAM-005", "HFS-FAULT-004"]:
        when |s| s.before.phase != Phase::Valid || s.inputs.boot || s.inputs.matches
            => s.outputs.demand == Stop::None;

    /// The state stays consistent.
    state_stays_consistent ["HFS-PARAM-004"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let phase_only = |phase| State { phase, open: 0 };
    let after = if inputs.boot {
        if inputs.matches {
            phase_only(Phase::Valid)
        } else {
            State {
                phase: Phase::Changed,
                open: config.confirmations(inputs.changes),
            }
        }
    } else {
        match state.phase {
            Phase::Valid if !inputs.matches => phase_only(Phase::Interrupted),
            Phase::Valid | Phase::Interrupted => state,
            Phase::Changed | Phase::Confirming if inputs.cancel => phase_only(Phase::Interrupted),
            Phase::Changed if inputs.password => State {
                phase: Phase::Confirming,
                ..state
            },
            Phase::Confirming if inputs.permissive && state.open <= 1 => phase_only(Phase::Valid),
            Phase::Confirming if inputs.permissive => State {
                open: state.open.saturating_sub(1),
                ..state
            },
            Phase::Changed | Phase::Confirming => state,
        }
    };
    let corrupt = state.phase == Phase::Valid && !inputs.boot && !inputs.matches;
    let outputs = Outputs {
        in_service: after.phase == Phase::Valid,
        demand: if corrupt { Stop::Ss1F } else { Stop::None },
    };
    (after, outputs)
}
