//! The contract of F_ENDZONE.

use super::{Config, Direction, EzDir, Inputs, Outputs, State, VinvRetract, transition};
use crate::srm::common::ErrReact;
use crate::srm::retraction::Phase;

/// ACK has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held
}

/// Nothing takes all enables away.
fn free(s: &Step) -> bool {
    s.config.err_react == ErrReact::Report || s.config.parameter_bits() == 0 && !s.after.overflowed
}

/// The envelope at a distance; 0 where it cannot be calculated.
fn envelope(config: &Config, distance: i64) -> i64 {
    let distance = i32::try_from(distance).ok();
    config.envelope(distance).map_or(0, i64::from)
}

/// The envelopes of the upper and the lower end.
fn ends(s: &Step) -> (i64, i64) {
    let place = i64::from(s.inputs.safe_pos);
    (
        envelope(&s.config, i64::from(s.inputs.x_positive) - place),
        envelope(&s.config, place - i64::from(s.inputs.x_negative)),
    )
}

/// What the direction after the call makes of both.
fn approached(s: &Step) -> i64 {
    let (upper, lower) = ends(s);
    match s.after.direction {
        Direction::Rising => upper,
        Direction::Falling => lower,
        Direction::Unknown => upper.min(lower),
    }
}

/// The velocity without its sign.
fn velocity(s: &Step) -> i64 {
    i64::from(s.inputs.safe_v).abs()
}

/// Position and velocity are valid.
fn valid(s: &Step) -> bool {
    s.inputs.pos_valid && s.inputs.v_valid
}

monitor! { srm::endzone;
    /// A valid position below the lower limit takes its enable away in the same call, unless a retraction goes on.
    lower_limit_acts_at_once ["SRM-ENDZONE-015", "SRM-ENDZONE-023", "SRM-P-20", "SRM-P-76"]:
        when |s| s.inputs.pos_valid && s.inputs.safe_pos < s.inputs.x_negative
            => s.after.low && s.outputs.error && s.outputs.diag & 1 == 1
                && (!s.outputs.x_negative_ok || s.after.phase == Phase::RetractLower || s.after.phase == Phase::RetractUpper
                    || s.config.vinv_retract == VinvRetract::Hold)
                && !(s.outputs.move_negative_ok && s.inputs.safe_pos <= s.inputs.x_positive);

    /// The same above the upper limit.
    upper_limit_acts_at_once ["SRM-ENDZONE-015", "SRM-ENDZONE-023", "SRM-P-20", "SRM-P-76"]:
        when |s| s.inputs.pos_valid && s.inputs.safe_pos > s.inputs.x_positive
            => s.after.high && s.outputs.error && s.outputs.diag & 2 == 2
                && (!s.outputs.x_positive_ok || s.after.phase == Phase::RetractLower || s.after.phase == Phase::RetractUpper
                    || s.config.vinv_retract == VinvRetract::Hold)
                && !(s.outputs.move_positive_ok && s.inputs.safe_pos >= s.inputs.x_negative);

    /// Limits that have crossed violate both ends and lock both directions; no retraction.
    crossed_limits_lock ["SRM-ENDZONE-030", "SRM-P-28"]:
        when |s| s.inputs.pos_valid && s.inputs.x_negative > s.inputs.x_positive
            => s.after.low && s.after.high && !s.after.phase.released()
                && !s.outputs.x_negative_ok && !s.outputs.x_positive_ok
                && !s.outputs.move_negative_ok && !s.outputs.move_positive_ok;

    /// Otherwise one direction is always left.
    one_direction_is_left ["SRM-P-28"]:
        when |s| free(&s) && !(s.inputs.pos_valid && s.inputs.x_negative > s.inputs.x_positive)
            => s.outputs.move_negative_ok || s.outputs.move_positive_ok;

    /// A retraction has RELEASE and a valid velocity, enables both limits and locks the way further out.
    retraction_is_one_way ["SRM-ENDZONE-017", "SRM-ENDZONE-026", "SRM-P-21", "SRM-P-31"]:
        when |s| s.after.phase.retracts() && free(&s)
            => s.inputs.release && s.inputs.v_valid
                && s.outputs.move_negative_ok == s.after.phase.upper() && s.outputs.move_positive_ok == s.after.phase.lower()
                && s.outputs.x_negative_ok && s.outputs.x_positive_ok;

    /// While RELEASE is accepted the threshold is at most its velocity and, outside, the envelope of the opposite end.
    retraction_is_slow ["SRM-ENDZONE-017", "SRM-ENDZONE-018", "SRM-ENDZONE-024", "SRM-P-22"]:
        when |s| s.after.phase.released() && free(&s)
            => i64::from(s.outputs.sls_threshold) == i64::from(s.config.vmax_release.max(1)).min(
                if !s.inputs.pos_valid {
                    i64::MAX
                } else if s.after.phase.lower() {
                    ends(&s).0
                } else if s.after.phase.upper() {
                    ends(&s).1
                } else {
                    approached(&s)
                });

    /// RELEASE inside the range needs an edge, nothing latched and a valid position; both directions are free.
    release_inside ["SRM-ENDZONE-016"]:
        when |s| s.after.phase == Phase::Inside
            => s.inputs.release && !s.after.low && !s.after.high
                && (s.before.phase == Phase::Inside
                    || !s.before.release_held && s.inputs.pos_valid && s.before.phase == Phase::Normal)
                && (!free(&s) || s.outputs.move_negative_ok && s.outputs.move_positive_ok);

    /// An edge inside the range that finds a valid position is accepted.
    release_inside_is_heard ["SRM-ENDZONE-016"]:
        when |s| s.before.phase == Phase::Normal && s.inputs.release && !s.before.release_held && s.inputs.pos_valid
            && !s.after.low && !s.after.high
            => s.after.phase == Phase::Inside;

    /// A retraction from outside begins with an edge at RELEASE beside valid signals.
    retraction_wants_an_edge ["SRM-ENDZONE-017", "SRM-ENDZONE-020", "SRM-P-30"]:
        when |s| s.after.phase.retracts() && !s.before.phase.released()
            => s.inputs.release && !s.before.release_held && valid(&s) && (s.before.low || s.before.high);

    /// Without RELEASE none goes on, and what is latched has no enable.
    release_ends_it ["SRM-ENDZONE-026", "SRM-P-23", "SRM-P-31"]:
        when |s| !s.inputs.release
            => !s.after.phase.released()
                && (!s.after.low || !s.outputs.x_negative_ok) && (!s.after.high || !s.outputs.x_positive_ok);

    /// With an invalid velocity none goes on; the enables are gone (AMB-28 STOP).
    invalid_velocity_suspends ["SRM-ENDZONE-014", "SRM-ENDZONE-020", "SRM-P-31"]:
        when |s| !s.inputs.v_valid
            => !s.after.phase.retracts() && s.outputs.diag & 0x40 == 0x40
                && (s.config.vinv_retract == VinvRetract::Hold
                    || (!s.after.low || !s.outputs.x_negative_ok) && (!s.after.high || !s.outputs.x_positive_ok));

    /// A suspended retraction goes on with the velocity, without a new edge.
    suspension_ends ["SRM-ENDZONE-020"]:
        when |s| s.before.phase == Phase::SuspendLower && s.inputs.release && valid(&s)
            && s.inputs.safe_pos <= s.inputs.x_positive && s.inputs.x_negative <= s.inputs.x_positive && s.after.low
            => s.after.phase == Phase::RetractLower && s.outputs.diag & 0x40 == 0;

    /// A latch of a limit falls only by an edge at ACK while the position keeps the limit or is invalid.
    acknowledged_inside ["SRM-ENDZONE-028", "SRM-ENDZONE-033", "SRM-ACK-001", "SRM-P-24", "SRM-P-75"]:
        when |s| s.before.low && !s.after.low || s.before.high && !s.after.high
            => acknowledges(&s) && (!s.inputs.pos_valid || s.inputs.x_negative <= s.inputs.x_positive
                && (!s.before.low || s.after.low || s.inputs.safe_pos >= s.inputs.x_negative)
                && (!s.before.high || s.after.high || s.inputs.safe_pos <= s.inputs.x_positive));

    /// An edge at ACK clears each bit that keeps its own condition.
    acknowledgement_is_heard ["SRM-ACK-002", "SRM-ENDZONE-010", "SRM-ENDZONE-019", "SRM-ENDZONE-033"]:
        when |s| acknowledges(&s)
            => s.after.low == s.inputs.below() && s.after.high == s.inputs.above()
                && (s.inputs.v_valid || !s.after.fast && !s.after.retracts_fast);

    /// When the latches of the limits are gone the axis is inside: nothing is locked, its envelope counts.
    acknowledged_is_normal ["SRM-ENDZONE-019", "SRM-ENDZONE-028", "SRM-P-28"]:
        when |s| !s.after.low && !s.after.high && free(&s)
            => !s.after.phase.lower() && !s.after.phase.upper() && s.outputs.x_negative_ok && s.outputs.x_positive_ok
                && s.outputs.move_negative_ok && s.outputs.move_positive_ok;

    /// An enable of a limit that had gone comes back only by an acknowledgement, an accepted edge at RELEASE, or the end of a
    /// suspension with RELEASE held.
    nothing_restarts_by_itself ["SRM-ACK-008", "SRM-P-30", "SRM-P-75"]:
        when |s| s.before.high && !s.before.phase.retracts() && s.outputs.x_positive_ok
            => acknowledges(&s) || s.inputs.release && (!s.before.release_held || s.before.phase.suspended());

    /// With valid signals and no RELEASE the threshold is the envelope of what is approached.
    envelope_is_the_threshold ["SRM-ENDZONE-004", "SRM-ENDZONE-008", "SRM-ENDZONE-011", "SRM-ENDZONE-024", "SRM-ENDZONE-031"]:
        when |s| valid(&s) && !s.after.phase.released() && free(&s)
            => i64::from(s.outputs.sls_threshold) == approached(&s);

    /// A velocity above it takes the SLS enable away in the same call.
    envelope_acts_at_once ["SRM-ENDZONE-009", "SRM-ENDZONE-025", "SRM-P-26", "SRM-P-76"]:
        when |s| valid(&s) && !s.after.phase.released() && velocity(&s) > approached(&s)
            => !s.outputs.sls_ok && s.outputs.error && s.outputs.diag & 0x200 == 0x200;

    /// No threshold of the envelope is above V_16.
    never_above_v_16 ["SRM-ENDZONE-005", "SRM-ENDZONE-012"]:
        when |s| valid(&s) && !s.after.phase.released() && free(&s) && s.config.interpolation.v_16 >= 0
            => s.outputs.sls_threshold <= s.config.interpolation.v_16;

    /// While the position is invalid V_16 is supervised.
    invalid_position_leaves_v_16 ["SRM-ENDZONE-012", "SRM-ENDZONE-013"]:
        when |s| !s.inputs.pos_valid && s.inputs.v_valid && !s.after.phase.released()
            && velocity(&s) > i64::from(s.config.interpolation.v_16)
            => !s.outputs.sls_ok && s.outputs.diag & 0x200 == 0x200;

    /// Then the threshold is held, from an edge at ACK on it is V_16.
    invalid_position_holds_the_threshold ["SRM-ENDZONE-013", "SRM-ENDZONE-032"]:
        when |s| !s.inputs.pos_valid && s.inputs.v_valid && !s.after.phase.released() && free(&s)
            => s.outputs.sls_threshold == if acknowledges(&s) { s.config.interpolation.v_16 } else { s.before.threshold };

    /// An invalid velocity holds it too, and is not supervised.
    invalid_velocity_is_not_supervised ["SRM-ENDZONE-014", "SRM-ENDZONE-029"]:
        when |s| !s.inputs.v_valid
            => (s.before.fast || !s.after.fast) && (s.before.retracts_fast || !s.after.retracts_fast)
                && (s.after.phase.released() || !free(&s) || s.outputs.sls_threshold == s.before.threshold);

    /// In a retraction a velocity above the threshold is latched by its own bit.
    fast_retraction_is_stopped ["SRM-ENDZONE-018", "SRM-ENDZONE-029"]:
        when |s| s.after.phase.released() && s.inputs.v_valid && free(&s)
            && velocity(&s) > i64::from(s.outputs.sls_threshold)
            => s.after.retracts_fast && !s.outputs.sls_ok && s.outputs.error && s.outputs.diag & 4 == 4;

    /// The latches of the velocity fall only by an edge at ACK beside a velocity that keeps the threshold or is not supervised.
    velocity_is_acknowledged ["SRM-ENDZONE-010", "SRM-ENDZONE-018", "SRM-ENDZONE-025", "SRM-P-75"]:
        when |s| s.before.fast && !s.after.fast || s.before.retracts_fast && !s.after.retracts_fast
            => acknowledges(&s)
                && (!s.inputs.v_valid || velocity(&s) <= i64::from(s.after.threshold)
                    || !s.inputs.pos_valid && velocity(&s) <= i64::from(s.config.interpolation.v_16));

    /// A direction is what the position did between two calls with valid signals; it expires at standstill and with the signals.
    direction_is_seen ["SRM-ENDZONE-008", "SRM-ENDZONE-031"]:
        when |s| s.before.direction != s.after.direction || s.before.seen && valid(&s) && s.inputs.safe_v != 0
            => match s.after.direction {
                Direction::Unknown => s.config.ez_dir == EzDir::Expire && (!valid(&s) || s.inputs.safe_v == 0)
                    || s.before.direction == Direction::Unknown && s.inputs.safe_pos == s.before.place,
                Direction::Rising => valid(&s) && s.before.seen && (s.inputs.safe_pos > s.before.place
                    || s.inputs.safe_pos == s.before.place && s.before.direction == Direction::Rising),
                Direction::Falling => valid(&s) && s.before.seen && (s.inputs.safe_pos < s.before.place
                    || s.inputs.safe_pos == s.before.place && s.before.direction == Direction::Falling),
            };

    /// An axis that stands or cannot be seen has none (AMB-31 EXPIRE).
    direction_expires ["SRM-ENDZONE-031"]:
        when |s| s.config.ez_dir == EzDir::Expire && (s.inputs.safe_v == 0 || !valid(&s))
            => s.after.direction == Direction::Unknown;

    /// An invalid signal is told; it raises no fault by itself.
    invalid_signals_are_told ["SRM-ENDZONE-013", "SRM-ENDZONE-014", "SRM-ACK-004", "SRM-P-25"]:
        when |s| !s.inputs.pos_valid
            => s.outputs.diag & 0x20 == 0x20 && (s.before.low || !s.after.low) && (s.before.high || !s.after.high)
                && (s.before.overflowed || !s.after.overflowed);

    /// A distance that is no DInt, and an envelope that cannot be calculated, are a fault.
    overflow_is_a_fault ["SRM-ENDZONE-021", "SRM-LFMATH-003", "SRM-DIAG-003", "SRM-P-70"]:
        when |s| s.inputs.pos_valid
            && (i64::from(s.inputs.x_positive) - i64::from(s.inputs.safe_pos) > i64::from(i32::MAX)
                || i64::from(s.inputs.safe_pos) - i64::from(s.inputs.x_negative) > i64::from(i32::MAX)
                || !s.config.interpolation.ascends())
            => s.outputs.error && s.outputs.diag & 0x800 == 0x800
                && (s.config.err_react == ErrReact::Report || !s.outputs.sls_ok && !s.outputs.x_negative_ok
                    && !s.outputs.x_positive_ok && !s.outputs.move_negative_ok && !s.outputs.move_positive_ok);

    /// Which parameters are right; a wrong one is told as long as the block runs and takes every enable away (AMB-17 SAFE).
    parameters_are_right ["SRM-ENDZONE-006", "SRM-ENDZONE-007", "SRM-PARAM-003", "SRM-P-71"]:
        when |s| s.before.invariant(&s.config)
            => (s.outputs.diag & 8 == 0) == (s.config.interpolation.x[0] == 0 && s.config.interpolation.v[0] == 0
                    && s.config.interpolation.ascends())
                && (s.outputs.diag & 16 == 0) == (s.config.vmax_release >= 1
                    && s.config.vmax_release <= s.config.interpolation.v_16)
                && (s.outputs.diag & 24 == 0 || s.outputs.error && (s.config.err_react == ErrReact::Report
                    || !s.outputs.sls_ok && !s.outputs.x_negative_ok && !s.outputs.x_positive_ok
                        && !s.outputs.move_negative_ok && !s.outputs.move_positive_ok
                        && s.outputs.sls_threshold == s.config.vmax_release.max(1)));

    /// Reports are what is latched; the other bits are 0.
    reports_are_exact ["SRM-ACK-003", "SRM-ACK-004", "SRM-DIAG-001", "SRM-ENDZONE-022"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.diag & !0x18 == u16::from(s.after.low) | u16::from(s.after.high) << 1
                    | u16::from(s.after.retracts_fast) << 2 | u16::from(!s.inputs.pos_valid) << 5
                    | u16::from(!s.inputs.v_valid) << 6 | u16::from(s.after.fast) << 9 | u16::from(s.after.overflowed) << 11
                && s.outputs.error == (s.outputs.diag & 0xA1F != 0)
                && (!s.outputs.ack_req || s.outputs.diag & 0xA07 != 0)
                && s.outputs.sls_ok == (!s.after.fast && !s.after.retracts_fast && free(&s));

    /// The step keeps the invariant and remembers the commands.
    state_stays_consistent ["SRM-ENDZONE-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.ack_held == s.inputs.ack && s.after.release_held == s.inputs.release;
}
