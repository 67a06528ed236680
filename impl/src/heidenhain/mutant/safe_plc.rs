//! Wrong variants of the blocks of the safe PLC.

use crate::heidenhain::types::{GroupState, Kind, Som, Stop, Unit};
use crate::heidenhain::{
    allowed_functions, availability, axes_logic, control_voltage, f_limited, general_fields,
    group_motion, jog_increment, key_filter, magazine_logic, program_check, safe_input,
    safe_output, spindle_logic, working_space,
};

variants! { heidenhain::key_filter:
    /// A stop key of a unit that is not active is filtered.
    "key-filter-drops-stops" |state, config, inputs| {
        let (after, mut outputs) = key_filter::transition(state, config, inputs);
        outputs.stop &= !(inputs.door_open && inputs.t_open);
        (after, outputs)
    }

    /// The handwheel acts in every operating mode.
    "key-filter-two-units" |state, config, inputs| {
        let (after, mut outputs) = key_filter::transition(state, config, inputs);
        if !inputs.t_open {
            outputs.wheel = inputs.wheel;
        }
        (after, outputs)
    }

    /// The group signal is formed of what the filter lets through.
    "key-filter-group-signal-late" |state, config, inputs| {
        let (after, mut outputs) = key_filter::transition(state, config, inputs);
        outputs.machine_keys = outputs.panel.starts()
            || outputs.panel.axes != 0
            || outputs.wheel.starts()
            || outputs.t_permissive
            || outputs.t_keys != 0
            || inputs.confirm;
        (after, outputs)
    }
}

variants! { heidenhain::axes_logic:
    /// A key that is held while the door closes activates.
    "axes-logic-held-key-starts" |state, config, inputs| {
        let state = axes_logic::State { open: false, keyed: false, ..state };
        axes_logic::transition(state, config, inputs)
    }

    /// NC start counts as long as it is pressed, not from its edge.
    "axes-logic-start-by-level" |state, config, inputs| {
        let state = axes_logic::State { starts: false, ..state };
        axes_logic::transition(state, config, inputs)
    }

    /// A program goes on without its permissive.
    "axes-logic-forgets-the-permissive" |state, config, inputs| {
        let (mut after, mut outputs) = axes_logic::transition(state, config, inputs);
        if state.program && !inputs.permissive() && inputs.door_open && outputs.stop == Stop::Ss2 {
            after.program = true;
            outputs.stop = Stop::None;
        }
        (after, outputs)
    }

    /// An open magazine door does not matter.
    "axes-logic-magazine-door-overlooked" |state, config, inputs| {
        axes_logic::transition(state, config, &axes_logic::Inputs { t_open: false, ..*inputs })
    }
}

variants! { heidenhain::spindle_logic:
    /// A jog key that is released stops nothing.
    "spindle-logic-jog-runs-on" |state, config, inputs| {
        let state = spindle_logic::State { jogged: false, ..state };
        spindle_logic::transition(state, config, inputs)
    }

    /// With the door open a start needs no permissive.
    "spindle-logic-no-permissive" |state, config, inputs| {
        let (after, mut outputs) = spindle_logic::transition(state, config, inputs);
        let given = spindle_logic::Inputs {
            unit: Unit::Panel,
            panel: true,
            ..*inputs
        };
        outputs.activate = spindle_logic::transition(state, config, &given).1.activate;
        (after, outputs)
    }

    /// Restricted operation is granted in SOM_1 too.
    "spindle-logic-restricted-in-som-1" |state, config, inputs| {
        let (after, mut outputs) = spindle_logic::transition(state, config, inputs);
        if inputs.door_open && inputs.restricted && !inputs.holder_open {
            outputs.request = GroupState::SlsS;
        }
        (after, outputs)
    }
}

variants! { heidenhain::magazine_logic:
    /// A door that is opened in motion is an SS2.
    "magazine-logic-door-is-ss2" |state, config, inputs| {
        let inputs = magazine_logic::Inputs { moving: false, ..*inputs };
        magazine_logic::transition(state, config, &inputs)
    }

    /// A change of the mode is overlooked.
    "magazine-logic-mode-overlooked" |state, config, inputs| {
        let inputs = magazine_logic::Inputs { som_changed: false, ..*inputs };
        magazine_logic::transition(state, config, &inputs)
    }

    /// The confirmation outlasts the open door.
    "magazine-logic-confirmed-for-ever" |state, config, inputs| {
        let (mut after, outputs) = magazine_logic::transition(state, config, inputs);
        after.confirmed |= state.confirmed;
        (after, outputs)
    }

    /// The permissive alone keeps it moving.
    "magazine-logic-permissive-is-enough" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.t_open && inputs.permissive && !inputs.keys.is_power_of_two() {
            inputs.keys = 1;
        }
        magazine_logic::transition(state, config, &inputs)
    }
}

variants! { heidenhain::safe_input:
    /// One contact is enough.
    "safe-input-one-contact" |state, config, inputs| {
        let either = inputs.contact_a || inputs.contact_b;
        let inputs = safe_input::Inputs { contact_a: either, contact_b: either };
        safe_input::transition(state, config, &inputs)
    }
}

variants! { heidenhain::working_space:
    /// One closed door protects the space.
    "working-space-one-door" |state, config, inputs| {
        let closed = if inputs.closed != 0 { u8::MAX } else { 0 };
        working_space::transition(state, config, &working_space::Inputs { closed })
    }
}

variants! { heidenhain::control_voltage:
    /// One reset is good for ever.
    "control-voltage-one-reset" |state, config, inputs| {
        let (mut after, outputs) = control_voltage::transition(state, config, inputs);
        after.armed |= state.armed;
        (after, outputs)
    }
}

variants! { heidenhain::jog_increment:
    /// A key that stays pressed begins the next increment.
    "jog-increment-repeats" |state, config, inputs| {
        let (mut after, outputs) = jog_increment::transition(state, config, inputs);
        if after.jog == jog_increment::Jog::Ended {
            after.jog = jog_increment::Jog::Ready;
        }
        (after, outputs)
    }

    /// A lost condition takes the feed only.
    "jog-increment-no-stop" |state, config, inputs| {
        let (after, mut outputs) = jog_increment::transition(state, config, inputs);
        outputs.stop = Stop::None;
        (after, outputs)
    }
}

variants! { heidenhain::general_fields:
    /// A marker of 2 counts as 1.
    "general-fields-any-number" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.drives = inputs.drives.min(1);
        general_fields::transition(state, config, &inputs)
    }
}

variants! { heidenhain::program_check:
    /// A changed program runs on with a message.
    "program-check-message-only" |state, config, inputs| {
        let (mut after, mut outputs) = program_check::transition(state, config, inputs);
        outputs.good |= inputs.translated;
        after.good = outputs.good;
        (after, outputs)
    }
}

variants! { heidenhain::availability:
    /// Auxiliary axes have an operating stop in SOM_1.
    "availability-auxiliary-stop" |state, config, inputs| {
        let (after, mut outputs) = availability::transition(state, config, inputs);
        outputs.available |= inputs.kind == Kind::Auxiliary
            && inputs.function == availability::Function::Sos;
        (after, outputs)
    }
}

variants! { heidenhain::allowed_functions:
    /// The chip conveyor needs no permissive.
    "allowed-functions-conveyor" |state, config, inputs| {
        let inputs = allowed_functions::Inputs { permissive: true, ..*inputs };
        allowed_functions::transition(state, config, &inputs)
    }
}

variants! { heidenhain::f_limited:
    /// In SOM_1 the limit of SOM_2 applies.
    "f-limited-som-1-moves" |state, config, inputs| {
        let mut inputs = *inputs;
        if inputs.som == Som::Som1 {
            inputs.som = Som::Som2;
        }
        f_limited::transition(state, config, &inputs)
    }
}

variants! { heidenhain::group_motion:
    /// The first axis counts alone.
    "group-motion-first-axis" |state, config, inputs| {
        let axes = inputs.axes & 1;
        group_motion::transition(state, config, &group_motion::Inputs { axes })
    }
}

variants! { heidenhain::safe_output:
    /// The enable is not looked at.
    "safe-output-stays-on" |state, config, inputs| {
        let inputs = safe_output::Inputs { enabled: true, ..*inputs };
        safe_output::transition(state, config, &inputs)
    }
}
