//! SINAMICS S120 Safety Integrated: drive-based safety with the functions of IEC 61800-5-2.
//!
//! [`control`] selects, arbitrates and acknowledges; [`telegram`] is what goes over the bus.

/// Hands the monitors of SINAMICS S120 to a macro, after the name of the family and what else is given: the list that says which
/// there are. Each is a module with a `Monitor` that is a [`Contract`](crate::contract::Contract).
#[macro_export]
macro_rules! sinamics_monitors {
    ($callback:ident $($more:tt)*) => { $callback! { sinamics [$($more)*]
        input_filter terminal_pair chatter basic_selection basic_stop fail_safe_input fail_safe_output safe_state
        stop_arbiter acknowledgement_edge acknowledgement restart communication io_test message_buffer
        acceptance_mode commissioning
    } };
}

pub mod control;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod telegram;

pub use control::*;
