//! Table against monitor: the same outputs in every reachable pair, and each deliberately wrong monitor is found.

use std::collections::BTreeSet;

use stillpoint::diff::product::Product;
use stillpoint::diff::random::Random;
use stillpoint::diff::slices::slices;
use stillpoint::diff::{Compared, Pairing, bytes, exhaustive, pairings, peer, sample, to_json};
use stillpoint::subject::{self, Readings};
use stillpoint_model::Options;
use stillpoint_monitors::sinumerik::mutant::Mutant as Sinumerik;
use stillpoint_tests::root;

/// Everything that has a monitor: with the parameters of the systems of `axis.toml`, else with those of the milling machine
/// or its own default ones.
fn all() -> Vec<Pairing> {
    let mut all: Vec<Pairing> = Vec::new();
    for file in [
        "spec/sinumerik-840d/axis.toml",
        "spec/machines/milling-840d.toml",
    ] {
        let subject =
            subject::load(&root().join(file), &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
        let more = pairings(&subject).unwrap_or_else(|e| panic!("{e}"));
        let known: BTreeSet<String> = all.iter().map(|p| p.machine.clone()).collect();
        all.extend(more.into_iter().filter(|p| !known.contains(&p.machine)));
    }
    all
}

/// What is explored: the machines alone, and the slices of what is composed of several.
fn pieces() -> Vec<Pairing> {
    let pieces = all()
        .into_iter()
        .flat_map(|p| slices(&p).unwrap_or_else(|e| panic!("{e}")));
    pieces.collect()
}

fn explore(pairing: &Pairing) -> Compared {
    let options = Options {
        witnesses: false,
        ..Options::default()
    };
    exhaustive(pairing, None, &options, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

/// The machine that a mutant is one of: the first words of its name are its module.
fn machine(mutant: Mutant) -> &'static str {
    let family = mutant.family();
    let names = family.machines.iter().chain(family.systems);
    let prefix = |module: &str| format!("{}-", module.replace('_', "-"));
    names
        .filter(|(_, module)| mutant.name().starts_with(&prefix(module)))
        .max_by_key(|(_, module)| module.len())
        .map(|(machine, _)| *machine)
        .unwrap_or_else(|| panic!("{mutant:?} is one of no machine that is compared"))
}

#[test]
fn no_reachable_pair_differs() {
    let compared: Vec<Compared> = pieces().iter().map(explore).collect();
    let machines: BTreeSet<&str> = compared.iter().map(|c| c.machine.as_str()).collect();
    let families = peer::FAMILIES.iter();
    let known = families.flat_map(|family| family.machines.iter().chain(family.systems));
    assert_eq!(
        machines,
        known.map(|(name, _)| *name).collect(),
        "everything that has a monitor"
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
    let pairings = pieces();
    assert!(Mutant::all().count() >= 17);
    let mut survivors = Vec::new();
    for mutant in Mutant::all() {
        let machine = machine(mutant);
        let mut concerned = pairings.iter().filter(|p| p.machine == machine);
        let options = Options {
            witnesses: false,
            stop_when_decided: true,
            ..Options::default()
        };
        let found = concerned.find_map(|p| {
            exhaustive(p, Some(mutant), &options, &mut ())
                .unwrap_or_else(|e| panic!("{e}"))
                .divergence
        });
        let Some(diagram) = found else {
            survivors.push(mutant);
            continue;
        };
        let text = diagram.text();
        assert!(
            text.contains("cycle") && text.contains('^'),
            "{mutant:?}: no diagram with a mark\n{text}"
        );
    }
    // Those that need other parameters than the default ones: random runs have them.
    for mutant in survivors {
        assert!(differs(&all(), mutant), "{mutant:?} survives");
    }
}

/// Whether random runs of the machine of a mutant find it.
fn differs(pairings: &[Pairing], mutant: Mutant) -> bool {
    let machine = machine(mutant);
    let concerned: Vec<Pairing> = pairings
        .iter()
        .filter(|p| p.machine == machine)
        .cloned()
        .collect();
    let found = sample(&concerned, Some(mutant), 400_000, 3, 0, &|_, _| ())
        .unwrap_or_else(|e| panic!("{e}"));
    found.iter().any(|c| c.divergence.is_some())
}

#[test]
fn random_runs_find_no_difference_and_repeat() {
    let pairings = all();
    let runs = |threads| {
        sample(&pairings, None, 3_000_000, 3, threads, &|_, _| ()).unwrap_or_else(|e| panic!("{e}"))
    };
    let once = runs(1);
    for one in &once {
        assert!(
            one.divergence.is_none(),
            "{}: {:?}\n{}",
            one.machine,
            one.params,
            one.divergence.as_ref().expect("it").text()
        );
    }
    let cycles: u128 = once.iter().map(|c| c.cycles).sum();
    assert!(cycles >= 3_000_000, "{cycles}");
    assert_eq!(
        to_json(&once, Some(3)),
        to_json(&runs(3), Some(3)),
        "the number of threads does not matter"
    );
}

#[test]
fn random_runs_find_every_wrong_monitor() {
    let pairings = all();
    for mutant in Mutant::all() {
        assert!(differs(&pairings, mutant), "random runs miss {mutant:?}");
    }
}

/// What the fuzz target does with its bytes: the production monitors agree, a wrong one is found.
#[test]
fn runs_described_by_bytes_find_a_wrong_monitor() {
    let pairings = all();
    let pairing = pairings
        .iter()
        .find(|p| p.machine == "stop")
        .expect("the machine");
    let mut random = Random::new(5);
    let strings: Vec<Vec<u8>> = (0..400)
        .map(|_| (0..120).map(|_| random.below(256) as u8).collect())
        .collect();
    let found = |mutant| {
        let monitor = peer::peer("stop", &pairing.bound, mutant)
            .expect("the parameters fit")
            .expect("a monitor");
        let product = Product::new(&pairing.bound, monitor.as_ref()).expect("both sides fit");
        let inputs = pairing.bound.inputs.len();
        strings
            .iter()
            .any(|data| bytes::run(&product, inputs, data).is_some())
    };
    assert!(!found(None));
    assert!(found(Some(Mutant::Sinumerik(
        Sinumerik::StopLowerDisplaces
    ))));
}
