//! Wrong variants of the stop reaction.

use crate::heidenhain::types::{Phase, Stop};
use crate::heidenhain::{report, stop};
use crate::kernel::Cycles;

pub(super) fn stop_reloads_timer(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let (mut after, outputs) = stop::transition(state, config, inputs);
    if inputs.demand == Stop::Ss1F
        && after.level == Stop::Ss1F
        && state.level != Stop::Ss1F
        && matches!(after.phase, Phase::EmergencyBrake | Phase::BrakeCloses)
    {
        after.timer = stop::started(config.t_ss1());
    }
    (after, outputs)
}

pub(super) fn stop_leaves_contour(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let (mut after, mut outputs) = stop::transition(state, config, inputs);
    if after.phase == Phase::Ss1DWait {
        after.timer = Cycles::ZERO;
        outputs.on_contour = false;
    }
    (after, outputs)
}

pub(super) fn stop_restarts_hard(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let mut state = state;
    if state.phase == Phase::TorqueOff && state.level == Stop::Ss1F {
        state.level = Stop::Ss1;
    }
    stop::transition(state, config, inputs)
}

pub(super) fn stop_drops_the_load(
    state: stop::State,
    config: &stop::Config,
    inputs: &stop::Inputs,
) -> (stop::State, stop::Outputs) {
    let (after, mut outputs) = stop::transition(state, config, inputs);
    outputs.torque_off |= outputs.brake_closed;
    (after, outputs)
}

variants! {
    report_falls_silent: report |state, config, inputs| {
        let found = if inputs.phase == Phase::TorqueOff { Stop::None } else { inputs.found };
        report::transition(state, config, &report::Inputs { found, ..*inputs })
    }

    report_never_ends: report |state, config, inputs| {
        let phase = Phase::Run;
        report::transition(state, config, &report::Inputs { phase, ..*inputs })
    }
}
