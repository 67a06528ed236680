//! Guarantees that no shipped machine asks for: each holds where it is added, and is broken by each of its changes.

use std::path::PathBuf;

use serde::Deserialize;
use stillpoint_engine::check::Settings;
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::{self as machine, Machine, families};
use stillpoint_model::Verdict;
use stillpoint_tests::guarantees::{decided, is_violated};
use stillpoint_tests::peer::each;
use stillpoint_tests::{daily, root};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    guarantee: Vec<Added>,
}

/// A guarantee that is added to a machine.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Added {
    file: String,
    name: String,
    text: String,
    /// Whether a way is told with its bound.
    #[serde(default)]
    way: bool,
    change: Vec<Change>,
}

/// One text in the place of another, which stands there.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Change {
    text: String,
    replace: String,
    by: String,
}

/// The machine of the guarantee, which stands at the end of its file, with what is changed.
fn loaded(added: &Added, change: Option<&Change>) -> (PathBuf, Machine) {
    let path = root().join(&added.file);
    let mut text = std::fs::read_to_string(&path).expect("the machine");
    text.push_str(&added.text);
    if let Some(change) = change {
        assert!(text.contains(&change.replace), "{}", change.text);
        text = text.replacen(&change.replace, &change.by, 1);
    }
    let machine = machine::load_bytes(&path, text.into_bytes(), &families(&path));
    let machine = machine.unwrap_or_else(|e| panic!("{}: {e}", added.name));
    (path, machine)
}

/// The verdict on the guarantee, and whether a way is told with it.
fn judged(added: &Added) -> (Verdict, bool) {
    let (path, machine) = loaded(added, None);
    let names = [added.name.as_str()];
    let (subject, checked) = decided(&path, machine, &names, &Settings::default());
    let list = answers(&subject, &checked);
    let answer = (list.iter())
        .find(|answer| answer.guarantee.name == added.name)
        .expect("asked");
    let way = answer.runs.iter().any(|run| run.way.is_some());
    (answer.verdict, way)
}

fn all() -> Vec<Added> {
    let path = root().join("tests/machines/patterns.toml");
    let text = std::fs::read_to_string(path).expect("readable");
    let file: File = toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
    file.guarantee
}

/// Each holds and is broken by each of its changes.
fn are_right(guarantees: &[Added]) {
    assert!(guarantees.len() >= 4);
    let wrong = each(guarantees, |added| {
        let mut wrong = Vec::new();
        let found = judged(added);
        if found != (Verdict::Holds, added.way) {
            wrong.push(format!("{}: {found:?}", added.name));
        }
        for change in &added.change {
            let (path, machine) = loaded(added, Some(change));
            if !is_violated(&path, &machine, &added.name) {
                wrong.push(format!("{}: {}: not broken", added.name, change.text));
            }
        }
        wrong
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn added_guarantees_hold_and_are_broken_by_each_change() {
    are_right(&daily(all()));
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn every_added_guarantee_holds_and_is_broken_by_each_change() {
        are_right(&all());
    }
}
