//! `stillpoint acceptance`: a test for each enabled function and limit, and what a change makes to be repeated.

mod run;

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use crate::common::{copied, stdout, stillpoint};

const MILLING: &str = "spec/machines/milling-840d.toml";
const FAMILY: &str = "spec/families/sinumerik-840d";
const CATALOGUE: &str = "spec/families/sinumerik-840d/acceptance.toml";

fn json(arguments: &[&str]) -> Value {
    let mut all = vec!["acceptance"];
    all.extend(arguments);
    all.push("--json");
    let output = stillpoint(&all);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{all:?}: {errors}");
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// The tests of a protocol.
pub fn ids(json: &Value) -> BTreeSet<String> {
    let tests = json["tests"].as_array().expect("tests").iter();
    tests
        .map(|t| t["id"].as_str().expect("an id").to_owned())
        .collect()
}

/// A test of a protocol.
pub fn test<'a>(json: &'a Value, id: &str) -> &'a Value {
    let list = json["tests"].as_array().expect("tests");
    list.iter()
        .find(|t| t["id"] == id)
        .unwrap_or_else(|| panic!("no test {id}"))
}

/// A copy of the milling machine with something replaced, and of its family.
fn milling(name: &str, replace: &[(&str, &str)]) -> String {
    let replace: Vec<_> = replace
        .iter()
        .map(|(from, to)| (MILLING, *from, *to))
        .collect();
    copied(name, MILLING, FAMILY, &replace)
}

/// The list of tests and their parts (S840D-ACCEPT-751).
#[test]
fn one_test_for_each_enabled_function_and_limit() {
    let json = json(&[MILLING]);
    let ids = ids(&json);
    for axis in ["X", "Y", "Z"] {
        for id in [
            "TEST-STOP",
            "TEST-STOP-NEGATIVE",
            "EXTERNAL-A",
            "EXTERNAL-C",
            "EXTERNAL-D",
            "EXTERNAL-E",
            "COMPARE",
            "DOOR-front",
            "CHANGE-SG",
            "CHANGE-SBH",
            "STOP-GROUP",
            "AGREEMENT",
            "ACTUAL",
            "SG1",
            "SG2",
            "SG3",
            "SG4",
            "SG1-NOT-BRAKED",
            "SBH",
            "SBR",
            "THRESHOLD",
            "SE1+",
            "SE1-",
            "SE2+",
            "SE2-",
        ] {
            assert!(ids.contains(&format!("{id}-{axis}")), "{id}-{axis}");
        }
    }
    for id in [
        "FORCED-front",
        "COMPARE-LOGIC",
        "EMERGENCY-STOP",
        "SBH-S",
        "SG4-S",
        "EXTERNAL-D-S",
    ] {
        assert!(ids.contains(id), "{id}");
    }
    // What is not enabled is not tested: no limit switches, no STOP E, no agreement of the spindle; no cams at all.
    for id in [
        "SE1+-S",
        "EXTERNAL-E-S",
        "AGREEMENT-S",
        "SN1+-X",
        "OVERRIDE-SG2-X",
        "SLIP-X",
        "STOP-GROUP-S",
    ] {
        assert!(!ids.contains(id), "{id}");
    }
}

#[test]
fn a_function_that_is_enabled_gets_its_tests() {
    let file = milling(
        "acceptance-cams",
        &[(
            "functions = [\"SBH/SG\", \"SE\", \"external stops\", \"STOP E\"]",
            "functions = [\"SBH/SG\", \"SE\", \"SN2+\", \"override\", \"external stops\", \"STOP E\"]",
        )],
    );
    let ids = ids(&json(&[&file]));
    assert!(ids.contains("SN2+-X") && ids.contains("OVERRIDE-SG2-X"));
    assert!(!ids.contains("SN1+-X") && !ids.contains("SN2+-Y"));
}

#[test]
fn values_tolerances_and_traces() {
    let json = json(&[MILLING]);
    let sg = test(&json, "SG1-X");
    assert_eq!(sg["title"], "SG1 of axis X: 2000 mm/min, STOP C");
    let expect = sg["expect"].as_array().expect("expect");
    assert_eq!(
        (&expect[0]["signal"], &expect[0]["value"]),
        (&"stop".into(), &"C".into())
    );
    assert_eq!(expect[0]["latest_cycles"], 3);
    assert_eq!(expect[1]["value"], "TRUE");
    // t_C 300 ms = 25 cycles, and 4 of tolerance.
    assert_eq!(
        (&expect[1]["latest_cycles"], &expect[1]["latest_us"]),
        (&29.into(), &348_000.into())
    );
    assert_eq!(sg["depends"]["VELO_LIMIT[0]"], "2000 mm/min");
    assert!(sg["depends"]["VELO_LIMIT[1]"].is_null());
    let spindle = test(&json, "SG1-S");
    assert_eq!(spindle["title"], "SG1 of axis S: 50 rev/min, STOP C");
    assert_eq!(spindle["measure"][0]["unit"], "rev/min");
}

#[test]
fn checksums_are_those_of_the_files() {
    let first = json(&[MILLING]);
    let again = json(&[MILLING]);
    assert_eq!(first, again);
    assert_eq!(first["sha256"].as_str().expect("a checksum").len(), 64);
    let other = json(&[&milling("acceptance-sum", &[("0.5 mm", "0.4 mm")])]);
    assert_ne!(first["sha256"], other["sha256"]);
    assert_eq!(first["family_sha256"], other["family_sha256"]);
}

#[test]
fn a_changed_limit_is_tested_again_and_nothing_else() {
    let new = milling(
        "acceptance-limit",
        &[(
            "\"2000 mm/min\", \"5000 mm/min\"",
            "\"2000 mm/min\", \"6000 mm/min\"",
        )],
    );
    let json = json(&[&new, "--since", MILLING]);
    let since = &json["since"];
    assert_eq!(since["changes"].as_array().expect("changes").len(), 1);
    let change = &since["changes"][0];
    assert_eq!(change["of"], "axis X");
    assert_eq!(change["name"], "VELO_LIMIT[1]");
    assert_eq!(
        (&change["old"], &change["new"]),
        (&"5000 mm/min".into(), &"6000 mm/min".into())
    );
    let repeat = ids(&json);
    let expected = ["CHANGE-SG-X", "DOOR-front-X", "SG2-NOT-BRAKED-X", "SG2-X"];
    assert_eq!(
        repeat.iter().map(String::as_str).collect::<Vec<_>>(),
        expected
    );
    let why = since["repeat"].as_array().expect("repeat");
    assert!(
        why.iter()
            .all(|r| r["reasons"][0] == "VELO_LIMIT[1]: 5000 mm/min -> 6000 mm/min"),
        "{why:?}"
    );
}

#[test]
fn a_new_function_and_a_removed_axis() {
    let spindle = "[\"SBH/SG\", \"external stops\"]";
    let new = milling(
        "acceptance-new",
        &[
            (spindle, "[\"SBH/SG\", \"SN1+\", \"external stops\"]"),
            (
                "interpolates_with   = [\"Y\", \"Z\"]",
                "interpolates_with   = [\"Y\"]",
            ),
        ],
    );
    let json = json(&[&new, "--since", MILLING]);
    let repeat = ids(&json);
    assert!(
        repeat.contains("SN1+-S")
            && repeat.contains("AGREEMENT-S")
            && repeat.contains("STOP-GROUP-X")
    );
    assert!(!repeat.contains("SBH-Y"), "{repeat:?}");
    let back = self::json(&[MILLING, "--since", &new]);
    let gone = back["since"]["gone"].as_array().expect("gone");
    assert!(gone.contains(&"SN1+-S".into()), "{gone:?}");
}

#[test]
fn nothing_changed_nothing_repeated() {
    let json = json(&[MILLING, "--since", MILLING]);
    assert!(json["tests"].as_array().expect("tests").is_empty());
    assert!(
        json["since"]["changes"]
            .as_array()
            .expect("changes")
            .is_empty()
    );
    let text = stdout(&stillpoint(&["acceptance", MILLING, "--since", MILLING]));
    assert!(text.contains("No test has to be repeated"), "{text}");
}

#[test]
fn the_clock_makes_everything_with_a_time_to_be_repeated() {
    let new = milling(
        "acceptance-clock",
        &[(
            "SAFETY_SYSCLOCK_TIME_RATIO = 3",
            "SAFETY_SYSCLOCK_TIME_RATIO = 2",
        )],
    );
    let repeat = ids(&json(&[&new, "--since", MILLING]));
    for id in ["SBH-X", "SG1-S", "SE1+-Z", "COMPARE-Y", "TEST-STOP-X"] {
        assert!(repeat.contains(id), "{id}");
    }
    assert!(!repeat.contains("EMERGENCY-STOP"));
}

/// Documentation, both function tests, completion, and what a later measure repeats (S840D-ACCEPT-722, S840D-ACCEPT-723).
#[test]
fn markdown_and_page() {
    let text = stdout(&stillpoint(&["acceptance", MILLING]));
    for part in [
        "# Acceptance test of milling-840d",
        "SHA-256",
        "SG1 of axis X: 2000 mm/min, STOP C",
        "Signature",
        "MD10094",
        "encoder system replaced",
        "Function test part 1",
        "Function test part 2",
        "Completion",
    ] {
        assert!(text.contains(part), "no {part}");
    }
    assert!(!text.contains("{axis}"), "a place was not filled in");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("acceptance.html");
    let shown = path.display().to_string();
    let output = stillpoint(&["acceptance", MILLING, "--html", &shown]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(0), 0));
    let page = std::fs::read_to_string(&path).expect("the page");
    assert!(page.contains("an authorised person carries out"), "{page}");
}

#[test]
fn bad_input_is_refused() {
    let output = stillpoint(&["acceptance", "tests/bad-input/does-not-exist.toml"]);
    assert_eq!(output.status.code(), Some(2));
    let output = stillpoint(&["acceptance", MILLING, "--since", "no-such-file.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
}

#[test]
fn a_parameter_that_no_test_reads_is_a_fault_of_the_catalogue() {
    let read = "[\"VELO_OVR_FACTOR\", \"VELO_SWITCH_DELAY\"]";
    let replace = [(CATALOGUE, read, "[\"VELO_SWITCH_DELAY\"]")];
    let file = copied("acceptance-unread", MILLING, FAMILY, &replace);
    let output = stillpoint(&["acceptance", &file]);
    assert_eq!(output.status.code(), Some(2));
    let says = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        says.contains("no acceptance test depends on VELO_OVR_FACTOR"),
        "{says}"
    );
}

const INTERLOCK: &str = "tests/machines/interlock-840d";

/// The protocol carries the guarantees: with their verdicts, bounds and values where they are asked for.
#[test]
fn the_protocol_tells_what_the_machine_guarantees() {
    let file = format!("{INTERLOCK}.toml");
    let json = json(&[&file, "--guarantees"]);
    let list = json["guarantees"].as_array().expect("guarantees");
    assert_eq!(list.len(), 6);
    assert!(list.iter().all(|g| g["verdict"] == "holds"), "{list:#?}");
    let hold = &list[0]["runs"][0];
    assert_eq!(hold["bound_us"], 208_000);
    let values = hold["values"].as_array().expect("values");
    assert!(values.iter().any(|v| v["name"] == "STANDSTILL_TOL"));
    let page = stdout(&stillpoint(&["acceptance", &file, "--markdown"]));
    assert!(page.contains("What this machine guarantees") && page.contains("hold_to_run"));
}

/// A broken guarantee: the fault, the lines of the program and the values that decide it are in the JSON, and the protocol ends with status 1.
#[test]
fn what_breaks_a_guarantee_is_told_to_programs() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("broken-interlock");
    std::fs::create_dir_all(&folder).expect("a folder");
    let text = |end: &str| {
        let path = stillpoint_tests::root().join(format!("{INTERLOCK}.{end}"));
        std::fs::read_to_string(path).expect("readable")
    };
    let program = text("spf").replace("ACK_KEY AND KEY_WAS_UP", "ACK_KEY");
    std::fs::write(folder.join("interlock-840d.spf"), program).expect("written");
    std::fs::write(folder.join("interlock-840d.stl"), text("stl")).expect("written");
    let slow = text("toml")
        .replace("contacts      = 2", "contacts      = 1")
        .replace(
            "PULSE_DISABLE_DELAY = \"24 ms\"",
            "PULSE_DISABLE_DELAY = \"240 ms\"",
        );
    let path = folder.join("interlock-840d.toml");
    std::fs::write(&path, slow).expect("written");
    let file = path.display().to_string();
    let families = stillpoint_tests::root().join("spec/families");
    let families = families.display().to_string();
    let output = stillpoint(&["--family-data", &families, "check", &file, "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let json: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let runs = json["runs"].as_array().expect("runs");
    let broken = |title: &str| {
        let run = runs
            .iter()
            .find(|r| r["title"].as_str().is_some_and(|t| t.starts_with(title)));
        let properties = run.expect("a run")["properties"]
            .as_array()
            .expect("properties");
        let broken = properties.iter().find(|p| p["verdict"] == "violated");
        broken
            .unwrap_or_else(|| panic!("{title}: {properties:#?}"))
            .clone()
    };
    let lines = &broken("what the safe logic wants before it takes a stop back")["lines"];
    assert!(
        lines.to_string().contains("RELEASED = ESTOP_FREE"),
        "{lines}"
    );
    let by = &broken("an axis whose enabling device is released")["decided_by"];
    assert!(by.to_string().contains("PULSE_DISABLE_DELAY"), "{by}");
    let list = json["guarantees"].as_array().expect("guarantees");
    let start = list
        .iter()
        .find(|g| g["name"] == "no_start")
        .expect("asked");
    let stuck = start["runs"].as_array().expect("runs").iter();
    let stuck = stuck.filter(|r| r["faults"].to_string().contains("stuck at 0 or 1"));
    assert!(stuck.clone().count() == 1 && stuck.clone().all(|r| r["verdict"] == "violated"));
    let status = stillpoint(&[
        "--family-data",
        &families,
        "acceptance",
        &file,
        "--guarantees",
    ]);
    assert_eq!(status.status.code(), Some(1));
}
