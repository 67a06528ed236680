//! Safety functions of IEC 61800-5-2 that no manual of the other families describes: SSR, SLT, STR, SLA, SAR, SMT, SCA and SLI.
//!
//! The names are those of the standard, each definition is this project's own (`spec/families/iec-61800-5-2`). One module is one
//! function of one channel; a step is one monitoring cycle.
//!
//! | module | what |
//! | --- | --- |
//! | [`window`] | a value stays in a range: SSR (speed), STR and SLT (torque), SAR and SLA (acceleration) |
//! | [`acceleration`] | the acceleration that SAR and SLA look at, from the speeds of two cycles |
//! | [`temperature`] | SMT: temperature of the motor |
//! | [`cam`] | SCA: whether the position is within a range |
//! | [`increment`] | SLI: one increment a start, rest between |
//! | [`common`] | values, edges, latched demands: no step |
//!
//! Conventions:
//!
//! * Both channels run the same monitors on their own inputs. None has an input of the other channel, so nothing that one channel does
//!   takes back what the other demands; the drive stops where either demands it (IEC-MON-012).
//! * A time counts the cycles since the one that started it and is over in the first that reaches it: a time of `n` cycles that starts
//!   in cycle `k` is over in cycle `k + n`.
//! * A limit itself is kept (IEC-MON-003).
//! * `power_on` is 1 in the first cycle after the power has returned. That cycle begins from the initial state and is judged like every
//!   other: what has no delay is in force in it (IEC-MON-010, the reading that judges earlier).
//! * Monitors demand a stop and latch the demand. Which stop function answers is a matter of the wiring (IEC-MON-006).

/// Hands the monitors of the functions of IEC 61800-5-2 to a macro, after the name of the family and what else is given: the list
/// that says which there are. Each is a module with a `Monitor` that is a [`Contract`](crate::contract::Contract).
#[macro_export]
macro_rules! iec_monitors {
    ($callback:ident $($more:tt)*) => { $callback! { iec [$($more)*]
        window acceleration temperature cam increment
    } };
}

pub mod acceleration;
pub mod cam;
pub mod common;
pub mod increment;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod temperature;
pub mod window;
