//! The format of recordings: one JSON object a line.
//!
//! The first line is the header: format, version, machine, length of a cycle, signals with kind and unit. Each further line
//! is one cycle: its number, its time, and the signals that have changed; the first one tells all that is known, and
//! `null` says that a signal is not known any more. A cycle that is missing is like the one before it.

use std::collections::BTreeMap;
use std::io;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use stillpoint_lang::diag::{Diagnostics, Result};

use super::{Allowed, FORMAT, Kind, Recording, Role, Signal, Target, VERSION, Value};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    format: String,
    version: u64,
    machine: String,
    cycle_us: u64,
    signals: Vec<Declared>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Declared {
    name: String,
    kind: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    unit: String,
    role: String,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    cycle: u64,
    time_us: u64,
    signals: BTreeMap<String, serde_json::Value>,
}

/// Writes a recording.
///
/// # Errors
/// Of the writer.
pub fn write(recording: &Recording, out: &mut dyn io::Write) -> io::Result<()> {
    let declared = recording.signals.iter().map(|s| Declared {
        name: s.name.clone(),
        kind: s.kind.keyword().to_owned(),
        unit: s.unit.clone(),
        role: s.role.keyword().to_owned(),
    });
    let header = Header {
        format: FORMAT.to_owned(),
        version: VERSION,
        machine: recording.machine.clone(),
        cycle_us: recording.cycle_us,
        signals: declared.collect(),
    };
    serde_json::to_writer(&mut *out, &header)?;
    out.write_all(b"\n")?;
    for (n, row) in recording.rows.iter().enumerate() {
        let before = n.checked_sub(1).and_then(|n| recording.rows.get(n));
        let mut signals = BTreeMap::new();
        for (k, (signal, value)) in recording.signals.iter().zip(row).enumerate() {
            let unchanged = before.is_some_and(|b| b.get(k) == Some(value));
            // What is not known has no place in the first line, and from one with `null` on.
            let told = value.is_some() || before.is_some();
            if told && !unchanged {
                let value = value.as_ref().map_or(serde_json::Value::Null, to_json);
                signals.insert(signal.name.clone(), value);
            }
        }
        let cycle = recording.cycle(n);
        let line = Line {
            cycle,
            time_us: cycle.saturating_mul(recording.cycle_us),
            signals,
        };
        serde_json::to_writer(&mut *out, &line)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}

fn to_json(value: &Value) -> serde_json::Value {
    match value {
        Value::Bool(b) => (*b).into(),
        Value::Int(n) => (*n).into(),
        Value::Text(text) => text.as_ref().into(),
    }
}

/// Reads a recording of the machine `target`; `name` names the file in messages.
///
/// # Errors
/// The first thing that is wrong, with line, column and a fix.
pub fn read(name: &str, text: &Arc<str>, target: &Target<'_>) -> Result<Recording> {
    let reader = Reader { name, text, target };
    let mut lines = reader.lines();
    let (start, first) = lines.next().ok_or_else(|| {
        reader.fail(
            0..0,
            "this recording is empty",
            "its first line is the header",
        )
    })?;
    let header: Header = reader.parse(start, first, "the header of a recording")?;
    let mut recording = reader.header(start, first, header)?;
    let mut row: Vec<Option<Value>> = vec![None; recording.signals.len()];
    let places: BTreeMap<String, usize> = recording
        .signals
        .iter()
        .enumerate()
        .map(|(k, s)| (s.name.clone(), k))
        .collect();
    let mut next: Option<u64> = None;
    for (start, line) in lines {
        let at = start..start + line.len();
        let parsed: Line = reader.parse(start, line, "a cycle of a recording")?;
        reader.clock(&parsed, next, recording.cycle_us, at.clone())?;
        if next.is_none() {
            recording.first = parsed.cycle;
        }
        let missing = parsed.cycle - next.unwrap_or(parsed.cycle);
        let most = super::most_cycles(recording.signals.len());
        if (recording.rows.len() as u64).saturating_add(missing) >= most {
            let help = format!(
                "at most {most} cycles of these signals are read; cut the recording, or leave signals out"
            );
            return Err(reader.fail(at, "this recording is too long", &help));
        }
        recording.rows.extend((0..missing).map(|_| row.clone()));
        for (signal, value) in &parsed.signals {
            let Some(place) = places.get(signal) else {
                let message = format!("the header does not declare the signal \"{signal}\"");
                return Err(reader.fail(
                    reader.find(start, line, signal),
                    &message,
                    "declare it in the header, or remove it here",
                ));
            };
            let declared = &recording.signals[*place];
            if value.is_null() {
                row[*place] = None;
                continue;
            }
            let known = of_json(value, declared.kind).ok_or_else(|| {
                let message = format!("{signal} needs {}; got {value}", declared.kind.noun());
                let help = format!("the header declares it as {}", declared.kind.keyword());
                reader.fail(reader.find(start, line, signal), &message, &help)
            })?;
            if !declared.allowed.admits(&known) {
                let message = format!("{signal} cannot be {value}");
                let help = format!("allowed: {}", declared.allowed);
                return Err(reader.fail(reader.find(start, line, signal), &message, &help));
            }
            row[*place] = Some(known);
        }
        recording.rows.push(row.clone());
        next = parsed.cycle.checked_add(1);
    }
    if recording.rows.is_empty() {
        return Err(reader.fail(
            0..first.len(),
            "this recording has no cycle",
            "a line of a cycle is such as {\"cycle\":0,\"time_us\":0,\"signals\":{}}",
        ));
    }
    Ok(recording)
}

fn of_json(value: &serde_json::Value, kind: Kind) -> Option<Value> {
    match kind {
        Kind::Bool => value.as_bool().map(Value::Bool),
        Kind::Int => value.as_i64().map(Value::Int),
        Kind::Text => value
            .as_str()
            .map(|text| Value::Text(text.to_owned().into())),
    }
}

struct Reader<'a> {
    name: &'a str,
    text: &'a Arc<str>,
    target: &'a Target<'a>,
}

impl<'a> Reader<'a> {
    /// The lines that say something, with the place where each begins.
    fn lines(&self) -> impl Iterator<Item = (usize, &'a str)> {
        let mut at = 0;
        self.text.split_inclusive('\n').filter_map(move |line| {
            let start = at;
            at += line.len();
            let line = line.trim_end();
            (!line.is_empty()).then_some((start, line))
        })
    }

    fn fail(&self, at: std::ops::Range<usize>, message: &str, help: &str) -> Diagnostics {
        super::wrong(self.name, self.text, at, message, help)
    }

    /// Where a name stands in a line, else the line.
    fn find(&self, start: usize, line: &str, name: &str) -> std::ops::Range<usize> {
        match line.find(&format!("\"{name}\"")) {
            Some(at) => start + at..start + at + name.len() + 2,
            None => start..start + line.len(),
        }
    }

    fn parse<T: Deserialize<'a>>(&self, start: usize, line: &'a str, what: &str) -> Result<T> {
        serde_json::from_str(line).map_err(|error| {
            // Columns count bytes from 1.
            let at = start
                + error
                    .column()
                    .saturating_sub(1)
                    .min(line.len().saturating_sub(1));
            let text = error.to_string();
            let words = text.split(" at line ").next().unwrap_or(&text);
            let message = format!("not {what}: {words}");
            self.fail(
                at..at + 1,
                &message,
                "one JSON object a line, as `stillpoint simulate --trace` writes it",
            )
        })
    }

    fn header(&self, start: usize, line: &str, header: Header) -> Result<Recording> {
        let wrong = |name: &str, message: String, help: String| {
            Err(self.fail(self.find(start, line, name), &message, &help))
        };
        if header.format != FORMAT {
            let message = format!("the format is \"{}\"", header.format);
            return wrong("format", message, format!("this reads \"{FORMAT}\""));
        }
        if header.version != VERSION {
            let message = format!("the version of the format is {}", header.version);
            return wrong("version", message, format!("this reads version {VERSION}"));
        }
        let target = self.target;
        if header.machine != target.machine {
            let message = format!("this is a recording of the machine \"{}\"", header.machine);
            return wrong(
                "machine",
                message,
                format!("give its machine file; this one is of {}", target.machine),
            );
        }
        if header.cycle_us != target.cycle_us {
            let message = format!("the recording has cycles of {} us", header.cycle_us);
            let help = format!(
                "the machine file has cycles of {} us; both must be the same",
                target.cycle_us
            );
            return wrong("cycle_us", message, help);
        }
        let mut signals: Vec<Signal> = Vec::new();
        for declared in header.signals {
            if signals.iter().any(|s| s.name == declared.name) {
                let message = format!("the signal \"{}\" is declared twice", declared.name);
                return wrong(&declared.name, message, "remove one of them".to_owned());
            }
            let kinds = [Kind::Bool, Kind::Int, Kind::Text];
            let kind = kinds.into_iter().find(|k| k.keyword() == declared.kind);
            let roles = [Role::Input, Role::Output, Role::Plant];
            let role = roles.into_iter().find(|r| r.keyword() == declared.role);
            let (Some(kind), Some(role)) = (kind, role) else {
                let message = format!(
                    "the signal \"{}\" has kind \"{}\" and role \"{}\"",
                    declared.name, declared.kind, declared.role
                );
                let help = "allowed: kind bool, int, text; role input, output, plant".to_owned();
                return wrong(&declared.name, message, help);
            };
            let signal = Signal {
                allowed: match role {
                    Role::Plant => Allowed::All,
                    Role::Input | Role::Output => target.allowed(&declared.name),
                },
                name: declared.name,
                kind,
                unit: declared.unit,
                role,
            };
            if let Some((message, help)) = target.refuses(&signal) {
                return wrong(&signal.name, message, help);
            }
            signals.push(signal);
        }
        Ok(Recording {
            machine: header.machine,
            cycle_us: header.cycle_us,
            first: 0,
            signals,
            rows: Vec::new(),
        })
    }

    /// Cycles must rise, and times must be theirs.
    fn clock(
        &self,
        line: &Line,
        next: Option<u64>,
        cycle_us: u64,
        at: std::ops::Range<usize>,
    ) -> Result<()> {
        if let Some(next) = next.filter(|next| line.cycle < *next) {
            let message = format!("cycle {} comes after cycle {}", line.cycle, next - 1);
            return Err(self.fail(
                at,
                &message,
                &format!("cycles rise; at least {next} is allowed here"),
            ));
        }
        let time = line.cycle.checked_mul(cycle_us);
        if time != Some(line.time_us) {
            let message = format!("cycle {} has the time {} us", line.cycle, line.time_us);
            let right = time.map_or_else(
                || "a smaller cycle number".to_owned(),
                |t| format!("{t} us"),
            );
            return Err(self.fail(
                at,
                &message,
                &format!("in cycles of {cycle_us} us it is {right}"),
            ));
        }
        Ok(())
    }
}
