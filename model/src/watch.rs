//! The limits of an exploration, looked at by everything in it that can take long.

use crate::report::{Interrupt, Limits, Options};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// How long runs are rebuilt after an interrupt: who ends a process asks for what it has, not for more work.
const AFTER_INTERRUPT: Duration = Duration::from_secs(3);

/// The least time in which runs may be rebuilt after a time limit.
const AFTER_TIME: Duration = Duration::from_millis(500);

const TIME: u8 = 1;
const MEMORY: u8 = 2;
const INTERRUPT: u8 = 3;

/// The limits of one exploration, and whether one was reached. Copies watch the same exploration.
#[derive(Clone, Debug)]
pub(crate) struct Watch(Arc<Watched>);

#[derive(Debug)]
struct Watched {
    start: Instant,
    /// Time spent before this run, in nanoseconds.
    earlier: AtomicU64,
    limits: Limits,
    interrupt: Option<Interrupt>,
    stopped: AtomicU8,
    peak: AtomicU64,
}

impl Watch {
    pub(crate) fn new(options: &Options) -> Self {
        Watch::with(options.limits, options.interrupt.clone())
    }

    pub(crate) fn with(limits: Limits, interrupt: Option<Interrupt>) -> Self {
        Watch(Arc::new(Watched {
            start: Instant::now(),
            earlier: AtomicU64::new(0),
            limits,
            interrupt,
            stopped: AtomicU8::new(0),
            peak: AtomicU64::new(0),
        }))
    }

    /// A watch over the work that follows the verdicts, the rebuilding of runs. Under a time limit it may take as long as
    /// the search did; after an interrupt, a moment.
    pub(crate) fn afterwards(&self) -> Self {
        let own = &self.0;
        let spent = own.start.elapsed();
        let (time, interrupt) = match self.stopped_by(INTERRUPT) {
            true => (Some(AFTER_INTERRUPT), None),
            false => {
                let most =
                    |time: Duration| time.saturating_mul(2).saturating_sub(spent).max(AFTER_TIME);
                (own.limits.time.map(most), own.interrupt.clone())
            }
        };
        Watch::with(Limits { time, ..own.limits }, interrupt)
    }

    /// The time spent, also in the runs that this one continues.
    pub(crate) fn elapsed(&self) -> Duration {
        self.0.start.elapsed() + Duration::from_nanos(self.0.earlier.load(Ordering::Relaxed))
    }

    pub(crate) fn continues(&self, earlier: Duration) {
        self.0
            .earlier
            .store(earlier.as_nanos() as u64, Ordering::Relaxed);
    }

    /// True if work must end; `bytes` are held now.
    pub(crate) fn over(&self, bytes: u64) -> bool {
        let own = &self.0;
        own.peak.fetch_max(bytes, Ordering::Relaxed);
        if bytes > own.limits.memory.unwrap_or(u64::MAX / 8) {
            own.stopped.store(MEMORY, Ordering::Relaxed);
        }
        self.ended()
    }

    /// The same for who holds nothing more than was told before.
    pub(crate) fn ended(&self) -> bool {
        let own = &self.0;
        if self.stopped() {
            return true;
        }
        let reason = if own.interrupt.as_ref().is_some_and(Interrupt::is_raised) {
            INTERRUPT
        } else if own
            .limits
            .time
            .is_some_and(|most| own.start.elapsed() >= most)
        {
            TIME
        } else {
            return false;
        };
        own.stopped.store(reason, Ordering::Relaxed);
        true
    }

    /// True if `bytes` are more than may be held. Ends nothing.
    pub(crate) fn too_much(&self, bytes: u64) -> bool {
        self.0.peak.fetch_max(bytes, Ordering::Relaxed);
        self.0.limits.memory.is_some_and(|most| bytes > most)
    }

    /// The most bytes that may be held.
    pub(crate) fn memory(&self) -> Option<u64> {
        self.0.limits.memory
    }

    /// The most bytes that were told.
    pub(crate) fn peak(&self) -> u64 {
        self.0.peak.load(Ordering::Relaxed)
    }

    /// Whether a limit was reached.
    pub(crate) fn stopped(&self) -> bool {
        self.0.stopped.load(Ordering::Relaxed) != 0
    }

    fn stopped_by(&self, reason: u8) -> bool {
        self.0.stopped.load(Ordering::Relaxed) == reason
    }
}
