//! The cycles of one state, made by hand from state to state, against the exploration of the same system.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use crate::common::{padding, random_table};
use stillpoint_model::{Held, Options, System, cycles, explore, initials};

#[test]
fn from_state_to_state_the_cycles_are_those_of_the_explorer() {
    let (mut faults, mut several) = (0, 0);
    for seed in 0..500 {
        let table = random_table(seed, 1, padding(0));
        let mut seen = BTreeSet::new();
        initials(&table, |_, state| {
            seen.insert(state.to_vec());
            ControlFlow::Continue(())
        });
        several += usize::from(seen.len() > 1);
        let mut open: Vec<Vec<i32>> = seen.iter().cloned().collect();
        let mut transitions = 0;
        while let Some(state) = open.pop() {
            let mut sum = 0;
            cycles(&table, &state, &[], |cycle| {
                sum += cycle.weight;
                match cycle.after {
                    Ok(after) => {
                        if seen.insert(after.to_vec()) {
                            open.push(after.to_vec());
                        }
                    }
                    Err(_) => faults += 1,
                }
                ControlFlow::Continue(())
            });
            assert_eq!(sum, table.combinations(), "seed {seed}");
            transitions += sum;
        }
        let report = explore(&table, &[], &Options::default(), &mut ()).expect("explored");
        assert_eq!(
            (seen.len() as u64, transitions),
            (report.states, report.transitions),
            "seed {seed}"
        );
    }
    assert!(faults > 0 && several > 0);
}

#[test]
fn inputs_held_take_their_share_of_the_cycles() {
    for seed in 0..200 {
        let table = random_table(seed, 1, padding(0));
        let made = |held: &[Held]| {
            let (mut sum, mut reached) = (0, BTreeSet::new());
            initials(&table, |_, state| {
                cycles(&table, state, held, |cycle| {
                    assert!(
                        cycle
                            .reads
                            .iter()
                            .all(|(input, _)| held.iter().all(|h| h.input != *input))
                    );
                    sum += cycle.weight;
                    reached.extend(cycle.after.ok().map(<[i32]>::to_vec));
                    ControlFlow::Continue(())
                });
                ControlFlow::Continue(())
            });
            (sum, reached)
        };
        let (sum, reached) = made(&[]);
        for (input, size) in (0u32..).zip(table.sizes) {
            let parts = (0..size).map(|value| made(&[Held { input, size, value }]));
            let parts = parts.reduce(|a, b| (a.0 + b.0, a.1.union(&b.1).cloned().collect()));
            assert_eq!(
                parts,
                Some((sum, reached.clone())),
                "seed {seed}, input {input}"
            );
        }
    }
}
