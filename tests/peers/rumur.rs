//! Exported systems in rumur: the same number of states, and the same verdict on each property of single cycles.
//!
//! A user without rumur or gcc sees that the tests were skipped; where the environment has `CI`, they fail then.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use stillpoint_engine::subject::{Subject, Task};
use stillpoint_harness::export::murphi::{RANGE, murphi};
use stillpoint_lang::ir::Form;
use stillpoint_model::Verdict;
use stillpoint_tests::peer::{Folder, QUICK, each, explored, load, shipped, tools};
use stillpoint_tests::{daily, exceptions, files};

const TOOLS: [&str; 2] = ["rumur", "gcc"];

/// Systems with more combinations of inputs a cycle, or more transitions (states x combinations), than this are left out:
/// rumur enumerates every combination of the inputs that the model reads, which would take too long in a test.
const COMBINATIONS: u128 = 10_000;
const TRANSITIONS: u128 = 400_000;

/// What rumur found.
struct Found {
    states: u64,
    /// Properties whose claim failed, and [`RANGE`].
    broken: BTreeSet<String>,
    /// Witnesses that were seen.
    seen: BTreeSet<String>,
}

/// The value of an attribute of an XML element.
fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let start = element.find(&format!("{name}=\""))? + name.len() + 2;
    let length = element[start..].find('"')?;
    Some(&element[start..start + length])
}

/// The id that a property's message begins with.
fn id(message: &str) -> String {
    message.split(": ").next().unwrap_or_default().to_owned()
}

impl Found {
    fn of(xml: &str) -> Self {
        let elements = |name: &'static str| {
            let start = format!("<{name}");
            xml.lines().filter(move |l| l.starts_with(&start))
        };
        let summary = elements("summary")
            .next()
            .unwrap_or_else(|| panic!("not complete: {xml}"));
        let number = |name| attribute(summary, name).and_then(|v| v.parse::<u64>().ok());
        let mut broken = BTreeSet::new();
        let mut errors = 0;
        for line in elements("message") {
            let text = line
                .trim_start_matches("<message>")
                .trim_end_matches("</message>");
            // Assertion failed: FILE:PLACE: ID: text
            let claim = text
                .strip_prefix("Assertion failed: ")
                .and_then(|t| t.split_once(": "));
            errors += 1;
            broken.insert(match claim {
                Some((_, claim)) => id(claim),
                None => text.to_owned(),
            });
        }
        let mut seen = BTreeSet::new();
        for line in elements("cover_result") {
            if attribute(line, "count").is_some_and(|n| n != "0") {
                seen.insert(id(attribute(line, "message").unwrap_or_default()));
            } else {
                errors += 1;
            }
        }
        assert_eq!(
            number("errors"),
            Some(errors),
            "every error is understood: {xml}"
        );
        let states = number("states").unwrap_or_else(|| panic!("{xml}"));
        Found {
            states,
            broken,
            seen,
        }
    }
}

/// rumur's findings on a model.
fn run(name: &str, model: &str) -> Found {
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), &format!("rumur-{name}"));
    Found::of(&folder.rumur(model, 4_000_000_000))
}

/// Compares a system, unless it is too large; the answer is whether it was compared, and what is broken.
fn compare(
    subject: &Subject,
    task: &Task,
    name: &str,
    transitions: u128,
) -> Option<BTreeSet<String>> {
    let bound = &task.bound;
    if bound.combinations() > COMBINATIONS {
        return None;
    }
    let report = explored(subject, task);
    if report.transitions > transitions {
        return None;
    }
    let model = murphi(bound, &task.title).unwrap_or_else(|e| panic!("{name}: {e}"));
    let found = run(&name.replace('/', "-"), &model);
    assert_eq!(found.states, report.states, "{name}: states");
    let mut broken = BTreeSet::new();
    let mut seen = BTreeSet::new();
    for (property, judged) in bound.system.properties.iter().zip(&report.properties) {
        match property.form {
            Form::Always { .. } if judged.verdict == Verdict::Violated => {
                broken.insert(judged.id.clone());
            }
            Form::Reachable { .. } if judged.verdict == Verdict::Reached => {
                seen.insert(judged.id.clone());
            }
            _ => {}
        }
    }
    if !report.faults.is_empty() {
        broken.insert(RANGE.to_owned());
    }
    assert_eq!(found.broken, broken, "{name}: broken properties");
    assert_eq!(found.seen, seen, "{name}: witnesses");
    eprintln!("{name}: {} states in rumur and here", report.states);
    Some(broken)
}

/// Compares every system of a file with no more transitions than this.
fn compare_all(path: &Path, transitions: u128) -> Vec<(String, Option<BTreeSet<String>>)> {
    let subject = load(path);
    let compared = subject.tasks.iter().map(|task| {
        let name = &task.bound.system.name;
        let broken = compare(&subject, task, name, transitions);
        (name.clone(), broken)
    });
    compared.collect()
}

/// Compares the systems of these files with no more transitions than this; the answer is how many, and which are larger.
fn compare_shipped(files: &[PathBuf], transitions: u128) -> (usize, BTreeSet<String>) {
    let mut compared = 0;
    let mut left_out = BTreeSet::new();
    let all = each(files, |path| compare_all(path, transitions));
    for (name, broken) in all.into_iter().flatten() {
        match broken {
            Some(broken) => {
                assert_eq!(broken, BTreeSet::new(), "{name}");
                compared += 1;
            }
            None => _ = left_out.insert(name),
        }
    }
    (compared, left_out)
}

/// Every other file, those that SPIN does not compare; the answer is how many systems were compared.
fn compare_most(most: impl Fn(Vec<PathBuf>) -> Vec<PathBuf>) -> usize {
    let files = shipped().into_iter().skip(1).step_by(2).collect();
    let (compared, left_out) = compare_shipped(&most(files), QUICK);
    println!(
        "{compared} systems in rumur and here, {} larger",
        left_out.len()
    );
    compared
}

#[test]
fn some_shipped_systems_have_the_same_states_and_verdicts() {
    if tools(&TOOLS) {
        let compared = compare_most(daily);
        assert!(compared >= 8, "{compared}");
    }
}

#[test]
#[ignore = "deep: minutes"]
fn shipped_systems_have_the_same_states_and_verdicts() {
    if !tools(&TOOLS) {
        return;
    }
    assert_eq!(
        compare_shipped(&shipped(), TRANSITIONS).1,
        exceptions("rumur"),
        "the systems that are too large"
    );
}

/// In so many systems at least of these files a property is broken: with fewer the comparison shows too little.
fn broken_properties(files: &[PathBuf], least: usize) {
    let mut broken = 0;
    for (name, found) in each(files, |path| compare_all(path, TRANSITIONS))
        .into_iter()
        .flatten()
    {
        let found = found.unwrap_or_else(|| panic!("{name}: too large"));
        broken += usize::from(!found.is_empty());
    }
    assert!(
        broken >= least,
        "properties are broken in {broken} systems only"
    );
}

#[test]
fn some_seeded_errors_fail_there_too() {
    if tools(&TOOLS) {
        broken_properties(&daily(files("tests/must-fail", "toml")), 2);
    }
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn most_shipped_systems_have_the_same_states_and_verdicts() {
        if tools(&TOOLS) {
            let compared = compare_most(|files| files);
            assert!(compared >= 50, "{compared}");
        }
    }

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn seeded_errors_fail_there_too() {
        if tools(&TOOLS) {
            broken_properties(&files("tests/must-fail", "toml"), 8);
        }
    }
}
