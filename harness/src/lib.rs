//! Stillpoint proves that a machine stops: model checker and differential checker of drive safety functions.
//!
//! What the commands are made of: [`report`] and [`timing`] tell the result of a check, [`diff`] compares monitors with tables,
//! [`simulate`] runs whole machines of the [`families`], and so on. The exploration itself is in the crate `stillpoint-engine`.

pub mod acceptance;
pub mod atomic;
pub mod browse;
pub mod certificate;
pub mod diff;
pub mod export;
pub mod families;
pub mod guarantees;
pub mod matrix;
pub mod pages;
pub mod params;
pub mod plant;
pub mod product;
pub mod proof;
pub mod reaction;
pub mod recording;
pub mod replay;
pub mod report;
pub mod simulate;
pub mod states;
pub mod sweep;
pub mod theorems;
pub mod timing;
