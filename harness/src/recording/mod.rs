//! Recordings: the signals of a machine, one cycle after the other, to be written, read and replayed.
//!
//! What the signals are called stands in [`vocabulary`]; [`ndjson`] writes and reads the format of its own, [`csv`] reads
//! tables of other tools by a map of their columns.

pub mod csv;
pub mod ndjson;
pub mod vocabulary;

use std::borrow::Cow;
use std::fmt;

/// The name of the format, in the first line of a file.
pub const FORMAT: &str = "stillpoint-trace";

/// The version of the format.
pub const VERSION: u64 = 1;

/// A value of a signal in a cycle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value {
    /// True or false.
    Bool(bool),
    /// A whole number of the signal's unit.
    Int(i64),
    /// A name.
    Text(Cow<'static, str>),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(true) => f.write_str("TRUE"),
            Self::Bool(false) => f.write_str("FALSE"),
            Self::Int(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// What the values of a signal are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// True or false.
    Bool,
    /// Whole numbers.
    Int,
    /// Names.
    Text,
}

impl Kind {
    /// The keyword of the format.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Int => "int",
            Self::Text => "text",
        }
    }

    /// With article, for messages.
    pub const fn noun(self) -> &'static str {
        match self {
            Self::Bool => "true or false",
            Self::Int => "a whole number",
            Self::Text => "a text",
        }
    }

    /// Whether a value is of this kind.
    pub const fn admits(self, value: &Value) -> bool {
        matches!(
            (self, value),
            (Self::Bool, Value::Bool(_))
                | (Self::Int, Value::Int(_))
                | (Self::Text, Value::Text(_))
        )
    }
}

/// What a signal is to the monitors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A monitor reads it.
    Input,
    /// A monitor writes it.
    Output,
    /// Neither: what the axis does, or what the safety logic sees. Not replayed.
    Plant,
}

impl Role {
    /// The keyword of the format.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Output => "output",
            Self::Plant => "plant",
        }
    }
}

/// A signal of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signal {
    /// Its full name: `X.nck.SGA_STOP_AB`.
    pub name: String,
    /// What its values are.
    pub kind: Kind,
    /// The unit of a number; else empty.
    pub unit: String,
    /// What it is to the monitors.
    pub role: Role,
}

/// The signals of a machine over consecutive cycles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recording {
    /// The machine it was made of.
    pub machine: String,
    /// The length of a cycle in microseconds.
    pub cycle_us: u64,
    /// The number of the first cycle.
    pub first: u64,
    /// The signals.
    pub signals: Vec<Signal>,
    /// For each cycle the values, in the order of the signals. None: the recording has not begun to tell it.
    pub rows: Vec<Vec<Option<Value>>>,
}

impl Recording {
    /// The place of a signal in each row.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.signals.iter().position(|s| s.name == name)
    }

    /// The values of a signal, by cycle.
    pub fn column(&self, signal: usize) -> impl Iterator<Item = Option<&Value>> {
        self.rows
            .iter()
            .map(move |row| row.get(signal).and_then(Option::as_ref))
    }

    /// The number of the cycle in a row.
    pub fn cycle(&self, row: usize) -> u64 {
        self.first.saturating_add(row as u64)
    }
}
