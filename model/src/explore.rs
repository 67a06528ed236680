//! The whole exploration: search, verdicts, traces.

use crate::crew::{Crew, Watch};
use crate::cursor::Leaf;
use crate::hashed::Hashed;
use crate::pack::{Key, Packer, space};
use crate::property::{Eval, Form, Property, Sign, validate};
use crate::report::{Error, FaultReport, Judgement, Options, Progress, Report, Storage, Trace, Verdict};
use crate::search::{Found, Model, search};
use crate::store::{Dense, Store};
use crate::system::System;
use crate::trace::{Request, Run, Test, runs};
use std::sync::Arc;

/// The bitmap is the default where it needs no more bytes than this.
const DEFAULT_BITMAP: u64 = 1 << 30;

/// Work that is written once for every kind of storage.
pub(crate) trait Job<S> {
    type Output;
    fn run<T: Store>(self, model: &Model<S, T::Key>, store: T, storage: Storage) -> Result<Self::Output, Error>;
}

/// Runs a job with the storage that suits the index space and the limits.
pub(crate) fn on_store<S: System, J: Job<S>>(
    system: &S,
    options: &Options,
    crew: &Crew,
    watch: &Watch,
    job: J,
) -> Result<J::Output, Error> {
    let space = space(system.domains())?;
    // A quarter of the memory is left for lists, duties and traces.
    let bitmap = options.limits.memory.map_or(DEFAULT_BITMAP, |most| most / 4 * 3);
    match u64::try_from(space) {
        Ok(small) if Dense::need(space) <= u128::from(bitmap) => {
            let model = Model { system, packer: Packer::new(system.domains())?, crew, watch };
            job.run(&model, Dense::new(small, crew.size()), Storage::Bitmap)
        }
        Ok(_) => {
            let model = Model { system, packer: Packer::new(system.domains())?, crew, watch };
            job.run(&model, Hashed::<u64>::new(), Storage::Hash64)
        }
        Err(_) => {
            let model = Model { system, packer: Packer::new(system.domains())?, crew, watch };
            job.run(&model, Hashed::<u128>::new(), Storage::Hash128)
        }
    }
}

pub(crate) fn crew(options: &Options) -> Result<Crew, Error> {
    let threads = match options.limits.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        given => given,
    };
    Crew::new(threads)
}

/// Explores every reachable state of a system and judges the properties.
///
/// The report, its traces included, is the same for any number of threads as long as no limit is reached.
///
/// # Errors
/// A system that cannot be explored or contradicts itself, or a property that makes no sense: see [`Error`].
pub fn explore<S: System>(
    system: &S,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
) -> Result<Report, Error> {
    validate(properties)?;
    let watch = Watch::new(options.limits);
    let crew = crew(options)?;
    on_store(system, options, &crew, &watch, Explore { properties, options, progress })
}

struct Explore<'a> {
    properties: &'a [Property],
    options: &'a Options,
    progress: &'a mut dyn Progress,
}

/// How a run goes on after the cycle a request found: further steps, and where their loop starts among them.
pub(crate) type Tail<'a, K> = Box<dyn FnOnce(K) -> Option<(Vec<Vec<(u32, u32)>>, Option<usize>)> + 'a>;

/// What shows a verdict.
pub(crate) enum Evidence<'a, S: System, K> {
    None,
    /// A run to find, and how it goes on.
    Run(Request<'a, S, K>, Option<Tail<'a, K>>),
    /// A run found already.
    Trace(Trace),
}

/// A verdict with what shows it.
pub(crate) struct Decision<'a, S: System, K> {
    pub(crate) verdict: Verdict,
    pub(crate) bound: Option<u64>,
    pub(crate) evidence: Evidence<'a, S, K>,
}

impl<S: System, K> From<Verdict> for Decision<'_, S, K> {
    fn from(verdict: Verdict) -> Self {
        Decision { verdict, bound: None, evidence: Evidence::None }
    }
}

impl<S: System> Job<S> for Explore<'_> {
    type Output = Report;

    fn run<T: Store>(self, model: &Model<S, T::Key>, mut store: T, storage: Storage) -> Result<Report, Error> {
        let found = search(model, &mut store, self.properties, self.options, self.progress)?;
        let mut memory = found.bytes;
        let mut requests = Vec::new();
        let mut decisions = Vec::new();
        for (property, number) in self.properties.iter().zip(0..) {
            decisions.push(decide(model, &found, property, number, self.options)?);
        }
        let _ = &mut memory;
        let mut judgements = Vec::new();
        let mut tails = Vec::new();
        for (decision, property) in decisions.into_iter().zip(self.properties) {
            let mut judgement = Judgement {
                id: property.id.clone(),
                verdict: decision.verdict,
                length: None,
                bound: decision.bound,
                trace: None,
            };
            let mut tail = None;
            match decision.evidence {
                Evidence::None => (),
                Evidence::Trace(trace) => {
                    judgement.length = Some(trace.steps.len() as u64);
                    judgement.trace = Some(trace);
                }
                Evidence::Run(request, then) => {
                    judgement.length = request.at.filter(|_| then.is_none()).map(|(depth, _)| u64::from(depth) + 1);
                    tail = Some((requests.len(), then));
                    requests.push(request);
                }
            }
            judgements.push(judgement);
            tails.push(tail);
        }
        let first_fault = requests.len();
        let codes: Vec<u32> = found.faults.keys().copied().collect();
        for (code, at) in &found.faults {
            let test = fault_test(model.system, self.properties, *code);
            requests.push(Request { at: Some(*at), test, state: None });
        }
        let found_runs = runs(model, &mut store, &requests)?;
        for (judgement, tail) in judgements.iter_mut().zip(tails) {
            let Some((request, then)) = tail else { continue };
            let Some(run) = found_runs[request].clone() else { continue };
            if let Some(trace) = extend(run, then) {
                judgement.length = Some(trace.steps.len() as u64);
                judgement.trace = Some(trace);
            }
        }
        let fault = |(code, run): (u32, &Option<Run<T::Key>>)| FaultReport {
            code,
            length: found.faults.get(&code).map(|(depth, _)| u64::from(*depth) + 1),
            trace: run.as_ref().map(|run| run.trace.clone()),
        };
        let faults = codes.into_iter().zip(&found_runs[first_fault..]).map(fault).collect();
        Ok(Report {
            states: found.states,
            transitions: found.transitions,
            depth: found.depth,
            seconds: model.watch.seconds(),
            complete: found.complete && judgements.iter().all(|j| j.verdict != Verdict::Inconclusive),
            absorbing_examples: found.examples.iter().map(|key| model.packer.state(*key)).collect(),
            coverage: found.coverage,
            absorbing: found.absorbing,
            memory,
            storage,
            index_space: space(model.system.domains())?,
            faults,
            properties: judgements,
        })
    }
}

fn extend<K>(run: Run<K>, tail: Option<Tail<K>>) -> Option<Trace> {
    let Run { mut trace, end } = run;
    if let Some(tail) = tail {
        let (steps, start) = tail(end?)?;
        trace.loop_start = start.map(|start| trace.steps.len() + start);
        trace.steps.extend(steps);
    }
    Some(trace)
}

/// A test for cycles that mean something to a property.
pub(crate) fn sign_test<'a, S: System, K: Key>(
    system: &'a S,
    form: &'a Form,
    accept: impl Fn(Sign, K) -> bool + Send + Sync + 'a,
) -> Test<'a, S, K> {
    Arc::new(move |work, choices, leaf| {
        let Leaf::To(after) = leaf else { return false };
        let sign = Eval { system, work, choices, fault: |_| () }.sign(form);
        accept(sign, after)
    })
}

/// A test for cycles in which the step or the properties meet a fault.
fn fault_test<'a, S: System, K: Key>(system: &'a S, properties: &'a [Property], code: u32) -> Test<'a, S, K> {
    Arc::new(move |work, choices, leaf| match leaf {
        Leaf::Fault(fault) => fault.code == code,
        Leaf::Discarded => false,
        Leaf::To(_) => {
            let mut met = false;
            for property in properties {
                let fault = |fault: crate::Fault| met |= fault.code == code;
                Eval { system, work: &mut *work, choices: &mut *choices, fault }.sign(&property.form);
            }
            met
        }
    })
}

/// The evidence of a verdict that the search itself has seen.
pub(crate) fn seen<'a, S: System, K: Key>(
    system: &'a S,
    form: &'a Form,
    at: Option<(u32, K)>,
    accept: impl Fn(Sign) -> bool + Send + Sync + 'a,
) -> Evidence<'a, S, K> {
    match at {
        None => Evidence::None,
        Some(_) => Evidence::Run(Request { at, test: sign_test(system, form, move |s, _| accept(s)), state: None }, None),
    }
}

fn decide<'a, S: System, K: Key>(
    model: &Model<'a, S, K>,
    found: &Found<K>,
    property: &'a Property,
    number: usize,
    options: &Options,
) -> Result<Decision<'a, S, K>, Error> {
    let signs = found.signs[number];
    let form = &property.form;
    let witness = || match options.witnesses {
        true => seen(model.system, form, signs.first, |s| s.first),
        false => Evidence::None,
    };
    let decision = |verdict, evidence| Decision { verdict, bound: None, evidence };
    Ok(match form {
        Form::Always { .. } if signs.bad.is_some() => {
            decision(Verdict::Violated, seen(model.system, form, signs.bad, |s| s.bad))
        }
        Form::Reachable { .. } if signs.first.is_some() => {
            decision(Verdict::Reached, seen(model.system, form, signs.first, |s| s.first))
        }
        _ if !found.complete => Verdict::Inconclusive.into(),
        Form::Reachable { .. } => Verdict::Unreachable.into(),
        Form::Always { when: None, .. } => Verdict::Holds.into(),
        Form::Always { .. } | Form::LeadsTo { .. } | Form::Unless { .. } if signs.first.is_none() => {
            Verdict::Vacuous.into()
        }
        Form::Always { .. } => decision(Verdict::Holds, witness()),
        _ => Verdict::Inconclusive.into(),
    })
}
