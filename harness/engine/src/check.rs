//! `check`: explores every task of a subject and judges its properties.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use indexmap::IndexMap;
use indexmap::map::Entry;
use stillpoint_lang::ir::Property;
use stillpoint_model::{
    Cluster, Error, Interrupt, Limits, Options, Progress, Trace, Until, Verdict,
};

use crate::excluded::{Decisive, Exclusion, Judge, decisive};
use crate::keep::Keep;
use crate::known::Known;
use crate::outcome::{Outcome, Reductions, label};
use crate::subject::{Subject, Task};
use crate::tasks::{self, Explored};
use crate::theorems::Theorems;

/// How to check.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Worker threads; 0 for all processors.
    pub threads: usize,
    /// Bytes for the explorer.
    pub memory: Option<u64>,
    /// Wall time for everything.
    pub time: Option<Duration>,
    /// Use the interpreter even where there is generated code.
    pub interpret: bool,
    /// Where to keep the explorations, so that the check can be continued.
    pub keep: Option<Keep>,
    /// Explore less where that keeps the verdicts.
    pub reductions: Reductions,
    /// Rebuild the runs that show what must be reachable, not only those that break a property.
    pub witnesses: bool,
    /// When an exploration ends; with [`Until::Violated`] what comes after the one that has found a violation is not explored.
    pub until: Until,
    /// Look for the parameters that decide a broken guarantee: an exploration for each of them.
    pub decisive: bool,
    /// The processes that explore together; none for this one alone.
    pub cluster: Option<Arc<Cluster>>,
    /// Ends everything from outside, as a limit would.
    pub interrupt: Option<Interrupt>,
    /// Explore nothing loosely, see [`crate::subject::Loose`].
    pub exact: bool,
    /// What other checks have explored, which need not be explored again; what this one explores is kept there.
    pub known: Option<Arc<Known>>,
    /// The theorems of the family, which need not be explored; none: all is explored.
    pub theorems: Option<Arc<Theorems>>,
}

impl Settings {
    /// The limits of what begins now, where `start` began the time.
    pub fn limits(&self, start: Instant) -> Limits {
        Limits {
            memory: self.memory,
            time: self.time.map(|t| t.saturating_sub(start.elapsed())),
            threads: self.threads,
        }
    }

    /// The settings for what follows, where `start` began the time.
    #[must_use]
    pub fn after(&self, start: Instant) -> Self {
        Self {
            time: self.limits(start).time,
            ..self.clone()
        }
    }

    /// Whether all was ended from outside.
    pub fn interrupted(&self) -> bool {
        self.interrupt.as_ref().is_some_and(Interrupt::is_raised)
    }
}

/// What exploring one task gave.
#[derive(Debug)]
pub struct Checked {
    /// The engine's outcome.
    pub outcome: Outcome,
    /// The same was explored before, in this check or another one, and the outcome is that one's.
    pub again: bool,
    /// Seconds from the begin of the check until its outcome was there; 0 where all is cited.
    pub ended: f64,
    /// Whether anything was explored: else all is known from theorems.
    pub explored: bool,
    /// Properties that are theorems of the family, by number: their verdict is no exploration's.
    pub cited: Vec<usize>,
    /// Rules that never fired: (name, why).
    pub unfired: Vec<(String, Unfired)>,
    /// Witnesses that the values of the machine exclude, by property number.
    pub excluded: BTreeMap<usize, Exclusion>,
    /// Parameters that alone decide that a guarantee is broken, by property number.
    pub decisive: BTreeMap<usize, Vec<Decisive>>,
}

/// Beyond this many states of a broken guarantee it is not asked which parameter decides.
const ASKED: u64 = 3_000_000;

/// Why a rule never fired.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unfired {
    /// No state and input can make it fire under these parameters.
    Parameters,
    /// The specification gives the reason.
    Explained(String),
    /// Nothing explains it: a finding.
    Unexplained,
    /// The exploration did not end.
    Unknown,
}

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

/// What is told of an explored task: where `options` are those with which it was explored.
pub(crate) fn told(
    task: &Task,
    mut explored: Explored,
    judge: Option<&Mutex<Judge>>,
    settings: &Settings,
    options: &Options,
) -> Result<Checked, Error> {
    let outcome = &mut explored.outcome;
    let unfired = match explored.cited.all {
        true => Vec::new(),
        false => unfired(task, outcome),
    };
    let excluded = match judge {
        Some(judge) => {
            let mut judge = judge.lock().unwrap_or_else(PoisonError::into_inner);
            judge.of(task, outcome, options, settings.interpret)?
        }
        None => BTreeMap::new(),
    };
    let mut decided = BTreeMap::new();
    let alone = settings.cluster.as_ref().is_none_or(|c| c.process() == 0);
    let asked = settings.decisive && task.guarantee.is_some() && alone;
    let judged = outcome.report.properties.iter().enumerate();
    let broken = judged.filter(|(_, j)| j.verdict == Verdict::Violated);
    for (k, _) in broken.filter(|_| asked && outcome.report.states <= ASKED) {
        decided.insert(k, decisive(task, k, options, settings.interpret)?);
    }
    Ok(Checked {
        outcome: explored.outcome,
        again: explored.again,
        ended: explored.ended,
        unfired,
        excluded,
        decisive: decided,
        explored: !explored.cited.all,
        cited: explored.cited.properties,
    })
}

/// How what begins now is explored, where `start` began the time.
pub(crate) fn options(settings: &Settings, start: Instant) -> Options {
    Options {
        limits: settings.limits(start),
        interrupt: settings.interrupt.clone(),
        // Most reports tell the length of a witness only; rebuilding their runs takes as long as the search.
        witnesses: settings.witnesses,
        until: settings.until,
        ..Options::default()
    }
}

fn unfired(task: &Task, outcome: &Outcome) -> Vec<(String, Unfired)> {
    let system = &task.bound.system;
    let mut out = Vec::new();
    if outcome
        .reduction
        .as_ref()
        .is_some_and(|r| r.whole.is_none())
    {
        // Slices and orbits tell nothing about rules.
        return out;
    }
    for (k, rule) in system.rules().enumerate() {
        if outcome.report.coverage.get(k).is_some_and(|n| *n > 0) {
            continue;
        }
        let general = match (rule.name.find('['), rule.name.find(']')) {
            (Some(a), Some(b)) => format!("{}{}", &rule.name[..a], &rule.name[b + 1..]),
            _ => rule.name.clone(),
        };
        let reason = system
            .unreached
            .iter()
            .find(|(n, _)| *n == rule.name || *n == general);
        let why = if task.analysis.dead.contains(&k) {
            Unfired::Parameters
        } else if let Some((_, reason)) = reason {
            Unfired::Explained(reason.clone())
        } else if outcome.report.complete {
            Unfired::Unexplained
        } else {
            Unfired::Unknown
        };
        out.push((rule.name.clone(), why));
    }
    out
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
