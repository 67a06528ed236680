//! What a machine file guarantees is decided by its values and its logic: each dangerous one, alone, breaks a guarantee.

use std::collections::BTreeMap;

use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::{self as machine, Machine, families};
use stillpoint_model::Verdict;
use stillpoint_tests::root;

const MILLING: &str = "spec/machines/milling-840d.toml";
const CENTRE: &str = "spec/machines/machining-centre-heidenhain.toml";

/// A machine with one text of its file replaced.
fn changed(file: &str, from: &str, to: &str) -> Machine {
    let path = root().join(file);
    let text = std::fs::read_to_string(&path).expect("the machine");
    assert!(text.contains(from), "{from}");
    let text = text.replacen(from, to, 1);
    machine::load_bytes(&path, text.into_bytes(), &families(&path))
        .unwrap_or_else(|e| panic!("{to}: {e}"))
}

/// The verdict on these guarantees, and the tightest bound in milliseconds over the axes.
fn guaranteed(
    file: &str,
    machine: Machine,
    names: &[&str],
) -> BTreeMap<String, (Verdict, Option<u64>)> {
    let runs: Vec<_> = machine
        .runs
        .iter()
        .filter(|r| r.guarantee.as_deref().is_some_and(|g| names.contains(&g)))
        .cloned()
        .collect();
    let path = root().join(file);
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
    let found = guaranteed(MILLING, changed(MILLING, "", ""), &names);
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
fn every_dangerous_value_of_the_milling_machine_breaks_a_guarantee() {
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
            "a change-over of a second",
            "VELO_SWITCH_DELAY   = \"200 ms\"",
            "VELO_SWITCH_DELAY = \"1 s\"",
            "table",
        ),
        (
            "STOP C waits for a second",
            "STOP_SWITCH_TIME_C  = \"300 ms\"",
            "STOP_SWITCH_TIME_C = \"1 s\"",
            "table",
        ),
        (
            "STOP B waits for a second",
            "PULSE_DISABLE_DELAY = \"300 ms\"",
            "PULSE_DISABLE_DELAY = \"1 s\"",
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
        let found = guaranteed(MILLING, changed(MILLING, from, to), &[name]);
        assert_eq!(found[name].0, Verdict::Violated, "{what}");
    }
}

/// The same mistakes with times that are far too long: timers of thousands of cycles, and no other way through the tables.
#[test]
#[ignore = "deep: minutes"]
fn very_long_times_break_a_guarantee_too() {
    for (file, from, to, name) in [
        (
            MILLING,
            "VELO_SWITCH_DELAY   = \"200 ms\"",
            "VELO_SWITCH_DELAY = \"60 s\"",
            "table",
        ),
        (
            MILLING,
            "STOP_SWITCH_TIME_C  = \"300 ms\"",
            "STOP_SWITCH_TIME_C = \"10 s\"",
            "table",
        ),
        (
            CENTRE,
            "SMP525  = \"600 ms\"",
            "SMP525 = \"10 s\"",
            "table_som_2",
        ),
        (
            CENTRE,
            "SMP526 = \"2.3 s\"",
            "SMP526 = \"9 s\"",
            "emergency_stop_tool",
        ),
    ] {
        let found = guaranteed(file, changed(file, from, to), &[name]);
        assert_eq!(found[name].0, Verdict::Violated, "{to}");
    }
}

#[test]
fn guarantees_of_the_machining_centre_hold_with_their_bounds() {
    let names = [
        "table_som_1",
        "table_som_2",
        "table_som_3",
        "tool_som_1",
        "tool_som_2",
        "magazine",
        "emergency_stop",
        "emergency_stop_tool",
        "no_start",
        "no_start_tool",
        "no_start_magazine",
    ];
    let found = guaranteed(CENTRE, changed(CENTRE, "", ""), &names);
    assert!(
        found
            .values()
            .all(|(verdict, _)| *verdict == Verdict::Holds)
    );
    // The signal, two cycles of the program, the SS1 of the slowest axis of the group.
    for (name, times) in [
        ("table_som_1", &[20, 42, 600][..]),
        ("table_som_2", &[20, 42, 600]),
        ("table_som_3", &[20, 42, 600]),
        ("tool_som_1", &[20, 42, 2300]),
        ("tool_som_2", &[20, 42, 2300]),
        ("magazine", &[20, 42, 800]),
        ("emergency_stop", &[20, 600]),
        ("emergency_stop_tool", &[20, 2300]),
    ] {
        let (verdict, bound) = found[name];
        assert_eq!(verdict, Verdict::Holds, "{name}");
        // What takes a monitor's cycle is at most two of them each, and the contact opens at any moment of a cycle.
        let least: u64 = times.iter().map(|ms: &u64| ms / 3).sum();
        let cycles = bound.expect("a bound") / 3;
        assert!(
            (least..=least + 6).contains(&cycles),
            "{name}: {cycles}, at least {least}"
        );
    }
}

#[test]
fn every_dangerous_value_of_the_machining_centre_breaks_a_guarantee() {
    let dangerous = [
        (
            "SOM_3 is fast",
            "SMP540  = \"3000 mm/min\"",
            "SMP540 = \"3200 mm/min\"",
            "table_som_3",
        ),
        (
            "a magazine that may be faster",
            "speed   = \"1890 deg/min\"",
            "speed = \"1800 deg/min\"",
            "magazine",
        ),
        (
            "the spindle turns fast in SOM_2",
            "SMP591   = \"50 rev/min\"",
            "SMP591 = \"500 rev/min\"",
            "tool_som_2",
        ),
        (
            "an axis that is held may go a long way",
            "SMP545  = \"1 mm\"",
            "SMP545 = \"30 mm\"",
            "table_som_1",
        ),
        (
            "an SS1 that brakes for a second",
            "SMP525  = \"600 ms\"",
            "SMP525 = \"1 s\"",
            "table_som_2",
        ),
        (
            "another axis of the group that brakes for long",
            "SMP525  = \"450 ms\"",
            "SMP525 = \"1 s\"",
            "emergency_stop",
        ),
        (
            "a spindle that brakes for long",
            "SMP526 = \"2.3 s\"",
            "SMP526 = \"3 s\"",
            "emergency_stop_tool",
        ),
        (
            "a signal that takes its time",
            "signal  = \"20 ms\"",
            "signal = \"300 ms\"",
            "table_som_1",
        ),
        (
            "a program that forgets the door in SOM_2",
            "request_a  = \"SEL(door_open, AUTO, limited(som))\"",
            "request_a = \"SEL(door_open AND som <> SOM_2, AUTO, limited(som))\"",
            "table_som_2",
        ),
        (
            "a program that permits motion in SOM_1",
            "request_a  = \"SEL(door_open, AUTO, limited(som))\"",
            "request_a = \"SEL(door_open, AUTO, SEL(som = SOM_1, limited(som), SLS_2))\"",
            "table_som_1",
        ),
        (
            "a program that asks for nothing of the spindle",
            "SEL(door_open, AUTO, SEL(restricted AND som <> SOM_1, limited(som), SLS_S))",
            "SEL(door_open, AUTO, SEL(restricted, limited(som), SLS_S))",
            "tool_som_1",
        ),
        (
            "a key that is held starts when the door closes",
            "keyed_a := any_a; keyed_s := any_s; starts := TRUE; spins := TRUE;",
            "keyed_a := FALSE; keyed_s := any_s; starts := TRUE; spins := TRUE;",
            "no_start",
        ),
        (
            "an open door behind which the spindle needs no permissive",
            "som <> SOM_1 AND NOT t_open AND gen_safe AND pb AND (jog OR turned)",
            "som <> SOM_1 AND NOT t_open AND gen_safe AND (jog OR turned)",
            "no_start_tool",
        ),
        (
            "a magazine that needs no confirmation",
            "SEL(t_open, confirmed OR T_ACT_CONST, pb_magazine AND one_key AND gen_safe)",
            "SEL(t_open, TRUE, pb_magazine AND one_key AND gen_safe)",
            "no_start_magazine",
        ),
        (
            "a magazine whose door is not looked at",
            "request_t  = \"SEL(t_open, AUTO, SLS_2)\"",
            "request_t = \"SEL(t_open AND NOT door_open, AUTO, SLS_2)\"",
            "magazine",
        ),
    ];
    for (what, from, to, name) in dangerous {
        let found = guaranteed(CENTRE, changed(CENTRE, from, to), &[name]);
        assert_eq!(found[name].0, Verdict::Violated, "{what}");
    }
}
