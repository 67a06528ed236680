//! Walking by hand and exploring are the same: states, transitions, and what runs show about properties.

use std::collections::BTreeSet;
use std::path::Path as File;
use std::time::Duration;

use stillpoint_engine::subject::{self, Readings, Task};
use stillpoint_engine::table::Interpreted;
use stillpoint_harness::browse::classes::classes;
use stillpoint_harness::browse::jump::jump;
use stillpoint_harness::browse::live::{Standing, live};
use stillpoint_harness::browse::path::Path;
use stillpoint_harness::browse::walk::walk;
use stillpoint_harness::browse::{Bounds, identity};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;
use stillpoint_model::{Options, Verdict, initials};

use crate::common::root;

const BOUNDS: Bounds = Bounds {
    time: Duration::from_secs(60),
    memory: 1 << 28,
    threads: 1,
};
/// States of the largest system that is walked through.
const MOST_STATES: u64 = 400;

/// The systems of every seeded error, and small ones whose properties hold.
fn tasks() -> Vec<Task> {
    let mut files: Vec<_> = std::fs::read_dir(root().join("tests/must-fail"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.sort();
    files.push(root().join("spec/families/sinumerik-840d/reaction.toml"));
    let load =
        |file: &std::path::PathBuf| subject::load(file, &Readings::new()).expect("good").tasks;
    files.iter().flat_map(load).collect()
}

fn explored(bound: &Bound) -> stillpoint_model::Report {
    let options = Options {
        limits: stillpoint_model::Limits {
            threads: 1,
            ..Default::default()
        },
        ..Options::default()
    };
    let outcome = stillpoint_engine::run(bound, &options, true, &mut ()).expect("explored");
    outcome.report
}

#[test]
fn the_classes_of_all_states_are_what_the_explorer_enumerates() {
    let mut walked = 0;
    for task in tasks() {
        let bound = &task.bound;
        let report = explored(bound);
        if report.states > MOST_STATES {
            continue;
        }
        walked += 1;
        let mut seen = BTreeSet::new();
        initials(&Interpreted::new(bound), |_, state| {
            seen.insert(state.to_vec());
            std::ops::ControlFlow::Continue(())
        });
        let mut open: Vec<Vec<i32>> = seen.iter().cloned().collect();
        let mut transitions = 0;
        while let Some(state) = open.pop() {
            let next = classes(bound, &state, &[]);
            assert!(next.complete, "{}", bound.system.name);
            assert_eq!(
                next.combinations,
                bound.combinations(),
                "{}",
                bound.system.name
            );
            let sum: u128 = next.classes.iter().map(|c| c.combinations).sum();
            assert_eq!(sum, next.combinations);
            transitions += sum;
            for class in next.classes {
                let after = class.after.expect("no fault");
                if seen.insert(after.clone()) {
                    open.push(after);
                }
            }
        }
        assert_eq!(
            (seen.len() as u64, transitions),
            (report.states, report.transitions),
            "{}",
            bound.system.name
        );
    }
    assert!(walked >= 5, "only {walked} systems were small enough");
}

#[test]
fn a_class_is_made_by_its_choice_and_by_nothing_that_contradicts_its_condition() {
    for task in tasks() {
        let bound = &task.bound;
        let state = walk(bound, &Path::default())
            .expect("the initial state")
            .states
            .remove(0);
        let all = classes(bound, &state, &[]);
        for class in &all.classes {
            let path = Path {
                initial: Path::default().initial,
                steps: vec![class.choice.clone()],
            };
            let made = walk(bound, &path).expect("a cycle");
            assert_eq!(Some(made.states[1].clone()), class.after.clone().ok());
            assert_eq!(made.cycles[0].frame.fired, class.fired);
            for (input, values) in &class.when {
                let read = made.cycles[0].choices.iter().find(|(k, _)| k == input);
                assert!(read.is_some_and(|(_, value)| values.contains(value)));
            }
        }
        // Every input held at each of its values in turn: the combinations add up.
        for (input, (lo, hi)) in bound.inputs.iter().enumerate() {
            let sizes = 0..=u32::try_from(hi - lo).expect("a range");
            let sum: u128 = sizes
                .map(|value| classes(bound, &state, &[(input as u32, value)]).combinations)
                .sum();
            assert_eq!(sum, bound.combinations(), "{}", bound.system.name);
        }
    }
}

#[test]
fn along_the_runs_that_exploring_finds_the_properties_say_what_it_says() {
    let mut kinds = BTreeSet::new();
    for task in tasks() {
        let bound = &task.bound;
        let report = explored(bound);
        for (number, judged) in report.properties.iter().enumerate() {
            let found = jump(bound, number, BOUNDS).expect("explored");
            let Some(path) = found.path else {
                assert_ne!(judged.verdict, Verdict::Violated, "{}", judged.id);
                continue;
            };
            let text = path.to_string();
            assert_eq!(Path::parse(&text), Ok(path.clone()));
            let made = walk(bound, &path).expect("the run that was found");
            assert_eq!(made.path, path, "{text}");
            let told = &live(bound, &made.cycles)[number];
            let length = made.cycles.len();
            let earlier = &live(bound, &made.cycles[..length - 1])[number];
            let form = &bound.system.properties[number].form;
            let what = format!("{} {} {text}: {told:?}", bound.system.name, judged.id);
            match (judged.verdict, form) {
                (Verdict::Violated, Form::LeadsTo { within: None, .. }) => {
                    assert!(matches!(told.standing, Standing::Pending { .. }), "{what}");
                }
                (Verdict::Violated, Form::CanAlwaysReach { .. }) => {
                    assert_eq!(told.standing, Standing::NotOne, "{what}")
                }
                (Verdict::Violated, Form::Independent { observe, of, .. }) => {
                    // The two runs differ in nothing but the inputs named, and what is observed differs at their ends.
                    let other =
                        walk(bound, &found.other.expect("two runs")).expect("the other run");
                    let ends = [&made, &other].map(|walk| {
                        let mut frame = walk.cycles[length - 1].frame.clone();
                        let mut lo = |k: usize| bound.inputs[k].0;
                        let values = observe
                            .iter()
                            .map(|k| bound.observe(*k, &mut frame, &mut lo));
                        values.collect::<Vec<i64>>()
                    });
                    assert_ne!(ends[0], ends[1], "{what}");
                    for (one, two) in made.cycles.iter().zip(&other.cycles) {
                        for (k, (a, b)) in
                            one.frame.inputs.iter().zip(&two.frame.inputs).enumerate()
                        {
                            let unread = [*a, *b].contains(&stillpoint_lang::eval::UNSET);
                            assert!(a == b || unread || of.contains(&k), "{what}");
                        }
                    }
                    kinds.insert("compared");
                }
                (Verdict::Violated, _) => {
                    assert_eq!(
                        (told.standing, told.broken),
                        (Standing::Broken, Some(length)),
                        "{what}"
                    );
                    assert_eq!(earlier.broken, None, "{what}");
                    kinds.insert("violated");
                }
                (Verdict::Reached, _) => {
                    assert_eq!(told.standing, Standing::Seen(length), "{what}");
                    kinds.insert("reached");
                }
                (_, Form::Always { when: Some(_), .. }) => {
                    assert_eq!(told.standing, Standing::Met, "{what}");
                }
                (Verdict::Holds, Form::LeadsTo { .. }) => {
                    let begun =
                        matches!(told.standing, Standing::Pending { since, .. } if since == length);
                    assert!(begun || told.standing == Standing::Met, "{what}");
                    assert!(
                        !matches!(earlier.standing, Standing::Pending { .. }),
                        "{what}"
                    );
                    kinds.insert("answered");
                }
                _ => assert_eq!(told.broken, None, "{what}"),
            }
        }
    }
    let all = ["answered", "compared", "reached", "violated"];
    assert!(kinds.iter().eq(&all), "{kinds:?}");
}

#[test]
fn the_hash_of_a_link_is_that_of_the_rules_and_values_not_of_the_texts() {
    let file = root().join("tests/must-fail/stop-b-without-timer.toml");
    let text = std::fs::read_to_string(&file).expect("readable");
    let folder =
        File::new(env!("CARGO_TARGET_TMPDIR")).join(format!("identity-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let hash = |name: &str, text: &str| {
        let file = folder.join(name);
        std::fs::write(&file, text).expect("written");
        let subject = subject::load(&file, &Readings::new()).expect("good");
        identity(&subject.tasks[0].bound)
    };
    let own = hash("own.toml", &text);
    assert_eq!(own.len(), 16);
    let words = text.replace("STOP B and A", "other words") + "\n# a remark\n";
    assert_eq!(hash("words.toml", &words), own);
    for (name, from, to) in [
        ("value.toml", "default = 2", "default = 3"),
        (
            "rule.toml",
            "level = B AND standstill",
            "level = B AND NOT standstill",
        ),
        (
            "initial.toml",
            "\"Level\", init = \"NONE\"",
            "\"Level\", init = \"A\"",
        ),
    ] {
        assert!(text.contains(from), "{from}");
        assert_ne!(hash(name, &text.replace(from, to)), own, "{name}");
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}
