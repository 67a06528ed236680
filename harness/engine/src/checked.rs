//! What exploring a task has told, and what follows from it: rules that never fired, witnesses that the values exclude, parameters that
//! decide.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use stillpoint_model::{Error, Options, Verdict};

use crate::excluded::{Decisive, Exclusion, Judge, decisive};
use crate::outcome::Outcome;
use crate::settings::Settings;
use crate::subject::Task;
use crate::theorems::Cited;

/// The outcome of a task.
pub(crate) struct Answer {
    pub(crate) outcome: Outcome,
    /// It is the outcome of a task before it, or of another check.
    pub(crate) again: bool,
    /// Seconds from the begin of the check until its outcome was there; 0 where all is cited.
    pub(crate) ended: f64,
    pub(crate) cited: Cited,
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
    /// What its verdicts rest on.
    pub by: By,
    /// It is about a product of parts of the machine, too large to be explored, which is no system of its file.
    pub product: bool,
    /// Properties that are theorems of the family, by number: their verdict is no exploration's.
    pub cited: Vec<usize>,
    /// All its verdicts hold for the whole ranges of the parameters, whatever their values are.
    pub everywhere: bool,
    /// Rules that never fired: (name, why).
    pub unfired: Vec<(String, Unfired)>,
    /// Witnesses that the values of the machine exclude, by property number.
    pub excluded: BTreeMap<usize, Exclusion>,
    /// Parameters that alone decide that a guarantee is broken, by property number.
    pub decisive: BTreeMap<usize, Vec<Decisive>>,
}

/// What the verdicts about a task rest on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    /// All its states were enumerated; some properties may be theorems.
    Exploration,
    /// Theorems of the family alone.
    Theorems,
    /// Proof engines, which enumerate nothing.
    Proofs,
}

impl Checked {
    /// Whether states were enumerated.
    pub fn explored(&self) -> bool {
        self.by == By::Exploration
    }

    /// What is known of a product.
    pub fn of_product(outcome: Outcome, cited: Cited) -> Self {
        Checked {
            outcome,
            again: false,
            ended: 0.0,
            by: match cited.all {
                true => By::Theorems,
                false => By::Proofs,
            },
            product: true,
            everywhere: cited.everywhere,
            cited: cited.properties,
            unfired: Vec::new(),
            excluded: BTreeMap::new(),
            decisive: BTreeMap::new(),
        }
    }
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

/// What is told of a task; `options` are those with which it was explored.
pub(crate) fn told(
    task: &Task,
    mut answer: Answer,
    judge: Option<&Mutex<Judge>>,
    settings: &Settings,
    options: &Options,
) -> Result<Checked, Error> {
    let outcome = &mut answer.outcome;
    let unfired = match answer.cited.all {
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
        outcome: answer.outcome,
        again: answer.again,
        ended: answer.ended,
        unfired,
        excluded,
        decisive: decided,
        by: match answer.cited.all {
            true => By::Theorems,
            false => By::Exploration,
        },
        product: false,
        everywhere: answer.cited.everywhere,
        cited: answer.cited.properties,
    })
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
