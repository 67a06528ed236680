//! States with numbers, in the order in which they got them.

use crate::pack::Key;

/// Numbers for states, from 0.
#[derive(Debug)]
pub(crate) struct Nodes<K> {
    keys: Vec<K>,
    /// Open addressing from keys to numbers plus one.
    table: Vec<u32>,
}

/// Appends to a list that grows by an eighth: doubling it could take far more than the memory that is left.
pub(crate) fn push<T>(list: &mut Vec<T>, value: T) {
    if list.len() == list.capacity() {
        list.reserve_exact(list.len() / 8 + 64);
    }
    list.push(value);
}

impl<K: Key> Nodes<K> {
    pub(crate) fn new() -> Self {
        Nodes {
            keys: Vec::new(),
            table: vec![0; 64],
        }
    }

    /// Numbers for these states, which are different ones; none if there are too many.
    pub(crate) fn of(keys: Vec<K>) -> Option<Self> {
        let size = Self::size_for(u32::try_from(keys.len() + 1).ok()?);
        let mut nodes = Nodes {
            keys,
            table: Vec::new(),
        };
        nodes.place(size);
        Some(nodes)
    }

    /// The bytes that so many states take in [`Nodes::of`].
    pub(crate) fn bytes_for(states: u64) -> u64 {
        let size = u32::try_from(states + 1).map_or(u64::MAX / 8, |n| Self::size_for(n) as u64);
        states
            .saturating_mul(size_of::<K>() as u64)
            .saturating_add(size * 4)
    }

    fn size_for(states: u32) -> usize {
        states as usize / 2 * 3 + 64
    }

    /// Makes a table of so many places for the states.
    fn place(&mut self, size: usize) {
        // The old table goes first.
        self.table = Vec::new();
        self.table = vec![0; size];
        for (node, number) in self.keys.iter().zip(1..) {
            let mut slot = ((u128::from(node.hash()) * size as u128) >> 64) as usize;
            while self.table[slot] != 0 {
                slot = (slot + 1) % size;
            }
            self.table[slot] = number;
        }
    }

    pub(crate) fn keys(&self) -> &[K] {
        &self.keys
    }

    pub(crate) fn bytes(&self) -> u64 {
        (self.keys.capacity() * size_of::<K>() + self.table.capacity() * 4) as u64
    }

    #[inline]
    fn slot(&self, key: K) -> usize {
        let size = self.table.len();
        let mut slot = ((u128::from(key.hash()) * size as u128) >> 64) as usize;
        while self.table[slot] != 0 && self.keys[self.table[slot] as usize - 1] != key {
            slot = (slot + 1) % size;
        }
        slot
    }

    /// The number of a state, a new one if it has none; none if there are too many.
    pub(crate) fn add(&mut self, key: K) -> Option<u32> {
        let slot = self.slot(key);
        if self.table[slot] != 0 {
            return Some(self.table[slot] - 1);
        }
        let next = u32::try_from(self.keys.len() + 1).ok()?;
        push(&mut self.keys, key);
        self.table[slot] = next;
        if self.keys.len() * 3 >= self.table.len() * 2 {
            self.place(self.table.len() * 2);
        }
        Some(next - 1)
    }

    /// The number of a state, if it has one.
    #[inline]
    pub(crate) fn number(&self, key: K) -> Option<u32> {
        self.table[self.slot(key)].checked_sub(1)
    }
}
