//! What an exploration is asked and what it answers.

use crate::crew::Beside;
use crate::property::Property;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Bounds on an exploration. Reaching one ends it early with `complete = false`; it is no error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// Bytes for the tables of the explorer; none for a default choice of storage without a limit.
    pub memory: Option<u64>,
    /// Wall time of search and verdicts. Runs of violations already found are still rebuilt after it, for at most as long
    /// again; what is not rebuilt by then is told by its length alone.
    pub time: Option<Duration>,
    /// Worker threads; 0 for as many as the machine has.
    pub threads: usize,
}

/// Ends explorations from outside, as a limit that is reached does: each reports what it has. Copies are the same interrupt.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// One that ends explorations when this becomes true.
    pub fn of(flag: Arc<AtomicBool>) -> Self {
        Interrupt(flag)
    }

    /// Ends them.
    pub fn raise(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether they are to end.
    pub fn is_raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl PartialEq for Interrupt {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for Interrupt {}

/// Where to keep an exploration between two levels, so that it can be continued.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checkpoint {
    /// The file; its folder must exist.
    pub file: PathBuf,
    /// Says what is explored: the checkpoint of another identity is not continued.
    pub identity: String,
    /// The least time between two checkpoints. One more is written when a limit ends the search, and at its end.
    pub every: Duration,
    /// Whether to continue from the file, if it is there.
    pub resume: bool,
}

/// How to explore.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// When to give up.
    pub limits: Limits,
    /// What ends the exploration from outside; none for nothing.
    pub interrupt: Option<Interrupt>,
    /// The searches with which it shares the processors.
    pub beside: Option<Beside>,
    /// Whether properties that hold get a witness trace; without it they get its length alone.
    pub witnesses: bool,
    /// When the search ends (`complete` is then false if states were left).
    pub until: Until,
    /// The most absorbing states listed.
    pub examples: usize,
    /// Whether the values of a timer ([`crate::System::timer`]) are stored as intervals where an index of the state fits
    /// 64 bits. The report stays the same, but for traces of the same length, loops at the end of traces, and the examples of
    /// absorbing states.
    pub intervals: bool,
    /// Where to keep the exploration; none to keep it nowhere.
    pub checkpoint: Option<Checkpoint>,
    /// How the cycles of a state are made; the report is the same.
    pub way: Way,
}

/// When a search ends. What it has found until then are shortest runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Until {
    /// With the last state.
    #[default]
    Complete,
    /// When every property is decided.
    Decided,
    /// When a property is seen to be violated.
    Violated,
}

impl Until {
    /// Whether a search ends when of each property a first cycle, and a violation, have been seen or not.
    pub(crate) fn is_met(
        self,
        properties: &[Property],
        seen: impl Iterator<Item = (bool, bool)>,
    ) -> bool {
        let mut each = properties.iter().zip(seen);
        match self {
            Until::Complete => false,
            Until::Decided => {
                each.all(|(property, (first, bad))| property.form.decided_by(first, bad))
            }
            Until::Violated => each.any(|(_, (_, bad))| bad),
        }
    }
}

/// How the cycles of a state are made, where a system has stages ([`crate::System::stages`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Way {
    /// In the way that turns out to be the quicker one.
    #[default]
    Quicker,
    /// One by one.
    Single,
    /// In stages wherever it can be.
    Staged,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            limits: Limits::default(),
            interrupt: None,
            beside: None,
            witnesses: true,
            until: Until::default(),
            examples: 8,
            intervals: false,
            checkpoint: None,
            way: Way::default(),
        }
    }
}

/// Follows the search; the default methods do nothing.
pub trait Progress {
    /// Called after each level: its depth in cycles, the states found so far, the transitions so far (weighted with
    /// unread inputs), and the number of states found in the level just made.
    fn on_level(&mut self, depth: u32, states: u64, transitions: u128, frontier: u64) {
        let _ = (depth, states, transitions, frontier);
    }

    /// Called before [`Progress::on_level`]: the bytes that the tables of this process hold now.
    fn on_memory(&mut self, bytes: u64) {
        let _ = bytes;
    }

    /// Called when a checkpoint could not be written; the search goes on, and the last one is still there.
    fn on_lost_checkpoint(&mut self, error: &Error) {
        let _ = error;
    }
}

impl Progress for () {}

/// Why a system or property cannot be explored at all.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// A variable has no value.
    #[error("state variable {variable} has an empty domain")]
    EmptyDomain {
        /// Its number.
        variable: usize,
    },
    /// The number of states of the index space needs more than 128 bits.
    #[error(
        "the index space of the state variables does not fit 128 bits; make their ranges smaller"
    )]
    SpaceTooLarge,
    /// `initial` wrote a state outside the domains.
    #[error("an initial state lies outside the domains of the state variables")]
    InitialOutOfDomain,
    /// The weights of the transitions do not add up to the declared input combinations of the cycles made.
    #[error(
        "the system declares {declared} input combinations a cycle, but its reads make another number"
    )]
    Combinations {
        /// The declared number.
        declared: u128,
    },
    /// A property with a bound has fairness conditions.
    #[error("property {id}: `within` and `fair` exclude each other")]
    FairWithBound {
        /// The property.
        id: String,
    },
    /// More fairness conditions than supported.
    #[error("property {id}: more than 31 fairness conditions")]
    TooManyFair {
        /// The property.
        id: String,
    },
    /// A checkpoint cannot be used or written.
    #[error("checkpoint {file}: {reason}")]
    Checkpoint {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// Processes that explore together have lost one of them, or do not explore the same.
    #[error("the processes cannot go on together: {0}")]
    Cluster(String),
    /// The operating system gave no threads.
    #[error("cannot start the worker threads: {0}")]
    Threads(String),
}

/// How a property was judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It holds on every run.
    Holds,
    /// It is violated; there is a counterexample.
    Violated,
    /// Its condition never holds, so it says nothing.
    Vacuous,
    /// What was looked for exists.
    Reached,
    /// What was looked for does not exist.
    Unreachable,
    /// A limit was reached first.
    Inconclusive,
}

/// The choices (input, value) of one cycle, in the order of their reading.
pub type Step = Vec<(u32, u32)>;

/// A run from an initial state, to be replayed with [`crate::Replay`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// Choices (input, value) of the initial state.
    pub initial: Step,
    /// Choices of each cycle; an input that is not listed was not read and has any value.
    pub steps: Vec<Step>,
    /// The steps from this one on repeat forever.
    pub loop_start: Option<usize>,
}

/// A property and its verdict.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// The property's name.
    pub id: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Cycles of the counterexample or witness, where there is one.
    pub length: Option<u64>,
    /// For a response with a bound: the least bound that holds; none if no bound does (or it is not known).
    pub bound: Option<u64>,
    /// For a response with a bound: the least number of cycles from one with `when` to the first with the goal, over all
    /// runs; 0 if one cycle can be both. None if no run gets from the one to the other (or it is not known).
    pub fastest: Option<u64>,
    /// The counterexample or witness. It may be missing where memory did not suffice to rebuild it, or where it has
    /// more than a million cycles.
    pub trace: Option<Trace>,
}

/// A fault that a reachable cycle meets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaultReport {
    /// The place, see [`crate::Fault`].
    pub code: u32,
    /// Cycles of the shortest run to it, where known.
    pub length: Option<u64>,
    /// That run.
    pub trace: Option<Trace>,
}

/// How states are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// One bit an index (and a second one where a level is wide).
    Bitmap,
    /// An exact hash set of 64-bit indices.
    Hash64,
    /// An exact hash set of 128-bit indices.
    Hash128,
    /// Intervals of the values of one timer, for each state of everything else.
    Intervals,
}

/// The answer of an exploration.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Reachable states found.
    pub states: u64,
    /// Transitions, every input combination counted (also those that need not be enumerated); saturating.
    pub transitions: u128,
    /// Cycles from the initial states to the farthest state found.
    pub depth: u32,
    /// Wall time.
    pub seconds: f64,
    /// Whether every reachable state was explored and every property decided.
    pub complete: bool,
    /// Whether a checkpoint was written from which the search can be continued where it ended.
    pub resumable: bool,
    /// For each rule in how many transitions (weighted as above, saturating) it fired.
    pub coverage: Vec<u64>,
    /// The number of states whose only successor is the state itself.
    pub absorbing: u64,
    /// The first absorbing states in the order of their indices.
    pub absorbing_examples: Vec<Vec<i32>>,
    /// The most bytes the explorer's tables held, those of properties and graphs included.
    pub memory: u64,
    /// Bytes of the states at the end of the search in this process. Next to nothing where the search was continued from
    /// its end.
    pub stored: u64,
    /// How states were stored.
    pub storage: Storage,
    /// The number of indices of the state variables.
    pub index_space: u128,
    /// Faults by code.
    pub faults: Vec<FaultReport>,
    /// Verdicts in the order of the properties.
    pub properties: Vec<Judgement>,
}

impl Report {
    /// The report on an exploration of nothing: complete, and nothing found.
    pub fn nothing() -> Self {
        Report {
            states: 0,
            transitions: 0,
            depth: 0,
            seconds: 0.0,
            complete: true,
            resumable: false,
            coverage: Vec::new(),
            absorbing: 0,
            absorbing_examples: Vec::new(),
            memory: 0,
            stored: 0,
            storage: Storage::Bitmap,
            index_space: 0,
            faults: Vec::new(),
            properties: Vec::new(),
        }
    }

    /// Bytes of storage for each reachable state.
    pub fn bytes_per_state(&self) -> f64 {
        self.stored as f64 / self.states.max(1) as f64
    }

    /// The verdict on the property named `id`.
    pub fn judgement(&self, id: &str) -> Option<&Judgement> {
        self.properties.iter().find(|p| p.id == id)
    }
}
