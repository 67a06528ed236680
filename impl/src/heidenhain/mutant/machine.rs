//! Wrong variants of what concerns the whole machine: modes, permissives, control voltage, outputs.

use crate::heidenhain::types::{Som, Stop};
use crate::heidenhain::{button, output_enable, som, switch_on};

pub(super) fn som_one_cycle_lock(
    state: som::State,
    config: &som::Config,
    inputs: &som::Inputs,
) -> (som::State, som::Outputs) {
    let (mut after, outputs) = som::transition(state, config, inputs);
    if after.som == Som::Som1 {
        after.last = Som::Som1;
    }
    (after, outputs)
}

pub(super) fn som_first_key_wins(
    state: som::State,
    config: &som::Config,
    inputs: &som::Inputs,
) -> (som::State, som::Outputs) {
    let mut inputs = *inputs;
    inputs.key_4 &= !inputs.key_2 && !inputs.key_3;
    som::transition(state, config, &inputs)
}

pub(super) fn button_held_at_power_up(
    state: button::State,
    config: &button::Config,
    inputs: &button::Inputs,
) -> (button::State, button::Outputs) {
    let mut inputs = *inputs;
    inputs.power_on = false;
    button::transition(state, config, &inputs)
}

pub(super) fn button_one_contact(
    state: button::State,
    config: &button::Config,
    inputs: &button::Inputs,
) -> (button::State, button::Outputs) {
    let mut inputs = *inputs;
    inputs.contact_b = inputs.contact_a;
    button::transition(state, config, &inputs)
}

pub(super) fn switch_on_by_level(
    state: switch_on::State,
    config: &switch_on::Config,
    inputs: &switch_on::Inputs,
) -> (switch_on::State, switch_on::Outputs) {
    let mut state = state;
    if state.voltage == switch_on::Voltage::Off {
        state.seen = false;
    }
    switch_on::transition(state, config, inputs)
}

pub(super) fn switch_on_forgives_the_chain(
    state: switch_on::State,
    config: &switch_on::Config,
    inputs: &switch_on::Inputs,
) -> (switch_on::State, switch_on::Outputs) {
    let (after, mut outputs) = switch_on::transition(state, config, inputs);
    if outputs.fault {
        outputs.demand = Stop::None;
    }
    (after, outputs)
}

pub(super) fn output_enable_any_ss1(
    state: output_enable::State,
    config: &output_enable::Config,
    inputs: &output_enable::Inputs,
) -> (output_enable::State, output_enable::Outputs) {
    let mut inputs = *inputs;
    inputs.emergency = true;
    output_enable::transition(state, config, &inputs)
}

pub(super) fn output_enable_no_deadline(
    state: output_enable::State,
    config: &output_enable::Config,
    inputs: &output_enable::Inputs,
) -> (output_enable::State, output_enable::Outputs) {
    let mut state = state;
    if state.timer.count() == 1 {
        state.timer = config.t_off();
    }
    output_enable::transition(state, config, inputs)
}
