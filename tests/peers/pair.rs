//! Both channels of an axis: the production pair against the systems composed for it, in parts.

use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::diff::peer;
use stillpoint_harness::diff::slices::slices;
use stillpoint_harness::diff::{Compared, Pairing, exhaustive, pairings};
use stillpoint_harness::families;
use stillpoint_model::{Options, Until};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_tests::root;

const FILES: [&str; 2] = [
    "spec/families/sinumerik-840d/pair.toml",
    "spec/families/sinumerik-840d/pair-reference.toml",
];

/// The parts of both systems, in the order of the slices.
fn parts() -> Vec<Pairing> {
    let mut parts = Vec::new();
    for file in FILES {
        let subject =
            subject::load(&root().join(file), &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
        let all = pairings(&subject).unwrap_or_else(|e| panic!("{e}"));
        for system in all.iter().filter(|p| p.machine.starts_with("pair_")) {
            parts.extend(slices(system).unwrap_or_else(|e| panic!("{e}")));
        }
    }
    assert_eq!(parts.len(), PARTS);
    parts
}

fn compare(part: &Pairing, mutant: Option<Mutant>) -> Compared {
    let options = Options {
        witnesses: false,
        until: Until::Decided,
        ..Options::default()
    };
    exhaustive(part, mutant, &options, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

/// No reachable pair of this part differs.
fn holds(number: usize) {
    let start = std::time::Instant::now();
    let compared = compare(&parts()[number], None);
    println!(
        "part {number}, {}: {} pairs, {} cycles, {:.1} s",
        compared.machine,
        compared.pairs,
        compared.cycles,
        start.elapsed().as_secs_f64()
    );
    if let Some(diagram) = &compared.divergence {
        panic!("part {number}\n{}", diagram.text());
    }
    assert!(
        compared.complete && compared.pairs > 1000 && compared.outputs > compared.cycles,
        "{compared:?}"
    );
}

/// A test for each part.
macro_rules! parts {
    ($($(#[$attribute:meta])* $name:ident: $number:literal;)+; slow $($slow:ident: $large:literal;)+) => {
        const PARTS: usize = [$($number,)+ $($large),+].len();

        $(
            #[test]
            $(#[$attribute])*
            fn $name() {
                holds($number);
            }
        )+

        /// What takes a minute: `.ci/run` has it beside the daily tests.
        mod slow {
            $(
                #[test]
                #[ignore = "slow: a step of .ci/run"]
                fn $slow() {
                    super::holds($large);
                }
            )+
        }
    };
}

parts! {
    external_stops: 0;
    #[ignore = "deep: minutes"]
    stops_of_the_monitors: 1;
    #[ignore = "deep: minutes"]
    tolerance_time_of_the_stops: 2;
    #[ignore = "deep: minutes"]
    tolerance_time_of_the_selection: 3;
    #[ignore = "deep: minutes"]
    test_stops: 5;
    test_of_the_external_shutdown: 6;
    safe_logic: 7;
    #[ignore = "deep: a minute"]
    agreement: 8;
    stored_position: 9;
    lost_reference_and_parking: 10;
    gear_stages: 11;
    motion_with_gear_stages: 12;
    ; slow
    motion_under_the_operating_stop: 4;
    limit_positions: 13;
}

/// Each wrong coupling, and the part that has what it needs.
const WRONG: [(&str, usize); 13] = [
    ("pair-stop-late", 1),
    ("pair-request-late", 0),
    ("pair-request-passed-back", 0),
    ("pair-own-request-read", 0),
    ("pair-test-passed-on", 5),
    ("pair-fault-not-told", 0),
    ("pair-fault-late", 0),
    ("pair-reset-while-other-brakes", 1),
    ("pair-own-agreement-read", 8),
    ("pair-history-not-compared-in-drive", 9),
    ("pair-change-not-told", 3),
    ("pair-test-result-lost", 5),
    ("pair-nothing-told", 0),
];

/// Those that show late in a large part.
const WRONG_LATE: [(&str, usize); 2] = [("pair-agreement-stale", 8), ("pair-lists-apart", 1)];

fn are_found(wrong: &[(&str, usize)]) {
    let parts = parts();
    for (name, part) in wrong {
        let mutant = peer::mutant(name).unwrap_or_else(|e| panic!("{name}: {e}"));
        let found = compare(&parts[*part], Some(mutant)).divergence;
        let diagram = found.unwrap_or_else(|| panic!("{name} survives"));
        assert!(diagram.text().contains('^'), "{name}");
    }
}

#[test]
fn wrong_couplings_are_found() {
    let all = families::mutants().filter(|m| m.monitor == "pair");
    let mut names: Vec<&str> = all.map(|m| m.name).collect();
    let mut known: Vec<&str> = WRONG
        .iter()
        .chain(&WRONG_LATE)
        .map(|(name, _)| *name)
        .collect();
    names.sort_unstable();
    known.sort_unstable();
    assert_eq!(names, known);
    are_found(&WRONG);
}

#[test]
#[ignore = "deep: a minute"]
fn wrong_couplings_that_show_late_are_found() {
    are_found(&WRONG_LATE);
}
