//! Explores a table: generated step function where there is one, else the interpreter; two runs for `independent`.

use std::collections::BTreeMap;
use std::time::Instant;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::{Frame, UNSET};
use stillpoint_lang::ir;
use stillpoint_model::table::{Generated, Interpreted, properties};
use stillpoint_model::{
    Cluster, Error, Form, Judgement, Limits, Options, Progress, Property, Replay, Report, System,
    Trace, Twin, Verdict, explore, explore_together,
};

use crate::keep::beside;
use crate::recorded;
use crate::reduce::Reduction;

/// Which evaluator ran the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evaluator {
    /// Rust generated at build time.
    Generated,
    /// The interpreter.
    Interpreter,
}

/// What exploring one table gave.
#[derive(Debug)]
pub struct Outcome {
    /// The explorer's report; its `properties` follow `bound.system.properties`, the `independent` ones included.
    pub report: Report,
    /// Who ran it.
    pub evaluator: Evaluator,
    /// The exploration of pairs of runs for each `independent` property, by property number.
    pub pairs: BTreeMap<usize, Pair>,
    /// By property number: how the report differs from what the property records; its verdict is `Violated` then.
    pub refuted: BTreeMap<usize, String>,
    /// How the exploration was reduced, if that was wanted.
    pub reduction: Option<Reduction>,
}

/// The exploration of pairs of runs for one property.
#[derive(Debug)]
pub struct Pair {
    /// Pairs of states.
    pub states: u64,
    /// The second run of a counterexample; the judgement has the first.
    pub second: Option<Trace>,
}

/// Explores `bound` and judges all its properties; `interpret` forces the interpreter.
///
/// # Errors
/// A system that cannot be explored at all.
pub fn run(
    bound: &Bound,
    options: &Options,
    interpret: bool,
    progress: &mut dyn Progress,
) -> Result<Outcome, Error> {
    run_together(bound, options, interpret, progress, None)
}

/// Like [`run`], together with the other processes of a cluster; only process 0 gets an outcome that says something.
///
/// # Errors
/// A system that cannot be explored at all; a process that is gone.
pub fn run_together(
    bound: &Bound,
    options: &Options,
    interpret: bool,
    progress: &mut dyn Progress,
    cluster: Option<&Cluster>,
) -> Result<Outcome, Error> {
    let generated = if interpret {
        None
    } else {
        Generated::find(bound)
    };
    let (mut found, evaluator) = match generated {
        Some(system) => (
            judge(&system, &system, bound, options, progress, cluster)?,
            Evaluator::Generated,
        ),
        None => {
            let system = Interpreted::new(bound);
            (
                judge(&system, &system, bound, options, progress, cluster)?,
                Evaluator::Interpreter,
            )
        }
    };
    let refuted = recorded::judge(bound, &mut found.report.properties);
    Ok(Outcome {
        report: found.report,
        evaluator,
        pairs: found.pairs,
        refuted,
        reduction: None,
    })
}

/// A report on all properties of a table, before it is compared with what they record.
pub(crate) struct Judged {
    pub(crate) report: Report,
    pub(crate) pairs: BTreeMap<usize, Pair>,
}

/// Explores the table `bound` as `system`, and pairs of runs of it as `paired`.
pub(crate) fn judge<S: System, P: System>(
    system: &S,
    paired: &P,
    bound: &Bound,
    options: &Options,
    progress: &mut dyn Progress,
    cluster: Option<&Cluster>,
) -> Result<Judged, Error> {
    let start = Instant::now();
    let listed = properties(bound);
    let single: Vec<Property> = listed.iter().map(|(_, p)| p.clone()).collect();
    let mut report = search(system, &single, options, progress, cluster)?;
    let mut judged: Vec<Option<Judgement>> = vec![None; bound.system.properties.len()];
    for ((k, _), judgement) in listed.iter().zip(std::mem::take(&mut report.properties)) {
        judged[*k] = Some(judgement);
    }
    let mut pairs = BTreeMap::new();
    for (k, property) in bound.system.properties.iter().enumerate() {
        let ir::Form::Independent {
            observe,
            of,
            condition,
        } = &property.form
        else {
            continue;
        };
        // One time limit for all of them.
        let limits = Limits {
            time: options
                .limits
                .time
                .map(|t| t.saturating_sub(start.elapsed())),
            ..options.limits
        };
        let options = &Options {
            limits,
            ..options.clone()
        };
        let claim = Claim {
            bound,
            observe,
            of,
            condition: *condition,
            id: label(property),
            options,
            cluster,
        };
        let (outcome, pair) = claim.explore(paired)?;
        report.complete &= outcome.complete;
        report.resumable &= outcome.resumable;
        report.seconds += outcome.seconds;
        judged[k] = outcome.properties.into_iter().next();
        pairs.insert(k, pair);
    }
    report.properties = judged
        .into_iter()
        .zip(&bound.system.properties)
        .map(|(j, p)| j.unwrap_or_else(|| undecided(p)))
        .collect();
    Ok(Judged { report, pairs })
}

/// The judgement on a property that nothing is known about.
pub(crate) fn undecided(property: &ir::Property) -> Judgement {
    Judgement {
        id: label(property),
        verdict: Verdict::Inconclusive,
        length: None,
        bound: None,
        fastest: None,
        trace: None,
    }
}

/// Explores alone, or together with others.
fn search<S: System>(
    system: &S,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
    cluster: Option<&Cluster>,
) -> Result<Report, Error> {
    match cluster {
        None => explore(system, properties, options, progress),
        Some(cluster) => explore_together(system, properties, options, progress, cluster),
    }
}

/// A claim about pairs of runs that differ in some inputs only.
struct Claim<'a> {
    bound: &'a Bound,
    observe: &'a [usize],
    of: &'a [usize],
    condition: Option<usize>,
    id: String,
    options: &'a Options,
    cluster: Option<&'a Cluster>,
}

impl Claim<'_> {
    /// Explores all such pairs; a counterexample's first run stays in the judgement.
    fn explore<S: System>(self, system: &S) -> Result<(Report, Pair), Error> {
        let inputs = &self.bound.inputs;
        let size = |k: usize| {
            u32::try_from(i64::from(inputs[k].1) - i64::from(inputs[k].0) + 1).unwrap_or(u32::MAX)
        };
        let listed = self.of.iter().map(|k| (*k as u32, size(*k))).collect();
        let twin = Twin::new(system, listed, self.condition, self.observe.to_vec());
        let form = Form::Always {
            when: Some(Twin::<S>::BOTH),
            then: Twin::<S>::AGREE,
        };
        let options = Options {
            checkpoint: self
                .options
                .checkpoint
                .as_ref()
                .map(|c| beside(c, &self.id)),
            ..self.options.clone()
        };
        let property = Property { id: self.id, form };
        let mut report = search(&twin, &[property], &options, &mut (), self.cluster)?;
        let mut pair = Pair {
            states: report.states,
            second: None,
        };
        for judgement in &mut report.properties {
            if let Some(trace) = judgement.trace.take() {
                let [first, second] = twin.split(&trace);
                pair.second = Some(second);
                judgement.trace = Some(first);
            }
        }
        Ok((report, pair))
    }
}

/// Id of a property with the index of its copy.
pub fn label(property: &ir::Property) -> String {
    property
        .index
        .map_or(property.id.clone(), |i| format!("{}[{i}]", property.id))
}

/// One cycle of a replayed run.
#[derive(Debug, Clone)]
pub struct Cycle {
    /// All cells; inputs and named expressions that were not needed are evaluated too, unread inputs stay [`UNSET`].
    pub frame: Frame,
    /// The explorer's choices (input, value above the least).
    pub choices: Vec<(u32, u32)>,
}

/// Replays a trace with the interpreter.
pub fn replay(bound: &Bound, trace: &Trace) -> Vec<Cycle> {
    let system = Interpreted::new(bound);
    let mut frame = system.work();
    let mut state = vec![0; bound.states.len()];
    system.initial(&mut frame, &mut Replay::new(&trace.initial), &mut state);
    let mut cycles = Vec::new();
    for step in &trace.steps {
        let mut after = state.clone();
        let fault = system
            .next(&mut frame, &state, &mut Replay::new(step), &mut after)
            .is_err();
        for k in 0..bound.system.atoms.len() {
            // Atoms may have read inputs the step did not need; they belong to the cycle as well.
            let read = step.iter().map(|(i, _)| *i as usize).collect::<Vec<_>>();
            let mut probe = frame.clone();
            let mut extra = false;
            bound.atom(k, &mut probe, &mut |i| {
                extra |= !read.contains(&i);
                bound.inputs[i].0
                    + step
                        .iter()
                        .find(|(n, _)| *n as usize == i)
                        .map_or(0, |(_, v)| *v as i32)
            });
            if !extra {
                frame = probe;
            }
        }
        cycles.push(Cycle {
            frame: frame.clone(),
            choices: step.clone(),
        });
        if fault {
            break;
        }
        state = after;
    }
    cycles
}

/// The value of named expression `k` in a replayed cycle, if no unread input decides it.
pub fn lazy(bound: &Bound, cycle: &Cycle, k: usize) -> Option<i64> {
    let mut frame = cycle.frame.clone();
    let mut unread = false;
    let value = bound.lazy(k, &mut frame, &mut |i| {
        unread = true;
        bound.inputs[i].0
    });
    (!unread && value != i64::from(UNSET)).then_some(value)
}
