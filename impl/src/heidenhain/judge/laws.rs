//! The contract of the judgement.

use super::{Config, Inputs, Modes, Outputs, Place, State, transition};
use crate::heidenhain::types::{GroupState, Kind, Stop, Unit};

monitor! { heidenhain::judge;
    /// The demand is the highest of the causes and of the requested stop.
    demand_is_the_highest_cause ["HFS-STOP-009", "HFS-FAULT-018", "HFS-SS1-001"]:
        when |s| !s.inputs.main_switch
            => s.outputs.demand >= s.inputs.stop_request.min(Stop::Ss1F)
                && (!s.outputs.asks_ss1f || s.outputs.demand >= Stop::Ss1F)
                && (!s.outputs.asks_ss1 || s.outputs.demand >= Stop::Ss1)
                && (!s.outputs.asks_ss1d || s.outputs.demand >= Stop::Ss1D)
                && (!s.outputs.asks_ss2 || s.outputs.demand >= Stop::Ss2);

    /// Nothing is demanded without a cause or a request, and never SS0.
    demand_needs_a_cause ["HFS-STOP-009", "HFS-SS0-002"]:
        when |s| s.outputs.demand != Stop::None
            => match s.outputs.demand {
                Stop::None | Stop::Ss0 => false,
                Stop::Ss2 => s.outputs.asks_ss2 || s.inputs.stop_request == Stop::Ss2,
                Stop::Ss1D => s.outputs.asks_ss1d || s.inputs.stop_request == Stop::Ss1D,
                Stop::Ss1 => s.outputs.asks_ss1 || s.inputs.stop_request == Stop::Ss1,
                Stop::Ss1F => s.outputs.asks_ss1f || s.inputs.stop_request >= Stop::Ss1F,
            };

    /// A request that is no code, SS0 and SS1F of the safe PLC are SS1F.
    bad_request_is_ss1f ["HFS-FAULT-001", "HFS-FAULT-006", "HFS-API-018", "HFS-SS0-002"]:
        when |s| (s.inputs.bad_code || s.inputs.stop_request >= Stop::Ss1F) && !s.inputs.main_switch
            => s.outputs.demand == Stop::Ss1F;

    /// SOM_4 after SOM_2 or SOM_3, and the reverse, without SOS or AUTO between is SS1F.
    direct_change_of_mode_is_ss1f ["HFS-FAULT-007", "HFS-P-21"]:
        when |s| !s.inputs.main_switch
            && ((s.before.modes == Modes::Low && s.inputs.request == GroupState::Sls4)
                || (s.before.modes == Modes::High && matches!(s.inputs.request, GroupState::Sls2 | GroupState::Sls3)))
            => s.outputs.demand == Stop::Ss1F;

    /// What was requested is remembered until SOS or AUTO is requested.
    mode_is_remembered ["HFS-FAULT-007"]:
        when |s| !s.inputs.main_switch
            => match s.inputs.request {
                GroupState::Auto | GroupState::Sos => s.after.modes == Modes::None,
                GroupState::Sls2 | GroupState::Sls3 => s.after.modes == Modes::Low,
                GroupState::Sls4 => s.after.modes == Modes::High,
                GroupState::SlsS | GroupState::StoO | GroupState::Sto => s.after.modes == s.before.modes,
            };

    /// Restricted spindle operation of a group without spindle is SS1F.
    spindle_mode_needs_a_spindle ["HFS-FAULT-008/a", "HFS-P-39"]:
        when |s| s.inputs.request == GroupState::SlsS && s.config.kind() != Kind::Spindle && !s.inputs.main_switch
            => s.outputs.demand == Stop::Ss1F;

    /// SOM_4 that is not enabled is at least SS1.
    som_4_must_be_enabled ["HFS-FAULT-015", "HFS-MODE-007"]:
        when |s| s.inputs.request == GroupState::Sls4 && !s.config.som_4() && !s.inputs.main_switch
            => s.outputs.asks_ss1 && s.outputs.demand >= Stop::Ss1;

    /// Standstill asked for in motion is SS1: the door was opened in SOM_1.
    standstill_in_motion_is_ss1 ["HFS-SOS-004", "HFS-FAULT-014", "HFS-MODE-015", "HFS-P-08", "HFS-P-09"]:
        when |s| s.inputs.moving && s.inputs.request == GroupState::Sos && s.inputs.state.is_released()
            => s.outputs.asks_ss1;

    /// Torque off asked for in motion is SS1.
    torque_off_in_motion_is_ss1 ["HFS-AXG-006", "HFS-AXG-017", "HFS-P-08"]:
        when |s| s.inputs.moving && matches!(s.inputs.request, GroupState::StoO | GroupState::Sto)
            && s.inputs.state != GroupState::Sto
            => s.outputs.asks_ss1;

    /// A spindle that turns without permissive in SOM_2 or SOM_3, or at the handwheel in SOM_4, stops after the axes.
    spindle_without_permissive_stops ["HFS-MODE-005/e", "HFS-SS2-008/b", "HFS-AXG-014", "HFS-PB-003", "HFS-FAULT-016/a", "HFS-MODE-004/e", "HFS-SS2-010"]:
        when |s| s.config.kind() == Kind::Spindle && s.inputs.moving && !s.inputs.permissive
            && (matches!(s.inputs.state, GroupState::Sls2 | GroupState::Sls3)
                || (s.inputs.state == GroupState::Sls4 && s.inputs.unit == Unit::Handwheel))
            => s.outputs.asks_ss1d && s.outputs.stops_axes;

    /// So does a spindle that turns without permissive as its door is opened, also where restricted operation is requested.
    opened_door_stops_the_spindle ["HFS-MODE-011", "HFS-AXG-007"]:
        when |s| s.config.kind() == Kind::Spindle && s.inputs.moving && !s.inputs.permissive
            && s.inputs.state == GroupState::Auto
            && matches!(s.inputs.request, GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4 | GroupState::SlsS)
            => s.outputs.asks_ss1d && s.outputs.stops_axes;

    /// With the permissive, in restricted operation and in SOM_4 at the panel a spindle goes on.
    spindle_goes_on ["HFS-MODE-013", "HFS-MODE-023", "HFS-MODE-024", "HFS-AXG-014"]:
        when |s| s.inputs.permissive || s.inputs.state == GroupState::SlsS
            || (s.inputs.state == GroupState::Sls4 && s.inputs.unit != Unit::Handwheel)
            => !s.outputs.asks_ss1d && !s.outputs.stops_axes;

    /// Axes moved by handwheel without permissive stop.
    handwheel_needs_the_permissive ["HFS-AXG-015", "HFS-FAULT-026", "HFS-HW-002"]:
        when |s| s.config.kind() != Kind::Spindle && s.inputs.moving && !s.inputs.permissive
            && matches!(s.inputs.state, GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4)
            && s.inputs.unit == Unit::Handwheel
            => s.outputs.asks_ss2;

    /// So do a magazine and other auxiliary axes, however they are operated.
    magazine_needs_the_permissive ["HFS-PB-003", "HFS-API-012"]:
        when |s| s.config.kind() == Kind::Auxiliary && s.inputs.moving && !s.inputs.permissive
            && matches!(s.inputs.state, GroupState::Sls2 | GroupState::Sls3 | GroupState::Sls4)
            => s.outputs.asks_ss2;

    /// A change between panel, handwheel and reference run stops a released group.
    change_of_unit_stops ["HFS-SS2-008/d", "HFS-HW-004", "HFS-FAULT-025", "HFS-AXG-013"]:
        when |s| Place::of(s.inputs.unit) != s.before.place && s.inputs.state.is_released()
            => s.outputs.asks_ss2 && s.after.place == Place::of(s.inputs.unit);

    /// With the door open an overdue self-test stops a released group.
    overdue_test_stops ["HFS-P-30", "HFS-P-51", "HFS-FAULT-017", "HFS-TEST-031"]:
        when |s| !s.inputs.gen_safe && s.inputs.state.is_released() && s.inputs.request != GroupState::Auto
            => s.outputs.asks_ss2;

    /// The start-up protection and a moving axis that is not checked stop a released group.
    monitors_stop ["HFS-USTART-001", "HFS-P-19"]:
        when |s| (s.inputs.idle || s.inputs.untested) && s.inputs.state.is_released()
            => s.outputs.asks_ss2;

    /// A group that stands, in an allowed mode and with nothing amiss, is not stopped.
    nothing_amiss_nothing_asked ["HFS-AXG-004", "HFS-P-35"]:
        when |s| s.inputs.stop_request == Stop::None && !s.inputs.bad_code && !s.inputs.moving && s.inputs.gen_safe
            && !s.inputs.idle && !s.inputs.untested && !s.inputs.main_switch
            && Place::of(s.inputs.unit) == s.before.place
            && matches!(s.inputs.request, GroupState::Auto | GroupState::Sos)
            => s.outputs == Outputs::default();
}
