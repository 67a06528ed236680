//! The contract of F_SAFE_POS.

use super::{Config, CountWatch, Direction, Inputs, Outputs, Phase, State, SyncPos2, transition};
use crate::srm::common::{ErrReact, remainder, um};

/// ACK has become 1.
fn acknowledges(s: &Step) -> bool {
    s.inputs.ack && !s.before.ack_held
}

/// REFERENCE has become 1.
fn references(s: &Step) -> bool {
    s.inputs.reference && !s.before.reference_held
}

/// SYNC has become 1.
fn syncs(s: &Step) -> bool {
    s.inputs.sync && !s.before.sync_held
}

/// Nothing takes all enables away.
fn free(s: &Step) -> bool {
    s.config.err_react == ErrReact::Report || s.config.parameter_bits() == 0 && !s.after.overflowed
}

/// POS1 has gone further in a call than twice V_MAX allows.
fn jump(s: &Step) -> bool {
    let way = (i64::from(s.inputs.pos1) - i64::from(s.before.last1)).abs();
    s.before.seen1
        && s.inputs.pos1_valid
        && 30 * um(way) > i64::from(s.config.t_sample) * i64::from(s.config.v_max)
}

/// An encoder that is needed is invalid, or POS1 has jumped.
fn encoder_fault(s: &Step) -> bool {
    !s.inputs.pos1_valid
        || !s.inputs.possi_valid
        || s.config.pos_config && !s.inputs.pos2_valid
        || jump(s)
}

/// POS1 with the offset of a state, mm.
fn first(s: &Step, state: &State) -> i64 {
    i64::from(s.inputs.pos1) + i64::from(state.off1)
}

/// POS1 and POSSI with the offsets of a state are within a window; um. In the order of the block's own sums, as all that follow: a solver
/// finds the same sums at once, and does not find that two different orders are the same number.
fn motor_within(s: &Step, state: &State, window: i32) -> bool {
    let motor = i64::from(s.inputs.possi) + i64::from(state.off_si);
    (um(first(s, state)) - motor).abs() <= um(i64::from(window))
}

/// POS1 and POS2 with the offsets of a state are within a window.
fn second_within(s: &Step, state: &State, window: i32) -> bool {
    let second = i64::from(state.off2) - i64::from(s.inputs.pos2);
    (first(s, state) - second).abs() <= i64::from(window)
}

/// The encoders have gone apart in the offsets before the call.
fn apart(s: &Step) -> bool {
    s.before.phase.formed()
        && !(motor_within(s, &s.before, s.config.possi_disc_window)
            && (!s.config.pos_config || second_within(s, &s.before, s.config.pos2_disc_window)))
}

/// The reference has survived a fault, as far as the encoders tell now.
fn survives(s: &Step) -> bool {
    let before = &s.before;
    before.was_ref
        && if s.config.pos_config {
            second_within(s, before, s.config.pos_disc_window)
                && second_within(s, before, s.config.pos2_disc_window)
        } else if before.si_failed {
            (first(s, before) - i64::from(before.saved)).abs()
                <= i64::from(s.config.pos_startup_tol)
        } else {
            motor_within(s, before, s.config.pos_disc_window)
                && motor_within(s, before, s.config.possi_disc_window)
        }
}

/// A command that ends a fault is given.
fn commanded(s: &Step) -> bool {
    references(s) || syncs(s) || acknowledges(s) && survives(s)
}

/// The reference is validated: all encoders are back, and no command ends the fault.
fn validates(s: &Step) -> bool {
    !encoder_fault(s)
        && (s.before.phase == Phase::EncoderFault || s.before.phase.faulty() && !commanded(s))
}

/// It is, and tells so.
fn is_validated(s: &Step) -> bool {
    let phase = if survives(s) {
        Phase::Valid
    } else {
        Phase::Invalid
    };
    s.after.phase == phase
        && s.outputs.error
        && s.outputs.diag & 0x200 == 0x200
        && !s.outputs.pos_valid
        && !s.outputs.v_valid
}

/// POS1 and POSSI have gone different ways in the window of the call before.
fn drift(s: &Step) -> i64 {
    let first = i64::from(s.inputs.pos1) - i64::from(s.before.window1);
    let motor = i64::from(s.inputs.possi) - i64::from(s.before.window_si);
    (um(first) - motor).abs()
}

/// How far the counter has gone since the last sample, modulo 2^16.
fn ticks(s: &Step) -> i64 {
    i64::from((s.inputs.possi_count as u16).wrapping_sub(s.before.count as u16))
}

/// A velocity is that of a way in so many cycles, um and ms to mm/min, rounded up.
fn rounded_up(velocity: i32, way: i64, count: i64, cycle: i32) -> bool {
    let time = count * i64::from(cycle);
    let product = i64::from(velocity) * time;
    way * 60 <= product && product - way * 60 < time
}

monitor! { srm::safe_pos;
    /// An encoder that is invalid or jumps takes everything away in the same call, whatever is commanded.
    encoder_fault_acts_at_once ["SRM-POS-003", "SRM-POS-004", "SRM-POS-013", "SRM-POS-014", "SRM-POS-031", "SRM-REF-014", "SRM-REF-015", "SRM-P-02", "SRM-P-76"]:
        when |s| encoder_fault(&s)
            => !s.outputs.pos_valid && !s.outputs.referenced && !s.outputs.v_valid && s.outputs.error
                && s.outputs.diag & 0x200 == 0x200 && s.after.phase == Phase::EncoderFault;

    /// The comparison of the encoders is hidden then: no bit of a discrepancy rises.
    encoder_fault_hides_the_comparison ["SRM-POS-022", "SRM-P-05"]:
        when |s| encoder_fault(&s)
            => s.after.apart == s.before.apart && s.after.off1 == s.before.off1 && s.after.off2 == s.before.off2
                && s.after.off_si == s.before.off_si;

    /// What was valid before the first fault is kept over all that follow it.
    saved_is_from_before_the_fault ["SRM-POS-026", "SRM-POS-030", "SRM-P-15"]:
        when |s| encoder_fault(&s) && (s.before.phase.formed() || s.before.phase.faulty())
            => s.after.saved == s.before.saved && s.after.was_ref == (s.before.was_ref || s.before.phase == Phase::Referenced)
                && s.after.si_failed == (s.before.si_failed || !s.inputs.possi_valid);

    /// With two encoders a position that is formed is confirmed by POSSI.
    two_encoders_agree ["SRM-POS-011", "SRM-P-07", "SRM-P-76"]:
        when |s| s.outputs.pos_valid && !s.config.pos_config && s.config.possi_disc_window >= 0
            => motor_within(&s, &s.after, s.config.possi_disc_window);

    /// With three it is confirmed by POS2 and POSSI.
    three_encoders_agree ["SRM-POS-014", "SRM-ARCH-019", "SRM-P-08", "SRM-P-76"]:
        when |s| s.outputs.pos_valid && s.config.pos_config && s.config.possi_disc_window >= 0 && s.config.pos2_disc_window >= 0
            => motor_within(&s, &s.after, s.config.possi_disc_window)
                && second_within(&s, &s.after, s.config.pos2_disc_window);

    /// Two encoders that have gone apart cost the reference, by bit 8, before any command.
    discrepancy_of_two ["SRM-POS-011", "SRM-POS-027", "SRM-POS-031", "SRM-REF-011"]:
        when |s| !encoder_fault(&s) && apart(&s) && !s.config.pos_config
            => s.after.phase == Phase::Discrepant && s.outputs.error && s.outputs.diag & 0x100 == 0x100
                && !s.outputs.pos_valid && !s.outputs.referenced && !s.outputs.v_valid;

    /// Three that have gone apart are treated as an encoder fault, which keeps the reference to be validated.
    discrepancy_of_three ["SRM-POS-014", "SRM-POS-018", "SRM-POS-029", "SRM-REF-011"]:
        when |s| !encoder_fault(&s) && apart(&s) && s.config.pos_config
            => s.after.phase == Phase::EncoderFault && s.outputs.error && s.outputs.diag & 0x200 == 0x200
                && s.after.was_ref == (s.before.phase == Phase::Referenced) && !s.after.si_failed;

    /// Bit 8 rises by a discrepancy of two encoders only, and falls only by SYNC or REFERENCE: no acknowledgement ends it.
    discrepancy_is_not_acknowledged ["SRM-POS-012", "SRM-P-04"]:
        when |s| s.before.apart != s.after.apart
            => if s.after.apart { apart(&s) && !s.config.pos_config } else { references(&s) || syncs(&s) };

    /// REFERENCE with all encoders valid puts all of them at the reference point, and clears bits 7 to 12.
    reference_is_set ["SRM-REF-008", "SRM-REF-010", "SRM-REF-013", "SRM-POS-001", "SRM-POSPARAM-012", "SRM-P-13"]:
        when |s| references(&s) && !encoder_fault(&s) && !apart(&s) && s.before.phase != Phase::EncoderFault
            && !s.after.overflowed
            => s.after.phase == Phase::Referenced && s.outputs.safe_pos == s.config.pos_reference
                && s.outputs.diag & 0x1F80 == 0 && motor_within(&s, &s.after, 0)
                && (!s.config.pos_config || second_within(&s, &s.after, 0));

    /// Nothing else gives the reference but the acknowledgement of a fault that it has survived, or of a calculation fault.
    reference_is_earned ["SRM-REF-001", "SRM-REF-009", "SRM-POS-023", "SRM-P-03", "SRM-P-06"]:
        when |s| s.after.phase == Phase::Referenced && s.before.phase != Phase::Referenced
            => !encoder_fault(&s) && (references(&s) || acknowledges(&s) && survives(&s)
                && (s.before.phase == Phase::Valid || s.before.phase == Phase::Invalid));

    /// It is lost by an encoder fault or a discrepancy only; range, velocity and drift leave it.
    reference_is_kept ["SRM-REF-007", "SRM-REF-011", "SRM-POS-019", "SRM-P-12"]:
        when |s| s.before.phase == Phase::Referenced && !encoder_fault(&s) && !apart(&s)
            => s.after.phase == Phase::Referenced && s.outputs.referenced == free(&s);

    /// REFERENCED means a position that is formed, but for its range.
    referenced_is_valid ["SRM-POS-001", "SRM-P-01"]:
        when |s| s.outputs.referenced
            => s.outputs.pos_valid || s.after.above || s.after.below;

    /// Bit 7 is told until the first reference, and is no error.
    first_reference_is_missing ["SRM-REF-001", "SRM-REF-013"]:
        when |s| !s.after.ever
            => s.outputs.diag & 0x80 == 0x80 && !s.outputs.referenced
                && s.outputs.error == (s.outputs.diag & !0x80 != 0);

    /// SYNC moves the other encoders to POS1 and forms a position for relative use; POS1 keeps its offset.
    sync_aligns ["SRM-REF-002", "SRM-REF-003", "SRM-REF-004", "SRM-REF-006", "SRM-POS-010", "SRM-POS-017", "SRM-POS-034", "SRM-P-13"]:
        when |s| syncs(&s) && !references(&s) && !encoder_fault(&s) && !apart(&s) && s.before.phase != Phase::EncoderFault
            && !s.after.overflowed
            => s.after.phase == if s.before.phase == Phase::Referenced { Phase::Referenced } else { Phase::Synced }
                && motor_within(&s, &s.after, 0) && s.after.off1 == s.before.off1 && s.outputs.diag & 0x1F00 == 0
                && (!s.config.pos_config || s.before.phase == Phase::Referenced || second_within(&s, &s.after, 0));

    /// The offset of POS2 moves by a reference or by SYNC only, and by that not while it confirms a reference (AMB-14 KEEP).
    second_encoder_is_kept ["SRM-REF-005", "SRM-POS-016", "SRM-P-14"]:
        when |s| s.after.off2 != s.before.off2
            => references(&s) || syncs(&s) && (s.before.phase != Phase::Referenced || s.config.sync_pos2 == SyncPos2::Align);

    /// The offset of POS1 moves by a reference only.
    first_encoder_is_kept ["SRM-REF-007", "SRM-POS-028"]:
        when |s| s.after.off1 != s.before.off1
            => references(&s) && !encoder_fault(&s);

    /// With all encoders back after a fault the reference is validated, whatever is commanded: to be acknowledged, or not valid.
    fault_is_validated ["SRM-POS-006", "SRM-POS-007", "SRM-POS-008", "SRM-POS-015", "SRM-POS-032", "SRM-ACK-003"]:
        when |s| !encoder_fault(&s) && s.before.phase == Phase::EncoderFault
            => is_validated(&s);

    /// From then on it is validated in each call, until a command ends the fault.
    validation_goes_on ["SRM-POS-006", "SRM-POS-007", "SRM-POS-008", "SRM-POS-015", "SRM-POS-032", "SRM-ACK-003"]:
        when |s| validates(&s) && s.before.phase != Phase::EncoderFault
            => is_validated(&s);

    /// A reference that has not survived it has the bit that says why.
    lost_reference_has_its_bit ["SRM-POS-006", "SRM-POS-008", "SRM-POS-015", "SRM-ACK-003"]:
        when |s| s.before.was_ref && validates(&s) && !survives(&s)
            => s.outputs.diag & 0x1C00 & if s.config.pos_config {
                0x1000
            } else if s.before.si_failed {
                0x400
            } else {
                0x800
            } != 0;

    /// A reference that has survived is acknowledged: all is valid, from the offset of POS1 on; POSSI is moved where it had failed.
    survivor_is_acknowledged ["SRM-POS-009", "SRM-POS-016", "SRM-POS-018", "SRM-POS-028", "SRM-POSV-013"]:
        when |s| acknowledges(&s) && !encoder_fault(&s) && survives(&s) && !references(&s) && !syncs(&s)
            && (s.before.phase == Phase::Valid || s.before.phase == Phase::Invalid) && !s.after.overflowed
            => s.after.phase == Phase::Referenced && s.outputs.diag & 0x1E00 == 0
                && (!(s.config.pos_config || s.before.si_failed) || motor_within(&s, &s.after, 0));

    /// A fault of an encoder is over by an acknowledgement, SYNC or REFERENCE only.
    fault_wants_a_command ["SRM-POS-010", "SRM-POS-023", "SRM-ACK-001", "SRM-ACK-008", "SRM-P-11", "SRM-P-75"]:
        when |s| (s.before.phase.faulty() || s.before.phase == Phase::Discrepant || s.before.phase == Phase::Unsync)
            && s.after.phase.formed()
            => references(&s) || syncs(&s) || acknowledges(&s) && survives(&s);

    /// A command whose offset is no DInt is not executed: a calculation fault, no valid position.
    overflow_cancels ["SRM-POS-024", "SRM-POS-033", "SRM-LFMATH-003", "SRM-DIAG-003", "SRM-P-70"]:
        when |s| references(&s) && !encoder_fault(&s) && !apart(&s) && s.before.phase != Phase::EncoderFault
            && (i64::from(s.config.pos_reference) - i64::from(s.inputs.pos1)).abs() > i64::from(i32::MAX) + 1
            => s.after.phase == s.before.phase && s.after.off1 == s.before.off1 && s.after.off_si == s.before.off_si
                && s.outputs.diag & 0x2000 == 0x2000 && s.outputs.error
                && (s.config.err_react == ErrReact::Report
                    || !s.outputs.pos_valid && !s.outputs.referenced && !s.outputs.v_valid);

    /// While POS1 is valid SAFE_POS is POS1 with its offset; else it is held.
    position_is_that_of_pos1 ["SRM-POS-001"]:
        when |s| !s.after.overflowed
            => i64::from(s.outputs.safe_pos) == if s.inputs.pos1_valid {
                i64::from(s.inputs.pos1) + i64::from(s.after.off1)
            } else {
                i64::from(s.before.safe_pos)
            };

    /// A position that is formed and out of its range is not valid; the reference is untouched.
    range_acts_at_once ["SRM-POS-019", "SRM-POS-020", "SRM-POS-021", "SRM-P-76"]:
        when |s| s.after.phase.formed() && (s.outputs.safe_pos > s.config.pos_max || s.outputs.safe_pos < s.config.pos_min)
            => !s.outputs.pos_valid && s.outputs.error && s.outputs.diag & 0x18 != 0
                && (s.outputs.safe_pos <= s.config.pos_max || s.outputs.diag & 8 == 8)
                && (s.outputs.safe_pos >= s.config.pos_min || s.outputs.diag & 16 == 16);

    /// Range, velocity and drift are acknowledged when they are over.
    supervision_is_acknowledged ["SRM-POS-019", "SRM-POS-020", "SRM-POSV-006", "SRM-POSV-009", "SRM-P-11", "SRM-P-75"]:
        when |s| s.before.above && !s.after.above || s.before.below && !s.after.below
            || s.before.fast && !s.after.fast || s.before.drifted && !s.after.drifted
            => acknowledges(&s) && s.after.phase.formed() && (!s.before.above || s.after.above || s.outputs.safe_pos <= s.config.pos_max)
                && (!s.before.below || s.after.below || s.outputs.safe_pos >= s.config.pos_min)
                && (!s.before.fast || s.after.fast || s.outputs.safe_v <= s.config.v_max);

    /// An edge at ACK ends them then, while the position is formed.
    acknowledgement_is_heard ["SRM-ACK-002", "SRM-POS-019", "SRM-POS-020", "SRM-POSV-006"]:
        when |s| acknowledges(&s) && s.after.phase.formed()
            && s.outputs.safe_pos <= s.config.pos_max && s.outputs.safe_pos >= s.config.pos_min
            && s.outputs.safe_v <= s.config.v_max
            => !s.after.above && !s.after.below && !s.after.fast;

    /// A valid velocity is at most V_MAX, beside a drift within its window.
    valid_velocity_is_plausible ["SRM-POSV-006", "SRM-POSV-007", "SRM-POSV-015", "SRM-P-09", "SRM-P-76"]:
        when |s| s.outputs.v_valid
            => s.outputs.safe_v <= s.config.v_max
                && (!s.before.phase.formed() || drift(&s) <= um(i64::from(s.config.v_disc_window)));

    /// A drift beyond the window is a velocity fault; position and reference are untouched.
    drift_acts_at_once ["SRM-POSV-007", "SRM-POSV-009", "SRM-POSV-010", "SRM-P-12"]:
        when |s| s.before.phase.formed() && s.after.phase.formed()
            && drift(&s) > um(i64::from(s.config.v_disc_window))
            => !s.outputs.v_valid && s.outputs.error && s.outputs.diag & 0x40 == 0x40
                && s.outputs.pos_valid == (!s.after.above && !s.after.below && free(&s));

    /// The window begins anew after its length, and when a position is formed again.
    window_tumbles ["SRM-POSV-008", "SRM-POSV-014", "SRM-P-18"]:
        when |s| s.after.phase.formed()
            => if s.before.phase.formed() && s.before.window_calls + 1 < s.config.window() {
                s.after.window1 == s.before.window1 && s.after.window_si == s.before.window_si
                    && s.after.window_calls == s.before.window_calls + 1
            } else {
                s.after.window1 == s.inputs.pos1 && s.after.window_si == s.inputs.possi && s.after.window_calls == 0
            };

    /// SAFE_V is the way of POSSI in the time of the counter, rounded up.
    velocity_of_the_counter ["SRM-POSV-001", "SRM-POSV-002"]:
        when |s| s.before.seen_si && s.inputs.possi_valid && ticks(&s) > 0 && (1..=1_023).contains(&s.config.possi_t_sample)
            && !s.after.overflowed
            => rounded_up(
                s.outputs.safe_v,
                (i64::from(s.inputs.possi) - i64::from(s.before.sample)).abs(),
                ticks(&s),
                s.config.possi_t_sample,
            );

    /// Without a new sample it is held.
    velocity_is_held ["SRM-POSV-003", "SRM-POSV-015"]:
        when |s| !s.before.seen_si || !s.inputs.possi_valid || ticks(&s) == 0
            => s.outputs.safe_v == s.before.safe_v;

    /// A counter that has stood too long is a velocity fault (AMB-20 WATCH).
    standing_counter_is_found ["SRM-POSV-016", "SRM-P-19"]:
        when |s| s.config.count_watch == CountWatch::Watch && s.before.seen_si && s.inputs.possi_valid && ticks(&s) == 0
            && s.before.still >= s.config.standing() && s.after.phase.formed()
            => !s.outputs.v_valid && s.outputs.diag & 0x40 == 0x40;

    /// One that moves is none, and ends the count.
    moving_counter_counts_anew ["SRM-POSV-016"]:
        when |s| s.inputs.possi_valid && ticks(&s) != 0
            => s.after.still == 0;

    /// A velocity is valid only beside a formed position; invalid it is for a reason.
    velocity_is_valid_for_a_reason ["SRM-POSV-011", "SRM-POSV-013", "SRM-P-12"]:
        when |s| free(&s)
            => s.outputs.v_valid == (s.after.phase.formed() && !s.after.fast && !s.after.drifted)
                && s.outputs.pos_valid == (s.after.phase.formed() && !s.after.above && !s.after.below)
                && s.outputs.referenced == (s.after.phase == Phase::Referenced);

    /// Standstill and the directions exclude each other.
    one_motion_at_a_time ["SRM-POSV-004", "SRM-POSV-005", "SRM-P-10"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.standstill == (s.outputs.safe_v < s.config.v_standstill)
                && u8::from(s.outputs.standstill) + u8::from(s.outputs.moves_positive) + u8::from(s.outputs.moves_negative) <= 1;

    /// A direction is that of the last change of the position.
    direction_follows_the_position ["SRM-POSV-005"]:
        when |s| s.before.seen1 && s.inputs.pos1_valid
            => s.after.direction == match s.outputs.safe_pos.cmp(&s.before.safe_pos) {
                core::cmp::Ordering::Greater => Direction::Positive,
                core::cmp::Ordering::Less => Direction::Negative,
                core::cmp::Ordering::Equal => s.before.direction,
            };

    /// Which parameters are right; a wrong one is told as long as the block runs and takes every enable away (AMB-17 SAFE).
    parameters_are_right ["SRM-POSPARAM-013", "SRM-POSPARAM-014", "SRM-POSPARAM-015", "SRM-POSPARAM-016", "SRM-PARAM-003", "SRM-P-71"]:
        when |s| s.before.invariant(&s.config)
            => (s.outputs.diag & 1 == 0) == ((1..=1_023).contains(&s.config.possi_t_sample)
                    && s.config.v_sync_intervall > 0 && s.config.t_sample > 0 && s.config.t_sample <= 2 * s.config.possi_t_sample
                    && s.config.v_disc_window >= 0 && s.config.pos_disc_window >= 0 && s.config.pos_startup_tol >= 0)
                && (s.config.t_sample <= 0 || (s.outputs.diag & 2 == 0) == (remainder(s.config.v_sync_intervall, s.config.t_sample) == 0))
                && (s.outputs.diag & 4 == 0) == (s.config.v_max >= s.config.v_standstill && s.config.pos_max >= s.config.pos_min)
                && (s.outputs.diag & 7 == 0 || s.outputs.error && (s.config.err_react == ErrReact::Report
                    || !s.outputs.pos_valid && !s.outputs.referenced && !s.outputs.v_valid));

    /// Reports are what is latched; the other bits are 0.
    reports_are_exact ["SRM-ACK-003", "SRM-ACK-004", "SRM-DIAG-001", "SRM-POSDIAG-001", "SRM-POSDIAG-003"]:
        when |s| s.before.invariant(&s.config)
            => s.outputs.diag & !0x87 == u16::from(s.after.above) << 3 | u16::from(s.after.below) << 4
                    | u16::from(s.after.fast) << 5 | u16::from(s.after.drifted) << 6 | u16::from(s.after.apart) << 8
                    | u16::from(s.after.phase.faulty()) << 9 | u16::from(s.after.strayed) << 10
                    | u16::from(s.after.unconfirmed) << 11 | u16::from(s.after.unconfirmed2) << 12
                    | u16::from(s.after.overflowed) << 13
                && s.outputs.error == (s.outputs.diag & !0x80 != 0)
                && (!s.outputs.ack_req || s.after.phase == Phase::Valid || s.outputs.diag & 0x2078 != 0)
                && (s.after.phase != Phase::Valid || s.outputs.ack_req);

    /// The step keeps the invariant and remembers the commands.
    state_stays_consistent ["SRM-POS-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.ack_held == s.inputs.ack && s.after.sync_held == s.inputs.sync
                && s.after.reference_held == s.inputs.reference;
}
