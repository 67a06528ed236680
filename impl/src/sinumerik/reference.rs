//! Axis referencing up to "axis safely referenced", in one channel (machine M5).
//!
//! The agreement of the own channel steps before this machine in the cycle; it also makes the comparison with the stored
//! position (history) in the cycle after the axis has been referenced, and withdraws itself when it fails. The other channel
//! does the same for itself, and tells its agreement as confirmed only once its axis is referenced and its comparison made
//! ([`Outputs::confirmed`]). So "both agreed" means in both channels: given anew, or kept with the comparison passed.

use crate::kernel::ConfigError;

config! {
    /// What the axis is used for.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        se_sn_enabled: bool,
    }
}

impl Config {
    /// `se_sn_enabled`: limit switches or cams are enabled on the axis; only then is the missing safe reference reported.
    ///
    /// # Errors
    /// None at present; the constructor is fallible like those of the other monitors.
    pub fn new(se_sn_enabled: bool) -> Result<Self, ConfigError> {
        Ok(Self { se_sn_enabled })
    }
}

fields! {
    /// How far the axis is referenced.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum AxisState {
        /// Drive and control have not run up.
        #[default]
        Off,
        /// Not referenced.
        NotRef,
        /// Referenced.
        Ref,
        /// Safely referenced.
        SafeRef,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// How far the axis is referenced.
        pub axis: AxisState,
        /// The axis was referenced in the last cycle: the comparison with the history is due in the next one.
        pub fresh: bool,
    }
}

impl State {
    /// Switched off.
    pub const INITIAL: Self = Self {
        axis: AxisState::Off,
        fresh: false,
    };

    /// The comparison is due only where the axis is referenced.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, _config: &Config) -> bool {
        !self.fresh || self.axis == AxisState::Ref
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Power-on of drive and control.
        pub power_on: bool,
        /// Drive and control have run up.
        pub run_up: bool,
        /// The reference approach is correctly done, or the absolute position is transferred.
        pub referenced: bool,
        /// A new reference approach, or the reference is lost.
        pub reference_lost: bool,
        /// Parking is selected.
        pub parking: bool,
        /// The agreement of this channel after this cycle's step.
        pub agreed_1: bool,
        /// The agreement of the other channel as it was told: confirmed there ([`Outputs::confirmed`]).
        pub agreed_2: bool,
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// How far the axis is referenced.
        pub axis: AxisState,
        /// Interface signal "reference point reached".
        pub nst_reference_reached: bool,
        /// SGA "axis safely referenced".
        pub safely_referenced: bool,
        /// The comparison with the history is due in the next cycle.
        pub compare_due: bool,
        /// This channel agrees to a referenced position and has nothing left to compare: what the other channel is told.
        pub confirmed: bool,
        /// Message "axis not safely referenced" (27000 / 300950), only with position monitors; display only, no stop
        /// (S840D-REF-013; beyond the interface of the specification tables).
        pub message: bool,
    }
}

monitor! { sinumerik::reference;
    /// "Safely referenced" only with the agreements of both channels, in the same cycle.
    safely_referenced_needs_both ["S840D-P-13", "S840D-P-14", "S840D-REF-005", "S840D-REF-006/a", "S840D-ALARM-719"]:
        when |s| s.outputs.safely_referenced || s.after.axis == AxisState::SafeRef
            => s.inputs.agreed_1 && s.inputs.agreed_2 && s.after.axis == AxisState::SafeRef && s.outputs.safely_referenced;

    /// A withdrawn agreement resets "safely referenced" at once.
    withdrawal_resets_the_signal ["S840D-P-14", "S840D-P-37", "S840D-UA-006"]:
        when |s| !s.inputs.agreed_1 || !s.inputs.agreed_2
            => !s.outputs.safely_referenced && s.after.axis != AxisState::SafeRef;

    /// What the other channel is told as confirmed is an agreement to a referenced position whose comparison with the
    /// history is over: never one that is only stored.
    confirmed_is_compared ["S840D-REF-004", "S840D-REF-015", "S840D-P-15"]:
        when |s| s.outputs.confirmed
            => s.inputs.agreed_1 && !s.after.fresh && matches!(s.after.axis, AxisState::Ref | AxisState::SafeRef);

    /// A compared agreement is told, so that the other channel can follow.
    compared_agreement_is_told ["S840D-REF-014", "S840D-P-44"]:
        when |s| s.inputs.agreed_1 && !s.after.fresh && matches!(s.after.axis, AxisState::Ref | AxisState::SafeRef)
            => s.outputs.confirmed;

    /// From "not referenced" the axis never becomes safely referenced in one cycle: the history comes between.
    no_safe_reference_at_once ["S840D-P-15", "S840D-REF-004", "S840D-MDCOM-001"]:
        when |s| s.before.axis == AxisState::NotRef || s.before.axis == AxisState::Off || s.inputs.power_on
            => s.after.axis != AxisState::SafeRef && !s.outputs.safely_referenced;

    /// Parking and the loss of the reference always lead to "not referenced" or keep the axis off.
    loss_is_followed ["S840D-REF-006/b", "S840D-REF-016", "S840D-INTERACT-719"]:
        when |s| s.inputs.parking || s.inputs.reference_lost
            => s.after.axis == AxisState::NotRef || s.after.axis == AxisState::Off;

    /// The axis is referenced only by a reference approach or a transferred absolute position.
    reference_needs_its_event ["S840D-REF-002", "S840D-REF-003"]:
        when |s| s.before.axis == AxisState::NotRef && s.after.axis != AxisState::NotRef && !s.inputs.power_on
            => s.after.axis == AxisState::Ref && s.inputs.referenced && s.after.fresh;

    /// The comparison becomes due exactly when the axis has just been referenced.
    comparison_is_due_once ["S840D-REF-004", "S840D-REF-007", "S840D-REF-014", "S840D-UA-003/c", "S840D-UA-003/d"]:
        when |s| s.outputs.compare_due
            => s.before.axis == AxisState::NotRef && s.after.axis == AxisState::Ref && !s.inputs.power_on;

    /// Power-on without completed run-up leaves the axis off; run-up makes it "not referenced".
    run_up_starts_it ["S840D-REF-006/c", "S840D-REF-001", "S840D-ARCH-505", "S840D-MDCOM-001"]:
        when |s| s.inputs.power_on || s.before.axis == AxisState::Off
            => s.after.axis == if s.inputs.run_up { AxisState::NotRef } else { AxisState::Off };

    /// The signal "reference point reached" shows "referenced" and "safely referenced".
    reference_is_shown ["S840D-REF-001", "S840D-REF-002"]:
        when |s| s.after.axis == AxisState::Ref || s.after.axis == AxisState::SafeRef || s.outputs.nst_reference_reached
            => s.outputs.nst_reference_reached
                && (s.after.axis == AxisState::Ref || s.after.axis == AxisState::SafeRef);

    /// The missing safe reference is reported where position monitors need it, and only there.
    missing_reference_is_reported ["S840D-REF-011", "S840D-REF-013", "S840D-UA-002/b", "S840D-INTERACT-719", "S840D-ALARM-720"]:
        when |s| s.config.se_sn_enabled || s.outputs.message
            => s.config.se_sn_enabled && s.outputs.message != s.outputs.safely_referenced;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["S840D-REF-005"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.axis == s.after.axis && s.outputs.compare_due == s.after.fresh;
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let before = if inputs.power_on {
        State::INITIAL
    } else {
        state
    };
    let lost = inputs.parking || inputs.reference_lost;
    let agreed = inputs.agreed_1 && inputs.agreed_2;
    let axis = match before.axis {
        AxisState::Off if inputs.run_up => AxisState::NotRef,
        AxisState::Off => AxisState::Off,
        AxisState::NotRef if inputs.referenced && !lost => AxisState::Ref,
        AxisState::NotRef => AxisState::NotRef,
        AxisState::Ref | AxisState::SafeRef if lost => AxisState::NotRef,
        AxisState::Ref | AxisState::SafeRef if agreed => AxisState::SafeRef,
        AxisState::Ref | AxisState::SafeRef => AxisState::Ref,
    };
    let after = State {
        axis,
        fresh: before.axis == AxisState::NotRef && axis == AxisState::Ref,
    };
    let safely_referenced = axis == AxisState::SafeRef;
    let outputs = Outputs {
        axis,
        nst_reference_reached: matches!(axis, AxisState::Ref | AxisState::SafeRef),
        safely_referenced,
        compare_due: after.fresh,
        confirmed: inputs.agreed_1
            && !after.fresh
            && matches!(axis, AxisState::Ref | AxisState::SafeRef),
        message: config.se_sn_enabled && !safely_referenced,
    };
    (after, outputs)
}
