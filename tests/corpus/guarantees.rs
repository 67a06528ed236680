//! What a machine file guarantees is decided by its values and its logic: each dangerous one, alone, breaks a guarantee.

use std::collections::BTreeMap;

use serde::Deserialize;
use stillpoint_engine::check::{Checked, Settings};
use stillpoint_engine::subject::Subject;
use stillpoint_harness::guarantees::answers;
use stillpoint_machine::{self as machine, Machine, families};
use stillpoint_model::Verdict;
use stillpoint_tests::guarantees::{decided, is_violated};
use stillpoint_tests::peer::each;
use stillpoint_tests::root;

use crate::machines;

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

/// The verdict on each guarantee, and the tightest bound in milliseconds over the axes.
fn verdicts(subject: &Subject, checked: &[Checked]) -> BTreeMap<String, (Verdict, Option<u64>)> {
    let list = answers(subject, checked).into_iter().map(|answer| {
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
    let found = verdicts(&machines::MILLING.0, &machines::MILLING.1);
    // The signal and the discrepancy of the contacts, the change-over to SG1, 4 cycles until SG asks for its stop, STOP C, 3 cycles until SBH does, STOP B, the shutdown path, two cycles of the PLC and one of the interpolator. What
    // takes a monitor's cycle is little more; the contact opens at any moment of a cycle.
    for (name, times) in [
        ("table", &[100, 200, 48, 300, 36, 300, 100, 116][..]),
        ("tool", &[100, 1500, 48, 2000, 36, 2000, 100, 116]),
        ("emergency_stop", &[40, 300, 36, 300, 100, 116]),
        ("emergency_stop_tool", &[40, 2000, 36, 2000, 100, 116]),
    ] {
        let (verdict, bound) = found[name];
        assert_eq!(verdict, Verdict::Holds, "{name}");
        let least: u64 = times.iter().map(|ms: &u64| ms.div_ceil(12)).sum();
        let cycles = bound.expect("a bound") / 12;
        assert!(
            (least..=least + 4).contains(&cycles),
            "{name}: {cycles}, at least {least}"
        );
    }
}

/// What `reaction` adds up for an axis, summand by summand, is never longer than the bound that `check` finds for it: both are made from
/// the manual by themselves.
fn no_reaction_is_longer((subject, checked): &(Subject, Vec<Checked>), expected: usize) {
    let machine = subject.machine.as_ref().expect("a machine");
    let reactions = machine.reactions().expect("its chains");
    let mut compared = 0;
    for answer in answers(subject, checked) {
        let begins = match (answer.guarantee.pattern.as_str(), &answer.guarantee.door) {
            ("door_speed", Some(door)) => format!("door {door}"),
            ("stop_request", _) => "external STOP C".to_owned(),
            ("emergency_stop", _) => "emergency stop".to_owned(),
            _ => continue,
        };
        for run in answer.runs.iter().filter(|run| run.bound.is_some()) {
            let bound = run.bound.map(i128::from).expect("a bound");
            let chains = reactions.chains.iter().filter(|chain| {
                run.task.axes.contains(&chain.axis) && chain.name.starts_with(&begins)
            });
            for chain in chains {
                let times = chain.steps.iter().filter_map(|step| step.time);
                let total: i128 = times.map(i128::from).sum();
                assert!(
                    total <= bound,
                    "{} of {}: {total} us, and {} promises {bound} us",
                    chain.name,
                    chain.axis,
                    answer.guarantee.name
                );
                compared += 1;
            }
        }
    }
    assert!(compared >= expected, "{compared}");
}

#[test]
fn no_reaction_of_the_milling_machine_is_longer_than_the_bound_of_a_guarantee() {
    no_reaction_is_longer(&machines::MILLING, 8);
}

/// Legal changes of a shipped machine, each of which breaks a guarantee.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Dangers {
    file: String,
    change: Vec<Change>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Change {
    text: String,
    replace: String,
    by: String,
    breaks: String,
}

/// A change of a shipped machine that is an error.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Refused {
    text: String,
    file: String,
    change: Vec<(String, String)>,
    says: String,
}

#[test]
fn what_cannot_be_promised_is_refused() {
    let path = root().join("tests/machines/refused.toml");
    let text = std::fs::read_to_string(path).expect("readable");
    let mut file: BTreeMap<String, Vec<Refused>> =
        toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
    for case in file.remove("refused").expect("cases") {
        let path = root().join(&case.file);
        let mut text = std::fs::read_to_string(&path).expect("the machine");
        for (from, to) in &case.change {
            assert!(text.contains(from), "{}: {from}", case.text);
            text = text.replacen(from, to, 1);
        }
        let loaded = machine::load_bytes(&path, text.into_bytes(), &families(&path));
        let errors = loaded.err().map(|e| e.to_string()).unwrap_or_default();
        let words: Vec<&str> = errors.split_whitespace().collect();
        assert!(
            words.join(" ").contains(&case.says),
            "{}: {errors}",
            case.text
        );
    }
}

/// Where the NCK stands still the half in the PLC has to do it.
#[test]
fn a_slow_plc_breaks_a_guarantee_that_is_to_hold_after_a_fault() {
    const LATHE: &str = "spec/machines/lathe-840d.toml";
    const CYCLE: &str = "PLC_CYCLE_MAX              = \"50 ms\"";
    let path = root().join(LATHE);
    let broken = |by: &str| is_violated(&path, &changed(LATHE, CYCLE, by), "slides");
    assert!(!broken("PLC_CYCLE_MAX = \"52 ms\""));
    assert!(broken("PLC_CYCLE_MAX = \"60 ms\""));
}

/// Without the drive bus an axis may go on for ESR before its pulses go off, whatever stop has begun.
#[test]
fn the_delay_of_a_dead_drive_bus_is_in_a_guarantee_that_is_to_hold_after_a_fault() {
    let path = root().join(MILLING);
    let broken = |delay: &str| {
        let by = format!("[control]\nSAFE_PULSE_DIS_TIME_BUSFAIL = \"{delay}\"");
        is_violated(&path, &changed(MILLING, "[control]", &by), "table")
    };
    assert!(!broken("120 ms"));
    assert!(broken("160 ms"));
}

/// Of two contacts the NCK may have the later one: without a fault the PLC has seen the first one meanwhile, one of its cycles late.
#[test]
fn the_discrepancy_of_two_contacts_counts_without_a_fault_too() {
    const REQUEST: &str = "within  = \"950 ms\"\nsignal  = \"20 ms\"\ncontacts = 2\ndiscrepancy = \"20 ms\"\nafter   = \"any single fault of a channel or contact\"\n";
    let path = root().join(MILLING);
    let broken = |discrepancy: &str| {
        let by = format!(
            "within = \"840 ms\"\nsignal = \"20 ms\"\ncontacts = 2\ndiscrepancy = \"{discrepancy}\"\n"
        );
        is_violated(&path, &changed(MILLING, REQUEST, &by), "emergency_stop")
    };
    assert!(!broken("0 ms"));
    assert!(broken("80 ms"));
}

/// Where one contact is all there is, the broken guarantee names the fault that breaks it, and no other run is broken.
#[test]
fn the_fault_that_breaks_a_guarantee_is_named() {
    for (file, from, to, name) in [
        (MILLING, "contacts      = 2 ", "contacts      = 1 ", "table"),
        (
            CENTRE,
            "contacts    = 2            #",
            "contacts    = 1            #",
            "table_som_1",
        ),
    ] {
        let machine = changed(file, from, to);
        let path = root().join(file);
        let (subject, checked) = decided(&path, machine, &[name], &Settings::default());
        let list = answers(&subject, &checked);
        let answer = list
            .iter()
            .find(|a| a.guarantee.name == name)
            .expect("asked");
        for run in &answer.runs {
            let stuck = run.task.faults.iter().any(|f| f.starts_with("a contact"));
            let expected = if stuck {
                Verdict::Violated
            } else {
                Verdict::Holds
            };
            assert_eq!(run.verdict, expected, "{name}: {}", run.task.title);
        }
        assert!(
            answer
                .runs
                .iter()
                .any(|run| run.verdict == Verdict::Violated)
        );
    }
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn no_reaction_of_the_machining_centre_is_longer_than_the_bound_of_a_guarantee() {
        no_reaction_is_longer(&machines::MACHINING_CENTRE, 25);
    }

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn guarantees_of_the_machining_centre_hold_with_their_bounds() {
        let found = verdicts(&machines::MACHINING_CENTRE.0, &machines::MACHINING_CENTRE.1);
        for name in ["no_start", "no_start_tool", "no_start_magazine"] {
            assert_eq!(found[name].0, Verdict::Holds, "{name}");
        }
        // The signal and the discrepancy of the contacts, capture and telegram (4.8.20), two cycles of the program, the SS1 of the slowest axis of
        // the group.
        for (name, times) in [
            ("table_som_1", &[30, 28, 42, 600][..]),
            ("table_som_2", &[30, 28, 42, 600]),
            ("table_som_3", &[30, 28, 42, 600]),
            ("tool_som_1", &[30, 28, 42, 2300]),
            ("tool_som_2", &[30, 28, 42, 2300]),
            ("magazine", &[30, 28, 42, 800]),
            ("emergency_stop", &[30, 6, 600]),
            ("emergency_stop_tool", &[30, 6, 2300]),
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
    #[ignore = "slow: a step of .ci/run"]
    fn every_dangerous_value_breaks_a_guarantee() {
        let path = root().join("tests/machines/dangerous.toml");
        let text = std::fs::read_to_string(path).expect("readable");
        let mut file: BTreeMap<String, Vec<Dangers>> =
            toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"));
        let machines = file.remove("machine").expect("machines");
        assert_eq!(machines.len(), 5);
        let changes: usize = machines.iter().map(|machine| machine.change.len()).sum();
        assert!(changes >= 134, "{changes}");
        for machine in machines {
            assert!(machine.change.len() >= 6, "{}", machine.file);
            let wrong = each(&machine.change, |change| {
                let broken = changed(&machine.file, &change.replace, &change.by);
                let path = root().join(&machine.file);
                let violated = is_violated(&path, &broken, &change.breaks);
                (!violated).then(|| format!("{}: {} holds", change.text, change.breaks))
            });
            let wrong: Vec<String> = wrong.into_iter().flatten().collect();
            assert!(wrong.is_empty(), "{}: {}", machine.file, wrong.join("\n"));
        }
    }
}
