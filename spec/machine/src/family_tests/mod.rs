//! The data of the shipped families against the tables of the manuals, and every plausibility rule against examples.

mod examples;
mod explored;
mod heidenhain;
mod modules;
mod sinumerik;
mod values;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::family::Family;

/// A rule by what it says, a machine that violates it, and one beside it that does not.
type Example = (&'static str, String, String);

/// The families with examples for each of their rules.
fn examples() -> [(&'static str, Vec<Example>); 2] {
    let sinumerik =
        examples::EXAMPLES.map(|(rule, bad, good)| (rule, bad.to_owned(), good.to_owned()));
    [
        (
            "sinumerik-840d",
            sinumerik.into_iter().chain(modules::examples()).collect(),
        ),
        ("heidenhain-fs", heidenhain::examples()),
    ]
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../families")
}

fn family(name: &str) -> Family {
    super::family_file::load(&root().join(name)).unwrap_or_else(|e| panic!("{e}"))
}

fn table(family: &str, file: &str) -> toml::Table {
    let text = std::fs::read_to_string(root().join(family).join(file)).expect(file);
    toml::from_str(&text).expect(file)
}

/// What the test leaves out, by the file of exceptions of all tests.
fn exceptions(test: &str) -> BTreeSet<String> {
    let text = std::fs::read_to_string(root().join("../../tests/exceptions.toml")).expect("there");
    let table: toml::Table = toml::from_str(&text).expect("TOML");
    let all = table["exception"].as_array().expect("a list").iter();
    let names = all
        .filter(|one| one["test"].as_str() == Some(test))
        .flat_map(|one| one["of"].as_array().expect("a list"));
    names
        .map(|name| name.as_str().expect("a name").to_owned())
        .collect()
}

/// Loads what stands in a machine file after the family.
fn load(family: &str, text: &str) -> stillpoint_lang::diag::Result<super::Machine> {
    let text = format!("family = \"{family}\"\n{text}\n");
    super::load_bytes(Path::new("example.toml"), text.into_bytes(), &root())
}

#[test]
fn requirement_ids_exist() {
    fn ids(value: &toml::Value, list: &mut Vec<String>) {
        match value {
            toml::Value::Table(table) => {
                for (key, value) in table {
                    match value.as_array() {
                        Some(items) if key == "id" => list.extend(
                            items
                                .iter()
                                .filter_map(toml::Value::as_str)
                                .map(str::to_owned),
                        ),
                        _ => ids(value, list),
                    }
                }
            }
            toml::Value::Array(items) => items.iter().for_each(|i| ids(i, list)),
            _ => {}
        }
    }
    let catalogue = stillpoint_lang::catalogue::load(&root()).unwrap_or_else(|e| panic!("{e}"));
    let requirements = catalogue.requirements.iter();
    let known: BTreeSet<&str> = requirements.map(|r| r.id.as_str()).collect();
    for (family, _) in examples() {
        let mut used = Vec::new();
        let file = table(family, "family.toml");
        ids(&toml::Value::Table(file), &mut used);
        assert!(used.len() > 80, "{family}: {} ids", used.len());
        for id in used {
            let requirement = stillpoint_lang::catalogue::requirement_id(&id);
            assert!(known.contains(requirement), "{id} is in no catalogue");
        }
    }
}

#[test]
fn each_rule_refuses_its_example_and_nothing_beside_it() {
    for (family, list) in examples() {
        for (rule, bad, good) in list {
            let errors = load(family, &bad).expect_err(rule).0;
            let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
            assert!(texts.iter().all(|t| t.contains(rule)), "{bad}\n{texts:#?}");
            assert_eq!(texts.len(), 1, "{texts:#?}");
            assert!(errors.iter().all(|e| !e.help.is_empty()));
            if let Err(errors) = load(family, &good) {
                panic!("{good}\n{errors}");
            }
        }
    }
}

#[test]
fn each_rule_has_an_example() {
    for (name, examples) in examples() {
        let family = family(name);
        let of_patterns = family.patterns.values().flat_map(|pattern| &pattern.rules);
        for rule in family.rules.iter().chain(of_patterns) {
            let mut known = examples.iter();
            let has = known.any(|(text, _, _)| rule.text.starts_with(text));
            assert!(has, "no example violates '{}'", rule.text);
            assert!(!rule.id.is_empty());
        }
    }
}
