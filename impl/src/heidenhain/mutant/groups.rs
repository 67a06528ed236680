//! Wrong variants of what is asked of an axis group and of its monitoring state.

use crate::heidenhain::types::{GroupState, Left, Phase, Stop};
use crate::heidenhain::{axis_release, group, judge, startup};

pub(super) fn judge_trusts_mode_changes(
    state: judge::State,
    config: &judge::Config,
    inputs: &judge::Inputs,
) -> (judge::State, judge::Outputs) {
    let mut state = state;
    state.modes = judge::Modes::None;
    judge::transition(state, config, inputs)
}

pub(super) fn judge_misses_the_open_door(
    state: judge::State,
    config: &judge::Config,
    inputs: &judge::Inputs,
) -> (judge::State, judge::Outputs) {
    let mut inputs = *inputs;
    if inputs.state == GroupState::Auto && !inputs.idle {
        inputs.permissive = true;
    }
    judge::transition(state, config, &inputs)
}

pub(super) fn judge_moving_standstill(
    state: judge::State,
    config: &judge::Config,
    inputs: &judge::Inputs,
) -> (judge::State, judge::Outputs) {
    let (after, mut outputs) = judge::transition(state, config, inputs);
    if inputs.request == GroupState::Sos && outputs.demand == Stop::Ss1 {
        outputs.asks_ss1 = false;
        outputs.demand = inputs.stop_request;
    }
    (after, outputs)
}

pub(super) fn group_door_starts(
    state: group::State,
    config: &group::Config,
    inputs: &group::Inputs,
) -> (group::State, group::Outputs) {
    let mut inputs = *inputs;
    inputs.activate |= inputs.request == GroupState::Auto;
    group::transition(state, config, &inputs)
}

pub(super) fn group_loosens(
    state: group::State,
    config: &group::Config,
    inputs: &group::Inputs,
) -> (group::State, group::Outputs) {
    let (mut after, mut outputs) = group::transition(state, config, inputs);
    after.left = Left::NONE;
    outputs.left = Left::NONE;
    (after, outputs)
}

pub(super) fn group_soft_lifts_sto(
    state: group::State,
    config: &group::Config,
    inputs: &group::Inputs,
) -> (group::State, group::Outputs) {
    let (mut after, mut outputs) = group::transition(state, config, inputs);
    if inputs.soft && after.state == GroupState::Sto && inputs.phase == Phase::TorqueOff {
        after.state = GroupState::StoO;
        outputs.state = after.state;
    }
    (after, outputs)
}

pub(super) fn startup_forgets_by_permissive(
    state: startup::State,
    config: &startup::Config,
    inputs: &startup::Inputs,
) -> (startup::State, startup::Outputs) {
    let mut state = state;
    if inputs.permissive {
        state = startup::State::INITIAL;
    }
    startup::transition(state, config, inputs)
}

pub(super) fn startup_late(
    state: startup::State,
    config: &startup::Config,
    inputs: &startup::Inputs,
) -> (startup::State, startup::Outputs) {
    let (after, mut outputs) = startup::transition(state, config, inputs);
    outputs.idle = outputs.idle && inputs.limited && state.timer != after.timer;
    (after, outputs)
}

pub(super) fn axis_release_breaks_off(
    state: axis_release::State,
    config: &axis_release::Config,
    inputs: &axis_release::Inputs,
) -> (axis_release::State, axis_release::Outputs) {
    let mut state = state;
    if inputs.feed {
        state = axis_release::State::INITIAL;
    }
    axis_release::transition(state, config, inputs)
}

pub(super) fn axis_release_without_end(
    state: axis_release::State,
    config: &axis_release::Config,
    inputs: &axis_release::Inputs,
) -> (axis_release::State, axis_release::Outputs) {
    let (after, mut outputs) = axis_release::transition(state, config, inputs);
    outputs.asks_ss1 &= after.mode != axis_release::Mode::Ss2;
    (after, outputs)
}
