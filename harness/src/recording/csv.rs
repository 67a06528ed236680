//! Tables of other tools: a row a cycle, a column a signal, with a map from signals to column headings.
//!
//! The map is a TOML file with a heading for each signal, and the column of the cycle number or of the time:
//!
//! ```toml
//! cycle = "Cycle"                          # or: time_us, time_ms, time_s
//! [signals]
//! "X.CHANNEL.SIGNAL" = "a heading"
//! ```
//!
//! or the same on the command line: `cycle=Cycle,X.CHANNEL.SIGNAL=a heading`. Columns without a signal are not read.

use std::collections::BTreeMap;
use std::io;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result, nearest};
use stillpoint_lang::read_text;

use super::{Kind, Recording, Role, Target, Value};

/// Which column is the clock of the table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Clock {
    /// None: each row is the next cycle.
    #[default]
    Rows,
    /// The column with this heading has the number of the cycle.
    Cycle(String),
    /// The column with this heading has the time, in so many microseconds.
    Time(String, u64),
}

/// Where the signals stand in a table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Columns {
    /// The clock.
    pub clock: Clock,
    /// The heading of each signal.
    pub signals: BTreeMap<String, String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    cycle: Option<String>,
    time_us: Option<String>,
    time_ms: Option<String>,
    time_s: Option<String>,
    signals: BTreeMap<String, String>,
}

impl Columns {
    /// Reads the map at `path`.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn load(path: &Path) -> Result<Self> {
        let text = read_text(path, "column map")?;
        let name = path.display().to_string();
        let fail = |at: Option<Range<usize>>, message: String| {
            Diagnostics::from(
                Diagnostic::new(&name, &text, at, message)
                    .label("here")
                    .help(
                        "write cycle = \"HEADING\", then [signals] with \"SIGNAL\" = \"HEADING\"",
                    ),
            )
        };
        let file: File = toml::from_str(&text).map_err(|e| {
            fail(
                e.span(),
                format!("not a column map: {}", e.message().trim_end()),
            )
        })?;
        let clocks = [
            file.cycle.map(Clock::Cycle),
            file.time_us.map(|h| Clock::Time(h, 1)),
            file.time_ms.map(|h| Clock::Time(h, 1_000)),
            file.time_s.map(|h| Clock::Time(h, 1_000_000)),
        ];
        let mut clocks = clocks.into_iter().flatten();
        let clock = clocks.next().unwrap_or_default();
        if clocks.next().is_some() {
            return Err(fail(None, "this column map has two clocks".to_owned()));
        }
        Ok(Self {
            clock,
            signals: file.signals,
        })
    }

    /// The columns of a table whose headings are the names of signals, as `simulate --csv` writes it.
    pub fn by_name(text: &str, target: &Target<'_>) -> Self {
        let first = text.lines().next().unwrap_or("");
        let heading = cells(first, separator(first)).unwrap_or_default();
        let heading: Vec<String> = heading
            .into_iter()
            .flatten()
            .map(|cell| cell.text)
            .collect();
        let has = |name: &str| heading.iter().any(|h| h == name);
        let known = target.signals.iter().filter(|s| has(&s.name));
        Self {
            clock: match has("cycle") {
                true => Clock::Cycle("cycle".to_owned()),
                false => Clock::Rows,
            },
            signals: known.map(|s| (s.name.clone(), s.name.clone())).collect(),
        }
    }

    /// Reads `SIGNAL=HEADING,...` of the command line, for a recording of the machine `target`.
    ///
    /// # Errors
    /// A sentence that names the item.
    pub fn parse(text: &str, target: &Target<'_>) -> std::result::Result<Self, String> {
        let example = || {
            let mut inputs = target.signals.iter().filter(|s| s.role == Role::Input);
            inputs.next().map_or("SIGNAL", |s| s.name.as_str())
        };
        let mut columns = Self::default();
        for item in text.split(',') {
            let (signal, heading) = item
                .split_once('=')
                .map(|(a, b)| (a.trim(), b.trim().to_owned()))
                .filter(|(a, b)| !a.is_empty() && !b.is_empty())
                .ok_or_else(|| {
                    format!(
                        "`{item}` is no column; write SIGNAL=HEADING, e.g. {}=\"a heading\"",
                        example()
                    )
                })?;
            let clock = match signal {
                "cycle" => Some(Clock::Cycle(heading.clone())),
                "time_us" => Some(Clock::Time(heading.clone(), 1)),
                "time_ms" => Some(Clock::Time(heading.clone(), 1_000)),
                "time_s" => Some(Clock::Time(heading.clone(), 1_000_000)),
                _ => None,
            };
            match clock {
                Some(_) if columns.clock != Clock::Rows => {
                    return Err(format!(
                        "`{item}` is a second clock; give one of cycle, time_us, time_ms, time_s"
                    ));
                }
                Some(clock) => columns.clock = clock,
                None => {
                    if columns.signals.insert(signal.to_owned(), heading).is_some() {
                        return Err(format!("the signal `{signal}` is named twice"));
                    }
                }
            }
        }
        Ok(columns)
    }
}

/// Writes a recording as a table: cycle, time in microseconds, then a column for each signal by its name.
///
/// # Errors
/// Of the writer.
pub fn write(recording: &Recording, out: &mut dyn io::Write) -> io::Result<()> {
    write!(out, "cycle,time_us")?;
    for signal in &recording.signals {
        write!(out, ",{}", quoted(&signal.name))?;
    }
    writeln!(out)?;
    for (n, row) in recording.rows.iter().enumerate() {
        let cycle = recording.cycle(n);
        write!(out, "{cycle},{}", cycle.saturating_mul(recording.cycle_us))?;
        for value in row {
            let text = match value {
                Some(Value::Bool(b)) => u8::from(*b).to_string(),
                Some(other) => other.to_string(),
                None => String::new(),
            };
            write!(out, ",{}", quoted(&text))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r', ';']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

/// A cell of a table, with its place in the text.
struct Cell {
    text: String,
    at: Range<usize>,
}

/// Reads a table; `name` names the file in messages. Commas or semicolons separate the cells, as the heading does.
///
/// # Errors
/// The first thing that is wrong, with line, column and a fix.
pub fn read(
    name: &str,
    text: &Arc<str>,
    columns: &Columns,
    target: &Target<'_>,
) -> Result<Recording> {
    let fail = |at: Range<usize>, message: String, help: String| {
        super::wrong(name, text, at, &message, &help)
    };
    let first = text.lines().next().unwrap_or("");
    let mut rows = cells(text, separator(first))
        .map_err(|at| {
            fail(
                at,
                "this quotation mark is not closed".to_owned(),
                "close it, or double it within a text".to_owned(),
            )
        })?
        .into_iter();
    let heading = rows.next().unwrap_or_default();
    let place = |wanted: &str| {
        let found = heading.iter().position(|cell| cell.text == wanted);
        found.ok_or_else(|| {
            let known: Vec<&str> = heading.iter().map(|c| c.text.as_str()).collect();
            let help = match nearest(wanted, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("columns: {}", known.join(", ")),
            };
            fail(
                0..first.len(),
                format!("the table has no column \"{wanted}\""),
                help,
            )
        })
    };
    let clock = match &columns.clock {
        Clock::Rows => None,
        Clock::Cycle(heading) => Some((place(heading)?, None)),
        Clock::Time(heading, scale) => Some((place(heading)?, Some(*scale))),
    };
    let mut signals = Vec::new();
    let mut places = Vec::new();
    for (signal, heading) in &columns.signals {
        let Some(found) = target.signals.iter().find(|s| s.name == *signal) else {
            let help = match nearest(signal, target.signals.iter().map(|s| s.name.as_str())) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "signals are named AXIS.CHANNEL.NAME; the book lists the names".to_owned(),
            };
            let message = format!(
                "the column map names the signal \"{signal}\", which {} does not have",
                target.machine
            );
            return Err(fail(0..first.len(), message, help));
        };
        places.push(place(heading)?);
        signals.push(found.clone());
    }
    let mut recording = Recording {
        machine: target.machine.to_owned(),
        cycle_us: target.cycle_us,
        first: 0,
        signals,
        rows: Vec::new(),
    };
    for row in rows {
        let whole = row.first().map_or(0, |c| c.at.start)..row.last().map_or(0, |c| c.at.end);
        if row.len() != heading.len() {
            let message = format!(
                "this row has {} cells, the heading {}",
                row.len(),
                heading.len()
            );
            return Err(fail(
                whole,
                message,
                "give each column a cell; texts with a separator stand in quotation marks"
                    .to_owned(),
            ));
        }
        let cycle = match clock {
            None => recording.rows.len() as u64,
            Some((column, scale)) => {
                let cell = &row[column];
                cycle_of(&cell.text, scale, target.cycle_us)
                    .map_err(|(message, help)| fail(cell.at.clone(), message, help))?
            }
        };
        let next = recording.cycle(recording.rows.len());
        let most = super::most_cycles(recording.signals.len());
        if !recording.rows.is_empty() && cycle.saturating_sub(recording.first) >= most {
            let message = format!("cycle {cycle} is too far from the first one");
            let help = format!("at most {most} cycles of these signals are read; cut the table");
            return Err(fail(whole, message, help));
        }
        if recording.rows.is_empty() {
            recording.first = cycle;
        } else if cycle < next {
            let message = format!("cycle {cycle} comes after cycle {}", next - 1);
            return Err(fail(
                whole,
                message,
                "rows rise by a cycle at least".to_owned(),
            ));
        } else if let Some(last) = recording.rows.last().cloned() {
            recording.rows.extend((next..cycle).map(|_| last.clone()));
        }
        let mut values = Vec::new();
        for (signal, column) in recording.signals.iter().zip(&places) {
            let cell = &row[*column];
            let value = value_of(&cell.text, signal.kind).map_err(|allowed| {
                let message = format!(
                    "{} needs {}; got \"{}\"",
                    signal.name,
                    signal.kind.noun(),
                    cell.text
                );
                fail(cell.at.clone(), message, allowed.to_owned())
            })?;
            if value.as_ref().is_some_and(|v| !signal.allowed.admits(v)) {
                let message = format!("{} cannot be \"{}\"", signal.name, cell.text);
                let help = format!("allowed: {}", signal.allowed);
                return Err(fail(cell.at.clone(), message, help));
            }
            values.push(value);
        }
        recording.rows.push(values);
    }
    if recording.rows.is_empty() {
        return Err(fail(
            0..first.len(),
            "this table has no row".to_owned(),
            "the first line is the heading, each further one a cycle".to_owned(),
        ));
    }
    Ok(recording)
}

/// The cycle of a cell of the clock.
fn cycle_of(
    text: &str,
    scale: Option<u64>,
    cycle_us: u64,
) -> std::result::Result<u64, (String, String)> {
    let wrong = |what: &str| {
        (
            format!("\"{text}\" is no {what}"),
            "write a number such as 12".to_owned(),
        )
    };
    let Some(scale) = scale else {
        return text.trim().parse().map_err(|_| wrong("cycle number"));
    };
    // A decimal of at most six places is exact in microseconds of a second.
    let (whole, fraction) = text.trim().split_once('.').unwrap_or((text.trim(), ""));
    let digits = |t: &str| t.chars().all(|c| c.is_ascii_digit());
    let width = scale.ilog10() as usize;
    if whole.is_empty() || !digits(whole) || !digits(fraction) {
        return Err(wrong("time"));
    }
    let padded = format!("{:0<width$}", fraction.trim_end_matches('0'));
    if padded.len() > width {
        let help = "times are whole microseconds".to_owned();
        return Err((format!("\"{text}\" is finer than a microsecond"), help));
    }
    let part = if padded.is_empty() {
        Ok(0)
    } else {
        padded.parse::<u64>()
    };
    let (Ok(whole), Ok(part)) = (whole.parse::<u64>(), part) else {
        return Err(wrong("time"));
    };
    let us = whole
        .checked_mul(scale)
        .and_then(|us| us.checked_add(part))
        .ok_or_else(|| wrong("time"))?;
    if us % cycle_us != 0 {
        return Err((
            format!("\"{text}\" is no whole number of cycles of {cycle_us} us"),
            "give the column of the cycle number instead (cycle=HEADING), or record at the cycle of the machine".to_owned(),
        ));
    }
    Ok(us / cycle_us)
}

/// A cell as a value; empty: the signal is not told.
fn value_of(text: &str, kind: Kind) -> std::result::Result<Option<Value>, &'static str> {
    let text = text.trim();
    if text.is_empty() {
        return Ok(match kind {
            Kind::Text => Some(Value::Text("".into())),
            _ => None,
        });
    }
    match kind {
        Kind::Bool => match text.to_ascii_lowercase().as_str() {
            "1" | "true" => Ok(Some(Value::Bool(true))),
            "0" | "false" => Ok(Some(Value::Bool(false))),
            _ => Err("allowed: 0, 1, true, false; empty where it is not known"),
        },
        Kind::Int => match text.parse() {
            Ok(n) => Ok(Some(Value::Int(n))),
            Err(_) => {
                Err("allowed: whole numbers in the unit of the signal; empty where it is not known")
            }
        },
        Kind::Text => Ok(Some(Value::Text(text.to_owned().into()))),
    }
}

/// What separates the cells of a table with this heading.
fn separator(heading: &str) -> char {
    if heading.contains(';') { ';' } else { ',' }
}

/// The cells of all rows (RFC 4180); the place of a quotation mark that is not closed.
fn cells(text: &str, separator: char) -> std::result::Result<Vec<Vec<Cell>>, Range<usize>> {
    let mut rows = Vec::new();
    let mut row: Vec<Cell> = Vec::new();
    let mut cell = String::new();
    let mut start = 0;
    let mut opened: Option<usize> = None;
    let mut rest = text.char_indices().peekable();
    while let Some((at, c)) = rest.next() {
        if opened.is_some() {
            match c {
                '"' if rest.next_if(|(_, next)| *next == '"').is_some() => cell.push('"'),
                '"' => opened = None,
                other => cell.push(other),
            }
            continue;
        }
        match c {
            '"' if cell.is_empty() => opened = Some(at),
            '\r' => {}
            c if c == separator || c == '\n' => {
                row.push(Cell {
                    text: std::mem::take(&mut cell),
                    at: start..at,
                });
                start = at + c.len_utf8();
                if c == '\n' {
                    push_row(&mut rows, std::mem::take(&mut row));
                }
            }
            other => cell.push(other),
        }
    }
    if let Some(at) = opened {
        return Err(at..at + 1);
    }
    row.push(Cell {
        text: cell,
        at: start..text.len(),
    });
    push_row(&mut rows, row);
    Ok(rows)
}

/// A row that says something.
fn push_row(rows: &mut Vec<Vec<Cell>>, row: Vec<Cell>) {
    if row.len() > 1 || row.iter().any(|c| !c.text.trim().is_empty()) {
        rows.push(row);
    }
}
