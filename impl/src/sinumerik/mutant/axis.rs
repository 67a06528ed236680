//! Wrong variants of selection, referencing, user agreement and gear stage.

use crate::kernel::Cycles;
use crate::sinumerik::{agreement, gear, reference, selection};

pub(super) fn selection_delay_short(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut state = state;
    if state.timer > Cycles::new(1) {
        state.timer = state.timer.tick();
    }
    selection::transition(state, config, inputs)
}

pub(super) fn selection_forced_deselects(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut inputs = *inputs;
    inputs.sbh_internal &= !inputs.sge_sbh_sg;
    selection::transition(state, config, &inputs)
}

pub(super) fn selection_factor_at_once(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut state = state;
    let other_factor = state.factor != inputs.choice(config).factor;
    if state.mode.watches_speed()
        && inputs.sge_sbh
        && state.stage == inputs.sg_select
        && other_factor
    {
        // As if nothing had been selected before.
        state = selection::State::INITIAL;
    }
    selection::transition(state, config, inputs)
}

pub(super) fn selection_override_in_sg3(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut inputs = *inputs;
    if inputs.sg_select == selection::Stage::Sg3 && inputs.over != selection::FactorIndex::NONE {
        inputs.sg_select = selection::Stage::Sg4;
    }
    selection::transition(state, config, &inputs)
}

pub(super) fn selection_reference_creeps(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let mut state = state;
    if state.mode == selection::Mode::Sbh {
        state.reference = inputs.position;
    }
    selection::transition(state, config, inputs)
}

pub(super) fn selection_forced_late(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let inputs = selection::Inputs {
        ended_at: inputs.position,
        ..*inputs
    };
    selection::transition(state, config, &inputs)
}

pub(super) fn selection_window_stays(
    state: selection::State,
    config: &selection::Config,
    inputs: &selection::Inputs,
) -> (selection::State, selection::Outputs) {
    let inputs = selection::Inputs {
        set_anew: false,
        ..*inputs
    };
    selection::transition(state, config, &inputs)
}

pub(super) fn reference_tells_uncompared(
    state: reference::State,
    config: &reference::Config,
    inputs: &reference::Inputs,
) -> (reference::State, reference::Outputs) {
    let (after, mut outputs) = reference::transition(state, config, inputs);
    outputs.confirmed = inputs.agreed_1;
    (after, outputs)
}

pub(super) fn reference_one_agreement(
    state: reference::State,
    config: &reference::Config,
    inputs: &reference::Inputs,
) -> (reference::State, reference::Outputs) {
    let agreed = inputs.agreed_1 || inputs.agreed_2;
    let inputs = reference::Inputs {
        agreed_1: agreed,
        agreed_2: agreed,
        ..*inputs
    };
    reference::transition(state, config, &inputs)
}

pub(super) fn reference_late_reset(
    state: reference::State,
    config: &reference::Config,
    inputs: &reference::Inputs,
) -> (reference::State, reference::Outputs) {
    let (after, mut outputs) = reference::transition(state, config, inputs);
    outputs.safely_referenced |= state.axis == reference::AxisState::SafeRef && !inputs.power_on;
    (after, outputs)
}

pub(super) fn agreement_kept_after_gear(
    state: agreement::State,
    config: &agreement::Config,
    inputs: &agreement::Inputs,
) -> (agreement::State, agreement::Outputs) {
    agreement::transition(
        state,
        config,
        &agreement::Inputs {
            gear_changed: false,
            ..*inputs
        },
    )
}

pub(super) fn agreement_no_history(
    state: agreement::State,
    config: &agreement::Config,
    inputs: &agreement::Inputs,
) -> (agreement::State, agreement::Outputs) {
    agreement::transition(
        state,
        config,
        &agreement::Inputs {
            compare_due: false,
            ..*inputs
        },
    )
}

pub(super) fn agreement_without_key(
    state: agreement::State,
    config: &agreement::Config,
    inputs: &agreement::Inputs,
) -> (agreement::State, agreement::Outputs) {
    agreement::transition(
        state,
        config,
        &agreement::Inputs {
            key: inputs.key || inputs.set,
            ..*inputs
        },
    )
}

pub(super) fn gear_change_overlooked(
    state: gear::State,
    config: &gear::Config,
    inputs: &gear::Inputs,
) -> (gear::State, gear::Outputs) {
    let (after, mut outputs) = gear::transition(state, config, inputs);
    outputs.changed &= after.stage != gear::GearIndex::FIRST;
    (after, outputs)
}
