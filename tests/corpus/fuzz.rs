//! Every fuzz target for a moment, on altered inputs that are the same in every run; the table of the targets in the book and
//! the files of the fuzzer.

use std::collections::BTreeSet;

use stillpoint_tests::fuzz::{TARGETS, altered};
use stillpoint_tests::random::Random;
use stillpoint_tests::{drive, files, root, telegram};

/// Inputs for each target, in the daily run and in a deep one. The first ones are the same in both.
const INPUTS: usize = 800;
const DEEP: usize = 20_000;

#[test]
fn no_altered_input_breaks_a_property() {
    tried(INPUTS);
}

#[test]
#[ignore = "deep: minutes"]
fn none_of_many_altered_inputs_breaks_a_property() {
    tried(DEEP);
}

fn tried(inputs: usize) {
    for (number, target) in TARGETS.iter().enumerate() {
        let seeds = (target.seeds)();
        let accepted = seeds.iter().filter(|seed| (target.run)(seed)).count();
        assert!(accepted > 0, "{}: no seed is accepted", target.name);
        let mut random = Random::new(number as u64);
        let mut refused = 0;
        for _ in 0..inputs {
            let input = altered(&mut random, &seeds);
            let judged = std::panic::catch_unwind(|| (target.run)(&input));
            let accepted = judged.unwrap_or_else(|_| {
                panic!("{}: {:?}", target.name, String::from_utf8_lossy(&input))
            });
            refused += usize::from(!accepted);
        }
        println!(
            "{}: {refused} of {inputs} altered inputs refused",
            target.name
        );
        // Any bytes are a run of the monitors.
        assert!(
            refused > 0 || target.name == "differential",
            "{}",
            target.name
        );
    }
}

/// Frames of the telegrams of SINAMICS S120, in the daily run and in a deep one.
const FRAMES: usize = 20_000;
const DEEP_FRAMES: usize = 10_000_000;

#[test]
fn telegrams_are_what_the_manual_prints() {
    sent_and_received(FRAMES);
}

#[test]
#[ignore = "deep: a minute"]
fn many_telegrams_are_what_the_manual_prints() {
    sent_and_received(DEEP_FRAMES);
}

/// What a target says of these bytes; they are told where it breaks.
fn judged<T>(data: &[u8], run: fn(&[u8]) -> T) -> T {
    std::panic::catch_unwind(|| run(data)).unwrap_or_else(|_| panic!("{data:?}"))
}

fn sent_and_received(frames: usize) {
    let mut random = Random::new(120);
    let mut accepted = 0;
    for _ in 0..frames {
        let frame = telegram::frame(&mut random);
        accepted += usize::from(judged(&frame, telegram::telegram));
    }
    println!("{accepted} of {frames} frames are telegrams");
    assert!(accepted > frames / 2 && accepted < frames, "{accepted}");
}

/// Cycles of drives at their F host, in the daily run and in a deep one.
const CYCLES: u64 = 200_000;
const DEEP_CYCLES: u64 = 10_000_000;

#[test]
fn drives_answer_as_the_manual_says() {
    answered(CYCLES);
}

#[test]
#[ignore = "deep: a minute"]
fn drives_answer_many_telegrams_as_the_manual_says() {
    answered(DEEP_CYCLES);
}

fn answered(cycles: u64) {
    let mut random = Random::new(700);
    let mut count = drive::Count::default();
    while count.telegrams < cycles {
        let data = drive::records(&mut random, 200);
        let run = judged(&data, drive::run);
        count.telegrams += run.telegrams;
        count.told |= run.told;
    }
    println!(
        "{} telegrams answered, bits {:#x}",
        count.telegrams, count.told
    );
    // Each function of these axes was active at some time, and an event has come.
    let met = [
        "STO active",
        "SS1 active",
        "SS2 active",
        "SOS active",
        "SLS active",
        "Internal Event",
        "SDI positive active",
        "SDI negative active",
    ];
    for name in met {
        assert!(
            count.told >> telegram::place("S_ZSW2", name) & 1 == 1,
            "{name} never"
        );
    }
}

#[test]
fn each_target_has_its_file_and_its_line() {
    let named: BTreeSet<String> = files("harness/fuzz/fuzz_targets", "rs")
        .iter()
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    let listed: BTreeSet<String> = TARGETS.iter().map(|t| t.name.to_owned()).collect();
    assert_eq!(named, listed);
    let manifest = std::fs::read_to_string(root().join("harness/fuzz/Cargo.toml")).expect("there");
    let page = std::fs::read_to_string(root().join("docs/src/fuzzing.md")).expect("there");
    let rows: Vec<&str> = page
        .lines()
        .filter(|line| line.starts_with("| `"))
        .collect();
    assert_eq!(rows.len(), TARGETS.len());
    for (target, row) in TARGETS.iter().zip(rows) {
        let name = target.name;
        assert_eq!(
            row,
            format!("| `{name}` | {} | {} |", target.component, target.property)
        );
        assert!(
            manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")),
            "{name}"
        );
        let file = root().join(format!("harness/fuzz/fuzz_targets/{name}.rs"));
        let source = std::fs::read_to_string(file).expect("there");
        assert!(source.contains(&format!("run(\"{name}\", data)")), "{name}");
    }
}
