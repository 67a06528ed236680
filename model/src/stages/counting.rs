//! In how many input combinations each rule fired: counted by what has come to the places of the tables.

use super::Staged;
use super::table::Count;
use crate::pack::Key;

impl<K: Key> Staged<'_, K> {
    /// Counts what has come to the places of a group where it comes in the tables that it is made of.
    pub(super) fn count_places(&mut self, table: usize) {
        let (of, group) = self.tables.split_at_mut(table);
        let Some(group) = group.first_mut() else {
            return;
        };
        let whole = group.whole;
        group.take_visits(|visits, counts| {
            for count in counts {
                if let Count::Place(table, place, share) = count {
                    let more = rational(visits, *share, whole);
                    let visits = of[*table as usize].visits(*place);
                    visit(visits, more, self.combinations);
                }
            }
        });
    }

    pub(super) fn drain(&mut self, each: &mut dyn FnMut(usize, u64)) {
        (0..self.groups.len()).for_each(|group| self.settle(group));
        let stages = self.writes.len();
        // What comes to a group comes to tables before its own.
        let groups = stages..self.tables.len();
        groups.rev().for_each(|table| self.count_places(table));
        for table in &mut self.tables[..stages] {
            let whole = table.whole;
            table.take_visits(|visits, counts| {
                for count in counts {
                    if let Count::Rule(rule, share) = count {
                        let count = rational(visits, *share, whole);
                        let count = count.and_then(|count| u64::try_from(count).ok());
                        each(*rule, count.unwrap_or(u64::MAX));
                    }
                }
            });
        }
    }

    /// Adds to the count of each rule in how many input combinations it fired since the last call.
    pub(crate) fn count(&mut self, coverage: &mut [u64]) {
        let mut add = |rule: usize, count: u64| {
            if let Some(sum) = coverage.get_mut(rule) {
                *sum = sum.saturating_add(count);
            }
        };
        std::mem::take(&mut self.fired)
            .into_iter()
            .for_each(|(rule, count)| add(rule, count));
        self.drain(&mut add);
    }
}

/// Counts more input combinations that have come to a place. So many that they do not fit, do not fit the counts of rules either.
#[inline]
pub(super) fn visit(visits: &mut u128, more: Option<u128>, combinations: u128) {
    let sum = more.and_then(|more| visits.checked_add(more));
    *visits = sum.unwrap_or_else(|| u128::MAX / combinations * combinations);
}

/// `share` of `whole` parts of a sum of weights, which is a whole number; none if it is so large that it does not fit.
fn rational(visits: u128, share: u64, whole: u128) -> Option<u128> {
    match visits.checked_mul(u128::from(share)) {
        Some(product) => Some(product / whole),
        None => (visits / whole).checked_mul(u128::from(share)),
    }
}
