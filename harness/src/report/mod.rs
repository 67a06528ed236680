//! The report of `check`: as text, as JSON, and as a document for HTML and Markdown.

mod configuration;
mod document;
mod exploration;
pub mod inventory;
mod json;
mod properties;
pub mod readings;
mod reduction;
mod text;
pub mod topics;
pub mod values;
mod words;

use std::collections::BTreeMap;

use stillpoint_engine::check::{By, Checked, Summary, Unfired, exit_status};
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_engine::{replay, verdict_name};
use stillpoint_lang::bind::Bound;
use stillpoint_model::{Storage, Trace, Verdict};
use stillpoint_show::diagram::{Diagram, Mark};

use crate::guarantees::unasked;
use crate::timing;

pub use document::{About, Control, document, guaranteed};
pub use json::{guarantees, to_json};
pub use text::{further, text};
pub(crate) use words::wrapped;
pub use words::{counted, grouped};

/// A verdict in a word for readers: as in JSON, but for a witness that the values exclude.
fn word(verdict: Verdict, excluded: bool) -> &'static str {
    match excluded {
        true => "excluded",
        false => verdict_name(verdict),
    }
}

/// Wall time of the explorations, some of which go on side by side.
fn seconds(checked: &[Checked]) -> f64 {
    checked.iter().map(|c| c.ended).fold(0.0, f64::max)
}

/// How many properties have which verdict, the ones to be looked at first: `1 violated, 3 holds`.
fn counts(summaries: &[Summary]) -> String {
    let order = [
        Verdict::Violated,
        Verdict::Unreachable,
        Verdict::Inconclusive,
        Verdict::Holds,
        Verdict::Reached,
        Verdict::Vacuous,
    ];
    let counts = order.into_iter().filter_map(|v| {
        let n = summaries.iter().filter(|s| s.verdict == v && !s.excluded);
        let n = n.count();
        (n > 0).then(|| format!("{n} {}", verdict_name(v)))
    });
    let excluded = summaries.iter().filter(|s| s.excluded).count();
    let excluded = (excluded > 0).then(|| format!("{excluded} excluded by your values"));
    counts.chain(excluded).collect::<Vec<_>>().join(", ")
}

/// How many properties are known from theorems alone, wherever they are judged.
fn cited(subject: &Subject, checked: &[Checked]) -> usize {
    let mut all = BTreeMap::new();
    for (task, done) in subject.tasks.iter().zip(checked) {
        let properties = task.bound.system.properties.iter().enumerate();
        for (k, property) in properties.filter(|_| task.guarantee.is_none()) {
            *all.entry(&property.id).or_insert(true) &= done.cited.contains(&k);
        }
    }
    all.into_values().filter(|cited| *cited).count()
}

/// Where the verdicts about a task are coarser than the machine. What holds for every value of the parameters holds for those of the machine too.
fn coarser<'a>(task: &'a Task, done: &Checked) -> impl Iterator<Item = &'a str> {
    let everywhere = done.everywhere;
    let all = task.abstractions.iter();
    all.filter(move |one| !(everywhere && one.of_values))
        .map(|one| one.text.as_str())
}

/// What of a run was not explored, as a sentence; empty if all was.
fn theorems(done: &Checked) -> String {
    let all = done.outcome.report.properties.len();
    match (done.by, done.cited.len()) {
        (By::Proofs, cited) => {
            let judged = done.outcome.report.properties.iter();
            let open = judged.filter(|one| one.verdict == Verdict::Inconclusive);
            let more = "--engine pdr --whole has more time";
            let open = match open.count() {
                0 if done.outcome.report.complete => String::new(),
                0 => format!("; whether a value leaves its range is not decided: {more}"),
                n => format!("; {n} not decided: {more}"),
            };
            let known = match cited {
                0 => String::new(),
                n if n == all => "all its properties are theorems of the family, ".to_owned(),
                n => format!("{n} of its {all} properties are theorems of the family, "),
            };
            let asked = match all - cited {
                0 => "whether a value leaves its range".to_owned(),
                n => counted(n as u64, "property"),
            };
            format!(
                "not explored: {known}{asked} asked of property-directed reachability, for all reachable states, in {:.2} s{open}",
                done.outcome.report.seconds
            )
        }
        (_, 0) => String::new(),
        (By::Theorems, _) => {
            "not explored: all its properties are theorems of the family".to_owned()
        }
        (By::Exploration, n) => format!("{n} of its {all} properties are theorems of the family"),
    }
}

/// The timing diagram of a run, with a mark at its last cycle.
pub fn diagram(bound: &Bound, trace: &Trace, mark: &str) -> Diagram {
    let cycles = replay(bound, trace);
    let mut diagram = timing::of_run(bound, &cycles);
    diagram.marks.push(Mark {
        column: cycles.len(),
        text: mark.to_owned(),
        fault: true,
    });
    // A loop starts with the step of that number, which makes the column after it.
    diagram.loop_start = trace.loop_start.map(|k| k + 1);
    diagram
}

/// Parameters with their values as a reader wants to see them, without the readings' options.
pub fn params(bound: &Bound) -> Vec<(String, String)> {
    let all = bound.system.params.iter().zip(&bound.values);
    all.filter(|(p, _)| p.reading.is_none())
        .map(|(p, v)| {
            (
                p.var.name.clone(),
                bound.system.show(p.var.ty, i64::from(*v)),
            )
        })
        .collect()
}

/// Whether less than the whole system was explored.
fn reduced(done: &Checked) -> bool {
    let reduction = done.outcome.reduction.as_ref();
    reduction.is_some_and(|r| r.whole.is_none())
}

/// The result in a few words.
fn result(subject: &Subject, summaries: &[Summary], checked: &[Checked]) -> &'static str {
    let broken = |s: &Summary| s.verdict == Verdict::Violated;
    match exit_status(summaries, checked) {
        0 if summaries.is_empty() => "EXPLORED, no property is stated",
        0 if unasked(subject).is_some() => {
            "NO GUARANTEE IS ASKED, the properties of its family hold"
        }
        0 if summaries.iter().any(|s| s.guarantee) => "ALL GUARANTEES HOLD",
        0 => "ALL PROPERTIES HOLD",
        1 if summaries.iter().any(|s| s.guarantee && broken(s)) => {
            "VIOLATED: a guarantee of this machine"
        }
        1 if !summaries.iter().any(broken) && summaries.iter().any(Summary::untested) => {
            "NOT SHOWN: nothing puts a guarantee of this machine to the test"
        }
        1 if !summaries.iter().any(broken) => "VIOLATED: a witness that must exist does not",
        1 => "VIOLATED",
        _ => "INCONCLUSIVE: a limit was reached first",
    }
}

/// How many rules of a specification never fire with nothing that says why: its author has to look at them. What the values of
/// a machine leave unused is no finding about the machine.
fn findings(subject: &Subject, checked: &[Checked]) -> u64 {
    if subject.machine.is_some() {
        return 0;
    }
    let unfired = checked.iter().flat_map(|c| &c.unfired);
    let unexplained = unfired.filter(|(_, u)| *u == Unfired::Unexplained);
    unexplained.count() as u64
}

/// How states were stored, in words.
fn storage_name(storage: Storage) -> &'static str {
    match storage {
        Storage::Bitmap => "exact bitmap",
        Storage::Hash64 | Storage::Hash128 => "exact hash set",
        Storage::Intervals => "intervals of a timer's values",
    }
}
