//! "Does not depend on": two runs side by side.

use crate::common::{Random, Table, random_table, replay};
use std::collections::BTreeSet;
use stillpoint_model::{Choices, Form, Options, Property, Report, System, Twin, Verdict, explore};

fn judge(twin: &Twin<Table>) -> Report {
    let form = Form::Always {
        when: Some(Twin::<Table>::BOTH),
        then: Twin::<Table>::AGREE,
    };
    let report = explore(
        twin,
        &[Property {
            id: "p".into(),
            form,
        }],
        &Options::default(),
        &mut (),
    )
    .unwrap();
    assert!(report.complete);
    report
}

/// All inputs of a cycle, fixed.
struct Fixed([u32; 3]);

impl Choices for Fixed {
    fn choose(&mut self, input: u32, _: u32) -> u32 {
        self.0[input as usize]
    }
}

/// The naive answer: all pairs of full input combinations from all reachable pairs of states. Gives whether `during`
/// ever held in both, and the length of the shortest disagreement.
fn naive(
    table: &Table,
    listed: &[u32],
    during: Option<usize>,
    observed: &[usize],
) -> (bool, Option<u64>) {
    let [p, q, r] = table.sizes;
    let inputs: Vec<[u32; 3]> = (0..p)
        .flat_map(|a| (0..q).flat_map(move |b| (0..r).map(move |c| [a, b, c])))
        .collect();
    let step = |state: usize, inputs: [u32; 3]| {
        let mut work = table.work();
        let mut before = vec![77; table.domains.len()];
        before[0] = (state / 3) as i32 - 1;
        before[1] = (state % 3) as i32;
        let mut after = before.clone();
        table
            .next(&mut work, &before, &mut Fixed(inputs), &mut after)
            .ok()?;
        let mut atom = |a: usize| table.atom(&mut work, a, &mut Fixed(inputs)).unwrap();
        let on = during.is_none_or(&mut atom);
        Some((
            Table::number(&after),
            on,
            observed.iter().map(|a| atom(*a)).collect::<Vec<_>>(),
        ))
    };
    let mut frontier: BTreeSet<(usize, usize)> = table.initial.iter().map(|s| (*s, *s)).collect();
    let mut seen = frontier.clone();
    let mut ever = false;
    let mut shortest = None;
    for depth in 1.. {
        let mut next = BTreeSet::new();
        for (s, t) in frontier {
            for a in &inputs {
                for b in &inputs {
                    let differ: Vec<usize> = (0..3).filter(|i| a[*i] != b[*i]).collect();
                    if differ.iter().any(|i| !listed.contains(&(*i as u32))) {
                        continue;
                    }
                    let (Some(x), Some(y)) = (step(s, *a), step(t, *b)) else {
                        continue;
                    };
                    let both = x.1 && y.1;
                    if !differ.is_empty() && !both {
                        continue;
                    }
                    ever |= both;
                    if both && x.2 != y.2 {
                        shortest = shortest.or(Some(depth));
                    }
                    if seen.insert((x.0, y.0)) {
                        next.insert((x.0, y.0));
                    }
                }
            }
        }
        if next.is_empty() {
            break;
        }
        frontier = next;
    }
    (ever, shortest)
}

#[test]
fn agrees_with_all_pairs_of_runs() {
    let mut verdicts = [0; 3];
    for seed in 0..1200 {
        let table = random_table(seed, 4, Vec::new());
        let mut random = Random(seed);
        let listed: Vec<u32> = (0..3).filter(|_| random.percent(40)).collect();
        let during = if random.percent(70) { Some(0) } else { None };
        let observed = [1, 2];
        let twin = Twin::new(
            &table,
            listed
                .iter()
                .map(|i| (*i, table.sizes[*i as usize]))
                .collect(),
            during,
            observed.to_vec(),
        );
        let report = judge(&twin);
        let judgement = &report.properties[0];
        let (ever, shortest) = naive(&table, &listed, during, &observed);
        match judgement.verdict {
            Verdict::Vacuous => {
                verdicts[0] += 1;
                assert!(!ever, "seed {seed}");
            }
            Verdict::Holds => {
                verdicts[1] += 1;
                assert!(ever && shortest.is_none(), "seed {seed}");
            }
            Verdict::Violated => {
                verdicts[2] += 1;
                assert_eq!(judgement.length, shortest, "seed {seed}");
                // The two runs replay on the system itself, and disagree in the last cycle.
                let trace = judgement.trace.as_ref().unwrap();
                let [one, other] = twin
                    .split(trace)
                    .map(|run| replay(&table, &run, 4).pop().unwrap());
                assert!(
                    observed.iter().any(|a| one.atoms[*a] != other.atoms[*a]),
                    "seed {seed}"
                );
                assert!(
                    during.is_none_or(|a| one.atoms[a] && other.atoms[a]),
                    "seed {seed}"
                );
            }
            other => panic!("seed {seed}: {other:?}"),
        }
    }
    assert!(verdicts.iter().all(|count| *count > 50), "{verdicts:?}");
}
