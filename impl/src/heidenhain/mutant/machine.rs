//! Wrong variants of what concerns the whole machine: modes, permissives, control voltage, outputs.

use crate::heidenhain::types::{Som, Stop};
use crate::heidenhain::{button, output_enable, som, switch_on};

variants! { heidenhain::som:
    /// A refused mode is taken one cycle later.
    "som-one-cycle-lock" |state, config, inputs| {
        let (mut after, outputs) = som::transition(state, config, inputs);
        if after.som == Som::Som1 {
            after.last = Som::Som1;
        }
        (after, outputs)
    }

    /// The key of SOM_4 does not count beside another one.
    "som-first-key-wins" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.key_4 &= !inputs.key_2 && !inputs.key_3;
        som::transition(state, config, &inputs)
    }
}

variants! { heidenhain::button:
    /// A button held at power-up counts.
    "button-held-at-power-up" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.power_on = false;
        button::transition(state, config, &inputs)
    }

    /// One contact is enough.
    "button-one-contact" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.contact_b = inputs.contact_a;
        button::transition(state, config, &inputs)
    }
}

variants! { heidenhain::switch_on:
    /// A control voltage that is on needs no edge.
    "switch-on-by-level" |state, config, inputs| {
        let mut state = state;
        if state.voltage == switch_on::Voltage::Off {
            state.seen = false;
        }
        switch_on::transition(state, config, inputs)
    }

    /// A chain that stays open raises no stop.
    "switch-on-forgives-the-chain" |state, config, inputs| {
        let (after, mut outputs) = switch_on::transition(state, config, inputs);
        if outputs.fault {
            outputs.demand = Stop::None;
        }
        (after, outputs)
    }
}

variants! { heidenhain::output_enable:
    /// Every SS1 takes it.
    "output-enable-any-ss1" |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.emergency = true;
        output_enable::transition(state, config, &inputs)
    }

    /// There is no deadline.
    "output-enable-no-deadline" |state, config, inputs| {
        let mut state = state;
        if state.timer.count() == 1 {
            state.timer = config.t_off();
        }
        output_enable::transition(state, config, inputs)
    }
}
