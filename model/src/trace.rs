//! Reconstruction of counterexamples and witnesses, the shortest runs to places of interest, without parent pointers in the search: a second search keeps its levels, and a
//! walk back through them finds the predecessors.

use crate::choices::Odometer;
use crate::cursor::{Cursor, Leaf};
use crate::level::lower;
use crate::model::Model;
use crate::pack::Key;
use crate::process::{Origin, Process, beyond};
use crate::report::{Error, Trace};
use crate::search::initial;
use crate::store::{PIECE, Store};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Says whether a cycle is the one looked for.
pub(crate) type Test<'a, K> =
    Arc<dyn Fn(&mut dyn Process, &mut Odometer, Leaf<K>) -> bool + Send + Sync + 'a>;

/// Says whether an initial state is the place looked for.
pub(crate) type StateTest<'a, K> = Arc<dyn Fn(K) -> bool + Send + Sync + 'a>;

/// A run to find: to the first cycle, in the order (depth, state, choices), that passes the test.
pub(crate) struct Request<'a, K> {
    /// The depth and the state before the cycle, where the search has told them.
    pub(crate) at: Option<(u32, K)>,
    pub(crate) test: Test<'a, K>,
    /// An initial state that passes needs no cycle.
    pub(crate) state: Option<StateTest<'a, K>>,
}

/// A run found, and the state at its end (none if it ends in a fault).
#[derive(Clone, Debug)]
pub(crate) struct Run<K> {
    pub(crate) trace: Trace,
    pub(crate) end: Option<K>,
}

/// Where the last cycle of a request starts; `no_cycle` if the run has none.
#[derive(Clone, Copy)]
struct Goal<K> {
    depth: usize,
    key: K,
    no_cycle: bool,
}

/// The runs of the requests. None for what is not reached, or where memory or time do not suffice.
pub(crate) fn runs<O: Origin, T: Store>(
    model: &Model<O, T::Key>,
    store: &mut T,
    requests: &[Request<T::Key>],
) -> Result<Vec<Option<Run<T::Key>>>, Error> {
    if requests.is_empty() {
        return Ok(Vec::new());
    }
    store.clear();
    let (levels, goals) = forward(model, store, requests)?;
    store.clear();
    let chains = backward(model, levels, &goals);
    let mut cursor = model.retracing();
    let mut found = Vec::with_capacity(requests.len());
    for ((request, goal), chain) in requests.iter().zip(&goals).zip(chains) {
        found.push(match goal {
            Some(goal) => spell(model, &mut cursor, request, *goal, &chain)?,
            None => None,
        });
    }
    Ok(found)
}

/// The levels in ascending order of states, up to the deepest goal; and the goals.
#[allow(clippy::type_complexity)]
fn forward<O: Origin, T: Store>(
    model: &Model<O, T::Key>,
    store: &mut T,
    requests: &[Request<T::Key>],
) -> Result<(Vec<Vec<T::Key>>, Vec<Option<Goal<T::Key>>>), Error> {
    let known = |r: &Request<T::Key>| {
        r.at.map(|(depth, key)| Goal {
            depth: depth as usize,
            key,
            no_cycle: false,
        })
    };
    let mut goals: Vec<_> = requests.iter().map(known).collect();
    let deepest = goals.iter().flatten().map(|g| g.depth).max().unwrap_or(0);
    let mut levels: Vec<Vec<T::Key>> = Vec::new();
    let mut held = 0;
    let mut workers: Vec<_> = (0..model.crew.size())
        .map(|_| {
            let staged = model.quicker(&[]);
            let hits = vec![None; requests.len()];
            (model.retracing(), staged, store.local(), hits)
        })
        .collect();
    let (_, mut all) = initial(model, store, model.retracing(), model.afterwards())?;
    while all {
        let level = store.frontier();
        let depth = levels.len();
        if level.is_empty() {
            break;
        }
        if depth == 0 {
            for (goal, request) in goals.iter_mut().zip(requests) {
                if let Some(test) = &request.state {
                    if let Some(key) = level.iter().copied().find(|key| test(*key)) {
                        *goal = Some(Goal {
                            depth,
                            key,
                            no_cycle: true,
                        });
                    }
                }
            }
        }
        held += (level.capacity() * size_of::<T::Key>()) as u64;
        if model.watch.too_much(held + store.bytes()) {
            break;
        }
        levels.push(level);
        let open: Vec<usize> = (0..goals.len()).filter(|g| goals[*g].is_none()).collect();
        if open.is_empty() && depth >= deepest {
            break;
        }
        let (now, open) = (&*store, &open);
        model.crew.share(
            &mut workers,
            now.pieces(),
            |(cursor, staged, local, hits), piece| {
                if model.afterwards().ended() {
                    return;
                }
                now.each(piece, |key| {
                    let known = staged.as_mut().filter(|_| open.is_empty());
                    if let Some(staged) = known.and_then(|s| s.made(key)) {
                        staged.ends().for_each(|(after, _)| now.visit(local, after));
                        return;
                    }
                    cursor.leaves(&model.packer, key, |process, odometer, leaf| {
                        if !open.is_empty() {
                            process.save();
                        }
                        for request in open.iter().copied() {
                            beyond(process, odometer, |process, odometer| {
                                if (requests[request].test)(process, odometer, leaf) {
                                    lower(&mut hits[request], key);
                                }
                            });
                        }
                        if let Leaf::To(after) = leaf {
                            now.visit(local, after);
                        }
                        ControlFlow::Continue(())
                    });
                });
            },
        );
        // A hit in a level that is not whole need not be the first one.
        all = !model.afterwards().ended();
        for request in open.iter().copied().filter(|_| all) {
            let hit = workers
                .iter_mut()
                .filter_map(|(_, _, _, hits)| hits[request].take())
                .min();
            goals[request] = hit.map(|key| Goal {
                depth,
                key,
                no_cycle: false,
            });
        }
        store.advance(workers.iter_mut().map(|(_, _, local, _)| local).collect());
    }
    // Without the level of its last state a run cannot be told.
    for goal in &mut goals {
        *goal = goal.filter(|g| g.depth < levels.len());
    }
    Ok((levels, goals))
}

/// For each goal the states of its run from the last one back to the initial one: always the least predecessor.
fn backward<O: Origin, K: Key>(
    model: &Model<O, K>,
    mut levels: Vec<Vec<K>>,
    goals: &[Option<Goal<K>>],
) -> Vec<Vec<K>> {
    let mut chains: Vec<Vec<K>> = goals
        .iter()
        .map(|g| g.map(|g| g.key).into_iter().collect())
        .collect();
    let mut cursors: Vec<_> = (0..model.crew.size())
        .map(|_| (model.retracing(), model.quicker(&[]), Vec::new()))
        .collect();
    while levels.len() > 1 {
        levels.truncate(levels.len() - 1);
        let Some(level) = levels.last() else { break };
        let above = levels.len();
        let involved: Vec<usize> = (0..goals.len())
            .filter(|g| goals[*g].is_some_and(|g| g.depth >= above))
            .collect();
        let mut wanted: Vec<K> = involved
            .iter()
            .filter_map(|g| chains[*g].last().copied())
            .collect();
        wanted.sort_unstable();
        wanted.dedup();
        let mut parents: Vec<Option<K>> = vec![None; wanted.len()];
        // In ascending blocks, so that the walk ends as soon as every wanted state has its least predecessor.
        for block in level.chunks(512 * PIECE) {
            if parents.iter().all(Option::is_some) {
                break;
            }
            for (_, _, found) in &mut cursors {
                *found = vec![None; wanted.len()];
            }
            let pieces = block.len().div_ceil(PIECE);
            model
                .crew
                .share(&mut cursors, pieces, |(cursor, staged, found), piece| {
                    if model.afterwards().ended() {
                        return;
                    }
                    for key in &block[piece * PIECE..block.len().min((piece + 1) * PIECE)] {
                        let mut note = |after: K| {
                            if let Ok(place) = wanted.binary_search(&after) {
                                lower(&mut found[place], *key);
                            }
                        };
                        if let Some(staged) = staged.as_mut().and_then(|s| s.made(*key)) {
                            staged.ends().for_each(|(after, _)| note(after));
                            continue;
                        }
                        cursor.leaves(&model.packer, *key, |_, _, leaf| {
                            if let Leaf::To(after) = leaf {
                                note(after);
                            }
                            ControlFlow::Continue(())
                        });
                    }
                });
            for (place, parent) in parents.iter_mut().enumerate().filter(|(_, p)| p.is_none()) {
                *parent = cursors
                    .iter()
                    .filter_map(|(_, _, found)| found[place])
                    .min();
            }
        }
        for goal in involved {
            let parent = chains[goal]
                .last()
                .and_then(|last| wanted.binary_search(last).ok());
            if let Some(Some(parent)) = parent.map(|place| parents[place]) {
                chains[goal].push(parent);
            }
        }
    }
    chains
}

/// The choices along a chain of states, and those of the last cycle.
fn spell<O: Origin, K: Key>(
    model: &Model<O, K>,
    cursor: &mut Cursor<O::Process>,
    request: &Request<K>,
    goal: Goal<K>,
    chain: &[K],
) -> Result<Option<Run<K>>, Error> {
    let mut trace = Trace::default();
    let Some(start) = chain
        .last()
        .copied()
        .filter(|_| chain.len() == goal.depth + 1)
    else {
        return Ok(None);
    };
    let mut begun = false;
    cursor.initial(&model.packer, |key, odometer| {
        if key == start {
            trace.initial = odometer.values();
            begun = true;
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    })?;
    if !begun {
        return Ok(None);
    }
    for pair in chain.windows(2).rev() {
        let step = cursor.first(&model.packer, pair[1], |_, _, leaf| {
            leaf == Leaf::To(pair[0])
        });
        let Some((choices, _)) = step else {
            return Ok(None);
        };
        trace.steps.push(choices);
    }
    if goal.no_cycle {
        return Ok(Some(Run {
            trace,
            end: Some(goal.key),
        }));
    }
    let test = &request.test;
    let last = cursor.first(&model.packer, goal.key, |process, odometer, leaf| {
        test(process, odometer, leaf)
    });
    Ok(last.map(|(choices, leaf)| {
        trace.steps.push(choices);
        let end = if let Leaf::To(key) = leaf {
            Some(key)
        } else {
            None
        };
        Run { trace, end }
    }))
}
