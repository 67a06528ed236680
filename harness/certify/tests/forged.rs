//! Forged certificates, each with a right checksum: it is the proof that must be refused.
//!
//! The certificate that is altered was written by `stillpoint check tests/certified/forms.toml --certificate ...`;
//! `tests/peers/certificates.rs` checks that it still is what that command writes.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use stillpoint_certify::format::{Body, CHECKSUM, Header, Kind, Proof, Run, Verdict, bodies, open};
use stillpoint_certify::subject::Subject;
use stillpoint_certify::{Confirmed, Failure, certify_bytes, write};

fn forms() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/certified/forms.toml")
}

/// The certificate of the example with every form.
fn example() -> &'static [u8] {
    include_bytes!("../../../tests/certified/forms.cert")
}

/// System, property, verdict, of everything that is confirmed; faults too.
fn claims(confirmed: &Confirmed) -> Vec<(String, String, Verdict)> {
    let mut out = Vec::new();
    for task in &confirmed.header.task {
        for p in &task.property {
            out.push((task.system.clone(), p.id.clone(), p.verdict));
        }
        for fault in &task.faults {
            out.push((task.system.clone(), fault.clone(), Verdict::Violated));
        }
    }
    out
}

/// The number of an input of the lamp.
fn input(name: &str) -> u32 {
    let subject = Subject::load(&forms(), Kind::Specification, &Default::default());
    let subject = subject.unwrap_or_else(|e| panic!("{e}"));
    let inputs = &subject.bounds[BREAKS].system.inputs;
    let place = inputs.iter().position(|i| i.name == name);
    place.unwrap_or_else(|| panic!("no input {name}")) as u32
}

fn certified(bytes: &[u8]) -> Result<Confirmed, Failure> {
    certify_bytes(bytes, Some(&forms()), 1)
}

fn parts(bytes: &[u8]) -> (Header, Vec<Body>) {
    let (header, proofs) = open(bytes).expect("readable");
    let bodies = bodies(&header, proofs).expect("readable proofs");
    (header, bodies)
}

/// The example with changes and a right checksum.
fn forge(change: impl FnOnce(&mut Header, &mut Vec<Body>)) -> Vec<u8> {
    let (mut header, mut bodies) = parts(example());
    change(&mut header, &mut bodies);
    let mut out = Vec::new();
    write(&mut out, &header, &bodies).expect("written");
    out
}

/// A forged certificate must be rejected for a reason that contains these words.
#[track_caller]
fn rejected(words: &str, change: impl FnOnce(&mut Header, &mut Vec<Body>)) {
    let forged = forge(change);
    assert_ne!(forged, example(), "nothing was changed");
    match certified(&forged) {
        Err(Failure::Rejected(reason)) => {
            assert!(reason.contains(words), "`{reason}` does not say `{words}`");
            assert!(!reason.contains('\n'), "{reason}");
        }
        other => panic!("not rejected ({words}): {other:?}"),
    }
}

/// The systems of the example.
const LAMP: usize = 0;
const BREAKS: usize = 1;
const SUM: usize = 2;

fn number(task: usize, id: &str) -> usize {
    let (header, _) = parts(example());
    let found = header.task[task].property.iter().position(|p| p.id == id);
    found.unwrap_or_else(|| panic!("no property {id}"))
}

fn proof<'b>(bodies: &'b mut [Body], task: usize, id: &str) -> &'b mut Proof {
    &mut bodies[task].proofs[number(task, id)]
}

/// Drops a state with everything that is said about it.
fn drop_state(header: &mut Header, bodies: &mut [Body], task: usize, state: usize) {
    let body = &mut bodies[task];
    let count = body.states.len() as u128;
    body.states.remove(state);
    header.task[task].states -= 1;
    for proof in &mut body.proofs {
        if !proof.map.is_empty() {
            proof.map.remove(state);
        }
        let moved = |place: u128| place - u128::from(place > state as u128);
        let kept = proof.pairs.iter().map(|pair| (pair / count, pair % count));
        proof.pairs = kept
            .filter(|(a, b)| *a != state as u128 && *b != state as u128)
            .map(|(a, b)| moved(a) * (count - 1) + moved(b))
            .collect();
    }
}

/// Adds a state, under the values that each map has in the state before it.
fn add_state(header: &mut Header, bodies: &mut [Body], task: usize, state: u128) {
    let body = &mut bodies[task];
    let count = body.states.len() as u128;
    let place = body.states.binary_search(&state).expect_err("a new state");
    body.states.insert(place, state);
    header.task[task].states += 1;
    for proof in &mut body.proofs {
        if !proof.map.is_empty() {
            proof.map.insert(place, proof.map[place.saturating_sub(1)]);
        }
        let moved = |p: u128| p + u128::from(p >= place as u128);
        for pair in &mut proof.pairs {
            *pair = moved(*pair / count) * (count + 1) + moved(*pair % count);
        }
    }
}

#[test]
fn a_missing_state_is_rejected() {
    for task in [LAMP, BREAKS, SUM] {
        let count = parts(example()).1[task].states.len();
        assert!(count >= 6);
        for state in 0..count {
            rejected("", |h, b| drop_state(h, b, task, state));
        }
    }
    rejected("is missing in the set of states", |h, b| {
        drop_state(h, b, LAMP, 3)
    });
    rejected("an initial state is missing", |h, b| {
        drop_state(h, b, LAMP, 0)
    });
    rejected("needs the set of states", |h, b| {
        h.task[SUM].states = 0;
        b[SUM].states.clear();
    });
}

#[test]
fn a_bad_state_is_rejected() {
    // The variables are left 0..5, broken, shade 0..2: 36 states; left is 4 or 5 from 24 on.
    rejected("a successor of state 34 is missing", |h, b| {
        add_state(h, b, LAMP, 34)
    });
    // With all that follows from it the set is closed, but cycles break properties.
    rejected("not shown in the cycles from state 28", |h, b| {
        for state in [10, 16, 22, 28, 34] {
            add_state(h, b, LAMP, state);
        }
    });
    rejected("", |h, b| add_state(h, b, LAMP, 26));
    rejected("outside the ranges", |h, b| add_state(h, b, LAMP, 36));
    rejected("outside the ranges", |h, b| {
        add_state(h, b, LAMP, u128::MAX - 1)
    });
}

#[test]
fn another_property_or_subject_is_rejected() {
    rejected("states ALWAYS otherwise", |h, _| {
        h.task[LAMP].property[0].text = "other".into()
    });
    rejected("states ALWAYS otherwise", |h, _| {
        h.task[LAMP].property[0].written = vec!["always: TRUE".into()];
    });
    rejected("states ALWAYS otherwise", |h, _| {
        h.task[LAMP].property[0].id = "OTHER".into()
    });
    rejected("states NEVER otherwise", |h, b| {
        h.task[LAMP].property.swap(1, 2);
        b[LAMP].proofs.swap(1, 2);
    });
    rejected("accounts for 13 properties", |h, b| {
        h.task[LAMP].property.pop();
        b[LAMP].proofs.pop();
    });
    rejected("accounts for 15 properties", |h, b| {
        let (last, proof) = (h.task[LAMP].property[0].clone(), b[LAMP].proofs[0].clone());
        h.task[LAMP].property.push(last);
        b[LAMP].proofs.push(proof);
    });
    rejected("speaks of 2 systems", |h, b| {
        h.task.pop();
        b.pop();
    });
    rejected("in place of", |h, b| {
        h.task.swap(0, 1);
        b.swap(0, 1);
    });
    rejected("not the file", |h, _| h.file[0].sha256 = "0".repeat(64));
    rejected("not the file", |h, _| h.file[0].name = "other.toml".into());
    rejected("uses other files", |h, _| h.file.clear());
    rejected("other parameter values", |h, _| {
        h.task[LAMP].parameters.insert("burn".into(), 2);
    });
    rejected("its readings", |h, _| {
        h.readings.insert("A-1".into(), "NO".into());
    });
}

/// A claim with a verdict that its proof does not show, under every proof that the certificate has.
#[test]
fn a_stronger_verdict_is_rejected() {
    let (header, original) = parts(example());
    let verdicts = [
        Verdict::Holds,
        Verdict::Violated,
        Verdict::Vacuous,
        Verdict::Reached,
        Verdict::Unreachable,
    ];
    let mut tried = 0;
    for (task, claims) in header.task.iter().enumerate() {
        // Maps of a system with another number of states cannot even be read.
        let count = original[task].states.len();
        let proofs = original.iter().flat_map(|b| &b.proofs);
        let all: Vec<Proof> = (proofs.filter(|p| p.map.is_empty() || p.map.len() == count))
            .cloned()
            .collect();
        for (number, claim) in claims.property.iter().enumerate() {
            for verdict in verdicts.into_iter().filter(|v| *v != claim.verdict) {
                // What is recorded is not part of a certificate, and the response itself holds.
                if claim.id == "RECORDED" && verdict == Verdict::Holds {
                    continue;
                }
                for proof in all.iter().chain([&Proof::default()]) {
                    rejected(&claim.id, |h, b| {
                        h.task[task].property[number].verdict = verdict;
                        b[task].proofs[number] = proof.clone();
                    });
                    tried += 1;
                }
            }
        }
    }
    println!("{tried} wrong verdicts rejected");
    assert!(tried > 2000, "{tried}");
}

#[test]
fn a_wrong_rank_is_rejected() {
    for (task, id, needed) in [
        (LAMP, "BOUNDED", true),
        (LAMP, "FAIR", true),
        (LAMP, "ASSUMING", true),
        (LAMP, "UNLESS", true),
        (LAMP, "RECOVER", false),
        (BREAKS, "RECOVER", false),
    ] {
        let map = parts(example()).1[task].proofs[number(task, id)]
            .map
            .clone();
        assert!(map.iter().any(|v| *v != 0), "{id}");
        rejected(id, |_, b| proof(b, task, id).map.fill(0));
        rejected("", |_, b| proof(b, task, id).map.clear());
        for (state, value) in map.iter().enumerate().filter(|(_, v)| **v != 0 && needed) {
            // One state without its rank, or outside its set.
            rejected(id, |_, b| proof(b, task, id).map[state] = 0);
            assert_ne!(*value, 0);
        }
    }
    // Two ranks in each other's place.
    for id in ["BOUNDED", "RECOVER"] {
        let map = parts(example()).1[LAMP].proofs[number(LAMP, id)]
            .map
            .clone();
        let (low, high) = (
            map.iter().position(|v| *v == 1).expect("a rank"),
            map.iter().position(|v| *v == 3).expect("a rank"),
        );
        rejected(id, |_, b| proof(b, LAMP, id).map.swap(low, high));
    }
    // Ranks that fall as they must, but begin above the bound.
    rejected("BOUNDED", |_, b| {
        let ranks = &mut proof(b, LAMP, "BOUNDED").map;
        ranks.iter_mut().filter(|v| **v != 0).for_each(|v| *v += 1);
    });
    // The levels of the fair response, with the other condition.
    rejected("FAIR", |_, b| {
        let ranks = &mut proof(b, LAMP, "FAIR").map;
        ranks.iter_mut().filter(|v| **v != 0).for_each(|v| *v ^= 1);
    });
    // A set of states in which no cycle meets the goal, but from which there is a way to it: about to go out.
    rejected("RECOVER", |_, b| {
        let own = proof(b, BREAKS, "RECOVER");
        own.runs[0].initial = 0;
        own.runs[0].steps = vec![vec![(input("lamp.on"), 1)], vec![], vec![]];
        own.map.fill(0);
        let place = parts(example()).1[BREAKS].states.binary_search(&6);
        own.map[place.expect("left = 1")] = 1;
    });
    // A lost state from which the goal is not lost.
    rejected("RECOVER", |_, b| proof(b, BREAKS, "RECOVER").map.fill(1));
}

#[test]
fn a_missing_pair_is_rejected() {
    for id in ["INDEPENDENT", "INDEPENDENT-WHILE"] {
        let pairs = parts(example()).1[LAMP].proofs[number(LAMP, id)]
            .pairs
            .clone();
        assert!(pairs.len() >= 15, "{id}: {}", pairs.len());
        for pair in 0..pairs.len() {
            rejected(id, |_, b| {
                proof(b, LAMP, id).pairs.remove(pair);
            });
        }
        rejected("outside the set", |_, b| {
            proof(b, LAMP, id).pairs.push(15 * 15);
        });
    }
    // A closed set of pairs that leaves out where the runs begin: a broken lamp stays as it is.
    rejected("a pair of initial states is missing", |_, b| {
        proof(b, LAMP, "INDEPENDENT").pairs = vec![3 * 15 + 3];
    });
    // A pair of states that differ where they must not.
    rejected("INDEPENDENT: an observed", |_, b| {
        let pairs = &mut proof(b, LAMP, "INDEPENDENT").pairs;
        if let Err(place) = pairs.binary_search(&14) {
            pairs.insert(place, 14);
        }
    });
}

#[test]
fn a_run_that_does_something_else_is_rejected() {
    let (header, original) = parts(example());
    let mut runs = 0;
    for (task, body) in original.iter().enumerate() {
        for (number, proof) in body.proofs.iter().enumerate() {
            let id = &header.task[task].property[number].id;
            for (k, run) in proof.runs.iter().enumerate() {
                runs += 1;
                let change = |change: &dyn Fn(&mut Run)| {
                    rejected(id, |_, b| change(&mut b[task].proofs[number].runs[k]));
                };
                change(&|run| run.initial = 35);
                change(&|run| run.initial = u128::MAX);
                if run.steps.is_empty() {
                    continue; // a lost initial state
                }
                change(&|run| run.steps[0] = vec![(0, 7)]);
                change(&|run| run.steps[0] = vec![(99, 0)]);
                change(&|run| run.steps.clear());
                if run.steps.len() > 1 && id != "RESPONSE" {
                    change(&|run| drop(run.steps.pop()));
                }
                if run.repeats.is_some() {
                    change(&|run| run.repeats = None);
                    change(&|run| run.repeats = Some(run.steps.len()));
                }
            }
            if !proof.runs.is_empty() {
                rejected(id, |_, b| drop(b[task].proofs[number].runs.pop()));
                rejected(id, |_, b| {
                    let runs = &mut b[task].proofs[number].runs;
                    runs.push(runs[0].clone());
                });
            }
        }
    }
    assert!(runs >= 17, "{runs}");
    // Both runs of a property of two runs: other inputs than the listed ones must be the same.
    rejected("INDEPENDENT", |_, b| {
        let runs = &mut proof(b, BREAKS, "INDEPENDENT").runs;
        runs[1].steps[0].retain(|(input, _)| *input != 1);
    });
    rejected("INDEPENDENT", |_, b| {
        let runs = &mut proof(b, BREAKS, "INDEPENDENT").runs;
        runs[1] = runs[0].clone();
    });
    rejected("INDEPENDENT", |_, b| {
        let runs = &mut proof(b, BREAKS, "INDEPENDENT").runs;
        runs[0].steps = vec![vec![(input("lamp.on"), 1), (input("lamp.colour"), 1)]];
        runs[1].initial = runs[0].initial;
        runs[1].steps = vec![vec![]];
    });
}

#[test]
fn a_hidden_fault_is_rejected() {
    rejected("a range fault is not claimed: counter.add: sum", |h, b| {
        h.task[SUM].faults.clear();
        b[SUM].faults.clear();
    });
    rejected("no run shows the range fault", |h, _| {
        h.task[SUM].faults[0] = "other".into()
    });
    rejected("no run shows the range fault", |_, b| {
        drop(b[SUM].faults[0].steps.pop())
    });
    rejected("no run shows the range fault", |h, b| {
        h.task[LAMP].faults.push("counter.add: sum".into());
        b[LAMP].faults.push(Run::default());
    });
}

#[test]
fn weaker_and_partial_certificates_are_what_they_say() {
    // Nothing claimed about a property: accepted, and said.
    let weaker = forge(|h, b| {
        h.task[LAMP].property[0].verdict = Verdict::Open;
        h.task[LAMP].property[0].reason = "left out".into();
        b[LAMP].proofs[0] = Proof::default();
    });
    let confirmed = certified(&weaker).expect("confirmed");
    assert_eq!(
        confirmed.header.task[LAMP].property[0].verdict,
        Verdict::Open
    );
    // A counterexample alone needs no set of states.
    let alone = forge(|h, b| {
        for (task, body) in h.task.iter_mut().zip(b) {
            task.states = 0;
            body.states.clear();
            for (property, proof) in task.property.iter_mut().zip(&mut body.proofs) {
                if (property.id.as_str(), property.verdict) != ("FAIR", Verdict::Violated) {
                    property.verdict = Verdict::Open;
                    *proof = Proof::default();
                }
            }
        }
    });
    let confirmed = certified(&alone).expect("confirmed");
    let claimed: Vec<_> = claims(&confirmed);
    let claimed = claimed.iter().filter(|(_, _, v)| *v != Verdict::Open);
    let ids: Vec<&str> = claimed.map(|(_, id, _)| id.as_str()).collect();
    assert_eq!(ids, ["FAIR", "counter.add: sum"]);
}

#[test]
fn no_flipped_bit_goes_unnoticed() {
    let original = example();
    let mut bytes = original.to_vec();
    for place in 0..bytes.len() {
        for bit in 0..8 {
            bytes[place] ^= 1 << bit;
            assert!(certified(&bytes).is_err(), "byte {place}, bit {bit}");
            bytes[place] ^= 1 << bit;
        }
    }
    for length in 0..original.len() {
        assert!(certified(&original[..length]).is_err(), "{length} bytes");
    }
    assert!(certified(&[original, b"x"].concat()).is_err());
    assert_eq!(bytes, original);
}

/// A certificate with other bytes and a right checksum.
fn sealed(content: &[u8]) -> Vec<u8> {
    use sha2::{Digest, Sha256};
    [content, Sha256::digest(content).as_slice()].concat()
}

/// Other bytes, right checksum: no panic, and no claim that the original does not make.
fn harmless(content: &[u8]) -> bool {
    static ORIGINAL: LazyLock<Vec<(String, String, Verdict)>> =
        LazyLock::new(|| claims(&certified(example()).expect("confirmed")));
    match certified(&sealed(content)) {
        Err(_) => false,
        Ok(confirmed) => {
            // Texts that say nothing (the path of the subject, a reason) and ranks with room may differ.
            assert_eq!(claims(&confirmed), *ORIGINAL);
            true
        }
    }
}

#[test]
fn changed_bytes_with_a_right_checksum_claim_nothing_else() {
    let content = &example()[..example().len() - CHECKSUM];
    assert_eq!(sealed(content), example());
    // xorshift64, a fixed sequence: a test by samples.
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed % below as u64) as usize
    };
    let proofs = {
        let (_, proofs) = open(example()).expect("readable");
        content.len() - proofs.len()
    };
    let mut accepted = 0;
    for round in 0..6000 {
        let mut bytes = content.to_vec();
        // Mostly in the proofs: the header is compared text by text.
        let start = if round % 4 == 0 { 0 } else { proofs };
        for _ in 0..=random(3) {
            let place = start + random(bytes.len() - start);
            match random(4) {
                0 => bytes[place] = random(256) as u8,
                1 => bytes[place] ^= 1 << random(8),
                2 => {
                    bytes.remove(place);
                }
                _ => bytes.insert(place, random(256) as u8),
            }
        }
        accepted += u32::from(harmless(&bytes));
    }
    println!("6000 changed certificates, {accepted} of them with the same claims");
    for length in 0..content.len() {
        assert!(!harmless(&content[..length]), "{length} bytes");
    }
}

#[test]
fn lengths_in_the_file_do_not_decide_about_memory() {
    // A count of 2^63 in every place of the proofs.
    let (_, proofs) = open(example()).expect("readable");
    let content = &example()[..example().len() - CHECKSUM];
    let start = content.len() - proofs.len();
    let huge = [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f];
    for place in start..content.len() {
        let bytes = [&content[..place], &huge, &content[place + 1..]].concat();
        harmless(&bytes);
    }
    let line = content.iter().position(|b| *b == b'\n').expect("a line");
    let long = format!("stillpoint-certificate 1 {}", u64::MAX);
    let bytes = [long.as_bytes(), &content[line..]].concat();
    let reason = certified(&sealed(&bytes)).expect_err("refused");
    assert!(
        reason.to_string().contains("longer than the file"),
        "{reason}"
    );
}

#[test]
fn another_version_or_file_is_unreadable() {
    let text = String::from_utf8_lossy(&example()[..64]).into_owned();
    assert!(text.starts_with("stillpoint-certificate 1 "));
    let mut newer = example().to_vec();
    newer["stillpoint-certificate ".len()] = b'2';
    for (bytes, words) in [
        (newer, "version 2 of the format"),
        (b"".to_vec(), "no certificate"),
        (b"spec = \"x\"\n".to_vec(), "no certificate"),
        (vec![0; 4096], "no certificate"),
    ] {
        match certified(&bytes) {
            Err(Failure::Unreadable(reason)) => assert!(reason.contains(words), "{reason}"),
            other => panic!("{words}: {other:?}"),
        }
    }
    let nowhere = certify_bytes(example(), Some(Path::new("no/such/file.toml")), 1);
    assert!(matches!(nowhere, Err(Failure::Unreadable(r)) if r.contains("no such file")));
}
