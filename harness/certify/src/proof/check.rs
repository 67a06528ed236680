//! Checks the claims of a file: runs are replayed, obligations refuted with the lemmas given.

use std::collections::BTreeMap;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::Condition;
use stillpoint_lang::ir::{Form, Property};
use stillpoint_lang::twice::twice;

use super::clause::written;
use super::format::{Claim, Free, Proof, RANGE, Run, System};
use super::question::{Obligation, Question, Unshown};
use super::rup::Clauses;
use super::symbolic::Symbolic;
use super::target::Target;
use crate::cycle::Player;
use crate::format::{Task, Verdict};
use crate::replay::{ends, fault, violates};
use crate::subject::label;

/// What was confirmed about a system.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Proved {
    /// The configurations that this is about.
    pub free: Free,
    /// The verdict about ranges, if there is one, and what shows it.
    pub range: Option<(Verdict, String)>,
    /// For each property what shows its verdict.
    pub by: Vec<String>,
}

/// No k-induction is over that many cycles.
const LONGEST: usize = 1000;

/// Checks all claims about one system.
///
/// # Errors
/// What is not shown: the line and one sentence.
pub fn check(bound: &Bound, task: &Task, system: &System) -> Result<Proved, String> {
    let at = |line: usize, what: String| format!("line {line}: {what}");
    let here = |what: String| at(system.line, what);
    if system.name != task.system {
        return Err(here(format!("{} must stand here", task.system)));
    }
    if task.states > 0 || !task.faults.is_empty() {
        return Err(here(
            "the header speaks of states, of which there are none".to_owned(),
        ));
    }
    let symbolic = Symbolic::new(bound, &system.free).map_err(here)?;
    // Of no configuration everything is true.
    some(bound, &system.free).map_err(here)?;
    let mut claims = system.claims.iter();
    let mut proved = Proved {
        free: system.free.clone(),
        ..Proved::default()
    };
    for (number, property) in task.property.iter().enumerate() {
        proved.by.push(match property.verdict {
            Verdict::Open => String::new(),
            verdict => {
                let known = |claim: &&Claim| claim.id == property.id && claim.verdict == verdict;
                let claim = claims.next().filter(known).ok_or_else(|| {
                    here(format!(
                        "{}: what shows it is missing or not in its place",
                        property.id
                    ))
                })?;
                let property = &bound.system.properties[number];
                let checker = Checker {
                    symbolic: &symbolic,
                    system,
                    claim,
                };
                checker
                    .property(property)
                    .map_err(|(line, what)| at(line, format!("{}: {what}", claim.id)))?
            }
        });
    }
    if let Some(claim) = claims.next() {
        let checker = Checker {
            symbolic: &symbolic,
            system,
            claim,
        };
        if claim.id != RANGE || claims.next().is_some() {
            return Err(at(
                claim.line,
                "this claim is not one of the header".to_owned(),
            ));
        }
        let by = checker
            .range()
            .map_err(|(line, what)| at(line, format!("{RANGE}: {what}")))?;
        proved.range = Some((claim.verdict, by));
    }
    Ok(proved)
}

/// Checks claims about a system each by itself, whichever of its properties they are about.
///
/// # Errors
/// The first that is not shown: its name and one sentence.
pub fn confirm(bound: &Bound, system: &System) -> Result<(), String> {
    let symbolic = Symbolic::new(bound, &system.free)?;
    some(bound, &system.free)?;
    for claim in &system.claims {
        let checker = Checker {
            symbolic: &symbolic,
            system,
            claim,
        };
        let mut properties = bound.system.properties.iter();
        let shown = match properties.find(|property| label(property) == claim.id) {
            Some(property) => checker.property(property),
            None if claim.id == RANGE => checker.range(),
            None => checker.here(Err("there is no such property".to_owned())),
        };
        shown.map_err(|(_, what)| format!("{}: {what}", claim.id))?;
    }
    Ok(())
}

/// One of the configurations: where no other is named, that in which each free parameter has the value nearest to its own.
fn some(bound: &Bound, free: &Free) -> Result<Bound, String> {
    if !free.conditions.is_empty() || !free.such.is_empty() {
        return configured(bound, free, &free.such);
    }
    configured(bound, free, &nearest(bound, &free.every))
}

fn nearest(bound: &Bound, every: &[(String, (i64, i64))]) -> Vec<(String, i64)> {
    let params = bound.system.params.iter().zip(&bound.values);
    let own: BTreeMap<&String, i32> = params.map(|(p, v)| (&p.var.name, *v)).collect();
    let near = |(name, (lo, hi)): &(String, (i64, i64))| {
        let value = own.get(name).map_or(*lo, |v| i64::from(*v));
        (written(name), value.max(*lo).min(*hi))
    };
    every.iter().map(near).collect()
}

/// The system with values for the free parameters, each of which must have one; and all conditions hold.
fn configured(bound: &Bound, free: &Free, with: &[(String, i64)]) -> Result<Bound, String> {
    let every = &free.every[..];
    let own = match (every, with) {
        ([], []) => bound.clone(),
        _ => with_values(bound, every, with)?,
    };
    for condition in &free.conditions {
        let read = Condition::read(&own.system, condition).map_err(|why| why.to_string())?;
        if own.constant(&read.node()) == 0 {
            return Err(format!("`{condition}` does not hold in a configuration"));
        }
    }
    Ok(own)
}

fn with_values(
    bound: &Bound,
    every: &[(String, (i64, i64))],
    with: &[(String, i64)],
) -> Result<Bound, String> {
    let mut given: BTreeMap<&str, i64> = with.iter().map(|(n, v)| (n.as_str(), *v)).collect();
    let mut values: BTreeMap<String, Vec<i64>> = BTreeMap::new();
    for (param, value) in bound.system.params.iter().zip(&bound.values) {
        if param.reading.is_some() {
            continue;
        }
        let name = &param.var.name;
        let mut value = i64::from(*value);
        if let Some((_, (lo, hi))) = every.iter().find(|(free, _)| free == name) {
            let chosen = given.remove(written(name).as_str());
            value = chosen
                .filter(|v| lo <= v && v <= hi)
                .ok_or_else(|| format!("`{name}` has no value of its range {lo}..{hi}"))?;
        }
        let base = name.split('[').next().unwrap_or(name);
        values.entry(base.to_owned()).or_default().push(value);
    }
    if !given.is_empty() || with.len() != every.len() {
        return Err("a parameter has a value that is not free".to_owned());
    }
    let readings = bound.readings().into_iter().collect();
    Bound::new(bound.system.clone(), &values, &readings)
        .map_err(|e| format!("there is no such configuration: {e}"))
}

struct Checker<'a> {
    symbolic: &'a Symbolic<'a>,
    system: &'a System,
    claim: &'a Claim,
}

/// A line, and what is wrong there.
type Wrong = (usize, String);

impl Checker<'_> {
    fn here<T>(&self, result: Result<T, String>) -> Result<T, Wrong> {
        result.map_err(|what| (self.claim.line, what))
    }

    /// A claim about a property; one about two runs is a claim about the system of both.
    fn property(&self, property: &Property) -> Result<String, Wrong> {
        if !matches!(property.form, Form::Independent { .. }) {
            return self.form(&property.form);
        }
        // There may be more pairs of runs than it is about: one that breaks it shows nothing.
        let shown = matches!(self.claim.verdict, Verdict::Holds | Verdict::Vacuous);
        let both = twice(self.symbolic.bound, property).filter(|_| shown);
        let Some(both) = both else {
            return self.none();
        };
        let symbolic = Symbolic::new(&both.bound, &self.system.free);
        let checker = Checker {
            symbolic: &self.here(symbolic)?,
            ..*self
        };
        checker.form(&both.bound.system.properties[0].form)
    }

    fn form(&self, form: &Form) -> Result<String, Wrong> {
        let (run, proof) = (self.claim.run.as_ref(), self.claim.proof.as_ref());
        let verdict = self.claim.verdict;
        match (verdict, run, proof) {
            (Verdict::Violated, Some(run), None) => {
                let shown = self.replay(run, |bound, player| violates(bound, form, player, None));
                self.here(shown)?;
                Ok(length(run))
            }
            (Verdict::Reached, Some(run), None) => {
                let Form::Reachable { goal } = form else {
                    return self.none();
                };
                let shown = self.replay(run, |_, player| ends(player, |p| p.atom(*goal)));
                self.here(shown)?;
                Ok(length(run))
            }
            (_, run, Some(proof)) => {
                let Some(target) = Target::of(form, verdict) else {
                    return self.none();
                };
                let when = match (form, verdict) {
                    (Form::Always { when, .. }, Verdict::Holds) => *when,
                    (Form::Unless { when, .. } | Form::LeadsTo { when, .. }, Verdict::Holds) => {
                        Some(*when)
                    }
                    (Form::CanAlwaysReach { goal, .. }, Verdict::Holds) => Some(*goal),
                    _ => None,
                };
                match (when, run) {
                    (Some(when), Some(run)) => {
                        let shown = self.replay(run, |_, player| ends(player, |p| p.atom(when)));
                        self.here(shown)?;
                    }
                    (None, None) => {}
                    _ => return self.none(),
                }
                self.never(target, proof)
            }
            _ => self.none(),
        }
    }

    fn range(&self) -> Result<String, Wrong> {
        match (self.claim.verdict, &self.claim.run, &self.claim.proof) {
            (Verdict::Holds, None, Some(proof)) => self.never(Target::Range, proof),
            (Verdict::Violated, Some(run), None) => {
                let shown = self.replay(run, |_, player| match fault(player)? {
                    Some(_) => Ok(()),
                    None => Err("no value leaves its range".to_owned()),
                });
                self.here(shown)?;
                Ok(length(run))
            }
            _ => self.none(),
        }
    }

    fn none<T>(&self) -> Result<T, Wrong> {
        let verdict = self.claim.verdict;
        self.here(Err(format!(
            "what it carries is no proof that this is {verdict:?}"
        )))
    }

    /// Replays a run in the configuration that it names.
    fn replay(
        &self,
        run: &Run,
        shown: impl FnOnce(&Bound, Player) -> Result<(), String>,
    ) -> Result<(), String> {
        let bound = &configured(self.symbolic.bound, &self.system.free, &run.with)?;
        let mut start: BTreeMap<&str, i64> =
            run.start.iter().map(|(n, v)| (n.as_str(), *v)).collect();
        let mut state = Vec::new();
        let states = bound
            .system
            .states
            .iter()
            .zip(&bound.states)
            .zip(&bound.initial);
        for ((variable, (lo, _)), init) in states {
            let given = start.remove(written(&variable.var.name).as_str());
            state.push(match (init, given) {
                (None, given) => given.map_or(Ok(*lo), i32::try_from),
                (Some(init), None) => Ok(*init),
                (Some(_), Some(given)) => i32::try_from(given),
            });
        }
        let state: Result<Vec<i32>, _> = state.into_iter().collect();
        let state = state.map_err(|_| "a start value is no variable's")?;
        if !start.is_empty() {
            return Err("its run gives a variable a value that does not exist".to_owned());
        }
        let inputs = bound.system.inputs.iter().zip(&bound.inputs).enumerate();
        let inputs: BTreeMap<String, (u32, i64)> = inputs
            .map(|(k, (var, (lo, _)))| (written(&var.name), (k as u32, i64::from(*lo))))
            .collect();
        let one = |(name, value): &(String, i64)| {
            let (k, lo) = inputs.get(name)?;
            Some((*k, u32::try_from(value.checked_sub(*lo)?).ok()?))
        };
        let cycle = |list: &Vec<(String, i64)>| list.iter().map(one).collect();
        let steps: Option<Vec<Vec<(u32, u32)>>> = run.cycles.iter().map(cycle).collect();
        let steps = steps.ok_or("its run gives an input a value that it cannot have")?;
        shown(bound, Player::begin(bound, state, &steps)?)
    }

    /// That something is never seen.
    fn never(&self, target: Target, proof: &Proof) -> Result<String, Wrong> {
        if let Some(induction) = &proof.induction {
            if induction.cycles > LONGEST {
                return self.here(Err(format!("an induction over more than {LONGEST} cycles")));
            }
        }
        let question = Question::new(
            self.symbolic,
            target,
            &proof.invariant,
            proof.measure.as_ref(),
        );
        let mut question = self.here(question)?;
        if let Some((number, what)) = question.unknown() {
            return Err((proof.line + number, what));
        }
        let obligations = question.obligations(proof.induction.as_ref(), &proof.ways);
        let obligations = self.here(obligations)?;
        let mut lemmas = 0;
        for (obligation, given) in obligations.iter().zip(&proof.lemmas) {
            refuted(obligation, &given.list).map_err(|unshown| match unshown {
                Unrefuted::Lemma(k) => (
                    given.line + k + 1,
                    "this lemma does not follow from the clauses before".to_owned(),
                ),
                Unrefuted::Goal(Unshown::Start(k)) => (
                    proof.line + k,
                    "it is not shown that this clause holds at the start".to_owned(),
                ),
                Unrefuted::Goal(Unshown::Kept(k)) => (
                    proof.line + k,
                    "it is not shown that every cycle keeps this clause".to_owned(),
                ),
                Unrefuted::Goal(Unshown::Bad) => (
                    given.line,
                    "the invariant is not shown to exclude what must not happen".to_owned(),
                ),
                Unrefuted::Goal(Unshown::Base(k)) => (
                    given.line,
                    format!("cycle {} of a run is not shown to be good", k + 1),
                ),
                Unrefuted::Goal(Unshown::Cover) => (
                    given.line,
                    "it is not shown that every state of the invariant is in a region".to_owned(),
                ),
                Unrefuted::Goal(Unshown::Input(k)) => (
                    given.line,
                    format!(
                        "the inputs of region {} are not shown to be possible",
                        k + 1
                    ),
                ),
                Unrefuted::Goal(Unshown::Way(k)) => (
                    given.line,
                    format!(
                        "the inputs of region {} are not shown to lead out of it",
                        k + 1
                    ),
                ),
            })?;
            lemmas += given.list.len();
        }
        if obligations.len() != proof.lemmas.len() {
            return self.none();
        }
        let mut by = match &proof.induction {
            Some(induction) => format!("induction over {} cycles, ", induction.cycles),
            None => String::new(),
        };
        by += &format!(
            "invariant of {} clauses, {lemmas} lemmas",
            proof.invariant.len()
        );
        if let Some(measure) = &proof.measure {
            by = format!("measure of {} rounds, {by}", measure.rounds);
        }
        if !proof.ways.is_empty() {
            by = format!("{} regions, {by}", proof.ways.len());
        }
        Ok(by)
    }
}

fn length(run: &Run) -> String {
    format!("run of {} cycles", run.cycles.len())
}

/// What does not follow.
pub enum Unrefuted {
    /// The lemma of this number.
    Lemma(usize),
    /// A goal.
    Goal(Unshown),
}

/// Whether the goals of an obligation are refuted with these lemmas.
///
/// # Errors
/// The first that is not.
pub fn refuted(obligation: &Obligation, lemmas: &[Vec<i32>]) -> Result<(), Unrefuted> {
    let mut clauses = Clauses::new(obligation.variables);
    for clause in &obligation.clauses {
        clauses.add(clause);
    }
    for (k, lemma) in lemmas.iter().enumerate() {
        if !lemma.iter().all(|l| clauses.knows(*l)) || !clauses.lemma(lemma) {
            return Err(Unrefuted::Lemma(k));
        }
    }
    for (goal, what) in &obligation.goals {
        if !clauses.refutes(goal) {
            return Err(Unrefuted::Goal(*what));
        }
    }
    Ok(())
}
