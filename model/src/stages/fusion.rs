//! Which stages are looked up as one: where the same comes again and again, one table spares the ways between them.
//!
//! Nobody knows beforehand which stages these are. So two neighbours are taken together for some states, those first between which
//! most ways go, and stay together if little of what came was new. At last the first stages are: what they make of a state depends on
//! the variables alone that they read, and spares all ways between them. It decides how long an exploration takes, and nothing else.

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

/// One of so many states, of those for which the first stages are looked up, may be new to them. While more are, each part of their trial is twice as long as the one before,
/// and the share of what is new falls by one of so many at least.
const NEW: u64 = 2;
const FALLS: u64 = 100;

/// What is changed, by the number of a group.
pub(super) enum Change {
    /// It and the one behind it become one.
    Fuse(usize),
    /// It becomes the two that it was before.
    Split(usize),
}

pub(super) struct Fusion {
    /// Whether a stage may be in one group with the one behind it.
    open: Vec<bool>,
    states: u32,
    due: u32,
    /// The first stages are tried: what came in the part of the trial before this one.
    trial: Option<Traffic>,
    /// No further stage is tried with the first ones.
    whole: bool,
}

impl Fusion {
    pub(super) fn new(stages: usize) -> Self {
        Fusion {
            open: vec![true; stages.saturating_sub(1)],
            states: 0,
            due: TRIAL,
            trial: None,
            whole: false,
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

    /// These stages and the one behind them are not tried together again.
    pub(super) fn close(&mut self, stages: &Range<usize>) {
        if let Some(open) = self.open.get_mut(stages.end - 1) {
            *open = false;
        }
        self.whole |= stages.start == 0;
        self.trial = None;
    }

    /// What to change, from the groups with what has come to them. `room`: tables of groups may still grow.
    pub(super) fn next(
        &mut self,
        groups: &[(Range<usize>, Traffic)],
        room: bool,
    ) -> Option<Change> {
        self.states = 0;
        if groups[0].0.len() > 1 && !self.keeps(groups[0].1, room) {
            self.due = TRIAL;
            return Some(Change::Split(0));
        }
        if self.trial.is_some() {
            self.due *= 2;
            return None;
        }
        if let Some(change) = self.behind(groups, room) {
            self.due = TRIAL;
            return Some(change);
        }
        // The last table stays by itself: what follows behind it comes in bursts.
        if room && !self.whole && groups.len() > 2 {
            self.trial = Some(Traffic { ways: 1, fresh: 2 });
            self.due = TRIAL;
            return Some(Change::Fuse(0));
        }
        self.due = LATER;
        None
    }

    /// Whether the first stages stay together.
    fn keeps(&mut self, traffic: Traffic, room: bool) -> bool {
        if traffic.fresh * NEW <= traffic.ways {
            self.trial = None;
            return room;
        }
        let falls = |before: Traffic| {
            traffic.fresh * before.ways * FALLS <= before.fresh * traffic.ways * (FALLS - 1)
        };
        room && self.due < LATER && self.trial.replace(traffic).is_some_and(falls)
    }

    /// What to change behind the first group.
    fn behind(&self, groups: &[(Range<usize>, Traffic)], room: bool) -> Option<Change> {
        // What has come to it is mostly new, or there is no room for it.
        let bad = |(stages, traffic): &(Range<usize>, Traffic)| {
            stages.len() > 1 && (!room || traffic.fresh * REUSE > traffic.ways)
        };
        if let Some(number) = (1..groups.len()).find(|number| bad(&groups[*number])) {
            return Some(Change::Split(number));
        }
        let open = |number: &usize| {
            let (before, behind) = (&groups[*number].0, &groups[*number + 1].1);
            room && self.open[before.end - 1] && behind.ways >= FEW
        };
        let between = (1..groups.len() - 1).filter(open);
        let most = between.max_by_key(|number| groups[*number + 1].1.ways);
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
        // Hardly anything goes between them, and the last one stays by itself.
        let few = seen(&[(0..1, 256, 9), (1..4, 300, 9)]);
        assert!(fusion.next(&few, true).is_none());
        assert_eq!(fusion.due, LATER);
    }

    #[test]
    fn the_first_stages_are_tried_last_and_as_long_as_less_and_less_is_new() {
        let trial = |parts: &[u64]| {
            let mut fusion = Fusion::new(4);
            let begin = seen(&[
                (0..1, 256, 9),
                (1..2, 300, 9),
                (2..3, 300, 9),
                (3..4, 300, 9),
            ]);
            assert!(matches!(fusion.next(&begin, true), Some(Change::Fuse(0))));
            let mut change = None;
            for fresh in parts {
                assert!(change.is_none());
                let ways = u64::from(fusion.due);
                let groups = seen(&[
                    (0..2, ways, ways * fresh / 1000),
                    (2..3, 300, 9),
                    (3..4, 300, 9),
                ]);
                change = fusion.next(&groups, true);
            }
            change
        };
        // Few are new: another one is tried with them.
        assert!(matches!(trial(&[300]), Some(Change::Fuse(0))));
        assert!(matches!(
            trial(&[990, 900, 700, 450]),
            Some(Change::Fuse(0))
        ));
        // All are new, again and again, or at last still too many.
        assert!(matches!(trial(&[1000, 1000]), Some(Change::Split(0))));
        let slow = [1000, 950, 900, 850, 800, 750];
        assert!(matches!(trial(&slow), Some(Change::Split(0))));
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
        fusion.close(&(1..2));
        // What is left to try are the first stages, but only two are there.
        let apart = seen(&[(0..2, 256, 9), (2..3, 8000, 9)]);
        assert!(fusion.next(&apart, true).is_none());
        let known = seen(&[(0..1, 256, 9), (1..3, 8000, 1000)]);
        assert!(fusion.next(&known, true).is_none());
        // Without room nothing is taken together, and what is together is taken apart.
        assert!(matches!(fusion.next(&known, false), Some(Change::Split(1))));
        assert!(matches!(fusion.next(&apart, false), Some(Change::Split(0))));
    }
}
