//! The inventory holds: every enumeration passes, is not vacuous, and the page in the book says what it found.

use std::collections::BTreeSet;

use stillpoint_proofs::enumeration::Count;
use stillpoint_proofs::inventory::{self, Entry};
use stillpoint_proofs::page;
use stillpoint_proofs::results::{Results, Verdict, parts, solver};

/// Enumerations that the page says to have fewer cases are made daily: nine of ten, and a tenth of all cases.
const QUICK: u64 = 2_000_000;

fn written() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/src/proofs.md");
    std::fs::read_to_string(path).expect("docs/src/proofs.md exists")
}

/// How many cases the page says that a harness has; none where it says nothing of it.
fn cases(page: &str, id: &str) -> Option<u64> {
    let head = format!("| `{id}` |");
    let line = page.lines().find(|line| line.starts_with(&head))?;
    let (before, _) = line.split_once(" cases |")?;
    let (_, number) = before.rsplit_once("holds, ")?;
    number.replace(' ', "").parse().ok()
}

/// Every law holds and every cover is met.
fn proves(results: &[(&Entry, Count)]) {
    for (entry, count) in results {
        assert_eq!(count.broken, None, "{}", entry.id);
        for (cover, met) in (entry.covers)().iter().zip(&count.covers) {
            assert!(*met > 0, "{}: the cover \"{cover}\" is never met", entry.id);
        }
        assert!(count.proves(), "{}: {count:?}", entry.id);
    }
}

#[test]
fn quick_enumerations_prove_what_the_page_says() {
    let (page, kani) = (written(), Results::read().expect("the answers of Kani"));
    let quick = |entry: &&Entry| cases(&page, entry.id).is_none_or(|cases| cases < QUICK);
    let results = page::results_of(inventory::all().filter(quick).collect());
    proves(&results);
    for (entry, count) in &results {
        for text in page::told(entry, count, &kani) {
            assert!(
                page.contains(&text),
                "docs/src/proofs.md is not up to date: run `{}`\n{text}",
                page::COMMAND
            );
        }
    }
    let share = (results.len() * 100) / inventory::all().count();
    assert!(share >= 85, "{share} % of all");
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

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn every_enumeration_proves_and_the_page_is_up_to_date() {
        let results = page::results();
        proves(&results);
        // Also when an answer of Kani is older than what it was given for and the page does not say so.
        let kani = Results::read().expect("the answers of Kani");
        assert!(
            written() == page::render(&results, &kani),
            "docs/src/proofs.md is not up to date: run `{}`",
            page::COMMAND
        );
    }
}
