//! The contract of the channel: what holds because the monitors are wired as they are.
//!
//! What one monitor guarantees on its own is part of its own contract and not repeated, except where a law of the manual
//! runs through several monitors. All are facts of one step from any consistent state; with the timers' own contracts they
//! add up to the bounds of the manual: a violation is latched in the cycle it is seen, braking gets shorter in every cycle,
//! the end of braking is watched from the next cycle on.

use super::{Config, Inputs, Outputs, State, transition};
use crate::sinumerik::fault::FaultState;
use crate::sinumerik::level::{ExternalStop, InternalStop, Level};
use crate::sinumerik::selection::{Mode, Monitored};
use crate::sinumerik::stop::Phase;

/// STOP C, D or E was effective after the cycle before.
const fn cde_before(step: &Step) -> bool {
    !step.inputs.power_on && step.before.stop.level.ends_in_standstill()
}

/// An internal STOP B or A was latched after the cycle before.
const fn ab_before(step: &Step) -> bool {
    !step.inputs.power_on && matches!(step.before.stop.internal, InternalStop::A | InternalStop::B)
}

/// A discrepancy is seen in this cycle, here or in the other channel.
const fn discrepancy(step: &Step) -> bool {
    step.inputs.discrepancy
        || step.outputs.test.refused
        || (step.inputs.rx_fault && !step.inputs.power_on)
}

monitor! { sinumerik::channel;
    /// What any monitor requires is latched in the same cycle, also in a cycle of RESET or power-on.
    every_violation_is_latched_at_once ["S840D-P-20", "S840D-P-47", "S840D-P-49", "S840D-P-52", "S840D-STOP-001",
        "S840D-ACK-002", "S840D-STOP-002/a", "S840D-STOP-002/b", "S840D-STOP-002/c", "S840D-STOP-002/e", "S840D-STOP-025", "S840D-STOP-033", "S840D-STOP-066"]:
        when |s| s.outputs.demand != InternalStop::None
            => s.after.stop.internal >= s.outputs.demand && s.after.stop.level >= s.outputs.demand.level();

    /// Outside the window of the operating stop, selected or forced: STOP B or A in the same cycle.
    standstill_violation_stops ["S840D-STOP-013/f", "S840D-P-04", "S840D-SBH-005", "S840D-STOP-081", "S840D-STOP-002/a", "S840D-ARCH-510"]:
        when |s| s.outputs.selection.monitored == Monitored::Standstill
            && s.outputs.motion.position.distance(s.outputs.selection.reference).0 > s.config.standstill.tolerance().0
            => s.after.stop.internal >= InternalStop::B && s.outputs.stop.sga_stop_ab;

    /// The operating stop begins in the cycle in which the braking of a STOP C, D or E ends, with a time of 0 in that of the
    /// stop itself.
    standstill_begins_with_the_end_of_braking ["S840D-STOP-031", "S840D-STOP-080", "S840D-SBH-007"]:
        when |s| s.after.stop.phase == Phase::SbhInt && s.config.selection.enabled()
            => s.outputs.sbh_active && s.outputs.sbh_sg_active
                && (s.before.stop.phase != Phase::SbhInt || s.inputs.power_on
                    || s.outputs.selection.monitored == Monitored::Standstill);

    /// What is compared from the next cycle on is the position of that one.
    window_lies_where_the_braking_ended ["S840D-STOP-031", "S840D-STOP-080", "S840D-SBH-001", "S840D-STOP-081"]:
        when |s| !s.inputs.power_on && s.before.stop.phase == Phase::SbhInt && !s.inputs.set_anew
            && s.before.selection.mode != Mode::SbhForced && s.config.selection.enabled()
            => s.outputs.selection.monitored == Monitored::Standstill
                && s.outputs.selection.reference == s.before.motion.last;

    /// A position set anew by referencing is neither a speed nor a way out of the window.
    setting_anew_violates_nothing ["S840D-REF-002", "S840D-REF-003", "S840D-GEAR-506"]:
        when |s| s.inputs.set_anew && !s.inputs.parking
            => !s.outputs.standstill.violated && s.outputs.motion.speed <= s.before.motion.speed;

    /// `$VA_STOPSI` shows STOP F where no stop is effective, and the test of the external shutdown before it.
    stopsi_shows_test_and_fault ["S840D-STOP-053/b", "S840D-STOP-053/c"]:
        when |s| s.outputs.stop.level == Level::None && (s.inputs.external_test || s.after.fault.fault != FaultState::None)
            => s.outputs.stop.stopsi == if s.inputs.external_test { 11 } else { 5 };

    /// Faster than the limit in force: the stop of the stage in the same cycle.
    speed_violation_stops ["S840D-STOP-013/b", "S840D-P-47", "S840D-P-49", "S840D-SG-006", "S840D-STOP-002/b", "S840D-STOP-025",
        "S840D-STOP-033", "S840D-SG-007"]:
        when |s| s.outputs.selection.monitored == Monitored::Speed && s.outputs.motion.speed > s.outputs.selection.limit
            => s.after.stop.internal >= s.config.speed.stop(s.outputs.selection.sga_sg);

    /// Faster than the braking ramp: pulses off in the same cycle.
    ramp_violation_cancels_pulses ["S840D-STOP-013/a", "S840D-P-01", "S840D-P-11", "S840D-SBR-003", "S840D-STOP-002/e", "S840D-ARCH-513",
        "S840D-SBR-005", "S840D-SBR-006"]:
        when |s| !s.inputs.power_on && s.before.stop.sbr_on()
            && s.outputs.motion.speed > s.before.ramp.limit(&s.config.ramp)
            => s.after.stop.internal == InternalStop::A && s.outputs.stop.level == Level::A && !s.outputs.pulses.enable;

    /// Without agreement the limit switches raise nothing.
    limit_switches_need_the_agreement ["S840D-P-12", "S840D-SE-003"]:
        when |s| !s.inputs.se_active
            => s.outputs.limit_switch.demand == InternalStop::None && !s.outputs.limit_switch.upper
                && !s.outputs.limit_switch.lower;

    /// The effective level is the highest of the latch, the signals of both channels and the test.
    level_is_the_highest_request ["S840D-P-38", "S840D-STOP-003"]:
        when |s| !s.inputs.power_on
            => s.outputs.stop.level == s.after.stop.internal.level().max(s.outputs.external.request.level())
                .max(s.inputs.rx_external.level())
                .max(if s.outputs.test.active { Level::Test } else { Level::None });

    /// STOP A and the test cancel the pulses in the same cycle, and so does an incomplete run-up.
    pulses_follow_the_stop ["S840D-P-01", "S840D-P-54", "S840D-STOP-010", "S840D-TEST-010", "S840D-ARCH-505",
        "S840D-PULSE-003"]:
        when |s| matches!(s.outputs.stop.level, Level::A | Level::Test) || !s.inputs.run_up
            => !s.outputs.pulses.enable;

    /// Nothing else cancels them.
    pulses_are_not_cancelled_otherwise ["S840D-P-38", "S840D-PULSE-006/b"]:
        when |s| !matches!(s.outputs.stop.level, Level::A | Level::Test) && s.inputs.run_up
            => s.outputs.pulses.enable;

    /// A latched STOP B or A stays until power-on, whatever RESET and the signals do.
    b_and_a_stay_latched ["S840D-P-03", "S840D-ACK-003"]:
        when |s| ab_before(&s)
            => s.after.stop.internal >= s.before.stop.internal;

    /// Under a latched STOP B or A no test runs and no fault is raised.
    b_and_a_suppress_tests_and_faults ["S840D-TEST-025", "S840D-TEST-030", "S840D-ALARM-708"]:
        when |s| ab_before(&s)
            => !s.outputs.test.active && !s.outputs.test.refused && !s.outputs.fault.alarm;

    /// STOP A requested by signal, also before the safe logic is compared, acts in the same cycle.
    external_stop_a_acts_at_once ["S840D-P-18", "S840D-P-19", "S840D-EXT-002", "S840D-EXT-009", "S840D-STOP-006"]:
        when |s| s.outputs.external.request == ExternalStop::A
            => s.outputs.stop.level == Level::A && !s.outputs.pulses.enable;

    /// A discrepancy with an active function and no stop before: the delay to STOP B starts, or STOP B comes at once.
    discrepancy_leads_to_stop_b ["S840D-P-21", "S840D-STOP-061", "S840D-STOP-063", "S840D-KDV-514"]:
        when |s| s.before.fault.fault == FaultState::None && discrepancy(&s) && s.outputs.monitoring
            && !cde_before(&s) && !ab_before(&s)
            => s.outputs.fault.alarm
                && (s.after.fault.fault == FaultState::Delay || s.after.stop.internal >= InternalStop::B);

    /// The delay ends in STOP B, whatever RESET, de-selection or other stops do.
    delay_ends_in_stop_b ["S840D-P-21", "S840D-P-24", "S840D-STOP-099"]:
        when |s| !s.inputs.power_on && matches!(s.before.fault.fault, FaultState::Delay | FaultState::Expired)
            => s.after.stop.internal >= InternalStop::B
                || (s.after.fault.fault == FaultState::Delay && s.after.fault.timer < s.before.fault.timer);

    /// What counts as an active function: the operating stop, a speed stage, limit switches and cams that are enabled. The
    /// speed threshold alone does not.
    threshold_is_no_active_function ["S840D-STOP-069", "S840D-STOP-089"]:
        when |s| s.outputs.threshold.below || s.outputs.monitoring
            => s.outputs.monitoring
                == (s.config.se_sn_enabled || s.outputs.selection.monitored != Monitored::Nothing);

    /// Under a STOP C, D or E a discrepancy requires no stop.
    discrepancy_under_a_stop_is_latched ["S840D-P-22", "S840D-P-23", "S840D-STOP-062", "S840D-KDV-514"]:
        when |s| cde_before(&s) && s.before.fault.fault == FaultState::None && discrepancy(&s) && !ab_before(&s)
            => s.after.fault.fault == FaultState::Latched && !s.outputs.fault.stop_b;

    /// A test refused because the pulses are off already raises STOP F.
    refused_test_raises_stop_f ["S840D-P-28", "S840D-TEST-008"]:
        when |s| s.outputs.test.refused && s.before.fault.fault == FaultState::None
            => s.outputs.fault.alarm && s.after.fault.fault != FaultState::None;

    /// A failed test ends in STOP A in the same cycle.
    failed_test_stops ["S840D-STOP-013/d", "S840D-P-29", "S840D-P-35", "S840D-TEST-012", "S840D-STOP-002/g"]:
        when |s| s.outputs.test.demand == InternalStop::A
            => s.after.stop.internal == InternalStop::A && !s.outputs.pulses.enable;

    /// Braking of STOP C, D or E gets shorter each cycle, or ends in the operating stop or a higher stop.
    braking_ends ["S840D-P-06", "S840D-P-47", "S840D-SE-008"]:
        when |s| !s.inputs.power_on && s.before.stop.phase == Phase::Braking && s.after.stop.level.ends_in_standstill()
            => s.after.stop.phase == Phase::SbhInt || s.after.stop.timer < s.before.stop.timer;

    /// STOP B gets shorter each cycle, or is STOP A.
    stop_b_ends ["S840D-P-05", "S840D-P-47"]:
        when |s| !s.inputs.power_on && s.before.stop.phase == Phase::BBraking
            => s.after.stop.level == Level::A || s.after.stop.timer < s.before.stop.timer;

    /// After the end of braking the standstill is monitored from the next cycle on, whatever the signals select.
    ended_stop_is_watched ["S840D-P-07", "S840D-P-46", "S840D-P-47", "S840D-STOP-080", "S840D-SE-008"]:
        when |s| !s.inputs.power_on && s.before.stop.phase == Phase::SbhInt && s.config.selection.enabled()
            => s.outputs.selection.mode == Mode::SbhForced && s.outputs.selection.monitored == Monitored::Standstill
                && (s.before.selection.mode != Mode::SbhForced || s.inputs.set_anew
                    || s.after.selection.reference == s.before.selection.reference);

    /// While the braking ramp is on its limit never rises.
    ramp_never_rises ["S840D-P-10", "S840D-SBR-002"]:
        when |s| !s.inputs.power_on && s.before.stop.sbr_on()
            => s.outputs.ramp.limit <= s.before.ramp.limit(&s.config.ramp);

    /// With a latched stop or a fault a restart is prevented, and without both it is not.
    restart_needs_acknowledgement ["S840D-P-22", "S840D-P-42", "S840D-P-43", "S840D-STOP-083"]:
        when |s| s.after.stop.internal != InternalStop::None || s.after.fault.fault != FaultState::None
            || s.outputs.start_inhibit
            => s.outputs.start_inhibit
                && (s.after.stop.internal != InternalStop::None || s.after.fault.fault != FaultState::None);

    /// A signal alone ends no internal stop: without RESET and power-on the latch never falls.
    no_signal_acknowledges ["S840D-P-02", "S840D-P-42", "S840D-STOP-005"]:
        when |s| !s.inputs.power_on && !s.inputs.reset && s.before.stop.internal != InternalStop::None
            => s.after.stop.internal >= s.before.stop.internal;

    /// Power-on leaves only what the monitors require in the same cycle.
    power_on_acknowledges ["S840D-ACK-001", "S840D-STOP-012"]:
        when |s| s.inputs.power_on && s.outputs.demand == InternalStop::None && !discrepancy(&s)
            => s.after.stop.internal == InternalStop::None && s.after.fault.fault == FaultState::None
                && !s.outputs.start_inhibit;

    /// A parked axis does not move.
    parked_axis_does_not_move ["S840D-REF-016"]:
        when |s| s.inputs.parking && !s.inputs.power_on
            => s.outputs.motion.speed.0 == 0 && s.outputs.motion.position == s.before.motion.last;

    /// The step keeps the invariants of all monitors.
    state_stays_consistent ["S840D-ARCH-501"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}
