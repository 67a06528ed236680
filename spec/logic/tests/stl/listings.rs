//! The programs that chapter 10 of the manual prints for the PLC. They are set again by hand, since the print has lost the order of its
//! columns; each file names its lines, and what was restored.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use stillpoint_logic::stl::{Program, Used, parse};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/corpus/sinumerik-840d/stl")
}

fn listing(name: &str) -> Program {
    let path = folder().join(format!("{name}.stl"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
    parse(name, &Arc::from(text.as_str())).unwrap_or_else(|e| panic!("{e}"))
}

/// What a program reads and does not write, and what it writes and does not read.
fn told(name: &str) -> String {
    let program = listing(name);
    let bits = program.bits();
    let list = |of: fn(&&Used) -> bool| {
        let shown: Vec<String> = bits.iter().filter(of).map(|u| u.bit.to_string()).collect();
        shown.join(" ")
    };
    format!(
        "{}\nread: {}\nwritten: {}\nboth: {}\n",
        program.name(),
        list(|u| u.reads && !u.writes),
        list(|u| u.writes && !u.reads),
        list(|u| u.reads && u.writes)
    )
}

const NAMES: [&str; 7] = [
    "brake",
    "brake-test",
    "emergency-stop",
    "forced-checking",
    "key-and-door",
    "light-barrier",
    "profisafe",
];

#[test]
fn every_listing_is_read() {
    let all: Vec<String> = NAMES
        .iter()
        .map(|name| format!("--- {name}\n{}", told(name)))
        .collect();
    insta::assert_snapshot!(all.join("\n"));
}

#[test]
fn every_listing_of_the_folder_is_tried() {
    let files = std::fs::read_dir(folder()).unwrap_or_else(|e| panic!("{e}"));
    let mut found: Vec<String> = files
        .map(|file| file.unwrap_or_else(|e| panic!("{e}")).path())
        .map(|path| {
            path.file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    found.sort();
    assert_eq!(found, NAMES);
}
