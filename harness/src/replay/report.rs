//! A replay as report, as JSON, and its first divergence as timing diagram.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value as Json, json};
use stillpoint_show::diagram::{Diagram, Lane, Mark};

use super::{Column, Divergence, Replayed};
use crate::recording::{Kind, Recording, Role, Value};
use crate::report::grouped;

/// Cycles that are shown after the first divergence.
const AFTER: usize = 6;

/// Both sides up to the first divergence: the inputs of its axis that change, and every signal that differs by then.
pub(super) fn diagram(
    recording: &Recording,
    columns: &[Column],
    divergences: &[Divergence],
) -> Option<Diagram> {
    let first = divergences.first()?;
    let rows = (first.row + AFTER + 1).min(recording.rows.len());
    let shown = |values: Vec<Option<&Value>>| -> Vec<Option<String>> {
        values
            .into_iter()
            .map(|v| v.map(Value::to_string))
            .collect()
    };
    let lane = |group: &str, name: &str, kind: Kind, values: Vec<Option<&Value>>| Lane {
        group: group.to_owned(),
        name: name.to_owned(),
        level: kind == Kind::Bool,
        values: shown(values),
    };
    let axis = first.signal.split('.').next().unwrap_or("");
    let mut lanes = Vec::new();
    for (k, signal) in recording.signals.iter().enumerate() {
        let own = signal.name.split('.').next() == Some(axis);
        // Positions and speeds change in every cycle and say nothing here.
        if !own || signal.role != Role::Input || signal.kind == Kind::Int {
            continue;
        }
        let values: Vec<Option<&Value>> = recording.column(k).take(rows).collect();
        if values.iter().skip(1).any(|v| *v != values[1]) {
            lanes.push(lane("inputs", &signal.name, signal.kind, values));
        }
    }
    let near: Vec<&Divergence> = divergences.iter().filter(|d| d.row < rows).collect();
    let differs = |column: &Column, d: &Divergence| {
        recording.signals[column.signal].name == d.signal && column.against == d.against
    };
    let own: Vec<&Column> = columns
        .iter()
        .filter(|c| near.iter().any(|d| differs(c, d)))
        .collect();
    let mut told = Vec::new();
    for column in &own {
        let signal = &recording.signals[column.signal];
        if !told.contains(&column.signal) {
            told.push(column.signal);
            let values = recording.column(column.signal).take(rows).collect();
            lanes.push(lane("recorded", &signal.name, signal.kind, values));
        }
    }
    for column in &own {
        let signal = &recording.signals[column.signal];
        let values = column
            .values
            .iter()
            .take(rows)
            .map(Option::as_ref)
            .collect();
        lanes.push(lane(
            column.against.keyword(),
            &signal.name,
            signal.kind,
            values,
        ));
    }
    let mut order = vec!["inputs", "recorded"];
    order.extend([super::Against::Specification, super::Against::Monitors].map(|a| a.keyword()));
    lanes.sort_by_key(|l| order.iter().position(|g| *g == l.group));
    let marks = near.iter().map(|d| Mark {
        column: d.row,
        text: format!(
            "{}: recorded {}, {} {}",
            d.signal,
            d.recorded,
            d.against.keyword(),
            d.replayed
        ),
        fault: true,
    });
    Some(Diagram {
        title: String::new(),
        columns: rows,
        cycle: Some(recording.cycle_us),
        panels: Vec::new(),
        lanes,
        marks: marks.collect(),
        loop_start: None,
    })
}

impl Replayed {
    /// The report for readers.
    pub fn text(&self) -> String {
        let mut out = match self.divergences.len() {
            0 => format!(
                "NO DIVERGENCE (a recording, tolerance {})\n",
                cycles(self.tolerance.into())
            ),
            n => format!(
                "{n} DIVERGENCES (a recording, tolerance {})\n",
                cycles(self.tolerance.into())
            ),
        };
        let _ = writeln!(
            out,
            "{} of {}, {} outputs compared\n",
            cycles(self.cycles),
            self.machine,
            grouped(self.outputs_compared)
        );
        for axis in &self.axes {
            let _ = writeln!(
                out,
                "{}: {} recorded outputs; {} on the monitors, on the tables {} of {}",
                axis.name,
                axis.outputs,
                match self.channels {
                    1 => "the channel",
                    _ => "both channels",
                },
                grouped(axis.table_cycles.into()),
                cycles(self.channels as u64 * self.cycles)
            );
            if !axis.missing.is_empty() {
                let _ = writeln!(
                    out,
                    "  not recorded, taken as at rest: {}",
                    axis.missing.join(", ")
                );
            }
        }
        if !self.left_out.is_empty() {
            let _ = writeln!(
                out,
                "not replayed, without a position or without an output: {}",
                self.left_out.join(", ")
            );
        }
        for d in self.divergences.iter().take(MOST_LISTED) {
            let _ = writeln!(
                out,
                "cycle {}: {}: recorded {}, {} {}",
                d.cycle,
                d.signal,
                d.recorded,
                d.against.keyword(),
                d.replayed
            );
        }
        if self.divergences.len() > MOST_LISTED {
            let _ = writeln!(
                out,
                "and {} more, all later or in the same cycle",
                self.divergences.len() - MOST_LISTED
            );
        }
        if let Some(diagram) = &self.diagram {
            let _ = write!(out, "\nfirst divergence:\n{}", diagram.text());
        }
        out
    }

    /// The report as JSON.
    pub fn to_json(&self) -> Json {
        let number = |n: u128| u64::try_from(n).unwrap_or(u64::MAX);
        let value = |v: &Value| match v {
            Value::Bool(b) => json!(b),
            Value::Int(n) => json!(n),
            Value::Text(text) => json!(text),
        };
        let divergences = self.divergences.iter().map(|d| {
            json!({
                "cycle": d.cycle, "signal": d.signal, "against": d.against.keyword(),
                "recorded": value(&d.recorded), "replayed": value(&d.replayed),
            })
        });
        let axes: BTreeMap<&str, Json> = self
            .axes
            .iter()
            .map(|a| {
                let about = json!({
                    "outputs": a.outputs, "table_cycles": a.table_cycles, "missing_inputs": a.missing,
                });
                (a.name.as_str(), about)
            })
            .collect();
        json!({
            "machine": self.machine,
            "pairs": 0,
            "cycles": self.cycles,
            "outputs_compared": number(self.outputs_compared),
            "divergences": self.divergences.len(),
            "complete": true,
            "tolerance": self.tolerance,
            "axes": axes,
            "axes_not_replayed": self.left_out,
            "differences": divergences.collect::<Vec<_>>(),
            "diagram": self.diagram.as_ref().map(Diagram::text),
        })
    }
}

/// Divergences that the report lists.
const MOST_LISTED: usize = 20;

fn cycles(n: u64) -> String {
    match n {
        1 => "1 cycle".to_owned(),
        n => format!("{} cycles", grouped(n.into())),
    }
}
