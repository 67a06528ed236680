//! Reductions that keep verdicts: each property judged on the slice of the system that it depends on, and states that differ
//! by an exchange of identical instances explored once.
//!
//! The theorems, with their conditions, are in the book, chapter "Reductions". Where a condition fails the whole system is
//! explored, and the report says why. What a reduced exploration cannot tell is left out of the report: rule coverage, absorbing
//! states, the number of states of the whole system.

use std::collections::BTreeMap;
use std::time::Instant;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::slice::{Slice, Slicer};
use stillpoint_model::{
    Error, Group, Judgement, Narrow, Options, Part, Progress, Report, Storage, Symmetric, Trace,
    Verdict,
};

use crate::explore::{self, Judged};
use crate::keep::beside;
use crate::outcome::{Evaluator, Explored, Outcome, Pair, Reduction, Reductions, label, undecided};
use crate::stated;
use crate::table::{Generated, Interpreted};

mod images;
mod lift;
mod plan;

use images::Images;
use plan::Share;

/// Explores `bound` and judges all its properties, like [`crate::run`], with these reductions.
///
/// # Errors
/// A system that cannot be explored at all.
pub fn run(
    bound: &Bound,
    options: &Options,
    interpret: bool,
    reductions: Reductions,
    progress: &mut dyn Progress,
) -> Result<Outcome, Error> {
    let options = &Options {
        intervals: reductions.timers,
        ..options.clone()
    };
    if !reductions.less() {
        return explore::run(bound, options, interpret, progress);
    }
    let whole = |reason: &str, progress: &mut dyn Progress| {
        let mut outcome = explore::run(bound, options, interpret, progress)?;
        outcome.reduction = Some(Reduction {
            wanted: reductions,
            parts: Vec::new(),
            images: Vec::new(),
            whole: Some(reason.to_owned()),
        });
        Ok(outcome)
    };
    let slicer = Slicer::new(bound);
    let images = Images::new(slicer.whole(), reductions.symmetry);
    let shares = match plan::plan(&slicer, &images, reductions) {
        Ok(shares) => shares,
        Err(reason) => return whole(reason, progress),
    };
    let runner = Runner {
        bound,
        slicer: &slicer,
        images: &images,
        interpret,
        reductions,
    };
    let mut sum = Sum::new(bound);
    let start = Instant::now();
    for (number, share) in shares.iter().enumerate() {
        let mut options = options.clone();
        let name = format!("part-{number}-of-{}", shares.len());
        options.checkpoint = options.checkpoint.map(|c| beside(&c, &name));
        let time = &mut options.limits.time;
        *time = time.map(|t| t.saturating_sub(start.elapsed()));
        let alone = shares.len() == 1;
        let Some((judged, part)) = runner.explore(share, alone, &options, progress)? else {
            return whole("nothing would be left out", progress);
        };
        if !judged.report.faults.is_empty() {
            return whole(
                "an assignment leaves its range, so that slices and orbits prove nothing",
                progress,
            );
        }
        sum.add(share, judged, part);
    }
    Ok(sum.outcome(&runner))
}

struct Runner<'a> {
    bound: &'a Bound,
    slicer: &'a Slicer,
    images: &'a Images,
    interpret: bool,
    reductions: Reductions,
}

impl Runner<'_> {
    /// Explores one share. The judgements are those of `share.properties`, in the numbers of the whole system. None if it is
    /// the only one and neither reduction makes it smaller than the whole system.
    fn explore(
        &self,
        share: &Share,
        alone: bool,
        options: &Options,
        progress: &mut dyn Progress,
    ) -> Result<Option<(Judged, Explored)>, Error> {
        let mates = plan::mates(self.slicer, self.images, share);
        let mut slice = self.slicer.slice(&share.cone, &mates);
        let images = Images::new(&slice.bound, self.reductions.symmetry);
        let safe = !images.group().is_trivial()
            && share.properties.iter().all(|k| {
                let own = mates.iter().position(|m| m == k);
                own.is_some_and(|own| images.safe(&slice.bound, own))
            });
        let all = slice.states.len() == self.bound.states.len()
            && slice.inputs.len() == self.bound.inputs.len();
        if all && alone && !safe {
            return Ok(None);
        }
        if !safe {
            slice = self.slicer.slice(&share.cone, &share.properties);
        }
        let trivial = Group::new(slice.bound.states.len(), slice.bound.inputs.len(), &[]);
        let group = if safe { images.group() } else { &trivial };
        let (mut judged, evaluator) = self.run(&slice, group, share.narrow, options, progress)?;
        if safe {
            images.combine(&slice.bound, &mut judged.report.properties);
            // Mates have served; what they show of themselves follows from their representative.
            let all = std::mem::take(&mut judged.report.properties);
            let own = all.into_iter().zip(&mates);
            judged.report.properties = own
                .filter(|(_, k)| share.properties.contains(k))
                .map(|(j, _)| j)
                .collect();
        }
        for judgement in &mut judged.report.properties {
            judgement.trace = judgement
                .trace
                .take()
                .and_then(|t| lift::whole(self.bound, &slice, &t));
        }
        let pairs = std::mem::take(&mut judged.pairs);
        judged.pairs = pairs
            .into_iter()
            .map(|(own, mut pair)| {
                let lifted = |t: Trace| lift::whole(self.bound, &slice, &t);
                pair.second = pair.second.take().and_then(lifted);
                (slice.properties[own], pair)
            })
            .collect();
        let part = Explored {
            properties: share
                .properties
                .iter()
                .map(|k| label(&self.bound.system.properties[*k]))
                .collect(),
            faults: share.faults,
            variables: slice.states.len(),
            inputs: slice.inputs.len(),
            permutations: group.elements().len(),
            complete: judged.report.complete,
            states: judged.report.states,
            evaluator,
            seconds: judged.report.seconds,
        };
        Ok(Some((judged, part)))
    }

    /// The generated step of the whole system runs a slice too, unless an assignment outside the slice could leave its range.
    fn run(
        &self,
        slice: &Slice,
        group: &Group,
        narrow: bool,
        options: &Options,
        progress: &mut dyn Progress,
    ) -> Result<(Judged, Evaluator), Error> {
        let bound = &slice.bound;
        let generated = match self.interpret || !narrow {
            true => None,
            false => Generated::find(self.bound),
        };
        let Some(generated) = generated else {
            let system = Interpreted::new(bound);
            let judged = orbits(&system, bound, group, options, progress)?;
            return Ok((judged, Evaluator::Interpreter));
        };
        if slice.is_whole(self.bound) {
            let judged = orbits(&generated, bound, group, options, progress)?;
            return Ok((judged, Evaluator::Generated));
        }
        let part = Part {
            states: slice.states.clone(),
            inputs: slice.inputs.clone(),
            atoms: slice.atoms.clone(),
            observed: slice.observed.clone(),
        };
        let inputs = self.bound.inputs.len();
        let system = Narrow::new(&generated, &part, inputs, bound.combinations());
        let judged = orbits(&system, bound, group, options, progress)?;
        Ok((judged, Evaluator::Generated))
    }
}

/// Explores a slice up to the permutations of a group; its runs are told as runs of the slice itself.
fn orbits<S: stillpoint_model::System>(
    system: &S,
    bound: &Bound,
    group: &Group,
    options: &Options,
    progress: &mut dyn Progress,
) -> Result<Judged, Error> {
    if group.is_trivial() {
        return explore::judge(system, system, bound, options, progress, None);
    }
    let orbits = Symmetric::new(system, group);
    let mut judged = explore::judge(&orbits, system, bound, options, progress, None)?;
    for (k, judgement) in judged.report.properties.iter_mut().enumerate() {
        // Pairs of runs were explored singly.
        if !judged.pairs.contains_key(&k) {
            judgement.trace = judgement.trace.take().and_then(|t| orbits.unfold(&t));
        }
    }
    Ok(judged)
}

/// The reports of the shares put together.
struct Sum<'a> {
    bound: &'a Bound,
    report: Report,
    judged: Vec<Option<Judgement>>,
    pairs: BTreeMap<usize, Pair>,
    parts: Vec<Explored>,
}

impl<'a> Sum<'a> {
    fn new(bound: &'a Bound) -> Self {
        Self {
            bound,
            report: Report {
                resumable: true,
                ..Report::nothing()
            },
            judged: vec![None; bound.system.properties.len()],
            pairs: BTreeMap::new(),
            parts: Vec::new(),
        }
    }

    fn add(&mut self, share: &Share, judged: Judged, part: Explored) {
        let (sum, new) = (&mut self.report, judged.report);
        sum.states += new.states;
        sum.transitions = sum.transitions.saturating_add(new.transitions);
        sum.depth = sum.depth.max(new.depth);
        sum.seconds += new.seconds;
        sum.complete &= new.complete;
        sum.resumable &= new.resumable;
        sum.memory = sum.memory.max(new.memory);
        sum.stored += new.stored;
        sum.index_space = sum.index_space.saturating_add(new.index_space);
        if new.storage != Storage::Bitmap {
            sum.storage = new.storage;
        }
        for (k, judgement) in share.properties.iter().zip(new.properties) {
            self.judged[*k] = Some(judgement);
        }
        self.pairs.extend(judged.pairs);
        self.parts.push(part);
    }

    fn outcome(mut self, runner: &Runner) -> Outcome {
        let properties = &self.bound.system.properties;
        // Every verdict on a slice supposes that nothing leaves its range.
        let proven = self.parts.iter().all(|p| !p.faults || p.complete);
        let mut images = Vec::new();
        for (k, property) in properties.iter().enumerate() {
            let (representative, permutation) = runner.images.representative(k);
            if representative == k {
                continue;
            }
            images.push((label(property), label(&properties[representative])));
            self.judged[k] = self.judged[representative].clone().map(|j| Judgement {
                id: label(property),
                trace: j.trace.map(|t| permutation.trace(&t)),
                ..j
            });
            if let Some(pair) = self.pairs.get(&representative) {
                let second = pair.second.as_ref().map(|t| permutation.trace(t));
                let states = pair.states;
                self.pairs.insert(k, Pair { states, second });
            }
        }
        self.report.properties = self
            .judged
            .into_iter()
            .zip(properties)
            .map(|(judged, property)| match judged {
                Some(judged) if proven || lift::shown(self.bound, &judged) => judged,
                _ => undecided(property),
            })
            .collect();
        let refuted = stated::judge(self.bound, &mut self.report.properties);
        let interpreted = |p: &Explored| p.evaluator == Evaluator::Interpreter;
        Outcome {
            report: self.report,
            evaluator: if self.parts.iter().any(interpreted) {
                Evaluator::Interpreter
            } else {
                Evaluator::Generated
            },
            pairs: self.pairs,
            refuted,
            reduction: Some(Reduction {
                wanted: runner.reductions,
                parts: self.parts,
                images,
                whole: None,
            }),
        }
    }
}

/// A verdict that a run of the whole system shows.
fn has_run(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::Violated | Verdict::Reached)
}
