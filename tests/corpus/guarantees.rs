//! What a machine file guarantees is decided by its values: each dangerous one, alone, breaks a guarantee of the milling machine.

use std::collections::BTreeMap;

use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::{self as machine, Machine, families};
use stillpoint_model::Verdict;
use stillpoint_tests::root;

/// The milling machine with one text of its file replaced.
fn changed(from: &str, to: &str) -> Machine {
    let path = root().join("spec/machines/milling-840d.toml");
    let text = std::fs::read_to_string(&path).expect("the machine");
    assert!(text.contains(from), "{from}");
    let text = text.replacen(from, to, 1);
    machine::load_bytes(&path, text.into_bytes(), &families(&path))
        .unwrap_or_else(|e| panic!("{to}: {e}"))
}

/// The verdict on these guarantees, and the tightest bound in milliseconds over the axes.
fn guaranteed(machine: Machine, names: &[&str]) -> BTreeMap<String, (Verdict, Option<u64>)> {
    let runs: Vec<_> = machine
        .runs
        .iter()
        .filter(|r| r.guarantee.as_deref().is_some_and(|g| names.contains(&g)))
        .cloned()
        .collect();
    let path = root().join("spec/machines/milling-840d.toml");
    let subject =
        subject::of_runs(&path, machine, &runs, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let checked = check(&subject, &Settings::default(), &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    let list = answers(&subject, &checked).into_iter().map(|answer| {
        let bound = answer.runs.iter().filter_map(|run| run.bound).max();
        (
            answer.guarantee.name.clone(),
            (answer.verdict, bound.map(|us| us / 1000)),
        )
    });
    list.collect()
}

#[test]
fn guarantees_of_the_milling_machine_hold_with_their_bounds() {
    let names = ["table", "tool", "emergency_stop", "emergency_stop_tool"];
    let found = guaranteed(changed("", ""), &names);
    // The signal, the change-over to SG1, STOP C, STOP B. What the monitors may take on top is at most three cycles each; the
    // contact opens at any moment of a cycle.
    for (name, times) in [
        ("table", &[50, 200, 300, 300][..]),
        ("tool", &[50, 1500, 2000, 2000]),
        ("emergency_stop", &[20, 300, 300]),
        ("emergency_stop_tool", &[20, 2000, 2000]),
    ] {
        let (verdict, bound) = found[name];
        assert_eq!(verdict, Verdict::Holds, "{name}");
        let least: u64 = times.iter().map(|ms: &u64| ms.div_ceil(12)).sum();
        let cycles = bound.expect("a bound") / 12;
        assert!(
            (least..=least + 8).contains(&cycles),
            "{name}: {cycles}, at least {least}"
        );
    }
}

#[test]
fn every_dangerous_value_breaks_a_guarantee() {
    let dangerous = [
        (
            "the door selects the fastest stage",
            "open          = \"SG1\"",
            "open = \"SG4\"",
            "table",
        ),
        (
            "SG1 is not slow",
            "[\"2000 mm/min\", \"5000",
            "[\"4000 mm/min\", \"5000",
            "table",
        ),
        (
            "a window of 100 mm",
            "STANDSTILL_TOL      = \"0.5 mm\"",
            "STANDSTILL_TOL = \"100 mm\"",
            "table",
        ),
        (
            "a change-over of a minute",
            "VELO_SWITCH_DELAY   = \"200 ms\"",
            "VELO_SWITCH_DELAY = \"60 s\"",
            "table",
        ),
        (
            "STOP C waits for ten seconds",
            "STOP_SWITCH_TIME_C  = \"300 ms\"",
            "STOP_SWITCH_TIME_C = \"10 s\"",
            "table",
        ),
        (
            "STOP B waits for two seconds",
            "PULSE_DISABLE_DELAY = \"300 ms\"",
            "PULSE_DISABLE_DELAY = \"2 s\"",
            "table",
        ),
        (
            "no external stops for the spindle",
            "functions = [\"SBH/SG\", \"external stops\"]",
            "functions = [\"SBH/SG\"]",
            "emergency_stop_tool",
        ),
        (
            "the first stage of the spindle is fast",
            "[\"50 rev/min\", \"800 rev/min\"",
            "[\"600 rev/min\", \"800 rev/min\"",
            "tool",
        ),
        (
            "the spindle may turn where it is held",
            "STANDSTILL_TOL      = \"2 deg\"",
            "STANDSTILL_TOL = \"90 deg\"",
            "tool",
        ),
        (
            "no external stops",
            "functions = [\"SBH/SG\", \"SE\", \"external stops\", \"STOP E\"]",
            "functions = [\"SBH/SG\", \"SE\"]",
            "emergency_stop",
        ),
        (
            "a promise that is too short",
            "within  = \"1 s\"",
            "within = \"900 ms\"",
            "table",
        ),
        (
            "a signal that takes its time",
            "signal  = \"50 ms\"",
            "signal = \"500 ms\"",
            "table",
        ),
    ];
    for (what, from, to, name) in dangerous {
        let found = guaranteed(changed(from, to), &[name]);
        assert_eq!(found[name].0, Verdict::Violated, "{what}");
    }
}
