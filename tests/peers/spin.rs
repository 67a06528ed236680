//! Exported systems in SPIN: the same number of states, and the same broken properties.
//!
//! A user without SPIN or gcc sees that the tests were skipped; where the environment has `CI`, they fail then.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use stillpoint_harness::export::promela::{Promela, promela};
use stillpoint_lang::ir::Form;
use stillpoint_model::Verdict;
use stillpoint_tests::peer::{Folder, QUICK, each, explored, load, shipped, starts, tools};
use stillpoint_tests::{daily, exceptions, files, root};

const TOOLS: [&str; 2] = ["spin", "gcc"];

/// The most transitions of a system whose verifier is quicker than an optimising compiler.
const SMALL: u128 = 1_000_000;

/// What came of a file.
#[derive(Default)]
struct Compared {
    /// Systems that were compared.
    compared: usize,
    /// Systems with a broken assertion.
    broken: usize,
    /// Systems that are left out.
    left_out: Vec<String>,
}

/// What a run of SPIN's verifier found.
struct Found {
    states: u64,
    errors: u64,
}

fn number(text: &str, before: &str, after: &str) -> Option<u64> {
    let end = text.find(after)?;
    let start = text[..end].rfind(before)? + before.len();
    text[start..end].trim().parse().ok()
}

impl Found {
    fn of(text: &str) -> Self {
        assert!(!text.contains("max search depth too small"), "{text}");
        assert!(
            !text.contains("Search not completed\n") || text.contains("errors: 1"),
            "{text}"
        );
        let states = number(text, "\n", "states, stored").unwrap_or_else(|| panic!("{text}"));
        let errors = text
            .split("errors: ")
            .nth(1)
            .and_then(|t| t.split_whitespace().next()?.parse().ok());
        Found {
            states,
            errors: errors.unwrap_or_else(|| panic!("{text}")),
        }
    }
}

/// What builds a verifier.
#[derive(Clone, Copy)]
enum Compiler {
    /// For small models, whose verifiers run shorter than an optimising compiler takes: tcc, else gcc as it is quickest.
    Quick,
    /// For large ones.
    Optimising,
}

impl Compiler {
    fn command(self) -> (&'static str, &'static str) {
        static TCC: LazyLock<bool> = LazyLock::new(|| starts("tcc", "-v"));
        match self {
            Compiler::Quick if *TCC => ("tcc", "-O0"),
            Compiler::Quick => ("gcc", "-O0"),
            Compiler::Optimising => ("gcc", "-O2"),
        }
    }
}

/// The verifier of a model, built in a folder.
fn verifier(name: &str, model: &Promela, compiler: Compiler) -> Folder {
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), &format!("spin-{name}"));
    folder.write("model.pml", &model.text);
    folder.run("spin", &["-a", "model.pml"]);
    let (program, optimise) = compiler.command();
    folder.run(
        program,
        &[
            optimise,
            "-w",
            "-DSAFETY",
            "-DNOREDUCE",
            "-DMEMLIM=3000",
            "-o",
            "pan",
            "pan.c",
        ],
    );
    folder
}

/// Compares every system of a file that is no exception and has no more transitions than that.
fn compare(path: &Path, exceptions: &BTreeSet<String>, most: u128) -> Compared {
    let subject = load(path);
    let mut compared = Compared::default();
    for (n, task) in subject.tasks.iter().enumerate() {
        let name = &task.bound.system.name;
        let report = (!exceptions.contains(name)).then(|| explored(&subject, task));
        let Some(report) = report.filter(|report| report.transitions <= most) else {
            compared.left_out.push(name.clone());
            continue;
        };
        let compiler = match report.transitions {
            0..=SMALL => Compiler::Quick,
            _ => Compiler::Optimising,
        };
        let model = promela(&task.bound, &task.title).unwrap_or_else(|e| panic!("{name}: {e}"));
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let folder = verifier(&format!("{stem}-{n}"), &model, compiler);
        let judged = Found::of(&folder.run("./pan", &["-m1000000"]));
        // A broken assertion ends the search; with -A none is looked at and every state is visited.
        let all = if judged.errors == 0 {
            judged.states
        } else {
            Found::of(&folder.run("./pan", &["-A", "-m1000000"])).states
        };
        assert_eq!(all, report.states + model.extra_states, "{name}: states");
        let violated = task
            .bound
            .system
            .properties
            .iter()
            .zip(&report.properties)
            .any(|(p, j)| matches!(p.form, Form::Always { .. }) && j.verdict == Verdict::Violated);
        assert_eq!(
            judged.errors > 0,
            violated || !report.faults.is_empty(),
            "{name}: assertions"
        );
        compared.compared += 1;
        compared.broken += usize::from(judged.errors > 0);
        eprintln!("{name}: {} states in SPIN and here", report.states);
    }
    compared
}

/// Compares the systems of these files of no more transitions: how many they are, and which are left out.
fn compare_shipped(files: &[PathBuf], most: u128) -> (usize, BTreeSet<String>) {
    let exceptions = exceptions("spin");
    let (mut compared, mut left_out) = (0, BTreeSet::new());
    let all = each(files, |path| compare(path, &exceptions, most));
    for (path, one) in files.iter().zip(all) {
        assert_eq!(one.broken, 0, "{}", path.display());
        compared += one.compared;
        left_out.extend(one.left_out);
    }
    (compared, left_out)
}

/// Every other file, those that rumur does not compare; the answer is how many systems were compared.
fn compare_most(most: impl Fn(Vec<PathBuf>) -> Vec<PathBuf>) -> usize {
    let files = shipped().into_iter().step_by(2).collect();
    let (compared, left_out) = compare_shipped(&most(files), QUICK);
    println!(
        "{compared} systems in SPIN and here, {} larger",
        left_out.len()
    );
    compared
}

#[test]
fn some_shipped_systems_have_the_same_states() {
    if tools(&TOOLS) {
        let compared = compare_most(daily);
        assert!(compared >= 8, "{compared}");
    }
}

#[test]
#[ignore = "deep: minutes"]
fn shipped_systems_have_the_same_states() {
    if !tools(&TOOLS) {
        return;
    }
    let (compared, left_out) = compare_shipped(&shipped(), u128::MAX);
    println!("{compared} systems in SPIN and here");
    assert_eq!(
        left_out,
        exceptions("spin"),
        "the systems that are too large"
    );
}

/// In so many systems at least of these files an assertion is broken: with fewer the comparison shows too little.
fn broken_assertions(files: &[PathBuf], least: usize) {
    let broken = each(files, |path| {
        compare(path, &BTreeSet::new(), u128::MAX).broken
    });
    let broken: usize = broken.iter().sum();
    assert!(
        broken >= least,
        "assertions are broken in {broken} systems only"
    );
}

#[test]
fn some_seeded_errors_break_assertions() {
    if tools(&TOOLS) {
        broken_assertions(&daily(files("tests/must-fail", "toml")), 2);
    }
}

#[test]
fn what_a_model_must_not_hide() {
    if !tools(&TOOLS) {
        return;
    }
    // A counter that leaves its range, a state that nothing reads, and an array with a computed index.
    let text = r#"
spec  = "test/spin"
title = "what a model must not hide"
[machine.m]
text = "a counter, a write-only state, an array"
otherwise = "stay"
order = "priority"
[machine.m.input]
go = "BOOL"
at = "INT(0..2)"
big = "INT(-40000..-39960)"
[machine.m.state]
count = { type = "INT(0..3)", init = 1 }
shadow = { type = "INT(-2..2)", init = "ANY" }
cells = { type = "ARRAY[0..2] OF BOOL", init = false }
[[machine.m.rule]]
name = "go"
note = "test"
when = "go AND NOT cells[at]"
then = "count := count + at; shadow := at - 1; cells[MIN(at, count)] := TRUE;"
[[machine.m.rule]]
name = "back"
note = "test"
when = "big < -39990 AND count > MAX(at, 1, count MOD 2)"
then = "count := ABS(at - count); IF at = 1 THEN shadow := -2; ELSIF cells[2] THEN cells[2] := FALSE; END_IF;"
[system.s]
text = "one"
[system.s.instance]
m = { machine = "m" }
[system.s.free]
ports = ["m.go", "m.at", "m.big"]
"#;
    let folder = Folder::new(env!("CARGO_TARGET_TMPDIR"), "spin-text");
    folder.write("hidden.toml", text);
    assert_eq!(
        compare(&folder.file("hidden.toml"), &BTreeSet::new(), u128::MAX).broken,
        1,
        "the counter leaves its range"
    );
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn most_shipped_systems_have_the_same_states() {
        if tools(&TOOLS) {
            let compared = compare_most(|files| files);
            assert!(compared >= 50, "{compared}");
        }
    }

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn the_yardstick_has_its_states() {
        if !tools(&TOOLS) {
            return;
        }
        let subject = load(&root().join("spec/bench/two-axis.toml"));
        let model = promela(&subject.tasks[0].bound, "yardstick").unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(
            model.extra_states, 0,
            "its initial state is fixed, SPIN's figure is the figure"
        );
        let folder = verifier("yardstick", &model, Compiler::Optimising);
        let found = Found::of(&folder.run("./pan", &["-m100000"]));
        assert_eq!((found.states, found.errors), (4_024_036, 0));
    }

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn seeded_errors_break_assertions() {
        if tools(&TOOLS) {
            broken_assertions(&files("tests/must-fail", "toml"), 8);
        }
    }
}
