//! Table against monitor: the same outputs in every reachable pair, and each deliberately wrong monitor is found.

use std::collections::BTreeSet;

use stillpoint::diff::random::Random;
use stillpoint::diff::{Compared, Pairing, exhaustive, pairings, peer, sample, to_json};
use stillpoint::subject::{self, Readings};
use stillpoint_model::Options;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_tests::root;

fn all() -> Vec<Pairing> {
    let path = root().join("spec/sinumerik-840d/axis.toml");
    let subject = subject::load(&path, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    pairings(&subject).unwrap_or_else(|e| panic!("{e}"))
}

fn explore(pairing: &Pairing) -> Compared {
    let options = Options {
        witnesses: false,
        ..Options::default()
    };
    exhaustive(pairing, None, &options, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn no_reachable_pair_differs() {
    let compared: Vec<Compared> = all().iter().map(explore).collect();
    let machines: BTreeSet<&str> = compared.iter().map(|c| c.machine.as_str()).collect();
    assert_eq!(
        machines,
        peer::MACHINES.into_iter().collect(),
        "every machine that has a monitor"
    );
    for one in &compared {
        assert!(
            one.divergence.is_none(),
            "{}: {}",
            one.machine,
            one.divergence.as_ref().expect("it").text()
        );
        assert!(
            one.complete && one.pairs > 0 && one.cycles > 0 && one.outputs >= one.cycles,
            "{one:?}"
        );
    }
    let json = to_json(&compared, None);
    assert_eq!(json["divergences"], 0);
    assert_eq!(json["complete"], true);
    assert!(
        json["pairs"].as_u64() > Some(0) && json["outputs_compared"].as_u64() > Some(0),
        "{json}"
    );
}

#[test]
fn every_wrong_monitor_is_found_by_exploration() {
    let pairings = all();
    assert!(Mutant::ALL.len() >= 17);
    for mutant in Mutant::ALL {
        // The first word of a mutant's name is its machine; the search ends with the first difference.
        let mut concerned = pairings
            .iter()
            .filter(|p| mutant.name().starts_with(&format!("{}-", p.machine)));
        let options = Options {
            witnesses: false,
            stop_when_decided: true,
            ..Options::default()
        };
        let found = concerned.find_map(|p| {
            exhaustive(p, Some(*mutant), &options, &mut ())
                .unwrap_or_else(|e| panic!("{e}"))
                .divergence
        });
        let Some(diagram) = found else {
            panic!("{mutant:?} survives")
        };
        let text = diagram.text();
        assert!(
            text.contains("cycle") && text.contains('^'),
            "{mutant:?}: no diagram with a mark\n{text}"
        );
    }
}

/// Random runs over all machines, as the command makes them.
fn random(pairings: &[Pairing], mutant: Option<Mutant>, cycles: u64, seed: u64) -> Vec<Compared> {
    let mut random = Random::new(seed);
    let share = cycles.div_ceil(pairings.len() as u64);
    pairings
        .iter()
        .map(|p| sample(p, mutant, share, &mut random).unwrap_or_else(|e| panic!("{e}")))
        .collect()
}

#[test]
fn random_runs_find_no_difference_and_repeat() {
    let pairings = all();
    let once = random(&pairings, None, 200_000, 3);
    for one in &once {
        assert!(
            one.divergence.is_none(),
            "{}",
            one.divergence.as_ref().expect("it").text()
        );
    }
    let cycles: u128 = once.iter().map(|c| c.cycles).sum();
    assert!(cycles >= 200_000, "{cycles}");
    let twice = random(&pairings, None, 200_000, 3);
    assert_eq!(to_json(&once, Some(3)), to_json(&twice, Some(3)));
}

#[test]
fn random_runs_find_most_wrong_monitors_and_repeat() {
    let pairings = all();
    let mut survivors = Vec::new();
    for mutant in Mutant::ALL {
        let found = random(&pairings, Some(*mutant), 200_000, 3);
        if found.iter().all(|c| c.divergence.is_none()) {
            survivors.push(*mutant);
        } else if survivors.len() < 2 {
            let again = random(&pairings, Some(*mutant), 200_000, 3);
            assert_eq!(
                to_json(&found, Some(3)),
                to_json(&again, Some(3)),
                "{mutant:?}"
            );
        }
    }
    assert!(survivors.len() <= 5, "random runs miss {survivors:?}");
}
