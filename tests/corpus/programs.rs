//! The safe PLC program of a machine is judged by the event tables of the manual: every property of them finds a program that
//! breaks it, and none finds one in the shipped machine.

use std::collections::BTreeSet;
use std::path::Path;

use serde::Deserialize;
use stillpoint_engine::check::{Checked, Settings, Summary, check, exit_status, summarise};
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_machine::{self as machine, Machine};
use stillpoint_model::{Until, Verdict};
use stillpoint_tests::peer::each;
use stillpoint_tests::root;

const MACHINE: &str = "spec/machines/machining-centre-heidenhain.toml";
const LIBRARY: &str = "events.toml";

/// A program that is wrong in one place.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Mistake {
    pub text: String,
    /// What stands in the program once, and what stands there instead.
    pub replace: Vec<(String, String)>,
    /// The property that finds it.
    pub breaks: String,
    /// The length of the shortest counterexample.
    pub cycles: u64,
    /// Of a program in Structured Text a piece of the line that the report names.
    pub line: Option<String>,
}

/// A program that is another one, and right.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Right {
    pub text: String,
    pub replace: Vec<(String, String)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Programs {
    pub mistake: Vec<Mistake>,
    pub right: Vec<Right>,
}

impl Programs {
    /// Reads a file of `tests/machines`.
    pub fn of(file: &str) -> Self {
        let path = root().join("tests/machines").join(file);
        let text = std::fs::read_to_string(path).expect("readable");
        toml::from_str(&text).unwrap_or_else(|e| panic!("{e}"))
    }
}

impl Mistake {
    /// Only what is asked for is judged: all of the others would take ten times as long.
    pub fn asked(&self, mut subject: Subject) -> Subject {
        subject
            .tasks
            .retain(|task| ids(task).any(|id| id == self.breaks));
        for task in &mut subject.tasks {
            let properties = &mut task.bound.system.properties;
            properties.retain(|p| p.id == self.breaks);
        }
        subject
    }

    /// What is wrong with the answer, if it is not that the property breaks so.
    pub fn missed(&self, judged: &[Summary]) -> Option<String> {
        let found: Vec<(&str, Verdict, Option<u64>)> = (judged.iter())
            .map(|one| (one.id.as_str(), one.verdict, one.length))
            .collect();
        let expected = [(self.breaks.as_str(), Verdict::Violated, Some(self.cycles))];
        (found != expected).then(|| format!("{}: {found:?}, not {expected:?}", self.text))
    }
}

fn programs() -> Programs {
    let programs = Programs::of("program-mistakes.toml");
    assert!(programs.mistake.iter().all(|m| m.line.is_none()));
    programs
}

/// A program with other texts in it, each in the place of one that stands there once.
pub(super) fn changed(title: &str, program: String, replace: &[(String, String)]) -> String {
    replace.iter().fold(program, |program, (from, to)| {
        let times = program.matches(from).count();
        assert_eq!(times, 1, "{title}: '{from}' stands there once");
        program.replace(from, to)
    })
}

fn shipped() -> String {
    std::fs::read_to_string(root().join(MACHINE)).expect("readable")
}

/// The explorations of the library for a machine with this text.
fn library(text: &str) -> Subject {
    let path = root().join(MACHINE);
    let machine = machine::load_bytes(
        &path,
        text.as_bytes().to_vec(),
        &root().join("spec/families"),
    )
    .unwrap_or_else(|e| panic!("{e}"));
    judging(&path, machine)
}

/// The explorations of a machine that judge its program by the event tables.
pub(super) fn judging(path: &Path, machine: Machine) -> Subject {
    let runs: Vec<_> = (machine.runs.iter())
        .filter(|run| run.file.ends_with(LIBRARY))
        .cloned()
        .collect();
    subject::of_runs(path, machine, &runs, &Readings::new()).unwrap_or_else(|e| panic!("{e}"))
}

/// There are many programs to check, so each has one thread.
pub(super) fn checked(subject: &Subject) -> Vec<Checked> {
    let settings = Settings {
        threads: 1,
        // Of a wrong program the shortest run to the one property that is asked for is all there is to know.
        until: Until::Decided,
        ..Settings::default()
    };
    check(&mut subject.clone(), &settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(title, e)| panic!("{title}: {e}"))
}

/// The properties of an exploration.
fn ids(task: &subject::Task) -> impl Iterator<Item = &str> {
    let properties = task.bound.system.properties.iter();
    properties.map(|p| p.id.as_str())
}

#[test]
fn the_shipped_program_keeps_every_row_of_the_event_tables() {
    let subject = library(&shipped());
    let groups: Vec<&str> = (subject.tasks.iter())
        .map(|task| task.bound.system.name.as_str())
        .collect();
    let systems = ["axes_events", "spindle_events", "magazine_events"];
    assert_eq!(groups, systems.map(|s| format!("heidenhain-fs/events/{s}")));
    let checked = checked(&subject);
    let summaries = summarise(&subject, &checked);
    assert_eq!(exit_status(&summaries, &checked), 0);
    for one in &summaries {
        // Vacuous is no answer here: the left side of each row is reached.
        assert_eq!(one.verdict, Verdict::Holds, "{}", one.id);
    }
}

/// What starts a group: HFS-API-005, HFS-API-006, HFS-API-007, HFS-API-008, HFS-API-009, HFS-API-010, HFS-API-011, HFS-API-012.
/// What stops it: HFS-API-015, HFS-API-017, HFS-API-021, HFS-API-022, HFS-API-023, HFS-API-026, HFS-API-040, HFS-KSW-003/a, HFS-KSW-003/b, HFS-KSW-003/c, HFS-MAG-002,
/// HFS-MAG-003, HFS-SS2-009, HFS-FAULT-022, HFS-FAULT-023, HFS-FAULT-024, HFS-FAULT-026.
#[test]
fn each_row_of_the_event_tables_finds_the_program_that_breaks_it() {
    let wrong = each(&programs().mistake, |mistake| {
        let program = changed(&mistake.text, shipped(), &mistake.replace);
        let subject = mistake.asked(library(&program));
        mistake.missed(&summarise(&subject, &checked(&subject)))
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The tables say what a program has to do, not how: one that does it otherwise is not accused.
#[test]
fn programs_that_are_right_in_another_way_are_not_accused() {
    each(&programs().right, |right| {
        let subject = library(&changed(&right.text, shipped(), &right.replace));
        for one in summarise(&subject, &checked(&subject)) {
            assert_eq!(one.verdict, Verdict::Holds, "{}: {}", right.text, one.id);
        }
    });
}

/// A property that no seeded mistake breaks could be one that nothing breaks.
#[test]
fn every_property_of_the_event_tables_has_a_seeded_mistake() {
    let subject = library(&shipped());
    let programs = programs();
    let all: BTreeSet<&str> = subject.tasks.iter().flat_map(ids).collect();
    let seeded: BTreeSet<&str> = programs.mistake.iter().map(|m| m.breaks.as_str()).collect();
    assert!(all.len() >= 30, "{}", all.len());
    assert_eq!(all, seeded);
}
