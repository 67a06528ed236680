//! The page of the command `explore`, interactive simulation: a local page to walk through the state spaces of a file.
//!
//! The server keeps nothing but the file: every answer is a function of the request, which carries the whole walk ([`path`]).
//! So back, forward, reload and several tabs work, and a link shows anybody with the same file the same state.
//!
//! * [`path`], [`walk`]: a walk as text, and the run that it stands for.
//! * [`classes`]: what can come next, cycles with the same outcome put together.
//! * [`live`], [`truth`]: what the properties say along the walk.
//! * [`jump`]: a run that shows a property, found by exploring.
//! * [`recording`]: a walk on the production monitors, to be replayed.
//! * [`view`]: all this as JSON. [`api`]: requests and answers. [`server`]: the same over HTTP, on loopback only;
//!   [`http`]: as much of it as that takes.

pub mod api;
pub mod classes;
pub mod http;
pub mod jump;
pub mod live;
pub mod path;
pub mod recording;
pub mod server;
pub mod truth;
pub mod view;
pub mod walk;

use std::sync::Mutex;
use std::time::Duration;

use sha2::{Digest, Sha256};
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_lang::bind::Bound;

use crate::export::system_names;

/// Bounds of an exploration for the page.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// Wall time.
    pub time: Duration,
    /// Bytes for the explorer.
    pub memory: u64,
    /// Worker threads; 0 for all processors.
    pub threads: usize,
}

/// What the page works on.
#[derive(Debug)]
pub struct Walks {
    subject: Subject,
    systems: Vec<Known>,
    /// The system that the page shows first.
    start: usize,
    bounds: Bounds,
    /// Held while one exploration runs: two would have half the time and memory each.
    exploring: Mutex<()>,
}

/// Name and identity of a system.
#[derive(Debug)]
struct Known {
    name: String,
    hash: String,
}

impl Walks {
    /// Walks through the systems of `subject`, which shows number `start` first.
    pub fn new(subject: Subject, start: usize, bounds: Bounds) -> Self {
        let known = |(name, task): (String, &Task)| Known {
            name,
            hash: identity(&task.bound),
        };
        let systems = system_names(&subject).into_iter().zip(&subject.tasks);
        Self {
            systems: systems.map(known).collect(),
            subject,
            start,
            bounds,
            exploring: Mutex::new(()),
        }
    }

    /// The file and its systems.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// The systems: task, name for links, identity.
    pub fn systems(&self) -> impl Iterator<Item = (&Task, &str, &str)> {
        let both = self.subject.tasks.iter().zip(&self.systems);
        both.map(|(task, known)| (task, known.name.as_str(), known.hash.as_str()))
    }
}

/// Identifies everything that decides what a path means: rules, ranges and values, not the texts beside them. Sixteen
/// hexadecimal digits of a SHA-256.
pub fn identity(bound: &Bound) -> String {
    let mut digest = Sha256::new();
    digest.update(bound.system.name.as_bytes());
    digest.update(bound.system.fingerprint().to_le_bytes());
    let mut number = |value: i32| digest.update(value.to_le_bytes());
    bound.values.iter().for_each(|value| number(*value));
    for (lo, hi) in bound.states.iter().chain(&bound.inputs) {
        number(*lo);
        number(*hi);
    }
    for value in &bound.initial {
        number(value.unwrap_or(i32::MIN));
    }
    let mut digits = format!("{:x}", digest.finalize());
    digits.truncate(16);
    digits
}
