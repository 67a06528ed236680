//! `stillpoint theorems`, and what `check` of a machine does with them.

use std::path::{Path, PathBuf};

use crate::common::{Folder, copied, messages, root, status, stderr, stdout, stillpoint};

const FAMILY: &str = "spec/families/sinumerik-840d";

/// An axis that asks nothing: all that is told is about the family.
const MACHINE: &str =
    "family = \"sinumerik-840d\"\n[axis.X]\nkind = \"linear\"\nfunctions = [\"SBH/SG\", \"SE\"]\n";

#[test]
fn theorems_are_listed_with_their_ranges() {
    let output = stillpoint(&["theorems", FAMILY]);
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "sinumerik-840d/axis/stop for every",
        "t_b = 0 .. 480000",
        "S840D-P-05",
        "not decided",
    ] {
        assert!(words.contains(part), "{part}: {text}");
    }
}

#[test]
fn a_folder_without_a_family_is_refused() {
    let output = stillpoint(&["theorems", "spec/machines"]);
    assert_eq!(status(&output), 2);
    let told = messages(&output);
    assert!(told.contains("no folder of a family"), "{told}");
    assert!(told.contains("spec/families/sinumerik-840d"), "{told}");
}

/// The folder of a copy of a family.
fn copy_of(name: &str, family: &str) -> PathBuf {
    let machine = copied(name, "spec/machines/storage-crane.toml", family, &[]);
    let root = Path::new(&machine).ancestors().nth(3).expect("its root");
    root.join(family)
}

/// Nothing is proved anew of tables that are as they were, and the files are the same to the last byte.
#[test]
fn what_is_proved_stays() {
    let family = "spec/families/srm-fblocks";
    let copy = copy_of("theorems-stay", family);
    let files = ["theorems.toml", "theorems.cert"].map(|name| copy.join(name));
    let read = || {
        files
            .clone()
            .map(|file| std::fs::read(file).expect("readable"))
    };
    let before = read();
    let output = stillpoint(&["theorems", copy.to_str().expect("UTF-8"), "--prove"]);
    assert_eq!(status(&output), 0, "{}", stderr(&output));
    assert_eq!(stdout(&output).lines().count(), 1, "{}", stdout(&output));
    assert!(read() == before);
}

/// The certificates confirm what stands there; one that says less is told, and which theorem it is of.
#[test]
fn certificates_are_checked() {
    let family = "spec/families/srm-fblocks";
    let only = ["--system", "ordered", "--system", "load"];
    let output = stillpoint(&[&["theorems", family, "--check"], &only[..]].concat());
    let text = stdout(&output);
    assert_eq!(status(&output), 0, "{text}{}", stderr(&output));
    assert!(
        text.contains("srm-fblocks/load/load: 18 confirmed, 7 shown to fail for some values, "),
        "{text}"
    );
    assert!(
        text.ends_with("srm-fblocks: 20 theorems confirmed\n"),
        "{text}"
    );
    let output = stillpoint(&["theorems", family, "--check", "--system", "laod"]);
    assert_eq!(status(&output), 2);
    assert!(
        messages(&output).contains("no such system"),
        "{}",
        messages(&output)
    );
    // A file that was altered, and none.
    let copy = copy_of("theorems-check", family);
    let text = std::fs::read_to_string(copy.join("theorems.cert")).expect("readable");
    let folder = copy.to_str().expect("UTF-8");
    std::fs::write(
        copy.join("theorems.cert"),
        text.replacen("clause", "clauses", 1),
    )
    .expect("written");
    let output = stillpoint(&["theorems", folder, "--check"]);
    assert_eq!(status(&output), 2);
    assert!(
        messages(&output).contains("truncated or was altered"),
        "{}",
        messages(&output)
    );
    std::fs::remove_file(copy.join("theorems.cert")).expect("removed");
    let output = stillpoint(&[&["theorems", folder, "--check"], &only[..]].concat());
    let text = stdout(&output);
    assert_eq!(status(&output), 1, "{text}");
    assert!(
        text.contains("load/load: REJECTED: there are 0 certificates"),
        "{text}"
    );
}

/// A broken file of theorems is bad input, not none.
#[test]
fn a_broken_file_is_told() {
    let change = [(
        "spec/families/srm-fblocks/theorems.toml",
        "seconds =",
        "minutes =",
    )];
    let machine = copied(
        "theorems-broken",
        "spec/machines/storage-crane.toml",
        "spec/families/srm-fblocks",
        &change,
    );
    let output = stillpoint(&["check", &machine]);
    assert_eq!(status(&output), 2, "{}", stdout(&output));
    let told = messages(&output);
    assert!(
        told.contains("theorems.toml:") && told.contains("minutes"),
        "{told}"
    );
}

/// The properties of a report that are told as theorems, and its first lines.
fn cited(arguments: &[&str]) -> (i32, usize, String) {
    let output = stillpoint(&[arguments, &["--json"]].concat());
    let text = stdout(&output);
    let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let runs = report["runs"].as_array().expect("runs");
    let all = runs
        .iter()
        .flat_map(|run| run["properties"].as_array().into_iter().flatten());
    let cited = all.filter(|property| property["theorem"] == true);
    assert!(cited.clone().all(|property| property["verdict"] == "holds"));
    (status(&output), cited.count(), text)
}

#[test]
fn check_cites_them_unless_all_is_asked_for() {
    let folder = Folder::new("theorems-cited");
    let file = folder.write("a.toml", MACHINE);
    let (code, some, text) = cited(&["check", &file]);
    assert_eq!(code, 0, "{text}");
    assert!(some >= 50, "{some}");
    let (code, none, whole) = cited(&["check", &file, "--all"]);
    assert_eq!((code, none), (0, 0));
    let states = |text: &str| {
        let report: serde_json::Value = serde_json::from_str(text).expect("JSON");
        report["states"].as_u64().expect("a number")
    };
    assert!(states(&text) < states(&whole));
    let text = stdout(&stillpoint(&["check", &file]));
    assert!(text.contains("of them theorems of the family"), "{text}");
}

/// STOP B without its timer: no theorem about the stops is left, and the exploration finds it.
#[test]
fn an_edited_table_is_explored() {
    let change = [(
        "spec/families/sinumerik-840d/stop.toml",
        "IF timer = 0 OR standstill THEN",
        "IF standstill THEN",
    )];
    let copy = copied(
        "theorems-edited",
        "spec/machines/milling-840d.toml",
        FAMILY,
        &change,
    );
    std::fs::write(&copy, MACHINE).expect("written");
    let output = stillpoint(&["check", &copy]);
    let text = stdout(&output);
    assert_eq!(status(&output), 1, "{text}");
    assert!(text.contains("VIOLATED  S840D-P-05"), "{text}");
    assert!(root().join(FAMILY).join("theorems.toml").is_file());
}
