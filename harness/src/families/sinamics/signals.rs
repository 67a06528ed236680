//! The signals of an axis in a channel: what it reads of the machine, the F-CPU and the control, and what its monitors tell.

use stillpoint_machine::Axis;
use stillpoint_monitors::sinamics::control_path::ControlPath;
use stillpoint_monitors::sinamics::level::{Function, Stop};
use stillpoint_monitors::sinamics::setpoint_limit::UNLIMITED;

use super::channel::Said;
use super::messages;
use super::values::{self, BY_TELEGRAM, MOTION, SBC, SDI, SLP, SS2E};
use crate::families::Port;
use crate::families::values::cell;
use crate::recording::vocabulary::{ALARMS, POSITION, STOP, Unit, VELOCITY};
use crate::recording::{Allowed, Value};

/// An input that is true or false. Selections are bits of the safety telegram, 0 selects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flag {
    PowerOn,
    /// Drive and control have run up.
    PoweredUp,
    /// The terminal of this channel for the Basic Functions: 0 selects.
    Terminal,
    /// A valid safety telegram comes in this cycle.
    Telegram,
    Sto,
    Ss1,
    Ss2,
    Ss2e,
    Sos,
    Sls,
    SdiPositive,
    SdiNegative,
    Slp,
    /// Range 2 of SLP.
    SlpRange,
    /// The retraction of SLP.
    Retract,
    /// Internal Event ACK.
    Ack,
    /// The axis is safely referenced.
    Referenced,
    /// The general acknowledgement of faults.
    General,
    /// ON/OFF1.
    On,
    /// The switch of the brake in this channel does not follow.
    BrakeFault,
    /// The acceptance test mode is on.
    Acceptance,
}

/// What selects a function with 0. It comes by the safety telegram.
const SELECTING: [Flag; 9] = [
    Flag::Sto,
    Flag::Ss1,
    Flag::Ss2,
    Flag::Ss2e,
    Flag::Sos,
    Flag::Sls,
    Flag::SdiPositive,
    Flag::SdiNegative,
    Flag::Slp,
];

/// What else comes by it. All of it is 0 where no telegram is valid.
const BESIDE: [Flag; 3] = [Flag::SlpRange, Flag::Retract, Flag::Ack];

/// An input that is a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    /// The actual position of this channel.
    Position,
    /// The level of SLS, 0 to 3.
    Level,
    /// S_SLS_LIMIT_A.
    Limit,
}

/// An input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Input {
    Flag(Flag),
    Number(Number),
}

/// The position of the axis: without it nothing is replayed.
pub(super) const PLACE: &str = "position";
/// Outputs that tell how a recording begins, and why a channel stops.
pub(super) const TORQUE: &str = "torque";
pub(super) const CAUSE: &str = "cause";

/// The latched stops, in rising order; F is beside the others and shown where there is none.
pub(super) const STOPS: [&str; 8] = ["NONE", "F", "E", "D", "C", "B", "A", "LOCKED"];

/// What an input needs: a function of the axis, or one of these.
const TERMINALS: &str = "terminals";
const PROFISAFE: &str = "PROFIsafe";
const SELECTED: &str = "bits";

/// Every input: its name, and what it needs.
static INPUTS: [(Input, &str, &str); 24] = {
    use Flag::*;
    use Input::{Flag as F, Number as N};
    [
        (F(PowerOn), "power_on", ""),
        (F(PoweredUp), "powered_up", ""),
        (N(Number::Position), PLACE, ""),
        (F(Terminal), "terminal", TERMINALS),
        (F(Telegram), "telegram", PROFISAFE),
        (F(Sto), "STO", SELECTED),
        (F(Ss1), "SS1", SELECTED),
        (F(Ss2), "SS2", MOTION),
        (F(Ss2e), "SS2E", SS2E),
        (F(Sos), "SOS", MOTION),
        (F(Sls), "SLS", MOTION),
        (N(Number::Level), "SLS_level", MOTION),
        (N(Number::Limit), "S_SLS_LIMIT_A", BY_TELEGRAM),
        (F(SdiPositive), "SDI_positive", SDI),
        (F(SdiNegative), "SDI_negative", SDI),
        (F(Slp), "SLP", SLP),
        (F(SlpRange), "SLP_range_2", SLP),
        (F(Retract), "retract", SLP),
        (F(Ack), "internal_event_ack", SELECTED),
        (F(Referenced), "referenced", SLP),
        (F(General), "acknowledge", ""),
        (F(On), "ON", ""),
        (F(BrakeFault), "brake_fault", SBC),
        (F(Acceptance), "acceptance_mode", MOTION),
    ]
};

/// The inputs of an axis, in the order of its signals.
pub(super) fn inputs(axis: &Axis) -> Vec<Input> {
    let has = |needs: &str| match needs {
        "" => true,
        TERMINALS => values::enables(axis, ControlPath::terminals),
        PROFISAFE => values::enables(axis, ControlPath::profisafe),
        SELECTED => values::bits(axis),
        function => {
            axis.has(function) && values::extended(axis) || function == SBC && axis.has(SBC)
        }
    };
    let known = INPUTS.iter().filter(|(.., needs)| has(needs));
    known.map(|(input, ..)| *input).collect()
}

impl Input {
    /// What it is called and what it may be.
    pub(super) fn port(self) -> Port {
        let name = INPUTS.iter().find(|(input, ..)| *input == self);
        let name = name.map_or("", |(_, name, _)| *name);
        let within = |unit, least: i64, most: i64| Port {
            allowed: Allowed::Between(least, most),
            ..Port::number(name, unit)
        };
        match self {
            Self::Flag(_) => Port::flag(name),
            Self::Number(Number::Position) => {
                within(Unit::Increment, i32::MIN.into(), i32::MAX.into())
            }
            Self::Number(Number::Level) => within(Unit::None, 0, 3),
            Self::Number(Number::Limit) => within(Unit::None, i16::MIN.into(), i16::MAX.into()),
        }
    }
}

/// What a channel reads in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Read {
    flags: [bool; 21],
    numbers: [i32; 3],
}

impl Read {
    /// Nothing is selected, everything is there, the drive is switched on.
    pub(super) fn at_rest(position: i32) -> Self {
        let there = [
            Flag::PoweredUp,
            Flag::Terminal,
            Flag::Telegram,
            Flag::Referenced,
            Flag::On,
        ];
        Self::default()
            .flags(&there.map(|flag| (flag, true)))
            .flags(&SELECTING.map(|flag| (flag, true)))
            .number(Number::Position, position)
            .number(Number::Limit, i16::MAX.into())
    }

    /// An input that is true or false.
    pub(super) fn is(&self, flag: Flag) -> bool {
        self.flags[flag as usize]
    }

    /// An input that is a number.
    pub(super) fn of(&self, number: Number) -> i32 {
        self.numbers[number as usize]
    }

    /// The same with flags set or not.
    pub(super) fn flags(mut self, given: &[(Flag, bool)]) -> Self {
        for (flag, on) in given {
            self.flags[*flag as usize] = *on;
        }
        self
    }

    /// The same with another number.
    pub(super) fn number(mut self, number: Number, value: i32) -> Self {
        self.numbers[number as usize] = value;
        self
    }

    /// The same with the bits of another telegram.
    pub(super) fn with_bits_of(mut self, telegram: &Self) -> Self {
        for bit in SELECTING.into_iter().chain(BESIDE) {
            self.flags[bit as usize] = telegram.is(bit);
        }
        for number in [Number::Level, Number::Limit] {
            self.numbers[number as usize] = telegram.of(number);
        }
        self
    }

    /// The same with everything at rest that is none of these inputs: the axis has no such signal.
    pub(super) fn only(&self, inputs: &[Input]) -> Self {
        let mut only = Self::at_rest(0);
        for input in inputs {
            match *input {
                Input::Flag(flag) => only.flags[flag as usize] = self.is(flag),
                Input::Number(number) => only.numbers[number as usize] = self.of(number),
            }
        }
        only
    }

    /// The value of an input.
    pub(super) fn get(&self, input: Input) -> Value {
        match input {
            Input::Flag(flag) => Value::Bool(self.is(flag)),
            Input::Number(number) => Value::Int(self.of(number).into()),
        }
    }

    /// Gives an input a value. False: it is none of its values.
    pub(super) fn set(&mut self, input: Input, value: &Value) -> bool {
        if !input.port().admits(value) {
            return false;
        }
        match (input, value) {
            (Input::Flag(flag), Value::Bool(on)) => self.flags[flag as usize] = *on,
            (Input::Number(number), Value::Int(n)) => {
                self.numbers[number as usize] = i32::try_from(*n).unwrap_or(0);
            }
            _ => return false,
        }
        true
    }
}

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
    if own(SLP) {
        all.extend([
            on("SLP_active", said.slp),
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
    all.push(on("internal_event", said.event));
    all
}

/// r9733 is used.
fn said_limits(axis: &Axis) -> bool {
    values::extended(axis) && cell(&axis.values, "p9533", 0) != 0
}
