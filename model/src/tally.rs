//! What a search counts and notes.

use crate::pack::Key;
use crate::set::Set;
use std::collections::BTreeMap;

/// The first places, in the order (depth, state), at which something about a property showed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Signs<K> {
    pub(crate) first: Option<(u32, K)>,
    pub(crate) bad: Option<(u32, K)>,
    /// Whether some cycle started a response and ended it at once.
    pub(crate) met: bool,
}

/// What a search counted and noted.
#[derive(Clone)]
pub(crate) struct Tally<K> {
    pub(crate) states: u64,
    pub(crate) transitions: u128,
    /// Of all leaves, modulo 2^128; must be the declared combinations for each state explored.
    pub(crate) weights: u128,
    pub(crate) explored: u64,
    pub(crate) depth: u32,
    /// Every reachable state was explored.
    pub(crate) complete: bool,
    pub(crate) signs: Vec<Signs<K>>,
    /// By code: the first place.
    pub(crate) faults: BTreeMap<u32, (u32, K)>,
    pub(crate) coverage: Vec<u64>,
    pub(crate) absorbing: u64,
    pub(crate) examples: Vec<K>,
    /// Bytes in which the states are stored.
    pub(crate) stored: u64,
}

impl<K: Key> Tally<K> {
    /// Nothing yet, for so many properties and rules.
    pub(crate) fn new(properties: usize, rules: usize) -> Self {
        let none = Signs {
            first: None,
            bad: None,
            met: false,
        };
        Tally {
            states: 0,
            transitions: 0,
            weights: 0,
            explored: 0,
            depth: 0,
            complete: false,
            signs: vec![none; properties],
            faults: BTreeMap::new(),
            coverage: vec![0; rules],
            absorbing: 0,
            examples: Vec::new(),
            stored: 0,
        }
    }
}

/// What a search found.
pub(crate) struct Found<K> {
    pub(crate) tally: Tally<K>,
    /// For each property the states in which a duty that just began is pending.
    pub(crate) pending: Vec<Set<K>>,
    /// The most bytes held.
    pub(crate) bytes: u64,
    /// Whether a checkpoint of the end was written.
    pub(crate) resumable: bool,
}
