//! The enumeration of the cycles from one state.

use crate::choices::Odometer;
use crate::pack::{Key, Packer};
use crate::report::Error;
use crate::system::{Fault, System};
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
pub(crate) struct Cursor<'s, S: System> {
    pub(crate) system: &'s S,
    pub(crate) work: S::Work,
    pub(crate) odometer: Odometer,
    before: Vec<i32>,
    after: Vec<i32>,
}

impl<'s, S: System> Cursor<'s, S> {
    pub(crate) fn new(system: &'s S) -> Self {
        let size = system.domains().len();
        Cursor {
            system,
            work: system.work(),
            odometer: Odometer::new(system.combinations()),
            before: roomy(size),
            after: roomy(size),
        }
    }

    /// Makes every cycle from a state in the order of the choice vectors, until `each` breaks off. `each` may read
    /// further inputs of the cycle; the weight of the odometer is final when it returns.
    #[inline]
    pub(crate) fn leaves<K: Key>(
        &mut self,
        packer: &Packer<K>,
        key: K,
        mut each: impl FnMut(&mut S::Work, &mut Odometer, Leaf<K>) -> ControlFlow<()>,
    ) {
        packer.unpack(key, &mut self.before);
        self.odometer.reset();
        loop {
            self.odometer.begin();
            let next = self.system.next(&mut self.work, &self.before, &mut self.odometer, &mut self.after);
            let leaf = match next {
                Err(fault) => Leaf::Fault(fault),
                Ok(()) if self.system.discarded(&self.work) => Leaf::Discarded,
                Ok(()) => packer.pack(&self.after).map_or(Leaf::Fault(Fault::OUT_OF_DOMAIN), Leaf::To),
            };
            if each(&mut self.work, &mut self.odometer, leaf).is_break() || !self.odometer.advance() {
                return;
            }
        }
    }

    /// The choices of the first cycle from a state that `test` accepts, and the state after it.
    pub(crate) fn first<K: Key>(
        &mut self,
        packer: &Packer<K>,
        key: K,
        mut test: impl FnMut(&mut S::Work, &mut Odometer, Leaf<K>) -> bool,
    ) -> Option<(Vec<(u32, u32)>, Leaf<K>)> {
        let mut found = None;
        self.leaves(packer, key, |work, odometer, leaf| {
            if test(work, odometer, leaf) {
                found = Some((odometer.values(), leaf));
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        found
    }

    /// Gives every initial state with its choices, until `each` breaks off.
    pub(crate) fn initial<K: Key>(
        &mut self,
        packer: &Packer<K>,
        mut each: impl FnMut(K, &Odometer) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        self.odometer.reset();
        loop {
            self.odometer.begin();
            self.system.initial(&mut self.work, &mut self.odometer, &mut self.after);
            let key = packer.pack(&self.after).ok_or(Error::InitialOutOfDomain)?;
            if each(key, &self.odometer).is_break() || !self.odometer.advance() {
                return Ok(());
            }
        }
    }
}
