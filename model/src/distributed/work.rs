//! The search as one worker makes it, together with the workers of all processes.

use super::flow::{Lost, Post, Wire};
use super::share::{Share, ShareLocal};
use crate::hashed::Code;
use crate::level::{Level, UNWATCHED, Worker, bytes, gather, least, lower};
use crate::model::Model;
use crate::parts::Tables;
use crate::process::{Any, AnyProcess, Origin};
use crate::property::Property;
use crate::report::{Error, Options, Progress};
use crate::set::{Batch, Set};
use crate::stages::Watched;
use crate::store::Store;
use crate::tally::{Found, Signs, Tally};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use timely::communication::Allocate;

/// Keys in one note.
const PENDING: usize = 4096;

/// Pieces of a level between two looks at what has come. A look tells all others about progress, which costs more than a
/// piece does.
const POLL: usize = 32;

/// What workers tell each other beside states.
#[derive(Clone, Serialize, Deserialize)]
pub(super) enum Note<K> {
    /// About the level just explored; every worker gets it.
    Explored(Explored),
    /// Part of what the sender has found about pending duties; for worker 0, like all that follows.
    Pending { property: usize, keys: Vec<K> },
    /// The rest of what the sender has found.
    Totals(Box<Totals<K>>),
}

#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Explored {
    /// The sender's states of that level.
    frontier: u64,
    /// Of the sender so far.
    transitions: u128,
    /// The sender has met a limit.
    stopped: bool,
    /// For each property whether `first` and `bad` have shown.
    signs: Vec<(bool, bool)>,
}

type Place<K> = Option<(u32, K)>;

#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Totals<K> {
    signs: Vec<(Place<K>, Place<K>, bool)>,
    faults: Vec<(u32, (u32, K))>,
    coverage: Vec<u64>,
    absorbing: u64,
    examples: Vec<K>,
    explored: u64,
    weights: u128,
    bytes: u64,
    stored: u64,
    sent: u64,
}

/// What all workers of one process share.
pub(super) struct Task<'a, K> {
    pub(super) model: Model<'a, Any<'a>, K>,
    pub(super) properties: &'a [Property],
    pub(super) options: &'a Options,
    pub(super) parts: Option<Tables<K>>,
    /// Bytes held by each worker of this process.
    pub(super) held: Vec<AtomicU64>,
    /// At process 0, in the end: the states that all workers have sent to others.
    pub(super) sent: AtomicU64,
}

/// Why a worker ended without an answer.
#[derive(Debug)]
pub(super) enum Broken {
    /// The system is to blame; all workers come to the same end.
    System(Error),
    Lost,
}

impl From<Lost> for Broken {
    fn from(_: Lost) -> Self {
        Broken::Lost
    }
}

type Own<'a, C> = Worker<'a, AnyProcess<'a>, <C as Code>::Key, ShareLocal<C>>;

impl<'a, K: Wire> Task<'a, K> {
    /// Makes the search as worker `number` of this process. Worker 0 of process 0 gets what all have found.
    pub(super) fn work<C: Code<Key = K>, A: Allocate>(
        &self,
        number: usize,
        mut post: Post<'_, A, K, Note<K>>,
        progress: &mut dyn Progress,
    ) -> Result<Option<Found<K>>, Broken> {
        let origin = &self.model.origin;
        let (rules, count) = (origin.rules(), self.properties.len());
        let mut share = Share::<C>::new(post.index(), post.peers());
        let mut worker = Worker::new(
            origin,
            self.model.watch,
            share.local(),
            count,
            self.parts.as_ref(),
        );
        let mut found = Found {
            tally: Tally::new(count, rules),
            pending: self.properties.iter().map(|_| Set::new()).collect(),
            bytes: 0,
            resumable: false,
        };
        // Each worker makes all initial states and keeps its own.
        let mut unwatched = 0;
        self.model
            .cursor()
            .initial(&self.model.packer, |key, _| {
                share.visit(&mut worker.local, key);
                // Who else owns them makes them too.
                worker.local.out.clear();
                unwatched += 1;
                match unwatched % UNWATCHED == 0 && self.model.watch.over(share.bytes()) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            })
            .map_err(Broken::System)?;
        post.end_depth(&mut |_| ())?;
        let mut signs = vec![(false, false); count];
        let (mut states, mut depth, mut stop) = (0, 0, false);
        loop {
            let frontier = share.advance(vec![&mut worker.local]);
            found.tally.depth = depth;
            if !stop {
                self.level(number, &mut post, &share, &mut worker, &found, &signs)?;
                let parts = self.parts.as_ref();
                gather(&mut found, &mut worker, parts, true, self.options.examples);
            }
            found.bytes = found.bytes.max(bytes(&share, &found.pending));
            found.tally.stored = share.bytes();
            let explored = Explored {
                frontier,
                transitions: found.tally.transitions,
                stopped: self.model.watch.stopped(),
                signs: seen(&found.tally.signs),
            };
            for peer in 0..post.peers() {
                post.tell(peer, Note::Explored(explored.clone()));
            }
            let notes = post.end_depth(&mut |key| share.take(&mut worker.local, key))?;
            // From here on all workers decide alike: all have the same notes.
            let (mut frontier, mut transitions, mut stopped) = (0, 0u128, false);
            for note in notes {
                if let Note::Explored(explored) = note {
                    frontier += explored.frontier;
                    transitions = transitions.saturating_add(explored.transitions);
                    stopped |= explored.stopped;
                    for (all, one) in signs.iter_mut().zip(explored.signs) {
                        *all = (all.0 | one.0, all.1 | one.1);
                    }
                }
            }
            states += frontier;
            if frontier > 0 && post.index() == 0 {
                progress.on_memory(bytes(&share, &found.pending));
                progress.on_level(depth, states, transitions, frontier);
            }
            if frontier == 0 || stop {
                let tally = &mut found.tally;
                tally.states = states;
                tally.transitions = transitions;
                // What a limit broke off is no level.
                tally.depth = depth.saturating_sub(u32::from(frontier == 0 || stopped));
                tally.complete = !stopped && frontier == 0;
                break;
            }
            let seen = signs.iter().copied();
            stop = stopped || self.options.until.is_met(self.properties, seen);
            depth += 1;
        }
        self.together(post, found, worker.local.sent)
    }

    /// Explores the worker's part of one level.
    fn level<C: Code<Key = K>, A: Allocate>(
        &self,
        number: usize,
        post: &mut Post<'_, A, K, Note<K>>,
        share: &Share<C>,
        worker: &mut Own<'a, C>,
        found: &Found<K>,
        signs: &[(bool, bool)],
    ) -> Result<(), Broken> {
        let settled = |p: usize| self.properties[p].form.settled(signs[p].0, signs[p].1);
        let open: Vec<usize> = (0..signs.len()).filter(|p| !settled(*p)).collect();
        let level = Level {
            model: &self.model,
            store: share,
            properties: self.properties,
            open: &open,
            pending: &found.pending,
            options: self.options,
            parts: self.parts.as_ref(),
            watched: &Watched::default(),
        };
        for piece in 0..share.pieces() {
            self.held[number].store(bytes(share, &found.pending), Ordering::Relaxed);
            let held = self.held.iter().map(|h| h.load(Ordering::Relaxed));
            if self.model.watch.over(held.fold(0, u64::saturating_add)) {
                return Ok(());
            }
            level.piece(worker, piece);
            worker.local.sent += worker.local.out.len() as u64;
            worker.local.out.drain(..).for_each(|key| post.send(key));
            if piece % POLL == POLL - 1 {
                post.poll(&mut |key| share.take(&mut worker.local, key))?;
            }
        }
        Ok(())
    }

    /// Brings together at worker 0 what all have found.
    fn together<A: Allocate>(
        &self,
        mut post: Post<'_, A, K, Note<K>>,
        mut found: Found<K>,
        sent: u64,
    ) -> Result<Option<Found<K>>, Broken> {
        let first = post.index() == 0;
        if !first {
            for (property, set) in found.pending.iter().enumerate() {
                for keys in set.sorted().chunks(PENDING) {
                    let keys = keys.to_vec();
                    post.tell(0, Note::Pending { property, keys });
                }
            }
        }
        let tally = &mut found.tally;
        let totals = Totals {
            signs: tally
                .signs
                .iter()
                .map(|s| (s.first, s.bad, s.met))
                .collect(),
            faults: std::mem::take(&mut tally.faults).into_iter().collect(),
            coverage: std::mem::take(&mut tally.coverage),
            absorbing: std::mem::take(&mut tally.absorbing),
            examples: std::mem::take(&mut tally.examples),
            explored: std::mem::take(&mut tally.explored),
            weights: std::mem::take(&mut tally.weights),
            bytes: std::mem::take(&mut found.bytes),
            stored: std::mem::take(&mut tally.stored),
            sent,
        };
        post.tell(0, Note::Totals(Box::new(totals)));
        let notes = post.end_depth(&mut |_| ())?;
        post.close()?;
        if !first {
            return Ok(None);
        }
        found.tally.coverage = vec![0; self.model.origin.rules()];
        for note in notes {
            match note {
                Note::Explored(_) => (),
                Note::Pending { property, keys } => {
                    let mut batch = Batch::new();
                    for key in keys {
                        found.pending[property].insert(&mut batch, key);
                    }
                    found.pending[property].flush(&mut batch);
                }
                Note::Totals(totals) => {
                    self.sent.fetch_add(totals.sent, Ordering::Relaxed);
                    merge(&mut found, *totals, self.options.examples);
                }
            }
        }
        let declared = self.model.origin.combinations();
        let Tally {
            explored, weights, ..
        } = found.tally;
        if weights != u128::from(explored).wrapping_mul(declared) {
            return Err(Broken::System(Error::Combinations { declared }));
        }
        Ok(Some(found))
    }
}

fn seen<K>(signs: &[Signs<K>]) -> Vec<(bool, bool)> {
    let both = |s: &Signs<K>| (s.first.is_some(), s.bad.is_some());
    signs.iter().map(both).collect()
}

fn merge<K: Wire>(found: &mut Found<K>, totals: Totals<K>, examples: usize) {
    found.bytes = found.bytes.saturating_add(totals.bytes);
    let tally = &mut found.tally;
    tally.stored = tally.stored.saturating_add(totals.stored);
    for (all, (first, bad, met)) in tally.signs.iter_mut().zip(totals.signs) {
        if let Some(place) = first {
            lower(&mut all.first, place);
        }
        if let Some(place) = bad {
            lower(&mut all.bad, place);
        }
        all.met |= met;
    }
    for (code, place) in totals.faults {
        let first = tally.faults.entry(code).or_insert(place);
        *first = place.min(*first);
    }
    for (sum, count) in tally.coverage.iter_mut().zip(totals.coverage) {
        *sum = sum.saturating_add(count);
    }
    tally.absorbing += totals.absorbing;
    tally.explored += totals.explored;
    tally.weights = tally.weights.wrapping_add(totals.weights);
    tally.examples.extend(totals.examples);
    least(&mut tally.examples, examples);
}
