//! Under which conditions on its parameters a property holds that does not hold for all their values.
//!
//! Each configuration that breaks it must be excluded by some condition. So the weakest conditions that exclude all known ones are tried;
//! another configuration that breaks it is known from then on. Two or three conditions are tried where one is not enough. Each holds for
//! the defaults of the parameters: what a condition leaves is to be a machine.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::{Condition, Relation, Right};
use stillpoint_lang::ir::Ty;
use stillpoint_model::{Interrupt, Verdict};

use super::Failed;
use super::attempt::fits;
use crate::proof::{Every, Judged, Settings, Which, deciding, judge_every};

/// Conditions are tried that often for a property, within so many times the time for one question.
const TRIES: usize = 60;
const TIMES: u32 = 3;

/// A parameter of at most so many values is compared with each of them.
const VALUES: i64 = 16;

/// Of so many conditions three are tried together, of so many two.
const THREE: usize = 120;
const TWO: usize = 2500;

/// A condition that excludes some of the configurations that are known.
struct Candidate {
    condition: Condition,
    /// About the share of all values that satisfy it.
    share: f64,
    /// The configurations that it excludes, as a set of their numbers.
    excludes: u64,
}

/// Searches for conditions of the one property of a system, or of its ranges.
pub(super) struct Search<'a> {
    pub bound: &'a Bound,
    pub which: &'a Which,
    /// Wall time for a question.
    pub each: Duration,
    pub interrupt: Option<Interrupt>,
}

impl Search<'_> {
    /// Weak conditions under which it holds, and its proof; `broken` is a configuration that breaks it, by the places of the parameters.
    ///
    /// # Errors
    /// Ended from outside.
    pub(super) fn find(
        &self,
        broken: Vec<i64>,
    ) -> Result<Option<(Vec<Condition>, Judged)>, Failed> {
        let Ok(every) = Every::new(self.bound, self.which) else {
            return Ok(None);
        };
        let mut all = conditions(&every, &deciding(&every));
        let default = |k: usize| self.bound.values.get(k).copied().map_or(0, i64::from);
        all.retain(|(condition, _)| condition.holds(default));
        let until = Instant::now() + self.each * TIMES;
        let mut known = vec![broken];
        let (mut nothing, mut open) = (Vec::new(), Vec::new());
        for _ in 0..TRIES {
            let candidates = excluding(&all, &known);
            let tried = (&nothing[..], &open[..]);
            let Some(chosen) = weakest(&candidates, known.len(), tried) else {
                return Ok(None);
            };
            match self.ask(&chosen, until)? {
                Answer::Holds(judged) => return Ok(Some((chosen, *judged))),
                Answer::Fails(configuration) if known.len() < 64 => known.push(configuration),
                Answer::Fails(_) => return Ok(None),
                Answer::Nothing => nothing.push(chosen),
                Answer::Open => open.push(chosen),
            }
            if Instant::now() >= until {
                return Ok(None);
            }
        }
        Ok(None)
    }

    fn ask(&self, conditions: &[Condition], until: Instant) -> Result<Answer, Failed> {
        let Ok(every) = Every::such(self.bound, self.which, conditions) else {
            return Ok(Answer::Nothing);
        };
        let left = until.saturating_duration_since(Instant::now());
        let settings = Settings {
            each: Some(self.each.min(left)),
            ranges: self.bound.system.properties.is_empty(),
            interrupt: self.interrupt.clone(),
            ..Settings::default()
        };
        let judged = judge_every(&every, &settings).into_iter().next();
        let judged = judged.unwrap_or_else(fits);
        if self.interrupt.as_ref().is_some_and(Interrupt::is_raised) {
            return Err(Failed::Ended);
        }
        Ok(match (judged.verdict, &judged.trace) {
            (Verdict::Holds, _) => Answer::Holds(Box::new(judged)),
            (Verdict::Violated, Some(trace)) => Answer::Fails(every.configuration(trace)),
            (Verdict::Vacuous, _) => Answer::Nothing,
            _ => Answer::Open,
        })
    }
}

enum Answer {
    Holds(Box<Judged>),
    /// In this configuration.
    Fails(Vec<i64>),
    /// It is true of nothing.
    Nothing,
    /// It is not decided.
    Open,
}

/// Sets of conditions that were tried: those under which a property is true of nothing, and those under which it is not decided.
type Tried<'a> = (&'a [Vec<Condition>], &'a [Vec<Condition>]);

/// All conditions of one comparison that are tried, with their shares.
fn conditions(every: &Every, params: &[usize]) -> Vec<(Condition, f64)> {
    let system = &every.bound.system;
    let mut all = Vec::new();
    let mut add = |left, relation, right, share| {
        let condition = Condition {
            left,
            relation,
            right,
        };
        all.push((condition, share));
    };
    let range = |param: usize| every.range_of(param);
    for param in params {
        let (lo, hi) = range(*param);
        let count = (hi - lo) as f64 + 1.0;
        let number = system.params[*param].var.ty == Ty::Int;
        let most = |value: i64| (value - lo + 1) as f64 / count;
        if hi - lo < VALUES {
            for value in (lo..=hi).map(Right::Value) {
                add(*param, Relation::Equal, value, 1.0 / count);
                if hi - lo > 1 {
                    add(*param, Relation::Unequal, value, 1.0 - 1.0 / count);
                }
            }
        }
        if !number || hi == lo {
            continue;
        }
        // One less than all values, the signs, and powers of two.
        let mut ends = BTreeSet::from([lo, hi - 1, -1, 0]);
        ends.extend((0..31).map(|k| 1 << k));
        for end in ends.into_iter().filter(|end| lo <= *end && *end < hi) {
            let value = Right::Value(end);
            add(*param, Relation::Most, value, most(end));
            add(*param, Relation::More, value, 1.0 - most(end));
        }
        for other in params.iter().filter(|other| *other != param) {
            let apart = range(*other).0 > hi || range(*other).1 < lo;
            if system.params[*other].var.ty != Ty::Int || apart {
                continue;
            }
            let right = Right::Parameter(*other);
            add(*param, Relation::Most, right, 0.5);
            add(*param, Relation::Less, right, 0.499);
            if param < other {
                add(*param, Relation::Equal, right, 1.0 / count);
            }
        }
    }
    all
}

/// Those that exclude a configuration that is known.
fn excluding(all: &[(Condition, f64)], known: &[Vec<i64>]) -> Vec<Candidate> {
    let one = |(condition, share): &(Condition, f64)| {
        let broken = known.iter().enumerate().filter(|(_, values)| {
            let value = |k: usize| values.get(k).copied().unwrap_or_default();
            !condition.holds(value)
        });
        let excludes = broken.fold(0, |set, (k, _)| set | 1 << k);
        (excludes != 0).then_some(Candidate {
            condition: *condition,
            share: *share,
            excludes,
        })
    };
    all.iter().filter_map(one).collect()
}

/// The weakest set of conditions so far that excludes all configurations that are known.
struct Best<'a> {
    /// Their numbers, as a set.
    known: u64,
    tried: Tried<'a>,
    share: f64,
    set: Option<Vec<Condition>>,
}

impl Best<'_> {
    fn offer(&mut self, set: &[&Candidate]) {
        let excluded = set.iter().fold(0, |all, c| all | c.excludes);
        let share = set.iter().map(|c| c.share).product();
        if excluded != self.known || share <= self.share {
            return;
        }
        let has = |condition| set.iter().any(|c| c.condition == condition);
        let around = |other: &Vec<Condition>| other.iter().all(|c| has(*c));
        // What is true of nothing is so with a further condition as well.
        let (nothing, open) = self.tried;
        let same = |other: &Vec<Condition>| other.len() == set.len() && around(other);
        if !nothing.iter().any(around) && !open.iter().any(same) {
            self.share = share;
            self.set = Some(set.iter().map(|c| c.condition).collect());
        }
    }
}

/// The weakest set that excludes all that are known, of as few conditions as there must be, and was not tried.
fn weakest(candidates: &[Candidate], known: usize, tried: Tried) -> Option<Vec<Condition>> {
    let mut best = Best {
        known: u64::MAX >> (64 - known),
        tried,
        share: 0.0,
        set: None,
    };
    candidates.iter().for_each(|a| best.offer(&[a]));
    if best.set.is_none() && candidates.len() <= TWO {
        for (k, a) in candidates.iter().enumerate() {
            candidates[..k].iter().for_each(|b| best.offer(&[a, b]));
        }
    }
    if best.set.is_none() && candidates.len() <= THREE {
        for (n, a) in candidates.iter().enumerate() {
            for (m, b) in candidates[..n].iter().enumerate() {
                candidates[..m].iter().for_each(|c| best.offer(&[a, b, c]));
            }
        }
    }
    best.set
}
