//! The contract of the load supervision of F_LOAD_MONITOR.

use super::{Config, Inputs, Outputs, State, transition};
use crate::srm::common::{ErrReact, remainder};

/// ACK has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held
}

/// Nothing takes all enables away.
fn free(s: &Step) -> bool {
    let fault =
        s.config.parameter_bits() != 0 || s.after.overflowed || s.inputs.calibration_overflow;
    s.config.err_react == ErrReact::Report || !fault
}

/// Some channel is above the limit of the mode.
fn heavy(s: &Step) -> bool {
    s.inputs.load1 > s.config.limit(s.inputs.maxload_mode)
        || s.inputs.load2 > s.config.limit(s.inputs.maxload_mode)
}

/// Some channel is below the least load.
fn light(s: &Step) -> bool {
    s.inputs.load1 < s.config.minload || s.inputs.load2 < s.config.minload
}

monitor! { srm::load_monitor;
    /// Overload takes the enable of its mode and the way up in the same call, unless a retraction goes on.
    overload_acts_at_once ["SRM-LOAD-010", "SRM-LOAD-011", "SRM-LOAD-022", "SRM-P-60", "SRM-P-61", "SRM-P-76"]:
        when |s| heavy(&s)
            => s.outputs.error && s.outputs.diag & 2 == 2 && !s.outputs.move_positive_ok
                && if s.inputs.maxload_mode {
                    s.after.over_dynamic && (!s.outputs.dyn_load_ok || s.after.retracting)
                } else {
                    s.after.over_static && (!s.outputs.stat_load_ok || s.after.retracting)
                };

    /// A slack rope takes its enable and the way down in the same call, unless a retraction goes on.
    slack_acts_at_once ["SRM-LOAD-012", "SRM-LOAD-022", "SRM-P-60", "SRM-P-61", "SRM-P-76"]:
        when |s| light(&s)
            => s.outputs.error && s.outputs.diag & 4 == 4 && !s.outputs.move_negative_ok
                && (!s.outputs.min_load_ok || s.after.retracting);

    /// Each mode has its own limit and its own enable.
    modes_are_apart ["SRM-LOAD-010", "SRM-LOAD-011", "SRM-LOAD-029"]:
        when |s| s.before.over_static != s.after.over_static && s.after.over_static
            || s.before.over_dynamic != s.after.over_dynamic && s.after.over_dynamic
            => heavy(&s) && (s.before.over_dynamic || !s.after.over_dynamic || s.inputs.maxload_mode)
                && (s.before.over_static || !s.after.over_static || !s.inputs.maxload_mode);

    /// Channels that differ limit the velocity and raise the error; nothing else.
    discrepancy_is_slow ["SRM-LOAD-008", "SRM-LOAD-023", "SRM-P-61"]:
        when |s| (i64::from(s.inputs.load1) - i64::from(s.inputs.load2)).abs() > i64::from(s.config.maxtol_load)
            => s.outputs.error && s.outputs.diag & 1 == 1 && s.outputs.sls_threshold == s.config.vmax_release.max(1);

    /// A load outside of 0 to 10000 is told.
    range_is_told ["SRM-LOAD-007"]:
        when |s| s.inputs.most() > 10_000 || s.inputs.least() < 0
            => s.outputs.error && s.outputs.diag & 0x400 == 0x400;

    /// Beside right limits it is an overload or a slack rope too.
    range_always_trips ["SRM-LOAD-007", "SRM-P-60"]:
        when |s| s.config.parameter_bits() == 0 && (s.inputs.most() > 10_000 || s.inputs.least() < 0)
            => s.after.overloaded_or_slack();

    /// The threshold is the slow velocity exactly while load or channels are latched.
    threshold_follows_the_faults ["SRM-LOAD-006", "SRM-LOAD-018", "SRM-LOAD-024", "SRM-P-61"]:
        when |s| free(&s)
            => s.outputs.sls_threshold == if s.after.overloaded_or_slack() || s.after.discrepancy {
                s.config.vmax_release.max(1)
            } else {
                i32::MAX
            };

    /// An overload is over only by an edge at ACK with both channels below the limit by more than the tolerance.
    overload_wants_its_hysteresis ["SRM-LOAD-013", "SRM-LOAD-022", "SRM-LOAD-027", "SRM-P-62"]:
        when |s| s.before.over_static && !s.after.over_static || s.before.over_dynamic && !s.after.over_dynamic
            => acknowledges(&s) && i64::from(s.inputs.most())
                < i64::from(s.config.limit(s.inputs.maxload_mode)) - i64::from(s.config.maxtol_load);

    /// A slack rope is over only by an edge at ACK with both channels above the least load by more than the tolerance.
    slack_wants_its_hysteresis ["SRM-LOAD-013", "SRM-LOAD-022", "SRM-P-62"]:
        when |s| s.before.slack && !s.after.slack
            => acknowledges(&s) && i64::from(s.inputs.least())
                > i64::from(s.config.minload) + i64::from(s.config.maxtol_load);

    /// A load between the limits and away from both by more than the tolerance is acknowledged.
    load_between_is_acknowledged ["SRM-LOAD-013", "SRM-P-65"]:
        when |s| acknowledges(&s) && s.inputs.load1 == s.inputs.load2 && free(&s) && s.config.parameter_bits() == 0
            && i64::from(s.inputs.load1) < i64::from(s.config.maxload_stat) - i64::from(s.config.maxtol_load)
            && i64::from(s.inputs.load1) > i64::from(s.config.minload) + i64::from(s.config.maxtol_load)
            => !s.after.overloaded_or_slack() && !s.after.discrepancy && !s.after.out_of_range
                && s.outputs.stat_load_ok && s.outputs.dyn_load_ok && s.outputs.min_load_ok
                && s.outputs.move_positive_ok && s.outputs.move_negative_ok && s.outputs.sls_threshold == i32::MAX;

    /// A retraction has RELEASE, a valid velocity and a reason.
    retraction_has_its_reasons ["SRM-LOAD-015", "SRM-LOAD-017", "SRM-P-64"]:
        when |s| s.after.retracting
            => s.inputs.release && s.inputs.v_valid && s.after.overloaded_or_slack() && !s.after.blind;

    /// It begins with an edge at RELEASE.
    retraction_wants_an_edge ["SRM-LOAD-015", "SRM-LOAD-030", "SRM-P-75"]:
        when |s| s.after.retracting && !s.before.retracting
            => s.inputs.release && !s.before.release_held;

    /// An edge that finds all it needs begins one: the enables return, the direction stays locked.
    retraction_begins ["SRM-LOAD-014", "SRM-LOAD-015"]:
        when |s| s.before.overloaded_or_slack() && !s.before.blind && s.inputs.v_valid && s.inputs.release
            && !s.before.release_held && !heavy(&s) && !light(&s) && !s.inputs.ack && free(&s)
            => s.after.retracting && s.outputs.stat_load_ok && s.outputs.dyn_load_ok && s.outputs.min_load_ok
                && s.outputs.error;

    /// A new overload or slack rope ends it in the same call.
    new_fault_ends_the_retraction ["SRM-LOAD-028"]:
        when |s| !s.before.over_static && s.after.over_static || !s.before.over_dynamic && s.after.over_dynamic
            || !s.before.slack && s.after.slack
            => !s.after.retracting && (!s.after.slack || !s.outputs.min_load_ok);

    /// Without RELEASE what is latched has no enable.
    release_ends_it ["SRM-LOAD-015", "SRM-ACK-008"]:
        when |s| !s.inputs.release
            => !s.after.retracting && (!s.after.over_static || !s.outputs.stat_load_ok)
                && (!s.after.over_dynamic || !s.outputs.dyn_load_ok) && (!s.after.slack || !s.outputs.min_load_ok);

    /// An invalid velocity in a retraction ends it: a fault, no SLS enable, in the same call.
    blind_retraction_ends ["SRM-LOAD-017", "SRM-LOAD-026", "SRM-P-64"]:
        when |s| s.before.retracting && !s.inputs.v_valid
            => !s.after.retracting && !s.outputs.sls_ok && s.outputs.error && s.outputs.diag & 0x200 == 0x200;

    /// Too fast takes the SLS enable away, in a retraction and without one.
    fast_is_stopped ["SRM-LOAD-016", "SRM-LOAD-026"]:
        when |s| s.inputs.v_valid && i64::from(s.inputs.safe_v).abs() > i64::from(s.outputs.sls_threshold) && free(&s)
            => !s.outputs.sls_ok && s.outputs.error && s.outputs.diag & 0x80 == 0x80;

    /// The faults of the velocity are over only by an edge at ACK: slow, and valid.
    velocity_is_acknowledged ["SRM-LOAD-016", "SRM-LOAD-017", "SRM-P-75"]:
        when |s| s.before.fast && !s.after.fast || s.before.blind && !s.after.blind
            => acknowledges(&s) && (!s.before.blind || s.after.blind || s.inputs.v_valid)
                && (!s.before.fast || s.after.fast || !free(&s)
                    || i64::from(s.inputs.safe_v).abs() <= i64::from(s.outputs.sls_threshold));

    /// Undisturbed everything is enabled and nothing told.
    undisturbed ["SRM-LOAD-024", "SRM-ACK-001"]:
        when |s| (State { release_held: true, ack_held: true, ..s.before }) == State::INITIAL && s.config.parameter_bits() == 0
            && !heavy(&s) && !light(&s) && s.inputs.safe_v > i32::MIN && free(&s)
            && (i64::from(s.inputs.load1) - i64::from(s.inputs.load2)).abs() <= i64::from(s.config.maxtol_load)
            => s.outputs.diag == 0 && !s.outputs.error && !s.outputs.ack_req && s.outputs.sls_ok
                && s.outputs.dyn_load_ok && s.outputs.stat_load_ok && s.outputs.min_load_ok
                && s.outputs.move_negative_ok && s.outputs.move_positive_ok && s.outputs.sls_threshold == i32::MAX;

    /// A difference or a sum that is no DInt is a fault.
    overflow_is_a_fault ["SRM-LOAD-025", "SRM-LFMATH-003", "SRM-DIAG-003", "SRM-P-70"]:
        when |s| (i64::from(s.inputs.load1) - i64::from(s.inputs.load2)).abs() > i64::from(i32::MAX) + 1
            => s.outputs.error && s.outputs.diag & 0x800 == 0x800
                && (s.config.err_react == ErrReact::Report || !s.outputs.sls_ok && !s.outputs.stat_load_ok
                    && !s.outputs.dyn_load_ok && !s.outputs.min_load_ok && !s.outputs.move_negative_ok
                    && !s.outputs.move_positive_ok);

    /// Which parameters are right.
    parameters_are_right ["SRM-LOAD-004", "SRM-LOAD-005", "SRM-LOAD-006", "SRM-PARAM-003", "SRM-P-71"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.diag & 0x148 == s.config.parameter_bits()
                && (s.outputs.diag & 0x148 == 0) == (s.config.minload < s.config.maxload_stat
                    && s.config.maxload_stat <= s.config.maxload_dyn
                    && s.config.t_sample > 0 && s.config.t_settle > 0 && s.config.t_test > s.config.t_settle
                    && remainder(s.config.t_test, s.config.t_sample.max(1)) == 0
                    && remainder(s.config.t_settle, s.config.t_sample.max(1)) == 0
                    && s.config.vmax_release > 0 && s.config.minload >= 0 && s.config.maxload_dyn <= 10_000
                    && (0..=10_000).contains(&s.config.cal_value)
                    && (0..=10_000).contains(&s.config.maxtol_load)
                    && (0..=10_000).contains(&s.config.maxtol_cal));

    /// Reports are what is latched; the other bits are 0; without enables the velocity is limited too (AMB-17 SAFE).
    reports_are_exact ["SRM-ACK-003", "SRM-ACK-004", "SRM-DIAG-001", "SRM-LOAD-020"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.error == (s.outputs.diag != 0) && s.outputs.diag & !0xFCF == 0
                && (!s.outputs.ack_req || s.outputs.diag & 0xE87 != 0)
                && (free(&s) || !s.outputs.sls_ok && !s.outputs.stat_load_ok && !s.outputs.dyn_load_ok
                    && !s.outputs.min_load_ok && !s.outputs.move_negative_ok && !s.outputs.move_positive_ok
                    && s.outputs.sls_threshold == s.config.vmax_release.max(1));

    /// The step keeps the invariant and remembers the commands.
    state_stays_consistent ["SRM-LOAD-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.ack_held == s.inputs.ack && s.after.release_held == s.inputs.release;
}
