//! The contract of an axis in one channel: what holds between the channel, the user's side of the axis, and the other
//! channel.
//!
//! An arbitrary state of a whole axis is too wide to be drawn or enumerated, so no harness of the proof inventory has these
//! clauses. Two things check them, with every contract inside: the test `tests/axis/laws.rs` on random runs of both channels,
//! in which each premise must be met; and, as debug assertions, every reachable pair of states of the parts in which both channels
//! are compared with their tables (exhaustive, small parameters).

use super::{Config, Inputs, Outputs, State, TestResult, transition};
use crate::sinumerik::alarm::{Alarm, Reaction};
use crate::sinumerik::fault::FaultState;
use crate::sinumerik::level::{ExternalStop, InternalStop};
use crate::sinumerik::reference::AxisState;
use crate::sinumerik::stop::Phase;

contract! {
    /// Told are the stops of this channel, never one that it was told: its own latch, its own signals.
    own_stops_are_told ["S840D-STOP-007", "S840D-STOP-090", "S840D-P-17", "S840D-ARCH-501"]:
        when |s| s.after.channel.stop.internal != InternalStop::None
            || s.outputs.channel.external.request != ExternalStop::None
            || s.outputs.exchange.internal != InternalStop::None || s.outputs.exchange.external != ExternalStop::None
            => s.outputs.exchange.internal == s.after.channel.stop.internal
                && s.outputs.exchange.external == s.outputs.channel.external.request;

    /// An internal stop of the other channel is latched here in the cycle it is read.
    told_stop_is_latched ["S840D-P-16", "S840D-STOP-007", "S840D-STOP-090"]:
        when |s| s.inputs.other.internal != InternalStop::None && !s.inputs.local.power_on && !s.outputs.reset_taken
            => s.after.channel.stop.internal >= s.inputs.other.internal;

    /// A stop by signal of the other channel acts here in the cycle it is read.
    told_request_acts ["S840D-P-16", "S840D-STOP-007"]:
        when |s| s.inputs.other.external != ExternalStop::None && !s.inputs.local.power_on
            => s.outputs.channel.stop.level >= s.inputs.other.external.level();

    /// A fault of the other channel is a fault here too, unless STOP A or B is latched; without own finding its code is 0.
    told_fault_is_raised ["S840D-P-51", "S840D-STOP-093", "S840D-STOP-068"]:
        when |s| s.inputs.other.fault && !s.inputs.local.power_on && s.before.channel.fault.fault == FaultState::None
            && s.before.channel.stop.internal < InternalStop::B
            => s.after.channel.fault.fault != FaultState::None && s.outputs.alarms.contains(Alarm::CrossComparison)
                && (!s.outputs.code.is_none() || s.outputs.alarms.code().is_none());

    /// A difference found by the comparison is a fault, named by its code, unless STOP A or B is latched.
    difference_is_a_fault ["S840D-P-26", "S840D-STOP-060", "S840D-STOP-068"]:
        when |s| s.outputs.compare.discrepancy && s.before.channel.fault.fault == FaultState::None
            && (s.inputs.local.power_on || s.before.channel.stop.internal < InternalStop::B)
            => s.after.channel.fault.fault != FaultState::None && s.outputs.alarms.code() == s.outputs.compare.code;

    /// RESET is taken only while neither channel brakes, and both have latched the same stop, and both or none a fault.
    reset_is_joint ["S840D-P-45", "S840D-ACK-001", "S840D-ACK-004"]:
        when |s| s.outputs.reset_taken && !s.inputs.local.power_on
            => s.inputs.local.reset && s.before.channel.stop.phase != Phase::Braking && !s.inputs.other.braking
                && s.before.channel.stop.internal == s.inputs.other.internal
                && (s.before.channel.fault.fault != FaultState::None) == s.inputs.other.fault;

    /// Where both channels have come to rest with the same stop, RESET is taken.
    reset_is_not_lost ["S840D-P-34", "S840D-P-44"]:
        when |s| s.inputs.local.reset && s.before.channel.stop.phase != Phase::Braking && !s.inputs.other.braking
            && s.before.channel.stop.internal == s.inputs.other.internal
            && (s.before.channel.fault.fault != FaultState::None) == s.inputs.other.fault
            => s.outputs.reset_taken;

    /// "Axis safely referenced" needs the agreements of both channels, and the comparison with the history over in both.
    safely_referenced_needs_both ["S840D-P-13", "S840D-P-14", "S840D-REF-004", "S840D-REF-005", "S840D-REF-015"]:
        when |s| s.outputs.sga.safely_referenced
            => s.after.agreement.agreed && s.inputs.other.confirmed && !s.after.reference.fresh
                && s.after.reference.axis == AxisState::SafeRef;

    /// The agreement is told as confirmed only where it is given and its position referenced and compared in this channel.
    confirmed_is_compared ["S840D-REF-004", "S840D-REF-015"]:
        when |s| s.outputs.exchange.confirmed
            => s.after.agreement.agreed && !s.after.reference.fresh
                && matches!(s.after.reference.axis, AxisState::Ref | AxisState::SafeRef);

    /// Referencing sets the position anew and moves nothing: neither the window of the operating stop nor the speed sees it.
    referencing_is_no_motion ["S840D-REF-002", "S840D-REF-003", "S840D-GEAR-506"]:
        when |s| s.before.reference.axis == AxisState::NotRef && s.after.reference.axis == AxisState::Ref
            => !s.outputs.channel.standstill.violated
                && s.outputs.channel.motion.speed <= s.before.channel.motion.speed;

    /// While the external shutdown is tested the NCK presents no external stop for the comparison, so that one at the drive
    /// is a difference: code 58 once t_chg has passed.
    stop_under_the_shutdown_test_is_a_difference ["S840D-TEST-019/a", "S840D-KDV-512"]:
        when |s| s.after.shutdown_test.selected || s.after.shutdown_test.active()
            => s.after.told.external == ExternalStop::None && s.outputs.exchange.snapshot.external == ExternalStop::None;

    /// The test of the external shutdown takes nothing from the stop itself: it is told and acts.
    stop_acts_under_the_shutdown_test ["S840D-TEST-016"]:
        when |s| s.outputs.shutdown_test.active && s.outputs.channel.external.request != ExternalStop::None
            => s.outputs.exchange.external == s.outputs.channel.external.request
                && s.outputs.channel.stop.level >= s.outputs.channel.external.request.level();

    /// A change of a signal that selects a stop starts t_chg, and so does the selection of the shutdown test.
    change_of_a_stop_signal_starts_the_tolerance_time ["S840D-EXT-006", "S840D-KDV-506", "S840D-TEST-019/b"]:
        when |s| !s.inputs.local.power_on
            && (s.inputs.local.sge.stop_a_off != s.before.sge.stop_a_off
                || s.inputs.local.sge.stop_c_off != s.before.sge.stop_c_off
                || s.inputs.local.sge.stop_d_off != s.before.sge.stop_d_off
                || s.inputs.local.sge.stop_e_off != s.before.sge.stop_e_off
                || (s.after.shutdown_test.selected != s.before.shutdown_test.selected
                    && !s.before.shutdown_test.active()))
            => s.after.compare.change_timer == s.config.monitors().compare.t_chg()
                && s.outputs.exchange.changing != s.config.monitors().compare.t_chg().is_zero();

    /// The cams are shown without agreement too, but then the axis is not safely referenced and the message tells it: to use
    /// them the agreement is needed.
    cams_without_agreement_are_not_safe ["S840D-UA-002/a", "S840D-SN-003", "S840D-REF-013"]:
        when |s| !s.after.agreement.agreed && s.config.monitors().channel.se_sn_enabled
            => !s.outputs.sga.safely_referenced && s.outputs.reference.message;

    /// A new gear stage withdraws the agreement and the safe reference in the same cycle.
    gear_change_withdraws ["S840D-P-37", "S840D-GEAR-505"]:
        when |s| s.outputs.gear.changed
            => !s.outputs.agreement.agreed && !s.outputs.exchange.agreed && !s.outputs.sga.safely_referenced;

    /// A parked axis is not referenced; its agreement is kept.
    parking_takes_the_reference ["S840D-REF-016"]:
        when |s| s.inputs.local.parking && !s.inputs.local.power_on
            => !s.outputs.sga.safely_referenced
                && matches!(s.after.reference.axis, AxisState::Off | AxisState::NotRef);

    /// The agreement is given only by the user with the key on a referenced axis.
    agreement_is_given_by_the_user ["S840D-P-48", "S840D-UA-005"]:
        when |s| !s.before.agreement.agreed && s.after.agreement.agreed
            => s.inputs.local.set_agreement && s.inputs.local.key && s.before.reference.axis == AxisState::Ref;

    /// Agreement and stored position are kept through power-on.
    non_volatile_is_kept ["S840D-UA-007", "S840D-PWR-001"]:
        when |s| s.inputs.local.power_on
            => s.after.history == s.before.history
                && (s.after.agreement.agreed == s.before.agreement.agreed || s.outputs.agreement.withdrawn);

    /// With cam synchronisation no channel shows a cam that the other one has not passed.
    synchronised_cams_agree ["S840D-P-32", "S840D-SN-007"]:
        when |s| s.config.monitors().words().function_enable & 0x80 != 0
            => (!s.outputs.sga.sn_1_plus || s.inputs.other.cams[0]) && (!s.outputs.sga.sn_4_minus || s.inputs.other.cams[7]);

    /// A test of the other channel changes nothing here but what counts for the interval.
    test_concerns_one_channel ["S840D-P-17", "S840D-STOP-007", "S840D-TEST-014"]:
        when |s| s.inputs.other.test != TestResult::None && !s.outputs.channel.test.active
            => s.outputs.channel.stop.level != crate::sinumerik::level::Level::Test;

    /// The external shutdown test acts in the NCK only.
    external_test_is_of_the_nck ["S840D-TEST-016"]:
        when |s| s.config.side() == super::Side::Drive
            => !s.outputs.shutdown_test.active && !s.outputs.alarms.contains(Alarm::ExternalTest);

    /// Every stop raised here or told has its alarm in the cycle it is latched.
    raised_stop_has_its_alarm ["S840D-ALARM-501", "S840D-STOP-001", "S840D-STOP-032", "S840D-STOP-041", "S840D-STOP-052"]:
        when |s| s.after.channel.stop.internal > s.before.channel.stop.internal
            => Alarm::of_stop(s.after.channel.stop.internal).is_some_and(|alarm| s.outputs.alarms.contains(alarm));

    /// A STOP A that is latched raises the alarm by which the control stops the whole mode group; a STOP A by signals raises
    /// none.
    stop_a_stops_the_mode_group ["S840D-STOP-011", "S840D-ALARM-730"]:
        when |s| s.after.channel.stop.internal == InternalStop::A
            && s.before.channel.stop.internal != InternalStop::A
            => s.outputs.alarms.contains(Alarm::StopA)
                && Alarm::StopA.nck().reactions.contains(&Reaction::ModeGroupNotReady);

    /// The step keeps the invariants of all monitors.
    state_stays_consistent ["S840D-ARCH-501"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config);
}
