//! Wrong variants of the external stops, of STOP F, of the arbitration and of the effect on other axes.

use crate::kernel::Cycles;

use crate::sinumerik::level::{ExternalStop, InternalStop};
use crate::sinumerik::{external, fault, group, stop};

pub(super) fn stop_b_no_timer_exit(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if state.phase == stop::Phase::BBraking && state.timer == Cycles::new(1) {
        state.timer = Cycles::new(2);
    }
    stop::transition(state, config, inputs)
}

pub(super) fn stop_b_on_standing_axis(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let braked = state.phase == stop::Phase::BBraking && !inputs.power_on;
    let inputs = stop::Inputs {
        standstill: inputs.standstill && braked,
        ..*inputs
    };
    stop::transition(state, config, &inputs)
}

pub(super) fn stop_without_f_and_test(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let inputs = stop::Inputs {
        fault: false,
        external_test: false,
        ..*inputs
    };
    stop::transition(state, config, &inputs)
}

pub(super) fn stop_lower_displaces(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if inputs.demand != InternalStop::None && inputs.demand < state.internal {
        state = stop::State::INITIAL;
    }
    stop::transition(state, config, inputs)
}

pub(super) fn stop_reset_while_braking(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if inputs.reset && state.phase == stop::Phase::Braking {
        state = stop::State::INITIAL;
    }
    stop::transition(state, config, inputs)
}

pub(super) fn stop_releases_standstill(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if state.phase == stop::Phase::SbhInt && !inputs.reset && inputs.demand.level() > state.level {
        state = stop::State {
            internal: state.internal,
            ..stop::State::INITIAL
        };
    }
    stop::transition(state, config, inputs)
}

pub(super) fn external_before_start(
    state: external::State,
    config: &external::Config,
    inputs: &external::Inputs,
) -> (external::State, external::Outputs) {
    let (after, mut outputs) = external::transition(state, config, inputs);
    if !after.started && !after.spl_latched {
        outputs.request = outputs.selected;
    }
    (after, outputs)
}

pub(super) fn external_wrong_priority(
    state: external::State,
    config: &external::Config,
    inputs: &external::Inputs,
) -> (external::State, external::Outputs) {
    let (after, mut outputs) = external::transition(state, config, inputs);
    if outputs.request == ExternalStop::C && !inputs.sge_d {
        outputs.request = ExternalStop::D;
    }
    (after, outputs)
}

pub(super) fn fault_delay_aborted(
    state: fault::State,
    config: &fault::Config,
    inputs: &fault::Inputs,
) -> (fault::State, fault::Outputs) {
    let mut state = state;
    if inputs.reset && state.fault == fault::FaultState::Delay {
        state = fault::State::INITIAL;
    }
    fault::transition(state, config, inputs)
}

pub(super) fn fault_delay_held_by_stop(
    state: fault::State,
    config: &fault::Config,
    inputs: &fault::Inputs,
) -> (fault::State, fault::Outputs) {
    let mut state = state;
    if inputs.cde_before && state.fault == fault::FaultState::Delay {
        state = fault::State {
            fault: fault::FaultState::Latched,
            timer: Cycles::ZERO,
        };
    }
    fault::transition(state, config, inputs)
}

pub(super) fn group_external_reaches(
    state: group::State,
    config: &group::Config,
    inputs: &group::Inputs,
) -> (group::State, group::Outputs) {
    let mut inputs = *inputs;
    if let Some(level) = InternalStop::from_level(inputs.level) {
        inputs.internal = level;
    }
    group::transition(state, config, &inputs)
}
