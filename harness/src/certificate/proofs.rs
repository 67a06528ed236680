//! Certificates of what the proof engines have found. Nothing that is confirmed rests on this module: what has to be shown is told by
//! the checker, a solver refutes it, and its lemmas are written.

use std::path::Path;

use stillpoint_certify::format::Verdict;
use stillpoint_certify::proof::clause::written;
use stillpoint_certify::proof::format::{Claim, File, Lemmas, Proof, RANGE, Run, System, text};
use stillpoint_certify::proof::question::Question;
use stillpoint_certify::proof::symbolic::Symbolic;
use stillpoint_certify::proof::target::Target;
use stillpoint_certify::subject;
use stillpoint_engine::subject::Subject;
use stillpoint_lang::bind::Bound;
use stillpoint_model::proof::{Budget, Spent, lemmas};
use stillpoint_model::{self as model, Trace};

use super::{Written, read_again};
use crate::atomic::write_with;
use crate::proof::{Engine, Every, Judged, Shown};

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
    let subject::Subject { mut header, bounds } = read_again(found.subject)?;
    let mut written = Written { claims: 0, open: 0 };
    let mut systems = Vec::new();
    for (k, (bound, task)) in bounds.iter().zip(&mut header.task).enumerate() {
        progress(k, tasks.len());
        let every = found.every.and_then(|all| all.get(k));
        let mut writer = Writer::new(bound, every, budget)?;
        let judged = &found.judged[k];
        for (n, judged) in judged.iter().enumerate() {
            let Some(property) = task.property.get_mut(n) else {
                let form = None;
                if let Ok(claim) = writer.claim(RANGE.to_owned(), form, judged)? {
                    writer.system.claims.push(claim);
                    written.claims += 1;
                }
                continue;
            };
            let form = Some(&bound.system.properties[n].form);
            match writer.claim(property.id.clone(), form, judged)? {
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

struct Writer<'a> {
    bound: &'a Bound,
    every: Option<&'a Every>,
    budget: &'a Budget,
    symbolic: Symbolic<'a>,
    system: System,
}

impl<'a> Writer<'a> {
    fn new(bound: &'a Bound, every: Option<&'a Every>, budget: &'a Budget) -> Result<Self, String> {
        let free = every.iter().flat_map(|every| {
            let one = |k: &usize| {
                let (lo, hi) = every.bound.states[*k];
                let name = every.bound.system.states[*k].var.name.clone();
                (name, (i64::from(lo), i64::from(hi)))
            };
            every.parameters.iter().map(one)
        });
        let system = System {
            name: bound.system.name.clone(),
            every: free.collect(),
            ..System::default()
        };
        Ok(Writer {
            symbolic: Symbolic::new(bound, &system.every)?,
            bound,
            every,
            budget,
            system,
        })
    }

    /// A claim about a property of this form, or about ranges; or why nothing is claimed.
    fn claim(
        &self,
        id: String,
        form: Option<&'a stillpoint_lang::ir::Form>,
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
        if judged.engine == Some(Engine::Explorer) {
            return Ok(Err(
                "the explorer has judged it, which writes its own certificates: leave out --engine"
                    .to_owned(),
            ));
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
        claim.proof = match self.proof(target, shown) {
            Ok(Ok(proof)) => Some(proof),
            Ok(Err(Spent)) => {
                return Ok(Err(
                    "the limit was reached while the certificate was written".to_owned(),
                ));
            }
            Err(what) => return Err(format!("{}: {}: {what}", self.system.name, claim.id)),
        };
        Ok(Ok(claim))
    }

    fn proof(&self, target: Target, shown: &Shown) -> Result<Result<Proof, Spent>, String> {
        let mut proof = Proof {
            invariant: shown.invariant.clone(),
            induction: shown.induction.clone(),
            ..Proof::default()
        };
        let mut question = Question::new(&self.symbolic, target, &shown.invariant)?;
        for obligation in question.obligations(shown.induction.as_ref())? {
            let goals: Vec<Vec<i32>> = obligation.goals.iter().map(|(g, _)| g.clone()).collect();
            match lemmas(&obligation.clauses, &goals, self.budget) {
                Ok(Some(list)) => proof.lemmas.push(Lemmas { line: 0, list }),
                Ok(None) => {
                    return Err(
                        "the tables, translated for the certificate, do not confirm what the engine has found: please report this"
                            .to_owned(),
                    );
                }
                Err(Spent) => return Ok(Err(Spent)),
            }
        }
        Ok(Ok(proof))
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
