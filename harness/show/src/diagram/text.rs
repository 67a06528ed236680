//! Timing diagrams as text.

use std::fmt::Write;

use super::columns::Column;
use super::{Diagram, Lane};
use crate::number::{millis, trimmed};

/// Columns that are drawn at most; a longer run is cut in its middle.
const MOST_COLUMNS: usize = 60;
/// Width of a page of columns in characters.
const PAGE: usize = 96;

impl Diagram {
    /// The diagram as text: levels as lines, values where they change, remarks under their columns.
    pub fn text(&self) -> String {
        let columns = self.drawn(2, MOST_COLUMNS);
        let mut lanes = self.quantities();
        lanes.extend(self.lanes.iter().cloned());
        let names = lanes.iter().map(|l| l.name.chars().count());
        let name_width = names.max().unwrap_or(4).max(5);
        let cell = lanes
            .iter()
            .filter(|l| !l.level)
            .flat_map(|l| l.values.iter().flatten())
            .map(|v| v.chars().count() + 1)
            .max()
            .unwrap_or(4)
            .clamp(4, 14);
        let heads = columns.iter().map(|c| self.head(*c).chars().count() + 1);
        let cell = heads.max().unwrap_or(4).max(cell);
        let per_page = (PAGE.saturating_sub(name_width) / cell).max(4);
        let mut out = String::new();
        if !self.title.is_empty() {
            let _ = writeln!(out, "  {}", self.title);
        }
        for page in columns.chunks(per_page) {
            line(&mut out, name_width, "cycle", |out| {
                for column in page {
                    let _ = write!(out, "{:<cell$}", self.head(*column));
                }
            });
            let mut group = "";
            for lane in &lanes {
                if lane.group != group {
                    group = &lane.group;
                    let _ = writeln!(out, "  {group}");
                }
                line(&mut out, name_width, &lane.name, |out| {
                    for column in page {
                        out.push_str(&lane.cell(*column, cell, page.first() == Some(column)));
                    }
                });
            }
            for mark in &self.marks {
                let Some(n) = page.iter().position(|c| c.holds(mark.column)) else {
                    continue;
                };
                let place = match page[n] {
                    Column::Cycle(_) => String::new(),
                    _ => format!("cycle {}: ", mark.column),
                };
                line(&mut out, name_width, "", |out| {
                    let _ = write!(out, "{:at$}^ {place}{}", "", mark.text, at = n * cell);
                });
            }
        }
        if let Some(k) = self.loop_start {
            let _ = writeln!(out, "  from cycle {k} (>>) on the run repeats for ever");
        }
        if let Some(us) = self.cycle {
            let _ = writeln!(out, "  one cycle lasts {}", millis(us));
        }
        out
    }

    fn head(&self, column: Column) -> String {
        match column {
            Column::Cycle(k) if self.loop_start == Some(k) => format!("{k}>>"),
            Column::Cycle(k) => k.to_string(),
            Column::Idle { count, .. } | Column::Cut { count, .. } => format!("+{count}"),
        }
    }

    /// The curves as lanes of numbers.
    fn quantities(&self) -> Vec<Lane> {
        let panels = self.panels.iter();
        let curves = panels.flat_map(|p| p.curves.iter().map(move |c| (p, c)));
        curves
            .map(|(panel, curve)| Lane {
                group: format!("{} ({})", panel.name, panel.unit),
                name: curve.name.clone(),
                level: false,
                values: curve
                    .values
                    .iter()
                    .map(|v| v.map(|v| trimmed(v, 3)))
                    .collect(),
            })
            .collect()
    }
}

/// A line with a name before it and no spaces at its end.
fn line(out: &mut String, width: usize, name: &str, rest: impl FnOnce(&mut String)) {
    let mut text = format!("  {name:width$} ");
    rest(&mut text);
    out.push_str(text.trim_end());
    out.push('\n');
}

impl Lane {
    fn cell(&self, column: Column, width: usize, first: bool) -> String {
        let k = match column {
            Column::Cycle(k) => k,
            Column::Idle { first, .. } if self.level || self.same(first, first + 1) => first,
            Column::Idle { .. } | Column::Cut { .. } => return format!("{:<width$}", "..."),
        };
        let Some(value) = self.at(k) else {
            return format!("{:<width$}", "·");
        };
        if self.level {
            let line = if value == "TRUE" { "▔" } else { "▁" };
            return line.repeat(width);
        }
        if k == 0 || first || !self.same(k - 1, k) {
            let cut: String = value.chars().take(width - 1).collect();
            format!("{cut:<width$}")
        } else {
            format!("{} ", "─".repeat(width - 1))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Curve, Mark, Panel, Role};
    use super::*;

    fn lane(name: &str, level: bool, values: &[&str]) -> Lane {
        Lane {
            group: "state".to_owned(),
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
            marks: vec![Mark {
                column: 2,
                text: "here".to_owned(),
                fault: true,
            }],
            ..Diagram::default()
        };
        assert_eq!(
            diagram.text(),
            "  cycle 0    1    2\n  state\n  on    ·    ▁▁▁▁▁▔▔▔▔▔\n  stop  NONE B    ────\n                  ^ here\n"
        );
    }

    #[test]
    fn gathers_stretches_in_which_signals_stay_or_count() {
        let still: Vec<&str> = std::iter::once("0")
            .chain(std::iter::repeat_n("1", 100))
            .collect();
        let counted: Vec<String> = (0..101).map(|k: i32| (500 - k).to_string()).collect();
        let counted: Vec<&str> = counted.iter().map(String::as_str).collect();
        let diagram = Diagram {
            lanes: vec![lane("x", false, &still), lane("t", false, &counted)],
            columns: 101,
            ..Diagram::default()
        };
        assert_eq!(
            diagram.text(),
            "  cycle 0   1   +98 100\n  state\n  x     0   1   ─── ───\n  t     500 499 ... 400\n"
        );
    }

    #[test]
    fn a_run_that_never_rests_is_cut_in_its_middle() {
        let values: Vec<String> = (0..500_i32).map(|k| (k * k % 97).to_string()).collect();
        let values: Vec<&str> = values.iter().map(String::as_str).collect();
        let diagram = Diagram {
            lanes: vec![lane("x", false, &values)],
            columns: 500,
            ..Diagram::default()
        };
        let text = diagram.text();
        assert!(text.contains("+441"), "{text}");
        assert!(text.lines().all(|l| l.chars().count() < 120), "{text}");
    }

    #[test]
    fn quantities_stand_above_the_lanes() {
        let diagram = Diagram {
            columns: 2,
            cycle: Some(12_000),
            panels: vec![Panel {
                name: "speed".to_owned(),
                unit: "mm/min".to_owned(),
                curves: vec![Curve {
                    name: "actual".to_owned(),
                    role: Role::Actual,
                    values: vec![Some(0.0), Some(10.25)],
                }],
            }],
            ..Diagram::default()
        };
        assert_eq!(
            diagram.text(),
            "  cycle  0     1\n  speed (mm/min)\n  actual 0     10.25\n  one cycle lasts 12 ms\n"
        );
    }
}
