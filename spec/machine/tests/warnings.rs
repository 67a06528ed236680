//! Every warning of each family against a machine that gives it and a neighbour that does not, from the files in `tests/warnings`;
//! and dangerous single changes of the shipped machines, from `tests/dangerous`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use stillpoint_machine::{Machine, load_bytes, warnings};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Cases {
    family: String,
    machine: BTreeMap<String, String>,
    case: Vec<Case>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    warning: String,
    /// The machine that is changed.
    of: String,
    /// A text of it, and what comes in its place.
    replace: String,
    fires: String,
    quiet: String,
    /// Changes on both sides.
    #[serde(default)]
    with: Vec<(String, String)>,
    /// Further warnings on both sides, and where it fires.
    #[serde(default)]
    also: BTreeSet<String>,
    #[serde(default)]
    only: BTreeSet<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Dangers {
    machine: String,
    change: Vec<Change>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Change {
    text: String,
    replace: String,
    by: String,
    warning: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn families() -> PathBuf {
    root().join("spec/families")
}

/// The files of a folder of the workspace; none would show nothing.
fn read<T: for<'de> Deserialize<'de>>(folder: &str) -> Vec<T> {
    let listed = std::fs::read_dir(root().join(folder)).expect(folder);
    let mut paths: Vec<PathBuf> = listed.map(|e| e.expect("an entry").path()).collect();
    paths.sort();
    assert!(paths.len() >= 2, "{folder}: {paths:?}");
    let read = |path: &PathBuf| {
        let text = std::fs::read_to_string(path).expect("UTF-8");
        toml::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    paths.iter().map(read).collect()
}

fn machine(text: String) -> Machine {
    // Programs stand beside it.
    let name = root().join("spec/machines/machine.toml");
    load_bytes(&name, text.clone().into_bytes(), &families())
        .unwrap_or_else(|e| panic!("{text}\n{e}"))
}

/// The warnings that nothing accepts.
fn ids(machine: &Machine) -> BTreeSet<String> {
    let open = machine.warnings.iter().filter(|w| w.accepted.is_none());
    open.map(|w| w.id.clone()).collect()
}

/// The file without its guarantees, and without what is accepted of them: some name what a change takes away, and are refused then.
fn unasked(text: &str) -> String {
    let parts = text.split("\n\n");
    let asks = |part: &&str| {
        let of_guarantees = |line: &str| {
            line.starts_with("[guarantee.")
                || line.starts_with("warning = ") && line.ends_with("-keeps-torque\"")
        };
        part.lines().any(of_guarantees)
    };
    let others = parts.filter(|part| !asks(part));
    others.collect::<Vec<_>>().join("\n\n")
}

fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}\nis not in\n{text}");
    text.replacen(from, to, 1)
}

#[test]
fn each_warning_has_a_machine_that_gives_it_and_a_neighbour_that_does_not() {
    for cases in read::<Cases>("tests/warnings") {
        let family = &cases.family;
        let known = warnings::catalogue(&families().join(family));
        let known = known.unwrap_or_else(|e| panic!("{e}"));
        let known: BTreeSet<String> = known.into_iter().map(|k| k.id).collect();
        assert!(known.len() >= 30, "{family}: {} warnings", known.len());
        let seen: BTreeSet<String> = cases.case.iter().map(|c| c.warning.clone()).collect();
        let apart: BTreeSet<_> = cases.case.iter().map(|c| (&c.warning, &c.fires)).collect();
        assert_eq!(
            apart.len(),
            cases.case.len(),
            "{family}: a case stands twice"
        );
        let without: Vec<&String> = known.symmetric_difference(&seen).collect();
        assert!(
            without.is_empty(),
            "{family}: warnings without a case, or cases without a warning: {without:?}"
        );
        let full = |body: &str| format!("family = \"{family}\"\n{body}");
        for (name, body) in &cases.machine {
            let found = ids(&machine(full(body)));
            assert!(found.is_empty(), "{family}, machine {name}: {found:?}");
        }
        let mut wrong: Vec<String> = Vec::new();
        let mut compare = |what: String, found: BTreeSet<String>, expected: &BTreeSet<String>| {
            if found != *expected {
                wrong.push(format!("{what}: {found:?}, not {expected:?}"));
            }
        };
        for case in &cases.case {
            let mut base = full(&cases.machine[&case.of]);
            for (from, to) in &case.with {
                base = changed(&base, from, to);
            }
            let name = &case.warning;
            let fires = machine(changed(&base, &case.replace, &case.fires));
            let quiet = machine(changed(&base, &case.replace, &case.quiet));
            let mut expected = case.also.clone();
            compare(format!("beside {name}"), ids(&quiet), &expected);
            expected.extend(case.only.iter().cloned());
            expected.insert(name.clone());
            compare(name.clone(), ids(&fires), &expected);
            for warning in &fires.warnings {
                assert!(warning.line >= 1 && warning.column >= 1);
                let texts = [&warning.text, &warning.reason, &warning.better];
                assert!(texts.iter().all(|t| !t.is_empty()), "{name}: {texts:?}");
                assert!(texts.iter().all(|t| !t.contains(['{', '}'])), "{texts:?}");
            }
        }
        assert!(wrong.is_empty(), "{family}:\n{}", wrong.join("\n"));
    }
}

#[test]
fn dangerous_values_of_the_shipped_machines_are_warned_of() {
    for dangers in read::<Dangers>("tests/dangerous") {
        let file = &dangers.machine;
        let text = std::fs::read_to_string(root().join(file)).expect(file);
        let text = unasked(&text);
        let clean = ids(&machine(text.clone()));
        assert!(clean.is_empty(), "{file}: {clean:?}");
        assert!(dangers.change.len() >= 8, "{file}");
        for change in &dangers.change {
            let with = machine(changed(&text, &change.replace, &change.by));
            let found = ids(&with);
            assert!(
                found.contains(&change.warning),
                "{file}, {}: {found:?}",
                change.text
            );
        }
    }
}

#[test]
fn requirements_of_warnings_exist_and_sources_name_lines_of_the_manual() {
    let catalogue = stillpoint_lang::catalogue::load(&families()).expect("a catalogue");
    let requirements = catalogue.requirements.iter();
    let known: BTreeSet<&str> = requirements.map(|r| r.id.as_str()).collect();
    for cases in read::<Cases>("tests/warnings") {
        let folder = families().join(&cases.family);
        let manual = std::fs::read_to_string(folder.join("manual.toml")).expect("a manual");
        let manual: toml::Table = toml::from_str(&manual).expect("TOML");
        let manual = manual["manual"].as_table().expect("manuals").values();
        let lines = manual.filter_map(|m| m["lines"].as_integer()).max();
        for warning in warnings::catalogue(&folder).unwrap_or_else(|e| panic!("{e}")) {
            for id in &warning.req {
                assert!(known.contains(id.as_str()), "{}: {id}", warning.id);
            }
            assert!(!warning.req.is_empty(), "{}", warning.id);
            let numbers = warning.source.split_once("line").map_or("", |(_, n)| n);
            let numbers = numbers.split(|c: char| !c.is_ascii_digit());
            let numbers: Vec<i64> = numbers.filter_map(|n| n.parse().ok()).collect();
            assert_eq!(numbers.is_empty(), warning.source.is_empty());
            assert!(numbers.iter().all(|n| Some(*n) <= lines), "{numbers:?}");
        }
    }
}
