//! The tables of a report: single faults and reaction times, from the properties that name a topic.

use serde_json::{Value, json};
use stillpoint_engine::check::Checked;
use stillpoint_engine::subject::Subject;
use stillpoint_engine::verdict_name;
use stillpoint_lang::ir::{Form, Topic};
use stillpoint_model::Verdict;

use super::words::wrapped;

/// One line of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Property id.
    pub id: String,
    /// In plain words.
    pub text: String,
    /// Where it stands in the manual.
    pub req: Vec<String>,
    /// The verdict.
    pub verdict: Verdict,
    /// Whether the property says that its case exists (`reachable`): for a fault, that nothing detects it.
    pub exists: bool,
    /// The fastest and the slowest reaction, in cycles.
    pub range: (Option<u64>, Option<u64>),
    /// The bound that must hold, in cycles.
    pub within: Option<u64>,
    /// Microseconds of a cycle; none where a machine file scales the times of the system.
    pub cycle_us: Option<u64>,
    /// The axes for which all this is so.
    pub axes: Vec<String>,
}

/// The lines of one table. Copies and runs with the same results share one.
pub fn rows(subject: &Subject, checked: &[Checked], topic: Topic) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for (task, done) in subject.tasks.iter().zip(checked) {
        let system = &task.bound.system;
        let judged = system
            .properties
            .iter()
            .zip(&done.outcome.report.properties);
        for (property, judged) in judged.filter(|(p, _)| p.topic == Some(topic)) {
            let within = match &property.form {
                Form::LeadsTo { within, .. } => within.as_ref(),
                _ => None,
            };
            let scaled = subject.machine.is_some() && system.scaled;
            let row = Row {
                id: property.id.clone(),
                text: property.text.clone(),
                req: property.req.clone(),
                verdict: judged.verdict,
                exists: matches!(property.form, Form::Reachable { .. }),
                range: (judged.fastest, judged.bound),
                within: within.and_then(|n| u64::try_from(task.bound.constant(n)).ok()),
                cycle_us: (!scaled).then_some(system.cycle_us),
                axes: Vec::new(),
            };
            let known = |r: &Row| {
                let axes = Vec::new();
                Row { axes, ..r.clone() } == row
            };
            let at = rows.iter().position(known).unwrap_or(rows.len());
            if at == rows.len() {
                rows.push(row);
            }
            for axis in &task.axes {
                if !rows[at].axes.contains(axis) {
                    rows[at].axes.push(axis.clone());
                }
            }
        }
    }
    rows
}

impl Row {
    /// Whether the fault of this line is detected; none if that is not known.
    pub(crate) fn detected(&self) -> Option<bool> {
        match self.verdict {
            Verdict::Reached if self.exists => Some(false),
            Verdict::Holds => Some(true),
            _ => None,
        }
    }

    pub(crate) fn cycles(&self) -> String {
        span(self.range, |cycles| cycles.to_string())
    }

    pub(crate) fn time(&self) -> String {
        match self.cycle_us {
            Some(us) => span(self.range, |cycles| time(cycles.saturating_mul(us))),
            None => String::new(),
        }
    }

    fn json(&self, topic: Topic) -> Value {
        let us = |cycles: Option<u64>| Some(cycles?.saturating_mul(self.cycle_us?));
        let (fastest, slowest) = self.range;
        let mut value = json!({
            "id": self.id, "text": self.text, "requirements": self.req, "axes": self.axes,
            "verdict": verdict_name(self.verdict), "fastest": fastest, "slowest": slowest,
            "fastest_us": us(fastest), "slowest_us": us(slowest), "allowed": self.within,
        });
        if topic == Topic::Fault {
            value["detected"] = json!(self.detected());
        }
        value
    }
}

/// `1 .. 2`, `3` where both ends are the same, `1 ..` where no bound holds.
fn span((fastest, slowest): (Option<u64>, Option<u64>), show: impl Fn(u64) -> String) -> String {
    match (fastest, slowest) {
        (Some(a), Some(b)) if a == b => show(a),
        (Some(a), Some(b)) => format!("{} .. {}", show(a), show(b)),
        (Some(a), None) => format!("{} ..", show(a)),
        (None, Some(b)) => format!(".. {}", show(b)),
        (None, None) => String::new(),
    }
}

/// Microseconds in milliseconds, with the decimals that are needed.
fn time(us: u64) -> String {
    let decimals = format!("{:03}", us % 1000);
    let decimals = decimals.trim_end_matches('0');
    let point = if decimals.is_empty() { "" } else { "." };
    format!("{}{point}{decimals} ms", us / 1000)
}

/// A table for readers; nothing if no property has the topic.
pub fn text(out: &mut String, subject: &Subject, checked: &[Checked], topic: Topic) {
    let rows = rows(subject, checked, topic);
    if rows.is_empty() {
        return;
    }
    out.push_str(match topic {
        Topic::Fault => "Single faults\n",
        Topic::Reaction => "Reaction times\n",
    });
    let heads = ["verdict", "cycles", "time", "allowed"].map(str::to_owned);
    let cells = |row: &Row| {
        let verdict = match (topic, row.detected()) {
            (Topic::Fault, Some(false)) => "undetected",
            _ => verdict_name(row.verdict),
        };
        let allowed = row.within.map_or(String::new(), |n| n.to_string());
        [verdict.to_owned(), row.cycles(), row.time(), allowed]
    };
    let mut table: Vec<_> = vec![(heads, "property".to_owned())];
    for row in &rows {
        let mut text = row.text.clone();
        if topic == Topic::Fault && row.detected() == Some(false) {
            text.push_str(": undetected until the next forced check");
        }
        let mut places = row.req.clone();
        if !row.axes.is_empty() {
            places.push(format!("axes {}", row.axes.join(" ")));
        }
        if !places.is_empty() {
            text = format!("{text} ({})", places.join(", "));
        }
        table.push((cells(row), format!("{}: {text}", row.id)));
    }
    let width = |column: usize| {
        let widths = table.iter().map(|(cells, _)| cells[column].chars().count());
        widths.max().unwrap_or(0)
    };
    let widths = [0, 1, 2, 3].map(width);
    for (cells, text) in &table {
        let mut head = String::from("  ");
        for (cell, width) in cells.iter().zip(widths) {
            if width > 0 {
                head.push_str(&format!("{cell:<width$}  "));
            }
        }
        wrapped(out, &head, text);
    }
    out.push('\n');
}

/// A table as JSON.
pub fn to_json(subject: &Subject, checked: &[Checked], topic: Topic) -> Value {
    let rows = rows(subject, checked, topic);
    rows.iter()
        .map(|row| row.json(topic))
        .collect::<Vec<_>>()
        .into()
}
