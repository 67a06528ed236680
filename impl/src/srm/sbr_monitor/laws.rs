//! The contract of F_SBR_MONITOR.

use super::{Config, Inputs, Outputs, PARTS, Phase, SbrPos, SbrRetrig, State, transition};
use crate::srm::common::{ErrReact, calls, quotient, remainder};

/// The parameters let the block give its enable.
fn free(config: &Config) -> bool {
    config.parameter_bits() == 0 || config.err_react == ErrReact::Report
}

/// EXECUTE has become 1.
fn starts(s: &Step) -> bool {
    s.inputs.execute && !s.before.execute_held
}

/// ACK has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held
}

/// The way from the kept position, exact.
fn gone(s: &Step) -> i64 {
    (i64::from(s.inputs.safe_pos) - i64::from(s.after.start)).abs()
}

monitor! { srm::sbr_monitor;
    /// Too fast for the ramp while it is monitored: no enable in the same call.
    velocity_keeps_the_ramp ["SRM-SBR-008", "SRM-SBR-012", "SRM-P-40", "SRM-P-76"]:
        when |s| s.outputs.busy && s.outputs.sbr_ok && s.config.err_react == ErrReact::Safe
            => i64::from(s.inputs.safe_v).abs() <= i64::from(s.after.ramp) + i64::from(s.config.maxtol_v);

    /// Too far for the ramp while it is monitored: no enable in the same call.
    way_keeps_the_ramp ["SRM-SBR-009", "SRM-SBR-012", "SRM-P-40", "SRM-P-76"]:
        when |s| s.outputs.busy && s.outputs.sbr_ok && s.config.err_react == ErrReact::Safe
            && s.config.sbr_pos == SbrPos::Cum
            => gone(&s) <= i64::from(s.after.way) + i64::from(s.config.maxtol_pos);

    /// An edge at EXECUTE beside right parameters starts with the whole ramp and keeps the position.
    edge_starts_the_ramp ["SRM-SBR-007", "SRM-SBR-021"]:
        when |s| starts(&s) && s.before.phase == Phase::Idle && s.config.parameter_bits() == 0
            => s.outputs.busy && s.outputs.ramping && s.after.ramp == s.config.v_max && s.after.way == 0
                && s.after.start == s.inputs.safe_pos;

    /// Nothing but such an edge starts.
    nothing_else_starts ["SRM-SBR-007", "SRM-SBR-018", "SRM-ACK-006"]:
        when |s| s.before.phase == Phase::Idle && s.outputs.busy
            => starts(&s) && s.config.parameter_bits() == 0;

    /// In each call of the ramp it falls by V_MAX / N and ends at 0: after N calls.
    ramp_falls ["SRM-SBR-003", "SRM-SBR-010", "SRM-P-41"]:
        when |s| s.before.phase == Phase::Ramp && !(starts(&s) && s.config.sbr_retrig == SbrRetrig::Reload)
            => match calls(s.config.t_ramp, s.config.t_sample) {
                // V_MAX = step * N: what is missing of the ramp is a whole number of steps.
                Some(count) => s.after.ramp
                    == (i64::from(s.before.ramp) - i64::from(quotient(s.config.v_max, count))).max(0) as i32
                    && s.outputs.ramping == (s.after.ramp > 0),
                None => false,
            };

    /// The way grows by what the ramp of the call before goes in a call; what is no whole mm is kept.
    way_grows_with_the_ramp ["SRM-SBR-009", "SRM-SBR-019"]:
        when |s| s.before.phase == Phase::Ramp && s.after.phase != Phase::Idle && s.config.sbr_pos == SbrPos::Cum
            && !(starts(&s) && s.config.sbr_retrig == SbrRetrig::Reload) && !s.after.overflowed
            => (i64::from(s.after.way) - i64::from(s.before.way)) * i64::from(PARTS) + i64::from(s.after.rest)
                == i64::from(s.before.rest) + i64::from(s.before.ramp) * i64::from(s.config.t_sample);

    /// A second edge has no effect on a ramp that falls.
    second_edge_is_ignored ["SRM-SBR-014", "SRM-P-41"]:
        when |s| s.before.phase == Phase::Ramp && starts(&s) && s.config.sbr_retrig == SbrRetrig::Ignore
            => (s.after.ramp < s.before.ramp || s.after.ramp == 0) && s.after.phase != Phase::Idle
                && (s.after.start == s.before.start || s.config.sbr_pos == SbrPos::Cycle);

    /// The monitoring ends exactly when EXECUTE is 0 and the ramp has ended.
    end_wants_both ["SRM-SBR-010", "SRM-P-42"]:
        when |s| s.before.phase != Phase::Idle
            => s.outputs.busy == (s.inputs.execute || s.after.ramp > 0);

    /// The violation falls only by an edge at ACK below V_STOP_MONITORING, while nothing is violated.
    acknowledged_slowly ["SRM-SBR-013", "SRM-SBR-020", "SRM-ACK-001", "SRM-P-43", "SRM-P-75"]:
        when |s| s.before.violated && !s.after.violated
            => acknowledges(&s) && i64::from(s.inputs.safe_v).abs() < i64::from(s.config.v_stop_monitoring);

    /// An acknowledgement at rest, when nothing is monitored any more, is heard.
    rest_is_acknowledged ["SRM-SBR-013", "SRM-P-44"]:
        when |s| acknowledges(&s) && !s.outputs.busy && s.inputs.safe_v == 0 && s.config.v_stop_monitoring >= 1
            && free(&s.config)
            => !s.after.violated && !s.after.overflowed && s.outputs.sbr_ok && !s.outputs.ack_req;

    /// Without monitoring nothing is violated anew.
    idle_violates_nothing ["SRM-SBR-012", "SRM-SBR-018"]:
        when |s| !s.outputs.busy
            => (s.before.violated || !s.after.violated) && (s.before.overflowed || !s.after.overflowed)
                && s.outputs.pos_threshold == 0 && s.outputs.v_threshold == 0 && !s.outputs.ramping;

    /// While it is monitored the thresholds are the limits with their tolerances.
    thresholds_are_the_limits ["SRM-SBR-011"]:
        when |s| s.outputs.busy && !s.after.overflowed
            => i64::from(s.outputs.v_threshold) == i64::from(s.after.ramp) + i64::from(s.config.maxtol_v)
                && (i64::from(s.outputs.pos_threshold) == i64::from(s.after.way) + i64::from(s.config.maxtol_pos)
                    || s.config.sbr_pos == SbrPos::Cycle);

    /// A result that is no DInt is a fault and takes the enable away.
    overflow_is_a_fault ["SRM-SBR-015", "SRM-LFMATH-003", "SRM-DIAG-003", "SRM-P-70"]:
        when |s| s.outputs.busy
            && (i64::from(s.after.ramp) + i64::from(s.config.maxtol_v) > i64::from(i32::MAX)
                || i64::from(s.after.way) + i64::from(s.config.maxtol_pos) > i64::from(i32::MAX)
                || gone(&s) > i64::from(i32::MAX) && s.config.sbr_pos == SbrPos::Cum)
            => s.outputs.diag & 0x800 == 0x800 && s.outputs.error
                && (!s.outputs.sbr_ok || s.config.err_react == ErrReact::Report);

    /// Each wrong parameter has its bit, as long as the block runs; nothing then starts, and there is no enable (AMB-17 SAFE).
    wrong_parameters_stay ["SRM-SBR-004", "SRM-SBR-005", "SRM-SBR-006", "SRM-PARAM-003", "SRM-P-71"]:
        when |s| s.config.parameter_bits() != 0
            => s.outputs.error && s.outputs.diag & 0x7A == s.config.parameter_bits() && !s.outputs.busy
                && (!s.outputs.sbr_ok || s.config.err_react == ErrReact::Report);

    /// Which parameters are right: whole quotients, tolerances within the ramp.
    parameters_are_right ["SRM-SBR-003", "SRM-SBR-004", "SRM-SBR-005", "SRM-SBR-006"]:
        when |s| s.config.parameter_bits() == 0
            => s.config.t_sample > 0 && s.config.t_ramp > 0 && remainder(s.config.t_ramp, s.config.t_sample) == 0
                && remainder(s.config.v_max, quotient(s.config.t_ramp, s.config.t_sample).max(1)) == 0
                && s.config.maxtol_v <= s.config.v_max && s.outputs.diag & 0x7A == 0;

    /// Reports are what is latched; the other bits are 0.
    reports_are_exact ["SRM-ACK-003", "SRM-ACK-004", "SRM-DIAG-001", "SRM-SBR-016"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.diag & !0x7A == u16::from(s.after.violated) | u16::from(s.after.overflowed) << 11
                && s.outputs.error == (s.outputs.diag != 0)
                && (!s.outputs.ack_req || s.after.violated || s.after.overflowed)
                && s.outputs.sbr_ok == (!s.after.violated
                    && (s.config.err_react == ErrReact::Report || s.outputs.diag == 0));

    /// The step keeps the invariant and remembers the commands.
    state_stays_consistent ["SRM-SBR-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.ack_held == s.inputs.ack && s.after.execute_held == s.inputs.execute
                && s.outputs.busy == (s.after.phase != Phase::Idle);
}
