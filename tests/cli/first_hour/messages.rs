//! What the messages say to somebody who writes their first file.

use super::{away, elsewhere};
use crate::common::{Folder, messages, root, status, stderr, stdout};

/// What `validate` or `check` says about a file, in one line.
fn said(folder: &Folder, command: &str, text: &str) -> (i32, String) {
    let file = folder.write("a.toml", text);
    let output = away(folder, &[command, &file]);
    let all = format!("{}{}", stdout(&output), stderr(&output));
    let plain = all.replace(['│', '×', '·', '─', '╰', '╭', '┬'], " ");
    let words = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    (status(&output), words)
}

#[test]
fn a_part_of_a_function_names_the_whole() {
    let folder = elsewhere("part");
    let machine = "family = \"sinumerik-840d\"\n[axis.X]\nkind = \"linear\"\nfunctions = [\"SBH\", \"SN1\"]\n";
    let (status, text) = said(&folder, "validate", machine);
    assert_eq!(status, 2);
    assert!(text.contains("did you mean \"SBH/SG\"?"), "{text}");
    assert!(
        text.contains("did you mean \"SN1+\" or \"SN1-\"?"),
        "{text}"
    );
    assert!(!text.contains("did you mean \"SE\""), "{text}");
}

#[test]
fn values_with_blanks_and_commas_are_quoted() {
    let folder = elsewhere("quoted");
    let machine = "family = \"sinumerik-840d\"\n[axis.X]\nkind = \"linear\"\nfunctions = [\"SBH/SG\"]\nIPO_STOP_GROUP = \"all\"\n";
    let (status, text) = said(&folder, "validate", machine);
    assert_eq!(status, 2);
    assert!(
        text.contains("allowed: \"channel\" or \"interpolating axes\""),
        "{text}"
    );
}

#[test]
fn the_manuals_numbers_and_other_units_are_names_too() {
    let folder = elsewhere("names");
    let head =
        "family = \"sinumerik-840d\"\n[axis.S]\nkind = \"spindle\"\nfunctions = [\"SBH/SG\"]\n";
    let machine = format!(
        "{head}MD36930 = \"2 deg\"\n\"$MA_SAFE_VELO_LIMIT\" = [\"50 rpm\", \"300 1/min\", \"1000 rev/min\", \"2000 rpm\"]\n"
    );
    let (status, text) = said(&folder, "validate", &machine);
    assert_eq!(status, 0, "{text}");
    let page = folder.file("a.md");
    let output = away(&folder, &["check", "a.toml", "--markdown"]);
    std::fs::write(&page, stdout(&output)).expect("written");
    assert!(stdout(&output).contains("2 deg"), "{}", stderr(&output));
    let twice = format!("{head}MD36930 = \"2 deg\"\nSTANDSTILL_TOL = \"1 deg\"\n");
    let (status, text) = said(&folder, "validate", &twice);
    assert_eq!(status, 2);
    assert!(text.contains("STANDSTILL_TOL is given twice"), "{text}");
}

/// A specification with a machine of this let and output.
fn specification(value: &str, output: &str) -> String {
    format!(
        "spec = \"t\"\n[machine.m]\ntext = \"m\"\n[machine.m.input]\na = \"BOOL\"\n[machine.m.let]\nhalf = \"{value}\"\n\
         [machine.m.output]\no = \"{output}\"\np = \"half\"\nq = \"NOT half\"\n[system.y]\ntext = \"y\"\n\
         [system.y.instance]\nm = {{ machine = \"m\" }}\n[system.y.free]\nports = [\"m.a\"]\n"
    )
}

#[test]
fn a_faulty_let_is_told_once() {
    let folder = elsewhere("let");
    let (status, text) = said(&folder, "check", &specification("a AND other", "a"));
    assert_eq!(status, 2);
    assert!(text.contains("`other` is not known here"), "{text}");
    assert!(
        !text.contains("`half` is not known") && !text.contains("errors;"),
        "{text}"
    );
}

#[test]
fn an_if_in_an_expression_names_sel() {
    let folder = elsewhere("if");
    let (status, text) = said(
        &folder,
        "check",
        &specification("a", "IF a THEN 1 ELSE 0 END_IF"),
    );
    assert_eq!(status, 2);
    assert!(
        text.contains("SEL(condition, value if FALSE, value if TRUE)"),
        "{text}"
    );
}

/// A scenario of one family is refused for a machine of another in the words of this one.
#[test]
fn simulate_speaks_the_words_of_the_family() {
    let folder = elsewhere("family");
    let machine = root().join("spec/machines/machining-centre-heidenhain.toml");
    let scenario = root().join("spec/scenarios/door-while-moving.toml");
    let arguments = [
        "simulate",
        machine.to_str().expect("UTF-8"),
        "--scenario",
        scenario.to_str().expect("UTF-8"),
    ];
    let output = away(&folder, &arguments);
    assert_eq!(status(&output), 2);
    let text = messages(&output);
    assert!(
        text.contains("\"C\" is no stop") && text.contains("SS1F"),
        "{text}"
    );
    assert!(!text.contains("SBH") && !text.contains("TEST"), "{text}");
}

/// Rounded times are one sentence; the list is there on demand.
#[test]
fn simulate_prints_no_line_that_nobody_reads() {
    let folder = elsewhere("lines");
    let machine = root().join("spec/machines/milling-840d.toml");
    let scenario = root().join("spec/scenarios/door-while-moving.toml");
    let arguments = [
        "simulate",
        machine.to_str().expect("UTF-8"),
        "--scenario",
        scenario.to_str().expect("UTF-8"),
        "--brief",
    ];
    let short = stdout(&away(&folder, &arguments));
    assert!(short.lines().all(|l| l.chars().count() <= 160), "{short}");
    assert!(
        short.contains("6 times of the scenario are no whole number of cycles; -v lists"),
        "{short}"
    );
    let long = stdout(&away(&folder, &[&arguments[..], &["-v"]].concat()));
    assert!(
        long.contains("\n  at 0.4 s up to 408 ms (cycle 34)\n"),
        "{long}"
    );
}
