//! A system as the search and the verdicts have it: packing, workers, limits.

use crate::choices::Odometer;
use crate::crew::Crew;
use crate::cursor::Cursor;
use crate::pack::{Key, Packer};
use crate::process::Origin;
use crate::property::Eval;
use crate::report::{Error, Way};
use crate::stages::{Condition, Staged};
use crate::system::Fault;
use crate::watch::Watch;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// A system with its packing, its workers and its limits.
pub(crate) struct Model<'a, O, K> {
    pub(crate) origin: O,
    pub(crate) packer: Packer<K>,
    pub(crate) crew: &'a Crew,
    pub(crate) watch: &'a Watch,
    /// Codes of faults that atoms meet after the search.
    pub(crate) late: Mutex<BTreeSet<u32>>,
    afterwards: OnceLock<Watch>,
    /// Whether stages have turned out to be the quicker way.
    pub(crate) pays: AtomicBool,
    /// Bytes of what is known of stages.
    pub(crate) known: AtomicU64,
}

/// The most bytes that all threads together know of stages, and the share of a limit.
const MOST_KNOWN: u64 = 512 << 20;
const SHARE_KNOWN: u64 = 8;

impl<'a, O: Origin, K: Key> Model<'a, O, K> {
    pub(crate) fn new(
        origin: O,
        crew: &'a Crew,
        watch: &'a Watch,
        way: Way,
    ) -> Result<Self, Error> {
        let packer = Packer::new(origin.domains())?;
        Ok(Model::with(origin, packer, crew, watch, way))
    }

    /// With a packing of its own.
    pub(crate) fn with(
        origin: O,
        packer: Packer<K>,
        crew: &'a Crew,
        watch: &'a Watch,
        way: Way,
    ) -> Self {
        Model {
            origin,
            packer,
            crew,
            watch,
            late: Mutex::default(),
            afterwards: OnceLock::new(),
            pays: AtomicBool::new(way == Way::Staged),
            known: AtomicU64::new(0),
        }
    }

    /// The stages of the system for one thread, if it has any.
    pub(crate) fn staged(&self, conditions: &[Condition]) -> Option<Staged<'_, K>> {
        let all = self.watch.memory().map_or(MOST_KNOWN, |m| m / SHARE_KNOWN);
        let most = all.min(MOST_KNOWN) / self.crew.size().max(1) as u64;
        Staged::new(&self.origin, &self.packer, conditions, &self.known, most)
    }

    /// The same, where stages are known to be the quicker way.
    pub(crate) fn quicker(&self, conditions: &[Condition]) -> Option<Staged<'_, K>> {
        let pays = self.pays.load(Ordering::Relaxed);
        pays.then(|| self.staged(conditions)).flatten()
    }

    /// Bytes of what is known of stages.
    pub(crate) fn known(&self) -> u64 {
        self.known.load(Ordering::Relaxed)
    }

    /// What makes cycles for the search and the verdicts, within the limits.
    pub(crate) fn cursor(&self) -> Cursor<O::Process> {
        Cursor::new(&self.origin, self.watch)
    }

    /// What makes cycles to rebuild runs, for which there is time of its own.
    pub(crate) fn retracing(&self) -> Cursor<O::Process> {
        Cursor::new(&self.origin, self.afterwards())
    }

    /// The limits of rebuilding runs; its time begins with the first call.
    pub(crate) fn afterwards(&self) -> &Watch {
        self.afterwards.get_or_init(|| self.watch.afterwards())
    }

    /// Evaluates atoms after the search; faults are noted and count as FALSE.
    pub(crate) fn eval<'b, P: ?Sized>(
        &'b self,
        process: &'b mut P,
        choices: &'b mut Odometer,
    ) -> Eval<'b, P, impl FnMut(Fault) + 'b> {
        let fault = |fault: Fault| {
            self.late
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .insert(fault.code);
        };
        Eval {
            process,
            choices,
            fault,
        }
    }
}
