//! Fail-safe blocks for storage and retrieval machines (library for SIMATIC Safety, V2.1).
//!
//! One module is one block of the library, exact to the call: a call is one execution of the safety program, `T_SAMPLE` after the
//! one before.
//!
//! | module | block |
//! | --- | --- |
//! | [`safe_pos`] | F_SAFE_POS (FB200): safe position and velocity from two or three encoders |
//! | [`slp_monitor`] | F_SLP_MONITOR (FB201): a range of positions with retraction |
//! | [`endzone`] | F_ENDZONE (FB202): a range with a velocity envelope before its ends |
//! | [`sbr_monitor`] | F_SBR_MONITOR (FB207): whether a drive brakes along its ramp |
//! | [`brake_test`] | F_BRAKE_TEST (FB203): the safe brake test of two brakes |
//! | [`load_monitor`], [`load_calibration`] | F_LOAD_MONITOR (FB204): overload and slack rope; the test of the measuring equipment |
//! | [`min_max`] | F_MIN_MAX (FC206): least or greatest of eight values |
//! | [`interpolation`] | F_INTERPOLATION (FC200): a velocity limit between 17 points |
//! | [`add_dint`], [`sub_dint`], [`mul_dint`], [`div_dint`] | LFAddDInt to LFDivDInt (FC211 to FC214): arithmetic with an overflow flag |
//! | [`common`], [`dint`], [`retraction`] | what blocks have in common: no step |
//!
//! Conventions common to the blocks:
//!
//! * Parameters are those that are fixed at run time (SRM-PARAM-002): they make the `Config`, which takes every value that the block
//!   takes. A wrong one is no error of the constructor; the block tells it by its bit of `DIAG`, from the first call on, for ever
//!   (SRM-PARAM-001, SRM-PARAM-003), since the parameters of a monitor cannot change.
//! * Numbers are those of the blocks: DInt in mm, mm/min, ms. A result that is no DInt is a calculation fault, never a wrapped value
//!   (SRM-LFMATH-003); comparisons are exact.
//! * In a call: inputs, conditions, one row of the state machine, conditions that need the new state, latches, outputs. A condition
//!   sets its latch in the call in which it is read, whoever acknowledges; commands are edges, and an edge that finds nothing to do is
//!   lost.

/// Hands the monitors of the fail-safe blocks for storage and retrieval machines to a macro, after the name of the family and what
/// else is given: the list that says which there are. Each is a module with a `Monitor` that is a
/// [`Contract`](crate::contract::Contract).
#[macro_export]
macro_rules! srm_monitors {
    ($callback:ident $($more:tt)*) => { $callback! { srm [$($more)*]
        add_dint sub_dint mul_dint div_dint min_max interpolation
        safe_pos slp_monitor endzone sbr_monitor brake_test load_monitor load_calibration
    } };
}

pub mod add_dint;
pub mod brake_test;
pub mod common;
pub mod dint;
pub mod div_dint;
pub mod endzone;
pub mod interpolation;
pub mod load_calibration;
pub mod load_monitor;
pub mod min_max;
pub mod mul_dint;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod retraction;
pub mod safe_pos;
pub mod sbr_monitor;
pub mod slp_monitor;
pub mod sub_dint;
