//! Witnesses that the values of a machine exclude.
//!
//! A property `reachable` says that the tables can do something. A machine whose values never let them (one speed limit for all
//! stages, a function that is not enabled) does not break it: the tables keep their promise, the machine has no use for it.
//! Whether it is the values that exclude the witness is decided by exploring the same system as the family itself checks it,
//! with the defaults of its parameters: what is reached there and not here differs in nothing but the values. What is reached
//! in neither is an error of the tables and stays one.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use stillpoint_lang::bind::Bound;
use stillpoint_model::{Error, Form, Options, Property, Until, Verdict, explore};

use crate::outcome::Outcome;
use crate::subject::Task;
use crate::table::{Generated, Interpreted, properties};

/// Beyond this many states of the family's own configuration it is not asked which of the values decides.
const SMALL: u64 = 100_000;

/// So long at most the parameters are asked which of them breaks a property: with the value of the family the system may be of any size.
const MOST: Duration = Duration::from_secs(20);

/// Why a witness need not exist.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exclusion {
    /// The parameters that decide it: with the family's own values for all of them the witness exists. None of them can be
    /// left out, where [`exact`](Exclusion::exact) says so.
    pub by: Vec<Decisive>,
    /// Whether none of `by` can be left out; else they are all that differ from the family's own values.
    pub exact: bool,
}

/// A parameter of a system with a value that excludes a witness, or breaks a guarantee.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decisive {
    /// Its name in the specification.
    pub name: String,
    /// Its value here.
    pub value: String,
    /// A value with which the witness exists, or the guarantee holds.
    pub instead: String,
    /// Where it comes from: an expression over the parameters of the machine file.
    pub source: Option<String>,
}

impl Exclusion {
    /// `VELO_LIMIT (limit_1 = 0, with 3 reached)`.
    pub fn text(&self) -> String {
        let one = |d: &Decisive| {
            let value = format!("{} = {}, reached with {}", d.name, d.value, d.instead);
            match &d.source {
                Some(source) if *source != d.name => format!("{source} ({value})"),
                _ => value,
            }
        };
        let list: Vec<String> = self.by.iter().map(one).collect();
        format!("excluded by your values: {}", list.join("; "))
    }
}

/// The parameters that alone decide that a property is broken: with the family's own value of any of them, and all others as they are,
/// it holds. What the machine file cannot change is not among them, as the times of a program, nor is what does not show within [`MOST`].
///
/// # Errors
/// A system that cannot be explored.
pub fn decisive(
    task: &Task,
    property: usize,
    options: &Options,
    interpret: bool,
) -> Result<Vec<Decisive>, Error> {
    let end = Instant::now() + options.limits.time.unwrap_or(MOST).min(MOST);
    let mut options = Options {
        witnesses: false,
        until: Until::Decided,
        checkpoint: None,
        ..options.clone()
    };
    let candidates = differing(&task.bound);
    let mut found = Vec::new();
    for (n, candidate) in candidates.iter().enumerate() {
        let source = task.sources.get(&candidate.name).map_or("", String::as_str);
        let is_time = source.starts_with("T#");
        if is_time || matches!(source, "" | "TRUE" | "FALSE") {
            continue;
        }
        let Some(other) = with(&task.bound, &candidates, &[n]) else {
            continue;
        };
        options.limits.time = Some(end.saturating_duration_since(Instant::now()));
        if let Some((Verdict::Holds, _)) = judged(&other, property, &options, interpret)? {
            found.push(candidate.told(task));
        }
    }
    Ok(found)
}

impl Decisive {
    /// `VELO_SWITCH_DELAY (t_vel = 5000, holds with 1)`.
    pub fn text(&self) -> String {
        let value = format!(
            "{} = {}, holds with {}",
            self.name, self.value, self.instead
        );
        match &self.source {
            Some(source) if *source != self.name => format!("{source} ({value})"),
            _ => value,
        }
    }
}

/// Decides for what could not be reached whether the values exclude it, and remembers what a system reaches by itself.
#[derive(Default)]
pub struct Judge {
    /// By file, system and property: whether it is reached under the defaults, and in how many states.
    own: BTreeMap<(PathBuf, String, usize), Option<u64>>,
}

/// Whether a witness is reached.
enum Reach {
    /// Among so many states.
    In(u64),
    Never,
    /// A limit was reached first.
    Unknown,
}

impl Judge {
    /// The exclusions among the unreachable witnesses of a task of a machine, by property number. A witness of which a limit leaves
    /// open whether it is excluded is inconclusive.
    ///
    /// # Errors
    /// A system that cannot be explored under its defaults.
    pub fn of(
        &mut self,
        task: &Task,
        outcome: &mut Outcome,
        options: &Options,
        interpret: bool,
    ) -> Result<BTreeMap<usize, Exclusion>, Error> {
        let mut out = BTreeMap::new();
        if !outcome.report.complete {
            return Ok(out);
        }
        let options = Options {
            witnesses: false,
            until: Until::Decided,
            checkpoint: None,
            ..options.clone()
        };
        let judged = outcome.report.properties.iter_mut().enumerate();
        for (k, judged) in judged.filter(|(_, j)| j.verdict == Verdict::Unreachable) {
            let candidates = differing(&task.bound);
            let Some(own) = with(
                &task.bound,
                &candidates,
                &(0..candidates.len()).collect::<Vec<_>>(),
            ) else {
                continue;
            };
            if candidates.is_empty() {
                continue;
            }
            let key = (task.file.clone(), task.bound.system.name.clone(), k);
            let states = match self.own.get(&key) {
                Some(known) => *known,
                None => {
                    let found = match reached(&own, k, &options, interpret)? {
                        Reach::In(states) => Some(states),
                        Reach::Never => None,
                        Reach::Unknown => {
                            judged.verdict = Verdict::Inconclusive;
                            continue;
                        }
                    };
                    self.own.insert(key, found);
                    found
                }
            };
            let Some(states) = states else {
                continue;
            };
            let exact = states <= SMALL;
            let decisive = match exact {
                true => least(&task.bound, &candidates, k, &options, interpret)?,
                false => (0..candidates.len()).collect(),
            };
            let by = decisive.iter().filter_map(|n| candidates.get(*n));
            let by = by.map(|c| c.told(task)).collect();
            out.insert(k, Exclusion { by, exact });
        }
        Ok(out)
    }
}

/// A parameter, scalar or array, whose value is not the default.
struct Candidate {
    name: String,
    here: Vec<i64>,
    own: Vec<i64>,
    /// The cell of its first element.
    first: usize,
}

impl Candidate {
    fn told(&self, task: &Task) -> Decisive {
        let system = &task.bound.system;
        let ty = system.params.get(self.first).map(|p| p.var.ty);
        let show = |cells: &[i64]| {
            let one = |v: &i64| ty.map_or_else(|| v.to_string(), |ty| system.show(ty, *v));
            cells.iter().map(one).collect::<Vec<_>>().join(", ")
        };
        Decisive {
            name: self.name.clone(),
            value: show(&self.here),
            instead: show(&self.own),
            source: task.sources.get(&self.name).cloned(),
        }
    }
}

/// The parameters without those of readings, arrays as one: name, cells.
fn parameters(bound: &Bound) -> Vec<(String, Vec<usize>)> {
    let mut out: Vec<(String, Vec<usize>)> = Vec::new();
    for (k, p) in bound.system.params.iter().enumerate() {
        if p.reading.is_some() {
            continue;
        }
        let name = p.var.array();
        match out.last_mut() {
            Some((last, cells)) if last == name => cells.push(k),
            _ => out.push((name.to_owned(), vec![k])),
        }
    }
    out
}

fn differing(bound: &Bound) -> Vec<Candidate> {
    let readings = bound.readings().into_iter().collect();
    let Ok(own) = Bound::new(bound.system.clone(), &BTreeMap::new(), &readings) else {
        return Vec::new(); // a system without defaults for all has no configuration of its own
    };
    let cells = |of: &Bound, cells: &[usize]| -> Vec<i64> {
        let values = cells.iter().filter_map(|k| of.values.get(*k));
        values.map(|v| i64::from(*v)).collect()
    };
    let all = parameters(bound).into_iter().map(|(name, at)| Candidate {
        here: cells(bound, &at),
        own: cells(&own, &at),
        first: at.first().copied().unwrap_or(0),
        name,
    });
    all.filter(|c| c.here != c.own).collect()
}

/// The system with the defaults for the candidates of these numbers, if they fit the other values.
fn with(bound: &Bound, candidates: &[Candidate], reset: &[usize]) -> Option<Bound> {
    let mut params: BTreeMap<String, Vec<i64>> = parameters(bound)
        .into_iter()
        .map(|(name, at)| {
            let values = at.iter().filter_map(|k| bound.values.get(*k));
            (name, values.map(|v| i64::from(*v)).collect())
        })
        .collect();
    for candidate in reset.iter().filter_map(|n| candidates.get(*n)) {
        params.insert(candidate.name.clone(), candidate.own.clone());
    }
    let readings = bound.readings().into_iter().collect();
    Bound::new(bound.system.clone(), &params, &readings).ok()
}

/// A smallest set of candidates in the sense that none can be left out.
fn least(
    bound: &Bound,
    candidates: &[Candidate],
    property: usize,
    options: &Options,
    interpret: bool,
) -> Result<Vec<usize>, Error> {
    let mut kept: Vec<usize> = (0..candidates.len()).collect();
    for n in 0..candidates.len() {
        let fewer: Vec<usize> = kept.iter().copied().filter(|k| *k != n).collect();
        let Some(other) = with(bound, candidates, &fewer) else {
            continue;
        };
        let found = reached(&other, property, options, interpret)?;
        if matches!(found, Reach::In(_)) {
            kept = fewer;
        }
    }
    Ok(kept)
}

/// The states explored until the witness was reached; none if it is not.
fn reached(
    bound: &Bound,
    property: usize,
    options: &Options,
    interpret: bool,
) -> Result<Reach, Error> {
    let witness = properties(bound)
        .into_iter()
        .any(|(k, p)| k == property && matches!(p.form, Form::Reachable { .. }));
    let found = match witness {
        true => judged(bound, property, options, interpret)?,
        false => None,
    };
    Ok(match found {
        Some((Verdict::Reached, states)) => Reach::In(states),
        Some((Verdict::Inconclusive, _)) => Reach::Unknown,
        _ => Reach::Never,
    })
}

/// The verdict on one property, and the states explored for it; none for a property that the explorer does not judge by itself.
fn judged(
    bound: &Bound,
    property: usize,
    options: &Options,
    interpret: bool,
) -> Result<Option<(Verdict, u64)>, Error> {
    let asked = properties(bound).into_iter().find(|(k, _)| *k == property);
    let Some((_, asked)) = asked else {
        return Ok(None);
    };
    let asked: [Property; 1] = [asked];
    let generated = match interpret {
        true => None,
        false => Generated::find(bound),
    };
    let report = match generated {
        Some(system) => explore(&system, &asked, options, &mut ())?,
        None => explore(&Interpreted::new(bound), &asked, options, &mut ())?,
    };
    let found = report.properties.first().map(|j| j.verdict);
    Ok(found.map(|verdict| (verdict, report.states)))
}
