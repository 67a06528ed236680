//! Recordings: the signals of a machine, one cycle after the other, to be written, read and replayed.
//!
//! What the signals are called stands in [`vocabulary`]; [`ndjson`] writes and reads the format of its own, [`csv`] reads
//! tables of other tools by a map of their columns.

pub mod csv;
pub mod ndjson;
pub mod vocabulary;

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use stillpoint_lang::diag::{Diagnostic, Diagnostics, nearest};

/// The name of the format, in the first line of a file.
pub const FORMAT: &str = "stillpoint-trace";

/// The version of the format.
pub const VERSION: u64 = 1;

/// No recording of a test run is that long; a longer one is a mistake.
const LONGEST: u64 = 1 << 30;

/// Reads the text of a recording.
///
/// # Errors
/// Not there, not readable, not a regular file, longer than 1 GiB, not UTF-8.
pub fn read_file(path: &Path) -> stillpoint_lang::diag::Result<Arc<str>> {
    let fail = |message: String, help: &str| {
        let name = path.display().to_string();
        Diagnostics::from(Diagnostic::new(&name, &Arc::from(""), None, message).help(help))
    };
    let cannot = |e: std::io::Error| {
        fail(
            format!("cannot read this recording: {e}"),
            "check the path and the permissions",
        )
    };
    let meta = std::fs::metadata(path).map_err(cannot)?;
    if !meta.is_file() {
        return Err(fail(
            "this is not a regular file".to_owned(),
            "name a recording (NDJSON or CSV)",
        ));
    }
    if meta.len() > LONGEST {
        return Err(fail(
            format!("{} bytes are too long for a recording", meta.len()),
            "at most 1 GiB is read; cut the recording",
        ));
    }
    let bytes = std::fs::read(path).map_err(cannot)?;
    let text = String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        fail(
            format!("the file is not UTF-8 at offset {at}"),
            "save it as UTF-8",
        )
    })?;
    Ok(text.trim_start_matches('\u{feff}').into())
}

/// What is wrong at a place of a recording. The place stands in the message: its lines are too long to be printed.
fn wrong(name: &str, text: &Arc<str>, at: Range<usize>, message: &str, help: &str) -> Diagnostics {
    let place = Diagnostic::new(name, text, Some(at), "");
    let file = match place.position() {
        Some((line, column)) => format!("{name}:{line}:{column}"),
        None => name.to_owned(),
    };
    Diagnostic::new(&file, &Arc::from(""), None, message)
        .help(help)
        .into()
}

/// Values that a recording may hold, of all signals and cycles: some 1 GiB of memory.
pub const MOST_VALUES: u64 = 30_000_000;

/// The cycles that a recording of so many signals may have.
pub fn most_cycles(signals: usize) -> u64 {
    MOST_VALUES / (signals as u64).max(1)
}

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

/// Which values of its kind a signal can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Allowed {
    /// All of them.
    All,
    /// Whole numbers from the first to the second.
    Between(i64, i64),
    /// These names.
    OneOf(&'static [&'static str]),
}

impl Allowed {
    /// Whether a value of the right kind is among them.
    pub fn admits(self, value: &Value) -> bool {
        match (self, value) {
            (Self::Between(least, most), Value::Int(n)) => (least..=most).contains(n),
            (Self::OneOf(names), Value::Text(text)) => names.contains(&text.as_ref()),
            _ => true,
        }
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all values of its kind"),
            Self::Between(least, most) => write!(f, "{least} to {most}"),
            Self::OneOf(names) => f.write_str(&names.join(", ")),
        }
    }
}

/// A signal of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signal {
    /// Its full name: `X.CHANNEL.SIGNAL`.
    pub name: String,
    /// What its values are.
    pub kind: Kind,
    /// The unit of a number; else empty.
    pub unit: String,
    /// What it is to the monitors.
    pub role: Role,
    /// The values that it can have.
    pub allowed: Allowed,
}

/// The machine that a recording must be of.
#[derive(Debug, Clone, Copy)]
pub struct Target<'a> {
    /// Its name.
    pub machine: &'a str,
    /// The length of its cycle in microseconds.
    pub cycle_us: u64,
    /// Its signals.
    pub signals: &'a [Signal],
}

impl Target<'_> {
    /// The values that a signal of this machine can have; all of them where it is none.
    pub fn allowed(&self, name: &str) -> Allowed {
        let known = self.signals.iter().find(|s| s.name == name);
        known.map_or(Allowed::All, |s| s.allowed)
    }

    /// Why a signal is none of this machine, with a fix. What no monitor reads or writes may be anything.
    pub fn refuses(&self, signal: &Signal) -> Option<(String, String)> {
        if signal.role == Role::Plant {
            return None;
        }
        let Some(known) = self.signals.iter().find(|s| s.name == signal.name) else {
            let names = self.signals.iter().filter(|s| s.role == signal.role);
            let help = match nearest(&signal.name, names.map(|s| s.name.as_str())) {
                Some(near) => {
                    format!("did you mean \"{near}\"? A signal of its own has the role plant")
                }
                None => {
                    "signals are named AXIS.CHANNEL.NAME; a signal of its own has the role plant"
                        .to_owned()
                }
            };
            let role = signal.role.keyword();
            return Some((
                format!("{} has no {role} \"{}\"", self.machine, signal.name),
                help,
            ));
        };
        let declared = |s: &Signal| (s.kind, s.unit.clone(), s.role);
        (declared(known) != declared(signal)).then(|| {
            let shown = |s: &Signal| {
                let unit = if s.unit.is_empty() {
                    String::new()
                } else {
                    format!(" in {}", s.unit)
                };
                format!("{} {}{unit}", s.role.keyword(), s.kind.keyword())
            };
            let message = format!(
                "the signal \"{}\" is declared as {}",
                signal.name,
                shown(signal)
            );
            (message, format!("it is {}", shown(known)))
        })
    }
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
