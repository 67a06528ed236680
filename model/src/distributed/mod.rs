//! Distributed search, one over several processes, for state spaces that outgrow the memory of one machine.
//!
//! The search is a timely dataflow whose time is the depth. Each worker of each process owns the states whose hash is
//! its own: it keeps them, and makes the cycles from them. What a cycle leads to goes to its owner, with the next depth
//! as its time. A level ends when progress tracking says that nothing of its depth can come any more to any worker.
//! Then all workers know from each other's notes what has shown so far, and decide alike how to go on.
//!
//! At the end process 0 gets what all have found and judges the properties as the search of one process does, so the
//! report is the same. Verdicts that need the graph of pending cycles, and runs, are made by process 0 alone.
//!
//! * `cluster`, `frame`, `health`: the processes, how they meet, and how each learns that another one is gone.
//! * `mesh`, `flow`: the connections, and the dataflow on them.
//! * `share`, `work`: a worker's states, and its search.

mod cluster;
mod flow;
mod frame;
mod health;
mod mesh;
mod share;
mod work;

pub use cluster::{Cluster, ClusterError};

use crate::explore::{Finish, bitmap_fits, crew};
use crate::hashed::{Code, Halves, Hashed, Plain};
use crate::model::Model;
use crate::pack::{Packer, Wide, space};
use crate::parts::Tables;
use crate::process::{Any, Origin};
use crate::property::{Property, validate};
use crate::report::{Error, Judgement, Limits, Options, Progress, Report, Storage, Verdict, Way};
use crate::search::Known;
use crate::store::Dense;
use crate::system::System;
use crate::tally::Found;
use crate::watch::Watch;
use flow::{Post, Wire};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize};
use std::thread;
use timely::communication::allocator::Process;
use timely::communication::allocator::zero_copy::bytes_slab::BytesRefill;
use timely::communication::allocator::zero_copy::initialize::initialize_networking_from_sockets;
use work::{Broken, Task};

/// Explores like [`crate::explore`], together with the other processes of a cluster, each of which calls this with the
/// same system and properties. The report is the same but for its time, memory and storage.
///
/// The options' checkpoint is not used. `limits.threads` is for the verdicts at process 0 (the cluster says how many threads search), `limits.memory` for
/// this process. Process 0's time limit holds for all.
///
/// Only process 0 gets the report; the others get one that says nothing.
///
/// # Errors
/// As [`crate::explore`]; [`Error::Cluster`] when another process ends or cannot be reached.
pub fn explore_together<S: System>(
    system: &S,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
    cluster: &Cluster,
) -> Result<Report, Error> {
    explored(Any::new(system), properties, options, progress, cluster)
}

/// The same for any system, so that it is compiled once and not for each of them.
#[inline(never)]
fn explored(
    any: Any,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
    cluster: &Cluster,
) -> Result<Report, Error> {
    validate(properties)?;
    let watch = Watch::new(options);
    if u64::try_from(space(any.domains())?).is_ok() {
        let parts = Tables::new(&any, &Packer::new(any.domains())?, properties, &watch);
        run::<Plain>(any, parts, properties, options, progress, cluster)
    } else {
        let parts = Tables::new(&any, &Packer::new(any.domains())?, properties, &watch);
        run::<Halves>(any, parts, properties, options, progress, cluster)
    }
}

/// How a worker stores its states, and the storage for what follows the search.
trait Ending: Code<Key: Wire> {
    const STORAGE: Storage;
    fn finish(finish: Finish<Self::Key>) -> Result<Report, Error>;
}

impl Ending for Plain {
    const STORAGE: Storage = Storage::Hash64;

    fn finish(finish: Finish<u64>) -> Result<Report, Error> {
        match bitmap_fits(space(finish.model.origin.domains())?, finish.options) {
            Some(small) => {
                let store = Dense::new(small, finish.model.crew.size());
                finish.report(store)
            }
            None => finish.report(Hashed::<Plain>::new()),
        }
    }
}

impl Ending for Halves {
    const STORAGE: Storage = Storage::Hash128;

    fn finish(finish: Finish<Wide>) -> Result<Report, Error> {
        finish.report(Hashed::<Halves>::new())
    }
}

fn run<C: Ending>(
    origin: Any,
    parts: Option<Tables<C::Key>>,
    properties: &[Property],
    options: &Options,
    progress: &mut dyn Progress,
    cluster: &Cluster,
) -> Result<Report, Error> {
    let fingerprint = fingerprint(&origin, properties);
    let order = cluster
        .begin(fingerprint, options.limits.time)
        .map_err(|e| Error::Cluster(e.to_string()))?;
    let limits = Limits {
        time: order.time,
        ..options.limits
    };
    let watch = Watch::with(limits, options.interrupt.clone());
    let crew = crew(options)?;
    let task = Task {
        model: Model::new(origin, &crew, &watch, Way::Single)?,
        properties,
        options,
        parts,
        held: (0..cluster.threads()).map(|_| AtomicU64::new(0)).collect(),
        sent: AtomicU64::new(0),
    };
    let found = match together::<C>(cluster, order.number, &task, progress) {
        Ok(found) => found,
        Err(Broken::System(error)) => return Err(error),
        Err(Broken::Lost) => {
            cluster.tell_failure();
            let reason = cluster.health.reason();
            return Err(Error::Cluster(
                reason.unwrap_or_else(|| "no reason known".to_owned()),
            ));
        }
    };
    cluster.note_sent(task.sent.into_inner());
    let Some(found) = found else {
        return Ok(nothing(properties, watch.elapsed().as_secs_f64()));
    };
    C::finish(Finish {
        model: &task.model,
        found,
        known: Known::default(),
        properties,
        options,
        storage: C::STORAGE,
    })
}

/// Starts the workers of this process and lets them search. Process 0 gets what was found.
fn together<C: Ending>(
    cluster: &Cluster,
    number: u64,
    task: &Task<C::Key>,
    progress: &mut dyn Progress,
) -> Result<Option<Found<C::Key>>, Broken> {
    let health = &*cluster.health;
    let fail = |reason: String| {
        health.fail(reason);
        Broken::Lost
    };
    let sending = Arc::new(AtomicUsize::new(cluster.threads()));
    let links = mesh::connect(cluster, number, &sending).map_err(fail)?;
    let refill = BytesRefill {
        logic: Arc::new(|size| Box::new(vec![0; size])),
        limit: None,
    };
    let no_log = Arc::new(|_| None);
    let (builders, guard) = initialize_networking_from_sockets::<_, Process>(
        links,
        cluster.process(),
        cluster.threads(),
        refill,
        no_log,
    )
    .map_err(|e| fail(e.to_string()))?;
    let sending = &*sending;
    let mut builders = builders.into_iter().enumerate();
    let first = builders.next();
    let result = thread::scope(|scope| {
        let others: Vec<_> = builders
            .map(|(number, builder)| {
                scope.spawn(move || {
                    let post = Post::new(builder.build(), health, sending);
                    task.work::<C, _>(number, post, &mut ())
                })
            })
            .collect();
        let mut result = match first {
            Some((number, builder)) => task.work::<C, _>(
                number,
                Post::new(builder.build(), health, sending),
                progress,
            ),
            None => Ok(None),
        };
        for other in others {
            match other.join() {
                Ok(Ok(_)) => (),
                Ok(Err(error)) => result = Err(error),
                Err(_) => result = Err(fail("a worker thread panicked".to_owned())),
            }
        }
        result
    });
    // The communication threads of a broken cluster wait for what will not come; they end with this process.
    let closer = thread::spawn(move || drop(guard));
    while !closer.is_finished() && !health.failed() {
        thread::sleep(cluster::GLANCE);
    }
    match result {
        Ok(_) if health.failed() => Err(Broken::Lost),
        Ok(_) if closer.join().is_err() => {
            Err(fail("a connection broke while it was closed".to_owned()))
        }
        result => result,
    }
}

/// A number that differs, with near certainty, where systems or properties do.
fn fingerprint(origin: &Any, properties: &[Property]) -> u64 {
    let text = format!(
        "{:?} {} {} {properties:?}",
        origin.domains(),
        origin.combinations(),
        origin.rules()
    );
    digest(text.as_bytes())
}

/// A number for a text (FNV-1a): equal for equal texts in every process, and different for different ones but for a
/// chance of 2^-64. For telling mistakes apart, not forgeries.
pub fn digest(text: &[u8]) -> u64 {
    text.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// What a process other than 0 answers.
fn nothing(properties: &[Property], seconds: f64) -> Report {
    let silent = |property: &Property| Judgement {
        id: property.id.clone(),
        verdict: Verdict::Inconclusive,
        length: None,
        bound: None,
        fastest: None,
        trace: None,
    };
    Report {
        states: 0,
        transitions: 0,
        depth: 0,
        seconds,
        complete: false,
        resumable: false,
        stored: 0,
        coverage: Vec::new(),
        absorbing: 0,
        absorbing_examples: Vec::new(),
        memory: 0,
        storage: Storage::Hash64,
        index_space: 0,
        faults: Vec::new(),
        properties: properties.iter().map(silent).collect(),
    }
}
