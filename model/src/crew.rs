//! The worker pool: the threads of one search.

use crate::report::Error;
use rayon::slice::ParallelSliceMut;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Searches that go on side by side and share the processors: each has its part of the threads, and more when others have ended.
#[derive(Clone, Debug)]
pub struct Beside(Arc<AtomicUsize>);

impl PartialEq for Beside {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for Beside {}

impl Beside {
    /// So many searches.
    pub fn new(searches: usize) -> Self {
        Beside(Arc::new(AtomicUsize::new(searches)))
    }

    /// One of them has ended, or waits.
    pub fn leave(&self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }

    /// One of them goes on.
    pub fn join(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    fn number(&self) -> usize {
        self.0.load(Ordering::Relaxed).max(1)
    }
}

/// Lists shorter than this are brought in order by one thread.
const ALONE: usize = 1 << 15;

/// A fixed number of threads.
pub(crate) struct Crew {
    pool: rayon::ThreadPool,
    beside: Option<Beside>,
}

impl Crew {
    pub(crate) fn new(threads: usize, beside: Option<Beside>) -> Result<Self, Error> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        Ok(Crew {
            pool: pool.map_err(|e| Error::Threads(e.to_string()))?,
            beside,
        })
    }

    pub(crate) fn size(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Brings a list in ascending order.
    pub(crate) fn sort(&self, list: &mut [u64]) {
        match list.len() < ALONE {
            true => list.sort_unstable(),
            false => self.pool.install(|| list.par_sort_unstable()),
        }
    }

    /// Does pieces of work, each once. Each worker runs on a thread of its own and begins with its share of the pieces,
    /// next to what it did the last time; then it helps the others.
    pub(crate) fn share<W: Send>(
        &self,
        workers: &mut [W],
        pieces: usize,
        work: impl Fn(&mut W, usize) + Sync,
    ) {
        self.share_to_end(workers, pieces, work, |_| ());
    }

    /// The same; at the end, when no piece is left, each worker does something more.
    pub(crate) fn share_to_end<W: Send>(
        &self,
        workers: &mut [W],
        pieces: usize,
        work: impl Fn(&mut W, usize) + Sync,
        end: impl Fn(&mut W) + Sync,
    ) {
        let searches = self.beside.as_ref().map_or(1, Beside::number);
        let number = workers.len().div_ceil(searches);
        if pieces <= 1 || number == 1 {
            if let Some(worker) = workers.first_mut() {
                (0..pieces).for_each(|piece| work(worker, piece));
                end(worker);
            }
            return;
        }
        let shares: Vec<Share> = (0..number)
            .map(|n| Share {
                next: AtomicUsize::new(pieces * n / number),
                end: pieces * (n + 1) / number,
            })
            .collect();
        let workers: Vec<Mutex<&mut W>> = workers.iter_mut().map(Mutex::new).collect();
        self.pool.broadcast(|context| {
            let first = context.index();
            let Some(worker) = workers.get(first).filter(|_| first < number) else {
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
            end(&mut worker);
        });
    }
}

/// A worker's share of the pieces, in a cache line of its own.
#[repr(align(128))]
struct Share {
    next: AtomicUsize,
    end: usize,
}
