//! The proof engines against the explorer: the same verdicts and the same shortest lengths, and runs that are real. A test, no proof.
//!
//! The systems are those whose reductions are compared, so that the explorer is asked once for all tests.

use std::time::{Duration, Instant};

use stillpoint_engine::Outcome;
use stillpoint_harness::proof::{Choice, Engine, Judged, Settings, has_engine, judge};
use stillpoint_lang::bind::Bound;
use stillpoint_model::Verdict;
use stillpoint_tests::peer::each;

use super::reductions::shipped::{must_fail, shipped};
use super::reductions::{full, random, real, systems};

/// What a system may take. Properties that are open then are counted; more than one in twenty fail the test.
const LIMIT: Duration = Duration::from_secs(10);

fn settings(choice: Choice) -> Settings {
    Settings {
        choice,
        depth: 60,
        time: Some(LIMIT),
        memory: None,
        threads: 1,
        interrupt: None,
    }
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
            assert!(
                reason.contains("the limit was reached first"),
                "{name}: {reason}"
            );
            println!("{name}: open");
            continue;
        }
        assert_eq!((a.verdict, a.length), (b.verdict, b.length), "{name}");
        if !has_engine(&property.form) {
            assert_eq!(b.engine, Some(Engine::Explorer), "{name}");
            continue;
        }
        assert!(
            matches!(
                b.engine,
                Some(Engine::Pdr | Engine::Bmc | Engine::Induction)
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
    let least = whole.report.faults.iter().filter_map(|f| f.length).min();
    let range = judged.get(bound.system.properties.len());
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

fn check(systems: &[(Bound, Outcome)], choice: Choice) -> (usize, usize) {
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

#[test]
fn shipped_systems_have_the_verdicts_of_the_explorer() {
    let (decided, hold) = check(shipped(), Choice::Auto);
    let properties = shipped()
        .iter()
        .flat_map(|(bound, _)| &bound.system.properties);
    let all = properties.filter(|p| has_engine(&p.form)).count();
    println!("{decided} of {all} decided, {hold} hold");
    assert!(all > 100 && hold > 50 && decided * 20 >= all * 19);
}

#[test]
fn must_fail_systems_have_the_shortest_runs_of_the_explorer() {
    let (decided, _) = check(must_fail(), Choice::Auto);
    assert!(decided > 15, "{decided} decided");
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
    random(0..150);
}

#[test]
#[ignore = "deep: 5000 random systems"]
fn many_random_systems_have_the_verdicts_of_the_explorer() {
    random(1000..6000);
}
