//! Exploring what decides single guarantees of a machine.

use std::path::Path;

use stillpoint_engine::check::{Checked, Settings, check};
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_machine::Machine;

/// The explorations that decide these guarantees of a machine of this file, and what they have given.
///
/// # Panics
/// If one cannot be explored.
pub fn decided(
    path: &Path,
    machine: Machine,
    names: &[&str],
    settings: &Settings,
) -> (Subject, Vec<Checked>) {
    let runs: Vec<_> = (machine.runs.iter())
        .filter(|run| run.guarantee.as_deref().is_some_and(|g| names.contains(&g)))
        .cloned()
        .collect();
    let subject =
        subject::of_runs(path, machine, &runs, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let checked = check(&subject, settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    (subject, checked)
}
