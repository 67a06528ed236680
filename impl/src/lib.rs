//! Safety monitors of machine-tool drives: no_std, integer, no allocation, no panic, with contracts.
//!
//! | module | what |
//! | --- | --- |
//! | [`sinumerik`] | SINUMERIK 840D / SIMODRIVE 611 digital: one module is one safety function of one monitoring channel |
//! | [`heidenhain`] | HEIDENHAIN Functional Safety (iTNC 530 HSCI): one module is one safety function of one channel |
//! | [`sinamics`] | SINAMICS S120: one module is one safety function of one channel |
//! | [`srm`] | fail-safe blocks for storage and retrieval machines: one module is one block |
//! | [`iec`] | functions of IEC 61800-5-2 that none of these has: one module is one safety function of one channel |
//! | [`kernel`] | what the monitors of every family are made of: durations, positions, speeds, windows, timers |
//! | [`units`] | user values to increments, rounded to the safe side |
//! | [`contract`] | how a step carries its contract |
//! | [`fields`] | the types of the monitors as numbers with names |
//!
//! A family uses nothing of another one.
//!
//! Every module has a validated `Config`, plain `Copy` data `State` and `Inputs`, `Outputs`, and the pure function
//! `next(state, &config, &inputs) -> (state, outputs)`, which advances the function by one monitoring cycle and carries the
//! contract (see [`contract`]). `Monitor` wraps it for firmware. Each module implements the recommended reading of every
//! ambiguity of the manual; its documentation names them.
//!
#![cfg_attr(not(any(test, kani)), no_std)]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[macro_use]
pub mod fields;
#[macro_use]
pub mod contract;
#[cfg(feature = "mutants")]
#[macro_use]
pub mod mutant;
pub mod heidenhain;
pub mod iec;
pub mod kernel;
pub mod sinamics;
pub mod sinumerik;
pub mod srm;
pub mod units;
