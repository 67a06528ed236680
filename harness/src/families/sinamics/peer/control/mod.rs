//! The monitors of the control part, and what is not the same in their tables.

mod apart;
mod composed;
mod same;
mod telegrams;

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::{Made, Make, Params, first};
use crate::diff::slices::Slice;

/// The machines of these tables, list by list.
pub(super) const SAME: &[(&str, &str)] = same::MACHINES;
pub(super) const APART: &[(&str, &str)] = apart::MACHINES;
pub(super) const TELEGRAMS: &[(&str, &str)] = telegrams::MACHINES;

/// The systems: several machines of the tables for one monitor.
pub(super) const SYSTEMS: &[(&str, &str)] = composed::SYSTEMS;

/// What of them is explored.
pub(super) const SLICES: &[Slice] = composed::SLICES;

/// The monitor of a machine or system.
pub(super) fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    let all: [Make; 4] = [same::make, apart::make, composed::make, telegrams::make];
    first(&all, machine, params, mutant)
}
