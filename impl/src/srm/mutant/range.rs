//! Wrong variants of the monitors of the range.

use crate::srm::retraction::Phase;
use crate::srm::slp_monitor;

variants! { srm::slp_monitor:
    /// A limit is violated 1 mm later.
    "slp-monitor-late" |state, config, inputs| {
        let config = slp_monitor::Config { x_negative: config.x_negative.saturating_sub(1), ..*config };
        slp_monitor::transition(state, &config, inputs)
    }

    /// A held ACK acknowledges for ever.
    "slp-monitor-static-ack" |state, config, inputs| {
        let state = slp_monitor::State { ack_held: false, ..state };
        slp_monitor::transition(state, config, inputs)
    }

    /// A held RELEASE enters a retraction.
    "slp-monitor-static-release" |state, config, inputs| {
        let state = slp_monitor::State { release_held: false, ..state };
        let (mut after, outputs) = slp_monitor::transition(state, config, inputs);
        after.release_held = inputs.release;
        (after, outputs)
    }

    /// Losing RELEASE leaves the enable of the violated limit.
    "slp-monitor-release-lingers" |state, config, inputs| {
        let (after, mut outputs) = slp_monitor::transition(state, config, inputs);
        if state.phase.retracts() && !inputs.release {
            outputs.x_negative_ok = true;
            outputs.x_positive_ok = true;
        }
        (after, outputs)
    }

    /// The axis comes back inside by itself and is enabled again.
    "slp-monitor-forgives" |state, config, inputs| {
        let inside = inputs.pos_valid && !inputs.below(config) && !inputs.above(config);
        let state = if inside && !inputs.release {
            slp_monitor::State { phase: Phase::Normal, low: false, high: false, ..state }
        } else {
            state
        };
        slp_monitor::transition(state, config, inputs)
    }

    /// A retraction goes on without a valid velocity.
    "slp-monitor-blind-retraction" |state, config, inputs| {
        let inputs = slp_monitor::Inputs { v_valid: true, ..*inputs };
        slp_monitor::transition(state, config, &inputs)
    }

    /// In a retraction both directions are free.
    "slp-monitor-both-ways" |state, config, inputs| {
        let (after, mut outputs) = slp_monitor::transition(state, config, inputs);
        if after.phase.retracts() {
            outputs.move_negative_ok = true;
            outputs.move_positive_ok = true;
        }
        (after, outputs)
    }

    /// An invalid position is a fault of both limits.
    "slp-monitor-invalid-is-outside" |state, config, inputs| {
        let (mut after, mut outputs) = slp_monitor::transition(state, config, inputs);
        if !inputs.pos_valid {
            after.low = true;
            after.phase = Phase::FaultLower;
            outputs.error = true;
        }
        (after, outputs)
    }

    /// A wrong parameter can be acknowledged.
    "slp-monitor-parameter-acknowledged" |state, config, inputs| {
        let (after, mut outputs) = slp_monitor::transition(state, config, inputs);
        if inputs.ack && !state.ack_held {
            outputs.diag &= !0x10;
        }
        (after, outputs)
    }

    /// The velocity fault waits for the limits to be acknowledged.
    "slp-monitor-velocity-last" |state, config, inputs| {
        let (mut after, mut outputs) = slp_monitor::transition(state, config, inputs);
        if state.fast && (after.low || after.high) {
            after.fast = true;
            outputs.sls_ok = false;
        }
        (after, outputs)
    }

    /// A suspended retraction needs a new edge.
    "slp-monitor-never-resumes" |state, config, inputs| {
        let (mut after, outputs) = slp_monitor::transition(state, config, inputs);
        if state.phase.suspended() && after.phase.retracts() {
            after.phase = state.phase;
        }
        (after, outputs)
    }
}
