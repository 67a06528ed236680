//! The shipped specifications and the must-fail set, with the evaluator a check would use.

use std::path::PathBuf;

use stillpoint::reduce::Reductions;
use stillpoint_spec::Spec;
use stillpoint_tests::{files, specification_files};

use super::{SLICE, SYMMETRY, compare, full, of, reduced};

/// Systems with more work than this are left out here: their check takes seconds, several times.
const MOST: u128 = 2_000_000_000;

fn check(paths: Vec<PathBuf>) -> (usize, Vec<String>) {
    let mut compared = 0;
    let mut left_out = Vec::new();
    for path in paths {
        let spec = Spec::load(&path).unwrap_or_else(|e| panic!("{e}"));
        for bound in of(&spec) {
            let name = &bound.system.name;
            let whole = full(&bound, false);
            if whole.report.transitions > MOST {
                left_out.push(name.clone());
                continue;
            }
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
    let (compared, left_out) = check(specification_files());
    println!("{compared} systems compared; left out for their size: {left_out:?}");
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
