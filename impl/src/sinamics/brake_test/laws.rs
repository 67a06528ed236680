//! The contract of the brake test.

use super::{Brake, Config, Inputs, Kind, Outputs, Phase, State, transition};
use crate::kernel::{Cycles, Position};

/// The conditions of a test are met: pulses, a slow axis, no stop.
fn fit(inputs: &Inputs) -> bool {
    inputs.pulses && inputs.slow && !inputs.stop
}

/// The test goes on: selected, and its conditions are met; no running sequence is interrupted.
fn goes_on(s: &Step) -> bool {
    s.inputs.select && fit(&s.inputs) && (s.inputs.start || !s.before.phase.runs())
}

/// The brake that is tested.
fn tested(s: &Step) -> &Brake {
    s.config.brake(s.before.choice.second_brake)
}

/// The axis has moved further than the running sequence tolerates.
fn moved(s: &Step) -> bool {
    let brake = tested(s);
    let sequence = if s.before.choice.second_sequence {
        brake.second
    } else {
        brake.first
    };
    s.inputs.position.distance(s.before.begin) > sequence.tolerance
}

monitor! { sinamics::brake_test;
    /// An edge of the selection begins the test where pulses, speed and stops permit it.
    selection_begins ["S120-SBT-006", "S120-SBT-007"]:
        when |s| s.before.phase == Phase::Idle && s.inputs.select && !s.before.select_held && fit(&s.inputs)
            => s.outputs.selected && s.outputs.own_setpoint && !s.outputs.runs && !s.outputs.refused;

    /// Elsewhere it is refused, and a level selects nothing.
    selection_is_refused ["S120-SBT-001", "S120-SBT-006", "S120-SBT-017"]:
        when |s| s.before.phase == Phase::Idle && s.inputs.select && (s.before.select_held || !fit(&s.inputs))
            => !s.outputs.selected && s.outputs.refused != s.before.select_held;

    /// A sequence begins with an edge of the start once the load is known, never before.
    start_wants_the_load ["S120-SBT-006", "S120-SBT-007", "S120-PF-39"]:
        when |s| s.outputs.runs && !s.before.phase.runs()
            => !s.outputs.ready && s.before.phase == Phase::Ready && s.inputs.start && !s.before.start_held;

    /// Ready is reached with a known load and open external brakes.
    load_is_measured_with_open_brakes ["S120-SBT-007"]:
        when |s| s.before.phase == Phase::Measure && s.after.phase == Phase::Ready
            => s.outputs.ready && s.inputs.load_known && !(s.config.has_external() && s.inputs.external_closed);

    /// That start closes the chosen brake.
    start_closes_the_brake ["S120-SBT-004", "S120-SBT-006", "S120-SBT-010"]:
        when |s| s.before.phase == Phase::Ready && s.inputs.start && !s.before.start_held && goes_on(&s)
            && s.config.brake(s.inputs.choice.second_brake).kind != Kind::None
            => s.outputs.runs && s.after.choice == s.inputs.choice && !s.outputs.torque
                && s.outputs.close_external != s.outputs.close_motor;

    /// What is chosen while a sequence runs counts for nothing.
    choice_is_frozen ["S120-SBT-009", "S120-SBT-500"]:
        when |s| s.before.phase.runs()
            => s.after.choice == s.before.choice;

    /// The brake that is not tested stays open, and each one that is not asked for.
    other_brake_stays_open ["S120-SBT-009", "S120-PF-39"]:
        when |s| s.outputs.close_external || s.outputs.close_motor
            => {
                let kind = s.config.brake(s.after.choice.second_brake).kind;
                s.after.phase.closed() && s.outputs.close_external == (kind == Kind::External)
                    && s.outputs.close_motor == (kind == Kind::Motor)
            };

    /// No torque against a brake that is not closed: an external one has reported so, that of the motor had its time.
    torque_wants_a_closed_brake ["S120-SBT-008", "S120-SBT-009", "S120-SBT-010"]:
        when |s| s.outputs.torque && !s.before.phase.torque()
            => s.before.phase == Phase::Close
                && if tested(&s).kind == Kind::External {
                    s.inputs.external_closed
                } else {
                    s.before.left == Cycles::new(1)
                };

    /// An external brake that does not follow in time ends the test with a fault.
    late_brake_is_a_fault ["S120-SBT-008"]:
        when |s| goes_on(&s) && s.before.left <= Cycles::new(1)
            && (s.before.phase == Phase::Measure && s.config.has_external() && s.inputs.external_closed
                || tested(&s).kind == Kind::External
                    && (s.before.phase == Phase::Close && !s.inputs.external_closed
                        || s.before.phase == Phase::Open && s.inputs.external_closed))
            => s.outputs.late && s.after.phase == Phase::Ended && !s.outputs.close_external;

    /// The test is ended so by nothing else.
    nothing_else_is_late ["S120-SBT-008"]:
        when |s| s.outputs.late
            => s.config.has_external() && s.before.left <= Cycles::new(1);

    /// The position counts from the beginning of the torque; more than the tolerance fails the brake at once.
    moving_axis_fails ["S120-SBT-010"]:
        when |s| goes_on(&s) && s.before.phase.torque() && moved(&s)
            => s.after.phase == Phase::Open && !s.after.good && !s.outputs.torque;

    /// The torque is built up, held and taken back, each for its time.
    torque_has_its_times ["S120-SBT-003", "S120-SBT-010"]:
        when |s| goes_on(&s) && s.before.phase.torque() && !moved(&s)
            => if s.before.left > Cycles::new(1) {
                s.after.phase == s.before.phase && s.after.left == s.before.left.tick()
            } else {
                s.after.phase > s.before.phase && s.after.good
            };

    /// A sequence is successful exactly if its torque had all its time and the axis stayed.
    success_is_earned ["S120-SBT-010"]:
        when |s| s.outputs.complete && s.before.phase == Phase::Open
            => s.outputs.successful == s.before.good;

    /// It is complete when the brake is open again.
    complete_is_open_again ["S120-SBT-010", "S120-SBT-011"]:
        when |s| s.outputs.complete && s.before.phase != Phase::Result
            => s.before.phase == Phase::Open && !s.outputs.runs && !s.outputs.close_external && !s.outputs.close_motor
                && (tested(&s).kind != Kind::External || !s.inputs.external_closed);

    /// The withdrawn start makes room for another sequence, without an alarm.
    next_sequence ["S120-SBT-011", "S120-SBT-013"]:
        when |s| s.before.phase == Phase::Result && goes_on(&s)
            => !s.outputs.interrupted && (s.after.phase == Phase::Ready) != s.inputs.start;

    /// Withdrawn while a sequence runs it interrupts it, with A01782: no torque, the brake opens.
    withdrawn_start_interrupts ["S120-SBT-013"]:
        when |s| s.before.phase.runs() && !s.inputs.start && s.inputs.select && fit(&s.inputs)
            => s.outputs.interrupted && s.after.phase == Phase::Ended && !s.outputs.torque
                && !s.outputs.close_external && !s.outputs.close_motor;

    /// Nothing else does.
    nothing_else_interrupts ["S120-SBT-013"]:
        when |s| s.outputs.interrupted
            => s.before.phase.runs() && !s.inputs.start;

    /// A stop, missing pulses and a fast axis end the test in the same cycle.
    stop_aborts ["S120-SBT-017", "S120-PF-39"]:
        when |s| s.before.phase != Phase::Idle && !fit(&s.inputs)
            => !s.outputs.torque && !s.outputs.runs && !s.outputs.complete && !s.outputs.close_external && !s.outputs.close_motor;

    /// An ended test waits for its deselection.
    ended_test_waits ["S120-SBT-013", "S120-SBT-014"]:
        when |s| s.before.phase == Phase::Ended && s.inputs.select
            => s.after.phase == Phase::Ended && s.outputs.selected && !s.outputs.complete;

    /// The deselection ends everything: the setpoint of the control counts again.
    deselection_ends ["S120-SBT-006", "S120-SBT-011", "S120-SBT-013"]:
        when |s| !s.inputs.select
            => s.after.phase == Phase::Idle && !s.outputs.selected && !s.outputs.own_setpoint && !s.outputs.torque
                && !s.outputs.runs && s.after.begin == Position(0);

    /// The state stays consistent.
    state_stays_consistent ["S120-SBT-006"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.after.select_held == s.inputs.select
                && s.after.start_held == s.inputs.start;
}
