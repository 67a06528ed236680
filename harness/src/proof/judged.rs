//! What the engines are asked, and what they answer.

use std::time::Duration;

use stillpoint_model::proof::{Invariant, Rank, Ways};
use stillpoint_model::{Interrupt, Trace, Verdict};

use super::Shown;

/// Which engine is to judge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// The explorer, for every property.
    Explorer,
    /// Runs of rising length: finds shortest runs, proves nothing.
    Bmc,
    /// k-induction.
    Induction,
    /// Property-directed reachability.
    Pdr,
    /// Sets of states as binary decision diagrams: counts them, too.
    Bdd,
    /// For each property the engine that decides it: property-directed reachability after short runs; sets of states, then the explorer,
    /// for what that leaves of ways back and runs without an end.
    Auto,
}

/// How to judge.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Which engine.
    pub choice: Choice,
    /// Cycles that BMC and k-induction look at.
    pub depth: usize,
    /// Wall time for everything.
    pub time: Option<Duration>,
    /// Of that for each property.
    pub each: Option<Duration>,
    /// Bytes for the explorer.
    pub memory: Option<u64>,
    /// Threads of the explorer.
    pub threads: usize,
    /// Whether it is asked too if a value leaves its range.
    pub ranges: bool,
    /// Ends everything from outside.
    pub interrupt: Option<Interrupt>,
}

impl Default for Settings {
    /// Reachability for as long as it takes, in one thread.
    fn default() -> Self {
        Settings {
            choice: Choice::Pdr,
            depth: 0,
            time: None,
            each: None,
            memory: None,
            threads: 1,
            ranges: true,
            interrupt: None,
        }
    }
}

/// What shows that something is never seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Proof {
    /// It is FALSE whatever the state.
    Nothing,
    /// So many good cycles are followed by another one, where these pairs of them begin in different states.
    Induction(usize, Vec<(usize, usize)>),
    /// This invariant, checked.
    Invariant(Invariant),
    /// From every reachable state these ways lead to the goal.
    Ways(Ways),
    /// A measure of a response without a bound, and what shows that it is one.
    Measured(Measured, Box<Proof>),
    /// All states were enumerated: so many.
    States(u64),
    /// All reachable states of what it depends on are known as a set.
    Reached {
        /// How many; none if they are more than 2^128 - 1.
        states: Option<u128>,
        /// The number of cycles to the farthest.
        cycles: usize,
    },
}

/// What shows that a response without a bound comes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Measured {
    /// How often at most a round of the fairness conditions is idle, or a number moves back.
    pub rounds: i64,
    /// Numbers that move.
    pub numbers: Vec<Rank>,
}

/// Who judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    /// The explorer.
    Explorer,
    /// Bounded model checking.
    Bmc,
    /// k-induction.
    Induction,
    /// Property-directed reachability.
    Pdr,
    /// Binary decision diagrams.
    Bdd,
}

/// A property and what was found.
#[derive(Debug, Clone)]
pub struct Judged {
    /// Its id with the number of its copy; `range` for the ranges of all assignments.
    pub id: String,
    /// In plain words.
    pub text: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Cycles of the shortest counterexample or witness.
    pub length: Option<u64>,
    /// Who judged; none if nobody has.
    pub engine: Option<Engine>,
    /// Of what holds (or is vacuous or unreachable): the proof.
    pub proof: Option<Proof>,
    /// The same for a certificate.
    pub shown: Option<Shown>,
    /// The shortest counterexample or witness.
    pub trace: Option<Trace>,
    /// Why there is no verdict, or why what is recorded of the bound is refuted.
    pub reason: Option<String>,
    /// Wall time.
    pub seconds: f64,
}
