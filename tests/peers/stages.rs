//! The cycles of a state one by one and in stages: the same report, to the last count and run.

use std::sync::atomic::{AtomicUsize, Ordering};

use stillpoint_engine::table::Interpreted;
use stillpoint_engine::{Outcome, run};
use stillpoint_lang::bind::Bound;
use stillpoint_model::{Options, System, Way};
use stillpoint_tests::peer::each;

use crate::reductions::shipped::{must_fail, shipped};

/// The exploration of a system in stages.
pub(crate) fn staged(bound: &Bound, witnesses: bool) -> Outcome {
    staged_within(bound, witnesses, None)
}

/// The same within so many bytes, an eighth of which is for what is known of stages.
fn staged_within(bound: &Bound, witnesses: bool, memory: Option<u64>) -> Outcome {
    let mut options = Options {
        way: Way::Staged,
        witnesses,
        ..Options::default()
    };
    options.limits.threads = 2;
    options.limits.memory = memory;
    run(bound, &options, true, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

/// Compares two reports of one system; the runs too, if both have them.
pub(crate) fn same(single: &Outcome, staged: &Outcome, context: &str) {
    let (a, b) = (&single.report, &staged.report);
    assert_eq!(
        (a.complete, a.states, a.transitions, a.depth),
        (b.complete, b.states, b.transitions, b.depth),
        "{context}"
    );
    assert_eq!(a.coverage, b.coverage, "{context}");
    assert_eq!(
        (a.absorbing, &a.absorbing_examples),
        (b.absorbing, &b.absorbing_examples),
        "{context}"
    );
    assert_eq!(a.faults, b.faults, "{context}");
    assert_eq!(a.properties, b.properties, "{context}");
    assert_eq!(single.refuted, staged.refuted, "{context}");
}

/// Whether a system has stages at all.
pub(crate) fn has_stages(bound: &Bound) -> bool {
    Interpreted::new(bound).stages(&[]).is_some()
}

/// Compares all of these; the answer is how many have stages.
fn compare(systems: &[(Bound, Outcome)]) -> usize {
    let with: Vec<&(Bound, Outcome)> = systems.iter().filter(|(b, _)| has_stages(b)).collect();
    each(&with, |(bound, single)| {
        same(single, &staged(bound, false), &bound.system.name);
    });
    with.len()
}

#[test]
fn shipped_systems_have_the_same_reports() {
    let compared = compare(shipped());
    println!("{compared} of {} systems have stages", shipped().len());
    assert!(compared >= 20, "{compared}");
}

/// Bytes for an exploration.
const FORGETFUL: u64 = 4 << 20;

/// What is known of stages has so little room that it is forgotten again and again.
#[test]
fn what_is_forgotten_is_counted() {
    let compared = AtomicUsize::new(0);
    let with: Vec<&(Bound, Outcome)> = shipped().iter().filter(|(b, _)| has_stages(b)).collect();
    each(&with, |(bound, single)| {
        let staged = staged_within(bound, false, Some(FORGETFUL));
        if staged.report.complete {
            same(single, &staged, &bound.system.name);
            compared.fetch_add(1, Ordering::Relaxed);
        }
    });
    let compared = compared.into_inner();
    assert!(compared >= 20, "{compared}");
}

#[test]
fn must_fail_systems_have_the_same_reports() {
    let compared = compare(must_fail());
    println!("{compared} of {} systems have stages", must_fail().len());
    // Most of them are one machine, which has no stages.
    assert!(compared >= 4, "{compared}");
}
