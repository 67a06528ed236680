//! The theorems of the families: they belong to the tables, are proved again, and are cited only where they are true of what is explored.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

use stillpoint_certify::format::Verdict as CertifiedVerdict;
use stillpoint_certify::proof::duty::Measure;
use stillpoint_certify::proof::format::{System as Certificate, theorems_text};
use stillpoint_certify::proof::read::read_theorems;
use stillpoint_engine::label;
use stillpoint_engine::theorems::{OfSystem, Proved, RANGE, Theorems};
use stillpoint_harness::proof::{Every, Settings, judge_every};
use stillpoint_harness::theorems::certificates::{Certificates, check as check_certificates};
use stillpoint_harness::theorems::{Proving, Ranges, is_more, prints, prove, ranges, systems};
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::Condition;
use stillpoint_model::Verdict;
use stillpoint_model::proof::Budget;
use stillpoint_tests::peer::each;
use stillpoint_tests::{daily, root};

/// Theorems that took longer together, in seconds, are proved again by the deep test.
const QUICK: f64 = 1.0;

pub(super) const FAMILIES: [&str; 4] = [
    "sinumerik-840d",
    "heidenhain-fs",
    "sinamics-s120",
    "srm-fblocks",
];

pub(super) fn folder(family: &str) -> PathBuf {
    root().join("spec/families").join(family)
}

pub(super) fn theorems(family: &str) -> Theorems {
    Theorems::load(&folder(family)).unwrap_or_else(|e| panic!("{e}"))
}

pub(super) fn bound(file: &Path, name: &str) -> Bound {
    let spec = Spec::load(file).unwrap_or_else(|e| panic!("{e}"));
    let system = spec.system(name, None).unwrap_or_else(|e| panic!("{e}"));
    Bound::new(system, &BTreeMap::new(), &BTreeMap::new()).expect("the defaults fit")
}

/// The systems of a family's machines with their defaults.
pub(super) fn explored(family: &str) -> Vec<Bound> {
    let list = systems(&folder(family)).unwrap_or_else(|e| panic!("{e}"));
    list.iter().map(|(file, name)| bound(file, name)).collect()
}

#[test]
fn every_theorem_belongs_to_its_tables() {
    for family in FAMILIES {
        let known = theorems(family);
        let mut names = BTreeSet::new();
        for bound in explored(family) {
            let system = &bound.system;
            let renew = format!(
                "{}: cargo run --release -- theorems spec/families/{family} --prove",
                system.name
            );
            names.insert(system.name.clone());
            let own = known.systems.get(&system.name).expect(&renew);
            let proved = own.proved.iter().flat_map(|proved| &proved.holds);
            let told: BTreeMap<String, String> = proved
                .chain(&own.open)
                .map(|(key, value)| (key.clone(), value.clone()))
                .collect();
            assert_eq!(told, prints(system), "{renew}");
            let readings: BTreeMap<_, _> = bound.readings().into_iter().collect();
            assert_eq!(own.readings, readings, "{renew}");
        }
        let told: BTreeSet<String> = known.systems.keys().cloned().collect();
        assert_eq!(told, names, "{family}");
    }
}

fn conditions(bound: &Bound, proved: &Proved) -> Vec<Condition> {
    let read = |text: &String| Condition::read(&bound.system, text);
    let list = proved.conditions.iter().map(read).collect::<Result<_, _>>();
    list.unwrap_or_else(|why| panic!("{}: {why}", bound.system.name))
}

/// Proves the theorems of some systems again; the answer is how many there were.
fn prove_again(wanted: impl Fn(&Proved) -> bool + Sync, time: Duration) -> usize {
    let mut work = Vec::new();
    for family in FAMILIES {
        let known = theorems(family);
        for bound in explored(family) {
            let own = known.systems.get(&bound.system.name);
            let proved = own.into_iter().flat_map(|own| own.proved.clone());
            work.extend(proved.filter(&wanted).map(|proved| (bound.clone(), proved)));
        }
    }
    let counts = each(&work, |(bound, proved)| {
        let mut bound = bound.clone();
        let asked = |id: &String| proved.holds.contains_key(id);
        bound.system.properties.retain(|p| asked(&label(p)));
        let which = ranges(&bound, &proved.within);
        let such = conditions(&bound, proved);
        let every = Every::such(&bound, &which, &such).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(every.text(), proved.every, "{}", bound.system.name);
        let settings = Settings {
            each: Some(time),
            ranges: asked(&RANGE.to_owned()),
            ..Settings::default()
        };
        let judged = judge_every(&every, &settings);
        for one in &judged {
            if asked(&one.id) {
                let context = format!("{} of {}: {:?}", one.id, bound.system.name, one.reason);
                assert_eq!(one.verdict, Verdict::Holds, "{context}");
            }
        }
        proved.holds.len()
    });
    counts.into_iter().sum()
}

#[test]
fn quick_theorems_are_proved_again() {
    let count = prove_again(|proved| proved.seconds < QUICK, Duration::from_secs(60));
    println!("{count} proved again");
    assert!(count >= 50, "{count}");
}

#[test]
#[ignore = "deep: all theorems, a quarter of an hour"]
fn all_theorems_are_proved_again() {
    let count = prove_again(|_| true, Duration::from_secs(600));
    println!("{count} proved again");
}

/// A system with its theorems, and the certificates of them.
type Shown = (Bound, OfSystem, Vec<Certificate>);

/// Every system that has theorems.
fn shown() -> Vec<Shown> {
    let mut work = Vec::new();
    for family in FAMILIES {
        let known = theorems(family);
        let certificates = Certificates::load(&folder(family)).unwrap_or_else(|e| panic!("{e}"));
        let proved = known
            .systems
            .iter()
            .filter(|(_, own)| !own.proved.is_empty());
        let names: BTreeSet<&String> = proved.map(|(name, _)| name).collect();
        assert_eq!(names, certificates.systems.keys().collect(), "{family}");
        for bound in explored(family) {
            let own = known.systems[&bound.system.name].clone();
            let shown = certificates.systems.get(&bound.system.name);
            let shown = shown.cloned().unwrap_or_default();
            work.push((bound, own, shown));
        }
    }
    work
}

/// The checker confirms each of these; the answer is how many theorems there were.
fn confirmed(work: &[Shown]) -> usize {
    let counts = each(work, |(bound, own, shown)| {
        let found = check_certificates(bound, own, shown, &Budget::default());
        let found = found.unwrap_or_else(|what| panic!("{}: {what}", bound.system.name));
        assert_eq!(found.other, 0, "{}", bound.system.name);
        let all = own.proved.iter().map(|proved| proved.holds.len());
        assert_eq!(found.confirmed, all.sum::<usize>(), "{}", bound.system.name);
        let fails = own.proved.iter().map(|proved| proved.fails.len());
        assert_eq!(found.fails, fails.sum::<usize>(), "{}", bound.system.name);
        found.confirmed
    });
    counts.into_iter().sum()
}

#[test]
fn certificates_of_theorems_are_confirmed() {
    let count = confirmed(&daily(shown()));
    assert!(count >= 100, "{count}");
}

/// What is known for some values is asked again for all, and stands there once then; what is not found for more stays as it was.
#[test]
fn what_is_known_for_fewer_values_is_asked_again() {
    let family = folder("heidenhain-fs");
    let name = "heidenhain-fs/cutout/brake".to_owned();
    let certificates = Certificates::load(&family).unwrap_or_else(|e| panic!("{e}"));
    let before = (theorems("heidenhain-fs"), certificates);
    let ask = |known: &(Theorems, Certificates), time: Duration| {
        let proving = Proving {
            each: time,
            open: true,
            systems: vec!["brake".to_owned()],
            interrupt: None,
        };
        let all = prove(&family, known, &proving, &mut |_| (), &mut |_| Ok(()));
        all.unwrap_or_else(|_| panic!("it is proved")).0
    };
    let mut few = before.clone();
    let proved = &mut few.0.systems.get_mut(&name).expect("known").proved;
    assert!(proved.len() == 1 && proved[0].within.is_empty());
    proved[0].within = [("factor".to_owned(), (0, 15))].into();
    proved[0].every = "factor = 0 .. 15: 16 configurations".to_owned();
    let within = |all: &Theorems, label: &str| -> Vec<Ranges> {
        let own = &all.systems[&name];
        assert!(own.open.is_empty());
        let of = own.proved.iter().filter(|p| p.holds.contains_key(label));
        of.map(|proved| proved.within.clone()).collect()
    };
    let all = ask(&few, Duration::from_secs(60));
    for label in before.0.systems[&name].proved[0].holds.keys() {
        assert_eq!(within(&all, label), [Ranges::new()], "{label}");
    }
    // Without time the ranges alone are decided.
    let all = ask(&few, Duration::ZERO);
    assert_eq!(
        within(&all, "HFS-BRT-002"),
        [Ranges::from([("factor".to_owned(), (0, 15))])]
    );
}

/// A range that is left out is the whole one.
#[test]
fn more_is_more_of_each_parameter() {
    let few = Ranges::from([("a".to_owned(), (0, 15)), ("b".to_owned(), (-8, 7))]);
    let only = |a| Ranges::from([("a".to_owned(), a)]);
    for (these, more) in [
        (few.clone(), false),
        (Ranges::new(), true),
        (only((0, 15)), true),
        (only((0, 255)), true),
        (only((1, 255)), false),
        (Ranges::from([("c".to_owned(), (0, 15))]), false),
    ] {
        assert_eq!(is_more(&these, &few), more, "{these:?}");
    }
    assert!(!is_more(&few, &only((0, 15))));
}

/// A certificate that says something else, or is about something else, confirms nothing.
#[test]
fn another_certificate_confirms_nothing() {
    let (known, family) = (theorems("heidenhain-fs"), folder("heidenhain-fs"));
    let all = Certificates::load(&family).unwrap_or_else(|e| panic!("{e}"));
    let bound = bound(&family.join("events.toml"), "axes_events");
    let own = &known.systems[&bound.system.name];
    let shown = &all.systems[&bound.system.name];
    let refused = |change: &dyn Fn(&mut Vec<Certificate>)| {
        let mut other = shown.clone();
        change(&mut other);
        check_certificates(&bound, own, &other, &Budget::default()).expect_err("it is altered")
    };
    let proof = |list: &mut Vec<Certificate>| {
        let claims = &mut list[0].claims;
        let mut proofs = claims.iter_mut().filter_map(|c| c.proof.as_mut());
        proofs.find(|p| !p.invariant.is_empty()).map(std::mem::take)
    };
    type Altered<'a> = (&'a str, &'a dyn Fn(&mut Vec<Certificate>));
    let changes: [Altered; 5] = [
        ("certificates for", &|list| list.clear()),
        ("is missing", &|list| drop(list[0].claims.pop())),
        ("other values", &|list| {
            list[0].free.every.push(("t".to_owned(), (0, 1)))
        }),
        ("does not show it", &|list| drop(proof(list))),
        ("is missing", &|list| {
            list[0].claims[0].verdict = CertifiedVerdict::Vacuous
        }),
    ];
    for (words, change) in changes {
        let why = refused(change);
        assert!(why.contains(words), "`{why}` does not say `{words}`");
    }
    // With another table or reading it is no theorem, and not confirmed either.
    let mut chosen = own.clone();
    chosen
        .readings
        .insert("A-02".to_owned(), "ANOTHER".to_owned());
    let found = check_certificates(&bound, &chosen, shown, &Budget::default());
    assert_eq!(found.expect("nothing wrong").confirmed, 0);
    let mut other = bound.clone();
    other.system.instances[0].rules.swap(0, 1);
    let found = check_certificates(&other, own, shown, &Budget::default()).expect("nothing wrong");
    assert_eq!(found.confirmed, 0);
    assert!(found.other > 0);
    // The file by itself.
    let text = all.text();
    let read = read_theorems(text.as_bytes()).expect("what was written");
    assert_eq!(theorems_text(&read), text);
    let cut = text.rsplit_once("claim").expect("claims").0;
    assert!(read_theorems(cut.as_bytes()).is_err());
    assert!(read_theorems(text.replacen("holds", "vacuous", 1).as_bytes()).is_err());
}

/// A theorem under a condition, and a configuration in which it fails: neither is confirmed as anything else.
#[test]
fn a_condition_is_part_of_what_is_shown() {
    let (known, family) = (theorems("sinamics-s120"), folder("sinamics-s120"));
    let all = Certificates::load(&family).unwrap_or_else(|e| panic!("{e}"));
    let bound = bound(&family.join("sbc.toml"), "sbc");
    let own = &known.systems[&bound.system.name];
    let shown = &all.systems[&bound.system.name];
    let (fails, such) = (0..own.proved.len()).fold((None, None), |(fails, such), k| {
        let proved = &own.proved[k];
        (
            fails.or((!proved.fails.is_empty()).then_some(k)),
            such.or((proved.conditions == ["enabled = TRUE"]).then_some(k)),
        )
    });
    let (fails, such) = (fails.expect("one that fails"), such.expect("a condition"));
    type Altered<'a> = (&'a str, &'a dyn Fn(&mut OfSystem, &mut Vec<Certificate>));
    let changes: [Altered; 8] = [
        // For all values nothing of it holds.
        ("does not show it", &|own, list| {
            own.proved[such].conditions.clear();
            list[such].free.conditions.clear();
        }),
        ("other values", &|own, _| {
            own.proved[such].conditions.clear()
        }),
        ("other values", &|_, list| {
            list[such].free.conditions.clear()
        }),
        // Of nothing everything holds.
        ("`enabled <> TRUE` does not hold", &|own, list| {
            let never = "enabled <> TRUE".to_owned();
            own.proved[such].conditions.push(never.clone());
            list[such].free.conditions.push(never);
        }),
        ("does not hold in a configuration", &|_, list| {
            list[such].free.such = vec![("enabled".to_owned(), 0)]
        }),
        ("has no value of its range", &|_, list| {
            list[such].free.such.clear()
        }),
        // The run is another one, or none.
        ("no run shows", &|own, _| {
            let mut fails = own.proved[fails].fails.values_mut();
            fails.next().expect("one").cycles += 1;
        }),
        ("no run shows", &|own, _| {
            let mut fails = own.proved[fails].fails.values_mut();
            let with = &mut fails.next().expect("one").with;
            with.insert("enabled".to_owned(), "TRUE".to_owned());
        }),
    ];
    for (words, change) in changes {
        let (mut own, mut list) = (own.clone(), shown.clone());
        change(&mut own, &mut list);
        let found = check_certificates(&bound, &own, &list, &Budget::default());
        let why = found.err().unwrap_or_default();
        assert!(why.contains(words), "`{why}` does not say `{words}`");
    }
    // It is cited where its condition holds.
    for (value, wanted) in [(0, false), (1, true)] {
        let mut machine = bound.clone();
        let mut params = machine.system.params.iter();
        let place = params.position(|p| p.var.name == "enabled");
        machine.values[place.expect("a parameter")] = value;
        let cited = known.of(&machine).properties;
        let cited = cited.iter().any(|k| {
            let id = label(&machine.system.properties[*k]);
            own.proved[such].holds.contains_key(&id)
        });
        assert_eq!(cited, wanted, "enabled = {value}");
    }
}

/// A measure whose number is to move the other way, or either way, shows nothing.
#[test]
fn a_measure_is_shown_by_the_direction_of_its_number() {
    let (known, family) = (theorems("sinumerik-840d"), folder("sinumerik-840d"));
    let all = Certificates::load(&family).unwrap_or_else(|e| panic!("{e}"));
    let bound = bound(&family.join("axis.toml"), "stop");
    let own = &known.systems[&bound.system.name];
    let shown = &all.systems[&bound.system.name];
    let turned = |measure: &mut Measure| measure.numbers[0].rises ^= true;
    let either = |measure: &mut Measure| {
        let mut other = measure.numbers[0].clone();
        other.rises ^= true;
        measure.numbers.push(other);
    };
    let changes: [&dyn Fn(&mut Measure); 2] = [&turned, &either];
    for change in changes {
        let mut other = shown.clone();
        let claims = other.iter_mut().flat_map(|c| &mut c.claims);
        let mut measures = claims.filter_map(|c| c.proof.as_mut()?.measure.as_mut());
        change(
            measures
                .find(|m| !m.numbers.is_empty())
                .expect("one with a number"),
        );
        let why = check_certificates(&bound, own, &other, &Budget::default());
        let why = why.expect_err("it is altered");
        assert!(why.contains("does not show it"), "{why}");
    }
}

/// What takes a minute: `.ci/run` has it beside the daily tests.
mod slow {
    use super::*;
    use stillpoint_harness::proof::Which;

    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn the_certificates_of_all_theorems_are_confirmed() {
        println!("{} theorems confirmed", confirmed(&shown()));
    }

    /// The way back from every state of an axis with all its stops, for all values at once: found only if states that were not helped
    /// wait until there is more to help them with. In the index it stands for fewer values.
    #[test]
    #[ignore = "slow: a step of .ci/run"]
    fn the_ways_back_of_an_axis_are_found_for_all_values() {
        let file = folder("sinumerik-840d").join("axis.toml");
        let mut bound = bound(&file, "stop");
        let wanted = |id: &str| id.starts_with("S840D-P-44-RESET");
        bound.system.properties.retain(|p| wanted(&label(p)));
        assert_eq!(bound.system.properties.len(), 1);
        let every = Every::new(&bound, &Which::All).expect("free parameters");
        let settings = Settings {
            each: Some(Duration::from_secs(300)),
            ..Settings::default()
        };
        for one in judge_every(&every, &settings) {
            assert_eq!(one.verdict, Verdict::Holds, "{}: {:?}", one.id, one.reason);
        }
    }
}
