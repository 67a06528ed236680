//! Referencing of one axis in one channel: from an unknown position to one that a person has checked.
//!
//! After power-on the axis is homed. If it is where it was when its checked position was saved, in both channels, it counts
//! as checked again; else a person drives it to the mark on the machine and confirms it with the permissive key. Until
//! then it moves with closed doors only, except in the machine mode for homing and testing. An axis without a group
//! moves always and is never checked.
//!
//! What asks for a check, an exchanged encoder or a changed parameter, takes effect at the next power-on; the saved position
//! is then worthless. So is one that was found but not yet compared when the power went.
//!
//! Recommended readings of the manual implemented here: AMB-61 FLAG_AND_POS, a saved position counts only if it was checked
//! when it was saved.

use crate::heidenhain::types::{Som, Stop, Unit};
use crate::kernel::ConfigError;

config! {
    /// Whether the axis is safe.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        safe_axis: bool,
    }
}

impl Config {
    /// `safe_axis`: the axis belongs to a group (SMP600.x is not -1).
    ///
    /// # Errors
    /// None; a result like that of the other monitors.
    pub const fn new(safe_axis: bool) -> Result<Self, ConfigError> {
        Ok(Self { safe_axis })
    }
}

fields! {
    /// What is known of the position.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum AxisRef {
        /// Nothing.
        #[default]
        NotHomed,
        /// Found; not yet compared with the saved one.
        Homed,
        /// Found, but nobody has checked it.
        NotChecked,
        /// Checked.
        Checked,
    }
}

fields! {
    /// The state between two cycles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct State {
        /// What is known of the position.
        pub axis: AxisRef,
        /// The saved position was checked when it was saved; kept through power-off.
        pub saved: bool,
    }
}

impl State {
    /// A new machine: nothing known, nothing saved.
    pub const INITIAL: Self = Self {
        axis: AxisRef::NotHomed,
        saved: false,
    };

    /// The state at power-on.
    pub const fn restored(saved: bool) -> Self {
        Self {
            axis: AxisRef::NotHomed,
            saved,
        }
    }

    /// A checked axis is saved as checked, one that is not as not.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        match self.axis {
            AxisRef::NotHomed | AxisRef::Homed => true,
            AxisRef::NotChecked => !self.saved,
            AxisRef::Checked => self.saved && config.safe_axis,
        }
    }
}

fields! {
    /// The inputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// Main switch off and on.
        pub power_on: bool,
        /// Since the last boot an encoder was exchanged, or a parameter changed that the position depends on.
        pub check_cause: bool,
        /// Reference marks passed or absolute value read, in both channels.
        pub homed: bool,
        /// The position of this channel is within SMP642.x of the saved one.
        pub own_matches: bool,
        /// The same in the other channel.
        pub peer_matches: bool,
        /// The position of this channel is within SMP642.x of the mark (SMP646.x).
        pub own_at_mark: bool,
        /// The same in the other channel.
        pub peer_at_mark: bool,
        /// The permissive key of the operating panel, both contacts.
        pub confirm: bool,
        /// `PP_GenSOM`.
        pub som: Som,
        /// The machine operating mode.
        pub unit: Unit,
        /// A door of the working space of the axis is open.
        pub door_open: bool,
        /// The axis moves.
        pub moving: bool,
        /// The other channel has it checked.
        pub peer_checked: bool,
    }
}

impl Inputs {
    /// Whether the person's confirmation is accepted.
    fn confirms(&self) -> bool {
        self.own_at_mark
            && self.peer_at_mark
            && self.confirm
            && self.som != Som::Som1
            && self.unit == Unit::Reference
    }

    /// Whether the position found is the one that was saved.
    fn found_again(&self) -> bool {
        self.own_matches && self.peer_matches
    }
}

fields! {
    /// The outputs of one cycle.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// `NN_AxSafe`: a safe axis, checked in both channels.
        pub ax_safe: bool,
        /// This channel has the axis checked.
        pub checked: bool,
        /// The axis may move.
        pub may_move: bool,
        /// It moves and must not: SS2 of its group.
        pub untested: bool,
        /// The stop to be raised.
        pub demand: Stop,
    }
}

monitor! { heidenhain::reference;
    /// Power-on: the position is unknown, what was saved is kept.
    power_on_forgets_the_position ["HFS-REF-001", "HFS-REF-011"]:
        when |s| s.inputs.power_on
            => s.after.axis == AxisRef::NotHomed && !s.outputs.ax_safe;

    /// An axis becomes checked by the comparison with a checked saved position in both channels, or by the person at the
    /// mark in both channels, and in no other way.
    checked_by_comparison_or_person ["HFS-P-20", "HFS-REF-007", "HFS-CHK-001", "HFS-CHK-002", "HFS-CHK-004",
        "HFS-REF-013"]:
        when |s| s.before.axis != AxisRef::Checked && s.after.axis == AxisRef::Checked
            => match s.before.axis {
                AxisRef::Homed => s.before.saved && s.inputs.own_matches && s.inputs.peer_matches,
                AxisRef::NotChecked => s.inputs.own_at_mark && s.inputs.peer_at_mark && s.inputs.confirm
                    && s.inputs.som != Som::Som1 && s.inputs.unit == Unit::Reference,
                AxisRef::NotHomed | AxisRef::Checked => false,
            };

    /// The position is found by homing in both channels, reference marks passed or absolute value read, and by nothing else.
    homing_gives_the_position ["HFS-REF-002"]:
        when |s| s.config.safe_axis && s.before.axis == AxisRef::NotHomed && !s.inputs.power_on
            => s.after.axis == if s.inputs.homed { AxisRef::Homed } else { AxisRef::NotHomed };

    /// The comparison decides in the cycle after the homing: checked, or to be checked by a person.
    comparison_decides ["HFS-P-41", "HFS-REF-007", "HFS-REF-010", "HFS-REF-012"]:
        when |s| s.config.safe_axis && s.before.axis == AxisRef::Homed && !s.inputs.power_on
            => s.after.axis == if s.before.saved && s.inputs.own_matches && s.inputs.peer_matches {
                AxisRef::Checked
            } else {
                AxisRef::NotChecked
            };

    /// The person at the mark decides, in SOM_2 to SOM_4, with the door open or closed.
    person_at_the_mark_decides ["HFS-CHK-001", "HFS-CHK-003", "HFS-CHK-004", "HFS-CHK-010"]:
        when |s| s.config.safe_axis && s.before.axis == AxisRef::NotChecked && !s.inputs.power_on
            => (s.after.axis == AxisRef::Checked) == (s.inputs.own_at_mark && s.inputs.peer_at_mark && s.inputs.confirm
                && s.inputs.som != Som::Som1 && s.inputs.unit == Unit::Reference);

    /// A saved position counts after power-on only without a cause for a check, if the axis was checked, or was not homed
    /// since it was saved: a second power-on forgets no cause.
    saved_position_needs_a_check ["HFS-REF-007", "HFS-REF-008", "HFS-REF-010", "HFS-SLP-008"]:
        when |s| s.inputs.power_on
            => !s.after.saved || (!s.inputs.check_cause && s.before.saved
                && matches!(s.before.axis, AxisRef::Checked | AxisRef::NotHomed));

    /// A checked position without a cause for a check is kept through power-off.
    checked_position_is_kept ["HFS-REF-008"]:
        when |s| s.config.safe_axis && s.inputs.power_on && !s.inputs.check_cause && s.before.axis == AxisRef::Checked
            => s.after.saved;

    /// Once checked, the axis stays so until power-on.
    checked_until_power_on ["HFS-REF-011"]:
        when |s| s.before.axis == AxisRef::Checked && !s.inputs.power_on
            => s.after.axis == AxisRef::Checked && s.outputs.checked;

    /// `NN_AxSafe` means a safe axis, checked in both channels.
    ax_safe_means_both_channels ["HFS-ARCH-004/k", "HFS-P-18", "HFS-REF-001", "HFS-CHK-007"]:
        when |s| s.outputs.ax_safe
            => s.config.safe_axis && s.after.axis == AxisRef::Checked && s.inputs.peer_checked;

    /// A moving safe axis, outside homing and testing: SS2 if it is not homed, or not checked with the door open.
    untested_axis_is_stopped ["HFS-P-19", "HFS-REF-009", "HFS-CHK-010"]:
        when |s| s.config.safe_axis && s.after.axis != AxisRef::Checked && s.inputs.moving
            && s.inputs.unit != Unit::Reference && (s.inputs.door_open || s.after.axis != AxisRef::NotChecked)
            => s.outputs.untested && s.outputs.demand == Stop::Ss2 && !s.outputs.may_move;

    /// Before homing a safe axis moves in the mode for it only, whatever the door.
    no_other_mode_before_homing ["HFS-REF-006"]:
        when |s| s.config.safe_axis && matches!(s.after.axis, AxisRef::NotHomed | AxisRef::Homed)
            => s.outputs.may_move == (s.inputs.unit == Unit::Reference);

    /// An axis without a group moves always and stops nothing.
    axis_without_group_is_free ["HFS-NS-001/c", "HFS-NS-001/d", "HFS-NS-002", "HFS-NS-003", "HFS-CHK-007"]:
        when |s| !s.config.safe_axis
            => s.outputs.may_move && !s.outputs.untested && !s.outputs.ax_safe && !s.outputs.checked
                && s.outputs.demand == Stop::None;

    /// A checked axis moves everywhere and is never untested.
    checked_axis_is_free ["HFS-REF-009"]:
        when |s| s.after.axis == AxisRef::Checked
            => s.outputs.may_move && !s.outputs.untested && s.outputs.demand == Stop::None;

    /// The state stays consistent.
    state_stays_consistent ["HFS-REF-008", "HFS-P-41"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

impl State {
    /// The state one cycle later, of a safe axis.
    fn advanced(self, inputs: &Inputs) -> Self {
        if inputs.power_on {
            let compared = self.axis != AxisRef::Homed;
            return Self::restored(self.saved && compared && !inputs.check_cause);
        }
        match self.axis {
            AxisRef::NotHomed if inputs.homed => Self {
                axis: AxisRef::Homed,
                ..self
            },
            AxisRef::Homed => {
                let saved = self.saved && inputs.found_again();
                Self {
                    axis: if saved {
                        AxisRef::Checked
                    } else {
                        AxisRef::NotChecked
                    },
                    saved,
                }
            }
            AxisRef::NotChecked if inputs.confirms() => Self {
                axis: AxisRef::Checked,
                saved: true,
            },
            AxisRef::NotHomed | AxisRef::NotChecked | AxisRef::Checked => self,
        }
    }
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let after = if config.safe_axis {
        state.advanced(inputs)
    } else {
        State::INITIAL
    };
    let checked = after.axis == AxisRef::Checked;
    let homing = inputs.unit == Unit::Reference;
    let may_move = !config.safe_axis
        || match after.axis {
            AxisRef::Checked => true,
            AxisRef::NotHomed | AxisRef::Homed => homing,
            AxisRef::NotChecked => homing || !inputs.door_open,
        };
    let untested = inputs.moving && !may_move;
    let outputs = Outputs {
        ax_safe: config.safe_axis && checked && inputs.peer_checked,
        checked,
        may_move,
        untested,
        demand: if untested { Stop::Ss2 } else { Stop::None },
    };
    (after, outputs)
}
