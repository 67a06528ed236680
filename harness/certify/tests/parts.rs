//! The parts of the checker against the simplest ways of doing the same.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use stillpoint_certify::cycle::{Cycle, PairCycle, Pairing};
use stillpoint_certify::format::{Body, Header, Kind, Proof, Run, bodies, open};
use stillpoint_certify::states::{Places, Radix};
use stillpoint_certify::subject::Subject;
use stillpoint_certify::{Failure, write};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;

/// The systems of a file.
fn load(file: &str) -> Subject {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    Subject::load(&path, Kind::Specification, &BTreeMap::new()).unwrap_or_else(|e| panic!("{e}"))
}

/// The systems of the example with every form of property.
fn systems() -> Subject {
    load("../../tests/certified/forms.toml")
}

/// All values of cells with these ranges, the last one turning fastest.
fn every(ranges: &[(i32, i32)]) -> Vec<Vec<i32>> {
    let mut all = vec![Vec::new()];
    for (lo, hi) in ranges {
        let longer = |list: Vec<i32>| (*lo..=*hi).map(move |v| [&list[..], &[v]].concat());
        all = all.into_iter().flat_map(longer).collect();
    }
    all
}

/// One cycle with all inputs given; none after a range fault.
fn cycle(bound: &Bound, before: &[i32], inputs: &[i32]) -> Option<Frame> {
    let mut frame = Frame::new(bound);
    frame.start(before);
    bound.step(&mut frame, &mut |k| inputs[k]).ok()?;
    Some(frame)
}

#[test]
fn states_have_numbers() {
    for bound in systems().bounds {
        let radix = Radix::new(&bound).expect("small");
        let all = every(&bound.states);
        assert_eq!(radix.space, all.len() as u128);
        let mut back = vec![0; bound.states.len()];
        for (number, state) in all.iter().enumerate() {
            assert_eq!(radix.index(state), Some(number as u128));
            assert!(radix.state(number as u128, &mut back));
            assert_eq!(back, *state);
        }
        assert!(!radix.state(radix.space, &mut back));
        for (k, (lo, hi)) in bound.states.iter().enumerate() {
            for outside in [lo - 1, hi + 1, i32::MIN, i32::MAX] {
                let mut state = all[0].clone();
                state[k] = outside;
                assert_eq!(radix.index(&state), None);
            }
        }
    }
    let list = [1, 5, 9, u128::MAX];
    let places = Places::new(&list).expect("few");
    for (place, number) in list.into_iter().enumerate() {
        assert_eq!(places.find(number), Some(place));
        assert_eq!(places.find(number ^ 2), None);
    }
    assert_eq!(Places::new(&[]).expect("none").find(0), None);
}

/// Cycles enumerated on demand are those of all combinations of all inputs, for the step and for each property.
#[test]
fn cycles_are_complete() {
    let mut bounds = systems().bounds;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/must-fail");
    for entry in std::fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("an entry").path();
        let subject = Subject::load(&path, Kind::Specification, &BTreeMap::new());
        let small = subject.into_iter().flat_map(|s| s.bounds);
        let work = |b: &Bound| Radix::new(b).map_or(u128::MAX, |r| r.space * b.combinations());
        bounds.extend(small.filter(|b| work(b) < 100_000));
    }
    assert!(bounds.len() > 6, "{}", bounds.len());
    for bound in bounds {
        let inputs = every(&bound.inputs);
        let radix = Radix::new(&bound).expect("small");
        let atoms = [(0, (0..bound.system.atoms.len()).collect())];
        let mut cycles = Cycle::new(&bound, &radix, &atoms);
        let mut made = 0;
        for state in every(&bound.states) {
            // For each successor (none: a fault) and atom whether it can be false, and true.
            let number = |state: &[i32]| radix.index(state).expect("a state");
            let mut naive: BTreeMap<Option<u128>, BTreeSet<(usize, bool)>> = BTreeMap::new();
            for given in &inputs {
                let Some(mut frame) = cycle(&bound, &state, given) else {
                    naive.entry(None).or_default();
                    continue;
                };
                let seen = naive.entry(Some(number(&frame.now))).or_default();
                for k in 0..bound.system.atoms.len() {
                    seen.insert((k, bound.atom(k, &mut frame, &mut |i| given[i])));
                }
            }
            let mut found: BTreeMap<Option<u128>, BTreeSet<(usize, bool)>> = BTreeMap::new();
            let each = cycles.each(number(&state), |cycle, result| {
                made += 1;
                let after = result.is_ok().then(|| cycle.after());
                let seen = found.entry(after).or_default();
                for k in 0..bound.system.atoms.len() {
                    if result.is_ok() {
                        assert!(cycle.all(|c| {
                            let value = c.atom(k);
                            seen.insert((k, value));
                            // Asked twice in one cycle it is the same.
                            c.atom(k) == value
                        }));
                    }
                }
                Ok::<(), ()>(())
            });
            assert_eq!(each, Ok(()));
            assert_eq!(found, naive, "{state:?}");
        }
        if bound.states.is_empty() {
            assert_eq!(
                made, 1,
                "its one state has one successor, whatever the inputs"
            );
        } else {
            assert!(
                made >= every(&bound.states).len(),
                "a state without a cycle"
            );
        }
    }
}

/// Pairs of cycles are those of the definition: equal inputs, but for the listed ones in cycles with the condition in
/// both runs.
#[test]
fn pairs_of_cycles_are_complete() {
    let mut compared = 0;
    let shared = load("tests/shared.toml");
    for bound in systems().bounds.into_iter().chain(shared.bounds) {
        let inputs = every(&bound.inputs);
        let states = every(&bound.states);
        // A part of the pairs of states is enough where there are many.
        let every_nth = if states.len() < 10 { 1 } else { 67 };
        let radix = Radix::new(&bound).expect("small");
        let number = |state: &[i32]| radix.index(state).expect("a state");
        let observe: Vec<usize> = (0..bound.system.observed.len()).collect();
        // Every atom as the condition, every input as the one that may differ.
        let conditions = (0..bound.system.atoms.len()).map(Some).chain([None]);
        let cases = conditions.flat_map(|c| (0..bound.inputs.len()).map(move |k| (c, [k])));
        for (condition, of) in cases {
            let (observe, of) = (&observe, &of);
            let pairing = Pairing {
                observe,
                of,
                condition,
            };
            let mut cycles = PairCycle::new(&bound, &radix, pairing);
            let pairs = states
                .iter()
                .flat_map(|a| states.iter().map(move |b| [a, b]));
            for [a, b] in pairs.step_by(every_nth) {
                let mut naive = BTreeSet::new();
                for one in &inputs {
                    for other in &inputs {
                        let differ = (0..one.len()).filter(|k| one[*k] != other[*k]);
                        let differ: Vec<usize> = differ.collect();
                        if !differ.iter().all(|k| of.contains(k)) {
                            continue;
                        }
                        let frames = cycle(&bound, a, one).zip(cycle(&bound, b, other));
                        let Some((mut first, mut second)) = frames else {
                            continue;
                        };
                        let holds = |f: &mut Frame, given: &[i32]| {
                            condition.is_none_or(|c| bound.atom(c, f, &mut |i| given[i]))
                        };
                        let both = holds(&mut first, one) && holds(&mut second, other);
                        if !both && !differ.is_empty() {
                            continue;
                        }
                        let agree = !both
                            || observe.iter().all(|k| {
                                bound.observe(*k, &mut first, &mut |i| one[i])
                                    == bound.observe(*k, &mut second, &mut |i| other[i])
                            });
                        naive.insert(([&first.now, &second.now].map(|s| number(s)), agree));
                    }
                }
                let mut found = BTreeSet::new();
                let each = cycles.each([number(a), number(b)], |after, agree| {
                    found.insert((after, agree));
                    Ok::<(), ()>(())
                });
                assert_eq!(each, Ok(()));
                assert_eq!(found, naive, "{condition:?} {of:?}: {a:?} {b:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 500, "{compared}");
}

/// A header that asks for two proofs over three states, and one fault.
fn header() -> Header {
    let mut header = systems().header;
    header.task.truncate(1);
    header.task[0].property.truncate(2);
    header.task[0].states = 3;
    header.task[0].faults = vec!["here".to_owned()];
    header
}

#[test]
fn what_is_written_is_read_again() {
    let run = Run {
        initial: u128::MAX,
        steps: vec![vec![(0, 1), (7, u32::MAX)], vec![], vec![(300, 128)]],
        repeats: Some(0),
    };
    let body = Body {
        states: vec![0, 127, u128::MAX - 1],
        proofs: vec![
            Proof::default(),
            Proof {
                runs: vec![run.clone(), Run::default()],
                map: vec![0, u32::MAX, u32::MAX],
                pairs: vec![3, 4, 1 << 90],
            },
        ],
        faults: vec![run],
    };
    let mut bytes = Vec::new();
    write(&mut bytes, &header(), std::slice::from_ref(&body)).expect("written");
    let (read, proofs) = open(&bytes).expect("a certificate");
    assert_eq!(read, header());
    assert_eq!(
        bodies(&read, proofs).expect("proofs"),
        std::slice::from_ref(&body)
    );
    // Too short, too long, and states that do not ascend.
    for end in 0..proofs.len() {
        assert!(matches!(
            bodies(&read, &proofs[..end]),
            Err(Failure::Rejected(_))
        ));
    }
    assert!(bodies(&read, &[proofs, &[0]].concat()).is_err());
    for states in [vec![1, 1, 2], vec![2, 1, 3], vec![0, 1]] {
        let body = Body {
            states,
            ..body.clone()
        };
        let mut bytes = Vec::new();
        write(&mut bytes, &header(), std::slice::from_ref(&body)).expect("written");
        let (read, proofs) = open(&bytes).expect("a certificate");
        assert!(bodies(&read, proofs).is_err());
    }
}
