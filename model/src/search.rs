//! The one breadth-first search: counts, coverage, faults, and what every property needs to know.

use crate::checkpoint::Keeper;
use crate::cursor::Cursor;
use crate::level::{Level, UNWATCHED, Worker, bytes, gather};
use crate::model::Model;
use crate::pack::Key;
use crate::parts::Tables;
use crate::process::Origin;
use crate::property::Property;
use crate::report::{Error, Options, Progress, Way};
use crate::set::Set;
use crate::stages::{Condition, Pace, Staged, Trial, Watched};
use crate::store::Store;
use crate::tally::{Found, Tally};
use crate::watch::Watch;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;

/// Explores level by level. The answer does not depend on the number of threads as long as no limit is reached.
pub(crate) fn search<'m, O: Origin, T: Store>(
    model: &'m Model<O, T::Key>,
    store: &mut T,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
) -> Result<Searched<'m, T::Key>, Error> {
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
                return Ok((found, Known::default()));
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
    let mut staging = Staging::new(options.way, parts.is_some());
    while !found.tally.complete {
        let open: Vec<usize> = (0..properties.len())
            .filter(|p| {
                let signs = found.tally.signs[*p];
                !properties[*p]
                    .form
                    .settled(signs.first.is_some(), signs.bad.is_some())
            })
            .collect();
        let size = store.size();
        staging.prepare(
            model,
            properties,
            &open,
            size,
            &mut found.tally,
            &mut workers,
        );
        let room = model
            .watch
            .memory()
            .is_none_or(|most| bytes(store, &found.pending) + model.known() + 8 * size <= most);
        if staging.active && room {
            store.arrange(model.crew);
        }
        let level = Level {
            model,
            store: &*store,
            properties,
            open: &open,
            pending: &found.pending,
            options,
            parts: parts.as_ref(),
            watched: &staging.watched,
        };
        model.crew.share_to_end(
            &mut workers,
            store.pieces(),
            |worker, piece| level.explore(worker, piece),
            |worker| level.settle(worker),
        );
        // A level that a limit broke off is explored again when the search is continued.
        let stopped = model.watch.stopped();
        let before = (stopped && keeper.is_some()).then(|| found.tally.clone());
        // A checkpoint needs the counts of the level; else it is enough to add them up once.
        let counted = parts.as_ref().filter(|_| keeper.is_some());
        for worker in &mut workers {
            gather(
                &mut found,
                worker,
                counted,
                keeper.is_some(),
                options.examples,
            );
            staging.pace.take(&mut worker.pace);
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
        let seen = tally.signs.iter();
        let seen = seen.map(|s| (s.first.is_some(), s.bad.is_some()));
        let decided = options.until.is_met(properties, seen);
        if let Some(keeper) = &mut keeper {
            if tally.complete || decided || keeper.is_due() {
                found.resumable = keep(keeper, model, store, &found.tally, &found, progress);
            }
        }
        if decided {
            break;
        }
    }
    // What follows the search uses them only where they pay.
    staging.judge(model, &mut found.tally, &mut workers);
    if let Some(parts) = &parts {
        for joined in workers.iter_mut().filter_map(|w| w.joined.as_mut()) {
            parts.count(joined, &mut found.tally.coverage);
        }
    }
    for staged in workers.iter_mut().filter_map(|w| w.staged.as_mut()) {
        staged.count(&mut found.tally.coverage);
    }
    let Tally {
        weights, explored, ..
    } = found.tally;
    if weights != u128::from(explored).wrapping_mul(origin.combinations()) {
        return Err(Error::Combinations {
            declared: origin.combinations(),
        });
    }
    let known = Known {
        told: staging.watched.conditions,
        staged: workers.into_iter().filter_map(|w| w.staged).collect(),
    };
    Ok((found, known))
}

/// What a search has found, and learned.
type Searched<'m, K> = (Found<K>, Known<'m, K>);

/// What the threads of a search have learned of the stages of a cycle, if that is the quicker way, and the conditions of which they tell.
pub(crate) struct Known<'m, K> {
    pub(crate) staged: Vec<Staged<'m, K>>,
    pub(crate) told: Vec<Condition>,
}

impl<K> Default for Known<'_, K> {
    fn default() -> Self {
        Known {
            staged: Vec::new(),
            told: Vec::new(),
        }
    }
}

/// Decides between levels how the cycles of their states are made.
struct Staging {
    way: Way,
    pace: Pace,
    watched: Watched,
    /// The stages are in the workers.
    active: bool,
    /// They are not tried again.
    over: bool,
}

impl Staging {
    fn new(way: Way, parts: bool) -> Self {
        Staging {
            way,
            pace: Pace::default(),
            watched: Watched::default(),
            active: false,
            over: parts || way == Way::Single,
        }
    }

    /// Gives the workers the stages of the system, takes them away, or leaves all as it is.
    fn prepare<'m, O: Origin, K: Key, L>(
        &mut self,
        model: &'m Model<'_, O, K>,
        properties: &[Property],
        open: &[usize],
        frontier: u64,
        tally: &mut Tally<K>,
        workers: &mut [Worker<'m, O::Process, K, L>],
    ) {
        self.judge(model, tally, workers);
        if !self.over && !self.active && (self.way == Way::Staged || self.pace.tries(frontier)) {
            self.begin(model, properties, open, tally, workers);
        }
    }

    /// Takes the stages away if a worker has given them up, and all together lose by them: one that has joined late may have learned too
    /// little, and goes on alone.
    fn judge<O: Origin, K: Key, L>(
        &mut self,
        model: &Model<'_, O, K>,
        tally: &mut Tally<K>,
        workers: &mut [Worker<'_, O::Process, K, L>],
    ) {
        let trials = || workers.iter().filter_map(|w| w.trial);
        if trials().any(|t| t.over) && trials().map(|t| t.lost()).sum::<i128>() > 0 {
            self.end(tally, workers);
            model.pays.store(false, Ordering::Relaxed);
        }
    }

    /// Gives the workers the stages of the system.
    fn begin<'m, O: Origin, K: Key, L>(
        &mut self,
        model: &'m Model<'_, O, K>,
        properties: &[Property],
        open: &[usize],
        tally: &mut Tally<K>,
        workers: &mut [Worker<'m, O::Process, K, L>],
    ) {
        // What is known of a property already is not looked for.
        let shown = |p: usize| (tally.signs[p].first.is_some(), tally.signs[p].met);
        let Some(watched) = Watched::new(properties, open, shown) else {
            // More may be known when the next level is over.
            return;
        };
        let threads = workers.len();
        let quicker = self.way == Way::Quicker;
        for worker in workers.iter_mut() {
            worker.staged = model.staged(&watched.conditions);
            worker.trial = quicker.then(|| Trial::new(&self.pace, threads));
        }
        if workers.iter().any(|worker| worker.staged.is_none()) {
            self.end(tally, workers);
            return;
        }
        self.active = true;
        self.watched = watched;
        model.pays.store(true, Ordering::Relaxed);
    }

    /// Takes the stages away for good.
    fn end<K: Key, P, L>(&mut self, tally: &mut Tally<K>, workers: &mut [Worker<'_, P, K, L>]) {
        for worker in workers {
            worker.trial = None;
            if let Some(mut staged) = worker.staged.take() {
                staged.count(&mut tally.coverage);
            }
        }
        self.active = false;
        self.over = true;
    }
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
