//! What the monitors of an axis tell in a channel.

use stillpoint_machine::Axis;
use stillpoint_monitors::sinamics::control_path::ControlPath;
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::setpoint_limit::UNLIMITED;

use super::messages;
use super::said::Said;
use super::values::{self, GEAR, SBC, SBT, SDI, SP};
use crate::families::Port;
use crate::families::values::cell;
use crate::recording::Value;
use crate::recording::vocabulary::{ALARMS, POSITION, STOP, Unit, VELOCITY};

/// Outputs that tell how a recording begins, and why a channel stops.
pub(super) const TORQUE: &str = "torque";
pub(super) const CAUSE: &str = "cause";

/// The latched stops, in rising order; F is beside the others and shown where there is none.
pub(super) const STOPS: [&str; 8] = ["NONE", "F", "E", "D", "C", "B", "A", "LOCKED"];

/// The name of what a channel has latched.
fn stop(said: &Said) -> &'static str {
    STOPS[match said.stop {
        Stop::None => usize::from(said.stop_f),
        Stop::E => 2,
        Stop::D => 3,
        Stop::C => 4,
        Stop::B => 5,
        Stop::A => 6,
        Stop::Locked => 7,
    }]
}

const fn function(function: Function) -> &'static str {
    match function {
        Function::None => "NONE",
        Function::Watching => "WATCHING",
        Function::Sos => "SOS",
        Function::Ss2e => "SS2E",
        Function::Ss2 => "SS2",
        Function::Ss1 => "SS1",
        Function::Sto => "STO",
    }
}

/// What is told of an axis, in the order of its signals.
pub(super) fn outputs(axis: &Axis, side: usize, said: &Said) -> Vec<(Port, Value)> {
    let on = |name, value: bool| (Port::flag(name), Value::Bool(value));
    let int = |name, unit, value: i64| (Port::number(name, unit), Value::Int(value));
    let name = |port, value: &'static str| (Port::text(port), Value::Text(value.into()));
    let mut all = vec![
        int(POSITION, Unit::Increment, said.position.into()),
        int(VELOCITY, Unit::IncrementPerCycle, said.speed.0.into()),
        name(STOP, stop(said)),
        name(CAUSE, said.cause),
        (
            Port::text(ALARMS),
            Value::Text(messages::text(said.messages, side).into()),
        ),
        on("STO_active", said.sto),
        on("SS1_active", said.ss1),
        on("pulses_off", said.pulses_off),
        on("OFF3", said.off3),
        on(TORQUE, said.torque),
    ];
    if values::extended(axis) {
        let monitored = |on: bool, fault: bool, names: [&'static str; 2]| match (on, fault) {
            (false, _) => "NONE",
            (true, false) => names[0],
            (true, true) => names[1],
        };
        all.extend([
            on("STOP_F", said.stop_f),
            int("C01711", Unit::None, said.value.into()),
            name("function", function(said.function)),
            on("SS2_active", said.ss2),
            on("SOS_active", said.sos),
            on("SLS_active", said.sls),
            int("SLS_monitored_level", Unit::None, said.sls_level.into()),
            on("SSM", said.ssm),
            int(
                "braking_limit",
                Unit::IncrementPerCycle,
                said.braking_limit.0.into(),
            ),
            name(
                "Safety.SOS.ActivationState",
                monitored(
                    said.sos,
                    said.sos_violated,
                    ["SOS_ACTIVE", "SOS_ACTIVE_FAULTED"],
                ),
            ),
            int(
                "standstill_reference",
                Unit::Increment,
                said.sos_reference.into(),
            ),
            name(
                "Safety.SLS.ActivationState",
                monitored(
                    said.sls,
                    said.sls_violated,
                    ["SLS_ACTIVE", "SLS_ACTIVE_FAULTED"],
                ),
            ),
            int(
                "Safety.SLS.Limit",
                Unit::IncrementPerCycle,
                said.sls_limit.0.into(),
            ),
        ]);
    }
    let own = |function| values::extended(axis) && axis.has(function);
    if own(SDI) {
        all.extend([
            on("SDI_positive_active", said.sdi[0]),
            on("SDI_negative_active", said.sdi[1]),
        ]);
    }
    if values::referenced(axis) {
        all.extend([
            on("referenced", said.reference.referenced),
            on("safely_referenced", said.reference.safe),
            on("reference_fault", said.reference.moved),
        ]);
    }
    if values::slp(axis) {
        all.extend([
            on("SLP_active", said.slp),
            on("SLP_upper_kept", said.slp_kept[0]),
            on("SLP_lower_kept", said.slp_kept[1]),
            name(
                "Safety.SLP.SelectionState",
                match (said.slp, said.slp_second) {
                    (false, _) => "NONE",
                    (true, false) => "SELECTED_LIMIT_1",
                    (true, true) => "SELECTED_LIMIT_2",
                },
            ),
        ]);
    }
    if own(GEAR) {
        all.extend([
            int(
                "active_gear_stage",
                Unit::None,
                said.gear.stage.get().into(),
            ),
            on("gear_tolerance_active", said.gear.raised),
        ]);
    }
    if own(SP) {
        all.extend([
            on("SP_valid", said.transferred.valid),
            int("S_XIST16", Unit::None, said.transferred.short.into()),
            int("S_XIST32", Unit::Increment, said.transferred.long.into()),
            // The word of the telegram has a sign: behind 32767 comes -32768 (S120-PSAFE-518).
            int(
                "S_CYCLE_COUNT",
                Unit::None,
                (said.transferred.cycle as i16).into(),
            ),
        ]);
    }
    if values::extended(axis) && !values::encoder(axis) {
        all.extend([
            on("internal_STO", said.bare.internal),
            on("start_window", said.bare.window),
            on("actual_value_known", said.bare.known),
        ]);
    }
    if said_limits(axis) {
        let limit = |value: u32| {
            if value == UNLIMITED.0 {
                i64::from(i32::MAX)
            } else {
                value.into()
            }
        };
        all.push(int(
            "r9733",
            Unit::IncrementPerCycle,
            limit(said.setpoint.0),
        ));
    }
    if axis.has(SBC) {
        all.push(on("brake_open", said.brake_open));
    }
    if values::enables(axis, ControlPath::profisafe) {
        all.push(on("telegram_valid", said.valid));
    }
    if axis.has("ESR") {
        all.push(on("ESR", said.esr));
    }
    all.push(on("internal_event", said.event));
    all.push(on("path_test_due", said.service.path_due));
    if values::extended(axis) {
        all.extend([
            on("test_stop_due", said.service.due),
            on("test_stop_active", said.service.tests),
            on("test_stop_failed", said.service.failed),
        ]);
    }
    if own(SBT) {
        let test = &said.service.brake;
        all.extend([
            on("SBT_selected", test.selected),
            on("SBT_ready", test.ready),
            on("SBT_active", test.runs),
            on("SBT_torque", test.torque),
            on("SBT_successful", test.successful),
            on("SBT_complete", test.complete),
            on("SBT_refused", test.refused),
            on("SBT_late", test.late),
            on("external_brake_request", test.close_external),
        ]);
    }
    all
}

/// r9733 is used.
fn said_limits(axis: &Axis) -> bool {
    values::extended(axis) && cell(&axis.values, "p9533", 0) != 0
}
