//! The proof engines against the explorer: the same verdicts and the same shortest lengths, and runs that are real. A test, no proof.
//!
//! The systems are those whose reductions are compared, so that the explorer is asked once for all tests.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use stillpoint_engine::Outcome;
use stillpoint_harness::proof::{
    Choice, Engine, Every, Judged, Proof, Settings, Span, Which, judge, judge_every,
};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::Condition;
use stillpoint_lang::ir::Form;
use stillpoint_model::Verdict;
use stillpoint_tests::daily;
use stillpoint_tests::peer::each;

use super::reductions::shipped::{must_fail, shipped};
use super::reductions::{full, random, real, systems};

/// Shipped systems with more states are left to the deep test.
const MOST: u64 = 500;

/// What a system may take. Properties that are open then are counted; more than one in twenty fail the test.
const LIMIT: Duration = Duration::from_secs(10);

fn settings(choice: Choice) -> Settings {
    Settings {
        choice,
        depth: 60,
        time: Some(LIMIT),
        each: None,
        memory: None,
        ..Settings::default()
    }
}

/// What is said beside the properties.
fn named<'j>(judged: &'j [Judged], id: &str) -> Option<&'j Judged> {
    judged.iter().find(|judged| judged.id == id)
}

/// Compares what the engines say with what the explorer says; the answer tells how many properties they have decided, and how many of
/// these hold.
fn compare(bound: &Bound, whole: &Outcome, judged: &[Judged], context: &str) -> (usize, usize) {
    let mut told = (0, 0);
    let both = whole.report.properties.iter().zip(judged);
    for (k, (property, (a, b))) in bound.system.properties.iter().zip(both).enumerate() {
        let name = format!("{} of {context}", a.id);
        assert_eq!(a.id, b.id);
        if b.verdict == Verdict::Inconclusive {
            let reason = b.reason.as_deref().unwrap_or_default();
            // Of two runs only what holds is told without the explorer.
            let of_two = matches!(property.form, Form::Independent { .. });
            assert!(
                of_two || reason.contains("the limit was reached first"),
                "{name}: {reason}"
            );
            println!("{name}: open");
            continue;
        }
        // A run without an end is no shortest one.
        let endless = matches!(property.form, Form::LeadsTo { within: None, .. })
            && a.verdict == Verdict::Violated;
        assert_eq!(a.verdict, b.verdict, "{name}");
        assert!(
            endless || a.length == b.length,
            "{name}: {:?} {:?}",
            a.length,
            b.length
        );
        // Of two runs, of what can always be reached, and of runs without an end the engines tell what holds.
        let holds = matches!(
            property.form,
            Form::Independent { .. }
                | Form::CanAlwaysReach { .. }
                | Form::LeadsTo { within: None, .. }
        );
        let explored = holds && b.engine == Some(Engine::Explorer);
        if explored {
            continue;
        }
        assert!(
            matches!(
                b.engine,
                Some(Engine::Pdr | Engine::Bmc | Engine::Induction | Engine::Bdd)
            ),
            "{name}: {:?}",
            b.engine
        );
        told.0 += 1;
        told.1 += usize::from(b.verdict == Verdict::Holds);
        if let (Some(trace), Verdict::Violated | Verdict::Reached) = (&b.trace, b.verdict) {
            real(bound, k, trace, whole, &name);
        }
    }
    if let Some(Proof::Reached { states, .. }) =
        named(judged, "states").and_then(|s| s.proof.as_ref())
    {
        assert_eq!(
            *states,
            Some(u128::from(whole.report.states)),
            "states of {context}"
        );
    }
    let least = whole.report.faults.iter().filter_map(|f| f.length).min();
    let range = named(judged, "range");
    let length = range.and_then(|r| r.length);
    let open = range.is_some_and(|r| r.verdict == Verdict::Inconclusive);
    assert!(open || length == least, "ranges of {context}");
    if let Some(range) = range.filter(|_| !open) {
        let right = match least {
            Some(_) => Verdict::Violated,
            None => Verdict::Holds,
        };
        assert_eq!(
            (range.id.as_str(), range.verdict),
            ("range", right),
            "{context}"
        );
    }
    told
}

fn check(systems: &[&(Bound, Outcome)], choice: Choice) -> (usize, usize) {
    let told = each(systems, |(bound, whole)| {
        let begin = Instant::now();
        let judged = judge(bound, &settings(choice));
        let told = compare(bound, whole, &judged, &bound.system.name);
        println!(
            "{}: {} decided in {:.2} s, the explorer {:.2} s",
            bound.system.name,
            told.0,
            begin.elapsed().as_secs_f64(),
            whole.report.seconds
        );
        told
    });
    told.into_iter().fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}

/// Compares the shipped systems of at most so many states; of so many properties at least nearly all must be decided.
fn check_shipped(choice: Choice, most: u64, least: usize) {
    check_those(shipped_of(most), choice, least);
}

/// The shipped systems of at most so many states.
fn shipped_of(most: u64) -> Vec<&'static (Bound, Outcome)> {
    let all = shipped().iter();
    all.filter(|(_, whole)| whole.report.states <= most)
        .collect()
}

/// Compares these systems; of so many properties at least nearly all must be decided.
fn check_those(systems: Vec<&(Bound, Outcome)>, choice: Choice, least: usize) {
    let (decided, hold) = check(&systems, choice);
    let all = systems
        .iter()
        .flat_map(|(bound, _)| &bound.system.properties)
        .count();
    println!(
        "{} systems: {decided} of {all} decided, {hold} hold",
        systems.len()
    );
    assert!(all > least && hold * 2 > least && decided * 20 >= all * 19);
}

#[test]
fn shipped_systems_have_the_verdicts_of_the_explorer() {
    check_those(daily(shipped_of(MOST)), Choice::Auto, 50);
}

#[test]
fn sets_of_states_of_shipped_systems_are_those_of_the_explorer() {
    check_shipped(Choice::Bdd, MOST, 50);
}

#[test]
#[ignore = "deep: the larger systems too"]
fn all_shipped_systems_have_the_verdicts_of_the_explorer() {
    check_shipped(Choice::Auto, u64::MAX, 100);
}

/// One configuration after the other, and all at once: where none breaks a property it holds for all, and a run for all is one of a
/// configuration that breaks it.
#[test]
fn all_configurations_at_once_are_each_by_itself() {
    let bound = systems(COUNTDOWN).remove(0);
    let which = Which::Named(vec![Span {
        name: "t".to_owned(),
        values: None,
    }]);
    let each: Vec<Vec<Verdict>> = (0..=6)
        .map(|t| {
            let values = [("t".to_owned(), vec![t])].into();
            let one = Bound::new(bound.system.clone(), &values, &BTreeMap::new());
            let report = full(&one.expect("in its range"), true).report;
            assert_eq!(report.faults.is_empty(), t < 6);
            report.properties.iter().map(|one| one.verdict).collect()
        })
        .collect();
    let mut seen = BTreeSet::new();
    for text in ["", "t < 6", "t = 6", "t <> 6", "t <= 3", "t > 3", "t >= 1"] {
        let conditions =
            (!text.is_empty()).then(|| Condition::read(&bound.system, text).expect(text));
        let conditions: Vec<Condition> = conditions.into_iter().collect();
        let such = |t: &i64| conditions.iter().all(|c| c.holds(|_| *t));
        let all: Vec<usize> = (0..=6).filter(such).map(|t| t as usize).collect();
        let every = Every::such(&bound, &which, &conditions).expect("its parameter can be free");
        let judged = judge_every(&every, &settings(Choice::Pdr));
        for (k, judged) in judged
            .iter()
            .take(bound.system.properties.len())
            .enumerate()
        {
            let any = |verdict: Verdict| all.iter().any(|t| each[*t][k] == verdict);
            let verdict = match (any(Verdict::Violated), any(Verdict::Holds)) {
                (true, _) => Verdict::Violated,
                (false, true) => Verdict::Holds,
                (false, false) => Verdict::Vacuous,
            };
            let context = format!("{} {text}: {:?}", judged.id, judged.reason);
            assert_eq!(judged.verdict, verdict, "{context}");
            seen.insert((k, verdict == Verdict::Violated));
        }
        let range = judged.last().expect("the ranges");
        let verdict = match all.contains(&6) {
            true => Verdict::Violated,
            false => Verdict::Holds,
        };
        assert_eq!(
            (range.id.as_str(), range.verdict),
            ("range", verdict),
            "{text}"
        );
    }
    // Two of its properties hold for some values alone.
    assert_eq!(seen.len(), bound.system.properties.len() + 2);
}

/// A timer whose range, start and bound depend on a parameter. With 6 it leaves its range.
const COUNTDOWN: &str = r#"
spec   = "t"
title  = "t"
source = "t"

[machine.timer]
text      = "t"
order     = "priority"
otherwise = "stay"

[machine.timer.param]
t = { type = "INT(0..6)", default = 2 }

[machine.timer.input]
start = "BOOL"

[machine.timer.state]
left = { type = "INT(0..MIN(t, 5))", init = "MIN(t, 5)" }
on   = { type = "BOOL", init = false }

[[machine.timer.rule]]
name = "start"
note = "t"
when = "start AND NOT on"
then = "left := t; on := TRUE;"

[[machine.timer.rule]]
name = "tick"
note = "t"
when = "on AND left > 0"
then = "left := left - 1;"

[[machine.timer.rule]]
name = "end"
note = "t"
when = "on"
then = "on := FALSE;"

[system.t]
text  = "t"
cycle = "12 ms"

[system.t.instance]
timer = { machine = "timer" }

[system.t.free]
ports = ["timer.start"]

[[system.t.property]]
id     = "KEEPS"
text   = "t"
always = "timer.left <= t"

[[system.t.property]]
id       = "ENDS"
text     = "t"
when     = "timer.on AND NOT PREV(timer.on)"
leads_to = "NOT timer.on"
within   = "t + 1"

[[system.t.property]]
id       = "SOONER"
text     = "t"
when     = "timer.on AND NOT PREV(timer.on)"
leads_to = "NOT timer.on"
within   = "t"

[[system.t.property]]
id     = "SHORT"
text   = "t"
always = "timer.left < 4"
"#;

#[test]
fn must_fail_systems_have_the_shortest_runs_of_the_explorer() {
    let systems: Vec<_> = must_fail().iter().collect();
    for choice in [Choice::Auto, Choice::Bdd] {
        let (decided, _) = check(&systems, choice);
        assert!(decided > 15, "{decided} decided");
    }
}

/// Random systems by each engine; what the bounded ones leave open is no error, what they say is compared.
fn random(seeds: std::ops::Range<u64>) {
    let mut decided = [0; 3];
    let mut faulty = 0;
    for seed in seeds {
        let text = random::text(seed);
        for bound in systems(&text) {
            let whole = full(&bound, true);
            faulty += usize::from(!whole.report.faults.is_empty());
            let context = format!("seed {seed}:\n{text}");
            let judged = judge(&bound, &settings(Choice::Auto));
            decided[0] += compare(&bound, &whole, &judged, &context).0;
            let judged = judge(&bound, &settings(Choice::Bdd));
            assert!(named(&judged, "states").is_some(), "{context}");
            compare(&bound, &whole, &judged, &context);
            for (place, choice) in [(1, Choice::Induction), (2, Choice::Bmc)] {
                let judged = judge(&bound, &settings(choice));
                for (a, b) in whole.report.properties.iter().zip(&judged) {
                    if b.verdict != Verdict::Inconclusive {
                        assert_eq!((a.verdict, a.length), (b.verdict, b.length), "{context}");
                        decided[place] += 1;
                    }
                }
            }
        }
    }
    println!("{decided:?} decided, {faulty} systems with a fault");
    // k-induction with k up to the number of states decides as much; what holds is beyond bounded runs.
    assert!(decided[0] >= decided[1] && decided[1] > decided[2] && decided[2] > 0);
    assert!(faulty > 0);
}

#[test]
fn random_systems_have_the_verdicts_of_the_explorer() {
    random(0..60);
}

#[test]
#[ignore = "deep: 5000 random systems"]
fn many_random_systems_have_the_verdicts_of_the_explorer() {
    random(1000..6000);
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn most_shipped_systems_have_the_verdicts_of_the_explorer() {
        check_shipped(Choice::Auto, MOST, 50);
    }
}
