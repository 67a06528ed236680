//! Table against monitor: the same outputs in every reachable pair, and each deliberately wrong monitor is found.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use stillpoint_engine::subject::{self, Readings};
use stillpoint_harness::diff::pairing::vary;
use stillpoint_harness::diff::product::Product;
use stillpoint_harness::diff::random::Random;
use stillpoint_harness::diff::slices::slices;
use stillpoint_harness::diff::{
    Compared, Pairing, bytes, exhaustive, pairings, peer, sample, to_json,
};
use stillpoint_harness::families;
use stillpoint_model::{Options, Until};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_show::diagram::Diagram;
use stillpoint_tests::peer::each;
use stillpoint_tests::{daily, exceptions, root};

/// The tables compared: those of a machine, or with the parameters of their systems. What several files use is compared with
/// the parameters of the first one, so the file of a machine's own table stands before those that put it together with others.
const FILES: [&[&str]; 4] = [OTHERS, SINAMICS_FUNCTIONS, SINAMICS_CONTROL, IEC];

/// The functions of a drive of the family sinamics-s120.
const SINAMICS_FUNCTIONS: &[&str] = &[
    "spec/families/sinamics-s120/sto.toml",
    "spec/families/sinamics-s120/ss1-basic.toml",
    "spec/families/sinamics-s120/ss1.toml",
    "spec/families/sinamics-s120/sbc.toml",
    "spec/families/sinamics-s120/ss2.toml",
    "spec/families/sinamics-s120/sos.toml",
    "spec/families/sinamics-s120/sam.toml",
    "spec/families/sinamics-s120/sbr.toml",
    "spec/families/sinamics-s120/sls.toml",
    "spec/families/sinamics-s120/sls-ramp.toml",
    "spec/families/sinamics-s120/ssm.toml",
    "spec/families/sinamics-s120/sdi.toml",
    "spec/families/sinamics-s120/slp.toml",
    "spec/families/sinamics-s120/referencing.toml",
    "spec/families/sinamics-s120/sp.toml",
    "spec/families/sinamics-s120/actual-value.toml",
    "spec/families/sinamics-s120/gear.toml",
    "spec/families/sinamics-s120/setpoint-limit.toml",
    "spec/families/sinamics-s120/encoderless.toml",
    "spec/families/sinamics-s120/start-phase.toml",
    "spec/families/sinamics-s120/drive-test.toml",
    "spec/families/sinamics-s120/sbt.toml",
];

/// Their control and their telegrams.
const SINAMICS_CONTROL: &[&str] = &[
    "spec/families/sinamics-s120/terminals.toml",
    "spec/families/sinamics-s120/cross-check.toml",
    "spec/families/sinamics-s120/sto.toml",
    "spec/families/sinamics-s120/inputs.toml",
    "spec/families/sinamics-s120/acknowledgement.toml",
    "spec/families/sinamics-s120/arbiter.toml",
    "spec/families/sinamics-s120/restart.toml",
    "spec/families/sinamics-s120/communication.toml",
    "spec/families/sinamics-s120/io-test.toml",
    "spec/families/sinamics-s120/buffer.toml",
    "spec/families/sinamics-s120/acceptance-mode.toml",
    "spec/families/sinamics-s120/commissioning.toml",
    "spec/families/sinamics-s120/enabling.toml",
    "spec/families/sinamics-s120/words.toml",
];

/// Functions of IEC 61800-5-2.
const IEC: &[&str] = &[
    "spec/families/iec-61800-5-2/window.toml",
    "spec/families/iec-61800-5-2/motor-temperature.toml",
    "spec/families/iec-61800-5-2/cam.toml",
    "spec/families/iec-61800-5-2/increment.toml",
];

/// The other families.
const OTHERS: &[&str] = &[
    "spec/families/sinumerik-840d/axis.toml",
    "spec/families/sinumerik-840d/bus.toml",
    "spec/families/sinumerik-840d/setpoint.toml",
    "spec/families/sinumerik-840d/profisafe.toml",
    "spec/families/sinumerik-840d/brake-test.toml",
    "spec/families/sinumerik-840d/brake-control.toml",
    "spec/families/sinumerik-840d/acceptance-mode.toml",
    "spec/families/sinumerik-840d/alarm-display.toml",
    "spec/families/sinumerik-840d/comparison-signals.toml",
    "spec/families/sinumerik-840d/esr.toml",
    "spec/machines/milling-840d.toml",
    "spec/families/sinumerik-840d/relay.toml",
    "spec/families/sinumerik-840d/spl.toml",
    "spec/families/sinumerik-840d/spl-communication.toml",
    "spec/families/sinumerik-840d/spl-start.toml",
    "spec/families/sinumerik-840d/spl-test.toml",
    "spec/families/heidenhain-fs/stop.toml",
    "spec/families/heidenhain-fs/group.toml",
    "spec/families/heidenhain-fs/interface.toml",
    "spec/families/heidenhain-fs/compared.toml",
    "spec/families/heidenhain-fs/mode.toml",
    "spec/families/heidenhain-fs/monitors.toml",
    "spec/families/heidenhain-fs/operation.toml",
    "spec/families/heidenhain-fs/outputs.toml",
    "spec/families/heidenhain-fs/reference.toml",
    "spec/families/heidenhain-fs/selftest.toml",
    "spec/families/heidenhain-fs/cutout.toml",
    "spec/families/heidenhain-fs/status-bits.toml",
    "spec/families/heidenhain-fs/fields.toml",
    "spec/families/heidenhain-fs/link.toml",
    "spec/families/heidenhain-fs/splc.toml",
    "spec/families/heidenhain-fs/doors.toml",
    "spec/families/heidenhain-fs/faults.toml",
    "spec/families/srm-fblocks/position.toml",
    "spec/families/srm-fblocks/safe-pos.toml",
    "spec/families/srm-fblocks/slp.toml",
    "spec/families/srm-fblocks/endzone.toml",
    "spec/families/srm-fblocks/interpolation.toml",
    "spec/families/srm-fblocks/sbr.toml",
    "spec/families/srm-fblocks/brake.toml",
    "spec/families/srm-fblocks/brake-start.toml",
    "spec/families/srm-fblocks/load.toml",
    "spec/families/srm-fblocks/calibration.toml",
    "spec/families/srm-fblocks/math.toml",
    "spec/families/srm-fblocks/parameters.toml",
];

/// What has a monitor: the names of family and machine or system. Families use the same names for different machines.
type Name = (&'static str, String);

fn name(pairing: &Pairing) -> Name {
    let family = families::of_table(&pairing.bound.system.name).expect("a family with monitors");
    (family.name, pairing.machine.clone())
}

/// Everything that has a monitor: with the parameters of the systems of the first file that has it, else with those of the
/// milling machine or its own default ones.
static ALL: LazyLock<Vec<Pairing>> = LazyLock::new(|| {
    let mut all: Vec<Pairing> = Vec::new();
    for file in FILES.concat() {
        let subject =
            subject::load(&root().join(file), &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
        let more = pairings(&subject).unwrap_or_else(|e| panic!("{e}"));
        let known: BTreeSet<Name> = all.iter().map(name).collect();
        all.extend(more.into_iter().filter(|p| !known.contains(&name(p))));
    }
    all
});

/// Whether it is both channels of an axis: the test `pair` explores those.
fn both_channels(name: &str) -> bool {
    name.starts_with("pair_")
}

/// What is explored: the machines alone, and the slices of what is composed of several.
static PIECES: LazyLock<Vec<Pairing>> = LazyLock::new(|| {
    let pieces = ALL
        .iter()
        .filter(|p| !both_channels(&p.machine))
        .flat_map(|p| slices(p).unwrap_or_else(|e| panic!("{e}")));
    // Systems that differ only in parameters that a slice sets have it in common.
    let mut all: Vec<Pairing> = Vec::new();
    for piece in pieces {
        let same = |p: &Pairing| {
            name(p) == name(&piece) && p.held == piece.held && p.bound.values == piece.bound.values
        };
        if !all.iter().any(same) {
            all.push(piece);
        }
    }
    all
});

/// Explores a piece. There are many of them, so each has one thread.
fn explore(piece: &Pairing, mutant: Option<Mutant>) -> Compared {
    let mut options = Options {
        witnesses: false,
        until: match mutant {
            Some(_) => Until::Decided,
            None => Until::Complete,
        },
        ..Options::default()
    };
    options.limits.threads = 1;
    exhaustive(piece, mutant, &options, &mut ()).unwrap_or_else(|e| panic!("{e}"))
}

/// The machines and systems that a mutant is one of; none where no table states what its monitor does, so that only its contract
/// finds it.
fn machines(mutant: Mutant) -> BTreeSet<Name> {
    let family = families::of_mutant(mutant).expect("a family with monitors");
    // Both channels are compared in parts of their own: see the test `pair`.
    if mutant.monitor == "pair" || exceptions("uncompared").contains(mutant.name) {
        return BTreeSet::new();
    }
    let names = family.peers.machines().chain(family.peers.systems());
    let found: BTreeSet<Name> = names
        .filter(|(_, module)| *module == mutant.monitor)
        .map(|(machine, _)| (family.name, machine.to_owned()))
        .collect();
    let monitor = format!("{}/{}", family.name, mutant.monitor);
    assert!(
        found.is_empty() == exceptions("monitors").contains(&monitor),
        "{mutant:?} is one of no machine that is compared"
    );
    found
}

/// The wrong monitors that are compared with tables, and the names of those.
fn mutants() -> impl Iterator<Item = (Mutant, BTreeSet<Name>)> {
    families::mutants()
        .map(|mutant| (mutant, machines(mutant)))
        .filter(|(_, machines)| !machines.is_empty())
}

/// Compares pieces in every reachable pair.
fn no_difference(pieces: &[Pairing]) {
    let compared = each(pieces, |piece| explore(piece, None));
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

/// The pieces that are exceptions, or all others.
fn pieces(excepted: bool) -> Vec<Pairing> {
    let exceptions = exceptions("reachable pairs");
    let known = |p: &Pairing| {
        let (family, machine) = name(p);
        exceptions.contains(&format!("{family}/{machine}"))
    };
    let chosen = PIECES.iter().filter(|p| known(p) == excepted).cloned();
    let chosen: Vec<Pairing> = chosen.collect();
    if excepted {
        let names: BTreeSet<Name> = chosen.iter().map(name).collect();
        assert_eq!(names.len(), exceptions.len(), "{exceptions:?}");
    }
    chosen
}

#[test]
fn the_sequence_of_random_numbers_is_fixed() {
    let mut random = Random::new(42);
    assert_eq!(random.draw(), 13_679_457_532_755_275_413);
    let mut counts = [0; 5];
    for _ in 0..5000 {
        counts[random.below(5)] += 1;
    }
    assert!(counts.iter().all(|n| (850..1150).contains(n)), "{counts:?}");
}

#[test]
fn no_reachable_pair_differs() {
    let known = families::FAMILIES.iter().flat_map(|family| {
        let names = family.peers.machines().chain(family.peers.systems());
        names
            .filter(|(machine, _)| !both_channels(machine))
            .map(|(machine, _)| (family.name, machine.to_owned()))
    });
    assert_eq!(
        PIECES.iter().map(name).collect::<BTreeSet<_>>(),
        known.collect(),
        "everything that has a monitor"
    );
    no_difference(&daily(pieces(false)));
}

/// Random runs and the contracts compare them in the daily run too.
#[test]
#[ignore = "deep: a minute"]
fn no_reachable_pair_of_the_large_ones_differs() {
    no_difference(&pieces(true));
}

/// What exploration says about the wrong monitors that are exceptions, or about all others.
fn explored(excepted: bool) -> Vec<(Mutant, Option<Diagram>)> {
    let exceptions = exceptions("mutants");
    let chosen: Vec<(Mutant, BTreeSet<Name>)> = mutants()
        .filter(|(mutant, _)| exceptions.contains(mutant.name) == excepted)
        .collect();
    assert!(
        !excepted || chosen.len() == exceptions.len(),
        "{exceptions:?}"
    );
    each(&chosen, |(mutant, machines)| {
        let mut concerned = PIECES.iter().filter(|p| machines.contains(&name(p)));
        let found = concerned.find_map(|piece| explore(piece, Some(*mutant)).divergence);
        (*mutant, found)
    })
}

/// Random runs and the contracts find each of them in the daily run too.
#[test]
#[ignore = "deep: minutes"]
fn every_wrong_monitor_is_found_by_exploration() {
    let names: BTreeSet<&str> = families::mutants().map(|mutant| mutant.name).collect();
    assert_eq!(
        names.len(),
        families::mutants().count(),
        "a name is given once"
    );
    for (mutant, diagram) in explored(false) {
        let diagram = diagram.unwrap_or_else(|| panic!("{mutant:?} survives"));
        let text = diagram.text();
        assert!(
            text.contains("cycle") && text.contains('^'),
            "{mutant:?}: no diagram with a mark\n{text}"
        );
    }
}

/// Those that need other parameters than the default ones: random runs find them like all others.
#[test]
#[ignore = "deep: minutes"]
fn every_wrong_monitor_that_is_an_exception_survives_exploration() {
    for (mutant, diagram) in explored(true) {
        assert!(diagram.is_none(), "{mutant:?} is no exception any more");
    }
    for name in exceptions("uncompared") {
        let mutant = peer::mutant(&name).unwrap_or_else(|e| panic!("{name}: {e}"));
        let family = families::of_mutant(mutant).expect("a family with monitors");
        let all = family.peers.machines();
        let all = all.filter(|(_, module)| *module == mutant.monitor);
        let all = all.map(|(machine, _)| (family.name, machine.to_owned()));
        assert!(
            !differs(mutant, &all.collect()),
            "{mutant:?} is no exception any more"
        );
    }
}

/// Whether random runs of the machines of a mutant find it.
fn differs(mutant: Mutant, machines: &BTreeSet<Name>) -> bool {
    let concerned: Vec<Pairing> = ALL
        .iter()
        .filter(|p| machines.contains(&name(p)))
        .cloned()
        .collect();
    let found = sample(&concerned, Some(mutant), 4_000_000, 3, 0, &|_, _| ())
        .unwrap_or_else(|e| panic!("{e}"));
    found.iter().any(|c| c.divergence.is_some())
}

#[test]
fn random_runs_find_no_difference_and_repeat() {
    let runs = |threads| {
        sample(&ALL, None, 3_000_000, 3, threads, &|_, _| ()).unwrap_or_else(|e| panic!("{e}"))
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

/// Parameters of functions that a system leaves out: the override and the limit frequency.
fn left_out(machine: &str, param: &str) -> bool {
    let factor = param
        .strip_prefix("f_")
        .is_some_and(|n| n.parse::<u8>().is_ok());
    (both_channels(machine) && (factor || param == "encoder_max"))
        || (machine == "axis_core" && param == "encoder_max")
}

/// A parameter of a table that its monitor never hears of makes both differ for a reason that is none, or hides one.
#[test]
fn every_parameter_of_a_table_reaches_its_monitor() {
    let mut random = Random::new(1);
    let mut found = BTreeSet::new();
    for pairing in ALL.iter() {
        let mut unread = peer::unread(&pairing.machine, &pairing.bound);
        for _ in 0..40 {
            if let Some(other) = vary(pairing, &mut random) {
                let now = peer::unread(&other.machine, &other.bound);
                unread.retain(|name| now.contains(name));
            }
        }
        let (family, machine) = name(pairing);
        unread.retain(|param| !left_out(&machine, param));
        let names = unread
            .into_iter()
            .map(|p| format!("{family}/{machine}/{p}"));
        found.extend(names);
    }
    assert_eq!(found, exceptions("differential"));
}

/// What the fuzz target does with its bytes: the production monitors agree, a wrong one is found.
#[test]
fn runs_described_by_bytes_find_a_wrong_monitor() {
    let pairing = ALL
        .iter()
        .find(|p| name(p) == ("sinumerik-840d", "stop".to_owned()))
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
    let wrong = peer::mutant("stop-lower-displaces").expect("its name");
    assert!(found(Some(wrong)));
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn no_pair_differs_but_perhaps_of_the_large_ones() {
        no_difference(&pieces(false));
    }

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn random_runs_find_every_wrong_monitor() {
        let missed: BTreeSet<String> = mutants()
            .filter(|(mutant, machines)| !differs(*mutant, machines))
            .map(|(mutant, _)| mutant.name.to_owned())
            .collect();
        assert!(missed.is_empty(), "random runs miss {missed:?}");
    }
}
