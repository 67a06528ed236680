//! `check`: explores every task of a subject and judges its properties.

use indexmap::IndexMap;
use indexmap::map::Entry;
use stillpoint_lang::ir::Property;
use stillpoint_model::{Error, Progress, Trace, Verdict};

pub use crate::checked::{By, Checked, Unfired};
use crate::excluded::Decisive;
use crate::outcome::label;
pub use crate::settings::Settings;
use crate::subject::{Subject, Task};
use crate::tasks;

/// A verdict on one property id over all tasks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Summary {
    /// Property id, or the name of a guarantee.
    pub id: String,
    /// Whether it is a guarantee of the machine file; one may be named like a property.
    pub guarantee: bool,
    /// The worst verdict that says something.
    pub verdict: Verdict,
    /// Cycles of the shortest counterexample or witness.
    pub length: Option<u64>,
    /// Whether it is unreachable because the values of the machine exclude it, wherever it was looked for.
    pub excluded: bool,
}

impl Summary {
    /// A guarantee that nothing puts to the test: no answer to what the file asks.
    pub fn untested(&self) -> bool {
        self.guarantee && matches!(self.verdict, Verdict::Vacuous | Verdict::Unreachable)
    }
}

/// Checks all tasks. Where one holds loosely its system is the loose one afterwards.
///
/// # Errors
/// A system that cannot be explored at all, with the task's title.
pub fn check(
    subject: &mut Subject,
    settings: &Settings,
    progress: &mut (dyn FnMut(&Task) -> Box<dyn Progress> + Send),
) -> Result<Vec<Checked>, (String, Error)> {
    let machine = subject.machine.is_some();
    tasks::explore(&mut subject.tasks, machine, settings, progress)
}

/// Rank of a verdict when several runs are put together: what says most about a fault comes first.
fn rank(one: &Summary) -> u8 {
    // A property of the family is put to the test elsewhere, a guarantee of this machine nowhere else.
    if one.guarantee {
        return severity(one.verdict);
    }
    match one.verdict {
        Verdict::Violated => 6,
        Verdict::Unreachable if !one.excluded => 5,
        Verdict::Inconclusive => 4,
        Verdict::Holds | Verdict::Reached => 3,
        Verdict::Unreachable => 2,
        Verdict::Vacuous => 1,
    }
}

/// A guarantee is as good as the worst of what decides it; one that nothing has put to the test is not kept.
pub fn severity(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Violated => 4,
        Verdict::Unreachable => 3,
        Verdict::Vacuous => 2,
        Verdict::Inconclusive => 1,
        Verdict::Holds | Verdict::Reached => 0,
    }
}

/// One verdict for each property id and each guarantee, in the order in which they first occur.
pub fn summarise(subject: &Subject, checked: &[Checked]) -> Vec<Summary> {
    let mut all: IndexMap<(bool, String), Summary> = IndexMap::new();
    for (task, done) in subject.tasks.iter().zip(checked) {
        let guarantee = task.guarantee.is_some();
        let id = |otherwise: &str| task.guarantee.as_deref().unwrap_or(otherwise).to_owned();
        let properties = task.bound.system.properties.iter();
        let judgements = properties.zip(&done.outcome.report.properties);
        let judgements = judgements
            .enumerate()
            .map(|(k, (property, judged))| Summary {
                id: id(&property.id),
                guarantee,
                verdict: judged.verdict,
                length: judged.length,
                excluded: done.excluded.contains_key(&k),
            });
        let faults = done.outcome.report.faults.iter().map(|fault| Summary {
            id: id("range"),
            guarantee,
            verdict: Verdict::Violated,
            length: fault.length,
            excluded: false,
        });
        for new in judgements.chain(faults) {
            match all.entry((guarantee, new.id.clone())) {
                Entry::Vacant(free) => {
                    free.insert(new);
                }
                Entry::Occupied(mut old) => {
                    let shorter = rank(old.get()) == rank(&new)
                        && new.length.unwrap_or(u64::MAX) < old.get().length.unwrap_or(u64::MAX);
                    if rank(&new) > rank(old.get()) || shorter {
                        old.insert(new);
                    }
                }
            }
        }
    }
    all.into_values().collect()
}

/// Exit status for the verdicts: 1 violated (or a witness that must exist does not, though the values permit it, or nothing puts a
/// guarantee to the test), 3 inconclusive, 0 otherwise.
pub fn exit_status(summaries: &[Summary], checked: &[Checked]) -> u8 {
    let any = |v: Verdict| summaries.iter().any(|s| s.verdict == v && !s.excluded);
    if any(Verdict::Violated)
        || any(Verdict::Unreachable)
        || summaries.iter().any(Summary::untested)
    {
        1
    } else if any(Verdict::Inconclusive) || checked.iter().any(|c| !c.outcome.report.complete) {
        3
    } else {
        0
    }
}

/// A counterexample: which task, which property, and the run.
pub struct Violation<'a> {
    /// The task.
    pub task: &'a Task,
    /// Property id with the index of its copy.
    pub id: String,
    /// In plain words.
    pub text: String,
    /// The property; none for a value that left its range.
    pub property: Option<&'a Property>,
    /// The run.
    pub trace: Option<&'a Trace>,
    /// For a property of two runs, the second one.
    pub second: Option<&'a Trace>,
    /// How the report differs from what the property records.
    pub refuted: Option<&'a str>,
    /// Parameters that alone decide it, of a guarantee.
    pub decisive: &'a [Decisive],
}

/// All violations, in order.
pub fn violations<'a>(subject: &'a Subject, checked: &'a [Checked]) -> Vec<Violation<'a>> {
    let mut out = Vec::new();
    for (task, done) in subject.tasks.iter().zip(checked) {
        let judged = task
            .bound
            .system
            .properties
            .iter()
            .zip(&done.outcome.report.properties);
        for (k, (property, judged)) in judged.enumerate() {
            if judged.verdict == Verdict::Violated {
                out.push(Violation {
                    task,
                    id: task.guarantee.clone().unwrap_or_else(|| label(property)),
                    text: property.text.clone(),
                    property: Some(property),
                    trace: judged.trace.as_ref(),
                    second: done.outcome.pairs.get(&k).and_then(|p| p.second.as_ref()),
                    refuted: done.outcome.refuted.get(&k).map(String::as_str),
                    decisive: done.decisive.get(&k).map_or(&[], Vec::as_slice),
                });
            }
        }
        for fault in &done.outcome.report.faults {
            let site = task.bound.system.sites.get(fault.code as usize);
            out.push(Violation {
                task,
                id: "range".to_owned(),
                text: site.map_or("a value left its range".to_owned(), |s| {
                    format!("an assignment leaves the range of its variable: {}", s.name)
                }),
                property: None,
                trace: fault.trace.as_ref(),
                second: None,
                refuted: None,
                decisive: &[],
            });
        }
    }
    out
}
