//! The programs that chapter 10 of the manual prints, as they are printed: each is read with exactly the repairs that are listed here,
//! and refused without them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use stillpoint_logic::spf::{Mode, Program, parse};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/corpus/sinumerik-840d/safe-spf")
}

fn text(name: &str) -> Arc<str> {
    let path = folder().join(format!("{name}.spf"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
    Arc::from(text.as_str())
}

fn listing(name: &str) -> Program {
    parse(name, &text(name), Mode::Listing).unwrap_or_else(|e| panic!("{e}"))
}

/// The repairs and notes of a listing, the program as it was understood, and what is said of it without repairs.
fn understood(name: &str) -> String {
    let program = listing(name);
    let notes: Vec<String> = program.notes().iter().map(ToString::to_string).collect();
    let strict = match parse(name, &text(name), Mode::Strict) {
        Ok(_) => "accepted".to_owned(),
        Err(errors) => errors.to_string(),
    };
    let kind = if program.is_fragment() {
        "a part"
    } else {
        "a program"
    };
    format!(
        "{kind}, {}\n{program}\n--- notes\n{}\n--- strict\n{strict}\n",
        program.name(),
        notes.join("\n")
    )
}

macro_rules! listings {
    ($($test:ident $name:literal)*) => {
        const NAMES: &[&str] = &[$($name),*];
        $(#[test] fn $test() { insta::assert_snapshot!($name, understood($name)); })*
    };
}

listings! {
    definitions "definitions"
    emergency_stop "emergency-stop"
    test_stop "test-stop"
    acknowledgement "acknowledgement"
    the_main_example "main"
    light_barrier "light-barrier"
    profisafe "profisafe"
    brake "brake"
    cam "cam"
    retraction "esr"
}

/// Each is read with its repairs: S840D-LANG-701.
#[test]
fn every_listing_of_the_folder_is_tried() {
    let files = std::fs::read_dir(folder()).unwrap_or_else(|e| panic!("{e}"));
    let mut found: Vec<String> = files
        .map(|file| file.unwrap_or_else(|e| panic!("{e}")).path())
        .filter(|path| path.extension().is_some_and(|e| e == "spf"))
        .map(|path| {
            path.file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    found.sort();
    let mut tried: Vec<&str> = NAMES.to_vec();
    tried.sort_unstable();
    assert_eq!(found, tried);
}
