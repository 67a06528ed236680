//! `stillpoint reaction` and `stillpoint acceptance` for a machine with HEIDENHAIN functional safety.

mod acceptance;
#[path = "../common/mod.rs"]
mod common;
mod reaction;

use std::path::Path;

use serde_json::Value;

use common::{root, stderr, stdout, stillpoint};

const MACHINE: &str = "spec/machines/machining-centre-heidenhain.toml";

fn json(arguments: &[&str]) -> Value {
    let mut all = arguments.to_vec();
    all.push("--json");
    let output = stillpoint(&all);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{all:?}: {}",
        stderr(&output)
    );
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// A copy of the family and of the machine in which texts of some files are replaced.
fn changed(name: &str, replace: &[(&str, &str, &str)]) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let family = folder.join("spec/heidenhain-fs");
    std::fs::create_dir_all(&family).expect("a folder");
    for entry in std::fs::read_dir(root().join("spec/heidenhain-fs")).expect("the family") {
        let path = entry.expect("an entry").path();
        std::fs::copy(&path, family.join(path.file_name().expect("a name"))).expect("copied");
    }
    std::fs::copy(root().join(MACHINE), folder.join("machine.toml")).expect("copied");
    for (file, from, to) in replace {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).expect("readable");
        assert!(text.contains(from), "{file} has no {from}");
        std::fs::write(&path, text.replacen(from, to, 1)).expect("written");
    }
    folder.join("machine.toml").display().to_string()
}
