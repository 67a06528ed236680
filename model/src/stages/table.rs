//! What is known of a stage, or of several as one: by the values that they read and the class that comes to them, the outcomes.

use super::index::{Index, Places};
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
    pub(super) known: Vec<Known>,
    /// What each outcome adds to the index of the state after, its class, and its share.
    pub(super) outcomes: Vec<(K, u32, u64)>,
    pub(super) counts: Vec<Count>,
    /// The input combinations that have come to each place and are not counted yet.
    pub(super) visits: Vec<u128>,
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

/// What follows from a class and the values of the variables read: ranges of outcomes and of counts. Where there is a fault, no outcome.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) outcomes: (u32, u32),
    pub(super) counts: (u32, u32),
    /// Whether the shares of the outcomes are all there is.
    pub(super) adds_up: bool,
}

impl Known {
    #[inline]
    pub(super) fn outcomes(self) -> Range<usize> {
        self.outcomes.0 as usize..self.outcomes.1 as usize
    }

    pub(super) fn counts(self) -> Range<usize> {
        self.counts.0 as usize..self.counts.1 as usize
    }

    pub(super) fn is_fault(self) -> bool {
        self.outcomes.0 == self.outcomes.1
    }
}

/// What has come to a table since it was judged last, and how much of it was new.
#[derive(Clone, Copy, Default)]
pub(super) struct Traffic {
    pub(super) ways: u64,
    pub(super) fresh: u64,
}

impl<K> Table<K> {
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
            outcomes: Vec::new(),
            counts: Vec::new(),
            visits: Vec::new(),
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

    /// Takes what has been added to the outcomes and the counts since they had these numbers as what follows from the next place; a
    /// fault has none.
    pub(super) fn learn(&mut self, outcomes: usize, counts: usize, fault: bool) {
        if fault {
            self.outcomes.truncate(outcomes);
            self.counts.truncate(counts);
        }
        let shares = self.outcomes[outcomes..]
            .iter()
            .map(|(.., share)| u128::from(*share));
        let adds_up = shares.sum::<u128>() == self.whole;
        self.known.push(Known {
            adds_up,
            outcomes: (outcomes as u32, self.outcomes.len() as u32),
            counts: (counts as u32, self.counts.len() as u32),
        });
        self.visits.push(0);
        self.traffic.fresh += 1;
    }

    pub(super) fn bytes(&self) -> u64 {
        let lists = self.known.capacity() * size_of::<Known>()
            + self.outcomes.capacity() * size_of::<(K, u32, u64)>()
            + self.counts.capacity() * size_of::<Count>()
            + self.visits.capacity() * size_of::<u128>();
        lists as u64 + self.projections.bytes() + self.places.bytes()
    }

    pub(super) fn forget(&mut self) {
        self.projections = Index::default();
        self.places = Places::default();
        self.known = Vec::new();
        self.outcomes = Vec::new();
        self.counts = Vec::new();
        self.visits = Vec::new();
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
            table.learn(from, 0, fault);
            let known = table.known.last().expect("learned");
            assert_eq!((known.is_fault(), known.adds_up), (fault, adds_up));
        }
    }
}
