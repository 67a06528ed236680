//! Blocks that the control, its basic program or its manufacturer provides, as far as the safe logic calls them.

use super::Bit;
use super::ast::{Actual, Block, Call};
use super::operand::Area;

/// A block that does not stand in the file.
pub(super) struct Known {
    pub number: Block,
    /// Its usual symbol, in upper case.
    pub symbol: &'static str,
    /// The input that starts it; its outputs are 0 while it is 0.
    pub start: &'static str,
    /// Inputs, and beginnings of their names with a `*`.
    pub inputs: &'static [&'static str],
    pub outputs: &'static [&'static str],
    pub kind: Kind,
}

/// What is known of what a block does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// The safety relay.
    Relay,
    /// The brake test.
    BrakeTest,
    /// It transfers a byte to the NCK.
    Transfer,
    /// It changes nothing that the safe logic names.
    Silent,
    /// What it gives while it is started can be anything.
    Free,
}

pub(super) const KNOWN: [Known; 8] = [
    Known {
        number: Block::Fb(10),
        symbol: "SI_RELAY",
        start: "",
        inputs: &[
            "IN1",
            "IN2",
            "IN3",
            "QUIT1",
            "QUIT2",
            "TIMEVALUE1",
            "TIMEVALUE2",
            "TIMEVALUE3",
        ],
        outputs: &["OUT0", "OUT1", "OUT2", "OUT3", "FIRSTRUN"],
        kind: Kind::Relay,
    },
    Known {
        number: Block::Fc(21),
        symbol: "TRANSFER",
        start: "ENABLE",
        inputs: &["ENABLE", "FUNCT", "S7VAR", "IVAR1", "IVAR2"],
        outputs: &["ERROR", "ERRCODE"],
        kind: Kind::Transfer,
    },
    Known {
        number: Block::Fc(2),
        symbol: "GP_HP",
        start: "",
        inputs: &[],
        outputs: &[],
        kind: Kind::Silent,
    },
    Known {
        number: Block::Fb(4),
        symbol: "PI_SERV",
        start: "REQ",
        inputs: &["REQ", "PISERVICE", "UNIT", "ADDR*", "WVAR*"],
        outputs: &["ERROR", "DONE", "STATE"],
        kind: Kind::Free,
    },
    Known {
        number: Block::Fc(9),
        symbol: "ASUP",
        start: "START",
        inputs: &["START", "CHANNO", "INTNO"],
        outputs: &["ACTIV", "DONE", "ERROR", "STARTERR", "REF"],
        kind: Kind::Free,
    },
    Known {
        number: Block::Fb(11),
        symbol: "BRAKETEST",
        start: "START",
        inputs: &["START", "QUIT", "BCLOSED", "AXIS", "TIMERNO", "TV_*"],
        outputs: &["CLOSEBRAKE", "MOVEAXIS", "DONE", "ERROR", "STATE"],
        kind: Kind::BrakeTest,
    },
    Known {
        number: Block::Fc(18),
        symbol: "SPINCTRL",
        start: "START",
        inputs: &["START", "STOP", "FUNCT", "MODE", "AXISNO", "POS", "FRATE"],
        outputs: &["INPOS", "ERROR", "STATE"],
        kind: Kind::Free,
    },
    Known {
        number: Block::Fc(60),
        symbol: "TESTSTOP",
        start: "START",
        inputs: &["START", "RESET", "NUM_AXIS", "TEST_AXIS_*"],
        outputs: &["SERVO_TEST_OUT", "AUX_DWORD", "READY", "ERROR"],
        kind: Kind::Free,
    },
];

/// The known block of this number or symbol.
pub(super) fn known(block: &Block) -> Option<&'static Known> {
    KNOWN.iter().find(|known| match block {
        Block::Symbol(name) => known.symbol == name,
        other => known.number == *other,
    })
}

/// The data block of the first axis is that behind it.
const BEFORE_AXES: u16 = 30;

/// No control has more axes.
const MOST_AXES: i64 = 31;

/// What the brake test reads in the data block of its axis (S840D-BRAKE-708, S840D-BRAKE-710): controlled by the PLC, test active, the
/// traversing command in either direction, fixed stop reached. None: the call names no axis by its number.
pub(super) fn signals_of_axis(call: &Call) -> Option<[Bit; 5]> {
    let axis = call
        .params
        .iter()
        .find(|p| p.name.text.eq_ignore_ascii_case("AXIS"))?;
    let Actual::Int(number @ 1..=MOST_AXES) = axis.value else {
        return None;
    };
    let area = Area::Data(BEFORE_AXES + u16::try_from(number).ok()?);
    Some([(63, 1), (71, 0), (64, 6), (64, 7), (62, 5)].map(|(byte, bit)| Bit { area, byte, bit }))
}

impl Known {
    pub fn has_input(&self, name: &str) -> bool {
        self.inputs
            .iter()
            .any(|input| match input.strip_suffix('*') {
                Some(stem) => name.starts_with(stem),
                None => *input == name,
            })
    }

    pub fn has_output(&self, name: &str) -> bool {
        self.outputs.contains(&name)
    }

    /// Its parameters, for messages.
    pub fn params(&self) -> String {
        let all: Vec<&str> = self.inputs.iter().chain(self.outputs).copied().collect();
        all.join(", ")
    }
}
