//! What the cycles of different parts read in common, and which of them agree.

use super::tabulate::{Reads, Rough};
use crate::watch::Watch;
use std::collections::{BTreeMap, BTreeSet};

/// Some inputs with their values, each in bits of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Cube {
    fixed: u128,
    values: u128,
}

impl Cube {
    const FREE: Cube = Cube {
        fixed: 0,
        values: 0,
    };

    fn meet(self, other: Cube) -> Option<Cube> {
        let both = self.fixed & other.fixed;
        ((self.values ^ other.values) & both == 0).then_some(Cube {
            fixed: self.fixed | other.fixed,
            values: self.values | other.values,
        })
    }
}

/// For each group of cycles the cubes of its cycles, over the inputs that other parts read too.
pub(super) type Pattern = Vec<Vec<Cube>>;

/// The combinations of groups with cycles that agree: for each a group of each pattern. None if a limit is reached first.
pub(super) fn agree<'a>(
    patterns: impl Iterator<Item = &'a Pattern>,
    watch: &Watch,
) -> Option<Vec<u32>> {
    let mut found: Vec<(Vec<u32>, Vec<Cube>)> = vec![(Vec::new(), vec![Cube::FREE])];
    for pattern in patterns {
        let mut next = Vec::new();
        for (groups, cubes) in &found {
            if watch.ended() {
                return None;
            }
            for (group, own) in pattern.iter().enumerate() {
                let meets = cubes
                    .iter()
                    .flat_map(|a| own.iter().filter_map(|b| a.meet(*b)));
                let meets: BTreeSet<Cube> = meets.collect();
                if !meets.is_empty() {
                    let groups = groups.iter().copied().chain([group as u32]).collect();
                    next.push((groups, meets.into_iter().collect()));
                }
            }
        }
        found = next;
    }
    Some(found.into_iter().flat_map(|(groups, _)| groups).collect())
}

/// The bits of the inputs that several parts read.
pub(super) struct Shared(BTreeMap<u32, (u32, u32)>);

impl Shared {
    /// None if they need more bits than a cube has.
    pub(super) fn new<'a, K: 'a>(locals: impl Iterator<Item = &'a Rough<K>>) -> Option<Self> {
        let mut readers: BTreeMap<u32, (BTreeSet<usize>, u32)> = BTreeMap::new();
        for local in locals {
            for (input, size, _) in local.reads.iter().flatten().flatten() {
                let (parts, _) = readers.entry(*input).or_insert((BTreeSet::new(), *size));
                parts.insert(local.part);
            }
        }
        let (mut bits, mut place) = (BTreeMap::new(), 0);
        for (input, (parts, size)) in readers {
            if parts.len() > 1 {
                let width = (32 - size.saturating_sub(1).leading_zeros()).max(1);
                bits.insert(input, (place, width));
                place += width;
            }
        }
        (place <= 128).then_some(Shared(bits))
    }

    pub(super) fn pattern(&self, groups: &[Vec<Reads>]) -> Pattern {
        let cubes = |cycles: &Vec<Reads>| -> BTreeSet<Cube> {
            cycles.iter().map(|reads| self.cube(reads)).collect()
        };
        groups
            .iter()
            .map(|cycles| cubes(cycles).into_iter().collect())
            .collect()
    }

    fn cube(&self, reads: &Reads) -> Cube {
        let mut cube = Cube::FREE;
        for (input, _, value) in reads {
            if let Some((place, width)) = self.0.get(input) {
                cube.fixed |= ((1u128 << width) - 1) << place;
                cube.values |= u128::from(*value) << place;
            }
        }
        cube
    }
}
