//! Duties (obligations) with an end that the next few cycles decide: bounded responses, which are bounded leads-to, and weak until.

use crate::choices::Odometer;
use crate::crew::Crew;
use crate::cursor::Leaf;
use crate::duty::Duty;
use crate::explore::{Decision, Evidence, Job, Tail, on_store, seen, sign_test};
use crate::graph::{Graph, Mark, Rules};
use crate::model::Model;
use crate::pack::Key;
use crate::process::{Any, Process};
use crate::property::{Form, Property};
use crate::report::{Error, Options, Storage, Trace, Until, Verdict};
use crate::search::search;
use crate::set::Set;
use crate::stages::Condition;
use crate::store::Store;
use crate::tally::Signs;
use crate::trace::{Request, runs};
use crate::watch::Watch;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The most cycles without the goal that a counterexample lists.
const LONGEST: u32 = 1 << 20;

/// What a response is about.
#[derive(Clone, Copy)]
pub(crate) struct Response {
    pub(crate) goal: usize,
    pub(crate) assuming: Option<usize>,
    /// Whether some cycle starts the response and ends it at once.
    pub(crate) met: bool,
}

impl Response {
    pub(crate) fn new<K>(goal: usize, assuming: Option<usize>, signs: Signs<K>) -> Self {
        let met = signs.met;
        Response {
            goal,
            assuming,
            met,
        }
    }
}

/// The most bytes of the graph of a response that one thread finds by itself.
const ROOM: u64 = 1 << 20;

/// What a cycle is to the graph of a response.
fn edge<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    Response { goal, assuming, .. }: Response,
) -> impl Fn(&mut dyn Process, &mut Odometer, K) -> Mark + Sync + 'a {
    move |process, choices, _| {
        let mut eval = model.eval(process, choices);
        match (eval.atom(goal), eval.given(assuming)) {
            (false, true) => Mark::Edge(0),
            (true, true) => Mark::Exit,
            (_, false) => Mark::Outside,
        }
    }
}

/// The graph of the cycles without the goal, from the states in which the duty is pending: by the calling thread alone if it takes
/// `alone` bytes at most, or by all.
pub(crate) fn waiting<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    response: Response,
    pending: &Set<K>,
    held: u64,
    alone: Option<u64>,
) -> Option<Graph<K>> {
    let edge = edge(model, response);
    let given: Condition = response.assuming.iter().map(|atom| (*atom, true)).collect();
    let with = |value| {
        given
            .iter()
            .copied()
            .chain([(response.goal, value)])
            .collect()
    };
    let rules = Rules {
        rule: &edge,
        conditions: vec![with(false), with(true)],
        mark: &|marks, _| match marks & 3 {
            0 => Mark::Outside,
            1 => Mark::Edge(0),
            _ => Mark::Exit,
        },
    };
    let seeds = pending.sorted();
    Graph::build(model, &seeds, &rules, held, alone)
}

/// The graphs of those of these responses whose graphs are small. Each of them is found by one thread, as what one learns of the stages
/// of a cycle is of no use to another one.
pub(crate) fn side_by_side<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    responses: &[(usize, Response, &Set<K>)],
    held: u64,
) -> BTreeMap<usize, Graph<K>> {
    let room = held + model.known() + ROOM * responses.len() as u64;
    let fits = model.watch.memory().is_none_or(|most| room <= most);
    if responses.len() < 2 || model.crew.size() < 2 || !fits {
        return BTreeMap::new();
    }
    let mut workers: Vec<_> = (0..model.crew.size()).map(|_| Vec::new()).collect();
    model.crew.share(&mut workers, responses.len(), |own, n| {
        let (number, response, pending) = responses[n];
        let graph = waiting(model, response, pending, held, Some(ROOM));
        own.extend(graph.map(|graph| (number, graph)));
    });
    workers.into_iter().flatten().collect()
}

/// Judges `goal` in one of the cycles k ..= k + within. The states after cycles with `when` and without `goal` are the
/// seeds of a graph of the cycles without `goal`: the longest path from a seed tells the least bound that holds, the
/// shortest one to a state that a cycle with `goal` leaves, the fastest reaction.
pub(crate) fn bounded<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    form: &'a Form,
    response: Response,
    within: u32,
    graph: Option<Graph<K>>,
    witness: Evidence<'a, K>,
) -> Decision<'a, K> {
    let edge = edge(model, response);
    let Some(graph) = graph else {
        return Verdict::Inconclusive.into();
    };
    let heights = graph.components(|_| true).heights(&graph);
    // With a path of h edges from a seed, h + 1 cycles pass without the goal after the first one.
    let bound = (0..graph.seeds)
        .map(|seed| heights[seed as usize].map(|h| u64::from(h) + 1))
        .try_fold(0, |most, one| one.map(|one| most.max(one)));
    let fastest = match response.met {
        true => Some(0),
        false => graph.nearest_exit().map(|edges| edges + 1),
    };
    if bound.is_some_and(|bound| bound <= u64::from(within)) {
        return Decision {
            verdict: Verdict::Holds,
            bound,
            fastest,
            evidence: witness,
        };
    }
    let shared = Arc::new((graph, heights));
    let other = Arc::clone(&shared);
    let test = sign_test(form, move |sign, after| {
        let (graph, heights) = &*other;
        let long = |node: u32| heights[node as usize].is_none_or(|h| h >= within);
        sign.pending && graph.number(after).is_some_and(long)
    });
    let tail: Tail<K> = Box::new(move |end| {
        if within > LONGEST {
            return None;
        }
        let (graph, heights) = &*shared;
        let mut cursor = model.retracing();
        let mut node = graph.number(end)?;
        let mut steps = Vec::new();
        for rest in (0..within).rev() {
            let long = |to: u32| heights[to as usize].is_none_or(|h| h >= rest);
            let to = graph.edges(node).iter().find(|e| long(e.to))?.to;
            let wanted = Leaf::To(graph.key(to));
            let (choices, _) =
                cursor.first(&model.packer, graph.key(node), |process, choices, leaf| {
                    leaf == wanted && edge(&mut **process, choices, graph.key(to)) == Mark::Edge(0)
                })?;
            steps.push(choices);
            node = to;
        }
        Some((steps, None))
    });
    let request = Request {
        at: None,
        test,
        state: None,
    };
    Decision {
        verdict: Verdict::Violated,
        bound,
        fastest,
        evidence: Evidence::Run(request, Some(tail)),
    }
}

/// Judges a weak until: a violation is seen in the cycle of `when` itself, or in a cycle under a pending duty.
#[allow(clippy::too_many_arguments)]
pub(crate) fn until<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    form: &'a Form,
    (holds, unless): (usize, usize),
    signs: Signs<K>,
    pending: &Set<K>,
    witness: Evidence<'a, K>,
    options: &Options,
    held: u64,
) -> Result<Decision<'a, K>, Error> {
    let violated = AtomicBool::new(signs.bad.is_some());
    if signs.bad.is_none() {
        let rule = |process: &mut dyn Process, choices: &mut Odometer, _: K| {
            let sign = model.eval(process, choices).duty(holds, unless);
            if sign.bad {
                violated.store(true, Ordering::Relaxed);
            }
            match sign.pending {
                true => Mark::Edge(0),
                false => Mark::Outside,
            }
        };
        let rules = Rules {
            rule: &rule,
            conditions: vec![
                vec![(unless, false), (holds, true)],
                vec![(unless, false), (holds, false)],
            ],
            mark: &|marks, _| {
                if marks & 2 != 0 {
                    violated.store(true, Ordering::Relaxed);
                }
                match marks & 1 {
                    0 => Mark::Outside,
                    _ => Mark::Edge(0),
                }
            },
        };
        if Graph::build(model, &pending.sorted(), &rules, held, None).is_none()
            && !violated.load(Ordering::Relaxed)
        {
            return Ok(Verdict::Inconclusive.into());
        }
    }
    if !violated.into_inner() {
        return Ok(Decision {
            verdict: Verdict::Holds,
            bound: None,
            fastest: None,
            evidence: witness,
        });
    }
    let trace = shortest(model.origin, form, options, model.crew, model.afterwards())?;
    // Memory may not suffice for the search with the duty; a violation in the cycle of `when` has a run without it.
    let evidence = match trace {
        Some(trace) => Evidence::Trace(trace),
        None => seen(form, signs.bad, |sign| sign.bad),
    };
    Ok(Decision {
        verdict: Verdict::Violated,
        bound: None,
        fastest: None,
        evidence,
    })
}

/// The shortest run that violates a weak until: the duty becomes part of the state, and its violation an atom.
fn shortest(
    system: Any,
    form: &Form,
    options: &Options,
    crew: &Crew,
    watch: &Watch,
) -> Result<Option<Trace>, Error> {
    let duty = Duty::new(system, form);
    let options = Options {
        until: Until::Decided,
        // It is another system, and its search is short beside the one that is kept.
        checkpoint: None,
        ..options.clone()
    };
    let trace = on_store(
        Any::of(&duty),
        &options,
        crew,
        watch,
        Counterexample { options: &options },
    )?;
    Ok(trace.map(|trace| duty.strip(trace)))
}

/// Finds the shortest run to a cycle in which atom 0 is FALSE.
struct Counterexample<'a> {
    options: &'a Options,
}

impl Job<Any<'_>> for Counterexample<'_> {
    type Output = Option<Trace>;

    fn run<T: Store>(
        self,
        model: &Model<Any, T::Key>,
        mut store: T,
        _: Storage,
    ) -> Result<Self::Output, Error> {
        let form = Form::Always {
            when: None,
            then: 0,
        };
        let property = [Property {
            id: String::new(),
            form: form.clone(),
        }];
        let found = search(model, &mut store, &property, self.options, &mut ())?;
        let Some(at) = found.tally.signs[0].bad else {
            return Ok(None);
        };
        let test = sign_test(&form, |sign, _| sign.bad);
        let runs = runs(
            model,
            &mut store,
            &[Request {
                at: Some(at),
                test,
                state: None,
            }],
        )?;
        Ok(runs.into_iter().flatten().next().map(|run| run.trace))
    }
}
