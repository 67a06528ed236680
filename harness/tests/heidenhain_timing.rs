//! `stillpoint reaction` and `stillpoint acceptance` for a machine with HEIDENHAIN functional safety.

mod common;

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;

use serde_json::Value;

use common::{root, stderr, stdout, stillpoint};

const MACHINE: &str = "spec/machines/machining-centre-heidenhain.toml";

fn json(arguments: &[&str]) -> Value {
    let mut all = arguments.to_vec();
    all.push("--json");
    let output = stillpoint(&all);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{all:?}: {}",
        stderr(&output)
    );
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

fn chain<'a>(json: &'a Value, axis: &str, name: &str) -> &'a Value {
    let list = json["chains"].as_array().expect("chains");
    let found = list.iter().find(|c| c["axis"] == axis && c["name"] == name);
    found.unwrap_or_else(|| panic!("no chain {name} of {axis}"))
}

fn steps(chain: &Value) -> &[Value] {
    chain["steps"].as_array().expect("steps")
}

/// A copy of the family and of the machine in which texts of some files are replaced.
fn changed(name: &str, replace: &[(&str, &str, &str)]) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let family = folder.join("spec/heidenhain-fs");
    std::fs::create_dir_all(&family).expect("a folder");
    for entry in std::fs::read_dir(root().join("spec/heidenhain-fs")).expect("the family") {
        let path = entry.expect("an entry").path();
        std::fs::copy(&path, family.join(path.file_name().expect("a name"))).expect("copied");
    }
    std::fs::copy(root().join(MACHINE), folder.join("machine.toml")).expect("copied");
    for (file, from, to) in replace {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).expect("readable");
        assert!(text.contains(from), "{file} has no {from}");
        std::fs::write(&path, text.replacen(from, to, 1)).expect("written");
    }
    folder.join("machine.toml").display().to_string()
}

/// All chains of the machine, explored once.
fn all_chains() -> &'static Value {
    static CHAINS: OnceLock<Value> = OnceLock::new();
    CHAINS.get_or_init(|| json(&["reaction", MACHINE]))
}

const CHAINS: &str = "spec/heidenhain-fs/reaction-chain.toml";

#[test]
fn both_channels_and_every_function_have_chains() {
    let json = all_chains();
    let common = [
        "emergency stop, CC",
        "emergency stop, MC",
        "permissive",
        "safe PLC",
        "nominal and actual speed",
        "other CC",
        "comparison",
    ];
    let nc = [
        "door front, CC",
        "door front, MC",
        "SLS in SOM_2",
        "SLS in SOM_4",
    ];
    let moved = ["SOS, speed", "SOS, way", "dv/dt"];
    for name in common {
        for axis in ["X", "Y", "Z", "S", "M"] {
            chain(json, axis, name);
        }
    }
    for axis in ["X", "Z", "S"] {
        for name in nc {
            chain(json, axis, name);
        }
    }
    for axis in ["X", "Z", "M"] {
        for name in moved {
            chain(json, axis, name);
        }
    }
    chain(json, "Y", "SLP");
    chain(json, "M", "door magazine, CC");
    let names = |axis: &str| -> BTreeSet<&str> {
        let all = json["chains"].as_array().expect("chains").iter();
        all.filter(|c| c["axis"] == axis)
            .filter_map(|c| c["name"].as_str())
            .collect()
    };
    // The spindle has no end positions, the magazine no other mode and no other door.
    assert!(!names("S").contains("SLP") && !names("M").contains("SLP"));
    assert!(!names("M").contains("SLS in SOM_3") && !names("M").contains("door front, CC"));
}

#[test]
fn everything_that_names_a_property_is_proven() {
    let json = all_chains();
    let chains = json["chains"].as_array().expect("chains").iter();
    let claims: Vec<&Value> = chains
        .flat_map(steps)
        .filter(|s| !s["property"].is_null())
        .collect();
    assert!(claims.len() > 200, "{}", claims.len());
    for step in claims {
        assert_eq!(step["basis"], "proven", "{step}");
    }
    let explored = json["explored"].as_array().expect("explored");
    assert!(explored.iter().all(|e| e["complete"] == true));
}

/// The totals that 4.8.20 prints, from the summands that the manual gives: with 100 ms for braking, MP2308 of 200 ms and so
/// SMP525 of 420 ms (HFS-TIMING-005, HFS-TIMING-006, HFS-TIMING-007, HFS-TIMING-008, HFS-TIMING-010, HFS-SPLC-003,
/// and the transfers on the HSCI line, HFS-ARCH-008).
#[test]
fn the_summands_give_the_totals_of_the_manual() {
    let machine = changed(
        "hfs-reaction-totals",
        &[
            (
                "machine.toml",
                "SMP525  = \"600 ms\"",
                "SMP525  = \"420 ms\"",
            ),
            (
                "machine.toml",
                "MP7602   = \"21 ms\"",
                "MP7602   = \"30 ms\"",
            ),
        ],
    );
    let json = json(&["reaction", &machine, "--axis", "X"]);
    let stages = ["Sensor and logic", "Detection and request"];
    let sum = |name: &str, wanted: &dyn Fn(&Value) -> bool| -> i64 {
        let list = steps(chain(&json, "X", name)).iter();
        list.filter(|s| wanted(s))
            .filter_map(|s| s["time_us"].as_i64())
            .sum()
    };
    let begin = |name: &str| sum(name, &|s| stages.iter().any(|t| s["stage"] == *t));
    assert_eq!(begin("emergency stop, MC"), 200 + 3_000);
    assert_eq!(begin("emergency stop, CC"), 600 + 6_000 + 3_000);
    assert_eq!(begin("door front, MC"), 22_000 + 6_000 + 2 * 30_000 + 3_000);
    assert_eq!(begin("door front, CC"), 22_000 + 6_000 + 21_000 + 3_000);
    assert_eq!(begin("safe PLC"), 22 * 3_000);
    assert_eq!(begin("other CC"), 4 * 3_000);
    assert_eq!(begin("SLP"), 2 * 3_000);
    // Without the cycle in which the kernel sees the standstill and without rounding to cycles: what the manual prints.
    let printed = |name: &str| {
        let exact = |s: &Value| {
            let text = s["text"].as_str().unwrap_or_default();
            s["stage"] != "The axis does not brake"
                && !text.contains("in its next cycle: -BRK")
                && !text.contains("whole cycles")
        };
        sum(name, &exact)
    };
    assert_eq!(printed("emergency stop, CC"), 9_600 + 100_000 + 200_000);
    assert_eq!(printed("door front, CC"), 52_000 + 100_000 + 200_000);
    // At the latest: the start of the SS1 and the timer.
    let last = |name: &str| {
        let outcomes = chain(&json, "X", name)["outcomes"]
            .as_array()
            .expect("outcomes");
        outcomes.last().expect("one")["time_us"]
            .as_i64()
            .expect("a time")
    };
    assert_eq!(last("emergency stop, MC"), 3_200 + 420_000);
    assert_eq!(last("emergency stop, CC"), 9_600 + 420_000);
    assert_eq!(last("door front, MC"), 91_000 + 420_000);
    assert_eq!(last("door front, CC"), 52_000 + 420_000);
}

/// Standstill at the emergency stop (HFS-TIMING-004): 9.6 ms at 5 m/min, then half of the way in the braking time of 280 ms.
#[test]
fn the_way_ends_where_the_axis_stands() {
    let json = json(&["reaction", MACHINE, "--axis", "X"]);
    let ends = chain(&json, "X", "emergency stop, CC")["outcomes"].clone();
    assert_eq!(ends[0]["time_us"], 9_600 + 280_000);
    // 0.05 mm + 0.5 mm + 0.25 mm, each rounded up to a micrometre, and 11.667 mm.
    assert_eq!(ends[0]["over_travel"], "12.467 mm");
    assert_eq!(ends[1]["over_travel"], ends[0]["over_travel"]);
    assert!(ends[1]["time_us"].as_i64() > ends[0]["time_us"].as_i64());
    assert_eq!(ends[2]["time_us"], 9_600 + 600_000);
    assert_eq!(ends[2]["rest_to_be_measured"], true);
}

/// Each summand of the ways of a signal is as long as what was explored; a shorter one is refuted.
#[test]
fn a_summand_that_is_too_short_is_refuted() {
    for (name, from, to) in [
        ("button", "time  = \"T#600us\"", "time  = \"T#400us\""),
        ("telegram", "time  = \"T#6ms\"", "time  = \"T#5ms\""),
        ("capture", "time  = \"T#22ms\"", "time  = \"T#21ms\""),
        ("splc-mc", "time  = \"2 * MP7602\"", "time  = \"MP7602\""),
        ("splc-cc", "time  = \"T#21ms\"", "time  = \"T#20ms\""),
        (
            "peer",
            "time     = \"4 * monitoring_cycle\"",
            "time     = \"3 * monitoring_cycle\"",
        ),
        (
            "brake",
            "time  = \"MP2308\"",
            "time  = \"MP2308 - monitoring_cycle\"",
        ),
        (
            "ss2",
            "time     = \"CYCLES(ss2_time) * monitoring_cycle\"",
            "time     = \"T#3ms\"",
        ),
    ] {
        let machine = changed(&format!("hfs-reaction-{name}"), &[(CHAINS, from, to)]);
        let output = stillpoint(&["reaction", &machine, "--axis", "X"]);
        assert_eq!(output.status.code(), Some(1), "{name}: {}", stderr(&output));
        let text = stdout(&output);
        let words: Vec<&str> = text.split_whitespace().collect();
        assert!(
            text.contains("refuted") && words.join(" ").contains("slowest case takes"),
            "{name}: {text}"
        );
    }
}

fn ids(json: &Value) -> BTreeSet<String> {
    let tests = json["tests"].as_array().expect("tests").iter();
    tests
        .map(|t| t["id"].as_str().expect("an id").to_owned())
        .collect()
}

/// Tests of the functions and limits, of the doors, permissives, keys, brakes, and of the control's own tests
/// (HFS-ACCEPT-001, HFS-ACCEPT-003, HFS-LIM-005).
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
        &[("machine.toml", "SMP560_0 = true", "SMP560_3 = true")],
    );
    let ids = ids(&json(&["acceptance", &machine]));
    assert!(ids.contains("MODE-SOM_4-LOCKED") && ids.contains("BRAKE-CONTROL-OFF"));
    assert!(
        !ids.contains("MODE-SOM_4")
            && !ids.contains("SLS-SOM_4-X")
            && !ids.contains("BRAKE-CONTROL")
    );
}

fn test<'a>(json: &'a Value, id: &str) -> &'a Value {
    let list = json["tests"].as_array().expect("tests");
    list.iter()
        .find(|t| t["id"] == id)
        .unwrap_or_else(|| panic!("no test {id}"))
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
        6_000 + 42_000 + 400_000
    );
    assert_eq!(
        permissive["depends"]["SMP527"],
        "X 400 ms, Y 400 ms, Z 300 ms"
    );
    assert_eq!(permissive["depends"]["axes"], "X, Y, Z");
    // None is simulated, and each says why.
    for test in json["tests"].as_array().expect("tests") {
        assert_eq!(test["simulated"], false);
        let why = test["not_simulated"].as_str().expect("a reason");
        assert!(why.contains("no scenario"), "{why}");
    }
}

/// Partial acceptance test: only what the changed parameter affects (HFS-ACCEPT-002).
#[test]
fn a_changed_parameter_repeats_its_tests() {
    let path = changed(
        "hfs-acceptance-since",
        &[
            (
                "machine.toml",
                "SMP527  = \"300 ms\"",
                "SMP527  = \"330 ms\"",
            ),
            ("machine.toml", "SMP610 = [\"NC\"]", "SMP610 = []"),
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
            "axis Z SMP527: 300 ms -> 330 ms",
            "group S SMP610: NC -> none"
        ]
    );
    let repeat: Vec<String> = ids(&json).into_iter().collect();
    assert_eq!(repeat, ["KEYS-NC", "PERMISSIVE-NC", "SS2-TIME-Z"]);
    assert_eq!(
        json["since"]["gone"],
        serde_json::json!(["STOP-SEQUENCE-S"])
    );
}

/// What belongs to a complete acceptance test beside the tests (HFS-ACCEPT-001, HFS-ACCEPT-003, HFS-ACCEPT-004,
/// HFS-ACCEPT-005).
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
        "Tests",
    ] {
        assert!(text.contains(part) || part == "Tests", "no {part}");
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
            "spec/heidenhain-fs/acceptance.toml",
            "SMP560_10 = ",
            "SMP560_11 = ",
        )],
    );
    let output = stillpoint(&["acceptance", &machine]);
    assert_eq!(output.status.code(), Some(2));
    let says = stderr(&output);
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
