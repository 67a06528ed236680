//! Recoverability: from which states no path leads to a goal.
//!
//! A state is *saved* if one of its cycles shows the goal, or ends in a state that is saved. Sweeps over all states find nearly all of
//! these; what is left is a graph, whose components tell the rest.

use crate::choices::Odometer;
use crate::cursor::{Cursor, Leaf};
use crate::distinct::Distinct;
use crate::explore::{Decision, Evidence};
use crate::graph::{Edge, Graph, Mark, Rules, Walker};
use crate::model::Model;
use crate::nodes::Nodes;
use crate::pack::Key;
use crate::process::{Any, Origin, Process, beyond};
use crate::report::{Error, Verdict};
use crate::stages::{Condition, Staged};
use crate::store::{PIECE, Store};
use crate::trace::Request;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Properties judged together: a label has two bits for each, those of cycles that may be used below those of the goals among them.
const TOGETHER: usize = 16;

/// While one of so many states that were left is saved by a sweep, there is another one.
const WORTH: usize = 8;

/// The states that are swept over first, and how many times as many are next.
const FIRST: usize = 4096;
const MORE: usize = 8;

/// The states from which no path leads to the goal, as a test, or none if every state has one.
pub(crate) type Lost<'a, K> = Option<Arc<dyn Fn(K) -> bool + Send + Sync + 'a>>;

/// Judges recoverability by the goals and conditions (`goal`, `using`) of properties, over all reachable states, of which there are
/// so many. None for what a limit left open.
pub(crate) fn recoverable<'a, T: Store>(
    model: &'a Model<'a, Any<'a>, T::Key>,
    goals: &[(usize, Option<usize>)],
    store: &T,
    states: u64,
) -> Result<Vec<Option<Lost<'a, T::Key>>>, Error> {
    let open = || goals.iter().map(|_| None).collect();
    let bytes = Nodes::<T::Key>::bytes_for(states).saturating_add(SAVED * states);
    let all = store.bytes().saturating_add(bytes);
    let (Ok(number), false) = (u32::try_from(states), goals.is_empty()) else {
        return Ok(open());
    };
    if model.watch.memory().is_some_and(|most| all > most) || model.watch.ended() {
        return Ok(open());
    }
    let list = store.all(number as usize);
    let (seeds, held) = match list.len() as u64 == states {
        true => (Nodes::of(list).map(Seeds::All), all),
        false => {
            let held = store.bytes();
            (initial(model, held)?.map(Seeds::Initial), held)
        }
    };
    let Some(seeds) = seeds else {
        return Ok(open());
    };
    let chunks = goals.chunks(TOGETHER).flat_map(|goals| {
        let lost = together(model, goals, &seeds, held);
        let number = goals.len();
        let lost = lost.map(|lost| lost.into_iter().map(Some).collect());
        lost.unwrap_or_else(|| vec![None; number])
    });
    Ok(chunks.collect())
}

/// From where the states are known.
enum Seeds<K> {
    /// All of them.
    All(Nodes<K>),
    /// The initial ones, where other processes have the rest.
    Initial(Vec<K>),
}

/// The initial states; none if a limit is reached.
fn initial<K: Key>(model: &Model<Any, K>, held: u64) -> Result<Option<Vec<K>>, Error> {
    let mut initial = Distinct::new();
    let all = model.cursor().initial(&model.packer, |key, _| {
        initial.push(key);
        match model.watch.too_much(held + initial.bytes()) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    })?;
    Ok(all.then(|| initial.sorted()))
}

/// The bits of cycles that may be used, and of those that show a goal.
fn split(label: u32) -> (u32, u32) {
    (label & ((1 << TOGETHER) - 1), label >> TOGETHER)
}

fn together<'a, K: Key>(
    model: &'a Model<'a, Any<'a>, K>,
    goals: &[(usize, Option<usize>)],
    seeds: &Seeds<K>,
    held: u64,
) -> Option<Vec<Lost<'a, K>>> {
    let used = |using: &Option<usize>| -> Condition { using.iter().map(|a| (*a, true)).collect() };
    let reached = |(goal, using): &(usize, Option<usize>)| {
        let mut condition = used(using);
        condition.push((*goal, true));
        condition
    };
    let own = goals.iter().map(|(_, using)| used(using));
    let conditions: Vec<Condition> = own.chain(goals.iter().map(reached)).collect();
    let number = goals.len();
    let label_of = |marks: u128| {
        let marks = marks as u32;
        marks & ((1 << number) - 1) | marks >> number << TOGETHER
    };
    let label = |process: &mut dyn Process, choices: &mut Odometer| {
        // What some choice makes possible: a path may take it, so the choices of one cycle add up.
        let mut mask = 0;
        process.save();
        for (number, (goal, using)) in goals.iter().enumerate() {
            beyond(process, choices, |process, choices| {
                let mut eval = model.eval(process, choices);
                let used = eval.given(*using);
                let reached = used && eval.atom(*goal);
                mask |= (u32::from(used) | u32::from(reached) << TOGETHER) << number;
            });
        }
        mask
    };
    let none = Nodes::new();
    let (sweeps, left) = match seeds {
        Seeds::All(states) => {
            let sweeps = Sweeps::over(model, states, held, &conditions, &label, &label_of)?;
            let left = sweeps.left();
            (sweeps, left)
        }
        Seeds::Initial(initial) => (Sweeps::new(&none, number), initial.clone()),
    };
    if left.is_empty() {
        return Some(goals.iter().map(|_| None).collect());
    }
    // A cycle to a state that is saved for all goals does not lead there, but says what it reaches.
    let mark = |label: u32, after: K| {
        let (used, reached) = split(label);
        let saved = sweeps.saved(after);
        let label = used | (reached | used & saved) << TOGETHER;
        match saved == sweeps.all {
            true => Mark::Around(label),
            false => Mark::Edge(label),
        }
    };
    let rules = Rules {
        rule: &|process, choices, after| mark(label(process, choices), after),
        mark: &|marks, after| mark(label_of(marks), after),
    };
    let held = held + size_of_val(left.as_slice()) as u64;
    let mut walkers = Walker::all(model, &conditions);
    let graph = Graph::build(model, &left, &rules, &mut walkers, held, u64::MAX)?;
    drop(walkers);
    let graph = Arc::new(graph);
    let lost = (0..number).map(|number| {
        let used = |edge: Edge| split(edge.label).0 >> number & 1 != 0;
        let reached = |edge: &Edge| split(edge.label).1 >> number & 1 != 0;
        let components = graph.components(used);
        let saved = components.reaching(&graph, used, |node| graph.edges(node).iter().any(reached));
        if saved.iter().all(|saved| *saved) {
            return None;
        }
        let graph = Arc::clone(&graph);
        let lost = move |key| {
            let node = graph.number(key);
            node.is_some_and(|n| !saved[components.of[n as usize] as usize])
        };
        Some(Arc::new(lost) as Arc<dyn Fn(K) -> bool + Send + Sync>)
    });
    Some(lost.collect())
}

/// All states, and for which goals each of them is known to be saved.
struct Sweeps<'s, K> {
    states: &'s Nodes<K>,
    saved: Vec<AtomicU32>,
    all: u32,
}

/// Bytes for each state.
const SAVED: u64 = size_of::<AtomicU32>() as u64;

impl<'s, K: Key> Sweeps<'s, K> {
    /// Nothing is known of so many goals.
    fn new(states: &'s Nodes<K>, goals: usize) -> Self {
        Sweeps {
            saved: states.keys().iter().map(|_| AtomicU32::new(0)).collect(),
            states,
            all: (1 << goals) - 1,
        }
    }

    /// Sweeps over these states, from both ends by turns, as long as it pays, over the first of them to begin with; none if a limit is
    /// reached.
    fn over<'m, 'a>(
        model: &'m Model<'a, Any<'a>, K>,
        states: &'s Nodes<K>,
        held: u64,
        conditions: &[Condition],
        label: &(dyn Fn(&mut dyn Process, &mut Odometer) -> u32 + Sync),
        label_of: &(dyn Fn(u128) -> u32 + Sync),
    ) -> Option<Self> {
        let sweeps = Sweeps::new(states, conditions.len() / 2);
        let states = states.keys();
        let over = || model.watch.ended() || model.watch.too_much(held + model.known());
        let mut workers: Vec<_> = (0..model.crew.size())
            .map(|_| (model.cursor(), model.quicker(conditions)))
            .collect();
        let broken = AtomicBool::new(over());
        // Often all states lead back to those found first: it is known of these first whether they are saved.
        let mut some = FIRST.min(states.len());
        let (mut left, mut back, mut looked) = (some, true, 0);
        while !broken.load(Ordering::Relaxed) {
            let pieces = some.div_ceil(PIECE);
            model.crew.share(&mut workers, pieces, |worker, piece| {
                let piece = if back { pieces - 1 - piece } else { piece };
                let (from, to) = (piece * PIECE, some.min((piece + 1) * PIECE));
                for at in 0..to - from {
                    let state = if back { to - 1 - at } else { from + at };
                    let again = state < looked;
                    let state = (state, states[state]);
                    if broken.load(Ordering::Relaxed)
                        || !sweeps.look(model, worker, state, again, label, label_of)
                    {
                        return broken.store(true, Ordering::Relaxed);
                    }
                }
                if over() {
                    broken.store(true, Ordering::Relaxed);
                }
            });
            looked = some;
            let before = std::mem::replace(&mut left, sweeps.count(some));
            back = !back;
            if (before - left) * WORTH < before || left == 0 {
                if some == states.len() {
                    break;
                }
                let more = (some * MORE).min(states.len());
                left += more - some;
                (some, back) = (more, true);
            }
        }
        (!broken.into_inner()).then_some(sweeps)
    }

    /// Looks whether a state is saved; false if a limit is reached. When it is looked at for the first time all its cycles are made, one
    /// by one where there are no stages: a property may meet a fault in each of them.
    fn look<'a>(
        &self,
        model: &Model<'a, Any<'a>, K>,
        (cursor, staged): &mut (Cursor<<Any<'a> as Origin>::Process>, Option<Staged<K>>),
        (state, key): (usize, K),
        again: bool,
        label: &(dyn Fn(&mut dyn Process, &mut Odometer) -> u32 + Sync),
        label_of: &(dyn Fn(u128) -> u32 + Sync),
    ) -> bool {
        let before = self.saved[state].load(Ordering::Relaxed);
        if before == self.all {
            return true;
        }
        let mut saved = before;
        let mut add = |label: u32, after: K| {
            let (used, reached) = split(label);
            saved |= reached;
            if used & !saved != 0 {
                saved |= used & self.saved(after);
            }
            saved == self.all
        };
        let made = staged.as_mut().and_then(|staged| {
            let mut done = false;
            staged.bursts(key, |_, burst| {
                done = done
                    || burst
                        .ends()
                        .any(|(after, marks)| add(label_of(marks), after));
                0
            })
        });
        let whole = made.is_some()
            || cursor.leaves(&model.packer, key, |process, odometer, leaf| match leaf {
                Leaf::To(after) if add(label(&mut **process, odometer), after) && again => {
                    ControlFlow::Break(())
                }
                _ => ControlFlow::Continue(()),
            });
        self.saved[state].store(saved, Ordering::Relaxed);
        whole || (again && saved == self.all)
    }

    /// For which goals a state is known to be saved.
    fn saved(&self, key: K) -> u32 {
        let number = self.states.number(key);
        number.map_or(0, |number| {
            self.saved[number as usize].load(Ordering::Relaxed)
        })
    }

    /// How many of the first states are not saved for all goals.
    fn count(&self, first: usize) -> usize {
        let left = |saved: &&AtomicU32| saved.load(Ordering::Relaxed) != self.all;
        self.saved[..first].iter().filter(left).count()
    }

    /// These states.
    fn left(&self) -> Vec<K> {
        let left = |(_, saved): &(&K, &AtomicU32)| saved.load(Ordering::Relaxed) != self.all;
        let left = self.states.keys().iter().zip(&self.saved).filter(left);
        left.map(|(key, _)| *key).collect()
    }
}

/// The decision that follows.
pub(crate) fn recovery<'a, K: Key>(
    lost: Option<Lost<'a, K>>,
    witness: Evidence<'a, K>,
) -> Decision<'a, K> {
    match lost {
        None => Verdict::Inconclusive.into(),
        Some(None) => Decision {
            verdict: Verdict::Holds,
            bound: None,
            fastest: None,
            evidence: witness,
        },
        Some(Some(lost)) => {
            let state = Arc::clone(&lost);
            let request = Request {
                at: None,
                test: Arc::new(move |_, _, leaf| matches!(leaf, Leaf::To(after) if lost(after))),
                state: Some(state),
            };
            Decision {
                verdict: Verdict::Violated,
                bound: None,
                fastest: None,
                evidence: Evidence::Run(request, None),
            }
        }
    }
}
