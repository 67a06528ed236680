//! Guarantees that no shipped machine asks for: each holds where it is added, and is broken by each of its changes.

use serde::Deserialize;
use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::{self as machine, families};
use stillpoint_model::Verdict;
use stillpoint_tests::peer::each;
use stillpoint_tests::root;

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

/// The verdict on the guarantee.
fn judged(added: &Added, change: Option<&Change>) -> Verdict {
    let path = root().join(&added.file);
    let mut text = std::fs::read_to_string(&path).expect("the machine");
    text.push_str(&added.text);
    if let Some(change) = change {
        assert!(text.contains(&change.replace), "{}", change.text);
        text = text.replacen(&change.replace, &change.by, 1);
    }
    let machine = machine::load_bytes(&path, text.into_bytes(), &families(&path));
    let machine = machine.unwrap_or_else(|e| panic!("{}: {e}", added.name));
    let runs: Vec<_> = (machine.runs.iter())
        .filter(|run| run.guarantee.as_ref() == Some(&added.name))
        .cloned()
        .collect();
    let subject = subject::of_runs(&path, machine, &runs, &Readings::new());
    let subject = subject.unwrap_or_else(|e| panic!("{}: {e}", added.name));
    let checked = check(&subject, &Settings::default(), &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    let list = answers(&subject, &checked);
    let answer = (list.iter())
        .find(|answer| answer.guarantee.name == added.name)
        .expect("asked");
    answer.verdict
}

#[test]
fn every_added_guarantee_holds_and_is_broken_by_each_change() {
    let path = root().join("tests/machines/patterns.toml");
    let text = std::fs::read_to_string(path).expect("readable");
    let file: File = toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
    let wrong = each(&file.guarantee, |added| {
        let mut wrong = Vec::new();
        let verdict = judged(added, None);
        if verdict != Verdict::Holds {
            wrong.push(format!("{}: {verdict:?}", added.name));
        }
        for change in &added.change {
            if judged(added, Some(change)) != Verdict::Violated {
                wrong.push(format!("{}: {}: not broken", added.name, change.text));
            }
        }
        wrong
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
