//! Hash tables of the stages: numbers for 64-bit values, and the ways that are one.

/// Numbers for values, given once. Open addressing with linear probing.
#[derive(Default)]
pub(super) struct Index {
    /// A value and its number plus one; 0 for nothing.
    slots: Vec<(u64, u32)>,
    used: u32,
}

#[inline]
fn mix(value: u64) -> u64 {
    let a = (value ^ (value >> 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    a ^ (a >> 29)
}

impl Index {
    /// The number of a value: `fresh` if it is new.
    #[inline]
    pub(super) fn number(&mut self, value: u64, fresh: u32) -> u32 {
        if self.used as usize * 2 >= self.slots.len() {
            self.grow();
        }
        let mask = self.slots.len() - 1;
        let mut at = mix(value) as usize & mask;
        loop {
            match self.slots[at] {
                (_, 0) => break,
                (old, number) if old == value => return number - 1,
                _ => at = (at + 1) & mask,
            }
        }
        self.slots[at] = (value, fresh + 1);
        self.used += 1;
        fresh
    }

    #[cold]
    fn grow(&mut self) {
        let old = std::mem::take(&mut self.slots);
        self.slots = vec![(0, 0); (old.len() * 2).max(64)];
        let mask = self.slots.len() - 1;
        for (value, number) in old.into_iter().filter(|(_, number)| *number > 0) {
            let mut at = mix(value) as usize & mask;
            while self.slots[at].1 > 0 {
                at = (at + 1) & mask;
            }
            self.slots[at] = (value, number);
        }
    }

    /// How many values have a number.
    pub(super) fn len(&self) -> u32 {
        self.used
    }

    pub(super) fn bytes(&self) -> u64 {
        (self.slots.capacity() * size_of::<(u64, u32)>()) as u64
    }
}

/// The places of a list by hash, for a short time: each start forgets them.
#[derive(Default)]
pub(super) struct Merge {
    /// A start, and a place in the list.
    slots: Vec<(u32, u32)>,
    /// The places of the list with their hashes, to make the table larger.
    hashes: Vec<u64>,
    starts: u32,
}

impl Merge {
    pub(super) fn start(&mut self) {
        self.hashes.clear();
        self.starts = self.starts.wrapping_add(1);
        if self.starts == 0 {
            self.slots.fill((0, 0));
            self.starts = 1;
        }
    }

    /// The place that is the same; if there is none, the next place (`len`) stands for this hash from now on.
    #[inline]
    pub(super) fn find(
        &mut self,
        hash: u64,
        len: usize,
        same: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        if self.hashes.len() * 2 >= self.slots.len() {
            self.grow();
        }
        let mask = self.slots.len() - 1;
        let mut at = mix(hash) as usize & mask;
        while self.slots[at].0 == self.starts {
            let place = self.slots[at].1 as usize;
            if self.hashes[place] == hash && same(place) {
                return Some(place);
            }
            at = (at + 1) & mask;
        }
        self.slots[at] = (self.starts, len as u32);
        self.hashes.push(hash);
        None
    }

    #[cold]
    fn grow(&mut self) {
        self.slots = vec![(0, 0); (self.slots.len() * 2).max(256)];
        let mask = self.slots.len() - 1;
        for (place, hash) in self.hashes.iter().enumerate() {
            let mut at = mix(*hash) as usize & mask;
            while self.slots[at].0 == self.starts {
                at = (at + 1) & mask;
            }
            self.slots[at] = (self.starts, place as u32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_their_numbers() {
        let mut index = Index::default();
        for round in 0..2 {
            for n in 0..5000u64 {
                let fresh = index.len();
                let number = index.number(n.wrapping_mul(n) << 20, fresh);
                assert_eq!(u64::from(number), n, "round {round}");
            }
        }
        assert_eq!(index.len(), 5000);
    }

    #[test]
    fn what_is_the_same_is_found_until_the_next_start() {
        let mut merge = Merge::default();
        for start in 0..3u64 {
            let mut list: Vec<u64> = Vec::new();
            merge.start();
            for n in 0..3000u64 {
                let value = n % 1000 + start;
                // Many values share a hash.
                let found = merge.find(value % 500, list.len(), |at| list[at] == value);
                match found {
                    Some(at) => assert_eq!(list[at], value),
                    None => list.push(value),
                }
            }
            assert_eq!(list, (start..1000 + start).collect::<Vec<_>>());
        }
    }
}
