//! The monitors of the functions, and what is not the same in their tables.

mod apart;
mod same;
mod slices;

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::{Made, Make, Params, first};
use crate::diff::slices::Slice;

/// The machines of these tables, list by list.
pub(super) const SAME: &[(&str, &str)] = same::MACHINES;
pub(super) const APART: &[(&str, &str)] = apart::MACHINES;

/// SLS and its ramp are one monitor.
pub(super) const SYSTEMS: &[(&str, &str)] = apart::SYSTEMS;

/// What of them is explored.
pub(super) const SLICES: &[Slice] = slices::SLICES;

/// The monitor of a machine or system.
pub(super) fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    let all: [Make; 2] = [same::make, apart::make];
    first(&all, machine, params, mutant)
}
