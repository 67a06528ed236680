//! The ways behind each group of stages, as the state before left them: of states that are much alike the first stages read the same, so
//! that what they make of it is there already.

use super::Staged;
use super::counting::visit;
use super::ways::Way;
use crate::pack::Key;

/// What a group has made of the state before, and of what the groups before it made.
pub(super) struct Prefix<K> {
    pub(super) ways: Vec<Way<K>>,
    /// The places looked up, with the combinations that came there from each state.
    pub(super) looked: Vec<(u32, u128)>,
    /// The states that it was the same for, of which the places know nothing yet.
    pub(super) states: u128,
}

impl<K> Default for Prefix<K> {
    fn default() -> Self {
        Prefix {
            ways: Vec::new(),
            looked: Vec::new(),
            states: 0,
        }
    }
}

impl<K> Prefix<K> {
    pub(super) fn bytes(&self) -> u64 {
        let bytes = self.ways.capacity() * size_of::<Way<K>>()
            + self.looked.capacity() * size_of::<(u32, u128)>();
        bytes as u64
    }
}

impl<K: Key> Staged<'_, K> {
    /// The ways that come to a group.
    #[inline]
    fn ways(&mut self, group: usize) -> &mut Vec<Way<K>> {
        match group.checked_sub(1) {
            Some(before) => &mut self.prefixes[before].ways,
            None => &mut self.first,
        }
    }

    /// Takes them, to be put back.
    #[inline]
    pub(super) fn take_ways(&mut self, group: usize) -> Vec<Way<K>> {
        std::mem::take(self.ways(group))
    }

    #[inline]
    pub(super) fn put_back(&mut self, group: usize, ways: Vec<Way<K>>) {
        *self.ways(group) = ways;
    }

    /// Tells the places of a group's prefix for how many states they were looked up.
    #[inline]
    pub(super) fn settle(&mut self, group: usize) {
        let Prefix { looked, states, .. } = &mut self.prefixes[group];
        let states = std::mem::take(states);
        if states > 0 {
            let table = &mut self.tables[self.groups[group].table];
            for (place, weight) in looked {
                let more = weight.checked_mul(states);
                visit(table.visits(*place), more, self.combinations);
            }
        }
    }

    /// Forgets the prefixes: places and groups have another meaning from now on.
    pub(super) fn forget_prefixes(&mut self) {
        (0..self.groups.len()).for_each(|group| self.settle(group));
        self.prefixes.fill_with(Prefix::default);
        self.valid = 0;
    }

    /// The first group that reads each variable.
    pub(super) fn note_readers(&mut self) {
        self.readers.fill(usize::MAX);
        for (number, group) in self.groups.iter().enumerate().rev() {
            for variable in self.tables[group.table].reads() {
                self.readers[variable] = number;
            }
        }
    }
}
