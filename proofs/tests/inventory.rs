//! The inventory holds: every enumeration passes, is not vacuous, and the page in the book says what it found.

use std::collections::BTreeSet;

use stillpoint_proofs::inventory;
use stillpoint_proofs::page;

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
    assert!(
        written == page::render(&results),
        "docs/src/proofs.md is not up to date: run `{}`",
        page::COMMAND
    );
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
