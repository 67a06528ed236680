//! Filter of the keys in one safe PLC: with the door of the working space open one operating unit starts motions, none while
//! the magazine door is open too.
//!
//! Only keys that start something are filtered, and only to 0; a key that stops is handed on from every unit. The group signal
//! of the machine keys is formed before.
//!
//! Recommended reading of the manual implemented here: AMB-54 CLEAR_UNLESS_TM (with its door open the magazine has a key only
//! together with its permissive, and only one).

use crate::heidenhain::types::Unit;

pub use crate::contract::Stateless as State;

config! {
    /// The function has no parameters.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Config;
}

fields! {
    /// The keys of one operating unit that start a motion. Statuses, not events: the PLC and the safe PLC run at clocks of their
    /// own (HFS-SPLC-004). Those of the handwheel, but for its permissive, come from the PLC and are not safe: no motion behind an
    /// open door comes of them alone (HFS-SPLC-006).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Keys {
        /// The permissive button or key is valid: see [`button`](crate::heidenhain::button).
        pub permissive: bool,
        /// Axis-direction keys: bit k is set while a key of axis k of the group is pressed. On the panel both contacts; those of
        /// the handwheel have one channel.
        pub axes: u8,
        /// NC start.
        pub nc_start: bool,
        /// Spindle jog.
        pub jog: bool,
        /// Spindle start.
        pub spindle_start: bool,
    }
}

impl Keys {
    /// No key.
    pub const NONE: Self = Self {
        permissive: false,
        axes: 0,
        nc_start: false,
        jog: false,
        spindle_start: false,
    };

    /// Whether a key but those for directions is pressed.
    pub const fn starts(self) -> bool {
        self.permissive || self.nc_start || self.jog || self.spindle_start
    }

    /// Whether every key that is pressed here is pressed in `other` too.
    pub const fn within(self, other: Self) -> bool {
        (!self.permissive || other.permissive)
            && self.axes & !other.axes == 0
            && (!self.nc_start || other.nc_start)
            && (!self.jog || other.jog)
            && (!self.spindle_start || other.spindle_start)
    }
}

fields! {
    /// The inputs of one cycle of the safe PLC, as the contacts and the PLC give them.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// A guard door of the working space of axes and spindle is open.
        pub door_open: bool,
        /// The magazine door is open.
        pub t_open: bool,
        /// The machine operating mode.
        pub unit: Unit,
        /// Keys of the operating panel.
        pub panel: Keys,
        /// Keys of the handwheel.
        pub wheel: Keys,
        /// A stop key of any unit is pressed, or an external stop is asked for.
        pub stop: bool,
        /// The permissive key of the magazine is valid.
        pub t_permissive: bool,
        /// Motion keys of the magazine: bit k is set while a key of its axis k is pressed.
        pub t_keys: u8,
        /// The key by which the operator confirms that nobody is in the magazine.
        pub confirm: bool,
    }
}

impl Inputs {
    /// Whether the keys of the panel may start something.
    fn panel_acts(&self) -> bool {
        !self.door_open || (!self.t_open && self.unit != Unit::Handwheel)
    }

    /// Whether the keys of the handwheel may start something.
    fn wheel_acts(&self) -> bool {
        !self.door_open || (!self.t_open && self.unit == Unit::Handwheel)
    }

    /// Whether the keys of the magazine may start something.
    const fn magazine_acts(&self) -> bool {
        !self.t_open || (self.t_permissive && self.t_keys.count_ones() == 1)
    }
}

fields! {
    /// The outputs of one cycle: what is evaluated further, and what the PLC sees.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// Keys of the operating panel.
        pub panel: Keys,
        /// Keys of the handwheel.
        pub wheel: Keys,
        /// A stop is asked for.
        pub stop: bool,
        /// The permissive key of the magazine.
        pub t_permissive: bool,
        /// Motion keys of the magazine.
        pub t_keys: u8,
        /// `PP_GenMKG`: a key without stop function is pressed.
        pub machine_keys: bool,
    }
}

monitor! { heidenhain::key_filter;
    /// The filter sets nothing.
    filter_only_clears ["HFS-P-24", "HFS-FILT-001", "HFS-SPLC-008"]:
        when |s| s.outputs.panel != Keys::NONE || s.outputs.wheel != Keys::NONE || s.outputs.t_permissive || s.outputs.t_keys != 0
            => s.outputs.panel.within(s.inputs.panel) && s.outputs.wheel.within(s.inputs.wheel)
                && (!s.outputs.t_permissive || s.inputs.t_permissive) && s.outputs.t_keys & !s.inputs.t_keys == 0;

    /// A key that stops is never filtered, whichever unit it is on.
    stop_keys_pass ["HFS-P-23", "HFS-FILT-001", "HFS-FILT-006", "HFS-UNIT-001"]:
        when |s| s.inputs.stop || s.outputs.stop
            => s.outputs.stop == s.inputs.stop;

    /// With the door open one unit at most is active.
    one_unit_at_a_time ["HFS-P-23", "HFS-UNIT-001", "HFS-FILT-006", "HFS-PB-004"]:
        when |s| s.inputs.door_open
            => s.outputs.panel == Keys::NONE || s.outputs.wheel == Keys::NONE;

    /// With the door open the handwheel is active in its operating mode only.
    handwheel_needs_its_mode ["HFS-FILT-002", "HFS-FILT-006"]:
        when |s| s.inputs.door_open && s.inputs.unit != Unit::Handwheel
            => s.outputs.wheel == Keys::NONE;

    /// With the door open the panel is not active in the operating mode of the handwheel.
    panel_yields_to_the_handwheel ["HFS-FILT-003", "HFS-FILT-006"]:
        when |s| s.inputs.door_open && s.inputs.unit == Unit::Handwheel
            => s.outputs.panel == Keys::NONE;

    /// With both doors open neither unit starts anything.
    both_doors_open_start_nothing ["HFS-FILT-006", "HFS-FILT-002", "HFS-FILT-003", "HFS-P-25"]:
        when |s| s.inputs.door_open && s.inputs.t_open
            => s.outputs.panel == Keys::NONE && s.outputs.wheel == Keys::NONE;

    /// The unit of the operating mode is not disturbed while the magazine door is closed.
    active_unit_acts ["HFS-FILT-006", "HFS-UNIT-001"]:
        when |s| s.inputs.door_open && !s.inputs.t_open
            => if s.inputs.unit == Unit::Handwheel {
                s.outputs.wheel == s.inputs.wheel
            } else {
                s.outputs.panel == s.inputs.panel
            };

    /// With the door closed nothing is filtered, whatever the magazine door does.
    closed_door_filters_nothing ["HFS-FILT-002", "HFS-FILT-003"]:
        when |s| !s.inputs.door_open
            => s.outputs.panel == s.inputs.panel && s.outputs.wheel == s.inputs.wheel;

    /// With its door open the magazine has one key at a time, together with its own permissive; with the door closed all.
    magazine_keys_need_their_permissive ["HFS-FILT-004", "HFS-MAG-005"]:
        when |s| s.inputs.t_keys != 0
            => (s.outputs.t_keys == s.inputs.t_keys || s.outputs.t_keys == 0)
                && (s.outputs.t_keys == 0)
                    == (s.inputs.t_open && !(s.inputs.t_permissive && s.inputs.t_keys.is_power_of_two()));

    /// No door and no operating mode takes the magazine its permissive.
    magazine_keeps_its_permissive ["HFS-MAG-005", "HFS-API-026"]:
        when |s| s.inputs.t_permissive
            => s.outputs.t_permissive;

    /// The group signal knows every key without stop function before the filter, the direction keys of the handwheel excepted.
    machine_keys_are_unfiltered ["HFS-API-030", "HFS-MKEY-001", "HFS-FILT-001"]:
        when |s| s.outputs.machine_keys || s.inputs.panel != Keys::NONE || s.inputs.wheel != Keys::NONE
            => s.outputs.machine_keys
                == (s.inputs.panel != Keys::NONE || s.inputs.wheel.starts() || s.inputs.t_permissive
                    || s.inputs.t_keys != 0 || s.inputs.confirm);
}

pub(crate) fn transition(state: State, _: &Config, inputs: &Inputs) -> (State, Outputs) {
    let keep = |acts: bool, keys: Keys| if acts { keys } else { Keys::NONE };
    let outputs = Outputs {
        panel: keep(inputs.panel_acts(), inputs.panel),
        wheel: keep(inputs.wheel_acts(), inputs.wheel),
        stop: inputs.stop,
        t_permissive: inputs.t_permissive,
        t_keys: if inputs.magazine_acts() {
            inputs.t_keys
        } else {
            0
        },
        machine_keys: inputs.panel.starts()
            || inputs.panel.axes != 0
            || inputs.wheel.starts()
            || inputs.t_permissive
            || inputs.t_keys != 0
            || inputs.confirm,
    };
    (state, outputs)
}
