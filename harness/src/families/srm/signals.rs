//! The signals of an axis: what the safety program reads, and what its blocks and their wiring tell.

use stillpoint_machine::Axis;
use stillpoint_monitors::srm::brake_test;
use stillpoint_monitors::srm::common::{UNLIMITED, bit};

use super::blocks::{Said, Stop, Told};
use super::values::{self, BRAKE_TEST, END_ZONE, LOAD, RAMP, SLP};
use crate::families::Port;
use crate::families::values::nearest;
use crate::recording::vocabulary::{ALARMS, POSITION, STOP, Unit, VELOCITY};
use crate::recording::{Allowed, Value};

/// An input that is true or false.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flag {
    /// The CPU runs: the safety program is called.
    Run,
    Pos1Valid,
    Pos2Valid,
    PossiValid,
    Reference,
    Sync,
    Ack,
    Release,
    /// Slow travel to the reference point is allowed.
    ToReference,
    /// The drive performs an SS1: EXECUTE of F_SBR_MONITOR.
    Ss1Active,
    FdbackDrive,
    FdbackBr1,
    FdbackBr2,
    /// EXECUTE of F_BRAKE_TEST.
    Execute,
    MaxloadMode,
    Calibrate,
}

/// An input that is a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    Pos1,
    Pos2,
    Possi,
    PossiCount,
    Load1,
    Load2,
    StatusWord,
}

/// An input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Input {
    Flag(Flag),
    Number(Number),
    /// The stop that is asked for from outside.
    Asked,
}

/// The position that defines the one of the axis: without it nothing is replayed.
pub(super) const POS1: &str = "POS1";
/// Names of outputs that tell how a recording begins.
pub(super) const SAFE_POS: &str = "SAFE_POS";
pub(super) const REFERENCED: &str = "REFERENCED";
pub(super) const TEST_OK: &str = "BT_TEST_OK";
pub(super) const MEASURES: &str = "LOAD_TEST_OK";
pub(super) const CAUSE: &str = "cause";

/// The stops, in rising order.
pub(super) const STOPS: [&str; 3] = ["NONE", "SS1", "STO"];

/// Every input: its name, and the block that it needs.
static INPUTS: [(Input, &str, &str); 24] = {
    use Flag::*;
    use Input::{Asked, Flag as F, Number as N};
    use Number::*;
    [
        (F(Run), "RUN", ""),
        (N(Pos1), POS1, ""),
        (F(Pos1Valid), "POS1_VALID", ""),
        (N(Pos2), "POS2", THREE),
        (F(Pos2Valid), "POS2_VALID", THREE),
        (N(Possi), "POSSI", ""),
        (F(PossiValid), "POSSI_VALID", ""),
        (N(PossiCount), "POSSI_COUNT", ""),
        (F(Reference), "REFERENCE", ""),
        (F(Sync), "SYNC", ""),
        (F(Ack), "ACK", ""),
        (F(Release), "RELEASE", ""),
        (F(ToReference), "to_reference", ""),
        (F(Ss1Active), "SS1_ACTIVE", RAMP),
        (F(FdbackDrive), "FDBACK_DRIVE", BRAKE_TEST),
        (F(FdbackBr1), "FDBACK_BR_1", BRAKE_TEST),
        (F(FdbackBr2), "FDBACK_BR_2", BRAKE_TEST),
        (N(StatusWord), "S_ZSW3B", BRAKE_TEST),
        (F(Execute), "EXECUTE", BRAKE_TEST),
        (N(Load1), "LOAD1", LOAD),
        (N(Load2), "LOAD2", LOAD),
        (F(MaxloadMode), "MAXLOAD_MODE", LOAD),
        (F(Calibrate), "CALIBRATE", LOAD),
        (Asked, "stop_asked", ""),
    ]
};

/// What POS2 needs: three encoders.
const THREE: &str = "POS_CONFIG";

/// The inputs of an axis, in the order of its signals.
pub(super) fn inputs(axis: &Axis) -> Vec<Input> {
    let three = values::safe_pos(axis, 1).pos_config;
    let has = |needs: &str| match needs {
        "" => true,
        THREE => three,
        function => axis.has(function),
    };
    let known = INPUTS.iter().filter(|(.., needs)| has(needs));
    known.map(|(input, ..)| *input).collect()
}

impl Input {
    /// What it is called and what it may be.
    pub(super) fn port(self) -> Port {
        let name = INPUTS.iter().find(|(input, ..)| *input == self);
        let name = name.map_or("", |(_, name, _)| *name);
        let number = |unit, least: i64, most: i64| Port {
            allowed: Allowed::Between(least, most),
            ..Port::number(name, unit)
        };
        let dint = |unit| number(unit, i64::from(i32::MIN), i64::from(i32::MAX));
        match self {
            Self::Flag(_) => Port::flag(name),
            Self::Number(Number::Pos1 | Number::Pos2) => dint(Unit::Millimetre),
            Self::Number(Number::Possi) => dint(Unit::Increment),
            Self::Number(Number::PossiCount) => {
                number(Unit::None, i64::from(i16::MIN), i64::from(i16::MAX))
            }
            Self::Number(Number::Load1 | Number::Load2) => dint(Unit::None),
            Self::Number(Number::StatusWord) => number(Unit::None, 0, i64::from(u16::MAX)),
            Self::Asked => Port {
                allowed: Allowed::OneOf(&STOPS),
                ..Port::text(name)
            },
        }
    }
}

/// What a call reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Read {
    flags: [bool; 16],
    numbers: [i32; 7],
    /// The stop that is asked for from outside.
    pub asked: Stop,
}

impl Read {
    /// An input that is true or false.
    pub(super) fn is(&self, flag: Flag) -> bool {
        self.flags[flag as usize]
    }

    /// An input that is a number.
    pub(super) fn number(&self, number: Number) -> i32 {
        self.numbers[number as usize]
    }

    /// The same with flags set or not.
    pub(super) fn flags(mut self, given: &[(Flag, bool)]) -> Self {
        for (flag, on) in given {
            self.flags[*flag as usize] = *on;
        }
        self
    }

    /// The same with numbers; what is no DInt is the nearest one.
    pub(super) fn numbers(mut self, given: &[(Number, i64)]) -> Self {
        for (number, value) in given {
            self.numbers[*number as usize] = nearest(*value);
        }
        self
    }

    /// The value of an input.
    pub(super) fn get(&self, input: Input) -> Value {
        match input {
            Input::Flag(flag) => Value::Bool(self.is(flag)),
            Input::Number(number) => Value::Int(self.number(number).into()),
            Input::Asked => Value::Text(STOPS[self.asked as usize].into()),
        }
    }

    /// Gives an input a value. False: it is none of its values.
    pub(super) fn set(&mut self, input: Input, value: &Value) -> bool {
        if !input.port().admits(value) {
            return false;
        }
        match (input, value) {
            (Input::Flag(flag), Value::Bool(on)) => *self = self.flags(&[(flag, *on)]),
            (Input::Number(number), Value::Int(n)) => *self = self.numbers(&[(number, *n)]),
            (Input::Asked, Value::Text(name)) => {
                let place = STOPS.iter().position(|known| known == name);
                self.asked = Stop::of(place.unwrap_or(0));
            }
            _ => return false,
        }
        true
    }

    /// What S_ZSW3B says.
    pub(super) fn status(&self) -> brake_test::Status {
        // Its values are words.
        brake_test::Status::from_word(self.number(Number::StatusWord) as u16)
    }
}

/// The blocks whose DIAG words are told bit by bit: `POS.9` is bit 9 of F_SAFE_POS.
const DIAGS: [&str; 6] = ["POS", "SLP", "EZ", "SBR", "BT", "LOAD"];

/// Every bit of every DIAG word by its name.
pub(super) fn diags() -> Vec<String> {
    let bits = |block| (0..16).map(move |n| format!("{block}.{n}"));
    DIAGS.into_iter().flat_map(bits).collect()
}

/// The bits that are set.
fn set_bits(axis: &Axis, told: &Told) -> String {
    let range = |function| match axis.has(function) {
        true => told.range.diag,
        false => 0,
    };
    let words = [
        told.pos.diag,
        range(SLP),
        range(END_ZONE),
        told.ramp.diag,
        told.brake.diag,
        told.load.diag | told.calibration.diag,
    ];
    let mut set = Vec::new();
    for (block, word) in DIAGS.into_iter().zip(words) {
        let bits = (0..16).filter(|n| bit(word, *n));
        set.extend(bits.map(|n| format!("{block}.{n}")));
    }
    set.join(" ")
}

/// What is told of an axis, in the order of its signals. `t_sample`: ms of a call.
pub(super) fn outputs(axis: &Axis, said: &Said, t_sample: i32) -> Vec<(Port, Value)> {
    let (told, logic) = (&said.told, &said.told.logic);
    let on = |name, value: bool| (Port::flag(name), Value::Bool(value));
    let int = |name, unit, value: i32| (Port::number(name, unit), Value::Int(value.into()));
    let name = |port, value: &'static str| (Port::text(port), Value::Text(value.into()));
    // mm/min in um per call.
    let per_call = |v: i32| i64::from(v) * i64::from(t_sample) / 60;
    let counted = |port, v| {
        (
            Port::number(port, Unit::IncrementPerCycle),
            Value::Int(per_call(v)),
        )
    };
    let pos = &told.pos;
    let position = Value::Int(i64::from(pos.safe_pos) * 1_000);
    let limited = logic.sls_limit < UNLIMITED;
    let has = |function| axis.has(function);
    let ranged = has(SLP) || has(END_ZONE);
    let mut all = vec![
        (Port::number(POSITION, Unit::Increment), position),
        name(STOP, STOPS[said.stop as usize]),
        name(CAUSE, said.cause),
        (Port::text(ALARMS), Value::Text(set_bits(axis, told).into())),
        int(SAFE_POS, Unit::Millimetre, pos.safe_pos),
        on("POS_VALID", pos.pos_valid),
        on(REFERENCED, pos.referenced),
        int("SAFE_V", Unit::MillimetrePerMinute, pos.safe_v),
        on("V_VALID", pos.v_valid),
        on("STANDSTILL", pos.standstill),
        on("MOVES_POSITIVE", pos.moves_positive),
        on("MOVES_NEGATIVE", pos.moves_negative),
    ];
    if ranged {
        all.extend([
            on("X_NEGATIVE_OK", told.range.x_negative_ok),
            on("X_POSITIVE_OK", told.range.x_positive_ok),
        ]);
    }
    if has(RAMP) {
        all.extend([
            on("SBR_OK", told.ramp.sbr_ok),
            on("SBR_BUSY", told.ramp.busy),
            int(
                "V_THRESHOLD",
                Unit::MillimetrePerMinute,
                told.ramp.v_threshold,
            ),
            int("POS_THRESHOLD", Unit::Millimetre, told.ramp.pos_threshold),
        ]);
    }
    if has(BRAKE_TEST) {
        let brake = &told.brake;
        all.extend([
            on("BT_TEST_REQ", brake.test_req),
            on("BT_BUSY", brake.busy),
            on(TEST_OK, brake.test_ok),
            on("BR_1_OK", brake.br_1_ok),
            on("BR_2_OK", brake.br_2_ok),
            on("OPEN_BR_1", brake.open_br_1),
            on("OPEN_BR_2", brake.open_br_2),
            int("S_STW3B", Unit::None, brake.stw.word().into()),
            on("RELEASE_DIR", brake.release_dir),
        ]);
    }
    if has(LOAD) {
        let (load, calibration) = (&told.load, &told.calibration);
        all.extend([
            on("STAT_LOAD_OK", load.stat_load_ok),
            on("DYN_LOAD_OK", load.dyn_load_ok),
            on("MIN_LOAD_OK", load.min_load_ok),
            on("LOAD_TEST_REQ", calibration.test_req),
            on("LOAD_BUSY", calibration.busy),
            on(MEASURES, calibration.test_ok),
        ]);
    }
    all.extend([
        int("SLS_LIMIT", Unit::MillimetrePerMinute, logic.sls_limit),
        on("SDI_POSITIVE", logic.sdi_positive),
        on("SDI_NEGATIVE", logic.sdi_negative),
        on("ACK_REQ", told.acknowledgeable()),
        on("ERROR", told.faulty()),
        name(
            "Safety.SLS.ActivationState",
            match (limited, told.keeps_limits()) {
                _ if !said.called => "NONE",
                (false, true) => "NONE",
                (true, true) => "SLS_ACTIVE",
                (_, false) => "SLS_ACTIVE_FAULTED",
            },
        ),
        counted("Safety.SLS.Limit", logic.sls_limit),
        name(
            "Safety.SLP.SelectionState",
            if ranged { "SELECTED_LIMIT_1" } else { "NONE" },
        ),
        counted(VELOCITY, pos.safe_v),
    ]);
    all
}
