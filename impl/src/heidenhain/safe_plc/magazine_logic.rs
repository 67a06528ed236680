//! What one safe PLC asks of the kernel for the auxiliary axes of a tool magazine behind a door of their own: monitoring state,
//! activation, feed enable of each axis, stop, permissive.
//!
//! Keylock, stop keys and the permissives of panel and handwheel have no effect here; the magazine has its own. With the door
//! closed the operator confirms once that nobody is inside; then its axes run like others, in a reference run too (HFS-MAG-006).
//!
//! Recommended readings of the manual implemented here: AMB-54 CLEAR_UNLESS_TM, AMB-57 CONFIRM.

use crate::heidenhain::axes_logic::ALL_AXES;
use crate::heidenhain::types::{GroupState, Stop};

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The state between two cycles of the safe PLC.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// The door was open in the cycle before.
        pub open: bool,
        /// The confirmation was pressed in the cycle before.
        pub keyed: bool,
        /// The operator has confirmed since the door was closed.
        pub confirmed: bool,
    }
}

impl State {
    /// As if the door had been open and the confirmation held: nothing starts by itself when the control comes up.
    pub const INITIAL: Self = Self {
        open: true,
        keyed: true,
        confirmed: false,
    };

    /// A confirmation belongs to the closed door.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        !(self.confirmed && self.open)
    }
}

impl Default for State {
    fn default() -> Self {
        Self::INITIAL
    }
}

fields! {
    /// The inputs of one cycle of the safe PLC.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// The magazine door is open.
        pub t_open: bool,
        /// The permissive key of the magazine is valid.
        pub permissive: bool,
        /// Motion keys of the magazine: bit k for axis k.
        pub keys: u8,
        /// The key by which the operator confirms that nobody is inside.
        pub confirm: bool,
        /// The safe operating mode has changed in this cycle.
        pub som_changed: bool,
        /// `NN_AxGrpInMotion`.
        pub moving: bool,
        /// `NN_GenSafe`: the self-test has passed and is not overdue; else no motion is started with the door open.
        pub gen_safe: bool,
    }
}

impl Inputs {
    /// The keys that move with the door open: one, together with the permissive.
    const fn moves(&self) -> u8 {
        if self.permissive && self.keys.is_power_of_two() {
            self.keys
        } else {
            0
        }
    }
}

fields! {
    /// The outputs of one cycle: fields of the interface to the kernel.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// `PP_AxGrpStateReq`.
        pub request: GroupState,
        /// `PP_AxGrpActivate`.
        pub activate: bool,
        /// `PP_AxFeedEnable`: bit k for axis k.
        pub feed: u8,
        /// `PP_AxGrpStopReq`.
        pub stop: Stop,
        /// `PP_AxGrpPB`.
        pub permissive: bool,
    }
}

monitor! { heidenhain::magazine_logic;
    /// Its door alone decides the monitoring state.
    state_follows_the_door ["HFS-API-004/a", "HFS-MAG-001", "HFS-GRP-006"]:
        when |s| s.inputs.t_open
            => s.outputs.request == GroupState::Sls2;

    /// With its door closed it runs automatically.
    closed_door_asks_for_automatic_operation ["HFS-API-004/a", "HFS-MAG-004"]:
        when |s| !s.inputs.t_open
            => s.outputs.request == GroupState::Auto;

    /// With the door open only one key together with the permissive activates.
    open_door_needs_one_key_and_permissive ["HFS-MAG-006/b", "HFS-API-012", "HFS-MAG-001", "HFS-PB-002", "HFS-DOOR-003"]:
        when |s| s.inputs.t_open
            => s.outputs.activate == (s.inputs.permissive && s.inputs.keys.is_power_of_two() && s.inputs.gen_safe);

    /// With the door closed the activation comes with a new confirmation and stays until the door opens.
    closed_door_needs_the_confirmation ["HFS-API-012", "HFS-P-13", "HFS-MAG-004"]:
        when |s| !s.inputs.t_open
            => s.outputs.activate == (s.before.confirmed || (!s.before.open && s.inputs.confirm && !s.before.keyed));

    /// With the door closed every axis has its feed enable: keys move without permissive, and the PLC positions.
    closed_door_enables_every_axis ["HFS-MAG-006/a", "HFS-API-017", "HFS-MAG-004"]:
        when |s| !s.inputs.t_open
            => s.outputs.feed == ALL_AXES;

    /// With the door open the axis of the one key alone is enabled, while that is pressed with the permissive.
    open_door_enables_the_axis_of_the_key ["HFS-API-017", "HFS-MAG-001"]:
        when |s| s.inputs.t_open
            => s.outputs.feed
                == if s.inputs.permissive && s.inputs.keys.is_power_of_two() { s.inputs.keys } else { 0 };

    /// With the door closed no stop is asked for.
    closed_door_asks_for_no_stop ["HFS-API-020"]:
        when |s| !s.inputs.t_open
            => s.outputs.stop == Stop::None;

    /// A door that is opened while the magazine moves brakes it by SS1.
    opened_door_in_motion_is_ss1 ["HFS-MAG-002", "HFS-API-023", "HFS-SEQ-008"]:
        when |s| s.inputs.t_open && !s.before.open && s.inputs.moving
            => s.outputs.stop == Stop::Ss1;

    /// Otherwise SS2 with the door open, unless it is moved by hand and the mode stays as it is.
    released_keys_are_ss2 ["HFS-KSW-003/c", "HFS-MAG-003", "HFS-API-023", "HFS-SEQ-008"]:
        when |s| s.inputs.t_open && (s.before.open || !s.inputs.moving)
            => s.outputs.stop
                == if s.inputs.permissive && s.inputs.keys.is_power_of_two() && !s.inputs.som_changed {
                    Stop::None
                } else {
                    Stop::Ss2
                };

    /// A change of the mode with its door open is SS2 or more, whatever is held and whether it moves or not.
    change_of_the_mode_stops ["HFS-KSW-003/c", "HFS-API-023", "HFS-MODE-019"]:
        when |s| s.inputs.t_open && s.inputs.som_changed
            => s.outputs.stop >= Stop::Ss2;

    /// Its own permissive is reported, always.
    own_permissive_is_reported ["HFS-API-026", "HFS-MAG-005", "HFS-PB-004", "HFS-PB-005"]:
        when |s| s.inputs.permissive || s.outputs.permissive
            => s.outputs.permissive == s.inputs.permissive;

    /// The step keeps the invariant.
    state_stays_consistent ["HFS-API-012"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let pressed = inputs.confirm && !state.keyed;
    let confirmed = !inputs.t_open && (state.confirmed || (pressed && !state.open));
    let after = State {
        open: inputs.t_open,
        keyed: inputs.confirm,
        confirmed,
    };
    let moves = inputs.moves();
    let outputs = if inputs.t_open {
        Outputs {
            request: GroupState::Sls2,
            activate: moves != 0 && inputs.gen_safe,
            feed: moves,
            stop: stop(state, inputs),
            permissive: inputs.permissive,
        }
    } else {
        Outputs {
            request: GroupState::Auto,
            activate: confirmed,
            feed: ALL_AXES,
            stop: Stop::None,
            permissive: inputs.permissive,
        }
    };
    (after, outputs)
}

/// The stop with the door open.
fn stop(state: State, inputs: &Inputs) -> Stop {
    if !state.open && inputs.moving {
        Stop::Ss1
    } else if inputs.som_changed || inputs.moves() == 0 {
        Stop::Ss2
    } else {
        Stop::None
    }
}
