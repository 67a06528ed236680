//! The protocol of the acceptance test.

use std::path::Path;

use super::{MACHINE, changed, json};
use crate::acceptance::{ids, test};
use crate::common::{messages, stdout, stillpoint};

/// Tests of the functions and limits, of the doors, permissives, keys, brakes, and of the control's own tests.
#[test]
fn every_function_and_limit_is_tested() {
    let ids = ids(&json(&["acceptance", MACHINE]));
    let has = |id: &str| assert!(ids.contains(id), "{id}");
    for id in [
        "PARAMETERS",
        "SPLC-PROGRAM",
        "SELF-TEST",
        "SELF-TEST-DOORS",
        "SELF-TEST-INTERVAL",
        "CONFIGURATION",
        "CONTACT-CHAIN",
        "OUTPUTS",
        "DYNAMIC-SAMPLING",
        "BRAKE-CONTROL",
        "BRAKE-Z",
        "NO-BRAKE-X",
        "DOOR-front",
        "DOOR-magazine",
        "DOOR-front-S",
        "DOOR-magazine-M",
        "MODE-SOM_1",
        "MODE-SOM_4",
        "MODE-CHANGE",
        "AXES-AT-A-TIME",
        "PERMISSIVE-NC",
        "PERMISSIVE-T",
        "KEYS-S",
        "UNEXPECTED-START-NC",
        "STOP-SEQUENCE-S",
        "STOP-NC",
        "STOP-OF-SPINDLE-S",
        "RESTRICTED-S",
        "TOOL-HOLDER-S",
        "MAGAZINE-magazine",
    ] {
        has(id);
    }
    for axis in ["X", "Y", "Z", "S", "M"] {
        for id in [
            "CUT-OUT",
            "EMERGENCY-STOP",
            "SLS-SOM_2",
            "SS1-TIME",
            "SS2-TIME",
            "DVDT",
            "SPEED",
            "COMPARISON",
            "MOTOR",
        ] {
            has(&format!("{id}-{axis}"));
        }
    }
    for axis in ["X", "Y", "Z"] {
        for id in [
            "SLS-SOM_3",
            "SLS-SOM_4",
            "SOS-SPEED",
            "SOS-WAY",
            "SS2-WAY",
            "SLP+",
            "SLP-",
            "REFERENCE",
            "MARK",
            "POSITION",
        ] {
            has(&format!("{id}-{axis}"));
        }
    }
    for id in [
        "SLP+-S",
        "SLP+-M",
        "SLS-SOM_3-M",
        "MODE-SOM_4-LOCKED",
        "BRAKE-CONTROL-OFF",
        "BRAKE-X",
        "STOP-SEQUENCE-NC",
    ] {
        assert!(!ids.contains(id), "{id}");
    }
}

/// What a bit of SMP560 makes to be tested another way.
#[test]
fn the_configuration_decides_what_is_tested() {
    let machine = changed(
        "hfs-acceptance-bits",
        &[(MACHINE, "SMP560_0 = true", "SMP560_3 = true")],
    );
    let ids = ids(&json(&["acceptance", &machine]));
    assert!(ids.contains("MODE-SOM_4-LOCKED") && ids.contains("BRAKE-CONTROL-OFF"));
    assert!(
        !ids.contains("MODE-SOM_4")
            && !ids.contains("SLS-SOM_4-X")
            && !ids.contains("BRAKE-CONTROL")
    );
}

#[test]
fn values_times_and_what_a_test_depends_on() {
    let json = json(&["acceptance", MACHINE]);
    let sls = test(&json, "SLS-SOM_2-X");
    assert_eq!(sls["title"], "SLS of X in SOM_2: 2000 mm/min");
    assert_eq!(sls["measure"][0]["limit"], "2100 mm/min");
    assert_eq!(sls["expect"][1]["latest_us"], 6_000);
    assert_eq!(sls["depends"]["SMP590"], "2000 mm/min");
    // The door: 52 ms in the CC, 31 ms and two cycles of the SPLC in the MC, one cycle of tolerance.
    let door = test(&json, "DOOR-front-X");
    assert_eq!(door["expect"][0]["latest_us"], 52_000 + 3_000);
    assert_eq!(door["expect"][1]["latest_us"], 31_000 + 42_000 + 3_000);
    // A group stands when its slowest axis stands, and depends on all of them.
    let permissive = test(&json, "PERMISSIVE-NC");
    assert_eq!(
        permissive["expect"][1]["latest_us"],
        28_000 + 42_000 + 3_000 + 400_000
    );
    assert_eq!(
        permissive["depends"]["SMP527"],
        "X 400 ms, Y 400 ms, Z 400 ms"
    );
    assert_eq!(permissive["depends"]["axes"], "X, Y, Z");
    // None is simulated, and each says why.
    for test in json["tests"].as_array().expect("tests") {
        assert_eq!(test["simulated"], false);
        let why = test["not_simulated"].as_str().expect("a reason");
        assert!(why.contains("no scenario"), "{why}");
    }
}

/// HFS-PARAM-012: SMP525 is the braking time with MP2308, 50 ms and 70 ms, so that the drive has to stand that much earlier.
#[test]
fn the_braking_time_of_an_ss1_is_smp525_without_its_allowances() {
    let limit = |machine: &str| -> i64 {
        let json = json(&["acceptance", machine]);
        let limit = test(&json, "SS1-TIME-X")["measure"][0]["limit"].clone();
        let text = limit.as_str().expect("a limit").to_owned();
        text.strip_suffix(" ms")
            .and_then(|n| n.parse().ok())
            .unwrap_or_else(|| panic!("{text}"))
    };
    let usual = limit(MACHINE);
    // MP2308 is 200 ms.
    assert_eq!(usual, 600 - 200 - 50 - 70);
    let longer = changed(
        "hfs-acceptance-smp525",
        &[(MACHINE, "SMP525  = \"600 ms\"", "SMP525  = \"690 ms\"")],
    );
    assert_eq!(limit(&longer), usual + 90);
}

/// Partial acceptance test: only what the changed parameter affects.
#[test]
fn a_changed_parameter_repeats_its_tests() {
    let path = changed(
        "hfs-acceptance-since",
        &[
            (
                MACHINE,
                "\"450 ms\"\nSMP527  = \"400 ms\"",
                "\"450 ms\"\nSMP527  = \"430 ms\"",
            ),
            (MACHINE, "SMP610 = [\"NC\"]", "SMP610 = []"),
        ],
    );
    let json = json(&["acceptance", &path, "--since", MACHINE]);
    let changes = json["since"]["changes"].as_array().expect("changes");
    let shown: Vec<String> = changes
        .iter()
        .map(|c| {
            format!("{} {}: {} -> {}", c["of"], c["name"], c["old"], c["new"]).replace('"', "")
        })
        .collect();
    assert_eq!(
        shown,
        [
            "axis Z SMP527: 400 ms -> 430 ms",
            "group S SMP610: NC -> none"
        ]
    );
    let repeat: Vec<String> = ids(&json).into_iter().collect();
    assert_eq!(
        repeat,
        ["KEYS-NC", "PERMISSIVE-NC", "PERMISSIVE-S", "SS2-TIME-Z"]
    );
    assert_eq!(
        json["since"]["gone"],
        serde_json::json!(["STOP-SEQUENCE-S"])
    );
}

/// What belongs to a complete acceptance test beside the tests.
#[test]
fn protocol_in_markdown_and_html() {
    let text = stdout(&stillpoint(&["acceptance", MACHINE]));
    for part in [
        "# Acceptance test of machining-centre-heidenhain",
        "SHA-256",
        "Group NC of X, Y, Z",
        "SMP691.0 to SMP691.2",
        "ISO 13849-1",
        "an encoder exchanged",
        "a machine of a series",
        "All invalid old machine parameter files are removed",
        "SLS of S in SOM_3: 800 rev/min",
    ] {
        assert!(text.contains(part), "no {part}");
    }
    assert!(!text.contains('{'), "a place was not filled in");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hfs-acceptance.html");
    let shown = path.display().to_string();
    let output = stillpoint(&["acceptance", MACHINE, "--html", &shown]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(0), 0));
    let page = std::fs::read_to_string(&path).expect("the page");
    for part in [
        "<svg",
        "DOOR-front-X",
        "personnel authorised by the machine tool builder",
    ] {
        assert!(page.contains(part), "no {part}");
    }
    let again = stillpoint(&["acceptance", MACHINE, "--html", &shown]);
    assert_eq!(again.status.code(), Some(0));
    assert_eq!(page, std::fs::read_to_string(&path).expect("the page"));
}

/// Nothing is run where nothing can be simulated, and the protocol does not claim it.
#[test]
fn a_run_says_that_nothing_was_simulated() {
    let output = stillpoint(&["acceptance", MACHINE, "--run"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.contains("No test was simulated"), "{text}");
    assert!(!text.contains("Every simulated test"), "{text}");
}

#[test]
fn a_parameter_that_no_test_reads_is_a_fault_of_the_catalogue() {
    let machine = changed(
        "hfs-acceptance-unread",
        &[(
            "spec/families/heidenhain-fs/acceptance.toml",
            "SMP560_10 = ",
            "SMP560_11 = ",
        )],
    );
    let output = stillpoint(&["acceptance", &machine]);
    assert_eq!(output.status.code(), Some(2));
    let says = messages(&output);
    assert!(
        says.contains("no acceptance test depends on SMP560_10"),
        "{says}"
    );
    assert!(
        says.contains("'SMP560_11' is no parameter without a test"),
        "{says}"
    );
}

/// What the machine builder has to see to, and the test of the protocol that asks for it.
#[test]
fn what_is_not_in_the_kernel_is_asked_for() {
    let json = json(&["acceptance", MACHINE]);
    for (requirement, id, asks) in [
        (
            "HFS-ACCEPT-001",
            "SPLC-PROGRAM",
            "cannot be put into service without the password",
        ),
        (
            "HFS-ACCEPT-002",
            "PARAMETERS",
            "asks for a partial acceptance test",
        ),
        (
            "HFS-ACCEPT-003",
            "EMERGENCY-STOP-X",
            "each emergency stop button",
        ),
        ("HFS-ACCEPT-003", "DOOR-front", "one contact of the door"),
        (
            "HFS-ACCEPT-004",
            "MARK-X",
            "distance between mark and position",
        ),
        (
            "HFS-ACCEPT-005",
            "PARAMETER-FILES",
            "Remove all invalid parameter files",
        ),
        (
            "HFS-CHK-005",
            "REFERENCE-X",
            "the display marks it as not checked",
        ),
        ("HFS-DVDT-005", "DVDT-X", "\"limit\":\"15 ms\""),
        ("HFS-GRP-004", "STOP-SEQUENCE-S", "the wait for NC included"),
        (
            "HFS-LIM-001",
            "PARAMETER-FILES",
            "nothing switches safe machine parameters",
        ),
        ("HFS-LIM-005", "CONTACT-CHAIN", "at each relay in turn"),
        ("HFS-MODE-017", "MODE-SOM_2", "the mode is displayed"),
        ("HFS-NAV-005", "POSITION-X", "W1044"),
        (
            "HFS-NAV-007",
            "SPEED-X",
            "longest time outside the tolerance",
        ),
        (
            "HFS-PARAM-003",
            "PARAMETERS",
            "with 95148 no SMP can be changed",
        ),
        (
            "HFS-PARAM-006",
            "PARAMETERS",
            "with the old value it starts without the password",
        ),
        ("HFS-PARAM-008", "PARAMETER-FILES", "MP subfiles"),
        ("HFS-PARAM-012", "SS1-TIME-X", "\"limit\":\"280 ms\""),
        (
            "HFS-PARAM-013",
            "SS2-TIME-X",
            "together with the axes it interpolates with",
        ),
        ("HFS-PARAM-014", "SS2-WAY-X", "7 mm to 10 mm"),
        ("HFS-PARAM-015", "POSITION-X", "as small as"),
        ("HFS-PARAM-016", "MODULO-M", "software limit switches act"),
        ("HFS-PARAM-020", "MOTOR-X", "no formula"),
        (
            "HFS-SLP-007",
            "SLP+-X",
            "must end before the mechanical stop",
        ),
        ("HFS-SLS-005", "SLS-SOM_2-X", "tool centre point"),
        ("HFS-SLS-009", "SLS-SOM_3-S", "\"limit\":\"5 rev\""),
        ("HFS-SOS-007", "SOS-SPEED-X", "its torque is not off"),
        (
            "HFS-SS1-012",
            "EMERGENCY-STOP-X",
            "no inverter fault while all axes brake together",
        ),
        ("HFS-STOP-005", "STOP-NC", "the screen shows the cause"),
        (
            "HFS-TEST-027",
            "SELF-TEST-INTERVAL",
            "before the interval is over",
        ),
        ("HFS-TEST-028", "SELF-TEST-INTERVAL", "8 h or a shift"),
        (
            "HFS-TEST-029",
            "SELF-TEST",
            "RELAY EXTERNAL DC VOLTAGE MISSING",
        ),
        (
            "HFS-USTART-005",
            "UNEXPECTED-START-NC",
            "belong to one group",
        ),
    ] {
        let test = test(&json, id);
        let named = test["requirements"].as_array().expect("requirements");
        assert!(
            named.iter().any(|r| r == requirement),
            "{id}: {requirement}"
        );
        assert!(test.to_string().contains(asks), "{id}: {asks}");
    }
}
