//! The signals of the family: what a channel reads of the machine and of an axis, and what it says of them.

use stillpoint_monitors::heidenhain::types::{GroupState, Phase, Stop};
use stillpoint_monitors::heidenhain::{axis_release, channel, reference};

use super::axis::Said;
use crate::families::Port;
use crate::recording::vocabulary::{ALARMS, POSITION, STOP, Unit, VELOCITY};
use crate::recording::{Allowed, Value};

/// An input of the machine in a channel. What is 1 in order is named as the manual names it: a lost signal stops.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Bit {
    Es,
    Sd,
    SdMagazine,
    Pb,
    PbHandwheel,
    PbMagazine,
    Key2,
    Key3,
    Key4,
    AxisKey,
    NcStart,
    Jog,
    SpindleStart,
    StopKey,
    MagazineKey,
    Confirm,
    Handwheel,
    Program,
    Homing,
    Restricted,
    HolderOpen,
    Cvo,
    Permit,
    Chain,
    GenSafe,
    /// Off and on, for a cycle.
    MainSwitch,
}

/// Their names, in the same order.
const BITS: [&str; Bit::COUNT] = [
    "ES",
    "SD",
    "SD_MAGAZINE",
    "PB",
    "PB_HANDWHEEL",
    "PB_MAGAZINE",
    "KEY_SOM_2",
    "KEY_SOM_3",
    "KEY_SOM_4",
    "AXIS_KEY",
    "NC_START",
    "JOG",
    "SPINDLE_START",
    "STOP_KEY",
    "MAGAZINE_KEY",
    "CONFIRM",
    "HANDWHEEL",
    "PROGRAM",
    "HOMING",
    "RESTRICTED",
    "HOLDER_OPEN",
    "PP_GenCVO",
    "PP_AxGrpPermitDrvOn",
    "PP_GenFB_NCC",
    "NN_GenSafe",
    "main_switch",
];

impl Bit {
    /// How many there are.
    pub const COUNT: usize = 26;
}

/// The safe operating modes.
pub(super) const SOMS: [&str; 4] = ["SOM_1", "SOM_2", "SOM_3", "SOM_4"];

/// What a channel reads of the machine.
pub(super) fn machine_inputs() -> Vec<Port> {
    BITS.map(Port::flag).to_vec()
}

/// What it says of it.
pub(super) const MACHINE_OUTPUTS: [Port; 4] = [
    Port::text("PP_GenSOM"),
    Port::flag(VOLTAGE),
    Port::flag("STOS.G"),
    Port::flag("NN_GenOutputEnable"),
];

/// The feed enable of an axis.
pub(super) const FEED: &str = "PP_AxFeedEnable";
/// Where a channel sees an axis, in the unit of the manual (8.9.4, line 3757): 0.0001 mm or degrees.
pub(super) const SEEN: &str = "NN_AxPosition";
/// Where the control wants it, in the same unit.
pub(super) const NOMINAL: &str = "nominal_position";
/// Its marks are passed.
pub(super) const HOMED: &str = "homed";
/// A person confirms where it is.
pub(super) const CONFIRMED: &str = "confirmed";
/// The stop that is asked for, for the group of the axis.
pub(super) const ASKED: &str = "PP_AxGrpStopReq";

/// The codes of [`ASKED`], 0 to 4 (8.10.4, lines 4195-4261), then every one that does not exist.
pub(super) const STOP_CODES: [&str; 6] = ["NONE", "SS2", "SS1D", "SS1", "SS1F", "INVALID"];

/// The state of a group, and its name without torque.
pub(super) const STATE: &str = "NN_AxGrpState";
pub(super) const OFF: &str = "STO";
/// The control voltage is on.
pub(super) const VOLTAGE: &str = "STO.G";

/// A position in tenths. Those of a simulation and of a control lie far within.
const fn place(name: &'static str) -> Port {
    const MOST: i64 = i32::MAX as i64 * 10;
    Port {
        allowed: Allowed::Between(-MOST, MOST),
        ..Port::number(name, Unit::Tenth)
    }
}

/// What a channel reads of an axis.
pub(super) const AXIS_INPUTS: [Port; 6] = [
    Port::flag(FEED),
    place(SEEN),
    place(NOMINAL),
    Port::flag(HOMED),
    Port::flag(CONFIRMED),
    Port {
        allowed: Allowed::OneOf(&STOP_CODES),
        ..Port::text(ASKED)
    },
];

/// What it says of an axis and of its group.
pub(super) const AXIS_OUTPUTS: [Port; 19] = [
    Port::number(POSITION, Unit::Increment),
    Port::text(STOP),
    Port::text("stop_phase"),
    Port::text("cause"),
    Port::text("PP_AxGrpStateReq"),
    Port::text(STATE),
    Port::flag("STO"),
    Port::flag("BRK_REL"),
    Port::text("axis_release"),
    Port::text("axis_state"),
    Port::flag("NN_AxSafe"),
    Port::text("Safety.SOS.ActivationState"),
    Port::number("standstill_reference", Unit::Increment),
    Port::text("Safety.SLS.ActivationState"),
    Port::number("Safety.SLS.Limit", Unit::IncrementPerCycle),
    Port::text("Safety.SLP.SelectionState"),
    Port::text("Safety.SLP.ActivationState"),
    Port::number(VELOCITY, Unit::IncrementPerCycle),
    Port::text(ALARMS),
];

/// The values of these outputs; `group`: what its kernel says and why it stops.
pub(super) fn axis(said: &Said, group: Option<(&channel::Outputs, &'static str)>) -> Vec<Value> {
    let name = |text: &'static str| Value::Text(text.into());
    let none = channel::Outputs::default();
    let (kernel, cause) = group.unwrap_or((&none, ""));
    let active = |on: bool, faulted: bool, words: [&'static str; 2]| match (on, faulted) {
        (false, _) => name("NONE"),
        (true, true) => name(words[1]),
        (true, false) => name(words[0]),
    };
    let micrometres = |tenths: i32| Value::Int(i64::from(tenths).div_euclid(10));
    let (switch, passed) = said.slp;
    vec![
        name(stop(kernel.stop.level)),
        name(phase(kernel.stop.phase)),
        name(cause),
        name(state(kernel.taken.request)),
        name(state(kernel.group.state)),
        // 1 in order, as the signals -STO and -BRK_REL are.
        Value::Bool(!kernel.torque_off),
        Value::Bool(!kernel.brake_closed),
        name(match said.release.mode {
            axis_release::Mode::Sos => "SOS",
            axis_release::Mode::Released => "RELEASED",
            axis_release::Mode::Ss2 => "SS2",
        }),
        name(match said.known {
            reference::AxisRef::NotHomed => "NOT_HOMED",
            reference::AxisRef::Homed => "HOMED",
            reference::AxisRef::NotChecked => "NOT_CHECKED",
            reference::AxisRef::Checked => "CHECKED",
        }),
        Value::Bool(said.reference.ax_safe),
        active(
            said.stands_at.is_some(),
            said.standing.too_far || said.standing.too_fast,
            ["SOS_ACTIVE", "SOS_ACTIVE_FAULTED"],
        ),
        micrometres(said.stands_at.map_or(0, |at| at.0)),
        active(
            said.limited.watched,
            said.limited.violated,
            ["SLS_ACTIVE", "SLS_ACTIVE_FAULTED"],
        ),
        Value::Int(said.limit.map_or(0, |limit| i64::from(limit.0) / 10)),
        name(if switch { "SELECTED_LIMIT_1" } else { "NONE" }),
        active(switch, passed, ["SLP_ACTIVE", "SLP_ACTIVE_FAULTED"]),
        Value::Int(i64::from(said.speed.0) / 10),
        name(""),
    ]
}

/// The name of a stop.
pub(super) const fn stop(stop: Stop) -> &'static str {
    match stop {
        Stop::None => "NONE",
        Stop::Ss2 => "SS2",
        Stop::Ss1D => "SS1D",
        Stop::Ss1 => "SS1",
        Stop::Ss1F => "SS1F",
        Stop::Ss0 => "SS0",
    }
}

const fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Run => "RUN",
        Phase::Ss2Wait => "SS2_WAIT",
        Phase::Ss2Brake => "SS2_BRAKE",
        Phase::Ss1DWait => "SS1D_WAIT",
        Phase::EmergencyBrake => "EMERGENCY_BRAKE",
        Phase::BrakeCloses => "BRAKE_CLOSES",
        Phase::TorqueOff => "TORQUE_OFF",
    }
}

const fn state(state: GroupState) -> &'static str {
    match state {
        GroupState::Auto => "AUTO",
        GroupState::Sls4 => "SLS_4",
        GroupState::Sls3 => "SLS_3",
        GroupState::Sls2 => "SLS_2",
        GroupState::SlsS => "SLS_S",
        GroupState::Sos => "SOS",
        GroupState::StoO => "STO_O",
        GroupState::Sto => OFF,
    }
}
