//! The shipped specifications and the must-fail set, with the evaluator a check would use.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use stillpoint_engine::Outcome;
use stillpoint_engine::Reductions;
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_tests::peer::each;
use stillpoint_tests::{exceptions, files, specification_files};

use super::{SLICE, SYMMETRY, YARDSTICK, compare, full, of, reduced};

/// Systems with more transitions than this are not explored several times here: they are exceptions.
const MOST: u128 = 6_000_000;

/// The shipped systems that are small enough, each with its unreduced exploration, made once for all tests.
pub(crate) fn shipped() -> &'static [(Bound, Outcome)] {
    static SHIPPED: OnceLock<Vec<(Bound, Outcome)>> = OnceLock::new();
    SHIPPED.get_or_init(|| {
        let too_large = exceptions("reductions");
        let mut left_out = BTreeSet::new();
        let mut systems = Vec::new();
        for path in specification_files() {
            let spec = Spec::load(&path).unwrap_or_else(|e| panic!("{e}"));
            for bound in of(&spec) {
                if too_large.contains(&bound.system.name) {
                    left_out.insert(bound.system.name);
                } else {
                    systems.push(bound);
                }
            }
        }
        assert_eq!(left_out, too_large);
        whole(systems)
    })
}

/// Systems with their unreduced explorations.
fn whole(systems: Vec<Bound>) -> Vec<(Bound, Outcome)> {
    let outcomes = each(&systems, |bound| full(bound, false));
    let all: Vec<(Bound, Outcome)> = systems.into_iter().zip(outcomes).collect();
    let large: Vec<&str> = (all.iter())
        .filter(|(_, whole)| whole.report.transitions > MOST)
        .map(|(bound, _)| bound.system.name.as_str())
        .filter(|name| *name != YARDSTICK)
        .collect();
    assert!(large.is_empty(), "to be left out: {large:?}");
    all
}

/// Compares each system with its reductions.
fn check(systems: &[(Bound, Outcome)]) {
    each(systems, |(bound, whole)| {
        let name = &bound.system.name;
        let mut changed = 0;
        for how in [SLICE, SYMMETRY, Reductions::ALL] {
            // Where only one of them does something, both together are that one.
            if how == Reductions::ALL && changed < 2 {
                continue;
            }
            let part = reduced(bound, false, how);
            compare(bound, whole, &part, &format!("{name} with {how:?}"));
            let reduction = part.reduction.as_ref().expect("it was asked for");
            if reduction.whole.is_none() {
                changed += 1;
                let (now, before) = (part.report.states, whole.report.states);
                println!("{name} {how:?}: {now} states in place of {before}");
            }
        }
    });
}

#[test]
fn shipped_systems_have_the_same_verdicts() {
    check(shipped());
    assert!(shipped().len() >= 20, "{}", shipped().len());
}

/// The systems of the must-fail set with their unreduced explorations.
pub(crate) fn must_fail() -> &'static [(Bound, Outcome)] {
    static SYSTEMS: OnceLock<Vec<(Bound, Outcome)>> = OnceLock::new();
    SYSTEMS.get_or_init(|| {
        let specs = files("tests/must-fail", "toml")
            .into_iter()
            .map(|path| Spec::load(&path).unwrap_or_else(|e| panic!("{e}")));
        whole(specs.flat_map(|spec| of(&spec)).collect())
    })
}

#[test]
fn must_fail_systems_fail_in_the_same_way() {
    let systems = must_fail();
    check(systems);
    assert!(systems.len() >= 15, "{}", systems.len());
}
