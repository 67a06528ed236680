//! How the sources are laid out: a family is registered in one list of the harness, and no general file of the harness names one;
//! modules have one style.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use stillpoint_harness::families::FAMILIES;
use stillpoint_tests::{exceptions, root};

/// The sources below a folder, without those of `leave`.
fn sources(folder: &Path, leave: &[PathBuf], found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for entry in entries {
        let path = entry.expect("an entry").path();
        if leave.contains(&path) {
            continue;
        }
        if path.is_dir() {
            sources(&path, leave, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// What follows a name in a text, wherever it stands there between anything but letters.
fn behind<'a>(text: &'a str, name: &'a str) -> impl Iterator<Item = &'a str> {
    text.match_indices(name).filter_map(|(at, name)| {
        let letter = |c: char| c.is_ascii_alphabetic();
        let rest = &text[at + name.len()..];
        (!text[..at].ends_with(letter) && !rest.starts_with(letter)).then_some(rest)
    })
}

#[test]
fn a_name_is_a_word() {
    let found = |text| behind(text, "iec").collect::<Vec<_>>();
    for (text, rest) in [
        ("iec::x", "::x"),
        ("of iec", ""),
        ("an iec_cam", "_cam"),
        ("niece iec2", "2"),
    ] {
        assert_eq!(found(text), [rest]);
    }
    for text in ["piece", "pieces::new", "iecs", "ie c", ""] {
        assert!(found(text).is_empty(), "{text}");
    }
}

/// The rooms of the families and their list are the only places; the commands name families in the examples of their help alone.
#[test]
fn no_general_file_names_a_family() {
    let home = root().join("harness/src/families");
    let mut leave: Vec<PathBuf> = FAMILIES.map(|f| home.join(f.module)).into();
    assert!(leave.iter().all(|room| room.is_dir()), "each has its room");
    leave.push(home.join("mod.rs"));
    let mut all = Vec::new();
    sources(&root().join("harness/src"), &leave, &mut all);
    sources(&root().join("harness/engine/src"), &leave, &mut all);
    let general = all.len();
    sources(&root().join("harness/cli/src"), &leave, &mut all);
    assert!(general > 100, "{general} files");
    let mut wrong = Vec::new();
    for (k, path) in all.iter().enumerate() {
        let text = std::fs::read_to_string(path)
            .expect("readable")
            .to_lowercase()
            // A standard of programming languages, which is no family.
            .replace("iec 61131", "");
        for family in FAMILIES {
            // In the commands the name of a family may be an example, its module may not.
            let module = behind(&text, family.module).any(|rest| rest.starts_with("::"));
            let named = [family.module, family.name]
                .iter()
                .any(|name| behind(&text, name).next().is_some());
            if module || (k < general && named) {
                wrong.push(format!("{}: {}", path.display(), family.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The list has every family of the data that has monitors, each once, and each entry is told from the others by both its names.
#[test]
fn each_family_is_registered_once() {
    let names: BTreeSet<&str> = FAMILIES.iter().map(|f| f.name).collect();
    let modules: BTreeSet<&str> = FAMILIES.iter().map(|f| f.module).collect();
    assert_eq!(
        (names.len(), modules.len()),
        (FAMILIES.len(), FAMILIES.len())
    );
    let folder = std::fs::read_dir(root().join("impl/src")).expect("the monitors");
    let rooms: BTreeSet<String> = folder
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_dir())
        .map(|path| {
            path.file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    assert_eq!(
        modules
            .iter()
            .map(|m| (*m).to_owned())
            .collect::<BTreeSet<_>>(),
        rooms
    );
    let mut without = BTreeSet::new();
    for family in FAMILIES {
        let folder = root().join("spec/families").join(family.name);
        assert!(folder.join("manual.toml").is_file());
        assert!((family.mutants)().iter().all(|m| m.family == family.module));
        assert!(!(family.mutants)().is_empty());
        // Monitors may come before the tables that they are compared with, and before what a machine file may say.
        let compared = family.peers.machines().count() > 0;
        if compared && !folder.join("family.toml").is_file() {
            without.insert(family.name.to_owned());
        }
    }
    assert_eq!(without, exceptions("family without machine files"));
}

/// A module with files of its own is a folder with `mod.rs`: no file stands beside a folder of its name.
#[test]
fn modules_have_one_style() {
    let mut all = Vec::new();
    for folder in ["harness", "impl", "model", "proofs", "spec", "tests"] {
        sources(&root().join(folder), &[], &mut all);
    }
    assert!(all.len() > 400, "{} files", all.len());
    let folders = all.iter().filter(|path| path.ends_with("mod.rs")).count();
    assert!(folders > 50, "{folders} folders");
    let has_files = |folder: PathBuf| all.iter().any(|path| path.starts_with(&folder));
    let beside = all.iter().filter(|path| has_files(path.with_extension("")));
    let beside: Vec<_> = beside.collect();
    assert!(beside.is_empty(), "{beside:#?}");
}

/// The libraries have `doctest = false`, which spares the tests a reading of each: an example in Rust would not be run.
#[test]
fn no_comment_has_an_example_that_nothing_runs() {
    let mut all = Vec::new();
    for folder in ["harness", "impl", "model", "proofs", "spec", "tests"] {
        sources(&root().join(folder), &[], &mut all);
    }
    assert!(all.len() > 500, "{} files", all.len());
    for path in all {
        let text = std::fs::read_to_string(&path).expect("readable");
        let lines = text.lines().map(str::trim_start);
        let comments = lines.filter(|l| l.starts_with("//!") || l.starts_with("///"));
        let fences = comments.filter_map(|l| l[3..].trim_start().strip_prefix("```"));
        for opening in fences.step_by(2) {
            let words = ["text", "toml", "json", "sh"];
            assert!(
                words.contains(&opening),
                "{}: an example in '{opening}'",
                path.display()
            );
        }
    }
}

/// Of the libraries with `test = false` no test in the sources would be run, but for those of the modules that `harness/tests/unit`
/// compiles alone.
#[test]
fn no_library_has_tests_that_nothing_runs() {
    let folder = root().join("harness/tests/unit");
    let unit = std::fs::read_to_string(folder.join("main.rs")).expect("readable");
    let alone = unit
        .split('"')
        .filter(|text| text.starts_with("../../src/"));
    let alone: Vec<PathBuf> = alone
        .map(|path| folder.join(path).canonicalize().expect("a module"))
        .collect();
    assert!(alone.len() >= 9, "{alone:?}");
    let is_alone = |path: &Path| {
        let path = path.canonicalize().expect("a source");
        let inside = |module: &PathBuf| {
            let folder = module.parent().filter(|_| module.ends_with("mod.rs"));
            folder.is_some_and(|folder| path.starts_with(folder))
        };
        alone.contains(&path) || alone.iter().any(inside)
    };
    let mut all = Vec::new();
    for folder in ["harness", "impl", "model", "proofs", "spec", "tests"] {
        sources(&root().join(folder), &[], &mut all);
    }
    let manifest = |path: &Path| {
        let folders = path.ancestors().skip(1);
        let mut manifests = folders.map(|folder| folder.join("Cargo.toml"));
        let manifest = manifests.find(|manifest| manifest.is_file());
        std::fs::read_to_string(manifest.expect("a crate")).expect("readable")
    };
    let mut libraries = 0;
    for path in all {
        let below = path.strip_prefix(root()).expect("below the root");
        let in_tests = below.components().any(|part| part.as_os_str() == "tests");
        if in_tests || !manifest(&path).contains("\ntest = false") || is_alone(&path) {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("readable");
        let has_tests = text.lines().any(|line| line.trim() == "#[test]");
        assert!(!has_tests, "{}: never run", path.display());
        libraries += 1;
    }
    assert!(libraries > 100, "{libraries} files");
}
