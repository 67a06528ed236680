//! Both channels of an axis: the production pair against the systems composed for it, in parts.

use stillpoint::diff::peer::Mutant;
use stillpoint::diff::slices::slices;
use stillpoint::diff::{Compared, Pairing, exhaustive, pairings};
use stillpoint::subject::{self, Readings};
use stillpoint_model::Options;
use stillpoint_tests::root;

const FILES: [&str; 2] = [
    "spec/sinumerik-840d/pair.toml",
    "spec/sinumerik-840d/pair-reference.toml",
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
    assert_eq!(parts.len(), 13);
    parts
}

fn compare(part: &Pairing, mutant: Option<Mutant>) -> Compared {
    let options = Options {
        witnesses: false,
        stop_when_decided: true,
        ..Options::default()
    };
    exhaustive(part, mutant, &options, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

/// Parts that take minutes: a deep run, with this variable set to anything.
const DEEP: &str = "STILLPOINT_DEEP";

/// These parts: a channel with stops of its monitors, tolerance time of the stops, that of the selection, test stops, gear stages,
/// limit positions. The last two have not been run to their end yet.
const LONG: [usize; 6] = [1, 2, 3, 5, 11, 12];

#[test]
fn no_reachable_pair_of_channels_differs() {
    let mut differences = String::new();
    let deep = std::env::var_os(DEEP).is_some();
    for (number, part) in parts().iter().enumerate() {
        if LONG.contains(&number) && !deep {
            println!("part {number}: not run; set {DEEP} to run it");
            continue;
        }
        let start = std::time::Instant::now();
        let compared = compare(part, None);
        println!(
            "part {number}, {}: {} pairs, {} cycles, {:.1} s",
            part.machine,
            compared.pairs,
            compared.cycles,
            start.elapsed().as_secs_f64()
        );
        match &compared.divergence {
            Some(diagram) => differences.push_str(&format!("part {number}\n{}\n", diagram.text())),
            None => assert!(
                compared.complete && compared.pairs > 1000 && compared.outputs > compared.cycles,
                "{compared:?}"
            ),
        }
    }
    assert!(differences.is_empty(), "{differences}");
}

/// Each wrong coupling, and the part that has what it needs.
const WRONG: [(&str, usize); 15] = [
    ("pair-stop-late", 1),
    ("pair-request-late", 0),
    ("pair-request-passed-back", 0),
    ("pair-own-request-read", 0),
    ("pair-test-passed-on", 5),
    ("pair-fault-not-told", 0),
    ("pair-fault-late", 0),
    ("pair-reset-while-other-brakes", 1),
    ("pair-agreement-stale", 8),
    ("pair-own-agreement-read", 8),
    ("pair-history-not-compared-in-drive", 9),
    ("pair-change-not-told", 3),
    ("pair-lists-apart", 1),
    ("pair-test-result-lost", 5),
    ("pair-nothing-told", 0),
];

#[test]
fn every_wrong_coupling_is_found() {
    let parts = parts();
    let all = Mutant::all().filter(|m| m.monitor() == "pair");
    let names: Vec<&str> = all.map(Mutant::name).collect();
    assert_eq!(names, WRONG.map(|(name, _)| name));
    for (name, part) in WRONG {
        let mutant: Mutant = name.parse().unwrap_or_else(|e| panic!("{e}"));
        let found = compare(&parts[part], Some(mutant)).divergence;
        let diagram = found.unwrap_or_else(|| panic!("{name} survives"));
        assert!(diagram.text().contains('^'), "{name}");
    }
}
