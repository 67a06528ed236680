//! Timing diagrams: signals over cycles, as text.

use std::fmt::Write;

use stillpoint_spec::bind::Bound;
use stillpoint_spec::eval::UNSET;
use stillpoint_spec::ir::{LazyKind, Ty};

use crate::engine::{Cycle, lazy};

/// A signal over the cycles of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lane {
    /// Heading under which it stands.
    pub group: &'static str,
    /// Name.
    pub name: String,
    /// Drawn as a level instead of a value.
    pub level: bool,
    /// The value in each column; none where nothing read it, so that it may have any.
    pub values: Vec<Option<String>>,
}

/// Signals over cycles. Column 0 is the initial state, column k the k-th cycle.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Diagram {
    /// The signals.
    pub lanes: Vec<Lane>,
    /// Number of columns.
    pub columns: usize,
    /// Remarks under columns.
    pub marks: Vec<(usize, String)>,
    /// Column from which the run repeats for ever.
    pub loop_start: Option<usize>,
}

/// Columns that are drawn at most; a longer run is cut in its middle.
const MOST_COLUMNS: usize = 60;
/// Width of a page of columns in characters.
const PAGE: usize = 96;

impl Diagram {
    /// The diagram of a replayed run of a table: inputs that were read, state, outputs; constant ones left out.
    pub fn of_run(bound: &Bound, cycles: &[Cycle]) -> Self {
        let system = &bound.system;
        let mut lanes = Vec::new();
        let show = |ty: Ty, v: i32| (v != UNSET).then(|| system.show(ty, i64::from(v)));
        for (k, input) in system.inputs.iter().enumerate() {
            let values = cycles.iter().map(|c| show(input.ty, c.frame.inputs[k]));
            lanes.push(Lane {
                group: "inputs",
                name: input.name.clone(),
                level: input.ty == Ty::Bool,
                values: std::iter::once(None).chain(values).collect(),
            });
        }
        lanes.retain(|l| l.values.iter().any(Option::is_some));
        for (k, state) in system.states.iter().enumerate() {
            let first = cycles
                .first()
                .and_then(|c| show(state.var.ty, c.frame.before[k]));
            let values = cycles.iter().map(|c| show(state.var.ty, c.frame.now[k]));
            lanes.push(Lane {
                group: "state",
                name: state.var.name.clone(),
                level: state.var.ty == Ty::Bool,
                values: std::iter::once(first).chain(values).collect(),
            });
        }
        for (k, output) in system.lazies.iter().enumerate() {
            if output.kind != LazyKind::Output {
                continue;
            }
            let values = cycles
                .iter()
                .map(|c| lazy(bound, c, k).map(|v| system.show(output.ty, v)));
            lanes.push(Lane {
                group: "outputs",
                name: output.name.clone(),
                level: output.ty == Ty::Bool,
                values: std::iter::once(None).chain(values).collect(),
            });
        }
        lanes.retain(|l| l.group == "inputs" || l.changes());
        Self {
            lanes,
            columns: cycles.len() + 1,
            marks: Vec::new(),
            loop_start: None,
        }
    }

    /// The diagram as text.
    pub fn text(&self) -> String {
        let columns = self.folded();
        let name_width = self
            .lanes
            .iter()
            .map(|l| l.name.chars().count())
            .max()
            .unwrap_or(4)
            .max(5);
        let cell = self
            .lanes
            .iter()
            .filter(|l| !l.level)
            .flat_map(|l| l.values.iter().flatten())
            .map(|v| v.chars().count() + 1)
            .max()
            .unwrap_or(4)
            .clamp(4, 14);
        let per_page = ((PAGE.saturating_sub(name_width)) / cell).max(4);
        let mut out = String::new();
        for page in columns.chunks(per_page) {
            let _ = write!(out, "  {:name_width$} ", "cycle");
            for column in page {
                let head = match column {
                    Column::Cycle(k) if self.loop_start == Some(*k) => format!("{k}>>"),
                    Column::Cycle(k) => k.to_string(),
                    Column::Idle(n) => format!("+{n}"),
                };
                let _ = write!(out, "{head:<cell$}");
            }
            out.push('\n');
            let mut group = "";
            for lane in &self.lanes {
                if lane.group != group {
                    group = lane.group;
                    let _ = writeln!(out, "  {group}");
                }
                let _ = write!(out, "  {:name_width$} ", lane.name);
                for column in page {
                    out.push_str(&lane.cell(column, cell, page));
                }
                while out.ends_with(' ') {
                    out.pop();
                }
                out.push('\n');
            }
            for (k, mark) in &self.marks {
                if let Some(at) = page.iter().position(|c| *c == Column::Cycle(*k)) {
                    let _ = writeln!(
                        out,
                        "  {:name_width$} {:at$}^ {mark}",
                        "",
                        "",
                        at = at * cell
                    );
                }
            }
        }
        if let Some(k) = self.loop_start {
            let _ = writeln!(out, "  from cycle {k} (>>) on the run repeats for ever");
        }
        out
    }

    /// The columns drawn: stretches in which nothing changes are folded into one.
    fn folded(&self) -> Vec<Column> {
        let same = |a: usize, b: usize| {
            self.lanes
                .iter()
                .all(|l| l.values.get(a) == l.values.get(b))
        };
        let marked =
            |k: usize| self.marks.iter().any(|(m, _)| *m == k) || self.loop_start == Some(k);
        let mut out: Vec<Column> = Vec::new();
        for k in 0..self.columns {
            let idle =
                k > 1 && k + 1 < self.columns && !marked(k) && same(k, k - 1) && same(k, k + 1);
            match (idle, out.last_mut()) {
                (true, Some(Column::Idle(n))) => *n += 1,
                (true, _) => out.push(Column::Idle(1)),
                (false, _) => out.push(Column::Cycle(k)),
            }
        }
        if out.len() > MOST_COLUMNS {
            let cut = out.len() - MOST_COLUMNS;
            let half = MOST_COLUMNS / 2;
            let hidden: usize = out[half..half + cut + 1]
                .iter()
                .map(|c| match c {
                    Column::Cycle(_) => 1,
                    Column::Idle(n) => *n,
                })
                .sum();
            out.splice(half..half + cut + 1, [Column::Idle(hidden)]);
        }
        out
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Cycle(usize),
    Idle(usize),
}

impl Lane {
    fn changes(&self) -> bool {
        let mut seen = self.values.iter().flatten();
        let first = seen.next();
        seen.any(|v| Some(v) != first)
    }

    fn cell(&self, column: &Column, width: usize, page: &[Column]) -> String {
        let Column::Cycle(k) = column else {
            return format!("{:<width$}", "...");
        };
        let Some(value) = self.values.get(*k).and_then(Option::as_ref) else {
            return format!("{:<width$}", "·");
        };
        if self.level {
            let line = if value == "TRUE" { "▔" } else { "▁" };
            return line.repeat(width);
        }
        let fresh = *k == 0
            || self.values.get(k - 1) != self.values.get(*k)
            || page.first() == Some(column);
        if fresh {
            let cut: String = value.chars().take(width - 1).collect();
            format!("{cut:<width$}")
        } else {
            format!("{} ", "─".repeat(width - 1))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lane(name: &str, level: bool, values: &[&str]) -> Lane {
        Lane {
            group: "state",
            name: name.to_owned(),
            level,
            values: values
                .iter()
                .map(|v| (*v != "?").then(|| (*v).to_owned()))
                .collect(),
        }
    }

    #[test]
    fn draws_levels_values_and_marks() {
        let diagram = Diagram {
            lanes: vec![
                lane("on", true, &["?", "FALSE", "TRUE"]),
                lane("stop", false, &["NONE", "B", "B"]),
            ],
            columns: 3,
            marks: vec![(2, "here".to_owned())],
            loop_start: None,
        };
        assert_eq!(
            diagram.text(),
            "  cycle 0    1    2\n  state\n  on    ·    ▁▁▁▁▁▔▔▔▔▔\n  stop  NONE B    ────\n                  ^ here\n"
                .replace("2\n", "2    \n")
        );
    }

    #[test]
    fn folds_idle_stretches() {
        let values: Vec<&str> = std::iter::once("0")
            .chain(std::iter::repeat_n("1", 100))
            .collect();
        let diagram = Diagram {
            lanes: vec![lane("x", false, &values)],
            columns: values.len(),
            marks: Vec::new(),
            loop_start: None,
        };
        let text = diagram.text();
        assert!(text.contains("+98"), "{text}");
        assert!(text.lines().all(|l| l.chars().count() < 120));
    }
}
