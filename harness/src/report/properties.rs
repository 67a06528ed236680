//! The properties of all runs, each told once.

use stillpoint_engine::check::Checked;
use stillpoint_engine::excluded::Exclusion;
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_lang::ir::Property;
use stillpoint_model::{Trace, Verdict};
use stillpoint_show::document::Block;

use super::document::{badge, code, ids, paragraph, table, words};
use super::{counted, diagram};

/// Copies of one property with one verdict.
pub(super) struct Row<'a> {
    pub(super) id: &'a str,
    pub(super) text: &'a str,
    /// The first copy.
    pub(super) property: &'a Property,
    pub(super) verdict: Verdict,
    /// Why the values of the machine exclude it: one sentence for each different reason.
    pub(super) excluded: Vec<String>,
    /// The runs (from 1) of which the same is told.
    runs: Vec<(Told, Vec<usize>)>,
    /// The shortest run that shows it, if one was kept, and the number of its task.
    pub(super) witness: Option<(usize, &'a Trace)>,
}

/// What is told of a run beside the verdict.
#[derive(PartialEq)]
enum Told {
    /// Cycles of the fastest reaction and of the least bound.
    Times(Option<u64>, Option<u64>),
    /// It is not explored there: it is a theorem.
    Theorem,
}

/// Every property once, with the runs in which it was judged; what is violated or open comes first.
pub(super) fn rows<'a>(subject: &'a Subject, checked: &'a [Checked]) -> Vec<Row<'a>> {
    // The same id may be stated differently in different systems: those are rows of their own.
    let mut rows: Vec<Row> = Vec::new();
    for (n, (task, done)) in subject.tasks.iter().zip(checked).enumerate() {
        let both = task
            .bound
            .system
            .properties
            .iter()
            .zip(&done.outcome.report.properties);
        for (k, (property, judged)) in both.enumerate() {
            let excluded = done.excluded.get(&k);
            let known = rows.iter_mut().find(|r| {
                (r.id, r.text, r.verdict) == (&property.id, &property.text, judged.verdict)
                    && r.excluded.is_empty() == excluded.is_none()
            });
            let row = match known {
                Some(row) => row,
                None => {
                    rows.push(Row {
                        id: &property.id,
                        text: &property.text,
                        property,
                        verdict: judged.verdict,
                        excluded: Vec::new(),
                        runs: Vec::new(),
                        witness: None,
                    });
                    let last = rows.len() - 1;
                    &mut rows[last]
                }
            };
            if let Some(reason) = excluded.map(Exclusion::text) {
                if !row.excluded.contains(&reason) {
                    row.excluded.push(reason);
                }
            }
            if let Some(trace) = &judged.trace {
                let shorter = |(_, t): &(usize, &Trace)| trace.steps.len() < t.steps.len();
                if row.witness.as_ref().is_none_or(shorter) {
                    row.witness = Some((n, trace));
                }
            }
            let told = match done.cited.contains(&k) {
                true => Told::Theorem,
                false => Told::Times(judged.fastest, judged.bound),
            };
            match row.runs.iter_mut().find(|(other, _)| *other == told) {
                Some((_, runs)) if runs.last() == Some(&(n + 1)) => {} // another copy of an index
                Some((_, runs)) => runs.push(n + 1),
                None => row.runs.push((told, vec![n + 1])),
            }
        }
    }
    rows.sort_by_key(|r| match r.verdict {
        Verdict::Violated | Verdict::Inconclusive => 0,
        Verdict::Unreachable if r.excluded.is_empty() => 0,
        Verdict::Unreachable => 2,
        _ => 1,
    });
    rows
}

impl Row<'_> {
    /// How fast it is and in which runs, if there are several: `in 1 to 3 cycles run 1, 2`.
    pub(super) fn told(&self, several: bool, between: &str) -> Vec<String> {
        let told = self.runs.iter().map(|(told, runs)| {
            let list: Vec<String> = runs.iter().map(usize::to_string).collect();
            let runs = if several {
                format!("run {}", list.join(", "))
            } else {
                String::new()
            };
            let cycles = match told {
                Told::Theorem => "theorem".to_owned(),
                Told::Times(Some(0), Some(0)) => "in the same cycle".to_owned(),
                Told::Times(Some(a), Some(b)) if a == b => format!("in {}", counted(*a, "cycle")),
                Told::Times(Some(a), Some(b)) => format!("in {a} to {b} cycles"),
                Told::Times(Some(a), None) => format!("in {} or more", counted(*a, "cycle")),
                Told::Times(None, Some(b)) => format!("within {}", counted(*b, "cycle")),
                Told::Times(None, None) => String::new(),
            };
            let both = !cycles.is_empty() && !runs.is_empty();
            format!("{cycles}{}{runs}", if both { between } else { "" })
        });
        told.filter(|t| !t.is_empty()).collect()
    }
}

/// The table of properties, as they are written, and the runs that show what must be reachable.
pub(super) fn blocks(subject: &Subject, checked: &[Checked]) -> Vec<Block> {
    let rows = rows(subject, checked);
    if rows.is_empty() {
        return vec![paragraph("No property is stated.")];
    }
    let several = subject.tasks.len() > 1;
    let cells = rows.iter().map(|row| {
        vec![
            code(row.id),
            badge(row.verdict, !row.excluded.is_empty()),
            words(
                [&[row.text.to_owned()], &row.excluded[..]]
                    .concat()
                    .join("\n"),
            ),
            words(row.told(several, ", ").join("\n")),
            ids(&row.property.req),
        ]
    });
    let mut out = vec![table(
        &[
            "property",
            "verdict",
            "in plain words",
            "how fast, where",
            "requirements",
        ],
        cells.collect(),
    )];
    let written = rows.iter().map(|row| {
        let parts = row.property.written.iter();
        let parts: Vec<String> = parts.map(|(key, text)| format!("{key}: {text}")).collect();
        vec![
            code(row.id),
            code(parts.join("\n")),
            words(&row.property.note),
        ]
    });
    out.push(Block::Details {
        summary: words("The properties as the specification states them"),
        blocks: vec![table(
            &["property", "statement", "remark"],
            written.collect(),
        )],
    });
    for row in rows.iter().filter(|r| r.verdict == Verdict::Reached) {
        let Some((task, trace)) = row
            .witness
            .and_then(|(n, t)| Some((subject.tasks.get(n)?, t)))
        else {
            continue;
        };
        out.push(Block::Details {
            summary: words(format!(
                "A run that shows {}, {} cycles: {}",
                row.id,
                trace.steps.len(),
                row.text
            )),
            blocks: vec![timing(
                subject,
                task,
                trace,
                &format!("{} is reached here", row.id),
                false,
            )],
        });
    }
    out
}

/// The timing diagram of a run of a task.
pub(super) fn timing(
    subject: &Subject,
    task: &Task,
    trace: &Trace,
    mark: &str,
    fault: bool,
) -> Block {
    let mut drawn = diagram(&task.bound, trace, mark);
    for mark in &mut drawn.marks {
        mark.fault = fault;
    }
    // A machine file may scale the times of a system down, so that a cycle has no length of its own.
    let scaled = subject.machine.is_some() && task.bound.system.scaled;
    drawn.cycle = (!scaled).then_some(task.bound.system.cycle_us);
    Block::Timing(Box::new(drawn))
}
