//! Times of programs that no question starts: what holds with them left open holds, and less is explored.

use stillpoint_engine::check::{Checked, Settings, check};
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_harness::guarantees::answers;
use stillpoint_model::Verdict;
use stillpoint_tests::root;

/// The explorations of a machine whose programs have such times.
fn loose(file: &str) -> Subject {
    let path = root().join(file);
    let mut subject = subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    subject.tasks.retain(|task| task.loose.is_some());
    subject
}

fn explored(subject: &mut Subject, exact: bool) -> Vec<Checked> {
    let settings = Settings {
        exact,
        ..Settings::default()
    };
    check(subject, &settings, &mut |_| Box::new(())).unwrap_or_else(|(t, e)| panic!("{t}: {e}"))
}

fn states(checked: &[Checked]) -> u64 {
    checked.iter().map(|c| c.outcome.report.states).sum()
}

#[test]
fn what_holds_with_open_times_holds_with_their_own() {
    for (file, least) in [
        ("spec/machines/lathe-840d.toml", 6),
        ("tests/machines/interlock-840d.toml", 2),
    ] {
        let subject = loose(file);
        assert!(
            subject.tasks.len() >= least,
            "{file}: {}",
            subject.tasks.len()
        );
        let (mut open, mut own) = (subject.clone(), subject);
        let (loosely, exactly) = (explored(&mut open, false), explored(&mut own, true));
        for ((task, a), b) in open.tasks.iter().zip(&loosely).zip(&exactly) {
            let told = task
                .abstractions
                .iter()
                .any(|one| one.text.contains("left open"));
            assert!(told, "{}: not decided loosely", task.title);
            let verdicts = a
                .outcome
                .report
                .properties
                .iter()
                .zip(&b.outcome.report.properties);
            for (a, b) in verdicts {
                assert_eq!(
                    (a.verdict, b.verdict),
                    (Verdict::Holds, Verdict::Holds),
                    "{}",
                    task.title
                );
                assert!(
                    a.bound >= b.bound,
                    "{}: {:?} {:?}",
                    task.title,
                    a.bound,
                    b.bound
                );
            }
        }
        assert!(
            states(&loosely) < states(&exactly),
            "{file}: {} {}",
            states(&loosely),
            states(&exactly)
        );
    }
}

/// The slides of the lathe stand behind the open door by a time that the door itself starts: that one is not left open.
#[test]
fn a_time_that_the_question_starts_is_kept() {
    let path = root().join("spec/machines/lathe-840d.toml");
    let subject = subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    let about = |name: &str| {
        let tasks = subject.tasks.iter();
        let tasks = tasks.filter(|task| task.guarantee.as_deref() == Some(name));
        let loose = tasks.filter_map(|task| task.loose.as_ref());
        loose.map(|loose| loose.text.clone()).collect::<Vec<_>>()
    };
    assert!(about("slides").is_empty(), "{:?}", about("slides"));
    let texts = about("emergency_stop");
    assert!(
        texts.iter().any(|text| text.contains("OPEN_TIME")),
        "{texts:?}"
    );
    assert!(texts.iter().any(|text| text.contains("T 1")), "{texts:?}");
}

/// A wrong program is found wrong with its own times: the counterexample is one of the machine.
#[test]
fn what_does_not_hold_is_explored_with_its_own_times() {
    let path = root().join("spec/machines/lathe-840d.toml");
    let text = std::fs::read_to_string(&path).expect("readable");
    let text = text.replacen("within  = \"650 ms\"", "within  = \"500 ms\"", 1);
    let families = root().join("spec/families");
    let machine = stillpoint_machine::load_bytes(&path, text.into_bytes(), &families)
        .unwrap_or_else(|e| panic!("{e}"));
    let mut runs = machine.runs.clone();
    runs.retain(|run| run.guarantee.as_deref() == Some("emergency_stop"));
    let mut subject =
        subject::of_runs(&path, machine, &runs, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    assert!(subject.tasks.iter().all(|task| task.loose.is_some()));
    let checked = explored(&mut subject, false);
    let answers = answers(&subject, &checked);
    let answer = answers
        .iter()
        .find(|a| a.guarantee.name == "emergency_stop");
    assert_eq!(answer.expect("asked").verdict, Verdict::Violated);
    for (task, done) in subject.tasks.iter().zip(&checked) {
        for judged in &done.outcome.report.properties {
            let trace = judged.trace.as_ref().expect("a counterexample");
            assert!(!trace.steps.is_empty());
        }
        // The system itself: it counts the times.
        let loose = task.loose.as_ref().expect("asked loosely first");
        assert!(task.bound.system.states.len() > loose.bound.system.states.len());
    }
}

/// A time with many values is counted: to try them all in each cycle costs more.
#[test]
fn a_long_time_is_not_left_open() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("loose");
    std::fs::create_dir_all(&folder).expect("a folder");
    let text = |end: &str| {
        let path = root().join(format!("tests/machines/interlock-840d.{end}"));
        std::fs::read_to_string(path).expect("readable")
    };
    std::fs::write(folder.join("interlock-840d.stl"), text("stl")).expect("written");
    for (limit, open) in [("4.7", true), ("4.9", false)] {
        let program = text("spf").replace("STOP_TIME < 0.06", &format!("STOP_TIME < {limit}"));
        std::fs::write(folder.join("interlock-840d.spf"), program).expect("written");
        let path = folder.join("interlock-840d.toml");
        let families = root().join("spec/families");
        let machine = stillpoint_machine::load_bytes(&path, text("toml").into_bytes(), &families)
            .unwrap_or_else(|e| panic!("{e}"));
        let mut runs = machine.runs.clone();
        runs.retain(|run| run.guarantee.as_deref() == Some("hold_to_run") && !run.half);
        let subject = subject::of_runs(&path, machine, &runs, &Readings::new())
            .unwrap_or_else(|e| panic!("{e}"));
        let tasks = &subject.tasks;
        assert!(!tasks.is_empty());
        assert!(
            tasks.iter().all(|task| task.loose.is_some() == open),
            "{limit}"
        );
    }
}
