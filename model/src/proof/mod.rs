//! The proof engines: symbolic answers where the states are too many to be enumerated.
//!
//! A system is a [`Netlist`]: bits of the state and what they become in a cycle, as functions in an and-inverter [`Graph`] (`graph`),
//! numbers as [`Word`]s over it (`word`). A [`Problem`] asks whether a run ends in a cycle with something bad, and is cut down to
//! what that depends on. Three engines answer:
//!
//! * [`Bounded`]: runs of rising length, by a SAT solver; what it finds first is a shortest run (bounded model checking);
//! * [`induction`]: k good cycles are followed by another one (k-induction over simple paths);
//! * [`reachability`]: property-directed reachability (IC3), which finds an [`Invariant`] or a run, of any length.
//!
//! [`ways`] shows that something can always be reached, by a ranking function in pieces.
//!
//! [`inductive`] finds which of many candidates are invariants together: what is known beforehand makes questions easier.
//!
//! What a run or an invariant shows is checked by other code: [`Problem::shows`], [`Invariant::check`]; [`lemmas`] tells what the solver
//! learns, so that somebody else can check it. `aiger` writes netlists for
//! other tools. Answers do not depend on time, except that a [`Budget`] may be spent before there is one.

pub mod aiger;
mod bdd;
mod bounded;
mod graph;
mod houdini;
mod invariant;
mod lemmas;
mod netlist;
mod pdr;
mod recovery;
mod sat;
mod simulate;
mod unroll;
mod word;

pub use bdd::{Condition, Lasso, States};
pub use bounded::{Bounded, Induction, induction};
pub use graph::{Graph, Lit, Node, value};
pub use houdini::{Candidates, inductive};
pub use invariant::{Defect, Invariant};
pub use lemmas::lemmas;
pub use netlist::{Input, Latch, Netlist, Problem, Run};
pub use pdr::{Effort, Reachability, reachability};
pub use recovery::{Rank, Recovery, Step, Values, Ways, ways};
pub use sat::{Budget, Spent};
pub use word::{Word, number};
