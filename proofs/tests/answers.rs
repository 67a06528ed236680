//! The answers of Kani as they are kept: each harness has its parts, its sources and its row.
//!
//! These are no unit tests, so that the list of all harnesses is compiled once, in the library.

use std::collections::BTreeMap;

use stillpoint_proofs::inventory;
use stillpoint_proofs::results::{
    Answer, Results, Row, Verdict, has_sources, numbers_of_parts, parts, shares,
};

#[test]
fn parts_are_those_declared() {
    let of = |id: &str| inventory::all().find(|entry| entry.id == id).map(parts);
    assert_eq!(of("external_contract"), Some(1));
    assert_eq!(of("motion_contract"), Some(1));
    assert_eq!(of("channel_contract"), Some(5));
    assert_eq!(of("units_speed"), Some(3));
    assert_eq!(of("s120_frames"), Some(4));
}

/// Clause `n` is asserted by the part that has `n` modulo the first number: with each remainder in one part none is left out.
#[test]
fn no_part_is_missing() {
    for entry in inventory::all() {
        let numbers = numbers_of_parts(entry);
        let Some((count, parts)) = numbers.split_first() else {
            continue;
        };
        let mut parts = parts.to_vec();
        parts.sort_unstable();
        assert!(parts.into_iter().eq(1..=*count), "{}", entry.id);
        let clauses = (entry.clauses)().len() as u64;
        assert!(clauses == 0 || *count <= clauses, "{}", entry.id);
    }
}

/// Else the inventory would name clauses whose part takes every number, or none at all.
#[test]
fn few_numbers_are_those_of_a_part() {
    for entry in inventory::all().filter(|entry| !entry.few_in.is_empty()) {
        let parts = 1..=shares(entry);
        let known = |part: &u32| parts.contains(&u64::from(*part));
        assert!(entry.few_in.iter().all(known), "{}", entry.id);
    }
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let row = |verdict| Row {
        answer: Answer {
            verdict,
            seconds: 1.5,
            slowest: 1.0,
            parts: 2,
            checks: 200,
            met: 2,
            covers: 3,
            solver: "kissat".to_owned(),
        },
        sources: "00ff".to_owned(),
    };
    let results = Results {
        kani: "0.57.0".to_owned(),
        cbmc: "6.6.0".to_owned(),
        rows: BTreeMap::from([
            ("stop_contract".to_owned(), row(Verdict::Vacuous)),
            (
                "fault_contract".to_owned(),
                row(Verdict::Fails("a_clause".to_owned())),
            ),
            ("gear_contract".to_owned(), row(Verdict::NoAnswer)),
        ]),
    };
    assert_eq!(Results::parse(&results.render()), Ok(results));
}

#[test]
fn a_harness_that_does_not_exist_is_refused() {
    let mut results = Results::default();
    let answer = Answer {
        verdict: Verdict::Holds,
        seconds: 0.0,
        slowest: 0.0,
        parts: 1,
        checks: 0,
        met: 0,
        covers: 0,
        solver: String::new(),
    };
    let sources = String::new();
    results
        .rows
        .insert("stop_contract".to_owned(), Row { answer, sources });
    let text = results.render().replace("stop_contract", "stop_contrakt");
    assert_eq!(
        Results::parse(&text),
        Err("stop_contrakt: there is no such harness".to_owned())
    );
}

#[test]
fn every_monitor_has_its_file() {
    for entry in inventory::all() {
        assert!(has_sources(entry), "{}", entry.id);
    }
}
