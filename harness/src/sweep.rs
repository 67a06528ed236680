//! For which values of one parameter the guarantees of a machine hold: the file is checked with other values in its place.
//!
//! A value is tested by exploring. Between two tested values with different answers the place of the change is sought by halves down to
//! the finest step; between two with equal answers nothing is tested, and the report says how many were.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use stillpoint_engine::check::{Settings, check, summarise};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_engine::verdict_name;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_machine::knob::{Knob, Range};
use stillpoint_machine::{self as machine, Machine};
use stillpoint_model::Verdict;

/// What a guarantee says with one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// The verdict.
    Found(Verdict),
    /// A machine file with this value is refused.
    Refused,
}

/// Values next to each other with the same answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Span {
    /// The least tested value.
    pub from: i64,
    /// The greatest tested value.
    pub to: i64,
    /// How many were tested.
    pub tested: usize,
    /// What they gave.
    pub answer: Answer,
}

/// The answers for one parameter.
#[derive(Debug)]
pub struct Swept {
    /// The parameter.
    pub knob: Knob,
    /// For each guarantee that the parameter could decide, the values in rising order.
    pub guarantees: Vec<(String, Vec<Span>)>,
    /// Why the first refused value is refused.
    pub refusal: Option<(i64, String)>,
}

/// The answers for one value: for each guarantee, or why the file is refused.
type Row = Result<BTreeMap<String, Verdict>, String>;

/// Sweeps the value `name` of the machine file at `path`.
///
/// # Errors
/// The file is wrong or has no guarantee, or gives no such value.
pub fn sweep(path: &Path, name: &str, settings: &Settings) -> Result<Swept, Failed> {
    let source = stillpoint_lang::read_text(path, "machine file")?;
    let families = machine::families(path);
    let load = |text: String| machine::load_bytes(path, text.into_bytes(), &families);
    let given = load(source.to_string())?;
    if given.guarantees.is_empty() {
        return Err(Failed::Other("this file asks nothing of the machine: a sweep tells for which values its guarantees hold".to_owned()));
    }
    let knob = given.knob(name).map_err(Failed::Other)?;
    // Most of what a value does not touch was explored with the value before.
    let settings = &Settings {
        known: Some(Arc::default()),
        ..settings.clone()
    };
    let mut rows: BTreeMap<i64, Row> = BTreeMap::new();
    let mut open: Vec<i64> = points(&knob);
    while let Some(value) = open.pop() {
        if rows.contains_key(&value) {
            continue;
        }
        let row = match load(knob.turned(&source, value)) {
            Ok(machine) => Ok(verdicts_of(path, machine, settings)?),
            Err(Diagnostics(list)) => {
                Err(list.first().map_or_else(String::new, |d| d.message.clone()))
            }
        };
        rows.insert(value, row);
        if open.is_empty() {
            open = changes(&knob, &rows);
        }
    }
    let refusal = rows
        .iter()
        .find_map(|(value, row)| Some((*value, row.as_ref().err()?.clone())));
    let names = given.guarantees.iter().map(|g| g.name.clone());
    Ok(Swept {
        guarantees: names
            .map(|name| (name.clone(), spans(&rows, &name)))
            .collect(),
        refusal,
        knob,
    })
}

/// Why nothing was swept.
#[derive(Debug)]
pub enum Failed {
    /// The machine file is wrong.
    Input(Diagnostics),
    /// Anything else.
    Other(String),
}

impl From<Diagnostics> for Failed {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Input(diagnostics)
    }
}

/// What the guarantees of a machine say.
fn verdicts_of(
    path: &Path,
    machine: Machine,
    settings: &Settings,
) -> Result<BTreeMap<String, Verdict>, Failed> {
    let mut runs = machine.runs.clone();
    runs.retain(|run| run.guarantee.is_some());
    let mut subject = subject::of_runs(path, machine, &runs, &Readings::new())?;
    let checked = check(&mut subject, settings, &mut |_| Box::new(()))
        .map_err(|(title, e)| Failed::Other(format!("{title}: {e}")))?;
    let summaries = summarise(&subject, &checked).into_iter();
    let mut found: BTreeMap<_, _> = summaries.map(|s| (s.id, s.verdict)).collect();
    // Nothing is said of what was not explored to its end.
    for (run, done) in runs.iter().zip(&checked) {
        let name = run
            .guarantee
            .as_ref()
            .filter(|_| !done.outcome.report.complete);
        match name.and_then(|name| found.get_mut(name)) {
            None | Some(Verdict::Violated) => {}
            Some(verdict) => *verdict = Verdict::Inconclusive,
        }
    }
    Ok(found)
}

/// What is tested first: all values of a choice; of a range its ends, the given value and others ever farther from it.
fn points(knob: &Knob) -> Vec<i64> {
    let (min, max, step) = match knob.range() {
        Range::All(values) => return values,
        Range::Between(min, max, step) => (min, max, step),
    };
    let mut points = BTreeSet::from([min, max, knob.given]);
    let mut distance = step;
    while distance <= max.saturating_sub(min) {
        points.extend([
            knob.given.saturating_sub(distance),
            knob.given.saturating_add(distance),
        ]);
        distance = distance.saturating_mul(4);
    }
    points.retain(|p| (min..=max).contains(p));
    points.into_iter().collect()
}

/// A value halfway between each two neighbours with different answers, where the step leaves one.
fn changes(knob: &Knob, rows: &BTreeMap<i64, Row>) -> Vec<i64> {
    let Range::Between(min, _, step) = knob.range() else {
        return Vec::new();
    };
    let pairs = rows.iter().zip(rows.iter().skip(1));
    let halves = pairs
        .filter(|((_, a), (_, b))| !same(a, b))
        .map(|((a, _), (b, _))| {
            let middle = a + (b - a) / 2;
            middle - (middle - min) % step
        });
    halves.filter(|m| !rows.contains_key(m)).collect()
}

/// Two files that are refused are alike, whatever for.
fn same(a: &Row, b: &Row) -> bool {
    match (a, b) {
        (Ok(a), Ok(b)) => a == b,
        (a, b) => a.is_err() == b.is_err(),
    }
}

/// Values next to each other with the same answer for a guarantee.
fn spans(rows: &BTreeMap<i64, Row>, name: &str) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for (value, row) in rows {
        let answer = match row {
            Ok(found) => Answer::Found(found.get(name).copied().unwrap_or(Verdict::Inconclusive)),
            Err(_) => Answer::Refused,
        };
        match spans.last_mut().filter(|last| last.answer == answer) {
            Some(last) => {
                last.to = *value;
                last.tested += 1;
            }
            None => spans.push(Span {
                from: *value,
                to: *value,
                tested: 1,
                answer,
            }),
        }
    }
    spans
}

impl Answer {
    fn word(self) -> &'static str {
        match self {
            Self::Found(verdict) => verdict_name(verdict),
            Self::Refused => "refused",
        }
    }
}

impl Swept {
    /// Whether every guarantee holds with the value that the file gives.
    pub fn holds(&self) -> bool {
        let given = self.knob.given;
        self.guarantees.iter().all(|(_, spans)| {
            let at = spans.iter().find(|s| (s.from..=s.to).contains(&given));
            at.is_some_and(|s| s.answer == Answer::Found(Verdict::Holds))
        })
    }

    /// As text: for each guarantee that the value decides where it holds, and which it does not decide.
    pub fn text(&self) -> String {
        let knob = &self.knob;
        let mut out = format!("{} = {}\n", knob.name, knob.show(knob.given));
        let (decided, other): (Vec<_>, Vec<_>) = self.guarantees.iter().partition(|(_, spans)| {
            let mut found = spans
                .iter()
                .map(|s| s.answer)
                .filter(|a| *a != Answer::Refused);
            let first = found.next();
            found.any(|a| Some(a) != first)
        });
        for (name, spans) in &decided {
            out.push_str(&format!("\n  {name}\n"));
            for span in spans {
                let (from, to) = (knob.show(span.from), knob.show(span.to));
                let range = match span.from == span.to {
                    true => from,
                    false => format!("{from} to {to}"),
                };
                let tested = match span.tested {
                    1 => "1 value".to_owned(),
                    n => format!("{n} values"),
                };
                out.push_str(&format!(
                    "    {:<12} {range} ({tested} tested)\n",
                    span.answer.word()
                ));
            }
        }
        if !other.is_empty() {
            let verdict = |spans: &[Span]| {
                let found = spans
                    .iter()
                    .map(|s| s.answer)
                    .find(|a| *a != Answer::Refused);
                found.map_or("refused", Answer::word)
            };
            let list = other
                .iter()
                .map(|(name, spans)| format!("{name} ({})", verdict(spans)));
            out.push_str(&format!(
                "\n  with every tested value the same: {}\n",
                list.collect::<Vec<_>>().join(", ")
            ));
        }
        if let Some((value, why)) = &self.refusal {
            out.push_str(&format!("\n  refused, {}: {why}\n", knob.show(*value)));
        }
        out
    }
}
