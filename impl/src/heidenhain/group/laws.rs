//! The contract of the monitoring state.

use super::{Config, Inputs, Outputs, State, transition};
use crate::heidenhain::types::{GroupState, Kind, Phase, Stop};

/// The state that the step starts from.
const fn held(step: &Step) -> GroupState {
    if step.inputs.main_switch {
        GroupState::Sto
    } else {
        step.before.state
    }
}

monitor! { heidenhain::group;
    /// A standing group is released only by an activation without any stop, in the state that is requested.
    release_needs_an_activation ["HFS-P-12", "HFS-AXG-004", "HFS-AXG-005", "HFS-API-005"]:
        when |s| !held(&s).is_released() && s.outputs.state.is_released()
            => s.inputs.activate && s.inputs.demand == Stop::None && s.inputs.phase == Phase::Run
                && s.outputs.state == s.inputs.request
                && matches!(held(&s), GroupState::Sos | GroupState::StoO);

    /// Closing the door starts nothing: without activation no group gets laxer than it was.
    closing_a_door_starts_nothing ["HFS-P-13", "HFS-STOP-006/b", "HFS-AXG-005", "HFS-AXG-018", "HFS-MODE-002"]:
        when |s| s.inputs.request == GroupState::Auto && !s.inputs.activate && held(&s) != GroupState::Sto
            => s.outputs.state.strictness() >= held(&s).strictness();

    /// With the door open nothing is released while the self-test is not in force.
    release_needs_the_self_test ["HFS-P-51", "HFS-TEST-031", "HFS-AXG-004"]:
        when |s| !held(&s).is_released() && !s.inputs.gen_safe
            => !s.outputs.state.is_limited();

    /// Opening the door puts the limit in force in the same cycle, also while a stop runs.
    opening_a_door_limits_at_once ["HFS-P-08", "HFS-P-10", "HFS-AXG-006", "HFS-SLS-006"]:
        when |s| held(&s) == GroupState::Auto && s.inputs.phase != Phase::TorqueOff && !s.inputs.ss2_ended
            && s.inputs.request.is_limited() && s.config.may_release(s.inputs.request)
            => s.outputs.state == s.inputs.request;

    /// Standstill or torque off asked for of a group that stands is in force in the same cycle; an activation does not help.
    standstill_is_in_force_at_once ["HFS-P-08", "HFS-STOP-006/b", "HFS-P-09", "HFS-SOS-004", "HFS-SOS-006", "HFS-AXG-017", "HFS-TH-001"]:
        when |s| matches!(s.inputs.request, GroupState::Sos | GroupState::StoO | GroupState::Sto) && !s.inputs.moving
            && held(&s) != GroupState::Sto && s.inputs.phase == Phase::Run
            => s.outputs.state.strictness() >= s.inputs.request.strictness();

    /// In motion a request for standstill or torque off leaves the limits as they are, until the stop that follows.
    limits_stay_in_motion ["HFS-STOP-011", "HFS-P-50", "HFS-AXG-001"]:
        when |s| held(&s).is_released() && s.inputs.moving && !s.inputs.ss2_ended && s.inputs.phase != Phase::TorqueOff
            && matches!(s.inputs.request, GroupState::Sos | GroupState::StoO | GroupState::Sto)
            => s.outputs.state == held(&s);

    /// While a stop runs the state stays; only a limit is added.
    stop_keeps_the_state ["HFS-AXG-001", "HFS-STOP-011", "HFS-P-50"]:
        when |s| !matches!(s.inputs.phase, Phase::Run | Phase::TorqueOff)
            => s.outputs.state == held(&s)
                || (held(&s).is_released() && s.outputs.state.is_limited()
                    && s.outputs.state.strictness() > held(&s).strictness() && s.outputs.state == s.inputs.request);

    /// Torque off ends in STO; after an SS1D in STO_O, unless the group was in STO.
    torque_off_is_sto ["HFS-AXG-008", "HFS-SS1D-003", "HFS-STO-006"]:
        when |s| s.inputs.phase == Phase::TorqueOff && !s.inputs.main_switch
            => s.outputs.state == if s.inputs.soft && held(&s) != GroupState::Sto {
                GroupState::StoO
            } else {
                GroupState::Sto
            };

    /// The end of an SS2 is the standstill state: SOS for axes, torque off for a spindle unless its stop key asks for SOS.
    ss2_ends_at_rest ["HFS-AXG-008", "HFS-AXG-011", "HFS-SS2-001", "HFS-SS2-002", "HFS-SS2-006"]:
        when |s| held(&s).is_released() && s.inputs.ss2_ended && s.inputs.phase == Phase::Run
            && !matches!(s.inputs.request, GroupState::StoO | GroupState::Sto)
            => s.outputs.state == if s.config.kind() == Kind::Spindle
                && !(s.inputs.spindle_stop && s.inputs.request != GroupState::Sos) {
                GroupState::StoO
            } else {
                GroupState::Sos
            };

    /// STO is left only by the operator's edge while no stop is there, and into standstill.
    sto_needs_the_operator ["HFS-P-06", "HFS-AXG-002", "HFS-AXG-003", "HFS-PDO-001", "HFS-STO-006"]:
        when |s| held(&s) == GroupState::Sto && s.outputs.state != GroupState::Sto
            => s.inputs.switch_on && s.inputs.phase == Phase::Run && s.inputs.demand < Stop::Ss1D
                && s.inputs.request != GroupState::Sto
                && matches!(s.outputs.state, GroupState::Sos | GroupState::StoO)
                && (s.config.kind() != Kind::Spindle || s.outputs.state == GroupState::StoO);

    /// The limit of a released group gets wider only with an activation while the door is closed.
    limits_widen_by_activation_only ["HFS-AXG-018", "HFS-AXG-019", "HFS-P-13"]:
        when |s| held(&s).is_limited() && s.outputs.state == GroupState::Auto
            => s.inputs.activate && s.inputs.request == GroupState::Auto && s.inputs.demand == Stop::None
                && s.inputs.phase == Phase::Run;

    /// After a change of the mode in motion the limit of the old one applies as well.
    old_limit_stays_in_motion ["HFS-AXG-018"]:
        when |s| s.inputs.moving && held(&s) != s.outputs.state
            && matches!(held(&s), GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4)
            && matches!(s.outputs.state, GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4)
            => s.outputs.left.has(held(&s));

    /// It does so until the group stands, or the speed is limited no more, whatever modes follow.
    old_limits_stay_until_standstill ["HFS-AXG-018"]:
        when |s| !s.before.left.is_none() && s.inputs.moving
            && matches!(s.outputs.state, GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4) && !s.inputs.main_switch
            => (!s.before.left.sls_2 || s.outputs.left.sls_2) && (!s.before.left.sls_3 || s.outputs.left.sls_3)
                && (!s.before.left.sls_4 || s.outputs.left.sls_4);

    /// A turning spindle leaves restricted operation for no other limit.
    restricted_until_standstill ["HFS-AXG-019", "HFS-MODE-013"]:
        when |s| held(&s) == GroupState::SlsS && s.inputs.moving && !s.inputs.ss2_ended
            && s.inputs.phase != Phase::TorqueOff && s.inputs.request != GroupState::Auto
            => s.outputs.state == GroupState::SlsS;

    /// The main switch leads to STO.
    main_switch_leads_to_sto ["HFS-AXG-002"]:
        when |s| s.inputs.main_switch
            => s.outputs.state == GroupState::Sto;

    /// Only a released group with torque may move.
    motion_needs_the_release ["HFS-P-12", "HFS-AXG-004"]:
        when |s| s.outputs.may_move
            => s.outputs.state.is_released() && s.inputs.phase != Phase::TorqueOff && !s.inputs.main_switch;

    /// The step keeps the invariant and shows its state.
    state_stays_consistent ["HFS-AXG-001"]:
        when |s| s.before.invariant(&s.config)
            => s.after.invariant(&s.config) && s.outputs.state == s.after.state && s.outputs.left == s.after.left;
}
