//! Wrong variants of what is taken over from the safe PLC.

use crate::heidenhain::types::{GroupState, Kind, Stop};
use crate::heidenhain::{both_channels, gate};

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
