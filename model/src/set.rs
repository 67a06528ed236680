//! Exact sets of numbers for many writers, in shards: the members in a list, and a table of places in that list.
//!
//! A list grows by an eighth and a table by a quarter, so that a member of 8 bytes takes at most 16 bytes with its place.

use crate::checkpoint::{In, Out};
use crate::pack::Key;
use std::io;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The number of shards; six bits of a hash choose one.
pub(crate) const SHARDS: usize = 64;
/// Keys of one shard a worker gathers before it takes the shard's lock.
const BATCH: usize = 64;
/// Bits of a slot that tell a place in the list, plus one; the bits above them are taken from the hash.
const PLACE: u32 = (1 << 26) - 1;

/// Open addressing with linear probing. A slot is 0 or a place plus one, with six bits of the hash: most members that are
/// not the one looked for differ in them.
pub(crate) struct Shard<K> {
    pub(crate) keys: Vec<K>,
    slots: Vec<u32>,
}

#[inline]
fn slot_of(hash: u64, slots: usize) -> usize {
    ((u128::from(hash) * slots as u128) >> 64) as usize
}

#[inline]
fn tag_of(hash: u64) -> u32 {
    (hash as u32 & 0xfc0) << 20
}

impl<K: Key> Shard<K> {
    pub(crate) const fn new() -> Self {
        Shard {
            keys: Vec::new(),
            slots: Vec::new(),
        }
    }

    fn bytes(&self) -> u64 {
        (self.keys.capacity() * size_of::<K>() + self.slots.capacity() * 4) as u64
    }

    /// The place of the key in the list, and whether it is new; none if there is no place left.
    #[inline]
    pub(crate) fn insert(&mut self, key: K, bytes: &AtomicU64) -> Option<(u32, bool)> {
        if self.keys.len() * 5 >= self.slots.len() * 4 {
            let before = self.bytes();
            let slots = self.slots.len();
            self.place((slots + slots / 4).max(16));
            bytes.fetch_add(self.bytes() - before, Ordering::Relaxed);
        }
        let hash = key.hash();
        let tag = tag_of(hash);
        let mut slot = slot_of(hash, self.slots.len());
        while self.slots[slot] != 0 {
            let place = (self.slots[slot] & PLACE).wrapping_sub(1);
            if self.slots[slot] & !PLACE == tag && self.keys[place as usize] == key {
                return Some((place, false));
            }
            slot += 1;
            if slot == self.slots.len() {
                slot = 0;
            }
        }
        let place = u32::try_from(self.keys.len()).ok()?;
        if place + 1 > PLACE {
            return None;
        }
        if self.keys.len() == self.keys.capacity() {
            let before = self.bytes();
            self.keys.reserve_exact(self.keys.len() / 8 + 16);
            bytes.fetch_add(self.bytes() - before, Ordering::Relaxed);
        }
        self.keys.push(key);
        self.slots[slot] = (place + 1) | tag;
        Some((place, true))
    }

    /// Makes a table of so many slots for the keys of the list.
    fn place(&mut self, slots: usize) {
        // The old table goes first.
        self.slots = Vec::new();
        self.slots = vec![0; slots];
        for (place, key) in self.keys.iter().enumerate() {
            let hash = key.hash();
            let mut slot = slot_of(hash, slots);
            while self.slots[slot] != 0 {
                slot = (slot + 1) % slots;
            }
            // Fits: it did when the key was inserted.
            self.slots[slot] = (place as u32 + 1) | tag_of(hash);
        }
    }

    /// Forgets the keys from a place on.
    pub(crate) fn truncate(&mut self, keys: usize) {
        if keys < self.keys.len() {
            self.keys.truncate(keys);
            self.place(self.slots.len());
        }
    }
}

/// A set for many writers.
pub(crate) struct Set<K> {
    shards: Vec<Mutex<Shard<K>>>,
    bytes: AtomicU64,
}

/// Keys on their way into a set, by shard.
pub(crate) struct Batch<K>(Vec<Vec<K>>);

impl<K: Key> Batch<K> {
    pub(crate) fn new() -> Self {
        Batch((0..SHARDS).map(|_| Vec::new()).collect())
    }

    pub(crate) fn clear(&mut self) {
        self.0.iter_mut().for_each(Vec::clear);
    }
}

impl<K: Key> Set<K> {
    pub(crate) fn new() -> Self {
        Set {
            shards: (0..SHARDS).map(|_| Mutex::new(Shard::new())).collect(),
            bytes: AtomicU64::new(0),
        }
    }

    pub(crate) fn shard(&self, shard: usize) -> MutexGuard<'_, Shard<K>> {
        self.shards[shard]
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a key at once; its shard and its place there, and whether it is new.
    #[inline]
    pub(crate) fn add(&self, key: K) -> Option<(usize, u32, bool)> {
        let shard = key.hash() as usize % SHARDS;
        let added = self.shard(shard).insert(key, &self.bytes);
        if added.is_none() {
            self.overflow();
        }
        added.map(|(place, new)| (shard, place, new))
    }

    /// Adds a key at once or later.
    #[inline]
    pub(crate) fn insert(&self, batch: &mut Batch<K>, key: K) {
        // The slot uses the upper bits of the hash, the shard the lower ones.
        let shard = key.hash() as usize % SHARDS;
        batch.0[shard].push(key);
        if batch.0[shard].len() >= BATCH {
            self.flush_shard(shard, &mut batch.0[shard]);
        }
    }

    fn flush_shard(&self, shard: usize, keys: &mut Vec<K>) {
        let mut table = self.shard(shard);
        for key in keys.drain(..) {
            if table.insert(key, &self.bytes).is_none() {
                self.overflow();
            }
        }
    }

    /// Adds everything still in the batch.
    pub(crate) fn flush(&self, batch: &mut Batch<K>) {
        for (shard, keys) in batch.0.iter_mut().enumerate() {
            if !keys.is_empty() {
                self.flush_shard(shard, keys);
            }
        }
    }

    /// A shard has no place left: more memory than any machine has is asked for, so that the search ends.
    #[cold]
    fn overflow(&self) {
        self.bytes.store(u64::MAX / 4, Ordering::Relaxed);
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// The number of keys in each shard.
    pub(crate) fn counts(&self) -> Vec<usize> {
        (0..SHARDS)
            .map(|shard| self.shard(shard).keys.len())
            .collect()
    }

    /// All keys in ascending order.
    pub(crate) fn sorted(&self) -> Vec<K> {
        let mut keys = Vec::new();
        for shard in 0..SHARDS {
            keys.extend_from_slice(&self.shard(shard).keys);
        }
        keys.sort_unstable();
        keys
    }
}

impl Set<u64> {
    /// Writes the lists of all shards.
    pub(crate) fn save(&self, out: &mut Out) -> io::Result<()> {
        (0..SHARDS).try_for_each(|shard| out.numbers(&self.shard(shard).keys))
    }

    /// Reads them into an empty set; each key gets the place it had.
    pub(crate) fn load(&mut self, input: &mut In) -> io::Result<()> {
        for shard in 0..SHARDS {
            for _ in 0..input.count()? {
                self.shard(shard).insert(input.number()?, &self.bytes);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_there_once_and_take_at_most_sixteen_bytes() {
        let set = Set::<u64>::new();
        let mut batch = Batch::new();
        let key = |n: u64| n.wrapping_mul(0x1_0000_0001) ^ (n << 40);
        let many = 300_000u64;
        for n in (0..many).chain(0..many / 2) {
            set.insert(&mut batch, key(n));
            if n % 50_000 == 49_999 {
                set.flush(&mut batch);
                let keys: usize = set.counts().iter().sum();
                assert!(set.bytes() <= 16 * keys as u64, "{keys}: {}", set.bytes());
            }
        }
        set.flush(&mut batch);
        let mut all: Vec<u64> = (0..many).map(key).collect();
        all.sort_unstable();
        assert_eq!(set.sorted(), all);
        let (shard, place, new) = set.add(key(7)).unwrap();
        assert!(!new && set.shard(shard).keys[place as usize] == key(7));
        set.shard(shard).truncate(place as usize);
        assert_eq!(set.add(key(7)), Some((shard, place, true)));
    }
}
