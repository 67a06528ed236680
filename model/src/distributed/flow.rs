//! The dataflow of one worker: states go to the worker that owns them, notes to the one they are for, and progress
//! tracking tells when all that belongs to a depth has arrived everywhere.

use super::health::Health;
use crate::pack::{Key, Wide};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use timely::ExchangeData;
use timely::communication::Allocate;
use timely::container::CapacityContainerBuilder;
use timely::dataflow::channels::pact::Exchange;
use timely::dataflow::operators::{Input, Operator, Probe};
use timely::dataflow::{InputHandle, ProbeHandle};
use timely::worker::{Config, Worker};

/// The output of an operator that has none.
type Nothing = CapacityContainerBuilder<Vec<()>>;

/// How long a worker without work sleeps before it looks whether all others are still there.
const NAP: Duration = Duration::from_millis(20);

/// A key that goes through the network as plain bytes.
pub(super) trait Wire: Key + Serialize + DeserializeOwned {}

impl Wire for u64 {}

impl Wire for Wide {}

/// The worker among `peers` that a state belongs to, before reduction modulo their number. The table of a worker uses the
/// lowest and the highest bits of the hash.
pub(super) fn owner<K: Key>(key: K) -> u64 {
    key.hash() >> 16 & 0xffff_ffff
}

/// What came for one depth and has not been taken.
struct Mail<K, N> {
    states: Vec<Vec<K>>,
    notes: Vec<N>,
}

impl<K, N> Default for Mail<K, N> {
    fn default() -> Self {
        Mail {
            states: Vec::new(),
            notes: Vec::new(),
        }
    }
}

/// What comes, by depth: who has finished a depth early sends for the next one already.
type Inbox<K, N> = Rc<RefCell<BTreeMap<u32, Mail<K, N>>>>;

/// One worker's end of the exchange.
pub(super) struct Post<'a, A: Allocate, K: Wire, N: ExchangeData> {
    worker: Worker<A>,
    states: InputHandle<u32, K>,
    notes: InputHandle<u32, (u64, N)>,
    mail: Inbox<K, N>,
    probe: ProbeHandle<u32>,
    /// The depth of the states being sent.
    depth: u32,
    health: &'a Health,
    /// Workers of this process that may still send something.
    sending: &'a AtomicUsize,
}

/// Another process is gone.
#[derive(Debug)]
pub(super) struct Lost;

impl<'a, A: Allocate, K: Wire, N: ExchangeData> Post<'a, A, K, N> {
    pub(super) fn new(allocator: A, health: &'a Health, sending: &'a AtomicUsize) -> Self {
        let mut worker = Worker::new(Config::default(), allocator, None);
        let mail: Inbox<K, N> = Rc::default();
        let probe = ProbeHandle::new();
        let (states, notes) = worker.dataflow::<u32, _, _>(|scope| {
            let (states, stream) = scope.new_input::<K>();
            let to = Rc::clone(&mail);
            let by_hash = Exchange::new(|key: &K| owner(*key));
            let arrived = stream.unary::<Nothing, _, _, _>(by_hash, "states", |_, _| {
                move |input, _| {
                    input.for_each(|time, keys: &mut Vec<K>| {
                        let mut mail = to.borrow_mut();
                        let of_depth = mail.entry(*time.time()).or_default();
                        of_depth.states.push(std::mem::take(keys));
                    });
                }
            });
            arrived.probe_with(&probe);
            let (notes, stream) = scope.new_input::<(u64, N)>();
            let to = Rc::clone(&mail);
            let addressed = Exchange::new(|note: &(u64, N)| note.0);
            let arrived = stream.unary::<Nothing, _, _, _>(addressed, "notes", |_, _| {
                move |input, _| {
                    input.for_each(|time, notes: &mut Vec<(u64, N)>| {
                        let mut mail = to.borrow_mut();
                        let of_depth = mail.entry(*time.time()).or_default();
                        of_depth.notes.extend(notes.drain(..).map(|(_, note)| note));
                    });
                }
            });
            arrived.probe_with(&probe);
            (states, notes)
        });
        Post {
            worker,
            states,
            notes,
            mail,
            probe,
            depth: 0,
            health,
            sending,
        }
    }

    /// The number of this worker among all workers of all processes.
    pub(super) fn index(&self) -> u64 {
        self.worker.index() as u64
    }

    /// The number of workers.
    pub(super) fn peers(&self) -> u64 {
        self.worker.peers() as u64
    }

    /// Sends a state to the worker that owns it.
    pub(super) fn send(&mut self, key: K) {
        self.states.send(key);
    }

    /// Sends a note to one worker.
    pub(super) fn tell(&mut self, worker: u64, note: N) {
        self.notes.send((worker, note));
    }

    /// Takes the states that have come so far.
    pub(super) fn poll(&mut self, take: &mut dyn FnMut(K)) -> Result<(), Lost> {
        if self.health.failed() {
            return Err(Lost);
        }
        self.worker.step();
        self.deliver(take);
        Ok(())
    }

    fn deliver(&mut self, take: &mut dyn FnMut(K)) {
        let mut mail = self.mail.borrow_mut();
        if let Some(mail) = mail.get_mut(&self.depth) {
            mail.states.drain(..).flatten().for_each(take);
        }
    }

    /// Ends the depth: nobody sends any more states of it. Takes all that come, and gives the notes.
    pub(super) fn end_depth(&mut self, take: &mut dyn FnMut(K)) -> Result<Vec<N>, Lost> {
        let next = self.depth + 1;
        self.states.advance_to(next);
        self.notes.advance_to(next);
        while self.probe.less_than(&next) {
            if self.health.failed() {
                return Err(Lost);
            }
            self.worker.step_or_park(Some(NAP));
            self.deliver(take);
        }
        self.deliver(take);
        let mail = self.mail.borrow_mut().remove(&self.depth);
        self.depth = next;
        Ok(mail.map(|mail| mail.notes).unwrap_or_default())
    }

    /// Ends the dataflow, when all others do.
    pub(super) fn close(self) -> Result<(), Lost> {
        let Post {
            mut worker,
            states,
            notes,
            health,
            sending,
            ..
        } = self;
        drop((states, notes));
        sending.fetch_sub(1, Ordering::AcqRel);
        while worker.has_dataflows() {
            if health.failed() {
                return Err(Lost);
            }
            worker.step_or_park(Some(NAP));
        }
        Ok(())
    }
}
