//! The monitors of the functions, and what is not the same in their tables.

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::{Made, Params};

/// None yet.
pub(super) const MACHINES: &[(&str, &str)] = &[];

/// The monitor of a machine.
pub(super) fn make(_machine: &str, _params: &Params, _mutant: Option<Mutant>) -> Made {
    Ok(None)
}
