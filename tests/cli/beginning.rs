//! `stillpoint new`, and `check --sweep`: how a machine file begins, and for which values its guarantees hold.

use serde_json::Value;

use crate::common::{Folder, command, messages, session, status, stderr, stdout, stillpoint};

const MILLING: &str = "spec/machines/milling-840d.toml";

/// A machine of each family from nothing to a clean verdict, as its user goes.
fn to_a_clean_verdict(family: &str, options: &[&str], guarantee: &str) {
    let folder = Folder::new(&format!("new-{family}"));
    let file = folder.file("machine.toml");
    let mut arguments = vec!["new", family, "--output", file.as_str()];
    arguments.extend(options);
    let written = stillpoint(&arguments);
    assert_eq!(status(&written), 0, "{}", stderr(&written));
    let output = stillpoint(&["check", &file, "--json"]);
    assert_eq!(status(&output), 0, "{}", stdout(&output));
    let report: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let guarantees = report["guarantees"].as_array().expect("guarantees");
    assert!(guarantees.len() >= 3);
    assert!(guarantees.iter().all(|g| g["verdict"] == "holds"));
    // Another value, and the verdict is another one.
    let text = std::fs::read_to_string(&file).expect("the file");
    let worse = text.replacen("within  = \"", "within  = \"0.", 1);
    assert_ne!(text, worse);
    std::fs::write(&file, worse).expect("written");
    let place = format!("guarantee.{guarantee}.way");
    let output = stillpoint(&["check", &file, "--sweep", &place]);
    assert_eq!(status(&output), 1, "{}", stderr(&output));
    assert!(stdout(&output).contains(&format!("{guarantee} (violated)")));
}

#[test]
fn a_lathe_from_nothing_to_a_clean_verdict() {
    let options = ["--name", "lathe", "--linear", "X,Z", "--spindles", "S"];
    to_a_clean_verdict("sinumerik-840d", &options, "front_axes");
}

#[test]
fn a_press_from_nothing_to_a_clean_verdict() {
    let options = ["--name", "press", "--linear", "Y"];
    to_a_clean_verdict("heidenhain-fs", &options, "front_axes_som_1");
}

/// What it writes is plausible for every kind of machine, without warnings but those that only the builder can answer.
#[test]
fn every_machine_that_begins_is_plausible() {
    let folder = Folder::new("new-kinds");
    for family in ["sinumerik-840d", "heidenhain-fs"] {
        for (n, options) in [
            &["--linear", "X,Y,Z", "--rotary", "B,C", "--spindles", "S"][..],
            &["--linear", "X", "--doors", "front,rear"],
            &["--linear", "", "--rotary", "C"],
            &["--linear", "X,Z", "--spindles", "S1,S2", "--doors", ""],
        ]
        .into_iter()
        .enumerate()
        {
            let file = folder.file(&format!("{family}-{n}.toml"));
            let mut arguments = vec!["new", family, "--output", file.as_str()];
            arguments.extend(options);
            let written = stillpoint(&arguments);
            assert_eq!(status(&written), 0, "{options:?}: {}", stderr(&written));
            let valid = stillpoint(&["validate", &file]);
            assert_eq!(status(&valid), 0, "{options:?}: {}", stderr(&valid));
            let warnings: Vec<String> = stdout(&valid)
                .lines()
                .filter(|line| line.trim_start().starts_with("warning: "))
                .map(str::to_owned)
                .collect();
            let builders = ["is ever tested", "no door of this file reaches"];
            let known = |line: &&String| !builders.iter().any(|w| line.contains(w));
            assert_eq!(
                warnings.iter().find(known),
                None,
                "{family} {options:?}: {}",
                stdout(&valid)
            );
        }
    }
}

#[test]
fn what_cannot_begin_is_refused_and_nothing_is_overwritten() {
    let folder = Folder::new("new-refused");
    let file = folder.write("kept.toml", "mine");
    for (arguments, says) in [
        (&["new", "sinumerik"][..], "there is no family 'sinumerik'"),
        (
            &["new", "sinumerik-840d", "--output", &file],
            "nothing of it is overwritten",
        ),
        (
            &["new", "sinumerik-840d", "--linear", "X,X"],
            "two are named 'X'",
        ),
        (
            &["new", "sinumerik-840d", "--linear", "an axis"],
            "'an axis' cannot be the name",
        ),
    ] {
        let output = stillpoint(arguments);
        assert_eq!(status(&output), 2, "{arguments:?}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        let said = messages(&output);
        assert!(said.contains(says), "{arguments:?}: {said}");
    }
    assert_eq!(std::fs::read_to_string(&file).expect("the file"), "mine");
}

#[test]
fn a_sweep_tells_where_guarantees_begin_to_hold() {
    let mut said = String::new();
    for (place, expected) in [
        ("axis.X.STANDSTILL_TOL", 0),
        ("axis.X.VELO_LIMIT[0]", 0),
        ("door.front.open", 0),
        ("guarantee.tool.speed", 0),
        ("axis.X.STANDSTIL_TOL", 2),
        ("axis.X.colour", 2),
        ("table", 2),
    ] {
        let arguments = ["check", MILLING, "--sweep", place];
        let output = stillpoint(&arguments);
        assert_eq!(status(&output), expected, "{place}: {}", stderr(&output));
        said.push_str(&session(&arguments, &output));
    }
    insta::assert_snapshot!(said);
}

/// The place where a sweep finds the change is that of a check with the values beside it.
#[test]
fn a_sweep_agrees_with_checks() {
    let folder = Folder::new("sweep");
    let text = std::fs::read_to_string(crate::common::root().join(MILLING)).expect("the machine");
    let sweep = |within: &str| {
        let text = text.replacen("within  = \"1.1 s\"", &format!("within  = \"{within}\""), 1);
        let file = folder.write("machine.toml", &text);
        let arguments = ["check", &file, "--sweep", "guarantee.table.way"];
        let output = command(&arguments).output().expect("it runs");
        (status(&output), stdout(&output))
    };
    // 996 ms is the tightest bound of a check.
    assert_eq!(sweep("996 ms").0, 0);
    let (status, said) = sweep("995 ms");
    assert_eq!(status, 1, "{said}");
}
