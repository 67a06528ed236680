//! Wrong variants of the load supervision and its calibration.

use crate::srm::load_calibration::{self, Phase};
use crate::srm::load_monitor;

variants! { srm::load_monitor:
    /// Only the mean of both channels counts.
    "load-monitor-mean" |state, config, inputs| {
        let mean = (i64::from(inputs.load1) + i64::from(inputs.load2)) / 2;
        let (mut after, outputs) = load_monitor::transition(state, config, inputs);
        if mean <= i64::from(config.maxload_stat) {
            after.over_static = state.over_static;
        }
        (after, outputs)
    }

    /// The limit is not inclusive.
    "load-monitor-early" |state, config, inputs| {
        let config = load_monitor::Config { maxload_stat: config.maxload_stat.saturating_sub(1), ..*config };
        load_monitor::transition(state, &config, inputs)
    }

    /// The dynamic limit counts in both modes.
    "load-monitor-always-dynamic" |state, config, inputs| {
        let inputs = load_monitor::Inputs { maxload_mode: true, ..*inputs };
        load_monitor::transition(state, config, &inputs)
    }

    /// An overload is acknowledged just below the limit.
    "load-monitor-no-hysteresis" |state, config, inputs| {
        let calm = load_monitor::Config { maxtol_load: 0, ..*config };
        let (after, _) = load_monitor::transition(state, &calm, inputs);
        let (right, outputs) = load_monitor::transition(state, config, inputs);
        (load_monitor::State { over_static: after.over_static, ..right }, outputs)
    }

    /// The directions are exchanged.
    "load-monitor-wrong-direction" |state, config, inputs| {
        let (after, mut outputs) = load_monitor::transition(state, config, inputs);
        core::mem::swap(&mut outputs.move_negative_ok, &mut outputs.move_positive_ok);
        (after, outputs)
    }

    /// A discrepancy has no effect on the velocity.
    "load-monitor-fast-discrepancy" |state, config, inputs| {
        let (after, mut outputs) = load_monitor::transition(state, config, inputs);
        if !after.overloaded_or_slack() {
            outputs.sls_threshold = i32::MAX;
        }
        (after, outputs)
    }

    /// A retraction outlives a new fault of the load.
    "load-monitor-retracts-on" |state, config, inputs| {
        let (mut after, mut outputs) = load_monitor::transition(state, config, inputs);
        if state.retracting && inputs.release && inputs.v_valid {
            after.retracting = true;
            outputs.min_load_ok = true;
        }
        (after, outputs)
    }

    /// After an invalid velocity a held RELEASE goes on.
    "load-monitor-resumes" |state, config, inputs| {
        let held = inputs.release && inputs.v_valid && state.overloaded_or_slack() && !state.blind;
        let state = load_monitor::State { retracting: state.retracting || held && state.release_held, ..state };
        load_monitor::transition(state, config, inputs)
    }

    /// A retraction goes on without a valid velocity.
    "load-monitor-blind" |state, config, inputs| {
        let (mut after, mut outputs) = load_monitor::transition(state, config, inputs);
        if state.retracting && inputs.release {
            after.retracting = after.overloaded_or_slack();
            after.blind = false;
            outputs.sls_ok = !after.fast;
        }
        (after, outputs)
    }

    /// The velocity is supervised in a retraction only.
    "load-monitor-fast-outside" |state, config, inputs| {
        let (mut after, mut outputs) = load_monitor::transition(state, config, inputs);
        if !after.retracting {
            after.fast = state.fast;
            outputs.sls_ok = !after.fast && !after.blind;
        }
        (after, outputs)
    }

    /// A held ACK acknowledges for ever.
    "load-monitor-static-ack" |state, config, inputs| {
        let state = load_monitor::State { ack_held: false, ..state };
        load_monitor::transition(state, config, inputs)
    }

    /// A calculation fault of the calibration takes nothing away.
    "load-monitor-calibration-apart" |state, config, inputs| {
        let inputs = load_monitor::Inputs { calibration_overflow: false, ..*inputs };
        load_monitor::transition(state, config, &inputs)
    }

    /// A load beyond 100 % is taken as it is.
    "load-monitor-any-load" |state, config, inputs| {
        let (after, mut outputs) = load_monitor::transition(state, config, inputs);
        outputs.diag &= !0x400;
        (after, outputs)
    }
}

variants! { srm::load_calibration:
    /// A test goes on with what is left of the last one.
    "load-calibration-keeps-passed" |state, config, inputs| {
        let (mut after, mut outputs) = load_calibration::transition(state, config, inputs);
        if outputs.busy {
            after.passed = state.passed;
            outputs.test_ok = state.passed;
        }
        (after, outputs)
    }

    /// The load may settle one call longer.
    "load-calibration-late" |state, config, inputs| {
        let (after, outputs) = load_calibration::transition(state, config, inputs);
        if after.unsettled && !state.unsettled {
            let wait = load_calibration::State { calibrate_held: inputs.calibrate, ack_held: inputs.ack, ..state };
            return (wait, load_calibration::Outputs { busy: true, ..outputs });
        }
        (after, outputs)
    }

    /// One channel is enough.
    "load-calibration-one-channel" |state, config, inputs| {
        let inputs = load_calibration::Inputs { load2: inputs.load1, ..*inputs };
        load_calibration::transition(state, config, &inputs)
    }

    /// A step is taken for a load.
    "load-calibration-no-step" |state, config, inputs| {
        let config = load_calibration::Config { cal_mode: false, ..*config };
        load_calibration::transition(state, &config, inputs)
    }

    /// The last call of the test is not looked at.
    "load-calibration-blind-end" |state, config, inputs| {
        let (after, outputs) = load_calibration::transition(state, config, inputs);
        let last = config.times().is_some_and(|(test, _)| state.calls + 1 == test);
        if state.phase == Phase::Hold && last && after.unsteady {
            let passed = load_calibration::State { unsteady: false, passed: true, left: config.t_interval, ..after };
            return (passed, load_calibration::Outputs { test_ok: true, error: false, diag: 0, ..outputs });
        }
        (after, outputs)
    }

    /// What was passed counts for ever.
    "load-calibration-for-ever" |state, config, inputs| {
        let (mut after, mut outputs) = load_calibration::transition(state, config, inputs);
        if state.passed && !outputs.busy {
            after.passed = true;
            outputs.test_ok = true;
        }
        (after, outputs)
    }

    /// After a restart no test is due.
    "load-calibration-not-due" |state, config, inputs| {
        let (after, mut outputs) = load_calibration::transition(state, config, inputs);
        if !state.passed {
            outputs.test_req = false;
        }
        (after, outputs)
    }

    /// An edge begins a running test anew.
    "load-calibration-restarts" |state, config, inputs| {
        let edge = inputs.calibrate && !state.calibrate_held && config.times().is_some();
        let state = if edge && state.phase != Phase::Idle {
            load_calibration::State { phase: Phase::Idle, calls: 0, from1: 0, from2: 0, ..state }
        } else {
            state
        };
        load_calibration::transition(state, config, inputs)
    }

    /// A step that is no DInt is none.
    "load-calibration-hides-overflow" |state, config, inputs| {
        let (mut after, mut outputs) = load_calibration::transition(state, config, inputs);
        if after.overflowed && !state.overflowed {
            after.unsteady = false;
            after.unsettled = false;
            outputs.diag &= 0x800;
            after.passed = true;
            outputs.test_ok = true;
        }
        (after, outputs)
    }
}
