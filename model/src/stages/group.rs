//! Stages next to each other that are looked up as one. What is not known of them is made from what is known of their two parts.

use super::Staged;
use super::fusion::Change;
use super::prefix::Prefix;
use super::table::{Count, Table, Traffic};
use super::ways::{Way, follow};
use crate::pack::Key;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

/// Of what may be held, the part that tables of groups may.
const SHARE_OF_GROUPS: u64 = 2;

/// Stages next to each other, with one table.
#[derive(Clone)]
pub(super) struct Group {
    pub(super) table: usize,
    pub(super) stages: Range<usize>,
    /// The two groups that it was before; none if it is one stage.
    parts: Option<Arc<[Group; 2]>>,
}

impl Group {
    pub(super) fn single(stage: usize) -> Self {
        Group {
            table: stage,
            stages: stage..stage + 1,
            parts: None,
        }
    }
}

impl<K: Key> Staged<'_, K> {
    /// Makes what follows from a class that comes to a group, for the next place of its table.
    pub(super) fn learn_of(&mut self, group: &Group, class: u32) {
        match &group.parts {
            None => self.learn_stage(group.table, class),
            Some(parts) => {
                self.learn_parts(group.table, parts, class);
                self.fusion.learned(self.tables[group.table].traffic);
            }
        }
    }

    /// The place of what follows from a class that comes to a part of a group.
    fn place_of(&mut self, part: &Group, projection: u32, class: u32) -> u32 {
        let (place, fresh) = self.tables[part.table].place(projection, class);
        if fresh {
            self.learn_of(part, class);
        }
        place
    }

    /// Goes through the parts of a group.
    fn learn_parts(&mut self, table: usize, parts: &[Group; 2], class: u32) {
        let (mut ways, mut next, mut merge) = self.inner.pop().unwrap_or_default();
        let own = &self.tables[table];
        let (from, whole) = (own.outcomes.len(), own.whole);
        let mut fault = false;
        ways.clear();
        ways.push(Way::begin(class, whole));
        'parts: for part in parts {
            let projection = self.tables[part.table].projection(&self.opened.state);
            next.clear();
            merge.start();
            for way in &ways {
                let place = self.place_of(part, projection, way.class);
                let of = &self.tables[part.table];
                let follows = of.follows(place);
                if follows.is_fault() {
                    fault = true;
                    break 'parts;
                }
                follow(*way, follows, of.whole, &mut next, Some(&mut merge));
                // The weights are parts of the whole, which is one of 64 bits.
                let count = Count::Place(part.table as u32, place, way.weight as u64);
                self.tables[table].counts.push(count);
            }
            std::mem::swap(&mut ways, &mut next);
        }
        let outcomes = ways
            .iter()
            .map(|way| (way.key, way.class, way.weight as u64));
        let own = &mut self.tables[table];
        own.outcomes.extend(outcomes);
        own.learn(from, fault);
        self.inner.push((ways, next, merge));
    }

    /// Has more stages, or fewer, looked up as one.
    #[cold]
    pub(super) fn fuse(&mut self) {
        let traffic = |group: &Group| self.tables[group.table].traffic;
        let seen: Vec<_> = self
            .groups
            .iter()
            .map(|g| (g.stages.clone(), traffic(g)))
            .collect();
        let bytes = self.tables[self.writes.len()..]
            .iter()
            .map(Table::bytes)
            .sum::<u64>();
        let room = bytes < self.most / SHARE_OF_GROUPS;
        let last = self.groups[self.groups.len() - 1].table;
        let change = self.fusion.next(&seen, room);
        if change.is_some() {
            self.forget_prefixes();
        }
        match change {
            Some(Change::Fuse(group)) => {
                let parts = [self.groups[group].clone(), self.groups[group + 1].clone()];
                match self.table(&parts) {
                    Some(mut table) => {
                        table.merges.shift(group);
                        self.tables.push(table);
                        let fused = Group {
                            table: self.tables.len() - 1,
                            stages: parts[0].stages.start..parts[1].stages.end,
                            parts: Some(Arc::new(parts)),
                        };
                        self.groups.splice(group..group + 2, [fused]);
                    }
                    None => self.fusion.close(&parts[0].stages),
                }
            }
            Some(Change::Split(number)) => {
                let group = self.groups[number].clone();
                if let Some(parts) = group.parts {
                    self.fusion.close(&parts[0].stages);
                    self.count_places(group.table);
                    self.tables[group.table].forget();
                    self.groups
                        .splice(number..number + 1, parts.iter().cloned());
                }
            }
            None => {}
        }
        self.prefixes
            .resize_with(self.groups.len(), Prefix::default);
        self.note_readers();
        for table in &mut self.tables {
            table.traffic = Traffic::default();
        }
        // Places of the last table are what bursts are told apart by.
        if self.groups[self.groups.len() - 1].table != last {
            self.seen.forget();
        }
        self.grown = true;
    }

    /// A table for two groups together; none if numbers do not fit.
    fn table(&self, parts: &[Group; 2]) -> Option<Table<K>> {
        let tables = || parts.iter().map(|part| &self.tables[part.table]);
        // To the first stage comes one way only, with all combinations.
        let whole = match parts[0].stages.start {
            0 => self.combinations,
            _ => tables().try_fold(1, |all: u128, t| all.checked_mul(t.whole))?,
        };
        self.combinations
            .checked_mul(u128::from(u64::try_from(whole).ok()?))?;
        let reads: BTreeSet<usize> = tables().flat_map(Table::reads).collect();
        Table::new(reads, whole, self.domains)
    }
}
