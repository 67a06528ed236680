//! `stillpoint reaction`, `stillpoint acceptance` and recordings for a machine with HEIDENHAIN functional safety.

mod acceptance;
mod conversion;
mod reaction;
mod recording;

use serde_json::Value;

use crate::common::{copied, stderr, stdout, stillpoint};

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

/// A copy of the machine and of its family in which texts of some files are replaced.
fn changed(name: &str, replace: &[(&str, &str, &str)]) -> String {
    copied(name, MACHINE, "spec/families/heidenhain-fs", replace)
}
