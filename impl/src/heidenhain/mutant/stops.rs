//! Wrong variants of the stop reaction.

use crate::heidenhain::types::{Phase, Stop};
use crate::heidenhain::{global_sto, neighbour, report, stop};
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

    neighbour_keeps_ss0: neighbour |state, config, inputs| {
        let level = if inputs.level == Stop::Ss0 { Stop::None } else { inputs.level };
        neighbour::transition(state, config, &neighbour::Inputs { level, ..*inputs })
    }

    neighbour_every_ss1: neighbour |state, config, inputs| {
        let wide = true;
        neighbour::transition(state, config, &neighbour::Inputs { wide, ..*inputs })
    }

    global_sto_at_once: global_sto |state, config, inputs| {
        let others_off = true;
        global_sto::transition(state, config, &global_sto::Inputs { others_off, ..*inputs })
    }

    global_sto_never_late: global_sto |state, config, inputs| {
        let mut state = state;
        if state.timer.count() == 1 {
            state.timer = Cycles::ZERO;
        }
        global_sto::transition(state, config, inputs)
    }
}
