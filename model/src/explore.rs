//! The whole exploration: search, verdicts, traces.

use crate::crew::Crew;
use crate::cursor::Leaf;
use crate::graph::Graph;
use crate::hashed::{Halves, Hashed, Plain};
use crate::liveness::fair;
use crate::model::Model;
use crate::pack::{Key, Packer, space};
use crate::process::{Any, Origin, Process};
use crate::property::{Eval, Form, Property, Sign, validate};
use crate::recoverable::{recoverable, recovery};
use crate::report::{
    Error, FaultReport, Judgement, Options, Progress, Report, Step, Storage, Trace, Verdict,
};
use crate::response::{Response, Waiting, bounded, until};
use crate::search::{Known, search};
use crate::store::{Dense, Store};
use crate::system::System;
use crate::tally::Found;
use crate::ticks::Ticked;
use crate::trace::{Request, Run, Test, runs};
use crate::watch::Watch;
use std::collections::BTreeSet;
use std::sync::{Arc, PoisonError};

/// The bitmap is the default where it needs no more bytes than this.
const DEFAULT_BITMAP: u64 = 1 << 30;

/// Work that is written once for every kind of storage.
pub(crate) trait Job<O> {
    type Output;
    fn run<T: Store>(
        self,
        model: &Model<O, T::Key>,
        store: T,
        storage: Storage,
    ) -> Result<Self::Output, Error>;
}

/// Runs a job with the storage that suits the index space and the limits.
pub(crate) fn on_store<O: Origin, J: Job<O>>(
    origin: O,
    options: &Options,
    crew: &Crew,
    watch: &Watch,
    job: J,
) -> Result<J::Output, Error> {
    let space = space(origin.domains())?;
    let small = u64::try_from(space);
    if let Some(timer) = origin
        .timer()
        .filter(|_| options.intervals && small.is_ok())
    {
        let domain = origin.domains().get(timer).copied();
        let size = domain.map_or(1, |d| u32::try_from(d.size()).unwrap_or(u32::MAX));
        let packer = Packer::with_least(origin.domains(), Some(timer))?;
        let model = Model::with(origin, packer, crew, watch, options.way);
        return job.run(&model, Ticked::new(size), Storage::Intervals);
    }
    match (bitmap_fits(space, options), small) {
        (Some(small), _) => {
            let model = Model::new(origin, crew, watch, options.way)?;
            job.run(&model, Dense::new(small, crew.size()), Storage::Bitmap)
        }
        (None, Ok(_)) => {
            let model = Model::new(origin, crew, watch, options.way)?;
            job.run(&model, Hashed::<Plain>::new(), Storage::Hash64)
        }
        (None, Err(_)) => {
            let model = Model::new(origin, crew, watch, options.way)?;
            job.run(&model, Hashed::<Halves>::new(), Storage::Hash128)
        }
    }
}

/// The index space, if a bitmap of it is small enough.
pub(crate) fn bitmap_fits(space: u128, options: &Options) -> Option<u64> {
    // A quarter of the memory is left for lists, duties and traces.
    let bitmap = options
        .limits
        .memory
        .map_or(DEFAULT_BITMAP, |most| most / 4 * 3);
    u64::try_from(space)
        .ok()
        .filter(|_| Dense::need(space) <= u128::from(bitmap))
}

pub(crate) fn crew(options: &Options) -> Result<Crew, Error> {
    let threads = match options.limits.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        given => given,
    };
    Crew::new(threads, options.beside.clone())
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
    explored(Any::new(system), properties, options, progress)
}

/// The same for any system, so that it is compiled once and not for each of them.
#[inline(never)]
fn explored(
    system: Any,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
) -> Result<Report, Error> {
    validate(properties)?;
    let watch = Watch::new(options);
    let crew = crew(options)?;
    let job = Explore {
        properties,
        options,
        progress,
    };
    on_store(system, options, &crew, &watch, job)
}

struct Explore<'a> {
    properties: &'a [Property],
    options: &'a Options,
    progress: &'a mut dyn Progress,
}

/// How a run goes on after the cycle a request found: further steps, and where their loop starts among them.
pub(crate) type Tail<'a, K> = Box<dyn FnOnce(K) -> Option<(Vec<Step>, Option<usize>)> + 'a>;

/// What shows a verdict.
pub(crate) enum Evidence<'a, K> {
    None,
    /// A run to find, and how it goes on.
    Run(Request<'a, K>, Option<Tail<'a, K>>),
    /// A run found already.
    Trace(Trace),
    /// The number of cycles of a run nobody asked to see.
    Length(u64),
}

/// A verdict with what shows it.
pub(crate) struct Decision<'a, K> {
    pub(crate) verdict: Verdict,
    pub(crate) bound: Option<u64>,
    pub(crate) fastest: Option<u64>,
    pub(crate) evidence: Evidence<'a, K>,
}

impl<K> From<Verdict> for Decision<'_, K> {
    fn from(verdict: Verdict) -> Self {
        Decision {
            verdict,
            bound: None,
            fastest: None,
            evidence: Evidence::None,
        }
    }
}

impl Job<Any<'_>> for Explore<'_> {
    type Output = Report;

    fn run<T: Store>(
        self,
        model: &Model<Any, T::Key>,
        mut store: T,
        storage: Storage,
    ) -> Result<Report, Error> {
        let (found, known) = search(
            model,
            &mut store,
            self.properties,
            self.options,
            self.progress,
        )?;
        let finish = Finish {
            model,
            found,
            known,
            properties: self.properties,
            options: self.options,
            storage,
        };
        finish.report(store)
    }
}

/// What is left to do after the search: verdicts and traces.
pub(crate) struct Finish<'a, K> {
    pub(crate) model: &'a Model<'a, Any<'a>, K>,
    pub(crate) found: Found<K>,
    pub(crate) known: Known<'a, K>,
    pub(crate) properties: &'a [Property],
    pub(crate) options: &'a Options,
    pub(crate) storage: Storage,
}

impl<K: Key> Finish<'_, K> {
    pub(crate) fn report<T: Store<Key = K>>(self, mut store: T) -> Result<Report, Error> {
        let Finish {
            model,
            found,
            known,
            properties,
            options,
            storage,
        } = self;
        let tally = &found.tally;
        let decisions = decide(model, &found, known, properties, options, &store)?;
        let mut requests = Vec::new();
        let mut judgements = Vec::new();
        let mut tails = Vec::new();
        for (decision, property) in decisions.into_iter().zip(properties) {
            let mut judgement = Judgement {
                id: property.id.clone(),
                verdict: decision.verdict,
                length: None,
                bound: decision.bound,
                fastest: decision.fastest,
                trace: None,
            };
            let mut tail = None;
            match decision.evidence {
                Evidence::None => (),
                Evidence::Length(length) => judgement.length = Some(length),
                Evidence::Trace(trace) => {
                    judgement.length = Some(trace.steps.len() as u64);
                    judgement.trace = Some(trace);
                }
                Evidence::Run(request, then) => {
                    judgement.length = request
                        .at
                        .filter(|_| then.is_none())
                        .map(|(depth, _)| u64::from(depth) + 1);
                    tail = Some((requests.len(), then));
                    requests.push(request);
                }
            }
            judgements.push(judgement);
            tails.push(tail);
        }
        let first_fault = requests.len();
        let late = model
            .late
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        let codes: Vec<u32> = late
            .into_iter()
            .chain(tally.faults.keys().copied())
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect();
        for code in &codes {
            let test = fault_test(properties, *code);
            requests.push(Request {
                at: tally.faults.get(code).copied(),
                test,
                state: None,
            });
        }
        let found_runs = runs(model, &mut store, &requests)?;
        for (judgement, tail) in judgements.iter_mut().zip(tails) {
            let Some((request, then)) = tail else {
                continue;
            };
            let Some(run) = found_runs[request].clone() else {
                continue;
            };
            if let Some(trace) = extend(run, then) {
                judgement.length = Some(trace.steps.len() as u64);
                judgement.trace = Some(trace);
            }
        }
        let fault = |(code, run): (u32, &Option<Run<K>>)| FaultReport {
            code,
            length: match run {
                Some(run) => Some(run.trace.steps.len() as u64),
                None => found
                    .tally
                    .faults
                    .get(&code)
                    .map(|(depth, _)| u64::from(*depth) + 1),
            },
            trace: run.as_ref().map(|run| run.trace.clone()),
        };
        let faults = codes
            .into_iter()
            .zip(&found_runs[first_fault..])
            .map(fault)
            .collect();
        Ok(Report {
            states: tally.states,
            transitions: tally.transitions,
            depth: tally.depth,
            seconds: model.watch.elapsed().as_secs_f64(),
            resumable: found.resumable,
            complete: tally.complete
                && judgements
                    .iter()
                    .all(|j| j.verdict != Verdict::Inconclusive),
            absorbing_examples: found
                .tally
                .examples
                .iter()
                .map(|key| model.packer.state(*key))
                .collect(),
            coverage: tally.coverage.clone(),
            absorbing: tally.absorbing,
            memory: found.bytes.max(model.watch.peak()),
            stored: tally.stored,
            storage,
            index_space: space(model.origin.domains())?,
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
pub(crate) fn sign_test<'a, K: Key>(
    form: &'a Form,
    accept: impl Fn(Sign, K) -> bool + Send + Sync + 'a,
) -> Test<'a, K> {
    Arc::new(move |process: &mut dyn Process, choices, leaf| {
        let Leaf::To(after) = leaf else { return false };
        let sign = Eval {
            process,
            choices,
            fault: |_| (),
        }
        .sign(form);
        accept(sign, after)
    })
}

/// A test for cycles in which the step or the properties meet a fault.
fn fault_test<'a, K: Key>(properties: &'a [Property], code: u32) -> Test<'a, K> {
    Arc::new(move |process, choices, leaf| match leaf {
        Leaf::Fault(fault) => fault.code == code,
        Leaf::Discarded => false,
        Leaf::To(_) => {
            let mut atoms = properties.iter().flat_map(|p| p.form.atoms());
            atoms.any(|atom| {
                process
                    .atom(atom, choices)
                    .is_err_and(|fault| fault.code == code)
            })
        }
    })
}

/// The evidence of a verdict that the search itself has seen.
pub(crate) fn seen<'a, K: Key>(
    form: &'a Form,
    at: Option<(u32, K)>,
    accept: impl Fn(Sign) -> bool + Send + Sync + 'a,
) -> Evidence<'a, K> {
    match at {
        None => Evidence::None,
        Some(_) => Evidence::Run(
            Request {
                at,
                test: sign_test(form, move |s, _| accept(s)),
                state: None,
            },
            None,
        ),
    }
}

/// Judges every property.
fn decide<'a, T: Store>(
    model: &'a Model<'a, Any<'a>, T::Key>,
    found: &Found<T::Key>,
    known: Known<'a, T::Key>,
    properties: &'a [Property],
    options: &Options,
    store: &T,
) -> Result<Vec<Decision<'a, T::Key>>, Error> {
    let (tally, held) = (&found.tally, store.bytes());
    let mut goals = Vec::new();
    if tally.complete {
        for property in properties {
            if let Form::CanAlwaysReach { goal, using } = property.form {
                goals.push((goal, using));
            }
        }
    }
    let responses = properties
        .iter()
        .enumerate()
        .filter_map(|(number, property)| {
            let signs = tally.signs[number];
            match property.form {
                Form::LeadsTo {
                    goal,
                    assuming,
                    within: Some(_),
                    ..
                } if tally.complete && signs.first.is_some() => {
                    let response = Response::new(goal, assuming, signs);
                    Some((number, response, &found.pending[number]))
                }
                _ => None,
            }
        });
    let responses: Vec<_> = responses.collect();
    let mut waiting = Waiting::new(model, &responses, known);
    let mut graphs = waiting.small(&responses, held);
    if graphs.len() == responses.len() {
        waiting.end();
    }
    let mut lost = recoverable(model, &goals, store, tally.states)?.into_iter();
    let held = held + graphs.values().map(Graph::bytes).sum::<u64>();
    let mut decisions = Vec::new();
    for (number, Property { form, .. }) in properties.iter().enumerate() {
        let signs = tally.signs[number];
        let pending = &found.pending[number];
        let witness = match options.witnesses {
            true => seen(form, signs.first, |s| s.first),
            false => match signs.first {
                Some((depth, _)) => Evidence::Length(u64::from(depth) + 1),
                None => Evidence::None,
            },
        };
        let decision = |verdict, evidence| Decision {
            verdict,
            bound: None,
            fastest: None,
            evidence,
        };
        decisions.push(match form {
            Form::Always { .. } if signs.bad.is_some() => {
                decision(Verdict::Violated, seen(form, signs.bad, |s| s.bad))
            }
            Form::Reachable { .. } if signs.first.is_some() => {
                decision(Verdict::Reached, seen(form, signs.first, |s| s.first))
            }
            Form::Unless { holds, unless, .. } if tally.complete || signs.bad.is_some() => {
                match signs.first {
                    None => Verdict::Vacuous.into(),
                    Some(_) => until(
                        model,
                        form,
                        (*holds, *unless),
                        signs,
                        pending,
                        witness,
                        options,
                        held,
                    )?,
                }
            }
            _ if !tally.complete => Verdict::Inconclusive.into(),
            Form::Reachable { .. } => Verdict::Unreachable.into(),
            Form::Always { when: None, .. } => Verdict::Holds.into(),
            Form::CanAlwaysReach { .. } => recovery(lost.next().flatten(), witness),
            _ if signs.first.is_none() => Verdict::Vacuous.into(),
            Form::LeadsTo {
                goal,
                within,
                fair: conditions,
                assuming,
                ..
            } => {
                let response = Response::new(*goal, *assuming, signs);
                match within {
                    Some(within) => {
                        let known = graphs.remove(&number);
                        let graph = known.or_else(|| waiting.graph(response, pending, held));
                        bounded(model, form, response, *within, graph, witness)
                    }
                    None => fair(model, form, response, conditions, pending, witness, held),
                }
            }
            Form::Always { .. } | Form::Unless { .. } => decision(Verdict::Holds, witness),
        });
    }
    Ok(decisions)
}
