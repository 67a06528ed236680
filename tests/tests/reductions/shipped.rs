//! The shipped specifications and the must-fail set, with the evaluator a check would use.

use std::path::{Path, PathBuf};

use stillpoint::engine::Outcome;
use stillpoint::reduce::Reductions;
use stillpoint_spec::Spec;
use stillpoint_spec::bind::Bound;
use stillpoint_tests::{files, specification_files};

use super::{SLICE, SYMMETRY, YARDSTICK, compare, full, of, reduced};

/// Systems with more transitions than this are not explored several times here.
const MOST: u128 = 50_000_000;

/// Those of the shipped specifications.
const LEFT_OUT: [&str; 16] = [
    "heidenhain-fs/composed-axes/machine_axes",
    "heidenhain-fs/composed-spindle/machine_spindle",
    "heidenhain-fs/composed/logic",
    "heidenhain-fs/faults-two-channels/fault_requests",
    "heidenhain-fs/group/axes",
    "heidenhain-fs/group/spindle",
    "sinumerik-840d/axis/channel",
    "sinumerik-840d/axis/referencing",
    "sinumerik-840d/axis/stop_group",
    "sinumerik-840d/axis/stop_pair",
    "sinumerik-840d/faults/fault_test",
    "sinumerik-840d/monitoring/axis_core",
    "sinumerik-840d/pair-reference/pair_reference",
    "sinumerik-840d/pair/pair_stops",
    "sinumerik-840d/verification/test_pair",
    "sinumerik-840d/verification/test_stop",
];

/// The systems of a file that are small enough, and the names of the others.
pub(crate) fn small(path: &Path) -> (Vec<Bound>, Vec<String>) {
    let spec = Spec::load(path).unwrap_or_else(|e| panic!("{e}"));
    let (large, small): (Vec<_>, Vec<_>) = of(&spec)
        .into_iter()
        .partition(|bound| LEFT_OUT.contains(&bound.system.name.as_str()));
    let names = large.into_iter().map(|bound| bound.system.name);
    (small, names.collect())
}

/// The unreduced exploration of one of them.
pub(crate) fn whole(bound: &Bound) -> Outcome {
    let whole = full(bound, false);
    let transitions = whole.report.transitions;
    assert!(
        transitions <= MOST || bound.system.name == YARDSTICK,
        "{} has {transitions} transitions: to be left out",
        bound.system.name
    );
    whole
}

fn check(paths: Vec<PathBuf>) -> (usize, Vec<String>) {
    let mut compared = 0;
    let mut left_out = Vec::new();
    for path in paths {
        let (systems, large) = small(&path);
        left_out.extend(large);
        for bound in systems {
            let name = &bound.system.name;
            let whole = whole(&bound);
            compared += 1;
            let mut changed = 0;
            for how in [SLICE, SYMMETRY, Reductions::ALL] {
                // Where only one of them does something, both together are that one.
                if how == Reductions::ALL && changed < 2 {
                    continue;
                }
                let part = reduced(&bound, false, how);
                compare(&bound, &whole, &part, &format!("{name} with {how:?}"));
                let reduction = part.reduction.as_ref().expect("it was asked for");
                if reduction.whole.is_none() {
                    changed += 1;
                    let (now, before) = (part.report.states, whole.report.states);
                    println!("{name} {how:?}: {now} states in place of {before}");
                }
            }
        }
    }
    (compared, left_out)
}

#[test]
fn shipped_systems_have_the_same_verdicts() {
    let (compared, mut left_out) = check(specification_files());
    println!("{compared} systems compared; left out for their size: {left_out:?}");
    left_out.sort();
    assert_eq!(left_out, LEFT_OUT);
    assert!(compared >= 20, "{compared}");
}

#[test]
fn must_fail_systems_fail_in_the_same_way() {
    let (compared, left_out) = check(files("tests/must-fail", "toml"));
    assert!(
        compared >= 15 && left_out.is_empty(),
        "{compared} {left_out:?}"
    );
}
