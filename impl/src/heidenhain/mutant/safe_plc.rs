//! Wrong variants of the blocks of the safe PLC.

use crate::heidenhain::types::{GroupState, Kind, Som, Stop, Unit};
use crate::heidenhain::{
    allowed_functions, availability, axes_logic, control_voltage, f_limited, general_fields,
    group_motion, jog_increment, key_filter, magazine_logic, program_check, safe_input,
    safe_output, spindle_logic, working_space,
};

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

    magazine_logic_mode_overlooked: magazine_logic |state, config, inputs| {
        let inputs = magazine_logic::Inputs { som_changed: false, ..*inputs };
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

    safe_input_one_contact: safe_input |state, config, inputs| {
        let either = inputs.contact_a || inputs.contact_b;
        let inputs = safe_input::Inputs { contact_a: either, contact_b: either };
        safe_input::transition(state, config, &inputs)
    }

    working_space_one_door: working_space |state, config, inputs| {
        let closed = if inputs.closed != 0 { u8::MAX } else { 0 };
        working_space::transition(state, config, &working_space::Inputs { closed })
    }

    control_voltage_one_reset: control_voltage |state, config, inputs| {
        let (mut after, outputs) = control_voltage::transition(state, config, inputs);
        after.armed |= state.armed;
        (after, outputs)
    }

    jog_increment_repeats: jog_increment |state, config, inputs| {
        let (mut after, outputs) = jog_increment::transition(state, config, inputs);
        if after.jog == jog_increment::Jog::Ended {
            after.jog = jog_increment::Jog::Ready;
        }
        (after, outputs)
    }

    jog_increment_no_stop: jog_increment |state, config, inputs| {
        let (after, mut outputs) = jog_increment::transition(state, config, inputs);
        outputs.stop = Stop::None;
        (after, outputs)
    }

    general_fields_any_number: general_fields |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.drives = inputs.drives.min(1);
        general_fields::transition(state, config, &inputs)
    }

    program_check_message_only: program_check |state, config, inputs| {
        let (mut after, mut outputs) = program_check::transition(state, config, inputs);
        outputs.good |= inputs.translated;
        after.good = outputs.good;
        (after, outputs)
    }

    availability_auxiliary_stop: availability |state, config, inputs| {
        let (after, mut outputs) = availability::transition(state, config, inputs);
        outputs.available |= inputs.kind == Kind::Auxiliary
            && inputs.function == availability::Function::Sos;
        (after, outputs)
    }

    allowed_functions_conveyor: allowed_functions |state, config, inputs| {
        let inputs = allowed_functions::Inputs { permissive: true, ..*inputs };
        allowed_functions::transition(state, config, &inputs)
    }

    f_limited_som_1_moves: f_limited |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.som == Som::Som1 {
            inputs.som = Som::Som2;
        }
        f_limited::transition(state, config, &inputs)
    }

    group_motion_first_axis: group_motion |state, config, inputs| {
        let axes = inputs.axes & 1;
        group_motion::transition(state, config, &group_motion::Inputs { axes })
    }

    safe_output_stays_on: safe_output |state, config, inputs| {
        let inputs = safe_output::Inputs { enabled: true, ..*inputs };
        safe_output::transition(state, config, &inputs)
    }
}
