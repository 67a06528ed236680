//! Whether all processes of a cluster are still there.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The first failure that a thread of this process has noticed.
#[derive(Debug, Default)]
pub(super) struct Health {
    failed: AtomicBool,
    reason: Mutex<Option<String>>,
}

impl Health {
    /// Notes a failure; the first one stays, since the others usually follow from it.
    pub(super) fn fail(&self, reason: String) {
        let mut first = self.reason.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(reason);
        self.failed.store(true, Ordering::Release);
    }

    pub(super) fn failed(&self) -> bool {
        self.failed.load(Ordering::Acquire)
    }

    /// The first failure.
    pub(super) fn reason(&self) -> Option<String> {
        let first = self.reason.lock().unwrap_or_else(PoisonError::into_inner);
        first.clone()
    }

    /// Fails with what has been noticed.
    pub(super) fn check(&self) -> Result<(), String> {
        match self.reason() {
            Some(reason) if self.failed() => Err(reason),
            _ => Ok(()),
        }
    }
}
