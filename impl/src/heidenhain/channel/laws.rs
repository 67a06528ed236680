//! The contract of the channel: what holds because the monitors are wired as they are, in the cycle of its cause.
//!
//! What one monitor guarantees on its own is part of its own contract and not repeated, except where a law of the manual
//! runs through several monitors.

use super::{Config, Inputs, Outputs, State, causes, found, transition};
use crate::heidenhain::gate;
use crate::heidenhain::types::{GroupState, Kind, Phase, Stop};

/// What this channel's safe PLC has set, as it is taken over.
fn own(step: &Step) -> gate::Outputs {
    gate::transition(gate::State::INITIAL, &step.config.gate, &step.inputs.fields).1
}

/// The state that the step starts from.
const fn held(step: &Step) -> GroupState {
    if step.inputs.main_switch {
        GroupState::Sto
    } else {
        step.before.group.state
    }
}

/// A stop of rank SS1 is in force, or brakes at the end of an SS1D.
const fn hard(step: &Step) -> bool {
    step.outputs.stop.level as u8 >= Stop::Ss1 as u8
        || matches!(
            step.outputs.stop.phase,
            Phase::EmergencyBrake | Phase::BrakeCloses | Phase::TorqueOff
        )
}

monitor! { heidenhain::channel;
    /// Every cause acts in its cycle, wherever it comes from; an SS2 may end at once where the group stands.
    every_cause_acts ["HFS-ARCH-004/m", "HFS-STOP-001", "HFS-STOP-009", "HFS-STOP-012", "HFS-P-03", "HFS-P-04"]:
        when |s| !s.inputs.main_switch && (causes(&s.inputs) != Stop::None || own(&s).stop != Stop::None || s.inputs.peer.stop != Stop::None)
            => {
                let asked = causes(&s.inputs).max(own(&s).stop).max(s.inputs.peer.stop);
                // An SS0 of the other channel's requests does not exist: it counts as SS1F.
                let asked = if asked == Stop::Ss0 && causes(&s.inputs) != Stop::Ss0 { Stop::Ss1F } else { asked };
                s.outputs.stop.level >= asked || (asked == Stop::Ss2 && (s.outputs.stop.ss2_ended || s.outputs.stop.restarted))
            };

    /// A wrong request of either safe PLC stops the machine for good and releases nothing.
    wrong_request_is_never_trusted ["HFS-FAULT-001", "HFS-FAULT-006", "HFS-FAULT-008/a"]:
        when |s| !s.inputs.main_switch && (own(&s).stop == Stop::Ss1F || s.inputs.peer.stop == Stop::Ss1F)
            => s.outputs.stop.level >= Stop::Ss1F && s.outputs.stop.needs_switch;

    /// The group is at least as strict as either channel was asked for, or stands in a stop, or one of rank SS1 brakes it.
    state_is_as_strict_as_requested ["HFS-ARCH-004/m", "HFS-ARCH-005", "HFS-P-08", "HFS-P-09", "HFS-P-10", "HFS-API-001"]:
        when |s| s.outputs.group.state.is_released()
            => hard(&s) || (s.outputs.stop.level != Stop::None && !s.inputs.moving)
                || (s.outputs.group.state.strictness() >= own(&s).request.strictness()
                && s.outputs.group.state.strictness() >= s.inputs.peer.request.strictness());

    /// A group is released only when both channels activate it in a cycle without any cause.
    release_needs_both_channels ["HFS-P-12", "HFS-API-005", "HFS-KDV-005"]:
        when |s| s.outputs.group.state.is_released() && !held(&s).is_released()
            => s.inputs.fields.activate && s.inputs.peer.starts && s.outputs.demand == Stop::None
                && s.outputs.stop.level == Stop::None
                && own(&s).stop == Stop::None && s.inputs.peer.stop == Stop::None;

    /// Standstill asked for in motion is a stop of the whole machine: the door was opened in SOM_1.
    open_door_in_som_1_stops ["HFS-P-09", "HFS-SOS-004", "HFS-FAULT-014"]:
        when |s| !s.inputs.main_switch && (s.inputs.moving && held(&s).is_released()
            && (own(&s).request == GroupState::Sos || s.inputs.peer.request == GroupState::Sos))
            => hard(&s) && s.outputs.demand >= Stop::Ss1;

    /// Channels that differ for too long stop the machine.
    lasting_difference_stops ["HFS-P-31", "HFS-KDV-001"]:
        when |s| !s.inputs.main_switch && (s.inputs.late)
            => s.outputs.stop.level >= Stop::Ss1
                && (s.outputs.stop.wide || s.outputs.stop.level >= Stop::Ss1F || s.outputs.stop.torque_off);

    /// After SS1F and SS0 the group does not move before the main switch.
    hard_stop_lasts ["HFS-P-05", "HFS-ACK-001"]:
        when |s| s.before.stop.level >= Stop::Ss1F && !s.inputs.main_switch
            => s.outputs.stop.level >= Stop::Ss1F && (s.before.stop.phase != Phase::TorqueOff || s.outputs.torque_off);

    /// STO is left by an edge of the permission after torque off with the control voltage on, and by nothing else.
    torque_needs_the_operator ["HFS-P-06", "HFS-ACK-005", "HFS-ACK-006", "HFS-PDO-001"]:
        when |s| held(&s) == GroupState::Sto && s.outputs.group.state != GroupState::Sto
            => s.inputs.voltage && (s.inputs.permit && !s.before.permitted || s.before.fresh)
                && !s.inputs.main_switch && s.outputs.demand < Stop::Ss1D && s.before.stop.level < Stop::Ss1F;

    /// A permission that merely stays on restarts nothing; an SS1D ends by itself, and leaves the group in STO_O.
    level_restarts_nothing ["HFS-P-06", "HFS-ACK-005"]:
        when |s| s.before.permitted && !s.before.fresh
            => (!s.outputs.stop.restarted || (s.before.stop.level == Stop::Ss1D && s.inputs.peer_off))
                && (held(&s) != GroupState::Sto || s.outputs.group.state == GroupState::Sto);

    /// With an open door nothing is released while the self-test is not in force.
    self_test_gates_the_release ["HFS-P-51", "HFS-TEST-031"]:
        when |s| !s.inputs.gen_safe && !held(&s).is_released()
            => !s.outputs.group.state.is_limited();

    /// A permissive, like an activation, counts only when both channels see it.
    permissive_needs_both_channels ["HFS-KDV-005", "HFS-AXG-014"]:
        when |s| s.inputs.fields.permissive != s.inputs.peer.held && s.inputs.moving
            && matches!(held(&s), GroupState::Sls2 | GroupState::Sls3)
            && s.config.kind() == Kind::Spindle && !s.inputs.main_switch
            => s.outputs.stops_axes && s.outputs.demand >= Stop::Ss1D;

    /// What has no torque has its brakes closed; and a standing group in STO or STO_O has no torque.
    brakes_hold_what_has_no_torque ["HFS-P-27", "HFS-SS0-001", "HFS-STO-001"]:
        when |s| s.outputs.torque_off
            => s.outputs.brake_closed && !s.outputs.group.may_move;

    /// A group that may move is released and has torque.
    motion_needs_release_and_torque ["HFS-P-05", "HFS-P-12"]:
        when |s| s.outputs.group.may_move
            => !s.outputs.torque_off && !s.outputs.stop.torque_off && s.outputs.group.state.is_released();

    /// The other channel is told what this one has taken over, checked.
    other_channel_is_told ["HFS-KDV-002/b", "HFS-AXG-012"]:
        when |s| s.outputs.differ
            => s.outputs.taken == own(&s)
                && (s.outputs.taken.request != s.inputs.peer.request || s.outputs.taken.stop != s.inputs.peer.stop
                    || s.outputs.taken.starts != s.inputs.peer.starts || s.outputs.taken.held != s.inputs.peer.held);

    /// The other channel is told every cause that this one finds, also when its own torque is off already.
    other_channel_is_told_of_causes ["HFS-STOP-012", "HFS-ARCH-001"]:
        when |s| !s.inputs.main_switch && (found(&s.inputs) != Stop::None || own(&s).stop != Stop::None)
            => s.outputs.tells >= found(&s.inputs).max(own(&s).stop);

    /// What the other channel has told is not told back by a channel without torque, so that both can be switched on again.
    told_causes_are_not_told_back ["HFS-STOP-012", "HFS-ACK-001"]:
        when |s| s.outputs.stop.torque_off && !s.outputs.stop.needs_switch && !held(&s).is_released()
            && found(&s.inputs) == Stop::None && !s.inputs.late && !s.inputs.moving
            && own(&s).stop == Stop::None && s.inputs.peer.stop == Stop::None
            && own(&s).request == GroupState::Auto && s.inputs.peer.request == GroupState::Auto
            => s.outputs.tells == Stop::None;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-STOP-009", "HFS-AXG-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.group.state == s.after.group.state
                && s.outputs.stop.level == s.after.stop.level;
}
