//! The guarantees of a machine with SAFE.SPF, or with the program of an F-CPU, depend on the program and on how the machine data connect it: each mistake, alone, breaks
//! one, and the report names the line.

use std::path::PathBuf;

use serde::Deserialize;
use stillpoint_engine::check::Settings;
use stillpoint_engine::lines;
use stillpoint_harness::guarantees::answers;
use stillpoint_machine as machine;
use stillpoint_model::{Until, Verdict};
use stillpoint_tests::guarantees::decided;
use stillpoint_tests::peer::each;
use stillpoint_tests::{daily, root};

const LATHE: &str = "spec/machines/lathe-840d";
const INTERLOCK: &str = "tests/machines/interlock-840d";
const PRESS: &str = "tests/machines/press-840d";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Cases {
    mistake: Vec<Case>,
    right: Vec<Case>,
}

/// Another program, or other values of the machine file.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    text: String,
    /// The machine and its program, without the end of their names; the lathe where nothing is said.
    base: Option<String>,
    #[serde(default)]
    replace: Vec<(String, String)>,
    #[serde(default)]
    machine: Vec<(String, String)>,
    /// Other texts in its half in the PLC; where there are none, the machine is taken without that half.
    #[serde(default)]
    plc: Vec<(String, String)>,
    /// The guarantee that finds it.
    breaks: Option<String>,
    /// The guarantee that still holds.
    keeps: Option<String>,
    /// A piece of the line that the report names.
    line: Option<String>,
}

fn cases() -> Cases {
    let path = root().join("tests/machines/safe-logic-mistakes.toml");
    let text = std::fs::read_to_string(path).expect("readable");
    toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"))
}

fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// The machine and its program with other texts in them, in a folder of their own.
fn written(k: usize, case: &Case) -> PathBuf {
    let changed = |text: String, replace: &[(String, String)]| {
        replace.iter().fold(text, |text, (from, to)| {
            assert!(text.contains(from), "{}: '{from}'", case.text);
            text.replace(from, to)
        })
    };
    let kind = if case.breaks.is_some() {
        "wrong"
    } else {
        "right"
    };
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("logic-{kind}-{k}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    let base = case.base.as_deref().unwrap_or(LATHE);
    let stem = base.rsplit('/').next().unwrap_or(base);
    let kinds = ["spf", "st"].into_iter();
    let mut kinds = kinds.filter(|kind| root().join(format!("{base}.{kind}")).is_file());
    let kind = kinds.next().expect("a program");
    let program = changed(text(&format!("{base}.{kind}")), &case.replace);
    std::fs::write(folder.join(format!("{stem}.{kind}")), program).expect("written");
    let path = folder.join(format!("{stem}.toml"));
    let mut machine = changed(text(&format!("{base}.toml")), &case.machine);
    if case.plc.is_empty() {
        let lines = machine.lines().filter(|line| !line.starts_with("plc "));
        machine = lines.map(|line| format!("{line}\n")).collect();
    } else {
        let half = changed(text(&format!("{base}.stl")), &case.plc);
        std::fs::write(folder.join(format!("{stem}.stl")), half).expect("written");
    }
    std::fs::write(&path, machine).expect("written");
    path
}

/// The verdict on a guarantee, and the lines that the report of a broken one names.
fn judged(path: &std::path::Path, guarantee: &str, until: Until) -> (Verdict, Vec<String>) {
    let machine =
        machine::load(path, &root().join("spec/families")).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        threads: 1,
        until,
        ..Settings::default()
    };
    let (subject, checked) = decided(path, machine, &[guarantee], &settings);
    let answers = answers(&subject, &checked);
    let found = answers.iter().find(|a| a.guarantee.name == guarantee);
    let named = subject.tasks.iter().zip(&checked).flat_map(|(task, one)| {
        let properties = &task.bound.system.properties;
        let broken = properties.iter().zip(&one.outcome.report.properties);
        let lines = broken.filter_map(|(property, judged)| {
            let trace = judged.trace.as_ref()?;
            Some(lines::deciding(&task.bound, property, trace))
        });
        lines.flatten().map(|line| line.text).collect::<Vec<_>>()
    });
    (found.expect("asked").verdict, named.collect())
}

#[test]
fn a_door_that_is_confirmed_keeps_what_it_guarantees() {
    let machine = root().join(format!("{INTERLOCK}.toml"));
    for name in [
        "hold_to_run",
        "acknowledge",
        "no_start",
        "torque",
        "slow",
        "stops",
    ] {
        assert_eq!(
            judged(&machine, name, Until::Complete).0,
            Verdict::Holds,
            "{name}"
        );
    }
}

#[test]
fn a_press_with_modes_a_lock_and_contactors_keeps_what_it_guarantees() {
    let machine = root().join(format!("{PRESS}.toml"));
    for name in ["modes", "lock", "hydraulics", "no_start"] {
        assert_eq!(
            judged(&machine, name, Until::Complete).0,
            Verdict::Holds,
            "{name}"
        );
    }
}

/// Judges these mistakes.
fn each_breaks(cases: &[(usize, Case)]) {
    assert!(cases.len() >= 10);
    let wrong = each(cases, |(k, case)| {
        let name = case.breaks.as_ref().expect("a guarantee");
        let (verdict, lines) = judged(&written(*k, case), name, Until::Violated);
        let line = case.line.as_deref().unwrap_or("");
        let named = line.is_empty() || lines.iter().any(|l| l.contains(line));
        (verdict != Verdict::Violated || !named)
            .then(|| format!("{}: {name} {verdict:?}, lines {lines:#?}", case.text))
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn mistakes_of_the_safe_logic_break_guarantees() {
    each_breaks(&daily(cases().mistake.into_iter().enumerate().collect()));
}

#[test]
fn logic_that_is_right_in_another_way_is_not_accused() {
    let cases = cases().right.into_iter().enumerate().collect::<Vec<_>>();
    each(&cases, |(k, case)| {
        let name = case.keeps.as_ref().expect("a guarantee");
        let (verdict, _) = judged(&written(*k, case), name, Until::Complete);
        assert_eq!(verdict, Verdict::Holds, "{}", case.text);
    });
}

/// What is asked in words of the file is an expression over signals that the program has.
#[test]
fn an_expression_over_signals_that_are_not_there_is_an_error_with_its_place() {
    let case = Case {
        text: "a signal that the program does not have".to_owned(),
        base: Some(INTERLOCK.to_owned()),
        machine: vec![("NOT $A_OUTSI[2]".to_owned(), "NOT OUTSI[22]".to_owned())],
        ..Case::default()
    };
    let path = written(98, &case);
    let machine =
        machine::load(&path, &root().join("spec/families")).unwrap_or_else(|e| panic!("{e}"));
    let run = machine
        .runs
        .iter()
        .find(|r| r.guarantee.as_deref() == Some("stops"));
    let errors = machine
        .spec(run.expect("asked"))
        .err()
        .expect("no such signal");
    let told = errors.to_string();
    assert!(
        told.contains("guarantee stops") && told.contains("interlock-840d.toml:"),
        "{told}"
    );
}

/// What the half in the PLC leaves alone could as well be 1: a guarantee that rests on it is refused.
#[test]
fn a_half_in_the_plc_that_gives_an_axis_nothing_is_an_error() {
    let case = Case {
        text: "no SBH".to_owned(),
        plc: vec![
            ("    = \"SPL\".SBH_OFF;\n".to_owned(), String::new()),
            ("    = DB32.DBX22.1;\n".to_owned(), String::new()),
        ],
        ..Case::default()
    };
    let errors = machine::load(&written(96, &case), &root().join("spec/families"))
        .expect_err("nothing gives SBH of Z");
    let told = errors.to_string();
    let told: Vec<&str> = told.split_whitespace().collect();
    let said =
        "gives axis Z nothing for SS_DISABLE_INPUT: no instruction writes DB32.DBX22.1 or OUTSI[3]";
    assert!(told.join(" ").contains(said), "{told:?}");
}

/// Another number of the machine axis is another data block.
#[test]
fn the_data_block_of_an_axis_is_that_of_its_number() {
    let case = Case {
        text: "X is machine axis 3".to_owned(),
        machine: vec![(
            "title     = \"cross slide\"".to_owned(),
            "machine_axis = 3".to_owned(),
        )],
        plc: vec![("U E 76.0".to_owned(), "U E 76.0".to_owned())],
        ..Case::default()
    };
    let machine = machine::load(&written(95, &case), &root().join("spec/families"))
        .unwrap_or_else(|e| panic!("{e}"));
    let blocks = |axis: &str| {
        let runs = machine
            .runs
            .iter()
            .filter(|run| run.half && run.axes == [axis]);
        let signals = runs.filter_map(|run| run.wiring.get("sge_sbh").cloned());
        signals.collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(blocks("X"), ["DB33.DBX22.1".to_owned()].into());
    assert_eq!(blocks("Z"), ["DB32.DBX22.1".to_owned()].into());
}

/// A guarantee about the program needs one.
#[test]
fn a_guarantee_about_a_program_that_is_not_there_is_an_error() {
    let case = Case {
        text: "no program".to_owned(),
        base: Some(INTERLOCK.to_owned()),
        machine: vec![(
            "[logic.spl]\nsource = \"interlock-840d.spf\"\n".to_owned(),
            String::new(),
        )],
        ..Case::default()
    };
    let errors = machine::load(&written(97, &case), &root().join("spec/families"))
        .expect_err("there is no program");
    let told = errors.to_string();
    assert!(
        told.contains("about the program of the safe logic"),
        "{told}"
    );
}

/// A guarantee about a contact that the program is not told of is refused, with the place and what to write.
#[test]
fn a_contact_that_the_program_does_not_know_is_an_error() {
    let case = Case {
        text: "no contact".to_owned(),
        machine: vec![("contact       = \"INSE[1]\"\n".to_owned(), String::new())],
        ..Case::default()
    };
    let errors = machine::load(&written(99, &case), &root().join("spec/families"))
        .expect_err("nothing tells the program of the door");
    let told = errors.to_string();
    assert!(
        told.contains("guarantee slides") && told.contains("contact names no signal"),
        "{told}"
    );
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn every_mistake_of_the_safe_logic_breaks_a_guarantee() {
        each_breaks(&cases().mistake.into_iter().enumerate().collect::<Vec<_>>());
    }

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn the_lathe_keeps_what_it_guarantees() {
        let lathe = root().join(format!("{LATHE}.toml"));
        for name in [
            "slides",
            "work",
            "emergency_stop",
            "emergency_stop_work",
            "setting_up",
            "acknowledge",
            "acknowledge_work",
            "tests",
            "tests_work",
        ] {
            assert_eq!(
                judged(&lathe, name, Until::Complete).0,
                Verdict::Holds,
                "{name}"
            );
        }
    }
}
