//! What the end-to-end tests share: where the files of the project are, what tests leave out, how to run other tools, how
//! single guarantees are decided, what fuzzers drive, a reader of BTOR2.

pub mod btor2;
pub mod drive;
pub mod fuzz;
pub mod guarantees;
pub mod peer;
pub mod random;
pub mod telegram;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::Deserialize;

/// The root of the workspace. Who asks for it works with its files, and gets their generated tables too, as the binary does.
pub fn root() -> PathBuf {
    stillpoint_engine::table::provide(&stillpoint_tables::FAMILIES);
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// What is compared daily, where a slow test compares all: every fourth.
pub fn daily<T>(all: Vec<T>) -> Vec<T> {
    all.into_iter().step_by(4).collect()
}

/// The files with this extension in a folder of the workspace, in the order of their names.
///
/// # Panics
/// If there is no such folder or no such file in it: a test over no files would show nothing.
pub fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let dir = root().join(folder);
    let mut found: Vec<PathBuf> = std::fs::read_dir(&dir)
        .unwrap_or_else(|e| panic!("{}: {e}", dir.display()))
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == extension))
        .collect();
    found.sort();
    assert!(!found.is_empty(), "no .{extension} in {}", dir.display());
    found
}

/// The specification files that ship with the project: those of the folders for which code is generated. A family without
/// `family.toml` is under construction and not among them.
pub fn specification_files() -> Vec<PathBuf> {
    let families = families().into_iter().filter(|f| registered(f));
    specifications(families.chain([root().join("spec/bench")]))
}

/// The specification files of the families under construction: no code is generated for them, and no machine file names them.
pub fn files_under_construction() -> Vec<PathBuf> {
    specifications(families().into_iter().filter(|f| !registered(f)))
}

/// The folders of the families.
fn families() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("spec/families")).expect("the families");
    entries.map(|e| e.expect("an entry").path()).collect()
}

/// Whether the family of this folder is finished: machine files can be written for it, or it is one of functions alone.
fn registered(folder: &Path) -> bool {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    folder.join("family.toml").exists()
        || exceptions("family without machine files").contains(name.as_ref())
}

/// The specification files of these folders, in the order of their names.
fn specifications(folders: impl Iterator<Item = PathBuf>) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in folders {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let is_toml = path.extension().is_some_and(|e| e == "toml");
            if is_toml
                && std::fs::read_to_string(&path)
                    .is_ok_and(|t| t.lines().any(|l| l.starts_with("spec ")))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// `tests/exceptions.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exceptions {
    exception: Vec<Exception>,
}

/// What a test leaves out for one reason.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exception {
    test: String,
    reason: String,
    of: Vec<String>,
}

/// What a test leaves out, by `tests/exceptions.toml`. The test must compare it with what it has met, so that no exception
/// outlives its reason.
///
/// # Panics
/// If the file is not as it must be, has nothing for this test, or the same thing twice.
pub fn exceptions(test: &str) -> BTreeSet<String> {
    let text = std::fs::read_to_string(root().join("tests/exceptions.toml"))
        .unwrap_or_else(|e| panic!("exceptions.toml: {e}"));
    let all: Exceptions = toml::from_str(&text).unwrap_or_else(|e| panic!("exceptions.toml: {e}"));
    let mut found = BTreeSet::new();
    for one in all.exception.into_iter().filter(|e| e.test == test) {
        assert!(!one.reason.is_empty(), "{test}: an exception has no reason");
        for name in one.of {
            assert!(!found.contains(&name), "{test}: {name} stands twice");
            found.insert(name);
        }
    }
    assert!(!found.is_empty(), "{test} has no exceptions");
    found
}
