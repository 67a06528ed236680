//! States of a channel by number.
//!
//! A channel with all its monitors has hundreds of fields, but few of their combinations are ever reached. A register gives
//! each state that is met a number: two states have one number exactly if they are equal.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{PoisonError, RwLock};

use stillpoint_monitors::sinumerik::axis::{Exchange, State};

/// The greatest number that the cells have room for; a state beyond it is a fault of the exploration, never an answer.
pub(super) const NUMBERS: i32 = (1 << 20) - 1;

/// A channel between two cycles: its state, and what it has told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Side {
    pub state: State,
    pub told: Exchange,
}

impl Side {
    /// A channel that has told nothing yet.
    pub(super) fn of(state: State) -> Self {
        Self {
            state,
            told: Exchange::default(),
        }
    }

    /// Equal sides have equal keys; the fields that differ most are enough.
    fn key(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        let state = &self.state;
        state.channel.hash(&mut hasher);
        (state.gear, state.agreement, state.reference, state.history).hash(&mut hasher);
        (
            state.compare,
            state.shutdown_test,
            state.forced_check,
            state.told,
        )
            .hash(&mut hasher);
        hasher.finish()
    }
}

#[derive(Default)]
struct Entries {
    sides: Vec<Side>,
    by_key: HashMap<u64, Vec<i32>>,
}

impl Entries {
    fn find(&self, key: u64, side: &Side) -> Option<i32> {
        let numbers = self.by_key.get(&key)?;
        let same = |number: &&i32| usize::try_from(**number).is_ok_and(|k| self.sides[k] == *side);
        numbers.iter().find(same).copied()
    }
}

/// The states met so far.
pub(super) struct Register(RwLock<Entries>);

impl Register {
    pub(super) fn new() -> Self {
        Self(RwLock::default())
    }

    /// The number of a state; a new one, if it has not been met.
    pub(super) fn number(&self, side: Side) -> i32 {
        let key = side.key();
        // Entries are only ever added whole, so they are good after a panic elsewhere, too.
        if let Some(number) = self
            .0
            .read()
            .unwrap_or_else(PoisonError::into_inner)
            .find(key, &side)
        {
            return number;
        }
        let mut entries = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if let Some(number) = entries.find(key, &side) {
            return number;
        }
        let number = i32::try_from(entries.sides.len()).unwrap_or(i32::MAX);
        entries.sides.push(side);
        entries.by_key.entry(key).or_default().push(number);
        number
    }

    /// The state with this number; the first one for a number that none has.
    pub(super) fn side(&self, number: i32) -> Side {
        let entries = self.0.read().unwrap_or_else(PoisonError::into_inner);
        let known = usize::try_from(number)
            .ok()
            .and_then(|k| entries.sides.get(k));
        *known.unwrap_or(&entries.sides[0])
    }
}
