//! How a check is made.

use std::sync::Arc;
use std::time::{Duration, Instant};

use stillpoint_model::{Cluster, Interrupt, Limits, Options, Until};

use crate::keep::Keep;
use crate::known::Known;
use crate::outcome::Reductions;
use crate::theorems::Theorems;

/// How to check.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Worker threads; 0 for all processors.
    pub threads: usize,
    /// Bytes for the explorer.
    pub memory: Option<u64>,
    /// Wall time for everything.
    pub time: Option<Duration>,
    /// Use the interpreter even where there is generated code.
    pub interpret: bool,
    /// Where to keep the explorations, so that the check can be continued.
    pub keep: Option<Keep>,
    /// Explore less where that keeps the verdicts.
    pub reductions: Reductions,
    /// Rebuild the runs that show what must be reachable, not only those that break a property.
    pub witnesses: bool,
    /// When an exploration ends; with [`Until::Violated`] what comes after the one that has found a violation is not explored.
    pub until: Until,
    /// Look for the parameters that decide a broken guarantee: an exploration for each of them.
    pub decisive: bool,
    /// The processes that explore together; none for this one alone.
    pub cluster: Option<Arc<Cluster>>,
    /// Ends everything from outside, as a limit would.
    pub interrupt: Option<Interrupt>,
    /// Explore nothing loosely, see [`crate::subject::Loose`].
    pub exact: bool,
    /// What other checks have explored, which need not be explored again; what this one explores is kept there.
    pub known: Option<Arc<Known>>,
    /// The theorems of the family, which need not be explored; none: all is explored.
    pub theorems: Option<Arc<Theorems>>,
}

impl Settings {
    /// The limits of what begins now, where `start` began the time.
    pub fn limits(&self, start: Instant) -> Limits {
        Limits {
            memory: self.memory,
            time: self.time.map(|t| t.saturating_sub(start.elapsed())),
            threads: self.threads,
        }
    }

    /// How what begins now is explored, where `start` began the time.
    pub(crate) fn options(&self, start: Instant) -> Options {
        Options {
            limits: self.limits(start),
            interrupt: self.interrupt.clone(),
            // Most reports tell the length of a witness only; rebuilding their runs takes as long as the search.
            witnesses: self.witnesses,
            until: self.until,
            ..Options::default()
        }
    }

    /// The settings for what follows, where `start` began the time.
    #[must_use]
    pub fn after(&self, start: Instant) -> Self {
        Self {
            time: self.limits(start).time,
            ..self.clone()
        }
    }

    /// Whether all was ended from outside.
    pub fn interrupted(&self) -> bool {
        self.interrupt.as_ref().is_some_and(Interrupt::is_raised)
    }
}
