//! `--run`: every test of the monitors on the simulated axis, and that each of them can fail.

use std::collections::BTreeSet;

use stillpoint_harness::acceptance::{Ran, run};
use stillpoint_machine::acceptance::{Protocol, Simulated, Test};
use stillpoint_machine::{self as machine, Machine};

use super::{CATALOGUE, FAMILY, MILLING, json, milling};
use crate::common::{copied, messages, stdout, stillpoint};

/// The milling machine with other functions: cams, override, setpoint limit, STOP A, B and E of the stages (X); the pulses
/// cancelled over the drive bus, stops for the whole channel (Y); a spindle with slip; a door that asks for SBH.
fn other(name: &str) -> String {
    let factors = format!("[\"100 %\", \"40 %\"{}]", ", \"100 %\"".repeat(14));
    let x = format!(
        "functions = [\"SBH/SG\", \"SE\", \"SN1+\", \"SN1-\", \"SN3-\", \"cam sync\", \"override\", \"external stops\", \"STOP E\"]\n\
         VELO_OVR_FACTOR = {factors}\nDES_VELO_LIMIT = \"80 %\"\n\
         CAM_POS_PLUS = [\"100 mm\", \"10 mm\", \"10 mm\", \"10 mm\"]\n\
         CAM_POS_MINUS = [\"-100 mm\", \"-10 mm\", \"-20 mm\", \"-10 mm\"]"
    );
    milling(
        name,
        &[
            (
                "functions = [\"SBH/SG\", \"SE\", \"external stops\", \"STOP E\"]",
                &x,
            ),
            (
                "[\"STOP C\", \"STOP D\", \"STOP D\", \"STOP D\"]",
                "[\"STOP A\", \"STOP B\", \"STOP D\", \"STOP E\"]",
            ),
            (
                "kind      = \"linear\"\ntitle     = \"saddle, to and fro\"",
                "kind      = \"linear\"\nINTERNAL_PULSE_CANCELLATION = true\nEXT_PULSE_ENABLE_ASSIGNED = true\n\
                 EXT_PULSE_TEST_ASSIGNED = true\nCONTROL_MODULE = \"High Performance\"",
            ),
            (
                "IPO_STOP_GROUP      = \"interpolating axes\"\ninterpolates_with   = [\"X\", \"Z\"]",
                "IPO_STOP_GROUP      = \"channel\"\ninterpolates_with   = [\"X\", \"Z\"]",
            ),
            (
                "functions = [\"SBH/SG\", \"external stops\"]",
                "functions = [\"SBH/SG\", \"slip sync\", \"external stops\"]\nSLIP = true\n\
                 LOAD_ENCODER = \"incremental\"",
            ),
            ("open          = \"SG1\"", "open          = \"SBH\""),
        ],
    )
}

fn load(file: &str) -> (Machine, Protocol) {
    let path = crate::common::root().join(file);
    let machine = machine::load(&path, &machine::families(&path)).expect("plausible");
    let protocol = machine.acceptance().expect("a protocol");
    (machine, protocol)
}

/// Runs tests; each of them has to have a scenario.
fn ran(machine: &Machine, tests: &[Test]) -> Vec<Ran> {
    let tests: Vec<&Test> = tests.iter().collect();
    let (ran, unfit) = run(machine, &tests);
    assert_eq!(unfit, []);
    assert_eq!(ran.len(), tests.len());
    ran
}

/// The tests with a scenario, the scenario changed.
fn changed(protocol: &Protocol, change: impl Fn(&Test, &str) -> Option<String>) -> Vec<Test> {
    let tests = protocol.tests.iter();
    let changed = tests.filter_map(|test| match &test.simulated {
        Simulated::Scenario(text) => Some(Test {
            simulated: Simulated::Scenario(change(test, text)?),
            ..test.clone()
        }),
        Simulated::Not(_) => None,
    });
    changed.collect()
}

/// The kind of a test: its name without axis and numbers.
fn kind(test: &str) -> String {
    let plain = test.rsplit_once('-').map_or(test, |(kind, _)| kind);
    plain.chars().filter(|c| !c.is_ascii_digit()).collect()
}

#[test]
fn every_test_of_the_monitors_is_run_and_holds() {
    let json = json(&[MILLING, "--run"]);
    let ran = json["simulated"].as_array().expect("results");
    let not = json["not_simulated"].as_array().expect("reasons");
    let all = json["tests"].as_array().expect("tests");
    assert_eq!((all.len(), ran.len(), not.len()), (108, 103, 5));
    for one in ran {
        assert_eq!(one["holds"], true, "{one:#}");
        let expectations = one["expectations"].as_array().expect("expectations");
        assert!(!expectations.is_empty(), "{one:#}");
    }
    // What only the machine can show says why.
    for one in not {
        let id = one["id"].as_str().expect("an id");
        assert!(id.starts_with("ACTUAL-") || id == "EMERGENCY-STOP", "{id}");
        assert!(one["reason"].as_str().is_some_and(|r| r.len() > 20));
    }
    let text = stdout(&stillpoint(&["acceptance", MILLING, "--run"]));
    assert!(
        text.contains("103 of 108 tests were run")
            && text.contains("5 were not, each for its reason"),
        "{text}"
    );
}

#[test]
fn every_kind_of_test_is_run_on_one_of_two_machines() {
    let (machine, protocol) = load(&other("acceptance-other"));
    let tests = changed(&protocol, |_, text| Some(text.to_owned()));
    for one in ran(&machine, &tests) {
        assert!(one.holds, "{}: {:#?}", one.id, one.judged);
    }
    let mut kinds: BTreeSet<String> = tests.iter().map(|t| kind(&t.id)).collect();
    let (_, milling) = load(MILLING);
    kinds.extend(
        changed(&milling, |_, text| Some(text.to_owned()))
            .iter()
            .map(|t| kind(&t.id)),
    );
    let catalogue = std::fs::read_to_string(
        crate::common::root().join("spec/families/sinumerik-840d/acceptance.toml"),
    );
    let catalogue: toml::Table = toml::from_str(&catalogue.expect("readable")).expect("TOML");
    let tests = catalogue["test"].as_array().expect("tests");
    let scenarios = tests.iter().filter(|t| t.get("simulate").is_some());
    assert_eq!(scenarios.count(), 24);
    for want in [
        "TEST-STOP",
        "TEST-STOP-NEGATIVE",
        "EXTERNAL-SHUTDOWN",
        "EXTERNAL-A",
        "EXTERNAL-C",
        "EXTERNAL-D",
        "EXTERNAL-E",
        "FORCED",
        "COMPARE",
        "DOOR-front",
        "CHANGE-SG",
        "CHANGE-SBH",
        "STOP-GROUP",
        "AGREEMENT",
        "SLIP",
        "SG",
        "SG-NOT-BRAKED",
        "SETPOINT-LIMIT",
        "OVERRIDE-SG",
        "SBH",
        "SBR",
        "THRESHOLD",
        "SE+",
        "SE-",
        "SN+",
        "SN-",
    ] {
        assert!(kinds.contains(want), "{want} was not run: {kinds:?}");
    }
}

/// Nothing is done to the machine but what the preconditions say: then no test may give what is expected of it.
#[test]
fn a_test_in_which_nothing_happens_fails() {
    let idle = |test: &Test, text: &str| {
        // Z is like Y, with other values.
        if test.axis.as_deref() == Some("Z") {
            return None;
        }
        let mut table: toml::Table = toml::from_str(text).expect("TOML");
        for event in [
            "motion",
            "stop",
            "signal",
            "door",
            "fault",
            "agreement",
            "reference",
            "moved",
        ] {
            table.remove(event);
        }
        Some(toml::to_string(&table).expect("TOML"))
    };
    let (machine, protocol) = load(&other("acceptance-idle"));
    for one in ran(&machine, &changed(&protocol, idle)) {
        assert!(!one.holds, "{} holds although nothing is done", one.id);
    }
}

/// For each kind of test a thing that goes another way: what is expected does not come, and the test says so.
#[test]
fn each_kind_fails_with_a_broken_expectation() {
    let breaks: &[(&str, &str, &str)] = &[
        // The path that is tested does not cancel the pulses.
        (
            "TEST-STOP-X",
            "[[expect]]",
            "[[fault]]\nat = \"0 s\"\naxis = \"X\"\nkind = \"lost\"\nsignal = \"pulses_cancelled\"\n[[expect]]",
        ),
        // The feedback comes, so that no STOP A follows.
        (
            "TEST-STOP-NEGATIVE-X",
            "at     = \"0.4 s\"",
            "at     = \"0.4 s\"\nuntil  = \"0.5 s\"",
        ),
        (
            "EXTERNAL-SHUTDOWN-Y",
            "alarm = \"27006\"",
            "alarm = \"27002\"",
        ),
        (
            "EXTERNAL-C-X",
            "stop = \"C\"\n[[expect]]",
            "stop = \"D\"\n[[expect]]",
        ),
        // The feedback stays interrupted after power-on: the door is never released.
        ("FORCED-front", "until   = \"1.1 s\"", ""),
        (
            "COMPARE-X",
            "kind    = \"lost\"",
            "kind    = \"stuck\"\nvalue   = true",
        ),
        // The error ends, but the request is expected to end with it.
        ("COMPARE-LOGIC", "stop = \"NONE\"", "stop = \"D\""),
        // The axis does not brake when the door is asked for.
        (
            "DOOR-front-X",
            "at    = \"1 s\"\naxis  = \"X\"\nspeed = \"0 mm/min\"",
            "at    = \"1 s\"\naxis  = \"X\"\nspeed = \"2200 mm/min\"",
        ),
        (
            "CHANGE-SG-X",
            "speed = \"1000 mm/min\"",
            "speed = \"3000 mm/min\"",
        ),
        ("CHANGE-SBH-X", "function = \"SBH\"", "function = \"SG3\""),
        // A stop asked for by signals does not reach the other axes.
        ("STOP-GROUP-X", "function = \"SG1\"", "function = \"SG4\""),
        // Moved by less than the tolerance, the axis is where it was.
        ("AGREEMENT-X", "by   = \"0.11 mm\"", "by   = \"0.01 mm\""),
        // A slip hardly faster than what is tolerated.
        (
            "SLIP-S",
            "speed   = \"6 rev/min\"",
            "speed   = \"6.1 rev/min\"",
        ),
        (
            "SG1-X",
            "speed = \"2200 mm/min\"",
            "speed = \"2000 mm/min\"",
        ),
        // It brakes in time.
        (
            "SG1-NOT-BRAKED-Y",
            "braking      = \"27 mm/s2\"",
            "braking      = \"500 mm/s2\"",
        ),
        (
            "SETPOINT-LIMIT-X",
            "duration = \"4 s\"",
            "duration = \"4 s\"\nacceptance_mode = true",
        ),
        ("OVERRIDE-SG2-X", "value  = true", "value  = false"),
        ("SBH-X", "stop  = \"B\"", "stop  = \"C\""),
        (
            "SBR-X",
            "kind = \"no braking\"",
            "kind = \"encoder freeze\"",
        ),
        (
            "THRESHOLD-X",
            "speed = \"100 mm/min\"",
            "speed = \"15 mm/min\"",
        ),
        // Without the agreement the limit does not act.
        (
            "SE1+-X",
            "[[motion]]",
            "[[agreement]]\nat = \"0.05 s\"\ngive = false\n[[motion]]",
        ),
        (
            "SE1--Y",
            "speed = \"-3000 mm/min\"",
            "speed = \"3000 mm/min\"",
        ),
        ("SN1+-X", "to    = \"110.1 mm\"", "to    = \"95 mm\""),
        ("SN3--X", "to    = \"-9.9 mm\"", "to    = \"-25 mm\""),
    ];
    let files = [MILLING.to_owned(), other("acceptance-broken")];
    let machines = files.map(|file| load(&file));
    for (id, from, to) in breaks {
        let mut found = machines.iter().filter_map(|(machine, protocol)| {
            let with = |test: &Test, text: &str| {
                let here = test.id == *id && text.contains(from);
                here.then(|| text.replacen(from, to, 1))
            };
            let tests = changed(protocol, with);
            (!tests.is_empty()).then_some((machine, tests))
        });
        let (machine, tests) = found
            .next()
            .unwrap_or_else(|| panic!("no {id} with {from}"));
        for one in ran(machine, &tests) {
            assert!(!one.holds, "{id} holds with {to}");
        }
    }
}

#[test]
fn a_test_that_fails_is_told_with_its_diagram() {
    // An axis that stays below its limit is not stopped; two tests drive it.
    let fast = "v = \"VELO_LIMIT[k] + MAX(VELO_LIMIT[k] / 10, 60000)\"";
    let slow = [(CATALOGUE, fast, "v = \"VELO_LIMIT[k] / 2\""); 2];
    let file = copied("acceptance-run", MILLING, FAMILY, &slow);
    let output = stillpoint(&["acceptance", &file, "--run"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    assert!(
        said.contains("simulated tests do not give what is expected"),
        "{said}"
    );
    // A test needs a scenario or a reason, and has only one of them.
    let bare = [(
        CATALOGUE,
        "hardware = \"the buttons",
        "# hardware = \"the buttons",
    )];
    let file = copied("acceptance-bare", MILLING, FAMILY, &bare);
    let output = stillpoint(&["acceptance", &file]);
    assert_eq!(output.status.code(), Some(2));
    let said = messages(&output);
    assert!(said.contains("can neither be simulated"), "{said}");
}
