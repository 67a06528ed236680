//! Bursts: what follows from one way behind the last table, from a state so far and a place there. Many states share them, so what is
//! made of one is noted.

use super::table::Follows;
use crate::pack::Key;

/// The most bursts that are remembered: so few that looking one up costs less than what follows from it.
const MOST: usize = 1 << 14;

/// Of what may be held, the part that they may.
const SHARE: u64 = 16;

/// Cycles of a state, of which others may have the same.
#[derive(Clone, Copy)]
pub(crate) struct Burst<'a, K> {
    pub(super) state: K,
    pub(super) follows: Follows<'a, K>,
    pub(super) marks: &'a [u128],
}

impl<K: Key> Burst<'_, K> {
    /// The states after them, each with the conditions that hold in it.
    #[inline]
    pub(crate) fn ends(&self) -> impl Iterator<Item = (K, u128)> + '_ {
        let (one, all) = match self.follows {
            Follows::One(own, class) => (Some((own, class)), &[][..]),
            Follows::Of(outcomes) => (None, outcomes),
        };
        let all = all.iter().map(|(own, class, _)| (*own, *class));
        one.into_iter().chain(all).map(|(own, class)| {
            let marks = self.marks.get(class as usize).copied();
            (self.state.plus(own), marks.unwrap_or(0))
        })
    }

    /// Whether there is one state after them, so that it costs no more to look at it than to see whether it was looked at.
    #[inline]
    pub(super) fn is_one(&self) -> bool {
        matches!(self.follows, Follows::One(..))
    }
}

/// A burst, the age in which it was handed on, and what was noted.
type Slot<K> = ((K, u32), u32, u128);

/// What was noted of bursts, of those that came last.
pub(super) struct Seen<K> {
    /// A power of two; none before the first burst.
    slots: Vec<Slot<K>>,
    room: usize,
    /// Slots of another age are empty.
    age: u32,
}

impl<K: Key> Seen<K> {
    /// So many at most as fit into a share of these bytes.
    pub(super) fn new(most: u64) -> Self {
        let fit = usize::try_from(most / SHARE).unwrap_or(usize::MAX) / size_of::<Slot<K>>();
        Seen {
            slots: Vec::new(),
            room: 1 << fit.clamp(1, MOST).ilog2(),
            age: 1,
        }
    }

    #[inline]
    fn slot(&self, state: K, place: u32) -> usize {
        let hash = state.hash() ^ u64::from(place).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (hash.wrapping_mul(0xd6e8_feb8_6659_fd93) >> 32) as usize & (self.room - 1)
    }

    /// What was noted of a burst.
    #[inline]
    pub(super) fn note(&self, state: K, place: u32) -> Option<u128> {
        let (of, age, note) = self.slots.get(self.slot(state, place))?;
        (*age == self.age && *of == (state, place)).then_some(*note)
    }

    /// Notes something of a burst.
    #[inline]
    pub(super) fn add(&mut self, state: K, place: u32, note: u128) {
        if self.slots.is_empty() {
            self.slots = vec![((K::of([0, 0]), 0), 0, 0); self.room];
        }
        let slot = self.slot(state, place);
        self.slots[slot] = ((state, place), self.age, note);
    }

    /// The numbers of places have another meaning from now on.
    pub(super) fn forget(&mut self) {
        match self.age.checked_add(1) {
            Some(age) => self.age = age,
            None => (self.slots, self.age) = (Vec::new(), 1),
        }
    }

    pub(super) fn bytes(&self) -> u64 {
        (self.slots.capacity() * size_of::<Slot<K>>()) as u64
    }
}
