//! Wrong variants of the stop reaction.

use crate::heidenhain::types::{Phase, Stop};
use crate::heidenhain::{global_sto, neighbour, report, stop};
use crate::kernel::Cycles;

variants! { heidenhain::stop:
    /// An SS1F that comes during the ramp loads the timer anew.
    "stop-reloads-timer" |state, config, inputs| {
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

    /// An SS1D ends the braking along the contour.
    "stop-leaves-contour" |state, config, inputs| {
        let (mut after, mut outputs) = stop::transition(state, config, inputs);
        if after.phase == Phase::Ss1DWait {
            after.timer = Cycles::ZERO;
            outputs.on_contour = false;
        }
        (after, outputs)
    }

    /// The operator's edge restarts after SS1F as well.
    "stop-restarts-hard" |state, config, inputs| {
        let mut state = state;
        if state.phase == Phase::TorqueOff && state.level == Stop::Ss1F {
            state.level = Stop::Ss1;
        }
        stop::transition(state, config, inputs)
    }

    /// Channel B takes the torque together with closing the brakes.
    "stop-drops-the-load" |state, config, inputs| {
        let (after, mut outputs) = stop::transition(state, config, inputs);
        outputs.torque_off |= outputs.brake_closed;
        (after, outputs)
    }
}

variants! { heidenhain::report:
    /// A channel without torque tells of no further cause.
    "report-falls-silent" |state, config, inputs| {
        let found = if inputs.phase == Phase::TorqueOff { Stop::None } else { inputs.found };
        report::transition(state, config, &report::Inputs { found, ..*inputs })
    }

    /// A stop that has ended is told on and on.
    "report-never-ends" |state, config, inputs| {
        let phase = Phase::Run;
        report::transition(state, config, &report::Inputs { phase, ..*inputs })
    }
}

variants! { heidenhain::neighbour:
    /// An SS0 stays with its group.
    "neighbour-keeps-ss0" |state, config, inputs| {
        let level = if inputs.level == Stop::Ss0 { Stop::None } else { inputs.level };
        neighbour::transition(state, config, &neighbour::Inputs { level, ..*inputs })
    }

    /// Every SS1 stops the machine.
    "neighbour-every-ss1" |state, config, inputs| {
        let wide = true;
        neighbour::transition(state, config, &neighbour::Inputs { wide, ..*inputs })
    }
}

variants! { heidenhain::global_sto:
    /// It falls with the SS0.
    "global-sto-at-once" |state, config, inputs| {
        let others_off = true;
        global_sto::transition(state, config, &global_sto::Inputs { others_off, ..*inputs })
    }

    /// There is no latest time.
    "global-sto-never-late" |state, config, inputs| {
        let mut state = state;
        if state.timer.count() == 1 {
            state.timer = Cycles::ZERO;
        }
        global_sto::transition(state, config, inputs)
    }
}
