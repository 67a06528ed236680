//! Stillpoint proves that a machine stops: model checker and differential checker of drive safety functions.
//!
//! The library behind the command line: [`subject`] loads what a command works on, [`check`] explores it, [`report`] and
//! [`timing`] show the result.

pub mod acceptance;
pub mod atomic;
pub mod certificate;
pub mod check;
pub mod diff;
pub mod engine;
pub mod excluded;
pub mod explore;
pub mod export;
pub mod families;
pub mod guarantees;
pub mod keep;
pub mod matrix;
pub mod pages;
pub mod plant;
pub mod reaction;
pub mod readings;
pub mod recorded;
pub mod recording;
pub mod reduce;
pub mod replay;
pub mod report;
pub mod simulate;
pub mod states;
pub mod subject;
pub mod timing;
pub mod topics;
