//! The families of drives that the harness has code for: a registry, one entry a family.
//!
//! Everything that is code of a family stands in its own module, its room, and is reached through its [`Family`]: its monitors as
//! [`Peers`] of its tables, and what its whole machines are to the commands, as a [`Drive`]. Only this file names families.

mod drive;
pub mod heidenhain;
pub mod iec;
pub mod sinamics;
pub mod sinumerik;
pub mod srm;
mod values;

use stillpoint_machine::Machine;
use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::Peers;
pub use drive::*;

/// The families with monitors. A new one is registered here, and nowhere else in the harness.
pub static FAMILIES: [&Family; 5] = [
    &sinumerik::FAMILY,
    &heidenhain::FAMILY,
    &sinamics::FAMILY,
    &srm::FAMILY,
    &iec::FAMILY,
];

/// A family of drives: what of it is code.
pub struct Family {
    /// Its name in a machine file, and the folder of its tables: the first part of their names.
    pub name: &'static str,
    /// The module of its monitors.
    pub module: &'static str,
    /// Its monitors as peers of its tables, for `diff`: none while the family is under construction.
    pub peers: Peers,
    /// Its deliberately wrong monitors.
    pub mutants: fn() -> Vec<Mutant>,
    /// What its whole machines are to the commands; none where its monitors run no whole axes.
    pub drive: Option<&'static dyn Drive>,
}

/// What runs whole machines of the family of a machine.
///
/// # Errors
/// A sentence: its whole axes cannot be run, and what can be done instead.
pub fn of(machine: &Machine) -> Result<&'static dyn Drive, String> {
    let family = FAMILIES.into_iter().find(|f| f.name == machine.family);
    family.and_then(|family| family.drive).ok_or_else(|| {
        format!(
            "{}: no production monitors run the axes of the family {}; there are check, reaction, acceptance and explore",
            machine.name, machine.family
        )
    })
}

/// The family with monitors that a machine, a system or a file of its tables belongs to, by its full name.
pub fn of_table(name: &str) -> Option<&'static Family> {
    let folder = name.split('/').next()?;
    FAMILIES.into_iter().find(|family| family.name == folder)
}

/// The family of a wrong monitor.
pub fn of_mutant(mutant: Mutant) -> Option<&'static Family> {
    FAMILIES.into_iter().find(|f| f.module == mutant.family)
}

/// Every deliberately wrong monitor, family by family.
pub fn mutants() -> impl Iterator<Item = Mutant> {
    FAMILIES.into_iter().flat_map(|family| (family.mutants)())
}
