//! What is known of a stage, or of several as one: by the values that they read and the class that comes to them, the outcomes.

use super::index::{Index, Places};
use crate::pack::Key;
use crate::system::Domain;
use std::ops::Range;

/// A table of outcomes.
pub(super) struct Table<K> {
    /// The variables it reads: number, least value, stride in the number of their values together.
    reads: Vec<(usize, i32, u64)>,
    /// The parts in which shares are counted.
    pub(super) whole: u128,
    /// The values of the variables it reads, numbered.
    projections: Index,
    /// By such a number and a class the place of what follows.
    places: Places,
    known: Vec<Known<K>>,
    /// Where a place has several outcomes, or a fault: their range, and whether their shares are all there is.
    lists: Vec<(Range<u32>, bool)>,
    /// What each outcome adds to the index of the state after, its class, and its share.
    pub(super) outcomes: Vec<(K, u32, u64)>,
    /// What is counted at each place, and where that ends.
    pub(super) counts: Vec<Count>,
    counted: Vec<u32>,
    pub(super) merges: Merges,
    pub(super) traffic: Traffic,
}

/// What is counted where something comes to a place.
#[derive(Clone, Copy)]
pub(super) enum Count {
    /// A rule that fired, with its share.
    Rule(usize, u64),
    /// A place of a table before this one, with its share.
    Place(u32, u32, u64),
}

/// What is known of a place. A state looks up many of them, so that what is needed stands in one piece of memory.
struct Known<K> {
    /// What the only outcome adds, and its class.
    only: (K, u32),
    /// The number of the list of outcomes plus one; 0 where there is an only one.
    list: u32,
    /// The input combinations that have come to it and are not counted yet.
    visits: u128,
}

/// What follows from a class and the values of the variables read.
#[derive(Clone, Copy)]
pub(super) enum Follows<'a, K> {
    /// This, whatever the inputs are.
    One(K, u32),
    /// One of these; if there is none, a fault.
    Of(&'a [(K, u32, u64)]),
}

impl<K> Follows<'_, K> {
    #[inline]
    pub(super) fn is_fault(&self) -> bool {
        matches!(self, Follows::Of([]))
    }
}

/// What has come to a table since it was judged last, and how much of it was new.
#[derive(Clone, Copy, Default)]
pub(super) struct Traffic {
    pub(super) ways: u64,
    pub(super) fresh: u64,
}

impl<K: Key> Table<K> {
    /// None if the values that it reads have no number together.
    pub(super) fn new(
        reads: impl IntoIterator<Item = usize>,
        whole: u128,
        domains: &[Domain],
    ) -> Option<Self> {
        let mut stride = 1u64;
        let mut list = Vec::new();
        for variable in reads {
            let domain = domains.get(variable)?;
            list.push((variable, domain.lo, stride));
            stride = stride.checked_mul(domain.size()).filter(|s| *s < 1 << 63)?;
        }
        Some(Table {
            reads: list,
            whole,
            projections: Index::default(),
            places: Places::default(),
            known: Vec::new(),
            lists: Vec::new(),
            outcomes: Vec::new(),
            counts: Vec::new(),
            counted: Vec::new(),
            merges: Merges::default(),
            traffic: Traffic::default(),
        })
    }

    /// The variables it reads.
    pub(super) fn reads(&self) -> impl Iterator<Item = usize> + '_ {
        self.reads.iter().map(|(variable, _, _)| *variable)
    }

    /// The number of the values of the variables that it reads.
    #[inline]
    pub(super) fn projection(&mut self, before: &[i32]) -> u32 {
        let mut all = 0;
        for (variable, lo, stride) in &self.reads {
            all += u64::from((before[*variable] as u32).wrapping_sub(*lo as u32)) * stride;
        }
        let fresh = self.projections.len();
        self.projections.number(all, fresh)
    }

    /// The place of what follows; the next one where nothing is known.
    #[inline]
    pub(super) fn place(&mut self, projection: u32, class: u32) -> (u32, bool) {
        let fresh = self.known.len() as u32;
        let place = self.places.number(projection, class, fresh);
        (place, place == fresh)
    }

    /// What follows from a place.
    #[inline]
    pub(super) fn follows(&self, place: u32) -> Follows<'_, K> {
        let Known {
            only: (own, class),
            list,
            ..
        } = self.known[place as usize];
        match list.checked_sub(1) {
            None => Follows::One(own, class),
            Some(list) => {
                let (range, _) = &self.lists[list as usize];
                Follows::Of(&self.outcomes[range.start as usize..range.end as usize])
            }
        }
    }

    /// Whether the shares of what follows from a place are all there is.
    #[inline]
    pub(super) fn adds_up(&self, place: u32) -> bool {
        let list = self.known[place as usize].list.checked_sub(1);
        list.is_none_or(|list| self.lists[list as usize].1)
    }

    /// The input combinations that have come to a place.
    #[inline]
    pub(super) fn visits(&mut self, place: u32) -> &mut u128 {
        &mut self.known[place as usize].visits
    }

    /// Takes the input combinations that have come to each place, with what is counted there.
    pub(super) fn take_visits(&mut self, mut each: impl FnMut(u128, &[Count])) {
        let mut from = 0;
        for (known, end) in self.known.iter_mut().zip(&self.counted) {
            let visits = std::mem::take(&mut known.visits);
            if visits > 0 {
                each(visits, &self.counts[from as usize..*end as usize]);
            }
            from = *end;
        }
    }

    /// Takes what has been added to the outcomes since they had this number, and to the counts, as what follows from the next place; a
    /// fault has none.
    pub(super) fn learn(&mut self, outcomes: usize, fault: bool) {
        if fault {
            self.outcomes.truncate(outcomes);
            let counts = self.counted.last().map_or(0, |end| *end as usize);
            self.counts.truncate(counts);
        }
        let only = match self.outcomes[outcomes..] {
            [(own, class, share)] if u128::from(share) == self.whole => Some((own, class)),
            _ => None,
        };
        if only.is_some() {
            self.outcomes.truncate(outcomes);
        } else {
            let shares = self.outcomes[outcomes..].iter();
            let shares = shares.map(|(.., share)| u128::from(*share));
            let adds_up = shares.sum::<u128>() == self.whole;
            let range = outcomes as u32..self.outcomes.len() as u32;
            self.lists.push((range, adds_up));
        }
        self.known.push(Known {
            only: only.unwrap_or((K::of([0, 0]), 0)),
            list: only.map_or(self.lists.len() as u32, |_| 0),
            visits: 0,
        });
        self.counted.push(self.counts.len() as u32);
        self.traffic.fresh += 1;
    }

    pub(super) fn bytes(&self) -> u64 {
        let lists = self.known.capacity() * size_of::<Known<K>>()
            + self.lists.capacity() * size_of::<(Range<u32>, bool)>()
            + self.outcomes.capacity() * size_of::<(K, u32, u64)>()
            + self.counts.capacity() * size_of::<Count>()
            + self.counted.capacity() * size_of::<u32>();
        lists as u64 + self.projections.bytes() + self.places.bytes()
    }

    pub(super) fn forget(&mut self) {
        self.projections = Index::default();
        self.places = Places::default();
        self.known = Vec::new();
        self.lists = Vec::new();
        self.outcomes = Vec::new();
        self.counts = Vec::new();
        self.counted = Vec::new();
    }
}

/// Whether ways that have become one behind a table are looked for: where hardly any do, it costs more than it saves. The last table
/// always does.
#[derive(Clone, Copy, Default)]
pub(super) struct Merges {
    rare: bool,
    states: u32,
    made: usize,
    left: usize,
}

impl Merges {
    /// The ways made until it is judged anew, the share of them that is worth it, and the states of which one is looked at all the same.
    const JUDGED: usize = 4096;
    const WORTH: usize = 16;
    const SAMPLE: u32 = 64;

    /// Looks at other states than a table before it.
    pub(super) fn shift(&mut self, by: usize) {
        self.states = self.states.wrapping_add(by as u32 * 7);
    }

    /// Whether this state is looked at.
    #[inline]
    pub(super) fn begin(&mut self) -> bool {
        self.states = self.states.wrapping_add(1);
        !self.rare || self.states % Self::SAMPLE == 0
    }

    /// What became of the ways.
    pub(super) fn end(&mut self, made: usize, left: usize) {
        self.made += made;
        self.left += left;
        if self.made >= Self::JUDGED {
            self.rare = (self.made - self.left) * Self::WORTH < self.made;
            (self.made, self.left) = (0, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_that_is_missing_is_noticed() {
        let mut table = Table::<u64>::new([], 8, &[]).expect("numbers that fit");
        for (shares, fault, adds_up) in [
            (&[5, 3][..], false, true),
            (&[5, 2], false, false),
            (&[8], true, false),
        ] {
            let from = table.outcomes.len();
            let outcomes = shares.iter().zip(0..).map(|(share, n)| (n, 0, *share));
            table.outcomes.extend(outcomes);
            let place = table.known.len() as u32;
            table.learn(from, fault);
            let known = (table.follows(place).is_fault(), table.adds_up(place));
            assert_eq!(known, (fault, adds_up));
        }
    }
}
