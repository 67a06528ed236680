//! What the data of a family gives to the systems that it has explored for a machine: each name is a parameter of the system.
//! A machine file that uses the function would find it; no shipped one uses all of them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use stillpoint_lang::Spec;
use stillpoint_tests::root;
use toml::{Table, Value};

/// The tables named `explore` in a file, at any depth.
fn explored(value: &Value, found: &mut Vec<Table>) {
    match value {
        Value::Table(table) => {
            for (name, value) in table {
                match value {
                    Value::Array(list) if name == "explore" => {
                        found.extend(list.iter().filter_map(Value::as_table).cloned());
                    }
                    _ => explored(value, found),
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|value| explored(value, found)),
        _ => {}
    }
}

/// The names that one of them gives values to.
fn given(explore: &Table) -> BTreeSet<&str> {
    let table = |name: &str| explore.get(name).and_then(Value::as_table);
    let keys = ["param", "time"].into_iter().filter_map(table);
    let keys = keys.flat_map(|table| table.keys().map(String::as_str));
    // `name[]` is the array of that name.
    let keys = keys.map(|key| key.strip_suffix("[]").unwrap_or(key));
    let ranked = table("rank").into_iter().flat_map(Table::values);
    let ranked = ranked.filter_map(Value::as_array).flatten();
    keys.chain(ranked.filter_map(Value::as_str)).collect()
}

fn parsed(path: &Path) -> Table {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    toml::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

#[test]
fn what_is_explored_for_a_machine_has_the_parameters_that_it_is_given() {
    let entries = std::fs::read_dir(root().join("spec/families")).expect("the families");
    let folders: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    let (mut wrong, mut names) = (Vec::new(), 0);
    for folder in folders.iter().filter(|f| f.join("family.toml").exists()) {
        let mut all = Vec::new();
        for file in ["family.toml", "product.toml", "guarantees.toml"] {
            let path = folder.join(file);
            if path.exists() {
                explored(&Value::Table(parsed(&path)), &mut all);
            }
        }
        for explore in &all {
            let text = |name: &str| explore[name].as_str().expect("a text");
            let path = folder.join(text("file"));
            let spec = Spec::load(&path).unwrap_or_else(|e| panic!("{e}"));
            let system = spec.system(text("system"), None);
            let system = system.unwrap_or_else(|e| panic!("{e}"));
            let known: BTreeSet<&str> = system.params.iter().map(|p| p.var.array()).collect();
            names += known.len();
            if text("system") == "setpoint" {
                let percent = &explore["param"]["percent"];
                assert_eq!(percent.as_str(), Some("DES_VELO_LIMIT"), "{path:?}");
            }
            for name in given(explore).difference(&known) {
                let (file, system) = (text("file"), text("system"));
                wrong.push(format!(
                    "{}: {file}, system {system}: {name}",
                    folder.display()
                ));
            }
        }
    }
    assert!(names > 1000, "{names}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
