//! The one breadth-first search: counts, coverage, faults, and what every property needs to know.

use crate::checkpoint::Keeper;
use crate::choices::Odometer;
use crate::crew::Crew;
use crate::cursor::{Cursor, Leaf};
use crate::pack::{Key, Packer};
use crate::parts::{Event, Joined, Tables};
use crate::process::{Origin, Process, beyond};
use crate::property::{Eval, Property};
use crate::report::{Error, Options, Progress};
use crate::set::{Batch, Set};
use crate::store::Store;
use crate::system::Fault;
use crate::watch::Watch;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::sync::{Mutex, OnceLock, PoisonError};

/// A system with its packing, its workers and its limits.
pub(crate) struct Model<'a, O, K> {
    pub(crate) origin: O,
    pub(crate) packer: Packer<K>,
    pub(crate) crew: &'a Crew,
    pub(crate) watch: &'a Watch,
    /// Codes of faults that atoms meet after the search.
    pub(crate) late: Mutex<BTreeSet<u32>>,
    afterwards: OnceLock<Watch>,
}

impl<'a, O: Origin, K: Key> Model<'a, O, K> {
    pub(crate) fn new(origin: O, crew: &'a Crew, watch: &'a Watch) -> Result<Self, Error> {
        let packer = Packer::new(origin.domains())?;
        Ok(Model::with(origin, packer, crew, watch))
    }

    /// With a packing of its own.
    pub(crate) fn with(origin: O, packer: Packer<K>, crew: &'a Crew, watch: &'a Watch) -> Self {
        Model {
            origin,
            packer,
            crew,
            watch,
            late: Mutex::default(),
            afterwards: OnceLock::new(),
        }
    }

    /// What makes cycles for the search and the verdicts, within the limits.
    pub(crate) fn cursor(&self) -> Cursor<O::Process> {
        Cursor::new(&self.origin, self.watch)
    }

    /// What makes cycles to rebuild runs, for which there is time of its own.
    pub(crate) fn retracing(&self) -> Cursor<O::Process> {
        Cursor::new(&self.origin, self.afterwards())
    }

    /// The limits of rebuilding runs; its time begins with the first call.
    pub(crate) fn afterwards(&self) -> &Watch {
        self.afterwards.get_or_init(|| self.watch.afterwards())
    }

    /// Evaluates atoms after the search; faults are noted and count as FALSE.
    pub(crate) fn eval<'b, P: ?Sized>(
        &'b self,
        process: &'b mut P,
        choices: &'b mut Odometer,
    ) -> Eval<'b, P, impl FnMut(Fault) + 'b> {
        let fault = |fault: Fault| {
            self.late
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .insert(fault.code);
        };
        Eval {
            process,
            choices,
            fault,
        }
    }
}

/// The first places, in the order (depth, state), at which something about a property showed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Signs<K> {
    pub(crate) first: Option<(u32, K)>,
    pub(crate) bad: Option<(u32, K)>,
    /// Whether some cycle started a response and ended it at once.
    pub(crate) met: bool,
}

/// What a search counted and noted.
#[derive(Clone)]
pub(crate) struct Tally<K> {
    pub(crate) states: u64,
    pub(crate) transitions: u128,
    /// Of all leaves, modulo 2^128; must be the declared combinations for each state explored.
    pub(crate) weights: u128,
    pub(crate) explored: u64,
    pub(crate) depth: u32,
    /// Every reachable state was explored.
    pub(crate) complete: bool,
    pub(crate) signs: Vec<Signs<K>>,
    /// By code: the first place.
    pub(crate) faults: BTreeMap<u32, (u32, K)>,
    pub(crate) coverage: Vec<u64>,
    pub(crate) absorbing: u64,
    pub(crate) examples: Vec<K>,
    /// Bytes in which the states are stored.
    pub(crate) stored: u64,
}

impl<K: Key> Tally<K> {
    /// Nothing yet, for so many properties and rules.
    pub(crate) fn new(properties: usize, rules: usize) -> Self {
        let none = Signs {
            first: None,
            bad: None,
            met: false,
        };
        Tally {
            states: 0,
            transitions: 0,
            weights: 0,
            explored: 0,
            depth: 0,
            complete: false,
            signs: vec![none; properties],
            faults: BTreeMap::new(),
            coverage: vec![0; rules],
            absorbing: 0,
            examples: Vec::new(),
            stored: 0,
        }
    }
}

/// What a search found.
pub(crate) struct Found<K> {
    pub(crate) tally: Tally<K>,
    /// For each property the states in which a duty that just began is pending.
    pub(crate) pending: Vec<Set<K>>,
    /// The most bytes held.
    pub(crate) bytes: u64,
    /// Whether a checkpoint of the end was written.
    pub(crate) resumable: bool,
}

// The alignment keeps the counters of two threads out of one cache line.
#[repr(align(128))]
pub(crate) struct Worker<P, K, L> {
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
    joined: Option<Joined>,
    /// Cycles put together from tables since the last look at the limits.
    unwatched: u32,
    /// A limit is reached: nothing more is begun.
    broken: bool,
}

/// Cycles of one worker between two looks at the memory held.
pub(crate) const UNWATCHED: u32 = 4096;

impl<P: Process, K: Key, L> Worker<P, K, L> {
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
            unwatched: 0,
            broken: false,
        }
    }
}

#[inline]
pub(crate) fn lower<K: Ord + Copy>(slot: &mut Option<K>, key: K) {
    if slot.is_none_or(|old| key < old) {
        *slot = Some(key);
    }
}

/// Explores level by level. The answer does not depend on the number of threads as long as no limit is reached.
pub(crate) fn search<O: Origin, T: Store>(
    model: &Model<O, T::Key>,
    store: &mut T,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
) -> Result<Found<T::Key>, Error> {
    let origin = &model.origin;
    let parts = Tables::new(origin, &model.packer, properties, model.watch);
    let mut workers: Vec<_> = (0..model.crew.size())
        .map(|_| {
            let (local, count) = (store.local(), properties.len());
            Worker::new(origin, model.watch, local, count, parts.as_ref())
        })
        .collect();
    let mut keeper = options.checkpoint.as_ref().map(Keeper::new);
    let resumed = match &keeper {
        Some(keeper) if options.checkpoint.as_ref().is_some_and(|c| c.resume) => {
            keeper.load(store)?
        }
        _ => None,
    };
    let mut found = match resumed {
        Some((found, earlier)) => {
            model.watch.continues(earlier);
            found
        }
        None => {
            let mut tally = Tally::new(properties.len(), origin.rules());
            let (states, all) = initial(model, store, model.cursor(), model.watch)?;
            tally.states = states;
            tally.stored = store.bytes();
            let found = Found {
                tally,
                pending: properties.iter().map(|_| Set::new()).collect(),
                bytes: store.bytes(),
                resumable: false,
            };
            if !all {
                // Not all initial states are there: nothing to explore from, nor to continue from later.
                return Ok(found);
            }
            found
        }
    };
    {
        let Tally {
            depth,
            states,
            transitions,
            ..
        } = found.tally;
        progress.on_level(depth, states, transitions, store.size());
    }
    while !found.tally.complete {
        let open: Vec<usize> = (0..properties.len())
            .filter(|p| {
                let signs = found.tally.signs[*p];
                !properties[*p]
                    .form
                    .settled(signs.first.is_some(), signs.bad.is_some())
            })
            .collect();
        let level = Level {
            model,
            store: &*store,
            properties,
            open: &open,
            pending: &found.pending,
            options,
            parts: parts.as_ref(),
        };
        model
            .crew
            .share(&mut workers, store.pieces(), |worker, piece| {
                level.explore(worker, piece)
            });
        // A level that a limit broke off is explored again when the search is continued.
        let stopped = model.watch.stopped();
        let before = (stopped && keeper.is_some()).then(|| found.tally.clone());
        // A checkpoint needs the counts of the level; else it is enough to add them up once.
        let counted = parts.as_ref().filter(|_| keeper.is_some());
        for worker in &mut workers {
            gather(&mut found, worker, counted, options.examples);
        }
        found.bytes = found.bytes.max(bytes(store, &found.pending));
        found.tally.stored = store.bytes();
        let locals = workers.iter_mut().map(|w| &mut w.local).collect();
        if stopped {
            found.tally.states += store.undo(locals);
            if let (Some(keeper), Some(before)) = (&mut keeper, before) {
                found.resumable = keep(keeper, model, store, &before, &found, progress);
            }
            break;
        }
        let frontier = store.advance(locals);
        found.bytes = found.bytes.max(bytes(store, &found.pending));
        let tally = &mut found.tally;
        tally.stored = store.bytes();
        tally.states += frontier;
        if frontier > 0 {
            tally.depth += 1;
            progress.on_memory(bytes(store, &found.pending));
            progress.on_level(tally.depth, tally.states, tally.transitions, frontier);
        }
        tally.complete = frontier == 0;
        let decided = options.stop_when_decided
            && properties
                .iter()
                .zip(&tally.signs)
                .all(|(p, s)| p.form.decided_by(s.first.is_some(), s.bad.is_some()));
        if let Some(keeper) = &mut keeper {
            if tally.complete || decided || keeper.is_due() {
                found.resumable = keep(keeper, model, store, &found.tally, &found, progress);
            }
        }
        if decided {
            break;
        }
    }
    if let Some(parts) = &parts {
        for joined in workers.iter_mut().filter_map(|w| w.joined.as_mut()) {
            parts.count(joined, &mut found.tally.coverage);
        }
    }
    let Tally {
        weights, explored, ..
    } = found.tally;
    if weights != u128::from(explored).wrapping_mul(origin.combinations()) {
        return Err(Error::Combinations {
            declared: origin.combinations(),
        });
    }
    Ok(found)
}

/// Writes a checkpoint; true if it is there.
fn keep<O, T: Store>(
    keeper: &mut Keeper,
    model: &Model<O, T::Key>,
    store: &T,
    tally: &Tally<T::Key>,
    found: &Found<T::Key>,
    progress: &mut dyn Progress,
) -> bool {
    let saved = keeper.save(store, tally, &found.pending, model.watch.elapsed());
    if let Err(error) = &saved {
        progress.on_lost_checkpoint(error);
    }
    saved.is_ok()
}

pub(crate) fn bytes<T: Store>(store: &T, pending: &[Set<T::Key>]) -> u64 {
    store.bytes() + pending.iter().map(Set::bytes).sum::<u64>()
}

/// Makes the initial states the frontier of an empty store; also tells whether these are all, or a limit was reached first.
pub(crate) fn initial<O: Origin, T: Store>(
    model: &Model<O, T::Key>,
    store: &mut T,
    mut cursor: Cursor<O::Process>,
    watch: &Watch,
) -> Result<(u64, bool), Error> {
    let mut local = store.local();
    let mut unwatched = 0;
    let all = cursor.initial(&model.packer, |key, _| {
        store.visit(&mut local, key);
        unwatched += 1;
        if unwatched == UNWATCHED {
            unwatched = 0;
            if watch.over(store.bytes()) {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    })?;
    Ok((store.advance(vec![&mut local]), all))
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
}

impl<O: Origin, T: Store> Level<'_, O, T> {
    fn explore(&self, worker: &mut Worker<O::Process, T::Key, T::Local>, piece: usize) {
        if !self.over() {
            self.piece(worker, piece);
        }
    }

    /// Whether a limit is reached.
    fn over(&self) -> bool {
        let tables = self.parts.map_or(0, Tables::bytes);
        self.model
            .watch
            .over(bytes(self.store, self.pending) + tables)
    }

    /// Makes the cycles from the states of one piece of the frontier.
    pub(crate) fn piece(&self, worker: &mut Worker<O::Process, T::Key, T::Local>, piece: usize) {
        self.store.each(piece, |key| {
            if worker.broken {
                return;
            }
            let joined = self
                .parts
                .is_some_and(|parts| self.joined(parts, worker, key));
            if !joined {
                self.state(worker, key);
            }
        });
    }

    /// One state of a system that falls into parts; false if its cycles are not in their tables.
    #[inline]
    fn joined(
        &self,
        parts: &Tables<T::Key>,
        worker: &mut Worker<O::Process, T::Key, T::Local>,
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

    fn absorbing(&self, worker: &mut Worker<O::Process, T::Key, T::Local>, key: T::Key) {
        worker.absorbing += 1;
        worker.examples.push(key);
        if worker.examples.len() > 2 * self.options.examples + 64 {
            least(&mut worker.examples, self.options.examples);
        }
    }

    #[inline]
    fn state(&self, worker: &mut Worker<O::Process, T::Key, T::Local>, key: T::Key) {
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
    worker: &mut Worker<P, K, L>,
    parts: Option<&Tables<K>>,
    examples: usize,
) {
    if let (Some(parts), Some(joined)) = (parts, &mut worker.joined) {
        parts.count(joined, &mut worker.coverage);
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
