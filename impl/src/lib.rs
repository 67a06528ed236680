//! Safety monitors of machine-tool drives: no_std, integer, no allocation, no panic, with contracts.
//!
//! One module is one safety function of one monitoring channel of the SINUMERIK 840D / SIMODRIVE 611 digital family:
//!
//! | module | safety function | steps after |
//! | --- | --- | --- |
//! | [`gear`] | gear stage of a selector gearbox and its change event | - |
//! | [`agreement`] | user agreement | `gear` |
//! | [`mod@reference`] | axis referencing up to "safely referenced" | `agreement` of both channels |
//! | [`external`] | external stops by signal, reaction to errors of the safe logic | - |
//! | [`fault`] | STOP F: reaction to a discrepancy between the channels | - |
//! | [`stop`] | arbitration of all stop requests, STOP A to E with their timers | `external`, `fault` |
//! | [`selection`] | selection of operating stop and speed stage with its delays | `stop` |
//!
//! Every module has a validated `Config`, plain `Copy` data `State` and `Inputs`, `Outputs`, and the pure function
//! `next(state, &config, &inputs) -> (state, outputs)`, which advances the function by one monitoring cycle and carries the
//! contract (see [`contract`]). `Monitor` wraps it for firmware. Each module implements the recommended reading of every
//! ambiguity of the manual; its documentation names them.
//!
//! Conventions common to all modules:
//!
//! * One call is one monitoring cycle (T_SI). Durations are [`kernel::Cycles`].
//! * A timer started with t expires t cycles after the cycle of its start; t = 0 expires in the cycle of the start.
//! * `power_on` first sets everything volatile to its initial value (which acknowledges every stop); requests received
//!   from the other channel are ignored in that cycle; then the cycle is evaluated with its other inputs.
//! * Selection signals are "de-select" signals: 0 (`false`) means selected, so that a lost signal selects (S840D-ARCH-504).
#![cfg_attr(not(any(test, kani)), no_std)]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[macro_use]
pub mod contract;
pub mod agreement;
pub mod external;
pub mod fault;
pub mod gear;
pub mod kernel;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod reference;
pub mod selection;
pub mod stop;
