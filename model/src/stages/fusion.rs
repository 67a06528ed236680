//! Which stages are looked up as one: where the same comes again and again, one table spares the ways between them.
//!
//! Nobody knows beforehand which stages these are. So two neighbours are taken together for some states, those first between which
//! most ways go, and stay together if little of what came was new. It decides how long an exploration takes, and nothing else.

use super::table::Traffic;
use std::ops::Range;

/// States between two changes, while there are some to be tried, and afterwards.
const TRIAL: u32 = 256;
const LATER: u32 = 8192;

/// One of so many ways may be new to a group.
const REUSE: u64 = 8;

/// So much that is new to one group is a reason to look at it before its time.
const MUCH: u64 = 1 << 14;

/// Fewer ways than these in a trial are not worth it.
const FEW: u64 = 2 * TRIAL as u64;

/// What is changed, by the number of a group.
pub(super) enum Change {
    /// It and the one behind it become one.
    Fuse(usize),
    /// Its stages are looked up one by one.
    Split(usize),
}

pub(super) struct Fusion {
    /// Whether a stage may be in one group with the one behind it.
    open: Vec<bool>,
    states: u32,
    due: u32,
}

impl Fusion {
    pub(super) fn new(stages: usize) -> Self {
        Fusion {
            open: vec![true; stages.saturating_sub(1)],
            states: 0,
            due: TRIAL,
        }
    }

    /// Counts a state; whether it is time for a change.
    #[inline]
    pub(super) fn is_due(&mut self) -> bool {
        self.states += 1;
        self.states >= self.due
    }

    /// Looks at the groups after this state already, where one of them learns so much.
    pub(super) fn learned(&mut self, traffic: Traffic) {
        if traffic.fresh >= MUCH {
            self.states = self.due;
        }
    }

    /// The stages of a group that does not come about are not tried together again.
    pub(super) fn close(&mut self, stages: Range<usize>) {
        if let Some(open) = self.open.get_mut(stages.start..stages.end - 1) {
            open.fill(false);
        }
    }

    /// What to change, from the groups with what has come to them. `room`: tables of groups may still grow.
    pub(super) fn next(
        &mut self,
        groups: &[(Range<usize>, Traffic)],
        room: bool,
    ) -> Option<Change> {
        self.states = 0;
        let fused = |group: &&(usize, &(Range<usize>, Traffic))| group.1.0.len() > 1;
        let numbered = || groups.iter().enumerate();
        // What has come to it is mostly new, or there is no room for it.
        let bad = numbered()
            .filter(|g| fused(&g))
            .find(|(_, (_, traffic))| !room || traffic.fresh * REUSE > traffic.ways);
        if let Some((number, (stages, _))) = bad {
            self.close(stages.clone());
            return Some(Change::Split(number));
        }
        let open = |number: &usize| {
            let (before, behind) = (&groups[*number].0, &groups[*number + 1].1);
            room && self.open[before.end - 1] && behind.ways >= FEW
        };
        let between = (0..groups.len() - 1).filter(open);
        let most = between.max_by_key(|number| groups[*number + 1].1.ways);
        self.due = match most {
            Some(_) => TRIAL,
            None => LATER,
        };
        most.map(Change::Fuse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(groups: &[(Range<usize>, u64, u64)]) -> Vec<(Range<usize>, Traffic)> {
        let one = |(stages, ways, fresh): &(Range<usize>, u64, u64)| {
            let traffic = Traffic {
                ways: *ways,
                fresh: *fresh,
            };
            (stages.clone(), traffic)
        };
        groups.iter().map(one).collect()
    }

    #[test]
    fn stages_with_the_most_ways_between_them_are_tried_first() {
        let mut fusion = Fusion::new(4);
        let all = seen(&[
            (0..1, 256, 9),
            (1..2, 700, 9),
            (2..3, 9000, 9),
            (3..4, 600, 9),
        ]);
        assert!(matches!(fusion.next(&all, true), Some(Change::Fuse(1))));
        assert_eq!(fusion.due, TRIAL);
        // Hardly anything goes between them.
        let few = seen(&[(0..1, 256, 9), (1..4, 300, 9)]);
        assert!(fusion.next(&few, true).is_none());
        assert_eq!(fusion.due, LATER);
    }

    #[test]
    fn what_learns_much_is_looked_at_soon() {
        let mut fusion = Fusion::new(3);
        let traffic = |fresh| Traffic { ways: 0, fresh };
        fusion.learned(traffic(MUCH - 1));
        assert!(!fusion.is_due());
        fusion.learned(traffic(MUCH));
        assert!(fusion.is_due());
    }

    #[test]
    fn what_is_mostly_new_is_taken_apart_and_not_tried_again() {
        let mut fusion = Fusion::new(3);
        let new = seen(&[(0..1, 256, 9), (1..3, 8000, 1001)]);
        assert!(matches!(fusion.next(&new, true), Some(Change::Split(1))));
        let apart = seen(&[(0..1, 256, 9), (1..2, 700, 9), (2..3, 8000, 9)]);
        assert!(matches!(fusion.next(&apart, true), Some(Change::Fuse(0))));
        let known = seen(&[(0..2, 8000, 1000), (2..3, 8000, 9)]);
        assert!(fusion.next(&known, true).is_none());
        // Without room nothing is taken together, and what is together is taken apart.
        assert!(matches!(fusion.next(&known, false), Some(Change::Split(0))));
    }
}
