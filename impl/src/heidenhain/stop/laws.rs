//! The contract of the stop reaction.

use super::started;
use super::{Config, Inputs, Outputs, State, transition};
use crate::heidenhain::types::{Phase, Stop};

/// An SS1 or SS1F brakes, or an SS1D that has waited.
const fn ramp(phase: Phase) -> bool {
    matches!(phase, Phase::EmergencyBrake | Phase::BrakeCloses)
}

monitor! { heidenhain::stop;
    /// A running stop becomes no lower one: it ends by the main switch, after torque off, or as an SS2 that has come to stand.
    stop_never_weakens ["HFS-P-01", "HFS-STOP-002", "HFS-STOP-003"]:
        when |s| s.before.level != Stop::None && s.after.level < s.before.level
            => s.inputs.main_switch || s.outputs.restarted
                || (s.before.level == Stop::Ss2 && s.outputs.ss2_ended && s.inputs.still);

    /// Every demand is met: the stop in force is at least what was asked for. An SS2 of a group that stands ends at once; one
    /// that is asked for in the cycle of a restart is met by the standstill state that the group takes then.
    every_demand_is_met ["HFS-ARCH-004/a", "HFS-TIMING-005/a", "HFS-TIMING-006/a", "HFS-TIMING-006/b", "HFS-STOP-001", "HFS-STOP-003", "HFS-P-02"]:
        when |s| s.inputs.demand != Stop::None && !s.inputs.main_switch
            => s.after.level >= s.inputs.demand
                || (s.inputs.demand == Stop::Ss2 && s.outputs.ss2_ended && s.inputs.still)
                || (s.inputs.demand == Stop::Ss2 && s.outputs.restarted);

    /// A stop rises only to what was asked for, to SS1 when an SS2 fails, and to SS0 when an SS1 fails.
    rises_only_for_a_reason ["HFS-STOP-003", "HFS-SS2-004", "HFS-SS1-005", "HFS-SS0-002"]:
        when |s| !s.inputs.main_switch && s.after.level > s.before.level.max(s.inputs.demand)
            => match s.after.level {
                Stop::Ss1 => s.before.timer.count() == 1
                    && (s.before.level == Stop::Ss2 || s.before.phase == Phase::Ss1DWait),
                Stop::Ss0 => ramp(s.before.phase) && s.before.timer.count() == 1,
                Stop::None | Stop::Ss2 | Stop::Ss1D | Stop::Ss1F => false,
            };

    /// After SS1F and SS0 nothing but the main switch gives torque again.
    hard_stop_needs_the_main_switch ["HFS-P-05", "HFS-SS0-005", "HFS-SS1F-003", "HFS-ACK-001"]:
        when |s| s.before.level >= Stop::Ss1F && !s.inputs.main_switch
            => s.after.level >= s.before.level && s.outputs.needs_switch && !s.outputs.restarted;

    /// The need of the main switch is shown from the demand on.
    needs_switch_is_shown ["HFS-P-05", "HFS-SS1F-003", "HFS-SS0-005"]:
        when |s| s.after.level != Stop::None || s.outputs.needs_switch
            => s.outputs.needs_switch == (s.after.level >= Stop::Ss1F);

    /// SS0 takes the torque and closes the brakes in the cycle of its demand.
    ss0_acts_at_once ["HFS-SS0-003/a", "HFS-STOP-008/a", "HFS-SS0-001", "HFS-SS0-003/b", "HFS-P-16"]:
        when |s| (s.inputs.demand == Stop::Ss0 && !s.inputs.main_switch) || s.after.level == Stop::Ss0
            => s.outputs.torque_off && s.outputs.brake_closed;

    /// A rise during the ramp keeps the ramp and its timers.
    rise_reloads_no_timer ["HFS-P-01", "HFS-STOP-010"]:
        when |s| ramp(s.before.phase) && !s.inputs.main_switch && ramp(s.after.phase)
            => s.after.timer == s.before.timer.tick()
                && (s.before.phase != Phase::BrakeCloses || s.after.phase == Phase::BrakeCloses);

    /// A ramp that begins has its whole time.
    ramp_starts_its_timer ["HFS-TIMING-005/c", "HFS-TIMING-006/e", "HFS-SS1-004", "HFS-STOP-010"]:
        when |s| (!ramp(s.before.phase) || s.inputs.main_switch) && ramp(s.after.phase)
            => s.after.phase == Phase::EmergencyBrake && s.after.timer == started(s.config.t_ss1());

    /// An SS1 ends: in each cycle its timer is lower or the torque is off, whatever the drives and the other channel do.
    ss1_ends_in_time ["HFS-P-02", "HFS-P-16", "HFS-P-47", "HFS-SS1-005", "HFS-SS1-007"]:
        when |s| ramp(s.before.phase) && !s.inputs.main_switch
            => s.outputs.torque_off || (ramp(s.after.phase) && s.after.timer < s.before.timer);

    /// The torque goes at the end of the ramp, or with SS0; when the time is up first, the stop has become SS0.
    late_ss1_becomes_ss0 ["HFS-SS1-005", "HFS-P-16"]:
        when |s| ramp(s.before.phase) && !s.inputs.main_switch && s.outputs.torque_off && s.inputs.demand != Stop::Ss0
            => s.after.level == Stop::Ss0 || if s.config.is_cc() {
                s.before.phase == Phase::BrakeCloses && s.before.brake.count() == 1
            } else {
                s.inputs.peer_off
            };

    /// Channel B takes the torque of an SS1 only after the brakes have been closing for their overlap.
    brake_closes_before_torque_off ["HFS-ARCH-004/d", "HFS-TIMING-006/c", "HFS-STOP-008/b", "HFS-TIMING-010", "HFS-TIMING-011", "HFS-P-17", "HFS-SS1-006", "HFS-SBC-001"]:
        when |s| s.config.is_cc() && s.before.phase == Phase::EmergencyBrake && !s.inputs.main_switch
            && s.inputs.demand != Stop::Ss0 && s.before.timer.count() > 1
            => if !s.inputs.still {
                s.after.phase == Phase::EmergencyBrake
            } else {
                s.after.phase == Phase::BrakeCloses && s.after.brake == started(s.config.t_brake())
                    && s.outputs.brake_closed && !s.outputs.torque_off
            };

    /// The overlap of the brake runs down by one in each cycle.
    overlap_runs ["HFS-TIMING-006/d", "HFS-P-17", "HFS-SS1-006"]:
        when |s| s.before.phase == Phase::BrakeCloses && !s.inputs.main_switch && s.after.phase == Phase::BrakeCloses
            => s.after.brake == s.before.brake.tick();

    /// Channel A keeps the torque until channel B has taken it, or until its own time is up.
    channel_a_waits_for_b ["HFS-TIMING-005/b", "HFS-TIMING-011", "HFS-SS1-007", "HFS-STOP-008/c"]:
        when |s| !s.config.is_cc() && s.before.phase == Phase::EmergencyBrake && !s.inputs.main_switch
            && s.inputs.demand != Stop::Ss0 && s.before.timer.count() > 1
            => s.outputs.torque_off == s.inputs.peer_off;

    /// An SS2 ends: in each cycle it stands, its timer is lower, or it has become an SS1.
    ss2_ends_in_time ["HFS-P-02", "HFS-P-15", "HFS-P-37", "HFS-SS2-004", "HFS-GRP-007"]:
        when |s| s.before.level == Stop::Ss2 && !s.inputs.main_switch
            => s.outputs.ss2_ended || s.after.level > Stop::Ss2 || s.after.timer < s.before.timer;

    /// A failed SS2 is an SS1 of the whole machine.
    failed_ss2_is_wide ["HFS-SS1-001", "HFS-SS2-004", "HFS-P-15"]:
        when |s| s.before.level == Stop::Ss2 && !s.inputs.main_switch && s.inputs.demand <= Stop::Ss2
            && s.after.level >= Stop::Ss1
            => s.after.wide && s.outputs.wide && s.before.timer.count() == 1;

    /// An SS2 that begins has its whole time from the request on, also while it waits.
    ss2_starts_its_timer ["HFS-SS2-003", "HFS-GRP-007"]:
        when |s| s.after.level == Stop::Ss2 && (s.before.level != Stop::Ss2 || s.inputs.main_switch)
            => s.after.timer == started(s.config.t_ss2());

    /// An SS2 leaves the drives and the control voltage on.
    ss2_keeps_the_torque ["HFS-STOP-008/e", "HFS-P-33", "HFS-SS2-001", "HFS-SS2-007"]:
        when |s| s.after.level == Stop::Ss2 || s.outputs.ss2_ended
            => !s.outputs.torque_off && !s.outputs.brake_closed && !s.outputs.needs_switch;

    /// An SS2 that brakes goes on braking along the contour while an SS1D waits, until the group stands; the wait adds no
    /// time to it.
    waiting_ss1d_keeps_the_contour ["HFS-P-49", "HFS-SS1D-004"]:
        when |s| s.after.phase == Phase::Ss1DWait && !s.inputs.still
            && (s.before.phase == Phase::Ss2Brake || (s.before.phase == Phase::Ss1DWait && !s.before.timer.is_zero()))
            => s.outputs.on_contour && s.after.timer == s.before.timer.tick();

    /// A group that waits and did not brake before is not braked, by an SS1D or by an SS2, until the listed groups stand.
    waiting_group_is_not_braked ["HFS-SS1D-001", "HFS-SS1D-002", "HFS-GRP-003"]:
        when |s| matches!(s.after.phase, Phase::Ss1DWait | Phase::Ss2Wait)
            && (matches!(s.before.phase, Phase::Run | Phase::Ss2Wait) || s.before.timer.is_zero())
            => !s.outputs.on_contour && !s.outputs.emergency_ramp && s.outputs.brake_listed;

    /// An SS1D brakes when the listed groups stand.
    ss1d_brakes_after_the_listed_groups ["HFS-SS1D-001", "HFS-SS1D-002", "HFS-GRP-003", "HFS-SS2-010"]:
        when |s| s.inputs.demand == Stop::Ss1D && s.before.level < Stop::Ss1D && s.inputs.listed_still
            && !s.inputs.main_switch
            => s.outputs.emergency_ramp;

    /// A stop that waits brakes the listed groups.
    waiting_brakes_the_listed_groups ["HFS-GRP-003", "HFS-SS1D-001"]:
        when |s| s.after.level != Stop::None
            => s.outputs.brake_listed == matches!(s.after.phase, Phase::Ss2Wait | Phase::Ss1DWait);

    /// An SS1 cause ends every wait at once.
    ss1_ends_every_wait ["HFS-GRP-007", "HFS-STOP-011"]:
        when |s| s.inputs.demand >= Stop::Ss1 && !s.inputs.main_switch
            => ramp(s.after.phase) || s.outputs.torque_off;

    /// Torque comes back only by the main switch, by the operator's edge after an ended SS1 while no such cause is there, or
    /// after an SS1D that has ended in both channels.
    restart_needs_the_operator ["HFS-P-06", "HFS-SS1-010", "HFS-SS1-011", "HFS-ACK-005", "HFS-ACK-006"]:
        when |s| s.before.phase == Phase::TorqueOff && s.after.phase != Phase::TorqueOff
            => s.inputs.main_switch || (s.outputs.restarted && s.before.level < Stop::Ss1F && s.inputs.demand < Stop::Ss1D
                && (s.inputs.restart || (s.before.level == Stop::Ss1D && s.inputs.peer_off)));

    /// The operator's edge after an ended SS1 is answered.
    restart_is_answered ["HFS-SS1-010", "HFS-ACK-005", "HFS-P-46"]:
        when |s| s.inputs.restart && s.before.phase == Phase::TorqueOff && s.before.level < Stop::Ss1F
            && s.inputs.demand == Stop::None && !s.inputs.main_switch
            => s.outputs.restarted && s.after.level == Stop::None;

    /// A machine-wide cause makes a braking SS1 machine-wide, also where it runs already; this lasts until torque off.
    wide_cause_is_kept ["HFS-SS1-001"]:
        when |s| ((s.inputs.wide_cause && s.inputs.demand == Stop::Ss1) || s.before.wide) && ramp(s.after.phase)
            => s.outputs.wide;

    /// An SS1 that the safe PLC asks for a group concerns no other group.
    requested_ss1_is_not_wide ["HFS-SS1-001", "HFS-P-36"]:
        when |s| s.outputs.wide
            => s.before.wide || (s.inputs.wide_cause && s.inputs.demand == Stop::Ss1) || s.before.timer.count() == 1;

    /// SS1 and SS1F alike begin on the emergency ramp, in the cycle of their cause, whatever was running below them.
    ss1_brakes_on_the_emergency_ramp ["HFS-STOP-008/d", "HFS-SS1-002", "HFS-SS1F-001"]:
        when |s| matches!(s.inputs.demand, Stop::Ss1 | Stop::Ss1F) && !s.inputs.main_switch
            && !ramp(s.before.phase) && s.before.phase != Phase::TorqueOff
            => s.outputs.emergency_ramp && s.after.level == s.inputs.demand;

    /// The torque of an SS1D that is off needs no drive-on; that of every higher stop does.
    soft_end_is_that_of_ss1d ["HFS-SS1D-003", "HFS-STO-006"]:
        when |s| s.outputs.torque_off
            => s.outputs.keeps_enable == (s.after.level == Stop::Ss1D);

    /// The main switch ends everything.
    main_switch_acknowledges ["HFS-ACK-001", "HFS-P-05"]:
        when |s| s.inputs.main_switch
            => s.after == State::INITIAL && s.outputs == Outputs::default();

    /// Without a stop nothing acts.
    no_stop_no_action ["HFS-STOP-002"]:
        when |s| s.after.level == Stop::None
            => !(s.outputs.torque_off || s.outputs.brake_closed || s.outputs.on_contour || s.outputs.emergency_ramp
                || s.outputs.brake_listed || s.outputs.keeps_enable);

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-STOP-003"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.level == s.after.level && s.outputs.phase == s.after.phase
                && s.outputs.wide == s.after.wide
                && s.outputs.torque_off == matches!(s.after.phase, Phase::TorqueOff)
                && s.outputs.emergency_ramp == matches!(s.after.phase, Phase::EmergencyBrake);
}
