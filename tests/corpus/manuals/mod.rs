//! The worked examples of the manuals: every number they print in an example, a table, a formula or a figure is a case, with
//! its line, and is run on the monitors or through the command line.
//!
//! The cases are data, `tests/corpus/<family>/*.toml`; files are discovered, never listed:
//!
//! ```toml
//! [[case]]
//! id = "stop-b-timer"                  # unique in the family
//! lines = "2555-2560"                  # of the manual the family's manual.toml names
//! kind = "example"                     # example, table, formula or figure
//! says = "what the manual prints there, in our words"
//! requirements = ["S840D-STOP-020"]    # what the case is evidence for; may be empty
//! run = "stop"                         # a runner of the family, or "cli"
//! given = { t_b = 2 }                  # what the runner reads, in the units of the manual; each key must be read
//! expect = { pulses_cancelled_after = 2 }   # compared exactly, key by key, with what the runner answers
//! reading = "A-07"                     # only where the number holds under one reading of an ambiguous place
//! ```
//!
//! A table `[given]` at the head of a file is given to each of its cases that does not say otherwise.
//!
//! A runner (`sinumerik.rs`, `heidenhain.rs`, `storage.rs`, or modules below them) is a function from what is given to an answer. It must not
//! know what is expected, and takes no number that the manual prints from anywhere but the case. Where the manual contradicts
//! itself, both places are cases: the one that is not followed has `expect` as the code answers and says so in `contradicts`.

mod case;
mod cli;
mod heidenhain;
mod sinumerik;
mod storage;
mod story;

use case::{Case, Given, Kind, Runner};
use std::collections::BTreeSet;

/// The runners that serve every family.
const GENERAL: &[(&str, Runner)] = &[("cli", cli::run)];

/// Runs every case of a family; what went wrong, a line each.
fn run_family(family: &str, runners: &[(&str, Runner)]) {
    let cases = case::load(family);
    let mut wrong = Vec::new();
    let mut seen = BTreeSet::new();
    let mut used = BTreeSet::new();
    for case in &cases {
        if !seen.insert(case.id.as_str()) {
            wrong.push(format!("{}: the id stands twice", case.place()));
        }
        let all = runners.iter().chain(GENERAL);
        let Some((name, runner)) = all.into_iter().find(|(name, _)| *name == case.run) else {
            wrong.push(format!(
                "{}: no runner is called {}",
                case.place(),
                case.run
            ));
            continue;
        };
        used.insert(*name);
        wrong.extend(judge(case, *runner));
    }
    for (name, _) in runners {
        if !used.contains(name) {
            wrong.push(format!("{family}: no case uses the runner {name}"));
        }
    }
    assert!(
        wrong.is_empty(),
        "{} of {} cases:\n{}",
        wrong.len(),
        cases.len(),
        wrong.join("\n")
    );
    let of = |kind| cases.iter().filter(|case| case.kind == kind).count();
    println!(
        "{family}: {} cases, of examples {}, tables {}, formulas {}, figures {}",
        cases.len(),
        of(Kind::Example),
        of(Kind::Table),
        of(Kind::Formula),
        of(Kind::Figure)
    );
}

/// Compares what a runner answers with what is expected.
fn judge(case: &Case, runner: Runner) -> Vec<String> {
    let given = Given::new(&case.given);
    let answer = match runner(&given) {
        Ok(answer) => answer,
        Err(error) => return vec![format!("{}: {error}", case.place())],
    };
    let mut wrong: Vec<String> = given
        .unread(&case.own)
        .into_iter()
        .map(|key| format!("{}: given {key} is not read by {}", case.place(), case.run))
        .collect();
    for (key, expected) in &case.expect {
        match answer.get(key) {
            Some(found) if found == expected => {}
            Some(found) => wrong.push(format!(
                "{}: {key} is {found}, the manual has {expected}",
                case.place()
            )),
            None => wrong.push(format!("{}: {} answers no {key}", case.place(), case.run)),
        }
    }
    wrong
}

/// Every printed number of the manual of the SINUMERIK 840D that is a case holds.
#[test]
fn sinumerik_840d() {
    run_family("sinumerik-840d", sinumerik::RUNNERS);
}

/// Every printed number of HEIDENHAIN's manual that is a case holds.
#[test]
fn heidenhain_fs() {
    run_family("heidenhain-fs", heidenhain::RUNNERS);
}

/// Every printed number of the manual of the SINAMICS S120 that is a case holds.
#[test]
fn sinamics_s120() {
    run_family("sinamics-s120", &[]);
}

/// Every printed number of the manual of the storage and retrieval machines that is a case holds.
#[test]
fn srm_fblocks() {
    run_family("srm-fblocks", storage::RUNNERS);
}

/// The frame itself: a wrong number, a key nobody reads and an answer that is missing are found.
#[test]
fn frame_finds_what_is_wrong() {
    let case = |given: &str, expect: &str| {
        Case::parse(
            "frame.toml",
            &format!(
                "id = 'x'\nlines = '1'\nkind = 'example'\nsays = 'x'\nrequirements = []\nrun = 'double'\ngiven = {given}\nexpect = {expect}"
            ),
        )
    };
    let double: Runner = |given| {
        let mut answer = toml::Table::new();
        answer.insert("twice".into(), (given.int("value")? * 2).into());
        Ok(answer)
    };
    let judged = |given, expect| judge(&case(given, expect), double).len();
    assert_eq!(judged("{ value = 2 }", "{ twice = 4 }"), 0);
    assert_eq!(judged("{ value = 2 }", "{ twice = 5 }"), 1);
    assert_eq!(judged("{ value = 2, more = 1 }", "{ twice = 4 }"), 1);
    assert_eq!(judged("{ value = 2 }", "{ thrice = 6 }"), 1);
    assert_eq!(judged("{ }", "{ twice = 4 }"), 1);
    for family in [
        "heidenhain-fs",
        "sinamics-s120",
        "sinumerik-840d",
        "srm-fblocks",
    ] {
        let last = case::last_line(family);
        let mut one = case("{ value = 2 }", "{ twice = 4 }");
        one.lines = last.to_string();
        assert_eq!(one.faults(last), None);
        one.lines = (last + 1).to_string();
        assert!(one.faults(last).is_some(), "beyond the manual of {family}");
    }
}
