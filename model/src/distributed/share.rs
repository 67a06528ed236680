//! One worker's share of the states: those whose hash is its own. What else its cycles lead to goes out.

use super::flow::owner;
use crate::checkpoint::{In, Out};
use crate::hashed::{Code, Hashed, HashedLocal};
use crate::pack::Key;
use crate::store::Store;
use std::io;
use std::sync::atomic::{AtomicU64, Ordering};

/// Slots of the filter for states sent before.
const RECENT: usize = 1 << 14;

/// States that go out between two notes of the memory they take.
const WAITING: usize = 4096;

/// An exact hash set of the states that belong to one worker.
pub(super) struct Share<C> {
    own: Hashed<C>,
    worker: u64,
    workers: u64,
    /// Bytes of the states of other workers that have not been sent, now and then.
    waiting: AtomicU64,
}

/// What one worker collects during a level.
pub(super) struct ShareLocal<C: Code> {
    own: HashedLocal<C::Memory>,
    /// States of other workers.
    pub(super) out: Vec<C::Key>,
    /// How many of them have been sent.
    pub(super) sent: u64,
    /// States sent before, by a part of their hash: sending one again would tell its owner nothing.
    recent: Vec<Option<C::Key>>,
}

impl<C: Code> Share<C> {
    pub(super) fn new(worker: u64, workers: u64) -> Self {
        Share {
            own: Hashed::new(),
            worker,
            workers,
            waiting: AtomicU64::new(0),
        }
    }

    /// Adds a state of this worker that came from another one.
    pub(super) fn take(&self, local: &mut ShareLocal<C>, key: C::Key) {
        self.own.visit(&mut local.own, key);
    }
}

impl<C: Code> Store for Share<C> {
    type Key = C::Key;
    type Local = ShareLocal<C>;

    fn local(&self) -> ShareLocal<C> {
        ShareLocal {
            own: self.own.local(),
            out: Vec::new(),
            sent: 0,
            recent: vec![None; RECENT],
        }
    }

    #[inline]
    fn visit(&self, local: &mut ShareLocal<C>, key: C::Key) {
        if owner(key) % self.workers == self.worker {
            return self.own.visit(&mut local.own, key);
        }
        let slot = &mut local.recent[key.hash() as usize % RECENT];
        if *slot != Some(key) {
            *slot = Some(key);
            local.out.push(key);
            if local.out.len() % WAITING == 0 {
                let bytes = local.out.capacity() * size_of::<C::Key>();
                self.waiting.store(bytes as u64, Ordering::Relaxed);
            }
        }
    }

    fn advance(&mut self, locals: Vec<&mut ShareLocal<C>>) -> u64 {
        self.own
            .advance(locals.into_iter().map(|l| &mut l.own).collect())
    }

    fn undo(&mut self, locals: Vec<&mut ShareLocal<C>>) -> u64 {
        self.own
            .undo(locals.into_iter().map(|l| &mut l.own).collect())
    }

    const NAME: &'static str = C::NAME;

    fn save(&self, out: &mut Out) -> io::Result<()> {
        self.own.save(out)
    }

    fn load(&mut self, input: &mut In) -> io::Result<()> {
        self.own.load(input)
    }

    fn pieces(&self) -> usize {
        self.own.pieces()
    }

    fn size(&self) -> u64 {
        self.own.size()
    }

    #[inline]
    fn each(&self, piece: usize, visit: impl FnMut(C::Key)) {
        self.own.each(piece, visit);
    }

    fn all(&self, states: usize) -> Vec<C::Key> {
        self.own.all(states)
    }

    fn bytes(&self) -> u64 {
        let waiting = self.waiting.load(Ordering::Relaxed);
        self.own.bytes() + waiting + (RECENT * size_of::<Option<C::Key>>()) as u64
    }

    fn clear(&mut self) {
        self.own.clear();
    }
}
