//! Certificates of the proof engines: invariants that are checked without enumerating states.
//!
//! The tables become functions of bits once more, by code that shares nothing with the engines. A claim that something is never seen
//! has an invariant: clauses over the state. Three things have to be shown, each as clauses that nothing satisfies: it is not false at
//! the start, no cycle leads out of it, and it excludes what must not be seen. A solver has found out that nothing satisfies them;
//! what it has learnt on the way, its lemmas, stands in the certificate, and each one follows from the ones before by unit propagation.
//!
//! A claim that something can always be reached has regions of states beside the invariant, with the inputs that lead out of each; one
//! about a response without a bound has a measure.
//!
//! That state variables keep to their ranges is not shown but given: a cycle in which an assignment leaves its range has no successor.
//!
//! To be read in this order: [`format`] (the file), [`read`], [`clause`], [`gates`], [`word`], [`symbolic`] (the tables), [`target`] and
//! [`question`], [`duty`] and [`ways`] (what has to be shown), [`rup`], [`check`].

pub mod check;
pub mod clause;
pub mod duty;
pub mod format;
pub mod gates;
pub mod question;
pub mod read;
pub mod rup;
pub mod symbolic;
pub mod target;
pub mod ways;
pub mod word;
