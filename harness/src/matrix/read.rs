//! Reads what the matrix is made of from the folders of a repository.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use stillpoint_lang::catalogue::{self, twice};
use stillpoint_lang::diag::Diagnostics;
use toml::{Table, Value};

use super::ids::ids;
use super::rust::{Found, Harness};
use super::{Evidence, EvidenceKind, Named, Sources, families, rust};

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

/// Reads the catalogues and tables of `spec/families/`, and of the Rust files of the repository the documented items and the clauses
/// of `impl/src`, the inventory of `proofs/src`, and the test functions of every crate; then the files that tests run.
///
/// # Errors
/// A folder or file that is missing, unreadable or of another form.
pub fn read(root: &Path) -> Result<Sources, ReadError> {
    for folder in ["spec/families", "impl/src", "proofs/src"] {
        if !root.join(folder).is_dir() {
            let message = format!(
                "{} has no folder {folder}; name the repository with --root",
                root.display()
            );
            return Err(ReadError::Other(message));
        }
    }
    let mut sources = Sources {
        catalogue: catalogue::load(&root.join("spec/families"))?,
        ..Sources::default()
    };
    let list = &sources.catalogue.requirements;
    let families: BTreeSet<String> = list.iter().map(|r| r.family.clone()).collect();
    let prefixes: BTreeSet<String> = list
        .iter()
        .filter_map(|r| r.id.split('-').next().map(str::to_owned))
        .collect();
    for family in &families {
        families::read(
            &root.join("spec/families").join(family),
            family,
            &mut sources,
        )?;
    }
    code(root, &prefixes, &mut sources)?;
    must_fail(root, &mut sources.tests)?;
    refused(root, &prefixes, &mut sources.tests)?;
    corpus(root, &mut sources.tests)?;
    printed(root, &prefixes, &mut sources.programs)?;
    Ok(sources)
}

/// A list of requirements, in which each stands once.
///
/// # Errors
/// The first that stands there twice, with the place.
pub(super) fn once(place: &str, list: &[String]) -> Result<(), ReadError> {
    match twice(list) {
        Some(id) => {
            let message = format!("{place} names {id} twice: remove one of them");
            Err(ReadError::Other(message))
        }
        None => Ok(()),
    }
}

pub(super) fn add(named: &mut Named, id: &str, kind: EvidenceKind, place: &str) {
    named.entry(id.to_owned()).or_default().insert(Evidence {
        kind,
        place: place.to_owned(),
    });
}

/// The Rust files of the repository.
fn code(root: &Path, prefixes: &BTreeSet<String>, sources: &mut Sources) -> Result<(), ReadError> {
    let mut clauses: Vec<(String, Found)> = Vec::new();
    let mut harnesses: Vec<Harness> = Vec::new();
    for (place, text) in texts(root, root, "rs")? {
        let monitor = place.starts_with("impl/src/") && !is_mutant(&place);
        let inventory = place.starts_with("proofs/src/inventory/");
        let language = place.starts_with("spec/logic/src/");
        // Most files name no requirement at a place that counts.
        if !monitor && !inventory && !language && !text.contains("#[test]") {
            continue;
        }
        let source = rust::parse(&text, prefixes)
            .map_err(|e| ReadError::Other(format!("{place} is no Rust: {e}")))?;
        for test in &source.tests {
            add_found(&mut sources.tests, EvidenceKind::Test, &place, test);
        }
        for clause in &source.clauses {
            once(
                &format!("{place}:{} {}", clause.line, clause.name),
                &clause.ids,
            )?;
        }
        for harness in &source.harnesses {
            once(&format!("{place} {}", harness.name), &harness.ids)?;
        }
        if monitor {
            for item in &source.items {
                add_found(&mut sources.monitors, EvidenceKind::Item, &place, item);
            }
            clauses.extend(source.clauses.into_iter().map(|c| (place.clone(), c)));
        }
        if language {
            for item in &source.items {
                let kind = EvidenceKind::Language;
                add_found(&mut sources.languages, kind, &place, item);
            }
        }
        if inventory {
            harnesses.extend(source.harnesses);
        }
    }
    for (place, clause) in clauses {
        // A clause without a harness is a sentence that nobody checks.
        let Some(harness) = contract(&place, &harnesses) else {
            continue;
        };
        add_found(&mut sources.monitors, EvidenceKind::Clause, &place, &clause);
        let proof = format!("{harness} {}", clause.name);
        for id in &clause.ids {
            add(&mut sources.proofs, id, EvidenceKind::Clause, &proof);
        }
    }
    for harness in harnesses {
        for id in &harness.ids {
            add(&mut sources.proofs, id, EvidenceKind::Run, &harness.name);
        }
    }
    Ok(())
}

fn add_found(named: &mut Named, kind: EvidenceKind, place: &str, found: &Found) {
    let place = format!("{place}:{} {}", found.line, found.name);
    for id in &found.ids {
        add(named, id, kind, &place);
    }
}

/// Whether a file holds monitors that are wrong on purpose.
fn is_mutant(place: &str) -> bool {
    place
        .split('/')
        .any(|part| part == "mutant" || part == "mutant.rs")
}

/// The harness of the contract of the module a file of `impl/src` belongs to: `stop_contract` for
/// `impl/src/family/stop.rs`, where the inventory says `[contract stop_contract on family::stop {`.
fn contract<'a>(place: &str, harnesses: &'a [Harness]) -> Option<&'a str> {
    modules(place).into_iter().find_map(|module| {
        harnesses
            .iter()
            .find(|h| h.contract.as_ref() == Some(&module))
            .map(|h| h.name.as_str())
    })
}

/// The modules a file of `impl/src` may belong to, the nearest first: one of its own, or one of its folders'. `family::stop` for
/// `impl/src/family/stop.rs`, `family::channel` for `impl/src/family/channel/laws.rs` and for
/// `impl/src/family/part/channel/laws.rs`; none for what all families share.
fn modules(place: &str) -> Vec<String> {
    let inside = place
        .strip_prefix("impl/src/")
        .and_then(|rest| rest.split_once('/'));
    let Some((family, path)) = inside else {
        return Vec::new();
    };
    path.rsplit('/')
        .map(|part| format!("{family}::{}", part.strip_suffix(".rs").unwrap_or(part)))
        .collect()
}

/// The must-fail set: of each file the property that its second line expects to be violated. What else the file names is
/// the frame of the seeded error, and shows nothing.
fn must_fail(root: &Path, tests: &mut Named) -> Result<(), ReadError> {
    for (place, text) in below(root, "tests/must-fail")? {
        let expected = text
            .lines()
            .find_map(|line| line.strip_prefix("# expect: "))
            .and_then(|rest| rest.split_once(" violated"))
            .map(|(property, _)| property);
        let spec: Table = families::parsed(&root.join(&place))?;
        for (_, system) in families::children(&spec, "system") {
            let list = system.get("property").and_then(Value::as_array);
            let found = list
                .into_iter()
                .flatten()
                .filter(|p| p.get("id").and_then(Value::as_str) == expected)
                .filter_map(|p| p.get("req")?.as_array())
                .flatten()
                .filter_map(Value::as_str);
            for id in found {
                add(tests, id, EvidenceKind::MustFail, &place);
            }
        }
    }
    Ok(())
}

/// The machine files that must be refused, by the ids that the refusal prints: a test compares this snapshot with the refusals.
fn refused(root: &Path, prefixes: &BTreeSet<String>, tests: &mut Named) -> Result<(), ReadError> {
    let list = root.join("spec/machine/tests/snapshots/machine_files__bad_input.snap");
    if !list.is_file() {
        return Ok(());
    }
    for line in texts_of(&list)?.lines() {
        let (Some((file, _)), Some((_, rules))) = (line.split_once(':'), line.rsplit_once('['))
        else {
            continue;
        };
        for id in ids(rules, prefixes) {
            let place = format!("tests/bad-input/{file}");
            add(tests, &id, EvidenceKind::Refused, &place);
        }
    }
    Ok(())
}

/// The worked examples of the manuals: each case with its list `requirements`.
fn corpus(root: &Path, tests: &mut Named) -> Result<(), ReadError> {
    for (place, _) in below(root, "tests/corpus")? {
        let file: Table = families::parsed(&root.join(&place))?;
        let mut open = vec![(place, &file)];
        while let Some((place, table)) = open.pop() {
            let names = ["name", "id"];
            let name = names.iter().find_map(|k| table.get(*k)?.as_str());
            let place = name.map_or(place.clone(), |n| format!("{place} {n}"));
            let list = strings(table.get("requirements"));
            once(&place, &list)?;
            for id in &list {
                add(tests, id, EvidenceKind::Corpus, &place);
            }
            let inner = table.values().flat_map(|value| match value {
                Value::Array(list) => list.iter().filter_map(Value::as_table).collect(),
                Value::Table(table) => vec![table],
                _ => Vec::new(),
            });
            open.extend(inner.map(|table| (place.clone(), table)));
        }
    }
    Ok(())
}

/// The texts of a list; nothing where there is none.
pub(super) fn strings(list: Option<&Value>) -> Vec<String> {
    let list = list.and_then(Value::as_array);
    let texts = list.into_iter().flatten().filter_map(Value::as_str);
    texts.map(str::to_owned).collect()
}

/// The programs that manuals print, by the comments of their lines.
fn printed(
    root: &Path,
    prefixes: &BTreeSet<String>,
    programs: &mut Named,
) -> Result<(), ReadError> {
    let tests = root.join("tests");
    if !tests.is_dir() {
        return Ok(());
    }
    for (ending, begins) in [("stl", "//"), ("spf", ";")] {
        for (place, text) in texts(root, &tests, ending)? {
            for (at, line) in text.lines().enumerate() {
                let comment = line.split_once(begins).map_or("", |(_, comment)| comment);
                for id in ids(comment, prefixes) {
                    let place = format!("{place}:{}", at + 1);
                    add(programs, &id, EvidenceKind::Program, &place);
                }
            }
        }
    }
    Ok(())
}

fn hidden(path: &Path) -> bool {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or("");
    name.starts_with('.') || name == "target"
}

pub(super) fn entries(folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let fail =
        |e: std::io::Error| ReadError::Other(format!("{} cannot be listed: {e}", folder.display()));
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        out.push(entry.map_err(fail)?.path());
    }
    out.sort();
    Ok(out)
}

/// The TOML files below a folder of the repository that need not exist.
fn below(root: &Path, folder: &str) -> Result<BTreeMap<String, String>, ReadError> {
    let path = root.join(folder);
    if !path.is_dir() {
        return Ok(BTreeMap::new());
    }
    Ok(texts(root, &path, "toml")?.into_iter().collect())
}

/// The files below a folder with this ending, named from the root.
fn texts(root: &Path, folder: &Path, ending: &str) -> Result<Vec<(String, String)>, ReadError> {
    let mut out = Vec::new();
    for path in entries(folder)? {
        if hidden(&path) {
            continue;
        }
        if path.is_dir() {
            out.extend(texts(root, &path, ending)?);
        } else if path.extension().is_some_and(|e| e == ending) {
            let place = path.strip_prefix(root).unwrap_or(&path);
            let place = place.to_string_lossy().replace('\\', "/");
            out.push((place, texts_of(&path)?));
        }
    }
    Ok(out)
}

fn texts_of(path: &Path) -> Result<String, ReadError> {
    std::fs::read_to_string(path)
        .map_err(|e| ReadError::Other(format!("{} cannot be read: {e}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_files_or_folders() {
        assert_eq!(
            modules("impl/src/family/part/channel/laws.rs"),
            ["family::laws", "family::channel", "family::part"]
        );
        assert!(modules("impl/src/kernel.rs").is_empty());
        let harnesses = [Harness {
            name: "c".to_owned(),
            contract: Some("family::stop".to_owned()),
            ids: Vec::new(),
        }];
        let found = |place| contract(place, &harnesses);
        assert_eq!(found("impl/src/family/stop.rs"), Some("c"));
        assert_eq!(found("impl/src/family/stop/laws.rs"), Some("c"));
        assert_eq!(found("impl/src/family/part/stop/laws.rs"), Some("c"));
        assert_eq!(found("impl/src/family/folder/stop.rs"), Some("c"));
        assert_eq!(found("impl/src/other/stop.rs"), None);
    }
}
