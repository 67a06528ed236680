//! The protocol of the acceptance test: chapter 7 and A.3 of the manual.

use serde_json::Value;

use crate::acceptance::{ids, test};
use crate::common::{copied, messages, status, stderr, stdout, stillpoint};

const GANTRY: &str = "spec/machines/gantry-s120.toml";
const FAMILY: &str = "spec/families/sinamics-s120";
const CATALOGUE: &str = "spec/families/sinamics-s120/acceptance.toml";

fn json(machine: &str, more: &[&str]) -> Value {
    let arguments = [&["acceptance", machine, "--json"], more].concat();
    let output = stillpoint(&arguments);
    assert_eq!(status(&output), 0, "{arguments:?}: {}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// The gantry with something replaced, and a copy of its family.
fn gantry(name: &str, replace: &[(&str, &str)]) -> String {
    let replace: Vec<_> = replace.iter().map(|(a, b)| (GANTRY, *a, *b)).collect();
    copied(name, GANTRY, FAMILY, &replace)
}

/// Signal, value and latest time in microseconds of what is expected, as far as it is a signal with a time.
fn trace(test: &Value) -> Vec<(&str, &str, i64)> {
    let expect = test["expect"].as_array().expect("expect").iter();
    expect
        .filter_map(|e| {
            let signal = e["signal"].as_str()?;
            Some((signal, e["value"].as_str()?, e["latest_us"].as_i64()?))
        })
        .collect()
}

/// The five axes with Extended Functions have the tests of A.3.3.2, the sixth those of A.3.3.1, each what it has enabled.
#[test]
fn each_axis_has_the_tests_of_its_functions() {
    let ids = ids(&json(GANTRY, &[]));
    let all = "SCOPE DOCUMENTATION CONDITIONS CONCLUSION SBC-BASIC-Z SBC-Z SBT1-Z SDI+-X1 SDI--X1 SDI+-X2 SDI--X2 SLP1+-Y SLP1--Y \
               SLP2+-Y SLP2--Y SLP-RETRACTION-Y REFERENCE-Y SS1-BASIC-C TERMINALS-C TEST-STOP-BASIC-C RUN-C DOOR-service-C DOOR-front-X1";
    for id in all.split_whitespace() {
        assert!(ids.contains(id), "{id}");
    }
    for axis in ["X1", "X2", "Y", "Z", "B"] {
        let extended = "STO SS1 SS2 SOS SLS1 SLS2 SLS3 SLS4 SLS-SETPOINT SSM ACCEPTANCE-MODE COMMUNICATION ACKNOWLEDGEMENT TEST-STOP RUN \
                        ENCODER ENABLING-front";
        for id in extended.split_whitespace() {
            assert!(ids.contains(&format!("{id}-{axis}")), "{id}-{axis}");
        }
    }
    // The second brake of Z is none, B has no terminals, C no Extended Functions; with p9652 the terminals select SS1 only.
    let none = "SBT2-Z SBT1-Y SDI+-Y SLP1+-X1 REFERENCE-X1 SS1-BASIC-B TERMINALS-B STO-C SOS-C SLS1-C ENCODER-C STO-BASIC-X1 STO-BASIC-C \
                SS2E-X1 SLS-TELEGRAM-X1 SP-Y GEAR-Y INPUTS TEST-STOP-TM54F TEST-STOP-CU310-2 SLS1-NO-ENCODER-X1 SDI-PULSES-X1 ENABLING-service-Z";
    for id in none.split_whitespace() {
        assert!(!ids.contains(id), "{id}");
    }
}

/// Limits, and times that follow from the parameters of the axis: three cycles of 12 ms are what the manual tolerates in a trace.
#[test]
fn values_and_times_are_those_of_the_machine() {
    let json = json(GANTRY, &[]);
    let sls = test(&json, "SLS3-X2");
    assert_eq!(
        sls["title"],
        "SLS of X2, level 3, over PROFIsafe: 20000 mm/min, STOP C"
    );
    assert!(sls.to_string().contains("C01714 (300) and C30714 (300)"));
    let c = [
        ("r9722.7", "FALSE", 36_000),
        ("r9722.2", "TRUE", 36_000),
        ("r9722.3", "TRUE", 636_000),
    ];
    assert_eq!(trace(sls), c);
    assert_eq!(sls["measure"][0]["limit"], "20000 mm/min");
    assert_eq!(sls["depends"]["p9531[2]"], "20000 mm/min");
    assert!(sls["depends"]["p9531[1]"].is_null());
    let b = [
        ("r9722.7", "FALSE", 36_000),
        ("r9722.1", "TRUE", 36_000),
        ("r9722.0", "TRUE", 636_000),
    ];
    assert_eq!(trace(test(&json, "SLS4-X2")), b);
    assert_eq!(
        test(&json, "SLS1-B")["title"],
        "SLS of B, level 1, over PROFIsafe: 5 rev/min, STOP C"
    );
    assert_eq!(
        trace(test(&json, "SS2-Z")),
        [("r9722.2", "TRUE", 36_000), ("r9722.3", "TRUE", 336_000)]
    );
    assert_eq!(
        trace(test(&json, "SS1-BASIC-C")),
        [("r9773.6", "TRUE", 36_000), ("r9773.1", "TRUE", 336_000)]
    );
    // p9650 + p9658 of the terminals.
    assert_eq!(trace(test(&json, "TERMINALS-Y"))[1].2, 436_000);
    let upper = test(&json, "SLP2+-Y");
    assert_eq!(
        upper["title"],
        "SLP of Y, range 2, upper limit, over PROFIsafe: 1500 mm, STOP C"
    );
    assert!(
        upper
            .to_string()
            .contains("C01715 (20) and C30715 (20), r9722.30 = 0")
            && upper.to_string().contains("p9575 = 172")
    );
    assert!(
        test(&json, "SLP1--Y")
            .to_string()
            .contains("C01715 (10) and C30715 (10), r9722.31 = 0")
    );
    // The trace of the brake test: twice the ramp and the longer one of both sequences.
    let brake = test(&json, "SBT1-Z").to_string();
    assert!(brake.contains("lasts 3 s for sequence 1, 2.5 s for sequence 2"));
    // The contact, F-CPU and bus, Table 8-4, p9551.
    assert_eq!(trace(test(&json, "DOOR-front-X1"))[0].2, 506_000);
}

/// The mode ends by itself after p9558; each test that needs it says so.
#[test]
fn the_acceptance_test_mode_is_limited_in_time() {
    let machine = gantry(
        "s120-acceptance-mode",
        &[("p9507_0 = false", "p9507_0 = false\np9558 = \"25 s\"")],
    );
    let json = json(&machine, &[]);
    let mode = test(&json, "ACCEPTANCE-MODE-X1");
    assert_eq!(
        trace(mode),
        [
            ("S_ZSW3B.15", "TRUE", 36_000),
            ("S_ZSW3B.15", "FALSE", 25_036_000)
        ]
    );
    // p9551 of 300 ms, p9552 and p9556 of 600 ms.
    assert!(mode["measure"][0].to_string().contains("alone take 1.5 s"));
    for id in ["SOS-X1", "SLS1-X1", "SDI+-X1"] {
        let test = test(&json, id);
        assert_eq!(test["depends"]["p9558"], "25 s", "{id}");
        assert!(
            test.to_string().contains("ends by itself after 25 s"),
            "{id}"
        );
    }
    // It has no effect on STO, SS1 and SSM.
    for id in ["STO-X1", "SS1-X1", "SSM-X1"] {
        assert!(test(&json, id)["depends"]["p9558"].is_null(), "{id}");
    }
    assert_eq!(test(&json, "SOS-Y")["depends"]["p9558"], "40 s");
}

/// Each stop of the manual has its bits and its time, and what has an external stop or no encoder its own test.
#[test]
fn the_configuration_decides_what_is_seen() {
    let stops = "p9563  = [\"STOP C\", \"STOP C\", \"STOP C\", \"STOP B\"]";
    let other = "p9563  = [\"STOP A\", \"STOP D\", \"STOP E\", \"STOP B delayed\"]\np9553 = \"700 ms\"\np9554 = \"800 ms\"\np9507_3 = true";
    let blind = "p9531  = [\"5 rev/min\", \"10 rev/min\", \"20 rev/min\", \"40 rev/min\"]";
    let no_encoder = format!(
        "p9506 = \"no encoder, SBR\"\np9511 = \"125 us\"\np9509_8 = true\np9582 = \"20 ms\"\np9563 = [\"STOP A\", \"STOP B\", \"STOP B\", \"STOP B\"]\n{blind}"
    );
    let last = "[\"motion monitoring\"]";
    let machine = gantry(
        "s120-acceptance-stops",
        &[
            (stops, other),
            // Without encoder there is no SOS.
            (
                "STW_SOS = \"head_sos\"\nSTW_SLS = \"head_sls\"\nSTW_SS1 = \"head_ss1\"\nSTW_ACK = \"event_ack\"\np9601  = \"C\"",
                "STW_SLS = \"head_sls\"\nSTW_SS1 = \"head_ss1\"\nSTW_ACK = \"event_ack\"\np9601  = \"C\"",
            ),
            (blind, &no_encoder),
            (last, "[\"motion monitoring\", \"SDI\"]"),
            // Without encoder there is neither SOS nor SS2 behind the door.
            (
                "axes     = [\"X1\", \"X2\", \"Y\", \"Z\", \"B\"]",
                "axes     = [\"X1\", \"X2\", \"Y\", \"Z\"]",
            ),
            ("axes    = [\"B\"]", "axes    = [\"Y\"]"),
            ("axes    = [\"B\"]\nwithin", "axes    = [\"Y\"]\nwithin"),
            ("axes    = [\"B\"]\nbutton", "axes    = [\"Y\"]\nbutton"),
            ("speed   = \"5 rev/min\"", "speed   = \"5000 mm/min\""),
        ],
    );
    let json = json(&machine, &[]);
    let seen = |id: &str| trace(test(&json, id))[1..].to_vec();
    assert_eq!(seen("SLS1-X1"), [("r9722.0", "TRUE", 36_000)]);
    assert_eq!(
        seen("SLS2-X1"),
        [("r9721.14", "TRUE", 36_000), ("r9722.3", "TRUE", 736_000)]
    );
    assert_eq!(
        seen("SLS3-X1"),
        [("r9721.15", "TRUE", 36_000), ("r9722.3", "TRUE", 836_000)]
    );
    assert_eq!(
        seen("SLS4-X1"),
        [("r9722.1", "TRUE", 36_000), ("r9722.0", "TRUE", 636_000)]
    );
    let external = test(&json, "SS1-X1").to_string();
    assert!(external.contains("does not brake by itself") && !external.contains("OFF3"));
    let ids = ids(&json);
    assert!(ids.contains("SLS2-NO-ENCODER-B") && ids.contains("SDI-PULSES-B"));
    for id in ["SLS2-B", "SOS-B", "SS2-B"] {
        assert!(!ids.contains(id), "{id}");
    }
    assert!(
        test(&json, "SLS2-NO-ENCODER-B")
            .to_string()
            .contains("within 5 s")
    );
    // p9582 counts as two cycles at least (S120-SBR-003), and SS1 has no timer then.
    let ramp = test(&json, "SS1-B").to_string();
    assert!(ramp.contains("from 24 ms on r9714[1] falls") && ramp.contains("there is no timer"));
    assert!(
        test(&json, "SDI-PULSES-B")
            .to_string()
            .contains("SDI is inactive")
    );
    assert!(test(&json, "ENCODER-B").to_string().contains("r0313"));
}

/// Inputs of a TM54F: their tests, and the longest time of its test stop.
#[test]
fn inputs_have_tests_of_their_own() {
    let machine = "family = \"sinamics-s120\"\n[control]\ninputs = \"TM54F\"\np10017 = \"25 ms\"\np10001 = \"30 ms\"\n\
                   [axis.X]\nkind = \"linear\"\nfunctions = [\"motion monitoring\"]\np9601 = \"4\"\np10011 = 2\np9507_0 = true\n";
    let folder = crate::common::Folder::new("s120-acceptance-inputs");
    let file = folder.write("tm54f.toml", machine);
    let json = json(&file, &[]);
    let ids = ids(&json);
    for id in ["INPUTS", "DRIVE-GROUP-X", "TEST-STOP-TM54F"] {
        assert!(ids.contains(id), "{id}");
    }
    assert!(!ids.contains("COMMUNICATION-X") && !ids.contains("FDI-TRANSFER-X"));
    assert_eq!(test(&json, "STO-X")["title"], "STO of X, over the F-DIs");
    // 3 * 12 ms + 3 * max(20, 12, 25) ms + 8 * 12 ms + 6 * max(30, 12, 25) ms (S120-TESTSTOP-510), and three cycles.
    let stop = test(&json, "TEST-STOP-TM54F");
    assert_eq!(trace(stop), [("A35012", "FALSE", 387_000 + 36_000)]);
    let permitted = machine.replace("TM54F", "CU310-2").replace(
        "p10011 = 2\n",
        "p60022 = \"31\"\np9611 = \"31\"\np9610 = 1\np9810 = 1\n",
    );
    let file = folder.write("cu310.toml", &permitted.replace("\"4\"", "\"C\""));
    let json = self::json(&file, &[]);
    assert!(self::ids(&json).contains("FDI-TRANSFER-X"));
    // 8 * 12 ms + 6 * 30 ms (S120-TESTSTOP-502), and three cycles.
    assert_eq!(
        trace(test(&json, "TEST-STOP-CU310-2")),
        [("A01772", "FALSE", 276_000 + 36_000)]
    );
}

/// A single parameter that was changed: the tests of its function (Table A-1).
#[test]
fn a_changed_parameter_repeats_its_tests() {
    let stop = gantry(
        "s120-acceptance-since",
        &[("\"20000 mm/min\", \"60000", "\"21000 mm/min\", \"60000")],
    );
    let json = json(&stop, &["--since", GANTRY]);
    let change = &json["since"]["changes"];
    assert_eq!(change.as_array().expect("changes").len(), 1);
    assert_eq!(change[0]["name"], "p9531[2]");
    assert_eq!(ids(&json).into_iter().collect::<Vec<_>>(), ["SLS3-X1"]);
}

/// What a person has to document and to do, in the order of A.3.1.
#[test]
fn the_report_has_what_the_manual_wants_in_it() {
    let text = stdout(&stillpoint(&["acceptance", GANTRY]));
    let mut from = 0;
    for part in [
        "# Acceptance test of gantry-s120",
        "SHA-256",
        "r9590",
        "r9781",
        "</a>Before the tests",
        "</a>A) Documentation",
        "B) Safety functions: Basic Functions",
        "B) Safety functions: Extended Functions",
        "Plant: inputs, doors, communication",
        "C) Forced dormant error detection",
        "D) Actual value acquisition",
        "E) Conclusion",
        "password itself does not appear",
        "Commissioning engineer",
        "motor with DRIVE-CLiQ replaced",
        "other firmware version on SIMOTION D",
    ] {
        let found = text[from..].find(part);
        from += found.unwrap_or_else(|| panic!("no {part} in its place"));
    }
    assert!(!text.contains('{'), "a place was not filled in");
    let run = stillpoint(&["acceptance", GANTRY, "--run"]);
    assert_eq!(status(&run), 0);
    assert!(stdout(&run).contains("No test was simulated"));
}

#[test]
fn a_parameter_that_no_test_reads_is_a_fault_of_the_catalogue() {
    let replace = [(CATALOGUE, "depends  = [\"p10006_idle\"]", "depends  = []")];
    let machine = copied("s120-acceptance-unread", GANTRY, FAMILY, &replace);
    let output = stillpoint(&["acceptance", &machine]);
    assert_eq!(status(&output), 2);
    let said = messages(&output);
    assert!(
        said.contains("no acceptance test depends on p10006_idle"),
        "{said}"
    );
}

/// A result names its test, and a changed parameter the tests to be repeated: two of one name would be one.
#[test]
fn two_tests_of_one_name_are_a_fault_of_the_catalogue() {
    let replace = [(CATALOGUE, "\"ENCODER-FAULT-{axis}\"", "\"ENCODER-{axis}\"")];
    let machine = copied("s120-acceptance-twice", GANTRY, FAMILY, &replace);
    let output = stillpoint(&["acceptance", &machine]);
    assert_eq!(status(&output), 2);
    let said = messages(&output);
    assert!(
        said.contains("two acceptance tests of this machine are called ENCODER"),
        "{said}"
    );
}
