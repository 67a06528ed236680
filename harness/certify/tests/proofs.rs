//! Forged certificates of the proof engines, each with a right checksum: it is the proof that must be refused, with its line.
//!
//! The certificates that are altered were written by `stillpoint check tests/certified/forms.toml --engine ... --certificate ...`;
//! `tests/peers/certificates.rs` checks that they still are what that command writes.

use std::path::{Path, PathBuf};
use std::slice::from_ref;

use stillpoint_certify::format::Verdict;
use stillpoint_certify::proof::clause::{Clause, Literal};
use stillpoint_certify::proof::duty::Measure;
use stillpoint_certify::proof::format::{Claim, File, Proof, Run, text};
use stillpoint_certify::proof::read::read;
use stillpoint_certify::proof::ways::{Rank, Step};
use stillpoint_certify::{Confirmed, Failure, certify_bytes};

fn forms() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/certified/forms.toml")
}

/// By `--engine pdr`, by `--engine kinduction`, and by `--engine pdr --every all`.
const STORED: [&str; 3] = [
    include_str!("../../../tests/certified/forms-pdr.cert"),
    include_str!("../../../tests/certified/forms-kinduction.cert"),
    include_str!("../../../tests/certified/forms-every.cert"),
];

/// By `--engine pdr --every all` of bounds that are made of several times: with sums.
const TIMES: &str = include_str!("../../../tests/certified/times-every.cert");

/// What a stored one is about.
fn subject(stored: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join(file(stored).header.subject)
}

fn certified(text: &str, subject: &Path) -> Result<Confirmed, Failure> {
    certify_bytes(text.as_bytes(), Some(subject), 1)
}

fn file(stored: &str) -> File {
    read(stored.as_bytes()).unwrap_or_else(|e| panic!("{e}"))
}

/// Why a changed certificate is refused; none if it is not.
fn refused(stored: &str, change: impl FnOnce(&mut File)) -> Option<String> {
    let mut changed = file(stored);
    change(&mut changed);
    let text = text(&changed).expect("written");
    match certified(&text, &subject(stored)) {
        Ok(_) => None,
        Err(Failure::Rejected(what)) => Some(what),
        Err(other) => panic!("{other}"),
    }
}

/// A changed certificate must be refused for this reason.
#[track_caller]
fn rejected(words: &str, stored: &str, change: impl FnOnce(&mut File)) {
    let why = refused(stored, change).unwrap_or_else(|| panic!("confirmed, in place of: {words}"));
    assert!(why.contains(words), "`{why}` does not say `{words}`");
}

/// Where the claims are: system and place.
fn claims(stored: &str) -> Vec<(usize, usize, Claim)> {
    let systems = file(stored).systems.into_iter().enumerate();
    systems
        .flat_map(|(s, system)| {
            let claims = system.claims.into_iter().enumerate();
            claims
                .map(move |(k, claim)| (s, k, claim))
                .collect::<Vec<_>>()
        })
        .collect()
}

fn proof(file: &mut File, (system, claim): (usize, usize)) -> &mut Proof {
    let claim = &mut file.systems[system].claims[claim];
    claim.proof.as_mut().expect("a proof")
}

#[test]
fn the_stored_ones_are_confirmed() {
    for (stored, least) in STORED.iter().chain([&TIMES]).zip([14, 14, 14, 2]) {
        let confirmed = certified(stored, &subject(stored)).unwrap_or_else(|e| panic!("{e}"));
        assert!(confirmed.proved.is_some());
        assert!(claims(stored).len() >= least, "{}", claims(stored).len());
        assert_eq!(text(&file(stored)).expect("written"), *stored);
    }
    // Each kind of claim, and of proof, is there.
    let all: Vec<Claim> = STORED
        .iter()
        .flat_map(|s| claims(s))
        .map(|(_, _, c)| c)
        .collect();
    for verdict in ["Holds", "Violated", "Vacuous", "Reached", "Unreachable"] {
        assert!(
            all.iter().any(|c| format!("{:?}", c.verdict) == verdict),
            "{verdict}"
        );
    }
    let proofs = || all.iter().filter_map(|c| c.proof.as_ref());
    assert!(proofs().any(|p| p.invariant.len() > 2 && p.induction.is_none()));
    assert!(proofs().any(|p| { p.induction.as_ref().is_some_and(|i| i.cycles > 1) }));
    assert!(proofs().any(|p| p.lemmas.iter().any(|l| l.list.len() > 2)));
}

/// What is left without a clause is confirmed only if it is an invariant too: then no other clause was learnt in vain.
#[test]
fn a_dropped_or_changed_clause_is_refused() {
    let (mut dropped, mut changed, mut kept) = (0, 0, 0);
    for stored in STORED.into_iter().chain([TIMES]) {
        for (s, k, claim) in claims(stored) {
            let Some(own) = &claim.proof else { continue };
            for (number, clause) in own.invariant.iter().enumerate() {
                let why = refused(stored, |f| drop(proof(f, (s, k)).invariant.remove(number)));
                match why {
                    Some(why) => {
                        assert!(why.contains("line "), "{why}");
                        dropped += 1;
                    }
                    None => kept += 1,
                }
                for place in 0..clause.0.len() {
                    for other in altered(&clause.0[place]) {
                        let change =
                            |f: &mut File| proof(f, (s, k)).invariant[number].0[place] = other;
                        match refused(stored, change) {
                            Some(why) => {
                                assert!(why.contains("line "), "{why}");
                                changed += 1;
                            }
                            None => kept += 1,
                        }
                    }
                }
            }
        }
    }
    println!(
        "refused: {dropped} without a clause, {changed} with a changed one; {kept} are proofs too"
    );
    assert!(
        dropped > 10 && changed > 50 && kept < changed,
        "{dropped} {changed} {kept}"
    );
}

/// Other literals in its place.
fn altered(literal: &Literal) -> Vec<Literal> {
    match literal.clone() {
        Literal::Bit { name, bit, set } => vec![
            Literal::Bit {
                name: name.clone(),
                bit,
                set: !set,
            },
            Literal::Bit {
                name,
                bit: bit + 1,
                set,
            },
            Literal::Bit {
                name: "nothing".into(),
                bit,
                set,
            },
        ],
        Literal::Is { name, value, equal } => vec![
            Literal::Is {
                name: name.clone(),
                value,
                equal: !equal,
            },
            Literal::Is {
                name,
                value: value + 1,
                equal,
            },
        ],
        Literal::Most { sum, most, shift } => {
            let mut list = vec![Literal::Most {
                sum: sum.clone(),
                most: most.clone(),
                shift: shift - 1,
            }];
            // The last once more, another number than the sum, the other side without its last.
            if let [.., last] = &sum[..] {
                let more = [&sum[..], from_ref(last)].concat();
                list.extend([more, vec!["nothing".into()]].map(|sum| Literal::Most {
                    sum,
                    most: most.clone(),
                    shift,
                }));
            }
            if let [fewer @ .., _] = &most[..] {
                let most = fewer.to_vec();
                list.push(Literal::Most { sum, most, shift });
            }
            list
        }
    }
}

#[test]
fn another_verdict_is_refused_under_every_proof() {
    let verdicts = [
        Verdict::Holds,
        Verdict::Violated,
        Verdict::Vacuous,
        Verdict::Reached,
        Verdict::Unreachable,
    ];
    let mut tried = 0;
    for stored in STORED {
        let all = claims(stored);
        for (s, k, claim) in &all {
            for verdict in verdicts.into_iter().filter(|v| *v != claim.verdict) {
                for (_, _, other) in all.iter().filter(|(other, _, _)| other == s) {
                    let why = refused(stored, |f| {
                        let own = &mut f.systems[*s].claims[*k];
                        (own.verdict, own.run, own.proof) =
                            (verdict, other.run.clone(), other.proof.clone());
                        let task = &mut f.header.task[*s];
                        for property in task.property.iter_mut().filter(|p| p.id == claim.id) {
                            property.verdict = verdict;
                        }
                    });
                    assert!(why.is_some(), "{} as {verdict:?} by {}", claim.id, other.id);
                    tried += 1;
                }
            }
        }
    }
    println!("{tried} wrong verdicts refused");
    assert!(tried > 500, "{tried}");
}

#[test]
fn a_dropped_or_changed_lemma_is_refused_or_not_needed() {
    let (mut refusals, mut kept) = (0, 0);
    for stored in STORED {
        for (s, k, claim) in claims(stored) {
            let Some(own) = &claim.proof else { continue };
            for (part, lemmas) in own.lemmas.iter().enumerate() {
                for (number, lemma) in lemmas.list.iter().enumerate() {
                    let list = |f: &mut File, change: &dyn Fn(&mut Vec<Vec<i32>>)| {
                        change(&mut proof(f, (s, k)).lemmas[part].list);
                    };
                    let mut whys = vec![refused(stored, |f| list(f, &|l| drop(l.remove(number))))];
                    for place in 0..lemma.len() {
                        whys.push(refused(stored, |f| list(f, &|l| l[number][place] *= -1)));
                        let why = refused(stored, |f| list(f, &|l| l[number][place] = i32::MAX));
                        assert!(why.is_some_and(|w| w.contains("does not follow")));
                    }
                    // Nothing follows from what is not there.
                    let why = refused(stored, |f| {
                        list(f, &|l| l.insert(number, vec![i32::MIN + 1]))
                    });
                    assert!(why.is_some_and(|w| w.contains("line ")));
                    refusals += whys.iter().flatten().count();
                    kept += whys.iter().filter(|w| w.is_none()).count();
                }
            }
        }
    }
    println!("{refusals} refused, {kept} proofs too");
    assert!(refusals > 20, "{refusals} {kept}");
}

#[test]
fn another_subject_is_refused() {
    let [pdr, induction, every] = STORED;
    rejected("not the file", pdr, |f| {
        f.header.file[0].sha256 = "0".repeat(64)
    });
    rejected("other parameter values", pdr, |f| {
        f.header.task[0].parameters.insert("burn".into(), 2);
    });
    rejected("proofs for 2 systems", pdr, |f| drop(f.systems.pop()));
    rejected("must stand here", pdr, |f| f.systems.swap(0, 1));
    rejected("missing or not in its place", pdr, |f| {
        f.systems[0].claims.swap(0, 1)
    });
    rejected("missing or not in its place", pdr, |f| {
        drop(f.systems[0].claims.remove(0))
    });
    rejected("not one of the header", pdr, |f| {
        let twice = f.systems[0].claims[0].clone();
        f.systems[0].claims.push(twice);
    });
    rejected("speaks of states", pdr, |f| f.header.task[0].states = 15);
    // A wider range, in which the lamp burns too long; an empty one; one that the file does not document.
    let range = |range: (i64, i64)| move |f: &mut File| f.systems[0].free.every[0].1 = range;
    rejected("says nothing", every, range((4, 1)));
    rejected("there is no such configuration", every, range((7, 9)));
    rejected("there is no parameter", every, |f| {
        f.systems[0].free.every[0].0 = "left".into()
    });
    let again = |f: &mut File| {
        let twice = f.systems[0].free.every[0].clone();
        f.systems[0].free.every.push(twice);
    };
    rejected("not the only one", every, again);
    // Conditions: none of the lamp's; that no configuration is said to satisfy; that the one named does not, nor one of a run.
    let such = |condition: &'static str, burn: &[i64]| {
        let such: Vec<(String, i64)> = burn.iter().map(|v| ("burn".into(), *v)).collect();
        move |f: &mut File| {
            f.systems[0].free.conditions = vec![condition.into()];
            f.systems[0].free.such = such.clone();
        }
    };
    rejected("is no parameter", every, such("left < 4", &[3]));
    rejected("has no value of its range", every, such("burn < 4", &[]));
    rejected("`burn < 4` does not hold", every, such("burn < 4", &[4]));
    rejected("`burn < 4` does not hold", every, such("burn < 4", &[3]));
    // What holds for one value is not shown for all.
    rejected("line ", pdr, |f| {
        f.systems[0].free.every.push(("burn".into(), (1, 4)))
    });
    rejected("more than 1000 cycles", induction, |f| {
        let known = f.systems[0]
            .claims
            .iter_mut()
            .filter_map(|c| c.proof.as_mut());
        known
            .filter_map(|p| p.induction.as_mut())
            .for_each(|i| i.cycles = 1 << 40);
    });
}

#[test]
fn a_shorter_induction_is_refused() {
    let stored = STORED[1];
    let mut tried = 0;
    for (s, k, claim) in claims(stored) {
        let Some(induction) = claim.proof.and_then(|p| p.induction) else {
            continue;
        };
        if induction.cycles > 0 {
            let why = refused(stored, |f| {
                let own = proof(f, (s, k)).induction.as_mut().expect("induction");
                own.cycles -= 1;
                own.differ
                    .retain(|(one, other)| one.max(other) <= &own.cycles);
                proof(f, (s, k)).lemmas[3].list.clear();
            });
            assert!(why.is_some_and(|w| w.contains("line ")), "{}", claim.id);
            tried += 1;
        }
        for pair in 0..induction.differ.len() {
            let _ = refused(stored, |f| {
                let own = proof(f, (s, k)).induction.as_mut().expect("induction");
                own.differ[pair].1 = 999;
            })
            .expect("a cycle that there is not");
        }
    }
    assert!(tried > 1, "{tried}");
}

#[test]
fn a_run_that_does_something_else_is_refused() {
    let mut runs = 0;
    for stored in STORED {
        for (s, k, claim) in claims(stored) {
            let Some(run) = &claim.run else { continue };
            runs += 1;
            let change = |change: &dyn Fn(&mut Run)| {
                let why = refused(stored, |f| {
                    change(f.systems[s].claims[k].run.as_mut().expect("a run"));
                });
                assert!(why.is_some_and(|w| w.contains("line ")), "{}", claim.id);
            };
            change(&|run| run.cycles.clear());
            change(&|run| run.cycles[0].push(("nothing".into(), 0)));
            change(&|run| run.cycles[0].push(("lamp.colour".into(), 7)));
            change(&|run| run.start.push(("lamp.left".into(), 1)));
            change(&|run| run.start.push(("nothing".into(), 0)));
            change(&|run| run.with.push(("burn".into(), 3)));
            if !run.with.is_empty() {
                change(&|run| run.with.clear());
                change(&|run| run.with[0].1 = 5);
            }
            let why = refused(stored, |f| f.systems[s].claims[k].run = None);
            assert!(why.is_some(), "{}", claim.id);
        }
    }
    assert!(runs > 15, "{runs}");
}

#[test]
fn no_flipped_bit_and_no_cut_goes_unnoticed() {
    let stored = STORED[0];
    let mut bytes = stored.as_bytes().to_vec();
    for place in 0..bytes.len() {
        let bit = 1 << (place % 8);
        bytes[place] ^= bit;
        assert!(
            certify_bytes(&bytes, Some(&forms()), 1).is_err(),
            "byte {place}"
        );
        bytes[place] ^= bit;
    }
    let mut end = 0;
    for line in stored.split_inclusive('\n') {
        match certified(&stored[..end], &forms()) {
            Err(Failure::Rejected(why)) => assert!(why.starts_with("line "), "{why}"),
            Err(Failure::Unreadable(_)) => assert_eq!(end, 0),
            Ok(_) => panic!("{end} bytes"),
        }
        end += line.len();
    }
}

/// Lines left out, doubled or exchanged, with a right checksum: nothing is confirmed that the original does not say.
#[test]
fn changed_lines_with_a_right_checksum_claim_nothing_else() {
    use sha2::{Digest, Sha256};
    let (mut confirmed, mut tried) = (0, 0);
    for stored in STORED {
        let verdicts = |c: &Confirmed| -> Vec<Vec<Verdict>> {
            let tasks = c.header.task.iter();
            tasks
                .map(|t| t.property.iter().map(|p| p.verdict).collect())
                .collect()
        };
        let original = certified(stored, &forms()).expect("confirmed");
        let lines: Vec<&str> = stored.lines().collect();
        let lines = &lines[..lines.len() - 1];
        for place in 0..lines.len() {
            let mut without = lines.to_vec();
            without.remove(place);
            let mut doubled = lines.to_vec();
            doubled.insert(place, lines[place]);
            let mut swapped = lines.to_vec();
            swapped.swap(place, (place + 1) % lines.len());
            for changed in [without, doubled, swapped] {
                let content = changed.join("\n") + "\n";
                let digits = Sha256::digest(content.as_bytes());
                tried += 1;
                if let Ok(other) = certified(&format!("{content}sha256 {digits:x}\n"), &forms()) {
                    assert_eq!(verdicts(&other), verdicts(&original));
                    confirmed += 1;
                }
            }
        }
    }
    println!("{tried} changed certificates, {confirmed} of them with the same claims");
    assert!(tried - confirmed > 500, "{confirmed} of {tried}");
}

/// An invariant that excludes nothing, one that excludes a start state, and one that a cycle leaves.
#[test]
fn each_of_the_three_obligations_is_asked_for() {
    let stored = STORED[0];
    let place = claims(stored)
        .into_iter()
        .find(|(_, _, c)| c.id == "ALWAYS" && c.verdict == Verdict::Holds);
    let (s, k, _) = place.expect("claimed");
    let with = |clauses: Vec<&'static str>| {
        move |f: &mut File| {
            let own = proof(f, (s, k));
            let read = |c: &&str| Clause::read(c.split(' ')).expect("a clause");
            own.invariant = clauses.iter().map(read).collect();
            own.lemmas.iter_mut().for_each(|l| l.list.clear());
        }
    };
    rejected("to exclude what must not happen", stored, with(vec![]));
    rejected("holds at the start", stored, with(vec!["lamp.left=1"]));
    rejected(
        "every cycle keeps this clause",
        stored,
        with(vec!["lamp.left=0"]),
    );
    rejected(
        "there is no `lamp.right`",
        stored,
        with(vec!["lamp.right=0"]),
    );
}

/// Regions that leave a state out, or whose inputs do not lead out of them or cannot be, show nothing.
#[test]
fn ways_that_lead_nowhere_are_refused() {
    let (mut seen, mut gone) = (0, 0);
    for stored in STORED {
        for (s, k, claim) in claims(stored) {
            let Some(own) = claim.proof.filter(|p| !p.ways.is_empty()) else {
                continue;
            };
            rejected("no proof", stored, |f| proof(f, (s, k)).ways.clear());
            for n in 0..own.ways.len() {
                let with = |change: &dyn Fn(&mut Step)| {
                    refused(stored, |f| change(&mut proof(f, (s, k)).ways[n]))
                };
                // Of no state: then another region leads nowhere, or a state is left out, or it was not needed.
                let none = Literal::read("lamp.left<=-1").expect("a literal");
                let why = with(&|step| step.region = vec![none.clone()]);
                gone += usize::from(why.is_some());
                let why = with(&|step| step.inputs.push(("lamp.colour".to_owned(), 99)));
                // Another constant makes other gates, of which the lemmas know nothing.
                let words = ["are not shown to be possible", "does not follow"];
                assert!(why.is_some_and(|why| words.iter().any(|w| why.contains(w))));
                let why = with(&|step| step.inputs.push(("lamp.nothing".to_owned(), 0)));
                assert!(why.is_some_and(|why| why.contains("there is no input")));
                seen += 1;
            }
        }
    }
    assert!(seen > 3 && gone > 1, "{seen} {gone}");
}

/// A response without a bound is shown by its own measure, and by no other that shows nothing; nothing else has one.
#[test]
fn measures_that_measure_nothing_are_refused() {
    let (mut seen, mut fewer) = (0, 0);
    for stored in STORED {
        for (s, k, claim) in claims(stored) {
            let Some(own) = claim.proof else {
                continue;
            };
            let with = |change: &dyn Fn(&mut Measure)| {
                refused(stored, |f| {
                    change(proof(f, (s, k)).measure.get_or_insert_default())
                })
            };
            if own.measure.is_none() {
                let why = with(&|_| {});
                assert!(why.is_some_and(|why| why.contains("nothing to measure")));
                continue;
            }
            seen += 1;
            rejected("no measure", stored, |f| proof(f, (s, k)).measure = None);
            for rounds in [-1, 1001] {
                let why = with(&|measure| measure.rounds = rounds);
                assert!(why.is_some_and(|why| why.contains("0 to 1000 rounds")));
            }
            fewer += usize::from(with(&|measure| measure.rounds = 0).is_some());
            for (name, what) in [
                ("lamp.nothing", "no state variable"),
                ("@rest", "no state variable"),
            ] {
                let rank = Rank {
                    name: name.to_owned(),
                    rises: false,
                };
                let why = with(&|measure| measure.numbers.push(rank.clone()));
                assert!(why.is_some_and(|why| why.contains(what)), "{name}");
            }
        }
    }
    assert!(seen > 2 && fewer > 0, "{seen} {fewer}");
}
