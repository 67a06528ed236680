//! The signals of an axis in a channel: what it reads of the machine, the F-CPU and the control.

use stillpoint_machine::Axis;
use stillpoint_monitors::sinamics::control_path::ControlPath;

use super::values::{self, BY_TELEGRAM, GEAR, MOTION, SBC, SBT, SDI, SLP, SS2E};
use crate::families::Port;
use crate::recording::vocabulary::Unit;
use crate::recording::{Allowed, Value};

/// An input that is true or false. Selections are bits of the safety telegram, 0 selects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flag {
    PowerOn,
    /// Drive and control have run up.
    PoweredUp,
    /// The terminal of this channel for the Basic Functions: 0 selects.
    Terminal,
    /// A valid safety telegram comes in this cycle, of PROFIsafe or of the TM54F.
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
    /// The increased tolerance of the gear: bit 27 of S_STW2.
    GearTolerance,
    /// The control declares the position: p9573 = 89.
    Declared,
    /// The user agreement of this channel: p9726 or p9740 is AC hex.
    Agrees,
    /// The general acknowledgement of faults.
    General,
    /// ON/OFF1.
    On,
    /// The switch of the brake in this channel does not follow.
    BrakeFault,
    /// The acceptance test mode is on.
    Acceptance,
    /// The test stop is asked for: p9705 or S_STW1B.8.
    TestStop,
    /// The switch-off path of this channel does not suppress the pulses.
    PathFault,
    /// S_STW3B: the brake test is selected.
    BrakeTest,
    /// A sequence of it is started.
    BrakeTestStart,
    /// Of brake 2.
    SecondBrake,
    /// With negative torque.
    NegativeTorque,
    /// Sequence 2.
    SecondSequence,
    /// The external brake reports closed.
    ExternalClosed,
    /// The encoder has failed.
    EncoderFault,
    /// Without encoder: the minimum current p9588 flows.
    Current,
    /// Without encoder: current and voltage agree on an actual value.
    Plausible,
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
const BESIDE: [Flag; 4] = [
    Flag::SlpRange,
    Flag::Retract,
    Flag::Ack,
    Flag::GearTolerance,
];

/// An input that is a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    /// The actual position of this channel.
    Position,
    /// The level of SLS, 0 to 3.
    Level,
    /// S_SLS_LIMIT_A.
    Limit,
    /// The gear stage, bits 24 to 26 of S_STW2.
    Stage,
}

/// An input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Input {
    Flag(Flag),
    Number(Number),
}

/// The position of the axis: without it nothing is replayed.
pub(super) const PLACE: &str = "position";

/// What an input needs: a function of the axis, or one of these.
const TERMINALS: &str = "terminals";
/// PROFIsafe, or DRIVE-CLiQ to a TM54F.
const LINK: &str = "link";
const SELECTED: &str = "bits";
/// Extended Functions that need an encoder, and what is read without one.
const ENCODER: &str = "encoder";
const BARE: &str = "no encoder";
/// An F-DI brings it, no telegram.
const RETRACTION: &str = "retraction";
/// The position is referenced, and the axis has a second brake.
const REFERENCED: &str = "referencing";
const EXTERNAL: &str = "external brake";

/// Every input: its name, and what it needs.
static INPUTS: [(Input, &str, &str); 38] = {
    use Flag::*;
    use Input::{Flag as F, Number as N};
    [
        (F(PowerOn), "power_on", ""),
        (F(PoweredUp), "powered_up", ""),
        (N(Number::Position), PLACE, ""),
        (F(Terminal), "terminal", TERMINALS),
        (F(Telegram), "telegram", LINK),
        (F(Sto), "STO", SELECTED),
        (F(Ss1), "SS1", SELECTED),
        (F(Ss2), "SS2", ENCODER),
        (F(Ss2e), "SS2E", SS2E),
        (F(Sos), "SOS", ENCODER),
        (F(Sls), "SLS", MOTION),
        (N(Number::Level), "SLS_level", MOTION),
        (N(Number::Limit), "S_SLS_LIMIT_A", BY_TELEGRAM),
        (F(SdiPositive), "SDI_positive", SDI),
        (F(SdiNegative), "SDI_negative", SDI),
        (F(Slp), "SLP", SLP),
        (F(SlpRange), "SLP_range_2", SLP),
        (F(Retract), "retract", RETRACTION),
        (F(Ack), "internal_event_ack", SELECTED),
        (N(Number::Stage), "gear_stage", GEAR),
        (F(GearTolerance), "gear_tolerance", GEAR),
        (F(Declared), "position_declared", REFERENCED),
        (F(Agrees), "user_agreement", REFERENCED),
        (F(General), "acknowledge", ""),
        (F(On), "ON", ""),
        (F(BrakeFault), "brake_fault", SBC),
        (F(Acceptance), "acceptance_mode", MOTION),
        (F(TestStop), "test_stop", MOTION),
        (F(PathFault), "path_fault", ""),
        (F(BrakeTest), "SBT_select", SBT),
        (F(BrakeTestStart), "SBT_start", SBT),
        (F(SecondBrake), "SBT_brake_2", EXTERNAL),
        (F(NegativeTorque), "SBT_negative", SBT),
        (F(SecondSequence), "SBT_sequence_2", SBT),
        (F(ExternalClosed), "external_brake_closed", EXTERNAL),
        (F(EncoderFault), "encoder_fault", ENCODER),
        (F(Current), "minimum_current", BARE),
        (F(Plausible), "plausible", BARE),
    ]
};

/// The inputs of an axis, in the order of its signals.
pub(super) fn inputs(axis: &Axis) -> Vec<Input> {
    let has = |needs: &str| match needs {
        "" => true,
        TERMINALS => values::enables(axis, ControlPath::terminals),
        LINK => values::enables(axis, ControlPath::profisafe) || values::tm54f(axis),
        SELECTED => values::bits(axis),
        ENCODER => values::extended(axis) && values::encoder(axis),
        BARE => values::extended(axis) && !values::encoder(axis),
        RETRACTION => values::slp(axis) && values::enables(axis, ControlPath::inputs),
        REFERENCED => values::referenced(axis),
        EXTERNAL => values::extended(axis) && values::external_brake(axis),
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
            Self::Number(Number::Stage) => within(Unit::None, 0, 7),
        }
    }
}

/// What a channel reads in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Read {
    /// Bit by bit.
    flags: u64,
    numbers: [i32; 4],
}

impl Read {
    /// Nothing is selected, everything is there, the drive is switched on.
    pub(super) fn at_rest(position: i32) -> Self {
        let there = [
            Flag::PoweredUp,
            Flag::Terminal,
            Flag::Telegram,
            Flag::On,
            Flag::Current,
            Flag::Plausible,
        ];
        Self::default()
            .flags(&there.map(|flag| (flag, true)))
            .flags(&SELECTING.map(|flag| (flag, true)))
            .number(Number::Position, position)
            .number(Number::Limit, i16::MAX.into())
    }

    /// An input that is true or false.
    pub(super) fn is(&self, flag: Flag) -> bool {
        self.flags >> flag as u32 & 1 == 1
    }

    fn put(&mut self, flag: Flag, on: bool) {
        let bit = 1 << flag as u32;
        self.flags = self.flags & !bit | u64::from(on) << flag as u32;
    }

    /// An input that is a number.
    pub(super) fn of(&self, number: Number) -> i32 {
        self.numbers[number as usize]
    }

    /// The same with flags set or not.
    pub(super) fn flags(mut self, given: &[(Flag, bool)]) -> Self {
        for (flag, on) in given {
            self.put(*flag, *on);
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
            self.put(bit, telegram.is(bit));
        }
        for number in [Number::Level, Number::Limit, Number::Stage] {
            self.numbers[number as usize] = telegram.of(number);
        }
        self
    }

    /// The same with everything at rest that is none of these inputs: the axis has no such signal.
    pub(super) fn only(&self, inputs: &[Input]) -> Self {
        let mut only = Self::at_rest(0);
        for input in inputs {
            match *input {
                Input::Flag(flag) => only.put(flag, self.is(flag)),
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
            (Input::Flag(flag), Value::Bool(on)) => self.put(flag, *on),
            (Input::Number(number), Value::Int(n)) => {
                self.numbers[number as usize] = i32::try_from(*n).unwrap_or(0);
            }
            _ => return false,
        }
        true
    }
}
