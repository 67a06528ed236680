//! Exploring what decides single guarantees of a machine.

use std::path::Path;
use std::sync::{Arc, LazyLock};

use stillpoint_engine::Known;
use stillpoint_engine::check::{Checked, Settings, check};
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::{Machine, Run};
use stillpoint_model::{Until, Verdict};

/// What the tests of this binary have explored: a change of one value leaves most explorations of a machine as they are.
static KNOWN: LazyLock<Arc<Known>> = LazyLock::new(Arc::default);

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
    explored(path, machine, &runs, settings)
}

/// Whether a guarantee of a machine of this file is violated. The first exploration that violates it is enough; there are many
/// machines to look at, so each has one thread.
///
/// # Panics
/// If one cannot be explored.
pub fn is_violated(path: &Path, machine: &Machine, name: &str) -> bool {
    let settings = Settings {
        threads: 1,
        until: Until::Violated,
        ..Settings::default()
    };
    let mut runs = machine.runs.iter();
    runs.any(|run| {
        run.guarantee.as_deref() == Some(name) && {
            let runs = std::slice::from_ref(run);
            let (subject, checked) = explored(path, machine.clone(), runs, &settings);
            let mut answers = answers(&subject, &checked).into_iter();
            answers.any(|a| a.verdict == Verdict::Violated)
        }
    })
}

fn explored(
    path: &Path,
    machine: Machine,
    runs: &[Run],
    settings: &Settings,
) -> (Subject, Vec<Checked>) {
    let mut subject =
        subject::of_runs(path, machine, runs, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        known: Some(KNOWN.clone()),
        ..settings.clone()
    };
    let checked = check(&mut subject, &settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    (subject, checked)
}
