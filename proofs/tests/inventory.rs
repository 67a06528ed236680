//! The inventory holds: every enumeration passes, is not vacuous, and the page in the book says what it found.

use std::collections::BTreeSet;

use stillpoint_proofs::inventory;
use stillpoint_proofs::page;
use stillpoint_proofs::results::{Results, Verdict, parts, solver};

#[test]
fn every_enumeration_proves_and_the_page_is_up_to_date() {
    let results = page::results();
    for (entry, count) in &results {
        assert_eq!(count.broken, None, "{}", entry.id);
        for (cover, met) in (entry.covers)().iter().zip(&count.covers) {
            assert!(*met > 0, "{}: the cover \"{cover}\" is never met", entry.id);
        }
        assert!(count.proves(), "{}: {count:?}", entry.id);
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/src/proofs.md");
    let written = std::fs::read_to_string(path).expect("docs/src/proofs.md exists");
    // Also when an answer of Kani is older than what it was given for and the page does not say so.
    let kani = Results::read().expect("the answers of Kani");
    assert!(
        written == page::render(&results, &kani),
        "docs/src/proofs.md is not up to date: run `{}`",
        page::COMMAND
    );
}

#[test]
fn every_answer_of_kani_is_one_of_its_harness() {
    // A harness that does not exist is refused while reading.
    let kani = Results::read().expect("the answers of Kani");
    for entry in inventory::all() {
        let Some((row, fresh)) = kani.row(entry) else {
            continue;
        };
        let answer = &row.answer;
        assert_eq!(answer.parts, parts(entry), "{}: its parts", entry.id);
        assert!(
            !matches!(answer.verdict, Verdict::Fails(_) | Verdict::Vacuous),
            "{}: {}",
            entry.id,
            answer.verdict
        );
        assert!(answer.slowest <= answer.seconds + 0.1, "{}", entry.id);
        if fresh {
            // CBMC may lack the one it was asked for, but for an external one.
            let named = answer.solver.as_str();
            assert!(
                ["cadical", "kissat", "minisat"].contains(&named),
                "{}",
                entry.id
            );
            let external = "kissat";
            assert_eq!(named == external, solver(entry) == external, "{}", entry.id);
        }
        if fresh && answer.verdict == Verdict::Holds {
            let covers = (entry.covers)().len() as u64;
            assert_eq!(
                (answer.met, answer.covers),
                (covers, covers),
                "{}",
                entry.id
            );
        }
    }
}

#[test]
fn names_are_unique_and_every_entry_has_covers_and_requirements() {
    let names: BTreeSet<_> = inventory::all().map(|entry| entry.id).collect();
    assert_eq!(names.len(), inventory::all().count());
    for entry in inventory::all() {
        assert!(!(entry.covers)().is_empty(), "{}", entry.id);
        assert!(!(entry.requirements)().is_empty(), "{}", entry.id);
    }
}
