//! The programs that chapter 10 of the manual prints are machines: their known weaknesses are found by what such a machine has to
//! guarantee, with the line of the program, and machines beside them that are mended keep it.

use stillpoint_engine::check::{Settings, check};
use stillpoint_engine::lines;
use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::guarantees::answers;
use stillpoint_machine as machine;
use stillpoint_model::Verdict;
use stillpoint_tests::peer::each;
use stillpoint_tests::root;

/// What one property says of a machine: verdict, length of the run that shows it, and the lines of the programs that decide its end.
#[derive(Debug)]
struct Found {
    id: String,
    verdict: Verdict,
    length: Option<usize>,
    lines: Vec<String>,
}

/// The verdict on a guarantee of a machine of `tests/machines`, and what its properties say.
fn judged(name: &str, guarantee: &str) -> (Verdict, Vec<Found>) {
    let path = root().join(format!("tests/machines/{name}.toml"));
    let machine =
        machine::load(&path, &root().join("spec/families")).unwrap_or_else(|e| panic!("{e}"));
    let runs: Vec<_> = (machine.runs.iter())
        .filter(|run| run.guarantee.as_deref() == Some(guarantee))
        .cloned()
        .collect();
    let subject =
        subject::of_runs(&path, machine, &runs, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        threads: 1,
        ..Settings::default()
    };
    let checked = check(&subject, &settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    let all = answers(&subject, &checked);
    let answer = all.iter().find(|a| a.guarantee.name == guarantee);
    let found = subject.tasks.iter().zip(&checked).flat_map(|(task, one)| {
        println!("{name}, {guarantee}: {} states", one.outcome.report.states);
        let properties = &task.bound.system.properties;
        let judged = properties.iter().zip(&one.outcome.report.properties);
        judged.map(|(property, judged)| {
            let trace = judged.trace.as_ref();
            let lines = trace.map(|trace| lines::deciding(&task.bound, property, trace));
            Found {
                id: property.id.clone(),
                verdict: judged.verdict,
                length: trace.map(|trace| trace.steps.len()),
                lines: (lines.into_iter().flatten())
                    .map(|line| format!("{} {}", line.value, line.text))
                    .collect(),
            }
        })
    });
    let found = found.collect();
    (answer.expect("asked").verdict, found)
}

/// A machine, its guarantee, and the properties that its printed program breaks, each with a piece of a line that decides it.
type Case = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);

const PRINTED: [Case; 4] = [
    (
        "emergency-stop-840d",
        "restart",
        &[
            ("FIRST-BY-BUTTON", "QUIT_MARKER"),
            ("LONGEST-COUNTS", "QUIT_MARKER"),
            ("HELD-BUTTON", "NOT_QUIT"),
        ],
    ),
    (
        "forced-checking-840d",
        "acknowledgement_ends",
        &[("ENDS", "")],
    ),
    ("forced-checking-840d", "next_test", &[("COMES-BACK", "")]),
    (
        "profisafe-840d",
        "valve",
        &[("FIRST-BY-BUTTON", "IE02_SCHUTZTUER_OK")],
    ),
];

const MENDED: [(&str, &str); 4] = [
    ("emergency-stop-relay-840d", "restart"),
    ("forced-checking-own-840d", "acknowledgement_ends"),
    ("forced-checking-own-840d", "next_test"),
    ("profisafe-command-840d", "valve"),
];

/// The findings about the printed programs: S840D-EXAMPLE-730 (a request of the PLC alone releases after power-on), S840D-EXAMPLE-731
/// (only the last interruption counts), S840D-EXAMPLE-732 (the acknowledgement is a level), S840D-TESTSTOP-720 (the acknowledgement of
/// the PLC stays), S840D-TESTSTOP-721 (an aborted test is the last one), S840D-PSAFE-719 (closing the door switches on).
#[test]
fn the_weaknesses_of_the_printed_programs_are_found() {
    let wrong = each(&PRINTED, |(name, guarantee, broken)| {
        let (verdict, found) = judged(name, guarantee);
        println!("{name}, {guarantee}: {found:#?}");
        let mut missed = Vec::new();
        if verdict != Verdict::Violated {
            missed.push(format!("{name}, {guarantee}: {verdict:?}"));
        }
        for (id, line) in *broken {
            let one = found.iter().find(|one| one.id == *id);
            let right = one.is_some_and(|one| {
                let named = line.is_empty() || one.lines.iter().any(|l| l.contains(line));
                one.verdict == Verdict::Violated && one.length.is_some() && named
            });
            if !right {
                missed.push(format!("{name}, {id}: {one:#?}"));
            }
        }
        missed
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// S840D-EXAMPLE-701, S840D-EXAMPLE-702, S840D-EXAMPLE-730, S840D-EXAMPLE-731, S840D-EXAMPLE-732, S840D-TESTSTOP-712, S840D-TESTSTOP-714,
/// S840D-TESTSTOP-720, S840D-TESTSTOP-721.
#[test]
fn the_mended_programs_keep_what_they_guarantee() {
    let wrong = each(&MENDED, |(name, guarantee)| {
        let (verdict, found) = judged(name, guarantee);
        (verdict != Verdict::Holds).then(|| format!("{name}, {guarantee}: {verdict:?} {found:#?}"))
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
