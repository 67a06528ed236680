//! Ways through stages.

use super::index::Merge;
use super::table::Follows;
use crate::pack::Key;

/// A way through some stages: the index of the state so far, the class, the input combinations.
#[derive(Clone, Copy)]
pub(super) struct Way<K> {
    pub(super) key: K,
    pub(super) class: u32,
    pub(super) weight: u128,
}

impl<K: Key> Way<K> {
    pub(super) fn begin(class: u32, weight: u128) -> Self {
        let key = K::of([0, 0]);
        Way { key, class, weight }
    }
}

/// The ways that follow from one, added to a list; those that are one are made one if they are looked for.
#[inline]
pub(super) fn follow<K: Key>(
    way: Way<K>,
    follows: Follows<K>,
    whole: u128,
    next: &mut Vec<Way<K>>,
    mut merge: Option<&mut Merge>,
) {
    let mut add = |own: K, class: u32, weight: u128| {
        let key = way.key.plus(own);
        if let Some(merge) = merge.as_deref_mut() {
            let hash = key.hash() ^ u64::from(class).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let same = |at: usize| next[at].key == key && next[at].class == class;
            if let Some(at) = merge.find(hash, next.len(), same) {
                next[at].weight += weight;
                return;
            }
        }
        next.push(Way { key, class, weight });
    };
    match follows {
        Follows::One(own, class) => add(own, class, way.weight),
        Follows::Of(outcomes) => {
            for (own, class, share) in outcomes {
                add(*own, *class, part_of(way.weight, *share, whole));
            }
        }
    }
}

/// `share` of `whole` parts of a weight, which is a whole number.
#[inline]
fn part_of(weight: u128, share: u64, whole: u128) -> u128 {
    if u128::from(share) == whole {
        return weight;
    }
    if weight == whole {
        return u128::from(share);
    }
    match (u64::try_from(weight), u64::try_from(whole)) {
        (Ok(weight), Ok(whole)) => match weight.checked_mul(share) {
            Some(product) => u128::from(product / whole),
            None => u128::from(weight) * u128::from(share) / u128::from(whole),
        },
        _ => weight * u128::from(share) / whole,
    }
}
