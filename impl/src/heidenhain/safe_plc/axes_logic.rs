//! What one safe PLC asks of the kernel for a group of NC axes: monitoring state, activation, feed enable of each axis, stop,
//! permissive.
//!
//! Steps after [`key_filter`](crate::heidenhain::key_filter). The edges of keys are those of the contacts, not of the filtered
//! values: a key that was held while it was filtered starts nothing when the filter lets it through again.
//!
//! Recommended readings of the manual implemented here: AMB-28 EN12417 (or the design of HEIDENHAIN, by the configuration),
//! AMB-52 ON (the open magazine door stops the axes too), AMB-68 PB_ONLY (with the handwheel its permissive alone enables the
//! feed).

use crate::heidenhain::types::{GroupState, Som, Stop, Unit};
use crate::kernel::{ConfigError, Cycles};

/// Every axis of the group has its feed enable.
pub const ALL_AXES: u8 = u8::MAX;

config! {
    /// What the permissive is needed for besides the start.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        t_clear: Cycles,
        hold: bool,
        manual: bool,
    }
}

impl Config {
    /// The longest time accepted: 3 s in cycles of 3 ms.
    pub const LONGEST: Cycles = Cycles::new(1000);

    /// `t_clear`: the program latch falls after the axes have stood so long, 1 s in cycles of the safe PLC, 1 cycle to
    /// [`Config::LONGEST`]. `hold`: in SOM_2 and SOM_3 a program needs the permissive all the time (EN 12417), else only for
    /// its start. `manual`: motion by an axis-direction key needs the permissive as well.
    ///
    /// # Errors
    /// [`ConfigError::NoDelay`] for a time of 0, [`ConfigError::DelayTooLong`] above [`Config::LONGEST`].
    pub fn new(t_clear: Cycles, hold: bool, manual: bool) -> Result<Self, ConfigError> {
        if t_clear.is_zero() {
            return Err(ConfigError::NoDelay);
        }
        Ok(Self {
            t_clear: t_clear.at_most(Self::LONGEST)?,
            hold,
            manual,
        })
    }

    /// How long the axes stand before the program latch falls.
    pub const fn t_clear(&self) -> Cycles {
        self.t_clear
    }

    /// Whether a program needs the permissive all the time in SOM_2 and SOM_3.
    pub const fn hold(&self) -> bool {
        self.hold
    }

    /// Whether axis-direction keys need the permissive.
    pub const fn manual(&self) -> bool {
        self.manual
    }
}

fields! {
    /// The state between two cycles of the safe PLC.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct State {
        /// The door was open in the cycle before.
        pub open: bool,
        /// A key of the axes was pressed in the cycle before.
        pub keyed: bool,
        /// NC start was pressed in the cycle before, or the door was closed.
        pub starts: bool,
        /// A key of the axes was pressed since the door was closed.
        pub latch: bool,
        /// NC start was accepted and is still held with the permissive.
        pub started: bool,
        /// `MG_Program_Running`.
        pub program: bool,
        /// How long the axes have stood, up to the time of the program latch.
        pub rest: Cycles,
    }
}

impl State {
    /// As if the door had been open and every key held: nothing starts by itself when the control comes up.
    pub const INITIAL: Self = Self {
        open: true,
        keyed: true,
        starts: true,
        latch: false,
        started: false,
        program: false,
        rest: Cycles::ZERO,
    };

    /// A latch belongs to the closed door, an accepted start to the open one.
    #[cfg_attr(creusot, creusot_contracts::macros::logic)]
    pub fn invariant(&self, config: &Config) -> bool {
        self.rest <= config.t_clear
            && !(self.latch && self.open)
            && (!self.started || (self.open && self.starts))
            && (!self.program || self.rest < config.t_clear)
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
        /// Axis-direction keys of the panel, filtered: bit k for axis k.
        pub keys: u8,
        /// NC start, filtered.
        pub nc_start: bool,
        /// NC start is pressed, filtered or not.
        pub start_held: bool,
        /// Axis-direction key, NC start or permissive of the handwheel is pressed, filtered or not.
        pub key_held: bool,
        /// NC stop or an external stop.
        pub stop: bool,
        /// `NN_AxGrpState`.
        pub state: GroupState,
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

    /// NC start is pressed, and the filter lets it through.
    const fn start(&self) -> bool {
        self.nc_start && self.start_held
    }

    /// The axis-direction keys that move with the door open: at the panel, not while axes are homed or tested.
    fn manual(&self) -> u8 {
        if self.unit.at_panel() && !self.t_open {
            self.keys
        } else {
            0
        }
    }

    /// Whether the axes may be released with the door open.
    fn may_start(&self) -> bool {
        self.door_open && !self.t_open && self.som != Som::Som1 && self.gen_safe
    }

    /// Whether the group is in a state that permits no motion.
    const fn stands(&self) -> bool {
        !self.state.is_released()
    }

    /// With the door open SOM_1 allows no motion, and so no program.
    fn no_motion(&self) -> bool {
        self.door_open && self.som == Som::Som1
    }

    /// A program that needs its permissive all the time has lost it.
    fn permissive_missing(&self, config: &Config) -> bool {
        let mode = matches!(self.som, Som::Som2 | Som::Som3);
        self.door_open && config.hold && mode && !self.permissive()
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

/// The state that a mode asks for with the door open.
pub const fn limited(som: Som) -> GroupState {
    match som {
        Som::Som1 => GroupState::Sos,
        Som::Som2 => GroupState::Sls2,
        Som::Som3 => GroupState::Sls3,
        Som::Som4 => GroupState::Sls4,
    }
}

monitor! { heidenhain::axes_logic;
    /// With the door open the mode decides the monitoring state, and nothing else.
    open_door_asks_for_the_mode ["HFS-API-002", "HFS-MODE-001", "HFS-MODE-003", "HFS-P-10", "HFS-GRP-006"]:
        when |s| s.inputs.door_open
            => s.outputs.request == limited(s.inputs.som);

    /// With the door closed the mode does not matter.
    closed_door_asks_for_automatic_operation ["HFS-API-002", "HFS-MODE-001", "HFS-GRP-006"]:
        when |s| !s.inputs.door_open
            => s.outputs.request == GroupState::Auto;

    /// With the door closed the activation comes with a new key and stays until the door opens.
    closed_door_activates_by_a_new_key ["HFS-API-006", "HFS-P-13", "HFS-REF-005"]:
        when |s| !s.inputs.door_open
            => s.outputs.activate == (s.before.latch || (!s.before.open && s.inputs.key_held && !s.before.keyed));

    /// In the cycle in which the door is found closed nothing is activated.
    closing_the_door_activates_nothing ["HFS-P-13", "HFS-API-006", "HFS-AXG-005"]:
        when |s| !s.inputs.door_open && s.before.open
            => !s.outputs.activate;

    /// With the door open no key activates in SOM_1, and none while the magazine door is open too.
    som_1_and_both_doors_block ["HFS-API-007", "HFS-API-009", "HFS-MODE-003", "HFS-P-25"]:
        when |s| s.inputs.door_open && (s.inputs.som == Som::Som1 || s.inputs.t_open)
            => !s.outputs.activate;

    /// Without a self-test in force nothing is started with the door open.
    overdue_test_blocks ["HFS-DOOR-003", "HFS-P-51"]:
        when |s| s.inputs.door_open && !s.inputs.gen_safe
            => !s.outputs.activate && (!s.after.program || s.before.program);

    /// At the panel a direction key activates without permissive, unless axes are homed or tested.
    direction_key_activates ["HFS-MODE-004/d", "HFS-API-007", "HFS-SEQ-003", "HFS-SEQ-004"]:
        when |s| s.inputs.may_start() && s.inputs.unit.at_panel() && s.inputs.keys != 0
            => s.outputs.activate;

    /// NC start activates from its edge with the permissive until one of them is released.
    nc_start_activates_from_its_edge ["HFS-MODE-004/f", "HFS-MODE-005/d", "HFS-API-007", "HFS-PB-002", "HFS-SEQ-006", "HFS-REF-004"]:
        when |s| s.inputs.may_start() && s.inputs.unit != Unit::Handwheel && s.inputs.manual() == 0
            => s.outputs.activate
                == (s.inputs.panel && s.inputs.start() && (!s.before.starts || s.before.started));

    /// With the handwheel its permissive activates, and nothing else.
    handwheel_activates_by_its_permissive ["HFS-MODE-004/g", "HFS-API-008", "HFS-PB-002"]:
        when |s| s.inputs.may_start() && s.inputs.unit == Unit::Handwheel
            => s.outputs.activate == s.inputs.wheel;

    /// With the door closed every axis has its feed enable.
    closed_door_enables_every_axis ["HFS-API-015"]:
        when |s| !s.inputs.door_open
            => s.outputs.feed == ALL_AXES;

    /// At the panel all axes are enabled exactly while a program runs, else those whose key is pressed.
    panel_enables_program_or_keys ["HFS-API-015", "HFS-SEQ-003", "HFS-SEQ-004", "HFS-SEQ-006", "HFS-P-48"]:
        when |s| s.inputs.door_open && s.inputs.unit.at_panel() && !s.config.manual
            => s.outputs.feed == if s.after.program { ALL_AXES } else { s.inputs.manual() };

    /// With the handwheel exactly its permissive enables, in a program too.
    handwheel_enables_by_its_permissive ["HFS-API-040", "HFS-SEQ-006", "HFS-API-015", "HFS-MODE-008"]:
        when |s| s.inputs.door_open && s.inputs.unit == Unit::Handwheel && !s.config.manual
            => s.outputs.feed == if s.inputs.permissive() { ALL_AXES } else { 0 };

    /// While axes are homed or tested a running program enables them all, a key none.
    reference_run_enables_by_program ["HFS-API-015", "HFS-REF-004", "HFS-REF-015"]:
        when |s| s.inputs.door_open && s.inputs.unit == Unit::Reference && !s.config.manual
            => s.outputs.feed == if s.after.program { ALL_AXES } else { 0 };

    /// Where direction keys need the permissive, every axis is enabled, and without permissive the group is stopped.
    simple_manual_operation_stops_by_permissive ["HFS-API-024"]:
        when |s| s.config.manual && s.inputs.door_open
            => s.outputs.feed == ALL_AXES && (s.inputs.permissive() || s.outputs.stop == Stop::Ss2);

    /// With the door closed no stop is asked for.
    closed_door_asks_for_no_stop ["HFS-API-020"]:
        when |s| !s.inputs.door_open
            => s.outputs.stop == Stop::None;

    /// With the door open a stop key, a change of the mode and an open magazine door stop along the contour.
    open_door_stops_by_event ["HFS-API-021", "HFS-SS2-009/a", "HFS-SS2-009/b", "HFS-SEQ-007", "HFS-KSW-003/a"]:
        when |s| s.inputs.door_open && (s.inputs.stop || s.inputs.som_changed || s.inputs.t_open)
            => s.outputs.stop == Stop::Ss2;

    /// A program whose permissive goes in SOM_2 or SOM_3 loses its latch, and the axes stop in that cycle.
    program_needs_its_permissive ["HFS-API-014", "HFS-MODE-009", "HFS-SS2-008/c", "HFS-FAULT-016/b"]:
        when |s| s.before.program && s.inputs.permissive_missing(&s.config)
            => !s.after.program && s.outputs.stop == Stop::Ss2;

    /// A door that is opened while a program runs without permissive ends it, in every mode.
    opened_door_stops_a_program ["HFS-SS2-009/c"]:
        when |s| s.inputs.door_open && !s.before.open && s.before.program && !s.inputs.permissive()
            => !s.after.program && s.outputs.stop == Stop::Ss2;

    /// Nothing else asks for a stop: one cycle of it is enough.
    nothing_else_stops ["HFS-API-019", "HFS-API-021", "HFS-API-014", "HFS-MODE-009"]:
        when |s| s.outputs.stop != Stop::None
            => s.inputs.stop || s.inputs.som_changed || s.inputs.t_open
                || (s.before.program && !s.inputs.permissive()
                    && (!s.before.open || s.inputs.permissive_missing(&s.config)))
                || (s.config.manual && !s.inputs.permissive());

    /// The program latch comes with an accepted start or with the activation behind a closed door.
    program_latch_needs_a_start ["HFS-API-013"]:
        when |s| s.after.program && !s.before.program
            => if s.inputs.door_open {
                s.inputs.start_held && !s.before.starts && s.inputs.permissive() && s.inputs.may_start()
            } else {
                s.outputs.activate
            };

    /// An accepted start sets it together with the activation.
    accepted_start_sets_the_latch ["HFS-API-013", "HFS-SEQ-006"]:
        when |s| s.after.started && !s.before.started
            => s.after.program && s.outputs.activate;

    /// It falls when the axes have stood for its time, and before that only with the permissive or in SOM_1.
    program_latch_falls_in_standstill ["HFS-API-013"]:
        when |s| s.before.program && !s.after.program && !s.inputs.no_motion()
            && (s.inputs.permissive() || (s.before.open && !s.inputs.permissive_missing(&s.config)))
            => s.inputs.stands() && s.before.rest.count() + 1 == s.config.t_clear.count();

    /// The time that the axes stand ends the latch unless a new start comes.
    standstill_is_timed ["HFS-API-013"]:
        when |s| s.before.program && s.inputs.stands()
            => !s.after.program || s.after.rest > s.before.rest
                || (s.inputs.key_held && !s.before.keyed) || (s.inputs.start_held && !s.before.starts);

    /// The permissive of one unit is reported, and none while both doors are open.
    one_permissive_is_reported ["HFS-API-026", "HFS-PB-004", "HFS-PB-005", "HFS-P-25"]:
        when |s| s.outputs.permissive
            => !(s.inputs.door_open && s.inputs.t_open)
                && (if s.inputs.unit == Unit::Handwheel { s.inputs.wheel } else { s.inputs.panel });

    /// A permissive that counts is reported.
    permissive_is_not_lost ["HFS-API-026", "HFS-PB-005"]:
        when |s| s.inputs.permissive()
            => s.outputs.permissive;

    /// The activation that falls asks for no stop of its own.
    activation_that_falls_stops_nothing ["HFS-AXG-020"]:
        when |s| s.before.started && !s.after.started && s.inputs.door_open && !s.config.manual
            && !s.inputs.stop && !s.inputs.som_changed && !s.inputs.t_open && s.inputs.permissive()
            => s.outputs.stop == Stop::None;

    /// The step keeps the invariant.
    state_stays_consistent ["HFS-API-013"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let pressed = inputs.key_held && !state.keyed;
    let edge = inputs.start_held && !state.starts;
    let latch = !inputs.door_open && (state.latch || (pressed && !state.open));
    let accepted = inputs.may_start() && inputs.permissive() && inputs.start();
    let started = accepted && (edge || state.started);

    // A new start begins a new standstill: else the latch would fall before the kernel has released the group.
    let begins = (started && edge) || (latch && !state.latch);
    let rest = if !inputs.stands() || begins {
        Cycles::ZERO
    } else {
        Cycles::new(state.rest.count().saturating_add(1)).min(config.t_clear)
    };
    let missing = inputs.permissive_missing(config);
    let opened = inputs.door_open && !state.open && !inputs.permissive();
    let lost = state.program && (missing || opened);
    let set = (started && edge) || latch;
    let program = (state.program || set) && !lost && !inputs.no_motion() && rest < config.t_clear;

    let after = State {
        open: inputs.door_open,
        keyed: inputs.key_held,
        // A start key counts only behind the open door: one that is pressed while it opens has to be pressed again.
        starts: inputs.start_held || !inputs.door_open,
        latch,
        started,
        program,
        rest,
    };
    let outputs = Outputs {
        request: if inputs.door_open {
            limited(inputs.som)
        } else {
            GroupState::Auto
        },
        activate: latch || started || by_hand(inputs),
        feed: feed(config, inputs, program),
        stop: if inputs.door_open && (stops(config, inputs) || lost) {
            Stop::Ss2
        } else {
            Stop::None
        },
        permissive: inputs.permissive(),
    };
    (after, outputs)
}

/// Whether motion by hand is asked for with the door open.
fn by_hand(inputs: &Inputs) -> bool {
    inputs.may_start()
        && if inputs.unit == Unit::Handwheel {
            inputs.wheel
        } else {
            inputs.manual() != 0
        }
}

/// The axes that are enabled.
fn feed(config: &Config, inputs: &Inputs, program: bool) -> u8 {
    let all = if inputs.unit == Unit::Handwheel {
        inputs.permissive()
    } else {
        program
    };
    if all || !inputs.door_open || config.manual {
        ALL_AXES
    } else {
        inputs.manual()
    }
}

/// Whether an event of this cycle stops the axes with the door open.
fn stops(config: &Config, inputs: &Inputs) -> bool {
    inputs.stop || inputs.som_changed || inputs.t_open || (config.manual && !inputs.permissive())
}
