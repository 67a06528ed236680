//! SINAMICS S120: the safety functions integrated in the drive, Basic and Extended.
//!
//! One module is one function of one of the two channels, which run the same functions on their own inputs. A step is one monitoring
//! cycle: p9500 of the Extended Functions, r9780 of the Basic ones (S120-TIMING-002).
//!
//! | module | what |
//! | --- | --- |
//! | [`sto`], [`sbc`] | safe torque off; the brake that follows it |
//! | [`ss1_basic`], [`ss1`] | safe stop 1 by time, and with monitored braking: also STOP B |
//! | [`ss2`], [`sos`] | safe stop 2, its external form, STOP C to E; the operating stop that they end in |
//! | [`sam`], [`sbr`] | what monitors braking: the acceleration, or the ramp |
//! | [`sls`], [`sls_ramp`] | safely limited speed with a delay, and without encoder with a ramp |
//! | [`setpoint_limit`] | what SLS and SDI leave of the setpoint |
//! | [`ssm`], [`sdi`] | speed below a limit; motion in one direction only |
//! | [`slp`], [`reference`], [`safe_position`] | range of positions with retraction; safe referencing; the transferred position |
//! | [`actual_value`], [`gear`] | comparison of the actual values of both channels; gear stages |
//! | [`encoderless`], [`start_phase`] | a drive without encoder after the suppression of its pulses; and after they have come again |
//! | [`drive_test`], [`path_test`] | test stop of the Extended Functions; test of the paths by the Basic ones |
//! | [`brake_test`], [`brake_test_request`] | safe brake test; its request by the test stop |
//! | [`data_set`] | change of the drive data set |
//! | [`control`] | inputs, selection, stop priorities, acknowledgement, restart, supervision of the communication, messages, modes |
//! | [`telegram`] | what goes over the bus, bit by bit: no step |
//! | [`types`], [`times`] | what functions have in common; sampling times: no step |
//!
//! Conventions:
//!
//! * A selection is true where its signal is 0. Within a cycle: selections, monitors, what they raise; the cycle of a violation is the
//!   cycle of its stop.
//! * A time counts the cycles since the one that started it and is over in the first that reaches it: a time of `n` cycles that starts
//!   in cycle `k` is over in cycle `k + n`.
//! * Speeds are magnitudes in increments per cycle on the side of the load. Comparisons are strict: a limit itself is kept.
//! * Monitors raise stops, the arbiter latches them: the inputs `stop`, `stop_a`, `stop_b` are what it has latched.
//! * Each module names the readings of the manual's ambiguities (AF-nn) that it implements. Readings that differ in behaviour are
//!   choices of its configuration, the recommended one first.

/// Hands the monitors of SINAMICS S120 to a macro, after the name of the family and what else is given: the list that says which
/// there are. Each is a module with a `Monitor` that is a [`Contract`](crate::contract::Contract).
#[macro_export]
macro_rules! sinamics_monitors {
    ($callback:ident $($more:tt)*) => { $callback! { sinamics [$($more)*]
        sto sbc ss1_basic ss1 ss2 sos sam sbr sls sls_ramp setpoint_limit ssm sdi
        slp reference safe_position actual_value gear encoderless start_phase drive_test path_test brake_test
        brake_test_request data_set
        input_filter terminal_pair chatter basic_selection basic_stop fail_safe_input fail_safe_output safe_state
        stop_arbiter cross_check acknowledgement_edge acknowledgement restart communication io_test message_buffer
        acceptance_mode commissioning replacement
    } };
}

pub mod actual_value;
pub mod brake_test;
pub mod brake_test_request;
pub mod control;
pub mod data_set;
pub mod drive_test;
pub mod encoderless;
pub mod gear;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod path_test;
pub mod reference;
pub mod safe_position;
pub mod sam;
pub mod sbc;
pub mod sbr;
pub mod sdi;
pub mod setpoint_limit;
pub mod slp;
pub mod sls;
pub mod sls_ramp;
pub mod sos;
pub mod ss1;
pub mod ss1_basic;
pub mod ss2;
pub mod ssm;
pub mod start_phase;
pub mod sto;
pub mod telegram;
pub mod times;
pub mod types;

pub use control::*;
