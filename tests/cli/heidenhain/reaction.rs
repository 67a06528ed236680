//! Reaction chains: summands, totals of the manual, ways.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use serde_json::Value;

use super::{MACHINE, changed, json};
use crate::common::{stderr, stdout, stillpoint};

fn chain<'a>(json: &'a Value, axis: &str, name: &str) -> &'a Value {
    let list = json["chains"].as_array().expect("chains");
    let found = list.iter().find(|c| c["axis"] == axis && c["name"] == name);
    found.unwrap_or_else(|| panic!("no chain {name} of {axis}"))
}

fn steps(chain: &Value) -> &[Value] {
    chain["steps"].as_array().expect("steps")
}

/// All chains of the machine, explored once.
fn all_chains() -> &'static Value {
    static CHAINS: OnceLock<Value> = OnceLock::new();
    CHAINS.get_or_init(|| json(&["reaction", MACHINE]))
}

const CHAINS: &str = "spec/families/heidenhain-fs/reaction-chain.toml";

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
/// SMP525 of 420 ms (HFS-TIMING-005/a/c, HFS-TIMING-006/b/e, HFS-TIMING-007, HFS-TIMING-008, HFS-TIMING-010, HFS-SPLC-003,
/// and the transfers on the HSCI line, HFS-ARCH-008).
#[test]
fn the_summands_give_the_totals_of_the_manual() {
    let machine = changed(
        "hfs-reaction-totals",
        &[
            (MACHINE, "SMP525  = \"600 ms\"", "SMP525  = \"420 ms\""),
            (MACHINE, "MP7602   = \"21 ms\"", "MP7602   = \"30 ms\""),
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
            "time     = \"MAX(ss2_time / monitoring_cycle, 1) * monitoring_cycle\"",
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
