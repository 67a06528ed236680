//! Wrong variants of what is taken over from the safe PLC.

use crate::heidenhain::types::{GroupState, Kind, Stop};
use crate::heidenhain::{both_channels, both_fields, both_status, gate};

pub(super) fn gate_activates_illegal(
    state: gate::State,
    config: &gate::Config,
    inputs: &gate::Inputs,
) -> (gate::State, gate::Outputs) {
    let (after, mut outputs) = gate::transition(state, config, inputs);
    outputs.starts = inputs.activate;
    (after, outputs)
}

pub(super) fn gate_trusts_codes(
    state: gate::State,
    config: &gate::Config,
    inputs: &gate::Inputs,
) -> (gate::State, gate::Outputs) {
    let (after, mut outputs) = gate::transition(state, config, inputs);
    outputs.stop = Stop::from_code(inputs.stop_code).unwrap_or(outputs.stop);
    (after, outputs)
}

pub(super) fn gate_grants_spindle_mode(
    state: gate::State,
    config: &gate::Config,
    inputs: &gate::Inputs,
) -> (gate::State, gate::Outputs) {
    let (after, mut outputs) = gate::transition(state, config, inputs);
    if inputs.state_code == GroupState::SlsS.code() && config.kind() != Kind::Spindle {
        outputs.stop = Stop::from_code(inputs.stop_code).unwrap_or(Stop::Ss1F);
    }
    (after, outputs)
}

pub(super) fn both_channels_trusts_a(
    state: both_channels::State,
    config: &both_channels::Config,
    inputs: &both_channels::Inputs,
) -> (both_channels::State, both_channels::Outputs) {
    let (after, mut outputs) = both_channels::transition(state, config, inputs);
    outputs.request = inputs.request_mc;
    (after, outputs)
}

pub(super) fn both_channels_one_permissive(
    state: both_channels::State,
    config: &both_channels::Config,
    inputs: &both_channels::Inputs,
) -> (both_channels::State, both_channels::Outputs) {
    let (after, mut outputs) = both_channels::transition(state, config, inputs);
    outputs.held = inputs.held_mc || inputs.held_cc;
    (after, outputs)
}

variants! {
    both_fields_forgets_mode: both_fields |state, config, inputs| {
        let (after, mut outputs) = both_fields::transition(state, config, inputs);
        let mut inputs = *inputs;
        inputs.cc.som = inputs.mc.som;
        outputs.differ = inputs.mc != inputs.cc;
        (after, outputs)
    }

    both_fields_one_drives: both_fields |state, config, inputs| {
        let (after, mut outputs) = both_fields::transition(state, config, inputs);
        outputs.drives = inputs.mc.drives || inputs.cc.drives;
        (after, outputs)
    }

    both_status_forgets_program: both_status |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.cc.executed = inputs.mc.executed;
        both_status::transition(state, config, &inputs)
    }

    both_status_forgets_outputs: both_status |state, config, inputs| {
        let mut inputs = *inputs;
        inputs.cc.outputs = inputs.mc.outputs;
        both_status::transition(state, config, &inputs)
    }

    both_status_needs_both: both_status |state, config, inputs| {
        let (after, mut outputs) = both_status::transition(state, config, inputs);
        if !(inputs.mc.runtime && inputs.cc.runtime) {
            outputs.stop = Stop::None;
        }
        (after, outputs)
    }
}
