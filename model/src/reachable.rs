//! Views of the reachable states: all of them in order, and the graph of what a projection shows.

use crate::crew::Watch;
use crate::cursor::{Cursor, Leaf};
use crate::explore::{Job, crew, on_store};
use crate::process::{Any, Origin};
use crate::report::{Error, Options, Storage};
use crate::search::{Model, initial};
use crate::store::Store;
use crate::system::System;
use petgraph::graph::{DiGraph, NodeIndex};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

/// The reachable states as a projection shows them.
#[derive(Clone, Debug)]
pub struct ControlGraph<P> {
    /// The values of the projection in ascending order; an edge tells the number of transitions (input combinations,
    /// saturating) that lead from the one to the other, stays included.
    pub graph: DiGraph<P, u128>,
    /// The values of initial states.
    pub initial: Vec<NodeIndex>,
    /// Whether every reachable state was explored.
    pub complete: bool,
}

/// The control-state graph: the reachable states under a projection, for example to the mode variables.
///
/// # Errors
/// As [`crate::explore`].
pub fn control_graph<S: System, P: Ord + Clone + Send>(
    system: &S,
    options: &Options,
    project: impl Fn(&[i32]) -> P + Sync,
) -> Result<ControlGraph<P>, Error> {
    let watch = Watch::new(options.limits);
    on_store(
        Any::new(system),
        options,
        &crew(options)?,
        &watch,
        Project { project },
    )
}

/// Calls `each` with every reachable state, by depth and in the order of indices inside a depth. The answer says
/// whether all reachable states were met.
///
/// # Errors
/// As [`crate::explore`].
pub fn reachable<S: System>(
    system: &S,
    options: &Options,
    each: &mut dyn FnMut(&[i32]),
) -> Result<bool, Error> {
    let watch = Watch::new(options.limits);
    on_store(
        Any::new(system),
        options,
        &crew(options)?,
        &watch,
        Visit { each },
    )
}

struct Visit<'a> {
    each: &'a mut dyn FnMut(&[i32]),
}

impl Job<Any<'_>> for Visit<'_> {
    type Output = bool;

    fn run<T: Store>(
        self,
        model: &Model<Any, T::Key>,
        mut store: T,
        _: Storage,
    ) -> Result<bool, Error> {
        let mut state = vec![0; model.origin.domains().len()];
        let show = |store: &T| {
            for key in store.frontier() {
                model.packer.unpack(key, &mut state);
                (self.each)(&state);
            }
        };
        levels(model, &mut store, || (), |(), _, _| (), show)
            .map(|_| model.watch.stopped().is_none())
    }
}

struct Project<F> {
    project: F,
}

/// The projections seen by one worker and the transitions between them.
struct Seen<P> {
    before: Option<P>,
    nodes: BTreeSet<P>,
    edges: BTreeMap<(P, P), u128>,
}

impl<P: Ord + Clone + Send, F: Fn(&[i32]) -> P + Sync> Job<Any<'_>> for Project<F> {
    type Output = ControlGraph<P>;

    fn run<T: Store>(
        self,
        model: &Model<Any, T::Key>,
        mut store: T,
        _: Storage,
    ) -> Result<Self::Output, Error> {
        let mut starts = BTreeSet::new();
        let project = |key| (self.project)(&model.packer.state(key));
        let none = || Seen {
            before: None,
            nodes: BTreeSet::new(),
            edges: BTreeMap::new(),
        };
        let each = |seen: &mut Seen<P>, key, to: Option<(T::Key, u128)>| {
            let Some((after, weight)) = to else {
                let node = project(key);
                seen.nodes.insert(node.clone());
                seen.before = Some(node);
                return;
            };
            if let Some(before) = &seen.before {
                let count = seen
                    .edges
                    .entry((before.clone(), project(after)))
                    .or_insert(0);
                *count = count.saturating_add(weight);
            }
        };
        let mut first = true;
        let start = |store: &T| {
            if std::mem::take(&mut first) {
                starts.extend(store.frontier().into_iter().map(project));
            }
        };
        let mut total = none();
        for worker in levels(model, &mut store, none, each, start)? {
            total.nodes.extend(worker.nodes);
            for ((from, to), weight) in worker.edges {
                total.nodes.extend([from.clone(), to.clone()]);
                let count = total.edges.entry((from, to)).or_insert(0);
                *count = count.saturating_add(weight);
            }
        }
        let mut graph = DiGraph::new();
        let numbers: BTreeMap<P, NodeIndex> = total
            .nodes
            .into_iter()
            .map(|node| (node.clone(), graph.add_node(node)))
            .collect();
        for ((from, to), weight) in total.edges {
            graph.add_edge(numbers[&from], numbers[&to], weight);
        }
        let initial = starts
            .iter()
            .filter_map(|node| numbers.get(node).copied())
            .collect();
        Ok(ControlGraph {
            graph,
            initial,
            complete: model.watch.stopped().is_none(),
        })
    }
}

/// Goes through all levels. `each` is called with a state and None, then for each of its transitions with the state
/// after it and the weight (successive ones to the same state added up); `level` before each level is explored.
fn levels<T: Store, W: Send>(
    model: &Model<Any, T::Key>,
    store: &mut T,
    new: impl Fn() -> W,
    each: impl Fn(&mut W, T::Key, Option<(T::Key, u128)>) + Sync,
    mut level: impl FnMut(&T),
) -> Result<Vec<W>, Error> {
    let mut workers: Vec<_> = (0..model.crew.size())
        .map(|_| (Cursor::new(&model.origin), store.local(), new()))
        .collect();
    let mut frontier = initial(model, store)?;
    while frontier > 0 && !model.watch.over(store.bytes()) {
        level(store);
        let now = &*store;
        model
            .crew
            .share(&mut workers, now.pieces(), |(cursor, local, own), piece| {
                if model.watch.over(now.bytes()) {
                    return;
                }
                now.each(piece, |key| {
                    each(own, key, None);
                    let mut run: Option<(T::Key, u128)> = None;
                    cursor.leaves(&model.packer, key, |_, odometer, leaf| {
                        if let Leaf::To(after) = leaf {
                            let weight = odometer.weight();
                            run = match run {
                                Some((to, sum)) if to == after => {
                                    Some((to, sum.saturating_add(weight)))
                                }
                                other => {
                                    if other.is_some() {
                                        each(own, key, other);
                                    }
                                    now.visit(local, after);
                                    Some((after, weight))
                                }
                            };
                        }
                        ControlFlow::Continue(())
                    });
                    if run.is_some() {
                        each(own, key, run);
                    }
                });
            });
        frontier = store.advance(workers.iter_mut().map(|(_, local, _)| local).collect());
    }
    Ok(workers.into_iter().map(|(_, _, own)| own).collect())
}
