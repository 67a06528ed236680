//! One level of the breadth-first search: what a worker makes of its pieces of the frontier.

use crate::cursor::{Cursor, Leaf};
use crate::model::Model;
use crate::pack::Key;
use crate::parts::{Event, Joined, Tables};
use crate::process::{Origin, Process, beyond};
use crate::property::{Eval, Property};
use crate::report::Options;
use crate::set::{Batch, Set};
use crate::stages::{self, Pace, Staged, Trial, Watched};
use crate::store::Store;
use crate::system::Fault;
use crate::tally::Found;
use crate::watch::Watch;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::time::Instant;

// The alignment keeps the counters of two threads out of one cache line.
#[repr(align(128))]
pub(crate) struct Worker<'m, P, K, L> {
    cursor: Cursor<P>,
    pub(crate) local: L,
    transitions: u128,
    weights: u128,
    explored: u64,
    first: Vec<Option<K>>,
    bad: Vec<Option<K>>,
    met: Vec<bool>,
    pending: Vec<Batch<K>>,
    faults: BTreeMap<u32, K>,
    coverage: Vec<u64>,
    absorbing: u64,
    examples: Vec<K>,
    pub(crate) joined: Option<Joined>,
    /// Where the cycles of a state are made in stages.
    pub(crate) staged: Option<Staged<'m, K>>,
    /// Where they are made in stages only as long as that is the quicker way.
    pub(crate) trial: Option<Trial>,
    /// What was made one by one in this level.
    pub(crate) pace: Pace,
    vectors: u64,
    /// Cycles put together from tables since the last look at the limits.
    unwatched: u32,
    /// A limit is reached: nothing more is begun.
    broken: bool,
}

/// Cycles of one worker between two looks at the memory held.
pub(crate) const UNWATCHED: u32 = 4096;

impl<P: Process, K: Key, L> Worker<'_, P, K, L> {
    pub(crate) fn new(
        origin: &impl Origin<Process = P>,
        watch: &Watch,
        local: L,
        properties: usize,
        parts: Option<&Tables<K>>,
    ) -> Self {
        Worker {
            cursor: Cursor::new(origin, watch),
            local,
            transitions: 0,
            weights: 0,
            explored: 0,
            first: vec![None; properties],
            bad: vec![None; properties],
            met: vec![false; properties],
            pending: (0..properties).map(|_| Batch::new()).collect(),
            faults: BTreeMap::new(),
            coverage: vec![0; origin.rules()],
            absorbing: 0,
            examples: Vec::new(),
            joined: parts.map(Tables::worker),
            staged: None,
            trial: None,
            pace: Pace::default(),
            vectors: 0,
            unwatched: 0,
            broken: false,
        }
    }

    /// Whether the next state is made in stages.
    fn in_stages(&self) -> bool {
        self.staged.is_some() && self.trial.is_none_or(|trial| !trial.plain())
    }
}

#[inline]
pub(crate) fn lower<K: Ord + Copy>(slot: &mut Option<K>, key: K) {
    if slot.is_none_or(|old| key < old) {
        *slot = Some(key);
    }
}

/// What the states and the pending duties take.
pub(crate) fn bytes<T: Store>(store: &T, pending: &[Set<T::Key>]) -> u64 {
    store.bytes() + pending.iter().map(Set::bytes).sum::<u64>()
}

/// States of a piece that are made in the same way, between two looks at the clock.
struct Lap {
    start: Instant,
    explored: u64,
    vectors: u64,
    staged: bool,
    stride: u64,
}

impl Lap {
    fn new<P: Process, K: Key, L>(worker: &Worker<'_, P, K, L>) -> Self {
        Lap {
            start: Instant::now(),
            explored: worker.explored,
            vectors: worker.vectors,
            staged: worker.in_stages(),
            stride: worker.trial.map_or(u64::MAX, |trial| trial.stride()),
        }
    }

    /// The worker takes note of what they took.
    fn end<P, K, L>(&self, worker: &mut Worker<'_, P, K, L>) {
        let (time, states) = (self.start.elapsed(), worker.explored - self.explored);
        if let Some(trial) = &mut worker.trial {
            trial.made(time, states);
        }
        if !self.staged {
            let vectors = worker.vectors - self.vectors;
            worker.pace.plain(time, states, vectors);
        }
    }
}

/// What is the same for all workers during a level.
pub(crate) struct Level<'a, O, T: Store> {
    pub(crate) model: &'a Model<'a, O, T::Key>,
    pub(crate) store: &'a T,
    pub(crate) properties: &'a [Property],
    pub(crate) open: &'a [usize],
    pub(crate) pending: &'a [Set<T::Key>],
    pub(crate) options: &'a Options,
    pub(crate) parts: Option<&'a Tables<T::Key>>,
    /// What the stages of the workers tell.
    pub(crate) watched: &'a Watched,
}

impl<O: Origin, T: Store> Level<'_, O, T> {
    /// Makes them, unless a limit is reached.
    pub(crate) fn explore(
        &self,
        worker: &mut Worker<'_, O::Process, T::Key, T::Local>,
        piece: usize,
    ) {
        if !self.over() {
            self.piece(worker, piece);
        }
    }

    /// Adds what a worker still has of its own to what all have found.
    pub(crate) fn settle(&self, worker: &mut Worker<'_, O::Process, T::Key, T::Local>) {
        self.store.settle(&mut worker.local);
        for (pending, own) in self.pending.iter().zip(&mut worker.pending) {
            pending.flush(own);
        }
    }

    /// Whether a limit is reached.
    fn over(&self) -> bool {
        let tables = self.parts.map_or(0, Tables::bytes);
        self.model
            .watch
            .over(bytes(self.store, self.pending) + tables + self.model.known())
    }

    /// Makes the cycles from the states of one piece of the frontier.
    pub(crate) fn piece(
        &self,
        worker: &mut Worker<'_, O::Process, T::Key, T::Local>,
        piece: usize,
    ) {
        let mut lap = Lap::new(worker);
        self.store.each(piece, |key| {
            if worker.broken {
                return;
            }
            let joined = self
                .parts
                .is_some_and(|parts| self.joined(parts, worker, key));
            let made = joined || lap.staged && self.staged(worker, key);
            if !made {
                self.state(worker, key);
            }
            if worker.explored - lap.explored >= lap.stride {
                lap.end(worker);
                lap = Lap::new(worker);
            }
        });
        lap.end(worker);
    }

    /// One state whose cycles are made in stages; false if there are none, or a cycle meets a fault.
    #[inline]
    fn staged(&self, worker: &mut Worker<'_, O::Process, T::Key, T::Local>, key: T::Key) -> bool {
        let Worker {
            staged: Some(staged),
            local,
            first,
            bad,
            met,
            pending,
            unwatched,
            broken,
            ..
        } = worker
        else {
            return false;
        };
        let (mut stays, mut shown, mut last) = (true, 0, key);
        // What was noted of a burst is what is shown in it: the states after it are stored already.
        let weight = staged.bursts(key, |noted, burst| {
            *unwatched += 1;
            stays = stays && burst.ends().all(|(after, _)| after == key);
            let all = noted.unwrap_or_else(|| {
                let mut all = 0;
                burst.ends().for_each(|(after, marks)| {
                    *unwatched += 1;
                    if after != last {
                        self.store.visit(local, after);
                        last = after;
                    }
                    all |= marks;
                    let mut duties = marks & self.watched.pending;
                    while duties != 0 {
                        let (property, _) = self.watched.events[duties.trailing_zeros() as usize];
                        self.pending[property].insert(&mut pending[property], after);
                        duties &= duties - 1;
                    }
                });
                all
            });
            shown |= all;
            all
        });
        let Some(weight) = weight else {
            return false;
        };
        shown &= self.watched.shown;
        while shown != 0 {
            let (property, event) = self.watched.events[shown.trailing_zeros() as usize];
            match event {
                stages::Event::First => lower(&mut first[property], key),
                stages::Event::Bad => lower(&mut bad[property], key),
                stages::Event::Met => met[property] = true,
                stages::Event::Pending => {}
            }
            shown &= shown - 1;
        }
        if *unwatched >= UNWATCHED {
            *unwatched = 0;
            *broken = self.over();
        }
        worker.explored += 1;
        worker.weights = worker.weights.wrapping_add(weight);
        worker.transitions = worker.transitions.saturating_add(weight);
        if stays {
            self.absorbing(worker, key);
        }
        true
    }

    /// One state of a system that falls into parts; false if its cycles are not in their tables.
    #[inline]
    fn joined(
        &self,
        parts: &Tables<T::Key>,
        worker: &mut Worker<'_, O::Process, T::Key, T::Local>,
        key: T::Key,
    ) -> bool {
        let Worker {
            local,
            first,
            bad,
            met,
            pending,
            joined: Some(joined),
            unwatched,
            broken,
            ..
        } = worker
        else {
            return false;
        };
        let mut stays = true;
        let known = parts.cycles(joined, key, self.model.watch, |event| match event {
            Event::First(property) => lower(&mut first[property], key),
            Event::Bad(property) => lower(&mut bad[property], key),
            Event::Met(property) => met[property] = true,
            Event::Pending(property, after) => {
                let batch = &mut pending[property];
                self.pending[property].insert(batch, after);
            }
            Event::To(after) => {
                *unwatched += 1;
                if after != key {
                    stays = false;
                    self.store.visit(local, after);
                }
            }
        });
        if *unwatched >= UNWATCHED {
            *unwatched = 0;
            *broken = self.over();
        }
        if known {
            let combinations = parts.combinations();
            worker.explored += 1;
            worker.weights = worker.weights.wrapping_add(combinations);
            worker.transitions = worker.transitions.saturating_add(combinations);
            if stays {
                self.absorbing(worker, key);
            }
        }
        known
    }

    fn absorbing(&self, worker: &mut Worker<'_, O::Process, T::Key, T::Local>, key: T::Key) {
        worker.absorbing += 1;
        worker.examples.push(key);
        if worker.examples.len() > 2 * self.options.examples + 64 {
            least(&mut worker.examples, self.options.examples);
        }
    }

    #[inline]
    fn state(&self, worker: &mut Worker<'_, O::Process, T::Key, T::Local>, key: T::Key) {
        let Worker {
            cursor,
            local,
            first,
            bad,
            met,
            pending,
            faults,
            coverage,
            unwatched,
            broken,
            vectors,
            ..
        } = worker;
        let mut last = key;
        let (mut stays, mut makes) = (true, false);
        let (mut weights, mut discarded) = (0u128, 0u128);
        let whole = cursor.leaves(&self.model.packer, key, |process, odometer, leaf| {
            match leaf {
                Leaf::To(after) => {
                    makes = true;
                    stays &= after == key;
                    if !self.open.is_empty() {
                        process.save();
                    }
                    for property in self.open.iter().copied() {
                        beyond(process, odometer, |process, choices| {
                            let mut eval = Eval {
                                process,
                                choices,
                                fault: |fault: Fault| record(faults, fault.code, key),
                            };
                            let sign = eval.sign(&self.properties[property].form);
                            if sign.first {
                                lower(&mut first[property], key);
                            }
                            if sign.bad {
                                lower(&mut bad[property], key);
                            }
                            met[property] |= sign.met;
                            if sign.pending {
                                let batch = &mut pending[property];
                                self.pending[property].insert(batch, after);
                            }
                        });
                    }
                    if after != last {
                        self.store.visit(local, after);
                        last = after;
                    }
                    if !coverage.is_empty() {
                        let weight = u64::try_from(odometer.weight()).unwrap_or(u64::MAX);
                        process.count(weight, coverage);
                    }
                }
                Leaf::Fault(fault) => {
                    makes = true;
                    stays = false;
                    record(faults, fault.code, key);
                }
                Leaf::Discarded => discarded = discarded.wrapping_add(odometer.weight()),
            }
            weights = weights.wrapping_add(odometer.weight());
            *vectors += 1;
            *unwatched += 1;
            if *unwatched == UNWATCHED {
                *unwatched = 0;
                // The states after one state alone may be more than fit the memory.
                if self.over() {
                    return ControlFlow::Break(());
                }
            }
            ControlFlow::Continue(())
        });
        *broken = !whole;
        if whole {
            worker.explored += 1;
            worker.weights = worker.weights.wrapping_add(weights);
        }
        worker.transitions = worker
            .transitions
            .saturating_add(weights.wrapping_sub(discarded));
        if stays && makes && whole {
            self.absorbing(worker, key);
        }
    }
}

fn record<K: Key>(faults: &mut BTreeMap<u32, K>, code: u32, key: K) {
    let least = faults.entry(code).or_insert(key);
    *least = key.min(*least);
}

pub(crate) fn least<K: Ord>(keys: &mut Vec<K>, most: usize) {
    keys.sort_unstable();
    keys.truncate(most);
}

/// Takes over what a worker found in the level just explored (at depth `tally.depth`).
pub(crate) fn gather<P, K: Key, L>(
    found: &mut Found<K>,
    worker: &mut Worker<'_, P, K, L>,
    parts: Option<&Tables<K>>,
    counted: bool,
    examples: usize,
) {
    if let (Some(parts), Some(joined)) = (parts, &mut worker.joined) {
        parts.count(joined, &mut worker.coverage);
    }
    if let Some(staged) = worker.staged.as_mut().filter(|_| counted) {
        staged.count(&mut worker.coverage);
    }
    let tally = &mut found.tally;
    let depth = tally.depth;
    for (property, signs) in tally.signs.iter_mut().enumerate() {
        if let Some(key) = worker.first[property].take() {
            lower(&mut signs.first, (depth, key));
        }
        if let Some(key) = worker.bad[property].take() {
            lower(&mut signs.bad, (depth, key));
        }
        signs.met |= worker.met[property];
        found.pending[property].flush(&mut worker.pending[property]);
    }
    for (code, key) in std::mem::take(&mut worker.faults) {
        let least = tally.faults.entry(code).or_insert((depth, key));
        *least = (depth, key).min(*least);
    }
    for (sum, count) in tally.coverage.iter_mut().zip(&mut worker.coverage) {
        *sum = sum.saturating_add(std::mem::take(count));
    }
    let transitions = std::mem::take(&mut worker.transitions);
    tally.transitions = tally.transitions.saturating_add(transitions);
    tally.weights = tally
        .weights
        .wrapping_add(std::mem::take(&mut worker.weights));
    tally.explored += std::mem::take(&mut worker.explored);
    tally.absorbing += std::mem::take(&mut worker.absorbing);
    tally.examples.append(&mut worker.examples);
    least(&mut tally.examples, examples);
}
