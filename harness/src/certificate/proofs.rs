//! Certificates of what the proof engines have found. Nothing that is confirmed rests on this module: what has to be shown is told by
//! the checker, a solver refutes it, and its lemmas are written.

use std::path::Path;

use stillpoint_certify::format::Verdict;
use stillpoint_certify::proof::clause::written;
use stillpoint_certify::proof::format::{
    Claim, File, Free, Lemmas, Proof, RANGE, Run, System, text,
};
use stillpoint_certify::proof::question::Question;
use stillpoint_certify::proof::symbolic::Symbolic;
use stillpoint_certify::proof::target::Target;
use stillpoint_certify::subject;
use stillpoint_engine::subject::Subject;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Form, Property};
use stillpoint_lang::twice::twice;
use stillpoint_model::proof::{Budget, Spent, lemmas};
use stillpoint_model::{self as model, Trace};

use super::{Written, read_again};
use crate::atomic::write_with;
use crate::proof::{Engine, Every, Judged, one_of};

/// What was found about the systems of a file.
pub struct Found<'a> {
    /// The file, its systems with the parameter values of the file.
    pub subject: &'a Subject,
    /// Their parameters that have every value, if such was asked for.
    pub every: Option<&'a [Every]>,
    /// The verdicts.
    pub judged: &'a [Vec<Judged>],
}

/// Writes a certificate to `path`; `progress` is told of how many systems of how many the claims are ready.
///
/// # Errors
/// One sentence: files that cannot be read or written, a specification that has changed since the check, an engine that was wrong.
pub fn certify(
    path: &Path,
    found: &Found,
    budget: &Budget,
    progress: &dyn Fn(usize, usize),
) -> Result<Written, String> {
    let tasks = &found.subject.tasks;
    let subject::Subject { mut header, bounds } = read_again(found.subject, tasks)?;
    let mut written = Written { claims: 0, open: 0 };
    let mut systems = Vec::new();
    for (k, (bound, task)) in bounds.iter().zip(&mut header.task).enumerate() {
        progress(k, tasks.len());
        let every = found.every.and_then(|all| all.get(k));
        let mut writer = Writer::new(bound, every, usize::MAX, budget)?;
        let judged = &found.judged[k];
        for (n, judged) in judged.iter().enumerate() {
            let Some(property) = task.property.get_mut(n) else {
                if let Ok(claim) = writer.claim(RANGE.to_owned(), None, judged)? {
                    writer.system.claims.push(claim);
                    written.claims += 1;
                }
                continue;
            };
            let own = Some(&bound.system.properties[n]);
            match writer.claim(property.id.clone(), own, judged)? {
                Ok(claim) => {
                    property.verdict = claim.verdict;
                    writer.system.claims.push(claim);
                    written.claims += 1;
                }
                Err(reason) => {
                    property.reason = reason;
                    written.open += 1;
                }
            }
        }
        systems.push(writer.system);
    }
    let text = text(&File { header, systems }).map_err(|e| e.to_string())?;
    write_with(path, |out| out.write_all(text.as_bytes()))
        .map_err(|e| format!("{} cannot be written: {e}", path.display()))?;
    Ok(written)
}

/// Writes claims about a system.
pub(crate) struct Writer<'a> {
    bound: &'a Bound,
    every: Option<&'a Every>,
    budget: &'a Budget,
    /// The most lemmas of an obligation.
    most: usize,
    symbolic: Symbolic<'a>,
    /// The claims, and which parameters are free.
    pub(crate) system: System,
}

impl<'a> Writer<'a> {
    pub(crate) fn new(
        bound: &'a Bound,
        every: Option<&'a Every>,
        most: usize,
        budget: &'a Budget,
    ) -> Result<Self, String> {
        let system = System {
            name: bound.system.name.clone(),
            free: every.map_or(Ok(Free::default()), free)?,
            ..System::default()
        };
        Ok(Writer {
            symbolic: Symbolic::new(bound, &system.free)?,
            bound,
            every,
            budget,
            most,
            system,
        })
    }

    /// A claim about a property, or about ranges; or why nothing is claimed.
    pub(crate) fn claim(
        &self,
        id: String,
        property: Option<&Property>,
        judged: &Judged,
    ) -> Result<Result<Claim, String>, String> {
        let Some(property) = property else {
            return self.told(id, None, judged);
        };
        let of_both = matches!(property.form, Form::Independent { .. });
        if !of_both || judged.shown.is_none() {
            return self.told(id, Some(&property.form), judged);
        }
        // A claim about two runs is one about the system of both.
        let every = self.every.and_then(|every| every.twice(property));
        let every = every.as_ref().map(|(every, _)| every);
        let both = twice(self.bound, property).ok_or("two runs of it are no system")?;
        let writer = Writer::new(&both.bound, every, self.most, self.budget)?;
        let trace = judged.shown.as_ref().and_then(|shown| shown.both.clone());
        let judged = Judged {
            trace,
            ..judged.clone()
        };
        writer.told(id, Some(&both.bound.system.properties[0].form), &judged)
    }

    /// A claim about what one run shows.
    fn told(
        &self,
        id: String,
        form: Option<&Form>,
        judged: &Judged,
    ) -> Result<Result<Claim, String>, String> {
        let verdict = match judged.verdict {
            model::Verdict::Holds => Verdict::Holds,
            model::Verdict::Violated => Verdict::Violated,
            model::Verdict::Vacuous => Verdict::Vacuous,
            model::Verdict::Reached => Verdict::Reached,
            model::Verdict::Unreachable => Verdict::Unreachable,
            model::Verdict::Inconclusive => {
                return Ok(Err(judged.reason.clone().unwrap_or_default()));
            }
        };
        let mut claim = Claim {
            id,
            verdict,
            line: 0,
            run: judged.trace.as_ref().map(|trace| self.run(trace)),
            proof: None,
        };
        let by_states = match judged.engine {
            Some(Engine::Explorer) => Some(
                "the explorer has judged it, which writes its own certificates: leave out --engine",
            ),
            Some(Engine::Bdd) => Some(
                "a set of states has no certificate; the explorer writes one: leave out --engine",
            ),
            _ => None,
        };
        if let Some(why) = by_states {
            return Ok(Err(why.to_owned()));
        }
        if matches!(verdict, Verdict::Violated | Verdict::Reached) {
            return Ok(match claim.run {
                Some(_) => Ok(claim),
                None => Err(judged.reason.clone().unwrap_or_default()),
            });
        }
        let target = match form {
            Some(form) => Target::of(form, verdict),
            None => Some(Target::Range),
        };
        let (Some(target), Some(shown)) = (target, &judged.shown) else {
            return Ok(Err("there is no certificate for this form".to_owned()));
        };
        let proof = Proof {
            invariant: shown.invariant.clone(),
            induction: shown.induction.clone(),
            measure: shown.measure.clone(),
            ways: shown.ways.clone(),
            ..Proof::default()
        };
        claim.proof = match with_lemmas(&self.symbolic, target, proof, self.most, self.budget) {
            Ok(proof) => Some(proof),
            Err(Unwritten::Spent) => {
                return Ok(Err(
                    "the limit was reached while the certificate was written".to_owned(),
                ));
            }
            Err(Unwritten::Untold(what)) => return Ok(Err(what)),
            Err(Unwritten::Wrong) => {
                return Err(format!(
                    "{}: {}: the tables, translated for the certificate, do not confirm what the engine has found: please report this",
                    self.system.name, claim.id
                ));
            }
        };
        Ok(Ok(claim))
    }

    /// A run of the engines in a certificate's terms.
    fn run(&self, trace: &Trace) -> Run {
        let judged = self.every.map_or(self.bound, |every| &every.bound);
        let mut run = Run::default();
        let value = |(lo, _): (i32, i32), offset: u32| i64::from(lo) + i64::from(offset);
        for (cell, offset) in &trace.initial {
            let k = *cell as usize;
            let name = written(&judged.system.states[k].var.name);
            let pair = (name, value(judged.states[k], *offset));
            let free = self
                .every
                .is_some_and(|every| every.parameters.contains(&k));
            if free {
                run.with.push(pair);
            } else if k < self.bound.initial.len() && self.bound.system.states[k].init.is_none() {
                run.start.push(pair);
            }
        }
        for step in &trace.steps {
            let inputs = step.iter().map(|(k, offset)| {
                let k = *k as usize;
                let name = written(&judged.system.inputs[k].name);
                (name, value(judged.inputs[k], *offset))
            });
            run.cycles.push(inputs.collect());
        }
        run
    }
}

/// The configurations of a system that are judged at once.
///
/// # Errors
/// One sentence: none satisfies the conditions.
pub(crate) fn free(every: &Every) -> Result<Free, String> {
    let system = &every.bound.system;
    let named = |(k, value): (usize, i64)| (written(&system.states[k].var.name), value);
    let such = match every.conditions[..] {
        [] => Vec::new(),
        _ => one_of(every)?.into_iter().map(named).collect(),
    };
    Ok(Free {
        every: spans(every),
        conditions: every.conditions.iter().map(|c| c.text(system)).collect(),
        such,
    })
}

/// The free parameters with their ranges.
pub(crate) fn spans(every: &Every) -> Vec<(String, (i64, i64))> {
    let one = |k: &usize| {
        let (lo, hi) = every.bound.states[*k];
        let name = every.bound.system.states[*k].var.name.clone();
        (name, (i64::from(lo), i64::from(hi)))
    };
    every.parameters.iter().map(one).collect()
}

/// Why there are no lemmas for a proof.
pub(crate) enum Unwritten {
    /// The budget is spent, or there are too many of them.
    Spent,
    /// What it says cannot be told in clauses.
    Untold(String),
    /// It shows nothing.
    Wrong,
}

/// A proof with the lemmas that a solver finds for it, at most so many for an obligation.
pub(crate) fn with_lemmas(
    symbolic: &Symbolic,
    target: Target,
    mut proof: Proof,
    most: usize,
    budget: &Budget,
) -> Result<Proof, Unwritten> {
    let mut found = Vec::new();
    let question = Question::new(symbolic, target, &proof.invariant, proof.measure.as_ref());
    let mut question = question.map_err(Unwritten::Untold)?;
    if let Some((_, what)) = question.unknown() {
        return Err(Unwritten::Untold(what));
    }
    let obligations = question.obligations(proof.induction.as_ref(), &proof.ways);
    for obligation in obligations.map_err(Unwritten::Untold)? {
        let goals: Vec<Vec<i32>> = obligation.goals.iter().map(|(g, _)| g.clone()).collect();
        let list = lemmas(&obligation.clauses, &goals, most, budget);
        let list = list.map_err(|Spent| Unwritten::Spent)?;
        let list = list.ok_or(Unwritten::Wrong)?;
        found.push(Lemmas { line: 0, list });
    }
    proof.lemmas = found;
    Ok(proof)
}
