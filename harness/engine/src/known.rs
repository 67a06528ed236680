//! What has been explored already: two explorations that agree in all that decides what they find are one.
//!
//! Axes with equal values ask the same of the same tables, and a file in which one value is changed asks mostly what the file asked
//! before. All that decides an outcome is the system with its values, texts included, and how it is explored; its SHA-256 stands for it.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Condvar, Mutex, PoisonError};

use stillpoint_lang::bind::Bound;

use crate::digest::All;
use crate::outcome::Outcome;

/// Stands for all that decides an outcome.
pub(crate) type Identity = [u8; 32];

/// The outcomes known, by what decides them.
#[derive(Debug, Default)]
pub struct Known {
    /// None: somebody explores it.
    found: Mutex<HashMap<Identity, Option<Outcome>>>,
    ended: Condvar,
}

/// What is known of an exploration.
pub(crate) enum Claim<'a> {
    /// Its outcome, in no time.
    Known(Box<Outcome>),
    /// Nothing: who asks explores it.
    Free(Free<'a>),
}

/// The right to explore something, which others wait for. Nothing is known of it if no outcome is kept.
pub(crate) struct Free<'a> {
    known: &'a Known,
    identity: Identity,
}

impl Known {
    /// The outcome of this, if it is known; if somebody explores it, once that has ended.
    pub(crate) fn claim(&self, identity: Identity) -> Claim<'_> {
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            match found.get(&identity) {
                Some(Some(outcome)) => {
                    let mut outcome = outcome.clone();
                    outcome.report.seconds = 0.0;
                    return Claim::Known(Box::new(outcome));
                }
                Some(None) => {
                    let woken = self.ended.wait(found);
                    found = woken.unwrap_or_else(PoisonError::into_inner);
                }
                None => {
                    found.insert(identity, None);
                    return Claim::Free(Free {
                        known: self,
                        identity,
                    });
                }
            }
        }
    }
}

impl Free<'_> {
    /// Keeps the outcome, unless a limit has decided what it is.
    pub(crate) fn keep(self, outcome: &Outcome) {
        if outcome.report.complete {
            let found = self.known.found.lock();
            let mut found = found.unwrap_or_else(PoisonError::into_inner);
            found.insert(self.identity, Some(outcome.clone()));
        }
    }
}

impl Drop for Free<'_> {
    fn drop(&mut self) {
        let mut found = self
            .known
            .found
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if found.get(&self.identity).is_some_and(Option::is_none) {
            found.remove(&self.identity);
        }
        drop(found);
        self.known.ended.notify_all();
    }
}

/// What decides the outcome of exploring a system in this way.
pub(crate) fn identity(bound: &Bound, how: &impl Hash) -> Identity {
    let mut all = All::default();
    bound.hash(&mut all);
    how.hash(&mut all);
    all.digest()
}
