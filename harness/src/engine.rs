//! Explores a table: generated step function where there is one, else the interpreter; two runs for `independent`.

use std::collections::BTreeMap;

use stillpoint_model::table::{Generated, Interpreted, properties};
use stillpoint_model::{
    Error, Form, Judgement, Options, Progress, Property, Report, Replay, System, Trace, Twin, Verdict, explore,
};
use stillpoint_spec::bind::Bound;
use stillpoint_spec::eval::{Frame, UNSET};
use stillpoint_spec::ir;

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
    let listed = properties(bound);
    let single: Vec<Property> = listed.iter().map(|(_, p)| p.clone()).collect();
    let generated = if interpret { None } else { Generated::find(bound) };
    let (mut report, evaluator) = match generated {
        Some(system) => (explore(&system, &single, options, progress)?, Evaluator::Generated),
        None => (explore(&Interpreted::new(bound), &single, options, progress)?, Evaluator::Interpreter),
    };
    let mut judged: Vec<Option<Judgement>> = vec![None; bound.system.properties.len()];
    for ((k, _), judgement) in listed.iter().zip(std::mem::take(&mut report.properties)) {
        judged[*k] = Some(judgement);
    }
    let mut pairs = BTreeMap::new();
    for (k, property) in bound.system.properties.iter().enumerate() {
        let ir::Form::Independent { observe, of, condition } = &property.form else {
            continue;
        };
        let system = Interpreted::new(bound);
        let size = |k: usize| (i64::from(bound.inputs[k].1) - i64::from(bound.inputs[k].0) + 1) as u32;
        let listed = of.iter().map(|k| (*k as u32, size(*k))).collect();
        let twin = Twin::new(&system, listed, *condition, observe.clone());
        type Of<'a> = Twin<'a, Interpreted<'a>>;
        let form = Form::Always { when: Some(Of::BOTH), then: Of::AGREE };
        let claim = [Property { id: label(property), form }];
        let mut outcome = explore(&twin, &claim, options, &mut ())?;
        report.complete &= outcome.complete;
        let mut pair = Pair { states: outcome.states, second: None };
        judged[k] = outcome.properties.pop().map(|mut j| {
            if let Some(trace) = &j.trace {
                let [first, second] = twin.split(trace);
                pair.second = Some(second);
                j.trace = Some(first);
            }
            j
        });
        pairs.insert(k, pair);
    }
    report.properties = judged
        .into_iter()
        .zip(&bound.system.properties)
        .map(|(j, p)| {
            j.unwrap_or_else(|| Judgement {
                id: label(p),
                verdict: Verdict::Inconclusive,
                length: None,
                bound: None,
                trace: None,
            })
        })
        .collect();
    Ok(Outcome { report, evaluator, pairs })
}

/// Id of a property with the index of its copy.
pub fn label(property: &ir::Property) -> String {
    property.index.map_or(property.id.clone(), |i| format!("{}[{i}]", property.id))
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
        let fault = system.next(&mut frame, &state, &mut Replay::new(step), &mut after).is_err();
        for k in 0..bound.system.atoms.len() {
            // Atoms may have read inputs the step did not need; they belong to the cycle as well.
            let read = step.iter().map(|(i, _)| *i as usize).collect::<Vec<_>>();
            let mut probe = frame.clone();
            let mut extra = false;
            bound.atom(k, &mut probe, &mut |i| {
                extra |= !read.contains(&i);
                bound.inputs[i].0 + step.iter().find(|(n, _)| *n as usize == i).map_or(0, |(_, v)| *v as i32)
            });
            if !extra {
                frame = probe;
            }
        }
        cycles.push(Cycle { frame: frame.clone(), choices: step.clone() });
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
