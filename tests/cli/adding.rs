//! "How to add a monitor" of the book is done in a copy of the sources, word for word, and the new monitor is proven, its wrong
//! variant killed, and compared with its table.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{Folder, root};

/// A section of the page: the file that its heading names, and its blocks.
struct Section {
    file: PathBuf,
    blocks: Vec<String>,
}

fn sections(page: &str) -> Vec<Section> {
    let parts = page.split("\n## ").skip(1);
    let section = |part: &str| {
        let file = part.split('`').nth(1).expect("a file in the heading");
        let blocks = part.split("\n```").skip(1).step_by(2);
        let block = |b: &str| b.split_once('\n').expect("a fence has a line").1.to_owned() + "\n";
        Section {
            file: PathBuf::from(file),
            blocks: blocks.map(block).collect(),
        }
    };
    parts.map(section).collect()
}

/// The sources, without what was built of them.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let entry = entry.expect("an entry");
        let (name, target) = (entry.file_name(), to.join(entry.file_name()));
        if entry.file_type().expect("a type").is_dir() {
            if name != "target" && name != ".git" {
                copy(&entry.path(), &target);
            }
        } else {
            std::fs::copy(entry.path(), target).expect("copied");
        }
    }
}

/// A file of the copy is changed.
fn edit(path: &Path, change: impl Fn(&str) -> Option<String>) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let changed =
        change(&text).unwrap_or_else(|| panic!("{}: the place is not there", path.display()));
    std::fs::write(path, changed).expect("written");
}

/// The text with `new` behind the first place where `place` stands.
fn behind(text: &str, place: &str, new: &str) -> Option<String> {
    let at = text.find(place)? + place.len();
    Some(format!("{}{new}{}", &text[..at], &text[at..]))
}

/// The text with `new` before the last brace.
fn before_last_brace(text: &str, new: &str) -> Option<String> {
    let at = text.rfind('}')?;
    Some(format!("{}{new}{}", &text[..at], &text[at..]))
}

/// Runs a command in the copy; its status, and the end of what it said.
fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new("cargo")
        .args(arguments)
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .env("INSTA_UPDATE", "always")
        .output()
        .expect("cargo runs");
    let said = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    let lines: Vec<&str> = said.lines().collect();
    let end = lines[lines.len().saturating_sub(60)..].join("\n");
    (output.status.code(), end)
}

#[test]
#[ignore = "deep: builds a copy of the workspace"]
fn the_monitor_of_the_book_works() {
    let page =
        std::fs::read_to_string(root().join("docs/src/adding-a-monitor.md")).expect("the page");
    let sections = sections(&page);
    let [what, list, wrong, tries, table] = sections.as_slice() else {
        panic!("{} sections", sections.len());
    };
    let folder = Folder::new("adding");
    copy(&root(), &folder.0);
    let at = |section: &Section| folder.0.join(&section.file);

    std::fs::write(at(what), what.blocks.join("\n")).expect("written");
    edit(&at(list), |text| {
        let text = behind(text, "pub mod channel;\n", &list.blocks[0])?;
        behind(&text, "brakes tool_holder", " coolant_door")
    });
    edit(&at(wrong), |text| {
        Some(format!("{text}\n{}", wrong.blocks[0]))
    });
    edit(&at(tries), |text| before_last_brace(text, &tries.blocks[0]));
    std::fs::write(at(table), &table.blocks[0]).expect("written");
    let peers = folder
        .0
        .join("harness/src/families/heidenhain/peer/same.rs");
    edit(&peers, |text| before_last_brace(text, &table.blocks[1]));

    // The pages are not written anew: nobody has asked for the toy in the book.
    let proofs = ["test", "-p", "stillpoint-proofs", "--test", "mutants"];
    for arguments in [
        &["test", "-p", "stillpoint-monitors"][..],
        // Writes which harnesses kill the new mutant.
        &[&proofs[..], &["--", "--ignored"]].concat(),
        &[&proofs[..], &["--test", "draws"]].concat(),
    ] {
        let (status, said) = run(&folder.0, arguments);
        assert_eq!(status, Some(0), "{arguments:?}:\n{said}");
    }
    let kills = folder.0.join("proofs/tests/kills/heidenhain.snap");
    let kills = std::fs::read_to_string(kills).expect("the kills");
    assert!(kills.contains(&wrong.blocks[1]), "{kills}");
    let spec = table.file.to_str().expect("UTF-8");
    for (arguments, expected) in [
        (&["check", spec][..], 0),
        (&["diff", spec], 0),
        (&["diff", spec, "--mutant", "coolant-door-counts-motion"], 1),
    ] {
        let (status, said) = run(&folder.0, &[&["run", "--"], arguments].concat());
        assert_eq!(status, Some(expected), "{arguments:?}:\n{said}");
    }
}
