//! Duties (obligations) with an end that the next few cycles decide: bounded responses, which are bounded leads-to, and weak until.

use crate::choices::Odometer;
use crate::crew::Crew;
use crate::cursor::Leaf;
use crate::duty::Duty;
use crate::explore::{Decision, Evidence, Job, Tail, on_store, seen, sign_test};
use crate::graph::{Graph, Mark, Rules, Walker};
use crate::model::Model;
use crate::pack::Key;
use crate::process::{Any, Process};
use crate::property::{Form, Property};
use crate::report::{Error, Options, Storage, Trace, Until, Verdict};
use crate::search::{Known, search};
use crate::set::Set;
use crate::stages::{Condition, MOST_CONDITIONS, waits};
use crate::store::Store;
use crate::tally::Signs;
use crate::trace::{Request, runs};
use crate::watch::Watch;
use std::cmp::Reverse;
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

    /// What the stages have to tell of each cycle: that the response waits on, and that it ends.
    pub(crate) fn waits(self) -> [Condition; 2] {
        waits(self.goal, self.assuming)
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

/// Finds the graphs of responses.
pub(crate) struct Waiting<'a, K> {
    model: &'a Model<'a, Any<'a>, K>,
    walkers: Vec<Walker<'a, 'a, K>>,
    /// What they tell of each cycle.
    told: Vec<Condition>,
}

impl<'a, K: Key> Waiting<'a, K> {
    /// With what the search has learned of the stages of a cycle, if it tells enough.
    pub(crate) fn new(
        model: &'a Model<'a, Any<'a>, K>,
        responses: &[(usize, Response, &Set<K>)],
        known: Known<'a, K>,
    ) -> Self {
        let mut needed: Vec<_> = responses.iter().flat_map(|(_, r, _)| r.waits()).collect();
        needed.sort_unstable();
        needed.dedup();
        let Known { staged, told } = known;
        let (walkers, told) = if responses.is_empty() || needed.len() > MOST_CONDITIONS {
            (Vec::new(), Vec::new())
        } else if !staged.is_empty() && needed.iter().all(|one| told.contains(one)) {
            let staged = staged.into_iter().map(Some);
            (staged.map(|s| Walker::new(model, s)).collect(), told)
        } else {
            drop(staged);
            (Walker::all(model, &needed), needed)
        };
        Waiting {
            model,
            walkers,
            told,
        }
    }

    /// Forgets what is known of the stages.
    pub(crate) fn end(&mut self) {
        self.walkers.clear();
    }

    /// The graphs of those of these responses whose graphs are small: each of them is found by one thread.
    pub(crate) fn small(
        &mut self,
        responses: &[(usize, Response, &Set<K>)],
        held: u64,
    ) -> BTreeMap<usize, Graph<K>> {
        let Waiting {
            model,
            walkers,
            told,
        } = self;
        let room = held + model.known() + ROOM * responses.len() as u64;
        let fits = model.watch.memory().is_none_or(|most| room <= most);
        if responses.len() < 2 || walkers.len() < 2 || !fits {
            return BTreeMap::new();
        }
        // Each thread begins with large ones, so that none of them is begun when the others are done.
        let mut order: Vec<_> = responses.iter().collect();
        order.sort_by_cached_key(|(_, _, pending)| Reverse(pending.counts().iter().sum::<usize>()));
        let threads = walkers.len();
        let of = |thread| order.iter().skip(thread).step_by(threads).copied();
        let order: Vec<_> = (0..threads).flat_map(of).collect();
        let mut workers: Vec<_> = walkers.iter_mut().map(|w| (w, Vec::new())).collect();
        model.crew.share(&mut workers, order.len(), |worker, n| {
            let (walker, graphs) = worker;
            let (number, response, pending) = *order[n];
            let one = std::slice::from_mut(*walker);
            let graph = waiting(model, response, pending, (one, told), held, ROOM);
            graphs.extend(graph.map(|graph| (number, graph)));
        });
        workers.into_iter().flat_map(|(_, graphs)| graphs).collect()
    }

    /// The graph of a response, found by all threads.
    pub(crate) fn graph(
        &mut self,
        response: Response,
        pending: &Set<K>,
        held: u64,
    ) -> Option<Graph<K>> {
        let all = |by| waiting(self.model, response, pending, by, held, u64::MAX);
        if self.walkers.is_empty() {
            let told = response.waits();
            let mut own = Walker::all(self.model, &told);
            return all((&mut own, &told));
        }
        all((&mut self.walkers, &self.told))
    }
}

/// The graph of the cycles without the goal, from the states in which the duty is pending, found by walkers that tell of these conditions.
fn waiting<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    response: Response,
    pending: &Set<K>,
    (walkers, told): (&mut [Walker<'a, 'a, K>], &[Condition]),
    held: u64,
    most: u64,
) -> Option<Graph<K>> {
    let edge = edge(model, response);
    let bit = |condition| told.iter().position(|one| *one == condition);
    let [waits, ends] = response.waits().map(bit);
    let holds = |marks: u128, bit: Option<usize>| bit.is_some_and(|bit| marks >> bit & 1 != 0);
    let rules = Rules {
        rule: &edge,
        mark: &|marks, _| match (holds(marks, waits), holds(marks, ends)) {
            (false, false) => Mark::Outside,
            (true, _) => Mark::Edge(0),
            (false, true) => Mark::Exit,
        },
    };
    Graph::build(model, &pending.sorted(), &rules, walkers, held, most)
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
        let conditions = [
            vec![(unless, false), (holds, true)],
            vec![(unless, false), (holds, false)],
        ];
        let mut walkers = Walker::all(model, &conditions);
        let seeds = pending.sorted();
        if Graph::build(model, &seeds, &rules, &mut walkers, held, u64::MAX).is_none()
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
        let (found, _) = search(model, &mut store, &property, self.options, &mut ())?;
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
