//! The programs that chapter 10 of the manual prints are machines: their known weaknesses are found by what such a machine has to
//! guarantee, with the line of the program, and machines beside them that are mended keep it.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use stillpoint_engine::check::Settings;
use stillpoint_engine::lines;
use stillpoint_harness::guarantees::answers;
use stillpoint_machine as machine;
use stillpoint_model::Verdict;
use stillpoint_tests::guarantees::decided;
use stillpoint_tests::peer::each;
use stillpoint_tests::root;

/// What one property says of a machine: verdict, length of the run that shows it, and the lines of the programs that decide its end.
#[derive(Debug)]
struct Found {
    id: String,
    verdict: Verdict,
    length: Option<usize>,
    lines: Vec<String>,
}

/// A machine of `tests/machines`.
fn machine_file(name: &str) -> PathBuf {
    root().join(format!("tests/machines/{name}.toml"))
}

/// The verdict on a guarantee of a machine file with this text behind it, and what its properties say.
fn judged(path: &Path, more: &str, guarantee: &str) -> (Verdict, Vec<Found>) {
    let mut bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    bytes.extend_from_slice(more.as_bytes());
    let machine = machine::load_bytes(path, bytes, &root().join("spec/families"))
        .unwrap_or_else(|e| panic!("{e}"));
    // As the command does, which tells what decides a broken one: that must come to an end too.
    let settings = Settings {
        threads: 1,
        decisive: true,
        ..Settings::default()
    };
    let (subject, checked) = decided(path, machine, &[guarantee], &settings);
    let all = answers(&subject, &checked);
    let answer = all.iter().find(|a| a.guarantee.name == guarantee);
    let found = subject.tasks.iter().zip(&checked).flat_map(|(task, one)| {
        let states = one.outcome.report.states;
        println!("{}, {guarantee}: {states} states", path.display());
        let properties = &task.bound.system.properties;
        let judged = properties.iter().zip(&one.outcome.report.properties);
        judged.map(|(property, judged)| {
            let trace = judged.trace.as_ref();
            let lines = trace.map(|trace| lines::deciding(&task.bound, property, trace));
            Found {
                id: property.id.clone(),
                verdict: judged.verdict,
                length: trace.map(|trace| trace.steps.len()),
                lines: (lines.into_iter().flatten())
                    .map(|line| format!("{} {}", line.value, line.text))
                    .collect(),
            }
        })
    });
    let found = found.collect();
    (answer.expect("asked").verdict, found)
}

/// A machine, its guarantee, and the properties that its printed program breaks, each with a piece of a line that decides it.
type Case = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);

const PRINTED: [Case; 5] = [
    (
        "emergency-stop-840d",
        "restart",
        &[
            ("FIRST-BY-KEY", "QUIT_MARKER"),
            ("LONGEST-COUNTS", "QUIT_MARKER"),
            ("HELD-KEY", "NOT_QUIT"),
        ],
    ),
    (
        "forced-checking-840d",
        "acknowledgement_ends",
        &[("ENDS", "")],
    ),
    ("forced-checking-840d", "next_test", &[("COMES-BACK", "")]),
    (
        "profisafe-840d",
        "valve",
        &[("FIRST-BY-KEY", "IE02_SCHUTZTUER_OK")],
    ),
    ("brake-test-840d", "test_ends", &[("ENDS", "M 110.7")]),
];

const MENDED: [(&str, &str); 14] = [
    ("emergency-stop-840d", "standstill"),
    ("emergency-stop-840d", "stage"),
    ("emergency-stop-relay-840d", "restart"),
    ("emergency-stop-relay-840d", "standstill"),
    ("forced-checking-own-840d", "acknowledgement_ends"),
    ("forced-checking-own-840d", "next_test"),
    ("profisafe-command-840d", "valve"),
    ("profisafe-command-840d", "valve_in_both"),
    ("brake-test-840d", "next_test"),
    ("brake-test-840d", "load_on_closed_brake"),
    ("brake-test-own-840d", "test_ends"),
    ("brake-test-own-840d", "next_test"),
    ("brake-test-own-840d", "brake_closes"),
    ("brake-test-own-840d", "load_on_closed_brake"),
];

/// What is missing in an answer: the property broken, by a run, with a line that has this piece.
fn missed(found: &[Found], id: &str, line: &str) -> Option<String> {
    let one = found.iter().find(|one| one.id == id);
    let right = one.is_some_and(|one| {
        let named = line.is_empty() || one.lines.iter().any(|l| l.contains(line));
        one.verdict == Verdict::Violated && one.length.is_some() && named
    });
    (!right).then(|| format!("{id}: {one:#?}"))
}

fn none(wrong: Vec<Vec<String>>) {
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The findings about the printed programs: S840D-EXAMPLE-730 (a request of the PLC alone releases after power-on), S840D-EXAMPLE-731
/// (only the last interruption counts), S840D-EXAMPLE-732 (the acknowledgement is a level), S840D-TESTSTOP-720 (the acknowledgement of
/// the PLC stays), S840D-TESTSTOP-721 (an aborted test is the last one), S840D-PSAFE-719 (closing the door switches on). Of the brake test:
/// one whose axis is not given to the PLC has no end (S840D-BRAKE-710). That the printed call reads no stop of the axis, so that its brake
/// closes for the test alone (S840D-BRAKE-716), cannot be asked of signals that it does not have.
#[test]
fn the_weaknesses_of_the_printed_programs_are_found() {
    none(each(&PRINTED, |(name, guarantee, broken)| {
        let (verdict, found) = judged(&machine_file(name), "", guarantee);
        let missing = broken.iter().map(|(id, line)| missed(&found, id, line));
        let missing = missing.flatten().map(|why| format!("{name}, {why}"));
        let held = (verdict != Verdict::Violated).then(|| format!("{name}, {guarantee}"));
        missing.chain(held).collect()
    }));
}

/// S840D-EXAMPLE-701, S840D-EXAMPLE-702, S840D-EXAMPLE-730, S840D-EXAMPLE-731, S840D-EXAMPLE-732, S840D-TESTSTOP-714,
/// S840D-TESTSTOP-720, S840D-TESTSTOP-721, S840D-BRAKE-708, S840D-BRAKE-716.
#[test]
fn the_mended_programs_keep_what_they_guarantee() {
    none(each(&MENDED, |(name, guarantee)| {
        let (verdict, found) = judged(&machine_file(name), "", guarantee);
        let wrong = verdict != Verdict::Holds;
        wrong
            .then(|| format!("{name}, {guarantee}: {verdict:?} {found:#?}"))
            .into_iter()
            .collect()
    }));
}

/// What one half does alone the comparison of the control ends with STOP D, a second later: a test of one of the halves that waits for a
/// stop that does not come, S840D-TESTSTOP-706, and a request to acknowledge that stays, which has a marker in one half alone for that
/// reason, S840D-EXAMPLE-721, S840D-EXAMPLE-729.
#[test]
fn what_one_half_does_alone_is_stopped_by_the_comparison() {
    // 1 s is 42 cycles of 24 ms, counted from the one after that in which the signal differs first; the next one is too many.
    let asked = ["OUTSI[4]", "MARKERSI[3]"];
    none(each(&asked, |signal| {
        let more = format!(
            "\n[guarantee.lone]\npattern = \"agree\"\naxes = [\"X\"]\nreleased = \"{signal}\"\n"
        );
        let (_, found) = judged(&machine_file("emergency-stop-840d"), &more, "lone");
        let one = found.iter().find(|one| one.id == "AGREE");
        let length = one.and_then(|one| one.length);
        let right = length == Some(44) && missed(&found, "AGREE", "").is_none();
        (!right)
            .then(|| format!("{signal}: {found:#?}"))
            .into_iter()
            .collect()
    }));
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mistakes {
    mistake: Vec<Mistake>,
}

/// A machine whose half in the PLC is wrong in one place.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mistake {
    text: String,
    machine: String,
    /// What stands in the statement list once, and what stands there instead.
    replace: (String, String),
    /// The guarantee that finds it, and which of its properties.
    breaks: String,
    property: String,
    /// A piece of the line that the report names.
    line: String,
}

/// The machine and its programs in a folder of their own, with the mistake.
fn written(k: usize, mistake: &Mistake) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("stl-mistake-{k}"));
    std::fs::create_dir_all(&folder).expect("a folder");
    let text = |path: &Path| {
        std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    let from = machine_file(&mistake.machine);
    let mut machine = text(&from);
    for key in ["source", "plc"] {
        let line = machine.lines().find(|line| line.starts_with(key));
        let named = line.and_then(|line| line.split('"').nth(1)).expect(key);
        let named = named.to_owned();
        let mut program = text(&from.with_file_name(&named));
        if key == "plc" {
            let (old, new) = &mistake.replace;
            assert_eq!(program.matches(old).count(), 1, "{}", mistake.text);
            program = program.replace(old, new);
        }
        let name = Path::new(&named).file_name().expect("a file");
        std::fs::write(folder.join(name), program).expect("written");
        machine = machine.replace(&named, &name.to_string_lossy());
    }
    let path = folder.join(format!("{}.toml", mistake.machine));
    std::fs::write(&path, machine).expect("written");
    path
}

/// A half of the PLC that is wrong alone starts nothing, but the comparison stops the machine: the line is named.
#[test]
fn every_mistake_of_the_half_in_the_plc_is_found_with_its_line() {
    let path = root().join("tests/machines/stl-mistakes.toml");
    let text = std::fs::read_to_string(path).expect("readable");
    let mistakes: Mistakes = toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
    assert!(mistakes.mistake.len() >= 4);
    let all: Vec<_> = mistakes.mistake.iter().enumerate().collect();
    none(each(&all, |(k, mistake)| {
        let (_, found) = judged(&written(*k, mistake), "", &mistake.breaks);
        let missed = missed(&found, &mistake.property, &mistake.line);
        let told = missed.map(|why| format!("{}: {why}", mistake.text));
        told.into_iter().collect()
    }));
}

/// What is wrong with the half in the PLC is told with file, line and column; that there is none, at the guarantee that is about it.
#[test]
fn a_half_in_the_plc_that_cannot_be_taken_is_told_with_its_place() {
    let families = root().join("spec/families");
    let mistake = Mistake {
        text: "a loop".to_owned(),
        machine: "emergency-stop-840d".to_owned(),
        replace: (
            "    = \"SPL\".STOP_A_A;".to_owned(),
            "    LOOP A;".to_owned(),
        ),
        breaks: String::new(),
        property: String::new(),
        line: String::new(),
    };
    let path = written(99, &mistake);
    let told = machine::load(&path, &families)
        .expect_err("a loop")
        .to_string();
    assert!(told.contains("emergency-stop.stl:"), "{told}");
    let text = std::fs::read_to_string(machine_file("emergency-stop-840d")).expect("readable");
    let path = machine_file("emergency-stop-840d");
    let alone: Vec<&str> = text.lines().filter(|l| !l.starts_with("plc ")).collect();
    let told = machine::load_bytes(&path, alone.join("\n").into_bytes(), &families)
        .expect_err("no half in the PLC")
        .to_string();
    let expected = "guarantee standstill is about both halves of the safe logic";
    assert!(
        told.contains(expected) && told.contains("emergency-stop-840d.toml:"),
        "{told}"
    );
}
