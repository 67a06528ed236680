//! Reads what the files of a family say of requirements: tables, data, acceptance tests, sentences and exceptions.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::Deserialize;
use stillpoint_lang::read_text;
use toml::{Table, Value};

use super::ids::is_sentence;
use super::read::{ReadError, add, entries, once, strings};
use super::{EvidenceKind, Exception, Named, Sources};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exceptions {
    #[serde(default)]
    exception: Vec<Excepted>,
    #[serde(default)]
    delegated: Vec<Delegated>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Excepted {
    id: Vec<String>,
    reason: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Delegated {
    id: Vec<String>,
    test: String,
    reason: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sentences {
    requirement: BTreeMap<String, BTreeMap<String, String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Declared {
    family_complete: bool,
}

pub(super) fn parsed<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, ReadError> {
    let text = read_text(path, "file of a family")?;
    toml::from_str(&text)
        .map_err(|e| ReadError::Other(format!("{}: {}", path.display(), e.to_string().trim())))
}

/// The specification files, family data, signals, sentences, exceptions and status of one family.
pub(super) fn read(folder: &Path, family: &str, sources: &mut Sources) -> Result<(), ReadError> {
    let mut specs: Vec<Table> = Vec::new();
    for path in entries(folder)?
        .into_iter()
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
    {
        match path.file_name().and_then(|n| n.to_str()).unwrap_or("") {
            "exceptions.toml" => exceptions(&path, family, sources)?,
            "sentences.toml" => sentences(&path, sources)?,
            "status.toml" => {
                let Declared { family_complete } = parsed(&path)?;
                if family_complete {
                    sources.complete.insert(family.to_owned());
                }
            }
            name @ ("family.toml" | "signals.toml" | "alarms.toml") => {
                let owner = name.trim_end_matches(".toml");
                let data = Value::Table(parsed(&path)?);
                named(EvidenceKind::Data, owner, &data, &mut sources.rules)?;
            }
            "reaction-chain.toml" => {
                let chains = Value::Table(parsed(&path)?);
                named(
                    EvidenceKind::Chain,
                    "reaction-chain",
                    &chains,
                    &mut sources.data,
                )?;
            }
            "acceptance.toml" => {
                let tests: Table = parsed(&path)?;
                acceptance(&tests, family, sources)?;
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
    tables(&specs, sources)
}

fn exceptions(path: &Path, family: &str, sources: &mut Sources) -> Result<(), ReadError> {
    let Exceptions {
        exception,
        delegated,
    } = parsed(path)?;
    let plain = exception.into_iter().map(|e| (e.id, e.reason, None));
    let passed = delegated
        .into_iter()
        .map(|e| (e.id, e.reason, Some(e.test)));
    for (ids, reason, test) in plain.chain(passed) {
        if reason.trim().is_empty() {
            let message = format!("{}: an exception without reason", path.display());
            return Err(ReadError::Other(message));
        }
        for id in ids {
            if sources.exceptions.iter().any(|e| e.id == id) {
                let message = format!("{}: {id} has two reasons", path.display());
                return Err(ReadError::Other(message));
            }
            sources.exceptions.push(Exception {
                family: family.to_owned(),
                id,
                reason: reason.clone(),
                test: test.clone(),
            });
        }
    }
    Ok(())
}

fn sentences(path: &Path, sources: &mut Sources) -> Result<(), ReadError> {
    let Sentences { requirement } = parsed(path)?;
    for (id, list) in requirement {
        let wrong = list
            .iter()
            .any(|(name, text)| !is_sentence(name) || text.trim().is_empty());
        if list.len() < 2 || wrong {
            let message = format!(
                "{}: {id} needs two or more sentences, each with a small letter as its name and a text",
                path.display()
            );
            return Err(ReadError::Other(message));
        }
        sources.sentences.insert(id, list);
    }
    Ok(())
}

/// The tests of the acceptance protocol. Only one with a scenario is evidence: the tests of the harness run it. To the others
/// a requirement can be delegated.
fn acceptance(tests: &Table, family: &str, sources: &mut Sources) -> Result<(), ReadError> {
    let tests = tests.get("test").and_then(Value::as_array);
    for test in tests.into_iter().flatten() {
        let name = test.get("id").and_then(Value::as_str).unwrap_or("");
        let list = strings(test.get("req"));
        once(&format!("{family}/acceptance.toml {name}"), &list)?;
        let ids: BTreeSet<String> = list.into_iter().collect();
        if test.get("simulate").is_some() {
            for id in &ids {
                let place = format!("{family}/acceptance.toml {name}");
                add(&mut sources.data, id, EvidenceKind::Acceptance, &place);
                add(&mut sources.tests, id, EvidenceKind::Acceptance, &place);
            }
        }
        let key = (family.to_owned(), name.to_owned());
        sources.acceptance.insert(key, ids);
    }
    Ok(())
}

/// The machines that a system has, and the systems.
fn tables(specs: &[Table], sources: &mut Sources) -> Result<(), ReadError> {
    let used = used_machines(specs);
    for spec in specs {
        for (name, machine) in children(spec, "machine") {
            // A machine that no system has is not checked, so that its rules show nothing.
            if used.contains(name) {
                named(EvidenceKind::Definition, name, machine, &mut sources.rules)?;
            }
        }
        for (name, system) in children(spec, "system") {
            named(EvidenceKind::Definition, name, system, &mut sources.rules)?;
        }
    }
    Ok(())
}

pub(super) fn children<'a>(
    table: &'a Table,
    key: &str,
) -> impl Iterator<Item = (&'a String, &'a Value)> {
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

/// Every table below `value` that names requirements by `id` (a list) or `req`. `owner` is the machine, system or file, `kind`
/// what a place is that stands below neither `rule` nor `property`.
fn named(
    kind: EvidenceKind,
    owner: &str,
    value: &Value,
    rules: &mut Named,
) -> Result<(), ReadError> {
    let mut open = vec![(kind, owner.to_owned(), value)];
    while let Some((kind, place, value)) = open.pop() {
        match value {
            Value::Table(table) => {
                for (key, inner) in table {
                    if matches!(key.as_str(), "id" | "req") && inner.is_array() {
                        let list = strings(Some(inner));
                        once(&place, &list)?;
                        list.iter().for_each(|id| add(rules, id, kind, &place));
                        continue;
                    }
                    let grouping = [
                        "rule", "property", "let", "output", "state", "input", "param",
                    ]
                    .contains(&key.as_str());
                    let inner_kind = match (kind, key.as_str()) {
                        (EvidenceKind::Definition, "rule") => EvidenceKind::Rule,
                        (EvidenceKind::Definition, "property") => EvidenceKind::Property,
                        _ => kind,
                    };
                    let inner_place = if grouping {
                        place.clone()
                    } else {
                        format!("{place}.{key}")
                    };
                    open.push((inner_kind, inner_place, inner));
                }
            }
            Value::Array(list) => {
                for inner in list {
                    let name = ["name", "id", "variable"]
                        .iter()
                        .find_map(|k| inner.get(k)?.as_str());
                    let inner_place = name.map_or(place.clone(), |n| format!("{place}.{n}"));
                    open.push((kind, inner_place, inner));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::Evidence;
    use super::*;

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
        let write = |name: &str, text: &str| {
            std::fs::write(folder.join(name), text).expect("written");
        };
        write("a.toml", text);
        write(
            "exceptions.toml",
            "[[exception]]\nid = [\"F-STOP-003\"]\nreason = \"r\"\n\
             [[delegated]]\nid = [\"F-TEST-002\"]\ntest = \"BY-HAND\"\nreason = \"seen at the machine only\"\n",
        );
        write(
            "sentences.toml",
            "[requirement.F-STOP-001]\na = \"one\"\nb = \"two\"\n",
        );
        write("status.toml", "family_complete = true\n");
        write(
            "acceptance.toml",
            "[[test]]\nid = \"SIMULATED\"\nreq = [\"F-TEST-001\"]\n[[test.simulate]]\ntext = \"\"\n\
             [[test]]\nid = \"BY-HAND\"\nreq = [\"F-TEST-002\"]\n",
        );
        write(
            "reaction-chain.toml",
            "[[group]]\nname = \"detect\"\n[[group.part]]\nreq = [\"F-TIME-001\"]\n",
        );
        let mut sources = Sources::default();
        read(&folder, "f", &mut sources).expect("readable");
        let one = |kind, place: &str| Evidence {
            kind,
            place: place.to_owned(),
        };
        let rules = &sources.rules;
        assert_eq!(
            rules["F-STOP-001"],
            BTreeSet::from([
                one(EvidenceKind::Rule, "stop.rise"),
                one(EvidenceKind::Property, "one.P-01")
            ])
        );
        assert_eq!(
            rules["F-STOP-002"],
            BTreeSet::from([one(EvidenceKind::Definition, "stop.wanted")])
        );
        assert!(
            !rules.contains_key("F-STOP-003"),
            "no system has the machine"
        );
        let simulated =
            BTreeSet::from([one(EvidenceKind::Acceptance, "f/acceptance.toml SIMULATED")]);
        assert_eq!(sources.data["F-TEST-001"], simulated);
        assert_eq!(sources.tests["F-TEST-001"], simulated);
        // A test that nobody runs here shows nothing.
        assert!(!sources.data.contains_key("F-TEST-002"));
        assert!(!sources.tests.contains_key("F-TEST-002"));
        let by_hand = &sources.acceptance[&("f".to_owned(), "BY-HAND".to_owned())];
        assert!(by_hand.contains("F-TEST-002"));
        assert!(
            sources.data["F-TIME-001"]
                .iter()
                .all(|e| e.kind == EvidenceKind::Chain && e.place.starts_with("reaction-chain."))
        );
        let tests: Vec<Option<&str>> = sources
            .exceptions
            .iter()
            .map(|e| e.test.as_deref())
            .collect();
        assert_eq!(tests, [None, Some("BY-HAND")]);
        assert_eq!(sources.sentences["F-STOP-001"].len(), 2);
        assert!(sources.complete.contains("f"));
        for (file, text) in [
            ("status.toml", "family_complet = true\n"),
            ("sentences.toml", "[requirement.F-STOP-001]\na = \"one\"\n"),
            (
                "sentences.toml",
                "[requirement.F-STOP-001]\na = \"one\"\nB = \"two\"\n",
            ),
            (
                "exceptions.toml",
                "[[exception]]\nid = [\"F-STOP-003\"]\nreason = \" \"\n",
            ),
            (
                "exceptions.toml",
                "[[exception]]\nid = [\"F-A-001\", \"F-A-001\"]\nreason = \"r\"\n",
            ),
            (
                "acceptance.toml",
                "[[test]]\nid = \"BY-HAND\"\nreq = [\"F-TEST-002\", \"F-TEST-002\"]\n",
            ),
            (
                "reaction-chain.toml",
                "[[group]]\nname = \"detect\"\nreq = [\"F-A-001\", \"F-A-002\", \"F-A-001\"]\n",
            ),
        ] {
            let kept = std::fs::read_to_string(folder.join(file)).expect("written above");
            write(file, text);
            assert!(
                read(&folder, "f", &mut Sources::default()).is_err(),
                "{text}"
            );
            write(file, &kept);
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
