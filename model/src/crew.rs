//! The worker threads, and the limits they watch.

use crate::report::{Error, Limits};
use std::sync::atomic::{AtomicU8, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Why work ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    Time,
    Memory,
}

/// The limits of one exploration, and whether one was reached.
pub(crate) struct Watch {
    start: Instant,
    /// Time spent before this run, in nanoseconds.
    earlier: AtomicU64,
    limits: Limits,
    stopped: AtomicU8,
    peak: AtomicU64,
}

impl Watch {
    pub(crate) fn new(limits: Limits) -> Self {
        Watch {
            start: Instant::now(),
            earlier: AtomicU64::new(0),
            limits,
            stopped: AtomicU8::new(0),
            peak: AtomicU64::new(0),
        }
    }

    /// The time spent, also in the runs that this one continues.
    pub(crate) fn elapsed(&self) -> Duration {
        self.start.elapsed() + Duration::from_nanos(self.earlier.load(Ordering::Relaxed))
    }

    pub(crate) fn continues(&self, earlier: Duration) {
        self.earlier
            .store(earlier.as_nanos() as u64, Ordering::Relaxed);
    }

    /// True if work must end; `bytes` are held now.
    pub(crate) fn over(&self, bytes: u64) -> bool {
        self.peak.fetch_max(bytes, Ordering::Relaxed);
        if self.stopped.load(Ordering::Relaxed) != 0 {
            return true;
        }
        let reason = if bytes > self.limits.memory.unwrap_or(u64::MAX / 8) {
            2
        } else if self
            .limits
            .time
            .is_some_and(|most| self.start.elapsed() >= most)
        {
            1
        } else {
            return false;
        };
        self.stopped.store(reason, Ordering::Relaxed);
        true
    }

    /// True if `bytes` are more than may be held. Ends nothing.
    pub(crate) fn too_much(&self, bytes: u64) -> bool {
        self.peak.fetch_max(bytes, Ordering::Relaxed);
        self.limits.memory.is_some_and(|most| bytes > most)
    }

    /// The most bytes that were told.
    pub(crate) fn peak(&self) -> u64 {
        self.peak.load(Ordering::Relaxed)
    }

    pub(crate) fn stopped(&self) -> Option<Stop> {
        match self.stopped.load(Ordering::Relaxed) {
            0 => None,
            1 => Some(Stop::Time),
            _ => Some(Stop::Memory),
        }
    }
}

/// A fixed number of threads.
pub(crate) struct Crew {
    pool: rayon::ThreadPool,
}

impl Crew {
    pub(crate) fn new(threads: usize) -> Result<Self, Error> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        Ok(Crew {
            pool: pool.map_err(|e| Error::Threads(e.to_string()))?,
        })
    }

    pub(crate) fn size(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Does pieces of work, each once. Each worker runs on a thread of its own and begins with its share of the pieces,
    /// next to what it did the last time; then it helps the others.
    pub(crate) fn share<W: Send>(
        &self,
        workers: &mut [W],
        pieces: usize,
        work: impl Fn(&mut W, usize) + Sync,
    ) {
        if pieces <= 1 || workers.len() <= 1 {
            if let Some(worker) = workers.first_mut() {
                (0..pieces).for_each(|piece| work(worker, piece));
            }
            return;
        }
        let number = workers.len();
        let shares: Vec<Share> = (0..number)
            .map(|n| Share {
                next: AtomicUsize::new(pieces * n / number),
                end: pieces * (n + 1) / number,
            })
            .collect();
        let workers: Vec<Mutex<&mut W>> = workers.iter_mut().map(Mutex::new).collect();
        self.pool.broadcast(|context| {
            let first = context.index();
            let Some(worker) = workers.get(first) else {
                return;
            };
            let mut worker = worker.lock().unwrap_or_else(PoisonError::into_inner);
            for share in shares.iter().cycle().skip(first).take(number) {
                loop {
                    let piece = share.next.fetch_add(1, Ordering::Relaxed);
                    if piece >= share.end {
                        break;
                    }
                    work(&mut worker, piece);
                }
            }
        });
    }
}

/// A worker's share of the pieces, in a cache line of its own.
#[repr(align(128))]
struct Share {
    next: AtomicUsize,
    end: usize,
}
