//! Pairs of runs that differ in some inputs, explored as pairs and as one system of both runs: what holds of that system holds of the pairs.

use stillpoint_engine::pairs::Claim;
use stillpoint_engine::table::Interpreted;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;
use stillpoint_lang::twice::twice;
use stillpoint_model::{Options, Verdict};
use stillpoint_tests::peer::each;

use crate::reductions::shipped::{must_fail, shipped};
use crate::reductions::{random, systems};

/// What was compared.
#[derive(Clone, Copy, Default, Debug)]
struct Compared {
    hold: usize,
    broken: usize,
    /// Held by the pairs and not shown by the system of both.
    wider: usize,
    without: usize,
}

fn compare(bound: &Bound) -> Compared {
    let mut all = Compared::default();
    let mut options = Options::default();
    options.limits.threads = 1;
    for property in &bound.system.properties {
        let Form::Independent { condition, .. } = &property.form else {
            continue;
        };
        let context = format!("{}: {}", bound.system.name, property.id);
        // Runs that begin anywhere.
        let Some(both) = twice(bound, property) else {
            all.without += 1;
            continue;
        };
        let claim = Claim {
            bound,
            property,
            options: &options,
        };
        let (one, _) = claim
            .explore_twice(&both)
            .unwrap_or_else(|e| panic!("{context}: {e}"));
        let (pairs, second) = claim
            .explore_pairs(&Interpreted::new(bound), None)
            .unwrap_or_else(|e| panic!("{context}: {e}"));
        let (a, b) = (&one.properties[0], &pairs.properties[0]);
        match (a.verdict, b.verdict) {
            (Verdict::Violated, Verdict::Holds | Verdict::Vacuous) => {
                assert!(condition.is_some(), "{context}: broken by one way only");
                all.wider += 1;
            }
            (Verdict::Violated, Verdict::Violated) => {
                assert!(a.length <= b.length, "{context}");
                assert!(second.second.is_some(), "{context}: one run only");
                all.broken += 1;
            }
            (one, pairs) => {
                assert_eq!((one, a.length), (pairs, b.length), "{context}");
                all.hold += 1;
            }
        }
        if condition.is_none() {
            assert_eq!(
                (a.verdict, a.length, one.states, one.depth),
                (b.verdict, b.length, pairs.states, pairs.depth),
                "{context}"
            );
        }
    }
    all
}

fn sum(list: Vec<Compared>) -> Compared {
    list.into_iter().fold(Compared::default(), |a, b| Compared {
        hold: a.hold + b.hold,
        broken: a.broken + b.broken,
        wider: a.wider + b.wider,
        without: a.without + b.without,
    })
}

#[test]
fn shipped_pairs_are_judged_alike() {
    let all: Vec<_> = shipped().iter().chain(must_fail()).collect();
    let all = sum(each(&all, |(bound, _)| compare(bound)));
    println!("{all:?}");
    assert!(
        all.hold >= 8 && all.broken >= 2 && all.wider == 0,
        "{all:?}"
    );
}

#[test]
fn random_pairs_are_judged_alike() {
    let seeds: Vec<u64> = (0..1500).collect();
    let all = each(&seeds, |seed| {
        sum(systems(&random::text(*seed)).iter().map(compare).collect())
    });
    let all = sum(all);
    println!("{all:?}");
    assert!(all.hold >= 100 && all.broken >= 5, "{all:?}");
}

/// A condition over the state: the input may differ while it holds in both runs. In the system of both it does not hold in the second run
/// after the first cycle, and the runs go on, so that more is broken there.
#[test]
fn what_only_the_system_of_both_breaks_is_no_violation() {
    let bound = systems(LATCH).remove(0);
    let all = compare(&bound);
    assert_eq!((all.hold, all.broken, all.wider), (0, 0, 1), "{all:?}");
    let whole = stillpoint_engine::run(&bound, &Options::default(), true, &mut ());
    let whole = whole.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(whole.report.properties[0].verdict, Verdict::Holds);
}

const LATCH: &str = r#"
spec   = "t"
title  = "t"
source = "t"

[machine.latch]
text      = "t"
order     = "priority"
otherwise = "stay"

[machine.latch.input]
set = "BOOL"

[machine.latch.state]
on    = { type = "BOOL", init = false }
later = { type = "BOOL", init = false }

[[machine.latch.rule]]
name = "step"
note = "t"
when = "TRUE"
then = "later := later OR on; on := set;"

[system.s]
text  = "t"
cycle = "10 ms"

[system.s.instance]
latch = { machine = "latch" }

[system.s.free]
ports = ["latch.set"]

[[system.s.property]]
id      = "P"
text    = "while it stays off the input changes nothing: where it is on in one run only, the inputs were the same"
observe = ["latch.later"]
of      = ["latch.set"]
while   = "NOT latch.on"
"#;
