//! The enumeration of the cycles from one state.

use crate::choices::Odometer;
use crate::pack::{Key, Packer};
use crate::process::{Origin, Process};
use crate::report::{Error, Step};
use crate::system::Fault;
use crate::watch::Watch;
use std::ops::ControlFlow;

/// The end of one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Leaf<K> {
    To(K),
    Fault(Fault),
    Discarded,
}

/// A buffer that shares no cache line with a buffer of another thread.
fn roomy(size: usize) -> Vec<i32> {
    let mut buffer = Vec::with_capacity(size + 64);
    buffer.resize(size, 0);
    buffer
}

/// Everything one thread needs to make cycles.
pub(crate) struct Cursor<P> {
    pub(crate) process: P,
    pub(crate) odometer: Odometer,
    before: Vec<i32>,
    after: Vec<i32>,
}

impl<P: Process> Cursor<P> {
    pub(crate) fn new(origin: &impl Origin<Process = P>, watch: &Watch) -> Self {
        let size = origin.domains().len();
        Cursor {
            process: origin.process(),
            odometer: Odometer::watched(origin.combinations(), watch),
            before: roomy(size),
            after: roomy(size),
        }
    }

    /// Makes every cycle from a state in the order of the choice vectors, until `each` breaks off or a limit is reached; the
    /// answer is whether these were all. `each` may read further inputs of the cycle; the weight of the odometer is final
    /// when it returns.
    #[inline]
    pub(crate) fn leaves<K: Key>(
        &mut self,
        packer: &Packer<K>,
        key: K,
        mut each: impl FnMut(&mut P, &mut Odometer, Leaf<K>) -> ControlFlow<()>,
    ) -> bool {
        if self.odometer.is_broken() {
            return false;
        }
        packer.unpack(key, &mut self.before);
        self.odometer.reset();
        loop {
            self.odometer.begin();
            let next = self
                .process
                .next(&self.before, &mut self.odometer, &mut self.after);
            let leaf = match next {
                Err(fault) => Leaf::Fault(fault),
                Ok(()) if self.process.discarded() => Leaf::Discarded,
                Ok(()) => packer
                    .pack(&self.after)
                    .map_or(Leaf::Fault(Fault::OUT_OF_DOMAIN), Leaf::To),
            };
            if each(&mut self.process, &mut self.odometer, leaf).is_break() {
                return false;
            }
            if !self.odometer.advance() {
                return !self.odometer.is_broken();
            }
        }
    }

    /// The choices of the first cycle from a state that `test` accepts, and the state after it. None also if a limit is
    /// reached first.
    pub(crate) fn first<K: Key>(
        &mut self,
        packer: &Packer<K>,
        key: K,
        mut test: impl FnMut(&mut P, &mut Odometer, Leaf<K>) -> bool,
    ) -> Option<(Step, Leaf<K>)> {
        let mut found = None;
        self.leaves(packer, key, |process, odometer, leaf| {
            if test(process, odometer, leaf) {
                found = Some((odometer.values(), leaf));
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        found
    }

    /// Gives every initial state with its choices, until `each` breaks off or a limit is reached; the answer is whether these
    /// were all.
    pub(crate) fn initial<K: Key>(
        &mut self,
        packer: &Packer<K>,
        mut each: impl FnMut(K, &Odometer) -> ControlFlow<()>,
    ) -> Result<bool, Error> {
        if self.odometer.is_broken() {
            return Ok(false);
        }
        self.odometer.reset();
        loop {
            self.odometer.begin();
            self.process.initial(&mut self.odometer, &mut self.after);
            let key = packer.pack(&self.after).ok_or(Error::InitialOutOfDomain)?;
            if each(key, &self.odometer).is_break() {
                return Ok(false);
            }
            if !self.odometer.advance() {
                return Ok(!self.odometer.is_broken());
            }
        }
    }
}
