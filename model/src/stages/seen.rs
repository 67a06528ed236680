//! Which bursts were handed on already: a burst is what follows from one way behind the last table, a state so far with a place there.
//! Many states share theirs, and a state after a cycle has to be stored once.

use crate::pack::Key;

/// The most bursts that are remembered: so few that looking one up costs less than what follows from it.
const MOST: usize = 1 << 14;

/// Of what may be held, the part that they may.
const SHARE: u64 = 16;

/// A burst, the age in which it was handed on, and the conditions that hold in some of its cycles.
type Slot<K> = ((K, u32), u32, u128);

/// Some of the bursts handed on, those that came last.
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
    fn slot(&self, (state, place): (K, u32)) -> usize {
        let hash = state.hash() ^ u64::from(place).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (hash.wrapping_mul(0xd6e8_feb8_6659_fd93) >> 32) as usize & (self.room - 1)
    }

    /// The conditions that hold in some of the cycles of a burst that was handed on.
    #[inline]
    pub(super) fn marks(&self, burst: (K, u32)) -> Option<u128> {
        let (of, age, marks) = self.slots.get(self.slot(burst))?;
        (*age == self.age && *of == burst).then_some(*marks)
    }

    /// A burst is handed on.
    #[inline]
    pub(super) fn add(&mut self, burst: (K, u32), marks: u128) {
        if self.slots.is_empty() {
            self.slots = vec![((K::of([0, 0]), 0), 0, 0); self.room];
        }
        let slot = self.slot(burst);
        self.slots[slot] = (burst, self.age, marks);
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
