//! Reads what the matrix is made of from the folders of a repository.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use stillpoint_spec::catalogue;
use stillpoint_spec::diag::Diagnostics;
use stillpoint_spec::read_text;
use toml::{Table, Value};

use super::{Named, Sources};

/// Why the sources cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// A file is wrong.
    #[error("{0}")]
    File(Diagnostics),
    /// Anything else: one sentence.
    #[error("{0}")]
    Other(String),
}

impl From<Diagnostics> for ReadError {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::File(diagnostics)
    }
}

/// The nearest folder at or above `start` that has a `Cargo.toml` and a folder `impl`.
pub fn find_root(start: &Path) -> Option<PathBuf> {
    let here = start.canonicalize().ok()?;
    let found = here
        .ancestors()
        .find(|dir| dir.join("Cargo.toml").is_file() && dir.join("impl").is_dir())?;
    Some(found.to_owned())
}

/// Reads the catalogues and tables of `spec/`, the monitors of `impl/src/`, the proofs of `proofs/src/` and the tests of
/// `tests/` and of every crate's own `tests/`.
///
/// A monitor names a requirement in a doc comment or at a clause of its contract. A clause is a proof as well where
/// `proofs/` has the harness of that contract (`[contract NAME on FAMILY::MODULE` in its inventory), since that harness
/// checks every clause.
///
/// # Errors
/// A folder or file that is missing, unreadable or of another form.
pub fn read(root: &Path) -> Result<Sources, ReadError> {
    for folder in ["spec", "impl/src", "proofs/src"] {
        if !root.join(folder).is_dir() {
            let message = format!(
                "{} has no folder {folder}; name the repository with --root",
                root.display()
            );
            return Err(ReadError::Other(message));
        }
    }
    let mut sources = Sources {
        catalogue: catalogue::load(&root.join("spec"))?,
        ..Sources::default()
    };
    let families: BTreeSet<String> = sources
        .catalogue
        .requirements
        .iter()
        .map(|r| r.family.clone())
        .collect();
    for family in &families {
        tables(&root.join("spec").join(family), family, &mut sources)?;
    }
    let prefixes: BTreeSet<String> = sources
        .catalogue
        .requirements
        .iter()
        .filter_map(|r| r.id.split('-').next().map(str::to_owned))
        .collect();
    let proofs = texts(root, &root.join("proofs/src"))?;
    for (place, text) in texts(root, &root.join("impl/src"))? {
        let contract = contract(&place, &proofs);
        for line in text
            .lines()
            .map(str::trim_start)
            .take_while(|l| !l.starts_with("#[cfg(test)]"))
        {
            let documents = line.starts_with("///") || line.starts_with("//!");
            if line.starts_with("//") && !documents {
                continue;
            }
            for id in ids(line, &prefixes) {
                add(&mut sources.monitors, id, &place);
                if let (Some(contract), false) = (contract, documents) {
                    add(&mut sources.proofs, id, contract);
                }
            }
        }
    }
    for (place, text) in &proofs {
        ids(text, &prefixes)
            .into_iter()
            .for_each(|id| add(&mut sources.proofs, id, place));
    }
    for folder in test_folders(root)? {
        for (place, text) in texts(root, &folder)? {
            ids(&text, &prefixes)
                .into_iter()
                .for_each(|id| add(&mut sources.tests, id, &place));
        }
    }
    Ok(sources)
}

fn add(named: &mut Named, id: &str, place: &str) {
    named
        .entry(id.to_owned())
        .or_default()
        .insert(place.to_owned());
}

/// The harness of the contract of the module a file of `impl/src` belongs to: `stop_contract` for
/// `impl/src/sinumerik/stop.rs`, where the inventory says `[contract stop_contract on sinumerik::stop {`.
fn contract<'a>(place: &str, proofs: &'a [(String, String)]) -> Option<&'a str> {
    modules(place).into_iter().flatten().find_map(|module| {
        let on = format!(" on {module} {{");
        let lines = proofs.iter().flat_map(|(_, text)| text.lines());
        lines
            .filter_map(|line| line.trim_start().strip_prefix("[contract "))
            .find_map(|line| line.strip_suffix(&on))
    })
}

/// The modules a file of `impl/src` may belong to: one of its own, or its folder's. `sinumerik::stop` for
/// `impl/src/sinumerik/stop.rs`, `sinumerik::channel` for `impl/src/sinumerik/channel/laws.rs`; none for what all families share.
fn modules(place: &str) -> [Option<String>; 2] {
    let name = |path: Option<&str>| {
        let (family, _) = place.strip_prefix("impl/src/")?.split_once('/')?;
        let name = path.map(|path| path.strip_suffix(".rs").unwrap_or(path))?;
        Some(format!("{family}::{name}"))
    };
    let inside = place
        .strip_prefix("impl/src/")
        .and_then(|rest| rest.split_once('/'));
    let parts = || inside.map(|(_, inside)| inside.split('/'));
    [
        name(parts().and_then(|mut parts| parts.next_back())),
        name(parts().and_then(|mut parts| parts.next())),
    ]
}

/// The requirement ids in a text: `PREFIX-AREA-123`, with a prefix of the catalogues and exactly three digits.
fn ids<'a>(text: &'a str, prefixes: &BTreeSet<String>) -> Vec<&'a str> {
    let part = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    let words = text.split(|c: char| !part(c));
    words.filter(|word| is_id(word, prefixes)).collect()
}

fn is_id(word: &str, prefixes: &BTreeSet<String>) -> bool {
    let parts: Vec<&str> = word.split('-').collect();
    let [prefix, area, number] = parts.as_slice() else {
        return false;
    };
    prefixes.contains(*prefix)
        && area.starts_with(|c: char| c.is_ascii_uppercase())
        && area
            .chars()
            .all(|c| c.is_ascii_uppercase() || c.is_ascii_digit())
        && number.len() == 3
        && number.chars().all(|c| c.is_ascii_digit())
}

/// `tests` at the root, and in each folder beside it.
fn test_folders(root: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let mut out: Vec<PathBuf> = entries(root)?
        .iter()
        .filter(|p| !hidden(p))
        .map(|p| p.join("tests"))
        .collect();
    out.push(root.join("tests"));
    out.retain(|p| p.is_dir());
    // The tests of the crate `tests` are below the folder at the root.
    out.retain(|p| *p != root.join("tests/tests"));
    out.sort();
    Ok(out)
}

fn hidden(path: &Path) -> bool {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or("");
    name.starts_with('.') || name == "target"
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let fail =
        |e: std::io::Error| ReadError::Other(format!("{} cannot be listed: {e}", folder.display()));
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        out.push(entry.map_err(fail)?.path());
    }
    out.sort();
    Ok(out)
}

/// The Rust, TOML and text files below a folder that are UTF-8, named from the root.
fn texts(root: &Path, folder: &Path) -> Result<Vec<(String, String)>, ReadError> {
    let mut out = Vec::new();
    for path in entries(folder)? {
        if hidden(&path) {
            continue;
        }
        if path.is_dir() {
            out.extend(texts(root, &path)?);
        } else if path
            .extension()
            .is_some_and(|e| e == "rs" || e == "toml" || e == "txt")
        {
            let bytes = std::fs::read(&path)
                .map_err(|e| ReadError::Other(format!("{} cannot be read: {e}", path.display())))?;
            // Inputs that are bad on purpose need not be UTF-8; they name no requirement.
            if let Ok(text) = String::from_utf8(bytes) {
                let place = path.strip_prefix(root).unwrap_or(&path);
                out.push((place.to_string_lossy().replace('\\', "/"), text));
            }
        }
    }
    Ok(out)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exceptions {
    exception: Vec<Exception>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exception {
    id: Vec<String>,
    reason: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Declared {
    family_complete: bool,
}

fn parsed<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, ReadError> {
    let text = read_text(path, "file of a family")?;
    toml::from_str(&text)
        .map_err(|e| ReadError::Other(format!("{}: {}", path.display(), e.to_string().trim())))
}

/// The specification files, family data, signals, exceptions and status of one family.
fn tables(folder: &Path, family: &str, sources: &mut Sources) -> Result<(), ReadError> {
    let mut specs: Vec<Table> = Vec::new();
    for path in entries(folder)?
        .into_iter()
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
    {
        match path.file_name().and_then(|n| n.to_str()).unwrap_or("") {
            "exceptions.toml" => {
                let Exceptions { exception } = parsed(&path)?;
                for Exception { id, reason } in exception {
                    if reason.trim().is_empty() {
                        return Err(ReadError::Other(format!(
                            "{}: an exception without reason",
                            path.display()
                        )));
                    }
                    sources.exceptions.extend(
                        id.into_iter()
                            .map(|id| (family.to_owned(), id, reason.clone())),
                    );
                }
            }
            "status.toml" => {
                let Declared { family_complete } = parsed(&path)?;
                if family_complete {
                    sources.complete.insert(family.to_owned());
                }
            }
            "family.toml" => data("family", &Value::Table(parsed(&path)?), &mut sources.rules),
            "signals.toml" => data("signals", &Value::Table(parsed(&path)?), &mut sources.rules),
            "reaction-chain.toml" => {
                let chains = Value::Table(parsed(&path)?);
                data("reaction-chain", &chains, &mut sources.data);
            }
            "acceptance.toml" => {
                let tests: Table = parsed(&path)?;
                let place = format!("{family}/acceptance.toml");
                acceptance(&tests, &place, sources);
            }
            name if name.starts_with("requirements") || name == "manual.toml" => {}
            _ => {
                let table: Table = parsed(&path)?;
                if table.contains_key("spec") {
                    specs.push(table);
                }
            }
        }
    }
    let used = used_machines(&specs);
    for spec in &specs {
        for (name, machine) in children(spec, "machine") {
            // A machine that no system has is not checked, so that its rules show nothing.
            if used.contains(name) {
                data(name, machine, &mut sources.rules);
            }
        }
        for (name, system) in children(spec, "system") {
            data(name, system, &mut sources.rules);
        }
    }
    Ok(())
}

/// The tests of the acceptance protocol. One with a scenario is run by the tests of the harness, too.
fn acceptance(tests: &Table, place: &str, sources: &mut Sources) {
    let tests = tests.get("test").and_then(Value::as_array);
    for test in tests.into_iter().flatten() {
        let name = test.get("id").and_then(Value::as_str).unwrap_or("");
        let ids = test.get("req").and_then(Value::as_array);
        let ids = ids.into_iter().flatten().filter_map(Value::as_str);
        for id in ids {
            add(&mut sources.data, id, &format!("acceptance.{name}"));
            if test.get("simulate").is_some() {
                add(&mut sources.tests, id, &format!("{place}: {name}"));
            }
        }
    }
}

fn children<'a>(table: &'a Table, key: &str) -> impl Iterator<Item = (&'a String, &'a Value)> {
    table
        .get(key)
        .and_then(Value::as_table)
        .into_iter()
        .flatten()
}

fn used_machines(specs: &[Table]) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for (_, system) in specs.iter().flat_map(|spec| children(spec, "system")) {
        let instances = system
            .get("instance")
            .and_then(Value::as_table)
            .into_iter()
            .flatten();
        used.extend(instances.filter_map(|(_, i)| i.get("machine")?.as_str().map(str::to_owned)));
    }
    used
}

/// Every table below `value` that names requirements by `id` (a list) or `req`. `owner` is the machine, system or file.
fn data(owner: &str, value: &Value, rules: &mut Named) {
    let mut open: BTreeMap<usize, (String, &Value)> =
        BTreeMap::from([(0, (owner.to_owned(), value))]);
    let mut next = 1;
    while let Some((_, (place, value))) = open.pop_first() {
        match value {
            Value::Table(table) => {
                for (key, inner) in table {
                    if let ("id" | "req", Some(list)) = (key.as_str(), inner.as_array()) {
                        list.iter()
                            .filter_map(Value::as_str)
                            .for_each(|id| add(rules, id, &place));
                    } else {
                        let grouping = matches!(
                            key.as_str(),
                            "rule" | "property" | "let" | "output" | "state" | "input" | "param"
                        );
                        let inner_place = if grouping {
                            place.clone()
                        } else {
                            format!("{place}.{key}")
                        };
                        open.insert(next, (inner_place, inner));
                        next += 1;
                    }
                }
            }
            Value::Array(list) => {
                for inner in list {
                    let name = ["name", "id", "variable"]
                        .iter()
                        .find_map(|k| inner.get(k)?.as_str());
                    let inner_place = name.map_or(place.clone(), |n| format!("{place}.{n}"));
                    open.insert(next, (inner_place, inner));
                    next += 1;
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_whole_words_of_known_prefixes() {
        let prefixes = BTreeSet::from(["F".to_owned()]);
        let text = "(F-STOP-001), `F-A2-123`: F-P-05 F-STOP-0012 X-STOP-001 F-STOP-001-X aF-STOP-001 F-STOP-002.";
        assert_eq!(
            ids(text, &prefixes),
            ["F-STOP-001", "F-A2-123", "F-STOP-002"]
        );
    }

    #[test]
    fn modules_are_files_or_folders() {
        let named = |[own, folder]: [Option<String>; 2]| (own, folder);
        let some = |name: &str| Some(name.to_owned());
        assert_eq!(
            named(modules("impl/src/sinumerik/channel/laws.rs")),
            (some("sinumerik::laws"), some("sinumerik::channel"))
        );
        assert_eq!(named(modules("impl/src/kernel.rs")), (None, None));
        let proofs = [(
            "base.rs".to_owned(),
            "    [contract c on sinumerik::stop {\n".to_owned(),
        )];
        assert_eq!(contract("impl/src/sinumerik/stop.rs", &proofs), Some("c"));
        assert_eq!(
            contract("impl/src/sinumerik/stop/laws.rs", &proofs),
            Some("c")
        );
        assert_eq!(
            contract("impl/src/sinumerik/folder/stop.rs", &proofs),
            Some("c")
        );
        assert_eq!(contract("impl/src/other/stop.rs", &proofs), None);
    }

    #[test]
    fn tables_name_their_rules() {
        let text = r#"
            spec = "x"
            [machine.stop.let]
            wanted = { value = "1", id = ["F-STOP-002"] }
            [[machine.stop.rule]]
            name = "rise"
            id = ["F-STOP-001"]
            [machine.idle.state]
            s = { type = "BOOL", id = ["F-STOP-003"] }
            [system.one.instance]
            stop = { machine = "stop" }
            [[system.one.property]]
            id = "P-01"
            req = ["F-STOP-001"]
        "#;
        let folder = std::env::temp_dir().join(format!("stillpoint-matrix-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join("a.toml"), text).expect("written");
        let exception = "[[exception]]\nid = [\"F-STOP-003\"]\nreason = \"r\"\n";
        std::fs::write(folder.join("exceptions.toml"), exception).expect("written");
        std::fs::write(folder.join("status.toml"), "family_complete = true\n").expect("written");
        let tests = "[[test]]\nid = \"SIMULATED\"\nreq = [\"F-TEST-001\"]\n[[test.simulate]]\ntext = \"\"\n\
                     [[test]]\nid = \"BY-HAND\"\nreq = [\"F-TEST-002\"]\n";
        std::fs::write(folder.join("acceptance.toml"), tests).expect("written");
        let chains = "[[group]]\nname = \"detect\"\n[[group.part]]\nreq = [\"F-TIME-001\"]\n";
        std::fs::write(folder.join("reaction-chain.toml"), chains).expect("written");
        let mut sources = Sources::default();
        tables(&folder, "f", &mut sources).expect("readable");
        let rules = &sources.rules;
        assert_eq!(
            rules["F-STOP-001"],
            BTreeSet::from(["stop.rise".to_owned(), "one.P-01".to_owned()])
        );
        assert_eq!(
            rules["F-STOP-002"],
            BTreeSet::from(["stop.wanted".to_owned()])
        );
        assert!(
            !rules.contains_key("F-STOP-003"),
            "no system has the machine"
        );
        let one = |place: &str| BTreeSet::from([place.to_owned()]);
        assert_eq!(sources.data["F-TEST-001"], one("acceptance.SIMULATED"));
        assert_eq!(sources.data["F-TEST-002"], one("acceptance.BY-HAND"));
        assert_eq!(
            sources.tests["F-TEST-001"],
            one("f/acceptance.toml: SIMULATED")
        );
        assert!(!sources.tests.contains_key("F-TEST-002"));
        assert!(
            sources.data["F-TIME-001"]
                .iter()
                .all(|p| p.starts_with("reaction-chain."))
        );
        assert_eq!(sources.exceptions.len(), 1);
        assert!(sources.complete.contains("f"));
        std::fs::write(folder.join("status.toml"), "family_complet = true\n").expect("written");
        assert!(tables(&folder, "f", &mut Sources::default()).is_err());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
