//! An exact hash set of state indices, in shards, and the store built on it.

use crate::pack::Key;
use crate::store::{PIECE, Store};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

const SHARDS: usize = 64;
/// Keys of one shard a worker gathers before it takes the shard's lock.
const BATCH: usize = 64;

/// Open addressing with linear probing; any capacity, so that growth by half keeps the table compact.
struct Shard<K> {
    slots: Vec<K>,
    used: usize,
}

impl<K: Key> Shard<K> {
    /// True if the key is new.
    #[inline]
    fn insert(&mut self, key: K, bytes: &AtomicU64) -> bool {
        if self.used * 5 >= self.slots.len() * 4 {
            self.grow(bytes);
        }
        let slot = self.find(key);
        if self.slots[slot] == key {
            return false;
        }
        self.slots[slot] = key;
        self.used += 1;
        true
    }

    /// The slot of the key, or the empty one where it belongs. The table is never full.
    #[inline]
    fn find(&self, key: K) -> usize {
        let size = self.slots.len();
        let mut slot = ((u128::from(key.hash()) * size as u128) >> 64) as usize;
        while self.slots[slot] != key && self.slots[slot] != K::EMPTY {
            slot += 1;
            if slot == size {
                slot = 0;
            }
        }
        slot
    }

    fn grow(&mut self, bytes: &AtomicU64) {
        let before = self.slots.len();
        let old = std::mem::replace(
            &mut self.slots,
            vec![K::EMPTY; (before + before / 2).max(16)],
        );
        let more = (self.slots.len() - before) * size_of::<K>();
        bytes.fetch_add(more as u64, Ordering::Relaxed);
        for key in old.into_iter().filter(|key| *key != K::EMPTY) {
            let slot = self.find(key);
            self.slots[slot] = key;
        }
    }
}

/// A set of indices for many writers.
pub(crate) struct Sharded<K> {
    shards: Vec<Mutex<Shard<K>>>,
    bytes: AtomicU64,
}

/// Keys on their way into a set, by shard.
pub(crate) struct Batch<K>(Vec<Vec<K>>);

impl<K: Key> Batch<K> {
    pub(crate) fn new() -> Self {
        Batch((0..SHARDS).map(|_| Vec::new()).collect())
    }
}

impl<K: Key> Sharded<K> {
    pub(crate) fn new() -> Self {
        let shards = (0..SHARDS)
            .map(|_| {
                Mutex::new(Shard {
                    slots: Vec::new(),
                    used: 0,
                })
            })
            .collect();
        Sharded {
            shards,
            bytes: AtomicU64::new(0),
        }
    }

    /// Adds the key at once or later; `found` gets each key that is new when it is added.
    #[inline]
    pub(crate) fn insert(&self, batch: &mut Batch<K>, key: K, found: impl FnMut(K)) {
        // The table position uses the upper bits of the hash, the shard the lower ones.
        let shard = key.hash() as usize % SHARDS;
        batch.0[shard].push(key);
        if batch.0[shard].len() >= BATCH {
            self.flush_shard(shard, &mut batch.0[shard], found);
        }
    }

    fn flush_shard(&self, shard: usize, keys: &mut Vec<K>, mut found: impl FnMut(K)) {
        let mut table = self.shards[shard]
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        for key in keys.drain(..) {
            if table.insert(key, &self.bytes) {
                found(key);
            }
        }
    }

    /// Adds everything still in the batch.
    pub(crate) fn flush(&self, batch: &mut Batch<K>, mut found: impl FnMut(K)) {
        for (shard, keys) in batch
            .0
            .iter_mut()
            .enumerate()
            .filter(|(_, keys)| !keys.is_empty())
        {
            self.flush_shard(shard, keys, &mut found);
        }
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// All keys in ascending order.
    pub(crate) fn sorted(&self) -> Vec<K> {
        let mut keys = Vec::new();
        for shard in &self.shards {
            let table = shard.lock().unwrap_or_else(PoisonError::into_inner);
            keys.extend(table.slots.iter().filter(|key| **key != K::EMPTY));
        }
        keys.sort_unstable();
        keys
    }
}

/// States in a hash set, the frontier in a list.
pub(crate) struct Hashed<K> {
    set: Sharded<K>,
    list: Vec<K>,
    lists: AtomicU64,
}

/// What a worker found in a level.
pub(crate) struct HashedLocal<K> {
    batch: Batch<K>,
    found: Vec<K>,
}

impl<K: Key> Hashed<K> {
    pub(crate) fn new() -> Self {
        Hashed {
            set: Sharded::new(),
            list: Vec::new(),
            lists: AtomicU64::new(0),
        }
    }
}

impl<K: Key> Store for Hashed<K> {
    type Key = K;
    type Local = HashedLocal<K>;

    fn local(&self) -> HashedLocal<K> {
        HashedLocal {
            batch: Batch::new(),
            found: Vec::new(),
        }
    }

    #[inline]
    fn visit(&self, local: &mut HashedLocal<K>, key: K) {
        let found = &mut local.found;
        let before = found.capacity();
        self.set
            .insert(&mut local.batch, key, |key| found.push(key));
        if found.capacity() > before {
            self.lists.fetch_add(
                ((found.capacity() - before) * size_of::<K>()) as u64,
                Ordering::Relaxed,
            );
        }
    }

    fn advance(&mut self, locals: Vec<&mut HashedLocal<K>>) -> u64 {
        self.list = Vec::new();
        for local in locals {
            let found = &mut local.found;
            self.set.flush(&mut local.batch, |key| found.push(key));
            self.list.append(&mut std::mem::take(found));
        }
        self.lists = AtomicU64::new((self.list.capacity() * size_of::<K>()) as u64);
        self.list.len() as u64
    }

    fn pieces(&self) -> usize {
        self.list.len().div_ceil(PIECE)
    }

    #[inline]
    fn each(&self, piece: usize, mut visit: impl FnMut(K)) {
        let end = self.list.len().min((piece + 1) * PIECE);
        for key in &self.list[piece * PIECE..end] {
            visit(*key);
        }
    }

    fn bytes(&self) -> u64 {
        self.set.bytes() + self.lists.load(Ordering::Relaxed)
    }

    fn clear(&mut self) {
        *self = Hashed::new();
    }
}
