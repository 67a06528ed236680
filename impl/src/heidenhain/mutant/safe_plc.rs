//! Wrong variants of the blocks of the safe PLC.

use crate::heidenhain::types::{GroupState, Stop, Unit};
use crate::heidenhain::{axes_logic, key_filter, magazine_logic, spindle_logic};

variants! {
    key_filter_drops_stops: key_filter |state, config, inputs| {
        let (after, mut outputs) = key_filter::transition(state, config, inputs);
        outputs.stop &= !(inputs.door_open && inputs.t_open);
        (after, outputs)
    }

    key_filter_two_units: key_filter |state, config, inputs| {
        let (after, mut outputs) = key_filter::transition(state, config, inputs);
        if !inputs.t_open {
            outputs.wheel = inputs.wheel;
        }
        (after, outputs)
    }

    key_filter_group_signal_late: key_filter |state, config, inputs| {
        let (after, mut outputs) = key_filter::transition(state, config, inputs);
        outputs.machine_keys = outputs.panel.starts()
            || outputs.panel.axes != 0
            || outputs.wheel.starts()
            || outputs.t_permissive
            || outputs.t_keys != 0
            || inputs.confirm;
        (after, outputs)
    }

    axes_logic_held_key_starts: axes_logic |state, config, inputs| {
        let state = axes_logic::State { open: false, keyed: false, ..state };
        axes_logic::transition(state, config, inputs)
    }

    axes_logic_start_by_level: axes_logic |state, config, inputs| {
        let state = axes_logic::State { starts: false, ..state };
        axes_logic::transition(state, config, inputs)
    }

    axes_logic_forgets_the_permissive: axes_logic |state, config, inputs| {
        let (mut after, mut outputs) = axes_logic::transition(state, config, inputs);
        if state.program && !inputs.permissive() && inputs.door_open && outputs.stop == Stop::Ss2 {
            after.program = true;
            outputs.stop = Stop::None;
        }
        (after, outputs)
    }

    axes_logic_magazine_door_overlooked: axes_logic |state, config, inputs| {
        axes_logic::transition(state, config, &axes_logic::Inputs { t_open: false, ..*inputs })
    }

    spindle_logic_jog_runs_on: spindle_logic |state, config, inputs| {
        let state = spindle_logic::State { jogged: false, ..state };
        spindle_logic::transition(state, config, inputs)
    }

    spindle_logic_no_permissive: spindle_logic |state, config, inputs| {
        let (after, mut outputs) = spindle_logic::transition(state, config, inputs);
        let given = spindle_logic::Inputs {
            unit: Unit::Panel,
            panel: true,
            ..*inputs
        };
        outputs.activate = spindle_logic::transition(state, config, &given).1.activate;
        (after, outputs)
    }

    spindle_logic_restricted_in_som_1: spindle_logic |state, config, inputs| {
        let (after, mut outputs) = spindle_logic::transition(state, config, inputs);
        if inputs.door_open && inputs.restricted && !inputs.holder_open {
            outputs.request = GroupState::SlsS;
        }
        (after, outputs)
    }

    magazine_logic_door_is_ss2: magazine_logic |state, config, inputs| {
        let inputs = magazine_logic::Inputs { moving: false, ..*inputs };
        magazine_logic::transition(state, config, &inputs)
    }

    magazine_logic_confirmed_for_ever: magazine_logic |state, config, inputs| {
        let (mut after, outputs) = magazine_logic::transition(state, config, inputs);
        after.confirmed |= state.confirmed;
        (after, outputs)
    }

    magazine_logic_permissive_is_enough: magazine_logic |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.t_open && inputs.permissive && !inputs.keys.is_power_of_two() {
            inputs.keys = 1;
        }
        magazine_logic::transition(state, config, &inputs)
    }
}
