//! The values of a machine file that are legal but unusual: a part of its own beside the verdicts, which it never changes.

use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_machine::warnings::Warning;
use stillpoint_machine::{Machine, Shown};
use stillpoint_show::document::{Block, Inline, Tone};

use super::document::{code, ids, paragraph, table, words};
use super::{counted, wrapped};

/// The warnings that nothing accepts.
pub fn unaccepted(machine: Option<&Machine>) -> usize {
    let all = machine.into_iter().flat_map(|m| &m.warnings);
    all.filter(|w| w.accepted.is_none()).count()
}

/// The part as text, empty where the family warns of nothing; `file` names the machine file.
pub fn text(machine: &Machine, file: &str) -> String {
    if !machine.is_warned_of() {
        return String::new();
    }
    let mut out = format!("These values: {}\n", summary(machine));
    let (accepted, open): (Vec<&Warning>, Vec<&Warning>) =
        machine.warnings.iter().partition(|w| w.accepted.is_some());
    for (n, warning) in open.iter().enumerate() {
        let same = |w: &&&Warning| w.id == warning.id;
        if open.iter().take(n).any(|w| same(&w)) {
            continue;
        }
        // The same about other axes stands together, with what they have in common told once.
        let all: Vec<&Warning> = open.iter().filter(same).copied().collect();
        out.push('\n');
        for alike in all.chunk_by(|a, b| a.text == b.text) {
            let of: Vec<&str> = alike.iter().map(|w| w.of.as_str()).collect();
            let Warning { id, text, .. } = alike[0];
            let head = format!("{}: {text} [{id}]", of.join("; "));
            wrapped(&mut out, "  warning: ", &head);
            for warning in alike {
                wrapped(&mut out, "    at:     ", &place(warning, file));
            }
        }
        wrapped(&mut out, "    why:    ", &warning.reason);
        wrapped(&mut out, "    better: ", &warning.better);
        wrapped(&mut out, "    source: ", &source(warning));
    }
    for warning in accepted {
        out.push('\n');
        let Warning { id, of, text, .. } = warning;
        wrapped(&mut out, "  accepted: ", &format!("{of}: {text} [{id}]"));
        wrapped(&mut out, "    at:     ", &place(warning, file));
        let reason = warning.accepted.as_deref().unwrap_or_default();
        wrapped(&mut out, "    reason: ", reason);
    }
    out
}

/// `2 warnings, 1 of them accepted`.
fn summary(machine: &Machine) -> String {
    let all = machine.warnings.len();
    let accepted = all - unaccepted(Some(machine));
    let head = match all {
        0 => "no warning".to_owned(),
        n => counted(n as u64, "warning"),
    };
    match accepted {
        0 => head,
        n if n == all => format!("{head}, accepted with reasons"),
        n => format!("{head}, {n} of them accepted with reasons"),
    }
}

/// `milling.toml:45:23, STANDSTILL_TOL = 100 mm, POS_TOL = 0.1 mm (default)`.
fn place(warning: &Warning, file: &str) -> String {
    let mut out = format!("{file}:{}:{}", warning.line, warning.column);
    for value in &warning.values {
        let _ = write!(out, ", {}", assigned(value));
    }
    out
}

fn assigned(value: &Shown) -> String {
    let default = if value.given { "" } else { " (default)" };
    format!("{} = {}{default}", value.name, value.value)
}

fn source(warning: &Warning) -> String {
    let ids = warning.req.join(" ");
    match (warning.source.as_str(), ids.as_str()) {
        ("", "") => "the values of the file".to_owned(),
        ("", ids) => format!("engineering, from the values of the file; {ids}"),
        (source, "") => source.to_owned(),
        (source, ids) => format!("{source}; {ids}"),
    }
}

/// The warnings as JSON.
pub fn to_json(machine: Option<&Machine>, file: &str) -> Value {
    let all = machine.into_iter().flat_map(|m| &m.warnings);
    let one = |w: &Warning| {
        let values = w.values.iter();
        let values = values.map(
            |v| json!({ "name": v.name, "manual": v.manual, "value": v.value, "given": v.given }),
        );
        json!({
            "id": w.id, "of": w.of, "file": file, "line": w.line, "column": w.column,
            "text": w.text, "reason": w.reason, "better": w.better, "source": w.source,
            "requirements": w.req, "values": values.collect::<Vec<_>>(), "accepted": w.accepted,
        })
    };
    all.map(one).collect()
}

/// The part of a document; nothing for a specification.
pub(super) fn blocks(machine: Option<&Machine>) -> Vec<Block> {
    let Some(machine) = machine.filter(|m| m.is_warned_of()) else {
        return Vec::new();
    };
    let head = format!(
        "{}. They say nothing about the properties, and change no verdict.",
        match summary(machine).as_str() {
            "no warning" => "No warning about the values of the machine file",
            other => other,
        }
    );
    let mut out = vec![paragraph(head)];
    let mut warnings: Vec<&Warning> = machine.warnings.iter().collect();
    warnings.sort_by_key(|w| w.accepted.is_some());
    if warnings.is_empty() {
        return out;
    }
    let rows = warnings.iter().map(|w| {
        let (tone, badge) = match w.accepted {
            Some(_) => (Tone::Plain, "accepted"),
            None => (Tone::Open, "warning"),
        };
        let mut what = words(format!("{}: {}", w.of, w.text));
        for value in &w.values {
            what.push(Inline::text("\n"));
            what.extend(code(assigned(value)));
        }
        let why = match &w.accepted {
            Some(reason) => format!("Accepted: {reason}\n{}", w.reason),
            None => format!("{}\nBetter: {}", w.reason, w.better),
        };
        let mut source = words(&w.source);
        if !w.source.is_empty() && !w.req.is_empty() {
            source.push(Inline::text("\n"));
        }
        source.extend(ids(&w.req));
        vec![
            vec![Inline::Badge(tone, badge.to_owned())],
            words(format!("{}:{}", w.line, w.column)),
            what,
            words(why),
            source,
            code(&w.id),
        ]
    });
    let heads = [
        "",
        "line",
        "what",
        "why, and what is better",
        "source",
        "name",
    ];
    out.push(table(&heads, rows.collect()));
    out
}
