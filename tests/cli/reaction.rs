//! `stillpoint reaction`: chains, what proves them, over-travel, and bad input.

use std::path::Path;

use serde_json::Value;

use crate::common::{copied, stdout, stillpoint};

const MILLING: &str = "spec/machines/milling-840d.toml";

fn chains(arguments: &[&str]) -> Value {
    let mut all = vec!["reaction", MILLING, "--json"];
    all.extend(arguments);
    let output = stillpoint(&all);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

fn chain<'a>(json: &'a Value, axis: &str, name: &str) -> &'a Value {
    let list = json["chains"].as_array().expect("chains");
    let found = list.iter().find(|c| c["axis"] == axis && c["name"] == name);
    found.unwrap_or_else(|| panic!("no chain {name} of {axis}"))
}

#[test]
fn every_enabled_function_has_a_chain() {
    let json = chains(&[]);
    for axis in ["X", "Y", "Z"] {
        for name in [
            "SBH",
            "SG1",
            "SG2",
            "SG3",
            "SG4",
            "SE",
            "SBR",
            "comparison",
            "door front",
            "external STOP A",
            "external STOP C",
            "external STOP D",
            "external STOP E",
        ] {
            chain(&json, axis, name);
        }
    }
    let names = json["chains"].as_array().expect("chains").iter();
    let spindle: Vec<&str> = names
        .filter(|c| c["axis"] == "S")
        .filter_map(|c| c["name"].as_str())
        .collect();
    assert!(
        !spindle.contains(&"SE") && !spindle.contains(&"external STOP E"),
        "{spindle:?}"
    );
}

#[test]
fn figures_of_a_speed_limit() {
    // SG1 of X: 2000 mm/min, STOP C, t_C 300 ms, t_B 300 ms, cycle 12 ms, STOP_VELO_TOL 300 mm/min, window 0.5 mm.
    let json = chains(&["--axis", "X"]);
    let sg = chain(&json, "X", "SG1");
    let steps = sg["steps"].as_array().expect("steps");
    let times: Vec<i64> = steps.iter().filter_map(|s| s["time_us"].as_i64()).collect();
    let expected = [
        18_000, 6_000, 12_000, 18_000, 0, 300_000, 12_000, 300_000, 24_000, 100_000,
    ];
    assert_eq!(times, expected);
    let ends = sg["outcomes"].as_array().expect("outcomes");
    assert_eq!(ends[0]["time_us"], 354_000);
    // 54 ms at 2000 mm/min are 1.8 mm, half of 300 ms 5 mm.
    assert_eq!(ends[0]["over_travel"], "6.8 mm");
    assert_eq!(ends[0]["rest_to_be_measured"], false);
    assert_eq!(ends[1]["time_us"], 790_000);
    // 1.8 mm + 312 ms at 2300 mm/min + 0.5 mm + 424 ms at 2600 mm/min.
    assert_eq!(ends[1]["over_travel"], "32.634 mm");
    assert_eq!(ends[1]["rest_to_be_measured"], true);
}

#[test]
fn proven_is_what_was_explored_with_the_times_of_the_axis() {
    let json = chains(&["--axis", "X", "--axis", "S"]);
    for (axis, stop_c) in [("X", 300_000), ("S", 2_004_000)] {
        let sg = chain(&json, axis, "SG1");
        let steps = sg["steps"].as_array().expect("steps");
        let of = |id: &str| {
            let found = steps.iter().find(|s| s["property"]["id"] == id);
            found.unwrap_or_else(|| panic!("{id} bounds no summand of {axis}"))
        };
        assert_eq!(of("S840D-STOP-031-TIME")["basis"], "proven");
        assert_eq!(of("S840D-STOP-031-TIME")["property"]["slowest_us"], stop_c);
        assert_eq!(of("S840D-ARCH-510-TIME")["basis"], "proven");
        // What no property bounds is not called proven.
        let reading = steps
            .iter()
            .find(|s| s["text"].as_str().is_some_and(|t| t.contains("A-01")));
        assert_eq!(reading.expect("the second reading")["basis"], "manual");
    }
    let explored = json["explored"].as_array().expect("explored");
    assert!(
        explored
            .iter()
            .all(|e| e["complete"] == true && e["states"].as_u64() > Some(1))
    );
    // Nothing falls back to a claim without exploration.
    let steps = json["chains"].as_array().expect("chains").iter();
    let notes = steps.flat_map(|c| c["steps"].as_array().expect("steps"));
    for step in notes.filter(|s| !s["property"].is_null()) {
        assert_eq!(step["basis"], "proven", "{step}");
    }
}

/// A copy of the milling machine and of its family in which a text of the chains is replaced.
fn changed(name: &str, from: &str, to: &str) -> String {
    let replace = [("spec/families/sinumerik-840d/reaction-chain.toml", from, to)];
    copied(name, MILLING, "spec/families/sinumerik-840d", &replace)
}

#[test]
fn a_summand_shorter_than_the_explored_bound_is_refuted() {
    let machine = changed(
        "reaction-refuted",
        "time     = \"CYCLES(STOP_SWITCH_TIME_C) * monitoring_cycle\"",
        "time     = \"(CYCLES(STOP_SWITCH_TIME_C) - 1) * monitoring_cycle\"",
    );
    let output = stillpoint(&["reaction", &machine]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let text = stdout(&output);
    assert!(text.contains("refuted"), "{text}");
    assert!(text.contains("its slowest case takes 300 ms"), "{text}");
}

#[test]
fn a_fault_of_the_data_names_its_place() {
    let machine = changed(
        "reaction-unknown",
        "length = \"STANDSTILL_TOL\"",
        "length = \"STANDSTIL_TOL\"",
    );
    let output = stillpoint(&["reaction", &machine]);
    assert_eq!(output.status.code(), Some(2));
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(
        text.contains("STANDSTIL_TOL") && text.contains("did you mean"),
        "{text}"
    );
}

#[test]
fn speed_and_acceleration_by_wish() {
    let json = chains(&[
        "--speed",
        "X=10000 mm/min",
        "--speed",
        "100 rev/min",
        "--acceleration",
        "2 m/s2",
    ]);
    assert_eq!(chain(&json, "X", "SG1")["speed"], "10000 mm/min");
    assert_eq!(chain(&json, "X", "SG1")["acceleration"], "2000 mm/s2");
    assert_eq!(chain(&json, "Y", "SG1")["speed"], "2000 mm/min");
    assert_eq!(chain(&json, "S", "SG1")["speed"], "100 rev/min");
    assert_eq!(chain(&json, "S", "SG1")["acceleration"], "0 deg/s2");
}

#[test]
fn wrong_wishes_are_refused() {
    for (arguments, says) in [
        (["--speed", "fast"], "--speed: 'fast' is no speed"),
        (["--speed", "Q=1 mm/min"], "there is no axis 'Q'"),
        (["--speed", "S=100 mm/min"], "of axis S"),
        (["--speed", "-5 mm/min"], "not negative"),
        (
            ["--acceleration", "X=1 mm/s"],
            "is no acceleration of axis X",
        ),
        (["--axis", "W"], "there is no axis 'W'"),
    ] {
        let option = format!("{}={}", arguments[0], arguments[1]);
        let output = stillpoint(&["reaction", MILLING, &option]);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(text.contains(says), "{arguments:?}: {text}");
    }
}

#[test]
fn the_page_is_the_same_each_time_and_says_what_is_measured() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let write = |name: &str, threads: &str| {
        let path = folder.join(name);
        let shown = path.display().to_string();
        let output = stillpoint(&["reaction", MILLING, "--html", &shown, "--threads", threads]);
        assert_eq!(output.status.code(), Some(0));
        std::fs::read_to_string(&path).expect("the page")
    };
    let page = write("reaction-1.html", "1");
    assert_eq!(page, write("reaction-2.html", "2"));
    for text in [
        "S840D-STOP-031-TIME",
        "5.5.2 Table 5-24",
        "to be measured",
        "CYCLES(STOP_SWITCH_TIME_C)",
    ] {
        assert!(page.contains(text), "no {text}");
    }
    let markdown = stdout(&stillpoint(&["reaction", MILLING, "--markdown"]));
    assert!(
        markdown.starts_with("# Reaction times of milling-840d"),
        "{markdown}"
    );
}
