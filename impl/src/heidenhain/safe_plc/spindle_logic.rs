//! What one safe PLC asks of the kernel for a spindle group: monitoring state, activation, stop, permissive. Its feed enable
//! is always given (HFS-API-016): activation and stop protect against a motion that nobody expects.
//!
//! Steps after [`key_filter`](crate::heidenhain::key_filter) and [`tool_holder`](crate::heidenhain::tool_holder). With the door
//! open no program starts the spindle: only its own keys activate, together with the permissive. Auxiliary axes that are reached
//! from the normal working space follow the same rules, with their motion key for the jog key (HFS-API-004).
//!
//! Recommended readings of the manual implemented here: AMB-52 ON (the open magazine door stops the spindle too); AMB-74: every
//! change of the mode with the door open is SS2, that to SOM_1 included (6.1.6), although the table of 8.10.4 is one of SOM_2 to SOM_4.

use crate::heidenhain::axes_logic::limited;
use crate::heidenhain::types::{GroupState, Som, Stop, Unit};

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
        /// A key of the spindle was pressed in the cycle before.
        pub keyed: bool,
        /// Spindle start was pressed in the cycle before, or the door was closed.
        pub starts: bool,
        /// Spindle jog was pressed in the cycle before.
        pub jogged: bool,
        /// A key of the spindle was pressed since the door was closed.
        pub latch: bool,
        /// Spindle start was accepted and is still held with the permissive.
        pub started: bool,
    }
}

impl State {
    /// As if the door had been open and every start key held: nothing starts by itself when the control comes up.
    pub const INITIAL: Self = Self {
        open: true,
        keyed: true,
        starts: true,
        jogged: false,
        latch: false,
        started: false,
    };

    /// A latch belongs to the closed door, an accepted start to the open one.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub const fn invariant(&self, _config: &Config) -> bool {
        !(self.latch && self.open) && (!self.started || (self.open && self.starts))
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
        /// A guard door of the working space is open.
        pub door_open: bool,
        /// The magazine door is open.
        pub t_open: bool,
        /// The safe operating mode.
        pub som: Som,
        /// It has changed in this cycle.
        pub som_changed: bool,
        /// The machine operating mode.
        pub unit: Unit,
        /// Valid permissive of the panel, filtered.
        pub panel: bool,
        /// Valid permissive of the handwheel, filtered.
        pub wheel: bool,
        /// Spindle jog, filtered.
        pub jog: bool,
        /// Spindle jog is pressed, filtered or not: its release stops, so the filter has no part in it.
        pub jog_held: bool,
        /// Spindle start, filtered.
        pub spindle_start: bool,
        /// Spindle start is pressed, filtered or not.
        pub start_held: bool,
        /// Spindle jog, spindle start, NC start or permissive of the handwheel is pressed, filtered or not.
        pub key_held: bool,
        /// Spindle stop or an external stop.
        pub stop: bool,
        /// The PLC asks for restricted spindle operation.
        pub restricted: bool,
        /// A tool holder of the group is open, or is about to be: no torque.
        pub holder_open: bool,
        /// `NN_GenSafe`: the self-test has passed and is not overdue; else no motion is started with the door open.
        pub gen_safe: bool,
    }
}

impl Inputs {
    /// The permissive that counts: one unit's, and none while both doors are open.
    pub fn permissive(&self) -> bool {
        let both_doors_open = self.door_open && self.t_open;
        super::permissive(self.unit, self.panel, self.wheel, both_doors_open)
    }

    /// Whether the spindle may be released with the door open.
    fn may_start(&self) -> bool {
        self.door_open
            && !self.t_open
            && self.som != Som::Som1
            && self.gen_safe
            && self.permissive()
    }

    /// Spindle start is pressed, and the filter lets it through.
    const fn start(&self) -> bool {
        self.spindle_start && self.start_held
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
        /// `PP_AxGrpStopReq`.
        pub stop: Stop,
        /// `PP_AxGrpPB`.
        pub permissive: bool,
    }
}

monitor! { heidenhain::spindle_logic;
    /// A spindle whose tool holder is open has no torque, whatever the doors do.
    open_holder_takes_the_torque ["HFS-API-003", "HFS-TH-004"]:
        when |s| s.inputs.holder_open
            => s.outputs.request == GroupState::StoO;

    /// With the door open the mode decides; restricted operation replaces the limit of SOM_2 to SOM_4, never the standstill of SOM_1.
    open_door_asks_for_the_mode ["HFS-API-004/b", "HFS-API-003", "HFS-MODE-001", "HFS-MODE-003", "HFS-MODE-013", "HFS-GRP-006"]:
        when |s| s.inputs.door_open && !s.inputs.holder_open
            => s.outputs.request == if s.inputs.restricted && s.inputs.som != Som::Som1 {
                GroupState::SlsS
            } else {
                limited(s.inputs.som)
            };

    /// With the door closed neither mode nor restricted operation matters.
    closed_door_asks_for_automatic_operation ["HFS-API-003", "HFS-MODE-001", "HFS-GRP-006"]:
        when |s| !s.inputs.door_open && !s.inputs.holder_open
            => s.outputs.request == GroupState::Auto;

    /// With the door closed the activation comes with a new key and stays until the door opens.
    closed_door_activates_by_a_new_key ["HFS-API-010", "HFS-P-13"]:
        when |s| !s.inputs.door_open
            => s.outputs.activate == (s.before.latch || (!s.before.open && s.inputs.key_held && !s.before.keyed));

    /// With the door open: never in SOM_1, without permissive, or while the magazine door is open too.
    no_start_without_permissive ["HFS-API-011", "HFS-API-009", "HFS-MODE-003", "HFS-MODE-004/h", "HFS-PB-002", "HFS-P-25"]:
        when |s| s.inputs.door_open && s.outputs.activate
            => s.inputs.som != Som::Som1 && !s.inputs.t_open
                && (if s.inputs.unit == Unit::Handwheel { s.inputs.wheel } else { s.inputs.panel });

    /// Without a self-test in force nothing is started with the door open.
    overdue_test_blocks ["HFS-DOOR-003", "HFS-P-51"]:
        when |s| s.inputs.door_open && !s.inputs.gen_safe
            => !s.outputs.activate;

    /// Only the keys of the spindle activate with the door open: a program that turns it on does not.
    program_starts_no_spindle ["HFS-MODE-010", "HFS-API-011"]:
        when |s| s.inputs.door_open && !s.inputs.jog && !s.inputs.spindle_start
            => !s.outputs.activate;

    /// Jog activates while it is pressed with the permissive.
    jog_activates ["HFS-API-011", "HFS-SEQ-001"]:
        when |s| s.inputs.may_start() && s.inputs.jog
            => s.outputs.activate;

    /// Spindle start activates from its edge with the permissive until one of them is released.
    start_activates_from_its_edge ["HFS-MODE-004/h", "HFS-API-011", "HFS-SEQ-002"]:
        when |s| s.inputs.may_start() && !s.inputs.jog
            => s.outputs.activate == (s.inputs.start() && (!s.before.starts || s.before.started));

    /// With the door closed no stop is asked for.
    closed_door_asks_for_no_stop ["HFS-API-020"]:
        when |s| !s.inputs.door_open
            => s.outputs.stop == Stop::None;

    /// In SOM_1 with the door open the standstill asked for suffices: no stop is asked for, but by the change to it.
    som_1_asks_for_no_stop ["HFS-API-022"]:
        when |s| s.inputs.door_open && s.inputs.som == Som::Som1
            => s.outputs.stop == if s.inputs.som_changed { Stop::Ss2 } else { Stop::None }
                && s.outputs.request.strictness() >= GroupState::Sos.strictness();

    /// Every change of the mode with the door open asks for SS2 or more.
    every_change_of_the_mode_stops ["HFS-KSW-003/b", "HFS-FAULT-018"]:
        when |s| s.inputs.door_open && s.inputs.som_changed
            => s.outputs.stop >= Stop::Ss2;

    /// With both doors open the spindle stops after the axes: SS1D, above every other request.
    both_doors_stop_after_the_axes ["HFS-API-022", "HFS-SEQ-007", "HFS-API-009"]:
        when |s| s.inputs.door_open && s.inputs.t_open && s.inputs.som != Som::Som1
            => s.outputs.stop == Stop::Ss1D;

    /// With its door open alone: SS2 by the stop key, a change of the mode and a jog key that is released, else nothing; one
    /// cycle is enough.
    open_door_stops_by_event ["HFS-API-022", "HFS-API-019", "HFS-SS2-009/b", "HFS-SS2-009/d", "HFS-SS2-009/e", "HFS-FAULT-024", "HFS-SEQ-001", "HFS-SEQ-002", "HFS-KSW-003/b"]:
        when |s| s.inputs.door_open && !s.inputs.t_open && s.inputs.som != Som::Som1
            => s.outputs.stop == if s.inputs.stop || s.inputs.som_changed || (s.before.jogged && !s.inputs.jog_held) {
                Stop::Ss2
            } else {
                Stop::None
            };

    /// The permissive of one unit is reported, and none while both doors are open.
    one_permissive_is_reported ["HFS-API-026", "HFS-PB-004", "HFS-PB-005", "HFS-P-25"]:
        when |s| s.outputs.permissive
            => !(s.inputs.door_open && s.inputs.t_open)
                && (if s.inputs.unit == Unit::Handwheel { s.inputs.wheel } else { s.inputs.panel });

    /// A permissive that counts is reported.
    permissive_is_not_lost ["HFS-API-026", "HFS-PB-005"]:
        when |s| s.inputs.permissive()
            => s.outputs.permissive;

    /// A start that is released stops nothing.
    activation_that_falls_stops_nothing ["HFS-AXG-020", "HFS-SEQ-002"]:
        when |s| s.before.started && !s.after.started && s.inputs.door_open && !s.before.jogged
            && !s.inputs.stop && !s.inputs.som_changed && !s.inputs.t_open
            => s.outputs.stop == Stop::None;

    /// The step keeps the invariant.
    state_stays_consistent ["HFS-API-010", "HFS-API-011"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let pressed = inputs.key_held && !state.keyed;
    let edge = inputs.start_held && !state.starts;
    let latch = !inputs.door_open && (state.latch || (pressed && !state.open));
    let started = inputs.may_start() && inputs.start() && (edge || state.started);
    let after = State {
        open: inputs.door_open,
        keyed: inputs.key_held,
        // A start key counts only behind the open door: one that is pressed while it opens has to be pressed again.
        starts: inputs.start_held || !inputs.door_open,
        jogged: inputs.jog_held,
        latch,
        started,
    };
    let outputs = Outputs {
        request: request(inputs),
        activate: latch || started || (inputs.may_start() && inputs.jog),
        stop: stop(state, inputs),
        permissive: inputs.permissive(),
    };
    (after, outputs)
}

fn request(inputs: &Inputs) -> GroupState {
    if inputs.holder_open {
        GroupState::StoO
    } else if !inputs.door_open {
        GroupState::Auto
    } else if inputs.restricted && inputs.som != Som::Som1 {
        GroupState::SlsS
    } else {
        limited(inputs.som)
    }
}

fn stop(state: State, inputs: &Inputs) -> Stop {
    let released = state.jogged && !inputs.jog_held;
    if !inputs.door_open {
        Stop::None
    } else if inputs.som == Som::Som1 {
        if inputs.som_changed {
            Stop::Ss2
        } else {
            Stop::None
        }
    } else if inputs.t_open {
        Stop::Ss1D
    } else if inputs.stop || inputs.som_changed || released {
        Stop::Ss2
    } else {
        Stop::None
    }
}
