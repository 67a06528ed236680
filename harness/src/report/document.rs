//! The report as a document, for HTML and Markdown. It tells no times and no memory: equal input gives equal bytes.

use std::collections::BTreeMap;
use std::time::Instant;

use stillpoint_certify::format::Source;
use stillpoint_engine::check::{Checked, Settings, Summary, Violation, exit_status, violations};
use stillpoint_engine::lines;
use stillpoint_engine::readings::Compared;
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_lang::ir::Topic;
use stillpoint_model::{Options, Verdict};
use stillpoint_show::document::{Block, Document, Inline, Table, Tone};
use stillpoint_show::graph::Graph;

use super::{
    coarser, configuration, counted, counts, exploration, findings, grouped, inventory, properties,
    result, topics, values, word,
};
use crate::certificate::read_again;
use crate::guarantees::{answers, time, unasked};
use crate::states::{Budget, control_states};

/// Beyond this many cycles the control states of a system are not drawn, which would take longer than the check.
const BUDGET: Budget = Budget {
    generated: 40_000_000,
    interpreted: 4_000_000,
};

/// What a document tells beside the result of the check.
#[derive(Debug, Default)]
pub struct About {
    /// The files that were read, with their SHA-256.
    pub sources: Vec<Source>,
    /// For each task its machines' control states.
    pub control: Vec<Control>,
    /// The comparison of the readings, if it was made.
    pub readings: Option<Vec<Compared>>,
}

/// The control states of the machines of one system.
#[derive(Debug)]
pub enum Control {
    /// Machine instance and its states, for those that have any.
    Drawn(Vec<(String, Graph)>),
    /// Why they are not told.
    Omitted(String),
}

impl About {
    /// Collects what [`document`] needs for a checked subject.
    ///
    /// # Errors
    /// One sentence: files that cannot be read any more or have been changed during the check.
    pub fn of(
        subject: &Subject,
        checked: &[Checked],
        settings: &Settings,
        begin: &mut dyn FnMut(&Task),
    ) -> Result<Self, String> {
        // A product of a machine is no task of its file.
        let own = checked.iter().filter(|done| !done.product).count();
        let mut out = Self {
            sources: read_again(subject, &subject.tasks[..own])?.header.file,
            ..Self::default()
        };
        let start = Instant::now();
        for (task, done) in subject.tasks.iter().zip(checked) {
            begin(task);
            out.control.push(drawn(task, done, settings, start)?);
        }
        Ok(out)
    }
}

fn drawn(
    task: &Task,
    done: &Checked,
    settings: &Settings,
    start: Instant,
) -> Result<Control, String> {
    let report = &done.outcome.report;
    if done.product {
        let why = "not drawn, since its states were not enumerated";
        return Ok(Control::Omitted(why.to_owned()));
    }
    if !report.complete {
        let why = "not drawn, since a limit ended the exploration";
        return Ok(Control::Omitted(why.to_owned()));
    }
    let options = Options {
        limits: settings.limits(start),
        interrupt: settings.interrupt.clone(),
        ..Options::default()
    };
    let drawn = control_states(&task.bound, BUDGET, &options)
        .map_err(|e| format!("{}: control states: {e}", task.title))?;
    Ok(match drawn {
        Some(drawn) => Control::Drawn(drawn),
        None => Control::Omitted(
            "not drawn, since more cycles would have to be gone through once more than the limits allow; \
             stillpoint export --to dot draws them"
                .to_owned(),
        ),
    })
}

/// The whole report as a document.
pub fn document(
    subject: &Subject,
    checked: &[Checked],
    summaries: &[Summary],
    about: &About,
) -> Document {
    let mut blocks = vec![verdict(subject, checked, summaries)];
    blocks.push(figures(checked, summaries));
    let mut part = |title: &str, anchor: &str, inside: Vec<Block>| {
        if !inside.is_empty() {
            blocks.push(section(title, anchor, inside));
        }
    };
    part("This machine", "machine", guaranteed(subject, checked));
    part(
        "Counterexamples",
        "counterexamples",
        counterexamples(subject, checked),
    );
    part(
        "These values",
        "values",
        values::blocks(subject.machine.as_ref()),
    );
    part(
        "Configuration",
        "configuration",
        configuration::blocks(subject),
    );
    part(
        "Properties",
        "properties",
        properties::blocks(subject, checked),
    );
    part(
        "Single faults",
        "faults",
        topic(subject, checked, Topic::Fault),
    );
    part(
        "Reaction times",
        "reactions",
        topic(subject, checked, Topic::Reaction),
    );
    part(
        "Explorations",
        "explorations",
        exploration::blocks(subject, checked),
    );
    part(
        "Control states",
        "control-states",
        exploration::control(subject, &about.control),
    );
    part(
        "Rule coverage",
        "rule-coverage",
        exploration::coverage(subject, checked),
    );
    part(
        "Readings of the manual",
        "readings",
        readings(subject, about.readings.as_deref()),
    );
    if subject.machine.is_some() {
        part("Proofs of the monitors", "proofs", inventory::blocks());
    }
    part("Tool and input", "input", input(about));
    Document {
        title: format!("{}: report of the check", subject.name),
        subtitle: subject.title.clone(),
        blocks,
    }
}

pub(super) fn section(title: &str, anchor: &str, blocks: Vec<Block>) -> Block {
    Block::Section {
        title: title.to_owned(),
        anchor: anchor.to_owned(),
        blocks,
    }
}

pub(super) fn words(text: impl Into<String>) -> Vec<Inline> {
    vec![Inline::text(text)]
}

/// Ids in a row, each of them whole.
pub(super) fn ids(ids: &[String]) -> Vec<Inline> {
    let mut cell = Vec::new();
    for (k, id) in ids.iter().enumerate() {
        if k > 0 {
            cell.push(Inline::text(" "));
        }
        cell.push(Inline::Name(id.clone()));
    }
    cell
}

pub(super) fn code(text: impl Into<String>) -> Vec<Inline> {
    vec![Inline::code(text)]
}

pub(super) fn paragraph(text: impl Into<String>) -> Block {
    Block::Paragraph(words(text))
}

/// A table; the headings as in [`Column::new`](stillpoint_show::document::Column::new). A column with nothing in it is left out.
pub(super) fn table(heads: &[&str], rows: Vec<Vec<Vec<Inline>>>) -> Block {
    Table::new(heads, rows).without_empty_columns().into()
}

pub(super) fn badge(verdict: Verdict, excluded: bool) -> Vec<Inline> {
    let tone = match verdict {
        _ if excluded => Tone::Plain,
        Verdict::Holds | Verdict::Reached => Tone::Good,
        Verdict::Violated | Verdict::Unreachable => Tone::Bad,
        Verdict::Vacuous | Verdict::Inconclusive => Tone::Open,
    };
    vec![Inline::Badge(tone, word(verdict, excluded).to_owned())]
}

fn verdict(subject: &Subject, checked: &[Checked], summaries: &[Summary]) -> Block {
    let status = exit_status(summaries, checked);
    let tone = match status {
        0 if summaries.is_empty() => Tone::Plain,
        0 => Tone::Good,
        1 => Tone::Bad,
        _ => Tone::Open,
    };
    let counts = counts(summaries);
    let mut text = String::new();
    if !counts.is_empty() {
        let properties = counted(summaries.len() as u64, "property");
        text = format!("{properties}: {counts}. ");
    }
    let (whole, parts): (Vec<_>, Vec<_>) = checked.iter().partition(|c| c.product);
    let complete = |all: &[&Checked]| all.iter().all(|c| c.outcome.report.complete);
    text.push_str(match (complete(&parts), complete(&whole)) {
        (true, _) if whole.is_empty() => "Every reachable state was explored.",
        (true, true) => {
            "Every reachable state of the parts was explored; what they do together was judged by proof engines."
        }
        (true, false) => {
            "Every reachable state of the parts was explored; of what they do together not all was decided in time."
        }
        (false, _) => "Not every reachable state was explored: a limit was reached first.",
    });
    let findings = findings(subject, checked);
    if findings > 0 {
        let rules = counted(findings, "rule");
        text.push_str(&format!(
            " Finding: {rules} without effect, and nothing says why."
        ));
    }
    let mut pairs = subject.tasks.iter().zip(checked);
    if pairs.any(|(task, done)| coarser(task, done).next().is_some()) {
        text.push_str(
            " The explorations are coarser than the machine where their abstractions say so.",
        );
    }
    Block::Verdict {
        tone,
        head: result(subject, summaries, checked).to_owned(),
        text: words(text),
    }
}

fn figures(checked: &[Checked], summaries: &[Summary]) -> Block {
    let reports = || checked.iter().map(|c| &c.outcome.report);
    let figure = |n: u128, name: &str| (grouped(n), name.to_owned());
    let explored = checked.iter().filter(|done| !done.product).count();
    Block::Figures(vec![
        figure(summaries.len() as u128, "properties"),
        figure(explored as u128, "explorations"),
        figure(reports().map(|r| u128::from(r.states)).sum(), "states"),
        figure(reports().map(|r| r.transitions).sum(), "transitions"),
        figure(
            reports().map(|r| u128::from(r.depth)).max().unwrap_or(0),
            "cycles to the farthest state",
        ),
    ])
}

/// What the machine file asks of its machine, each with its answer.
pub fn guaranteed(subject: &Subject, checked: &[Checked]) -> Vec<Block> {
    let answers = answers(subject, checked);
    if answers.is_empty() {
        return unasked(subject).map(paragraph).into_iter().collect();
    }
    let rows = answers.iter().flat_map(|answer| {
        let mut before: Option<(&[String], String)> = None;
        answer.runs.iter().map(move |run| {
            // What several runs of a guarantee have in common is told with the first one.
            let values = run.told().collect::<Vec<_>>().join("\n");
            let faults = run.task.faults.as_slice();
            let (first, same_faults, same_values) = match &before {
                Some((f, v)) => (false, *f == faults && !f.is_empty(), *v == values),
                None => (true, false, false),
            };
            before = Some((faults, values.clone()));
            let guarantee = &answer.guarantee;
            let told = format!("{}\n{}", guarantee.text, guarantee.source);
            vec![
                code(&guarantee.name),
                badge(run.verdict, false),
                words(if first { told } else { String::new() }),
                words(&run.task.title),
                words(match same_faults {
                    true => "the same faults".to_owned(),
                    false => faults.join("\n"),
                }),
                words(run.bound.map_or_else(String::new, |b| {
                    format!("at most {}{}", time(b), run.travelled())
                })),
                words(match same_values {
                    true => "the same values".to_owned(),
                    false => values,
                }),
            ]
        })
    });
    let heads = [
        "guarantee",
        "verdict",
        "in plain words",
        "explored",
        "also after this fault",
        "tightest bound",
        "values it depends on",
    ];
    vec![table(&heads, rows.collect())]
}

fn counterexamples(subject: &Subject, checked: &[Checked]) -> Vec<Block> {
    let mut out = Vec::new();
    for (n, violation) in violations(subject, checked).iter().enumerate() {
        let mut inside = vec![paragraph(&violation.text)];
        inside.push(paragraph(format!("In: {}", violation.task.title)));
        for fault in &violation.task.faults {
            inside.push(paragraph(format!("After this fault: {fault}")));
        }
        if let Some(reason) = violation.refuted {
            inside.push(paragraph(reason));
        }
        if !violation.decisive.is_empty() {
            inside.push(paragraph("Each of these values decides it:"));
            let list = violation.decisive.iter();
            inside.push(Block::List(list.map(|d| words(d.text())).collect()));
        }
        let mark = format!("{} is violated here", violation.id);
        let runs = [violation.trace, violation.second];
        for (k, trace) in runs.into_iter().flatten().enumerate() {
            inside.push(paragraph(match k {
                0 => format!(
                    "The shortest run, {}:",
                    counted(trace.steps.len() as u64, "cycle")
                ),
                _ => "Against the run that differs only in the inputs named:".to_owned(),
            }));
            inside.push(properties::timing(
                subject,
                violation.task,
                trace,
                &mark,
                true,
            ));
        }
        inside.extend(program(violation));
        if violation.trace.is_none() && violation.refuted.is_none() {
            inside.push(paragraph("No run could be rebuilt within the limits."));
        }
        let anchor = format!("counterexample-{}", n + 1);
        out.push(section(&violation.id, &anchor, inside));
    }
    out
}

/// The lines of a program that decide the last cycle of a run.
fn program(violation: &Violation<'_>) -> Option<Block> {
    let (property, trace) = (violation.property?, violation.trace?);
    let lines = lines::deciding(&violation.task.bound, property, trace);
    let heading = lines::heading(&lines);
    let rows = lines.into_iter().map(|line| {
        vec![
            words(line.number.to_string()),
            code(line.value),
            code(line.text),
        ]
    });
    let rows: Vec<_> = rows.collect();
    let heads = ["#line", "value", &heading];
    (!rows.is_empty()).then(|| table(&heads, rows))
}

fn topic(subject: &Subject, checked: &[Checked], topic: Topic) -> Vec<Block> {
    let rows = topics::rows(subject, checked, topic);
    if rows.is_empty() {
        return Vec::new();
    }
    let cells = rows.iter().map(|row| {
        let verdict = match (topic, row.detected()) {
            (Topic::Fault, Some(false)) => {
                vec![Inline::Badge(Tone::Open, "undetected".to_owned())]
            }
            _ => badge(row.verdict, false),
        };
        let mut text = row.text.clone();
        if topic == Topic::Fault && row.detected() == Some(false) {
            text.push_str(": undetected until the next forced check");
        }
        let allowed = row.within.map_or(String::new(), |n| n.to_string());
        vec![
            code(&row.id),
            verdict,
            words(row.cycles()),
            words(row.time()),
            words(allowed),
            words(text),
            words(row.axes.join(", ")),
            ids(&row.req),
        ]
    });
    let what = match topic {
        Topic::Fault => "fault",
        Topic::Reaction => "reaction",
    };
    vec![table(
        &[
            "property",
            "verdict",
            "#cycles",
            "#time",
            "#allowed",
            what,
            "axes",
            "requirements",
        ],
        cells.collect(),
    )]
}

fn readings(subject: &Subject, compared: Option<&[Compared]>) -> Vec<Block> {
    let mut rows: Vec<(String, Vec<Vec<Inline>>)> = Vec::new();
    for task in &subject.tasks {
        let chosen: BTreeMap<String, String> = task.bound.readings().into_iter().collect();
        for reading in &task.bound.system.readings {
            if rows.iter().any(|(id, _)| *id == reading.id) {
                continue;
            }
            let option = chosen.get(&reading.id).map_or("", String::as_str);
            let others: Vec<&str> = reading
                .options
                .iter()
                .map(String::as_str)
                .filter(|o| *o != option)
                .collect();
            let mut row = vec![
                code(&reading.id),
                words(&reading.text),
                code(option),
                words(others.join(", ")),
            ];
            if let Some(compared) = compared {
                row.push(effect(compared, &reading.id));
            }
            rows.push((reading.id.clone(), row));
        }
    }
    if rows.is_empty() {
        return Vec::new();
    }
    let mut heads = vec!["reading", "what is ambiguous", "read as", "other options"];
    let mut out = vec![paragraph(match compared {
        Some(_) => "Each other option was explored as well; the last column tells what it changes.",
        None => {
            "Where the manual can be read in more than one way, one option was chosen. Which verdicts depend on that is \
             told by the same command with --readings all."
        }
    })];
    if compared.is_some() {
        heads.push("what the others change");
    }
    let rows = rows.into_iter().map(|(_, row)| row).collect();
    out.push(table(&heads, rows));
    out
}

/// What the other options of a reading change.
fn effect(compared: &[Compared], id: &str) -> Vec<Inline> {
    let mut lines = Vec::new();
    for c in compared.iter().filter(|c| c.reading == id) {
        let mut said: Vec<String> = c
            .changes
            .iter()
            .map(|(id, a, b)| format!("{id}: {a} → {b}"))
            .collect();
        if c.tasks == 0 {
            said.push("not used".to_owned());
        } else if said.is_empty() {
            said.push("no verdict".to_owned());
        }
        if !c.complete {
            said.push("not explored to the end".to_owned());
        }
        lines.push(format!("{}: {}", c.option, said.join("; ")));
    }
    words(lines.join("\n"))
}

fn input(about: &About) -> Vec<Block> {
    let rows = about.sources.iter();
    let rows = rows.map(|s| vec![code(&s.name), code(&s.sha256)]);
    vec![
        paragraph(format!("Made by stillpoint {}.", env!("CARGO_PKG_VERSION"))),
        table(&["file", "SHA-256"], rows.collect()),
        paragraph(
            "This report is no certificate of conformity. It tells what was explored; the chapter on limits in the \
             manual of Stillpoint tells what that means and what it does not.",
        ),
    ]
}
