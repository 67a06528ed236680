//! From tables to systems and from explorations to answers: what stands between the specification and the explorer.
//!
//! The way of a check: [`subject`] loads a file and everything to be explored for it, [`check`] explores each [`table`] as a
//! whole or reduced ([`reduce`]), and judges its properties. What the answer is told in is no matter of this crate.

pub mod check;
mod checked;
mod cycles;
mod digest;
pub mod excluded;
mod explore;
pub mod keep;
mod known;
pub mod lines;
mod outcome;
pub mod pairs;
pub mod readings;
pub mod reduce;
mod settings;
mod staged;
mod stated;
pub mod subject;
pub mod table;
mod tasks;
pub mod theorems;

pub use cycles::{Cycle, lazy, replay};
pub use explore::{run, run_together};
pub use known::Known;
pub use outcome::{Evaluator, Explored, Outcome, Pair, Reduction, Reductions, label, verdict_name};
