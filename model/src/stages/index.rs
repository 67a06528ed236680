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

    /// The number of a value, if it has one.
    fn get(&self, value: u64) -> Option<u32> {
        let mask = self.slots.len().checked_sub(1)?;
        let mut at = mix(value) as usize & mask;
        loop {
            match self.slots[at] {
                (_, 0) => return None,
                (old, number) if old == value => return Some(number - 1),
                _ => at = (at + 1) & mask,
            }
        }
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

/// Numbers for pairs of numbers, given once. The pairs of a first number stand in a row, unless rows would have many gaps.
#[derive(Default)]
pub(super) struct Places {
    /// By the first number the begin of its row, and how many it has room for.
    rows: Vec<(u32, u32)>,
    /// Numbers plus one; 0 for nothing.
    slots: Vec<u32>,
    used: usize,
    /// What has no room in a row.
    others: Index,
}

impl Places {
    /// Rows have at least so much room; this many slots for each pair are too many, but for the first ones.
    const LEAST: usize = 16;
    const GAPS: usize = 16;
    const FEW: usize = 1 << 12;

    /// The number of a pair: `fresh` if it is new.
    #[inline]
    pub(super) fn number(&mut self, first: u32, second: u32, fresh: u32) -> u32 {
        if let Some((from, room)) = self.rows.get(first as usize) {
            if second < *room {
                let slot = &mut self.slots[(from + second) as usize];
                if *slot > 0 {
                    return *slot - 1;
                }
            }
        }
        self.other(first, second, fresh)
    }

    /// The number of a pair that stands in no row yet.
    #[cold]
    fn other(&mut self, first: u32, second: u32, fresh: u32) -> u32 {
        if self.rows.len() <= first as usize {
            self.rows.resize(first as usize + 1, (0, 0));
        }
        let (from, room) = self.rows[first as usize];
        let pair = u64::from(first) << 32 | u64::from(second);
        if second >= room {
            let wider = (second as usize + 1).next_power_of_two().max(Self::LEAST);
            if self.slots.len() + wider > (self.used * Self::GAPS).max(Self::FEW) {
                let number = self.others.number(pair, fresh);
                self.used += usize::from(number == fresh);
                return number;
            }
            let begin = self.slots.len();
            self.slots
                .extend_from_within(from as usize..(from + room) as usize);
            self.slots.resize(begin + wider, 0);
            self.rows[first as usize] = (begin as u32, wider as u32);
        }
        // It may have come when there was no room.
        let number = self.others.get(pair).unwrap_or(fresh);
        self.used += usize::from(number == fresh);
        let (from, _) = self.rows[first as usize];
        self.slots[(from + second) as usize] = number + 1;
        number
    }

    pub(super) fn bytes(&self) -> u64 {
        let lists = self.rows.capacity() * size_of::<(u32, u32)>()
            + self.slots.capacity() * size_of::<u32>();
        lists as u64 + self.others.bytes()
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
    fn pairs_keep_their_numbers() {
        let mut places = Places::default();
        let pairs: Vec<(u32, u32)> = (0..40_000u32)
            .map(|n| (n % 300, if n % 7 == 0 { n } else { n / 300 }))
            .collect();
        let mut known = std::collections::HashMap::new();
        for (first, second) in pairs.iter().chain(&pairs) {
            let fresh = known.len() as u32;
            let number = places.number(*first, *second, fresh);
            assert_eq!(number, *known.entry((*first, *second)).or_insert(fresh));
        }
        assert!(places.slots.len() <= Places::FEW.max(places.used * Places::GAPS));
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
