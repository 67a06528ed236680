//! Wrong wirings of the channel.

use crate::heidenhain::channel;
use crate::heidenhain::types::Stop;

pub(super) fn channel_permits_by_level(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let mut state = state;
    state.permitted = false;
    channel::transition(state, config, inputs)
}

pub(super) fn channel_misses_told(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let mut inputs = *inputs;
    inputs.told = Stop::None;
    channel::transition(state, config, &inputs)
}

pub(super) fn channel_alone(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let mut inputs = *inputs;
    inputs.peer = channel::transition(state, config, &inputs).1.taken;
    channel::transition(state, config, &inputs)
}

pub(super) fn channel_tells_back(
    state: channel::State,
    config: &channel::Config,
    inputs: &channel::Inputs,
) -> (channel::State, channel::Outputs) {
    let (after, mut outputs) = channel::transition(state, config, inputs);
    outputs.tells = outputs.tells.max(inputs.told);
    (after, outputs)
}
