//! Wrong variants of the monitor of the ramp.

use crate::srm::sbr_monitor::{self, Phase, SbrPos, SbrRetrig};

variants! { srm::sbr_monitor:
    /// The ramp begins to fall one call later.
    "sbr-monitor-late-ramp" |state, config, inputs| {
        let (mut after, mut outputs) = sbr_monitor::transition(state, config, inputs);
        if state.phase == Phase::Ramp && state.ramp == config.v_max && after.phase == Phase::Ramp {
            after.ramp = state.ramp;
            outputs.v_threshold = state.ramp.saturating_add(config.maxtol_v);
        }
        (after, outputs)
    }

    /// The tolerance of the velocity is not inclusive.
    "sbr-monitor-early" |state, config, inputs| {
        let config = sbr_monitor::Config { maxtol_v: config.maxtol_v.saturating_sub(1), ..*config };
        sbr_monitor::transition(state, &config, inputs)
    }

    /// The way is not monitored.
    "sbr-monitor-one-channel" |state, config, inputs| {
        let inputs = sbr_monitor::Inputs { safe_pos: state.start, ..*inputs };
        sbr_monitor::transition(state, config, &inputs)
    }

    /// The rest of a mm is lost in each call.
    "sbr-monitor-loses-rests" |state, config, inputs| {
        let (mut after, outputs) = sbr_monitor::transition(state, config, inputs);
        after.rest = 0;
        (after, outputs)
    }

    /// A second edge loads the ramp again.
    "sbr-monitor-reloads" |state, config, inputs| {
        let config = sbr_monitor::Config { sbr_retrig: SbrRetrig::Reload, ..*config };
        sbr_monitor::transition(state, &config, inputs)
    }

    /// The way is that of a call.
    "sbr-monitor-cycle-way" |state, config, inputs| {
        let config = sbr_monitor::Config { sbr_pos: SbrPos::Cycle, ..*config };
        sbr_monitor::transition(state, &config, inputs)
    }

    /// The monitoring ends with EXECUTE, before the ramp does.
    "sbr-monitor-ends-with-execute" |state, config, inputs| {
        let (after, outputs) = sbr_monitor::transition(state, config, inputs);
        if inputs.execute || state.phase == Phase::Idle {
            return (after, outputs);
        }
        let after = sbr_monitor::State {
            violated: after.violated,
            overflowed: after.overflowed,
            execute_held: false,
            ack_held: inputs.ack,
            ..sbr_monitor::State::INITIAL
        };
        (after, sbr_monitor::Outputs { busy: false, ramping: false, v_threshold: 0, pos_threshold: 0, ..outputs })
    }

    /// A violation is acknowledged at any velocity.
    "sbr-monitor-acknowledged-fast" |state, config, inputs| {
        let config = sbr_monitor::Config { v_stop_monitoring: i32::MAX, ..*config };
        sbr_monitor::transition(state, &config, inputs)
    }

    /// A held ACK acknowledges for ever.
    "sbr-monitor-static-ack" |state, config, inputs| {
        let state = sbr_monitor::State { ack_held: false, ..state };
        sbr_monitor::transition(state, config, inputs)
    }

    /// A ramp of no time is no wrong parameter.
    "sbr-monitor-no-ramp" |state, config, inputs| {
        let (after, mut outputs) = sbr_monitor::transition(state, config, inputs);
        if config.t_ramp == 0 {
            outputs.diag &= !8;
        }
        (after, outputs)
    }

    /// A sum that is no DInt is cut without a word.
    "sbr-monitor-hides-overflow" |state, config, inputs| {
        let (mut after, mut outputs) = sbr_monitor::transition(state, config, inputs);
        after.overflowed = false;
        outputs.diag &= !0x800;
        outputs.error = outputs.diag != 0;
        (after, outputs)
    }
}
