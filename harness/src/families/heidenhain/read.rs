//! What a channel reads in a cycle: the inputs of the machine and of its axes, as a recording tells them.

use stillpoint_machine::Machine;
use stillpoint_monitors::heidenhain::types::Stop;

use super::names::{self, Bit};
use super::values;
use crate::recording::Value;

/// The code of `PP_AxGrpStopReq` that stands for every one that does not exist.
pub(super) const NO_CODE: u8 = u8::MAX;

/// What a channel reads of an axis. Positions are tenths of a micrometre, or ten-thousandths of a degree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct OfAxis {
    /// `PP_AxFeedEnable`; none: what the safe PLC program says.
    pub feed: Option<bool>,
    /// By its encoder.
    pub position: i64,
    /// Where the control wants it; none: where the channel sees it.
    pub nominal: Option<i64>,
    /// Its marks are passed.
    pub homed: bool,
    /// The permissive key by which a person confirms where it is.
    pub confirm: bool,
    /// The code of `PP_AxGrpStopReq`; none: what the safe PLC program asks for.
    pub stop: Option<u8>,
}

impl OfAxis {
    /// At rest: at zero, or at the limit position next to it; homed, and left to the program.
    pub(super) fn rest(machine: &Machine, axis: usize) -> Self {
        Self {
            feed: None,
            position: values::within(&machine.axes[axis], 0),
            nominal: None,
            homed: true,
            confirm: false,
            stop: None,
        }
    }

    /// Where the control wants it.
    pub(super) fn nominal(&self) -> i64 {
        self.nominal.unwrap_or(self.position)
    }

    /// Gives an input, by its place in [`names::AXIS_INPUTS`], a value. False: it is none of its values.
    pub(super) fn set(&mut self, input: usize, value: &Value) -> bool {
        let Some(port) = names::AXIS_INPUTS.get(input) else {
            return false;
        };
        if !port.admits(value) {
            return false;
        }
        match (port.name, value) {
            (names::FEED, Value::Bool(on)) => self.feed = Some(*on),
            (names::SEEN, Value::Int(tenths)) => self.position = *tenths,
            (names::NOMINAL, Value::Int(tenths)) => self.nominal = Some(*tenths),
            (names::HOMED, Value::Bool(on)) => self.homed = *on,
            (names::CONFIRMED, Value::Bool(on)) => self.confirm = *on,
            (names::ASKED, Value::Text(name)) => {
                let place = names::STOP_CODES.iter().position(|known| known == name);
                self.stop = place.map(|k| u8::try_from(k).unwrap_or(NO_CODE)).map(code);
            }
            _ => return false,
        }
        true
    }
}

/// The code of a place in [`names::STOP_CODES`].
fn code(place: u8) -> u8 {
    Stop::from_code(place).map_or(NO_CODE, |_| place)
}

/// What a channel reads.
#[derive(Clone, Debug)]
pub(super) struct Read {
    /// The inputs of the machine.
    pub bits: [bool; Bit::COUNT],
    /// Those of the axes.
    pub axes: Vec<OfAxis>,
}

impl Read {
    /// A machine that nobody touches: doors closed, no emergency stop, self-test passed, every axis at rest. `voltage`: the
    /// control voltage is latched.
    pub(super) fn rest(machine: &Machine, voltage: bool) -> Self {
        let mut bits = [false; Bit::COUNT];
        for bit in [Bit::Es, Bit::Sd, Bit::SdMagazine, Bit::Chain, Bit::GenSafe] {
            bits[bit as usize] = true;
        }
        bits[Bit::Cvo as usize] = voltage;
        let axes = 0..machine.axes.len();
        Self {
            bits,
            axes: axes.map(|k| OfAxis::rest(machine, k)).collect(),
        }
    }

    /// An input of the machine.
    pub(super) fn is(&self, bit: Bit) -> bool {
        self.bits[bit as usize]
    }
}
