//! The shipped machine files, checked as a user does: everything holds, and what never happens is explained. A machine with a
//! wrong program of its safe PLC is found out.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use stillpoint_engine::check::{Checked, Settings, Unfired, check, exit_status, summarise};
use stillpoint_engine::subject::{self, Readings, Subject, Task};
use stillpoint_engine::theorems::Theorems;
use stillpoint_harness::product::{judged, products};
use stillpoint_harness::report;
use stillpoint_model::Verdict;
use stillpoint_tests::{exceptions, root};

/// A machine file.
fn load(file: &str) -> Subject {
    let path = root().join("spec/machines").join(file);
    subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"))
}

/// A machine, and what its check has found.
pub(crate) type Whole = (Subject, Vec<Checked>);

fn whole(mut subject: Subject) -> Whole {
    let settings = Settings::default();
    let mut checked = check(&mut subject, &settings, &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    let products = products(&subject, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let products = products.map_or(Vec::new(), |products| products.tasks);
    for (task, done) in judged(products, &settings, &mut |_| Box::new(())) {
        subject.tasks.push(task);
        checked.push(done);
    }
    (subject, checked)
}

/// The milling machine, checked once for all tests.
pub(crate) static MILLING: LazyLock<Whole> = LazyLock::new(|| whole(load("milling-840d.toml")));

/// The machining centre without the runs that are left to a deep run, checked once for all tests.
pub(crate) static MACHINING_CENTRE: LazyLock<Whole> = LazyLock::new(|| whole(centre(false)));

/// Every property of a machine holds in these runs; the answer is how many there are.
fn keeps_every_property((subject, checked): &Whole, expected: &[&str]) -> usize {
    let axes: Vec<&str> = subject
        .machine
        .iter()
        .flat_map(|m| m.axes.iter().map(|a| a.name.as_str()))
        .collect();
    assert_eq!(axes, expected);
    for (task, done) in subject.tasks.iter().zip(checked) {
        let report = &done.outcome.report;
        assert!(
            report.complete && report.faults.is_empty(),
            "{}: {:?}",
            task.title,
            report.faults
        );
        let unexplained: Vec<&str> = done
            .unfired
            .iter()
            .filter(|(_, why)| matches!(why, Unfired::Unexplained | Unfired::Unknown))
            .map(|(rule, _)| rule.as_str())
            .collect();
        assert!(
            unexplained.is_empty(),
            "{}: rules that never fire: {unexplained:?}",
            task.title
        );
    }
    let summaries = summarise(subject, checked);
    for one in &summaries {
        assert!(
            matches!(one.verdict, Verdict::Holds | Verdict::Reached),
            "{}: {:?}",
            one.id,
            one.verdict
        );
        // What holds because of a premise was seen to have its premise fulfilled.
        assert!(
            one.length.is_some() || one.verdict == Verdict::Holds,
            "{}",
            one.id
        );
    }
    assert_eq!(exit_status(&summaries, checked), 0);
    summaries.len()
}

#[test]
fn the_milling_machine_keeps_every_property() {
    assert!(MILLING.0.tasks.len() >= 10);
    let properties = keeps_every_property(&MILLING, &["X", "Y", "Z", "S"]);
    assert!(properties >= 30, "{properties}");
}

#[test]
fn the_pages_show_the_numbers_of_the_milling_machine() {
    let numbers = |checked: &[Checked]| {
        let reports = || checked.iter().map(|c| &c.outcome.report);
        let states: u64 = reports().map(|r| r.states).sum();
        let transitions: u128 = reports().map(|r| r.transitions).sum();
        format!("{states}states,{transitions}transitions")
    };
    // With the theorems of the family and without.
    let mut subject = load("milling-840d.toml");
    let machine = subject.machine.as_ref().expect("a machine");
    let theorems = Theorems::load(machine.family_folder()).unwrap_or_else(|e| panic!("{e}"));
    let settings = Settings {
        theorems: Some(theorems.into()),
        ..Settings::default()
    };
    let citing = check(&mut subject, &settings, &mut |_| Box::new(()));
    let citing = numbers(&citing.unwrap_or_else(|(title, e)| panic!("{title}: {e}")));
    let whole = numbers(&MILLING.1);
    let properties = format!("{}properties", summarise(&MILLING.0, &MILLING.1).len());
    for page in ["README.md", "docs/src/tutorial.md"] {
        let text = std::fs::read_to_string(root().join(page)).expect("a page");
        let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let shown = text.matches(&properties).count();
        assert!(shown > 0, "{page} shows no check of the milling machine");
        let cited = text.matches(&citing).count();
        assert!(cited > 0, "{page}: {citing}");
        let all = cited + text.matches(&whole).count();
        assert_eq!(all, shown, "{page}: {whole}");
    }
    let summaries = summarise(&MILLING.0, &MILLING.1);
    let report = report::text(&MILLING.0, &MILLING.1, &summaries, false);
    let report: String = report.chars().filter(|c| !c.is_whitespace()).collect();
    for page in [
        "README.md",
        "docs/src/tutorial.md",
        "docs/src/machine-files.md",
    ] {
        let text = std::fs::read_to_string(root().join(page)).expect("a page");
        let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let told = text.split("axesX,Y:inatmost").skip(1);
        let told = told.filter_map(|after| after.split_once("mm/min").map(|(bound, _)| bound));
        let told: BTreeSet<&str> = told.collect();
        assert!(
            !told.is_empty(),
            "{page} shows no bound of the milling machine"
        );
        for bound in told {
            let line = format!("axesX,Y:inatmost{bound}mm/min");
            assert!(report.contains(&line), "{page}: {line}");
        }
    }
}

/// The axes of the machining centre.
const CENTRE: [&str; 5] = ["X", "Y", "Z", "S", "M"];

/// The machining centre with those of its runs that are left to a deep run, or with all others.
fn centre(deep: bool) -> Subject {
    let mut subject = load("machining-centre-heidenhain.toml");
    let left_out = exceptions("machines");
    let name = |task: &Task| task.bound.system.name.clone();
    let all: BTreeSet<String> = subject.tasks.iter().map(name).collect();
    assert!(left_out.is_subset(&all), "{left_out:?}");
    subject
        .tasks
        .retain(|task| left_out.contains(&name(task)) == deep);
    subject
}

/// Two at a time or one after the other: the same outcomes, and the same of them are those of a run before.
#[test]
fn explorations_side_by_side_tell_the_same() {
    let told = |threads| {
        let mut subject = load("stacker-s120.toml");
        let settings = Settings {
            threads,
            ..Settings::default()
        };
        let checked = check(&mut subject, &settings, &mut |_| Box::new(()))
            .unwrap_or_else(|(title, e)| panic!("{title}: {e}"));
        let one = |done: &Checked| {
            assert_eq!(done.again, done.outcome.report.seconds == 0.0);
            let mut report = done.outcome.report.clone();
            (report.seconds, report.memory, report.stored) = (0.0, 0, 0);
            (done.again, format!("{report:?}"))
        };
        let all: Vec<_> = checked.iter().map(one).collect();
        (format!("{:?}", subject.tasks), all)
    };
    let (tasks, all) = told(1);
    assert!(all.iter().any(|(again, _)| *again));
    for _ in 0..2 {
        let (these, side_by_side) = told(2);
        assert_eq!(tasks, these);
        assert_eq!(all.len(), side_by_side.len());
        for (one, other) in all.iter().zip(&side_by_side) {
            assert_eq!(one, other);
        }
    }
}

#[test]
#[ignore = "deep: minutes"]
fn the_logic_and_the_kernel_of_the_machining_centre_keep_every_property() {
    let properties = keeps_every_property(&whole(centre(true)), &CENTRE);
    assert!(properties >= 10, "{properties}");
}

/// The kernel does what a program that ignores the doors asks for; that nothing may move then is found broken in the logic alone,
/// by the event tables of each group, and in the logic with the kernel of each group.
#[test]
fn a_program_that_ignores_the_doors_is_found() {
    let path = root().join("tests/machines/door-ignored.toml");
    let mut subject = subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let with_logic = |task: &Task| {
        let mut instances = task.bound.system.instances.iter();
        instances.any(|i| i.machine == "splc")
    };
    subject.tasks.retain(with_logic);
    assert_eq!(subject.tasks.len(), 7);
    let checked = check(&mut subject, &Settings::default(), &mut |_| Box::new(()))
        .unwrap_or_else(|(t, e)| panic!("{t}: {e}"));
    for (task, done) in subject.tasks.iter().zip(&checked) {
        let judged = done.outcome.report.properties.iter();
        let broken: Vec<&str> = judged
            .filter(|p| p.verdict == Verdict::Violated)
            .map(|p| p.id.as_str())
            .collect();
        assert!(!broken.is_empty(), "{}: nothing is broken", task.title);
        println!("{}: {broken:?}", task.title);
    }
    let summaries = summarise(&subject, &checked);
    assert_eq!(exit_status(&summaries, &checked), 1);
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn the_machining_centre_keeps_every_property() {
        assert!(MACHINING_CENTRE.0.tasks.len() >= 10);
        let properties = keeps_every_property(&MACHINING_CENTRE, &CENTRE);
        assert!(properties >= 200, "{properties}");
    }

    /// An exploration is spared exactly where the same system with the same values was explored before.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn equal_explorations_are_made_once() {
        let (subject, checked) = &*MACHINING_CENTRE;
        let mut spared = 0;
        for (n, (task, done)) in subject.tasks.iter().zip(checked).enumerate() {
            let mut before = subject.tasks[..n].iter().zip(checked);
            let same = before.find(|(earlier, _)| earlier.bound == task.bound);
            assert_eq!(same.is_some(), done.again, "{}", task.title);
            if let Some((_, first)) = same {
                let verdicts = |c: &Checked| c.outcome.report.properties.clone();
                assert_eq!(verdicts(first), verdicts(done), "{}", task.title);
                spared += 1;
            }
        }
        assert!(spared >= 2, "{spared}");
    }
}
