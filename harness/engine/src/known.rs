//! What has been explored already: two explorations that agree in all that decides what they find are one.
//!
//! Axes with equal values ask the same of the same tables, and a file in which one value is changed asks mostly what the file asked
//! before. All that decides an outcome is the system with its values, texts included, and how it is explored; its SHA-256 stands for it.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Mutex, PoisonError};

use stillpoint_lang::bind::Bound;

use crate::digest::All;
use crate::outcome::Outcome;

/// Stands for all that decides an outcome.
pub(crate) type Identity = [u8; 32];

/// The outcomes known, by what decides them.
#[derive(Debug, Default)]
pub struct Known {
    found: Mutex<HashMap<Identity, Outcome>>,
}

impl Known {
    /// The outcome of this, if it is known: in no time.
    pub(crate) fn find(&self, identity: &Identity) -> Option<Outcome> {
        let found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        let mut outcome = found.get(identity).cloned()?;
        outcome.report.seconds = 0.0;
        Some(outcome)
    }

    /// Keeps an outcome, unless a limit has decided what it is.
    pub(crate) fn keep(&self, identity: Identity, outcome: &Outcome) {
        if outcome.report.complete {
            let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
            found.insert(identity, outcome.clone());
        }
    }
}

/// What decides the outcome of exploring a system in this way.
pub(crate) fn identity(bound: &Bound, how: &impl Hash) -> Identity {
    let mut all = All::default();
    bound.hash(&mut all);
    how.hash(&mut all);
    all.digest()
}
