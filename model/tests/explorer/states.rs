//! Sets of states of random netlists against enumeration: the reachable ones, what gets lost, runs without an end.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::Random;
use crate::proof::{cycle, explored, naive, random_netlist, sensible};
use stillpoint_model::proof::{Budget, Condition, Lit, Netlist, Problem, Run, States, value};

/// The states of all latches.
fn states(netlist: &Netlist) -> States {
    let latches = netlist.latches.iter().map(|latch| latch.lit);
    let inputs = netlist.inputs.iter().map(|input| input.lit);
    let all: Vec<Lit> = latches.chain(inputs).collect();
    let whole = Problem::with(netlist, Lit::FALSE, &all);
    // What is not needed is forgotten at every opportunity, and each latch is a part of the cycle.
    States::sized(&whole, &Budget::default(), (0, 0)).expect("no budget")
}

fn condition(states: &mut States, netlist: &Netlist, lit: Lit) -> Condition {
    let condition = states.condition(&netlist.graph, lit);
    condition.expect("no budget").expect("in the cone")
}

/// The edges of the reachable states, each with the values of its nodes.
fn edges(netlist: &Netlist) -> Vec<(usize, usize, Vec<bool>)> {
    let mut list = Vec::new();
    for state in explored(netlist, Lit::FALSE).1 {
        for inputs in 0..1 << netlist.inputs.len() {
            let values = cycle(netlist, state, inputs);
            if netlist.assumed.iter().all(|lit| value(&values, *lit)) {
                let next = netlist.latches.iter().enumerate();
                let next = next.fold(0, |n, (k, l)| n | usize::from(value(&values, l.next)) << k);
                list.push((state, next, values));
            }
        }
    }
    list
}

/// All that is reached from states by some edges, these states included.
fn closure(begin: impl IntoIterator<Item = usize>, edges: &[(usize, usize)]) -> BTreeSet<usize> {
    let mut seen: BTreeSet<usize> = begin.into_iter().collect();
    loop {
        let new = edges.iter().filter(|(a, _)| seen.contains(a)).map(|e| e.1);
        let new: Vec<usize> = new.filter(|b| !seen.contains(b)).collect();
        if new.is_empty() {
            return seen;
        }
        seen.extend(new);
    }
}

/// The states of a run, one more than it has cycles.
fn played(netlist: &Netlist, run: &Run) -> Vec<(usize, Vec<bool>)> {
    let bit = |value: &Option<bool>, k: usize| usize::from(value.unwrap_or(false)) << k;
    let mut state = run.start.iter().enumerate().map(|(k, v)| bit(v, k)).sum();
    let mut list = Vec::new();
    for inputs in &run.cycles {
        let inputs = inputs.iter().enumerate().map(|(k, v)| bit(v, k)).sum();
        let values = cycle(netlist, state, inputs);
        assert!(netlist.assumed.iter().all(|lit| value(&values, *lit)));
        let next = netlist.latches.iter().enumerate();
        let next = next.map(|(k, l)| usize::from(value(&values, l.next)) << k);
        list.push((state, values.clone()));
        state = next.sum();
    }
    list.push((state, Vec::new()));
    list
}

#[test]
fn reachable_states_are_counted() {
    let (mut most, mut found) = (0, 0);
    for seed in 0..3000 {
        let (netlist, bad) = random_netlist(seed);
        if !sensible(&netlist) {
            continue;
        }
        let mut all = states(&netlist);
        let bad_states = condition(&mut all, &netlist, bad);
        let run = all.reach(Some(bad_states)).expect("no budget");
        assert_eq!(
            run.as_ref().map(|run| run.cycles.len()),
            naive(&netlist, bad),
            "{seed}"
        );
        let problem = Problem::new(&netlist, bad);
        assert!(run.iter().all(|run| problem.shows(run)), "{seed}");
        found += usize::from(run.is_some());
        assert_eq!(all.reach(None), Ok(None), "{seed}");
        let known = explored(&netlist, Lit::FALSE).1.len();
        assert_eq!(all.count(), Some(known as u128), "{seed}");
        most = most.max(known);
    }
    assert!(most > 40 && found > 1000, "{most} states, {found} runs");
}

#[test]
fn lost_states_and_runs_without_an_end_are_those_of_enumeration() {
    let (mut lost, mut never_lost, mut endless, mut ending, mut twice) = (0, 0, 0, 0, 0);
    for seed in 0..3000 {
        let (netlist, goal) = random_netlist(seed);
        if !sensible(&netlist) {
            continue;
        }
        let mut random = Random(seed + 77);
        let mut some =
            || Lit::of(1 + random.below(netlist.graph.size() - 1)).flipped(random.below(2) == 0);
        let (using, begin, fair) = (some(), some(), [some(), some()]);
        let fair = &fair[..random.below(3)];
        let all = edges(&netlist);
        let mut states = states(&netlist);
        let of = |states: &mut States, lit: Lit| condition(states, &netlist, lit);

        // Backwards from the goal by edges of cycles that are `using`.
        let back: Vec<(usize, usize)> = (all.iter())
            .filter(|(.., values)| value(values, using))
            .map(|(a, b, _)| (*b, *a))
            .collect();
        let goals = all
            .iter()
            .filter(|(.., values)| value(values, goal))
            .map(|e| e.0);
        let good = closure(goals, &back);
        let (a, b) = (of(&mut states, using), of(&mut states, goal));
        let found = states.lost(a, b).expect("no budget");
        let reached = explored(&netlist, Lit::FALSE).1;
        assert_eq!(found.is_some(), !reached.is_subset(&good), "{seed}");
        match found {
            Some(run) => {
                let end = played(&netlist, &run).last().expect("a state").0;
                assert!(!good.contains(&end), "{seed}");
                lost += 1;
            }
            None => never_lost += 1,
        }

        // A component of edges that are `using` with each condition on an inner edge.
        let stay: Vec<(usize, usize)> = back.iter().map(|(b, a)| (*a, *b)).collect();
        let from: BTreeMap<usize, BTreeSet<usize>> =
            reached.iter().map(|s| (*s, closure([*s], &stay))).collect();
        let inner = |s: usize, a: usize, b: usize| from[&s].contains(&a) && from[&b].contains(&s);
        let goes_round = |s: usize| {
            let met = |lit: Lit| {
                let mut inside = all.iter().filter(|(.., v)| value(v, using));
                inside.any(|(a, b, v)| inner(s, *a, *b) && value(v, lit))
            };
            met(Lit::TRUE) && fair.iter().all(|lit| met(*lit))
        };
        let round: BTreeSet<usize> = reached.iter().copied().filter(|s| goes_round(*s)).collect();
        let endless_from = |s: usize| from[&s].iter().any(|t| round.contains(t));
        let expected = all
            .iter()
            .any(|(_, b, v)| value(v, begin) && endless_from(*b));
        let c = of(&mut states, begin);
        let told: Vec<Condition> = fair.iter().map(|lit| of(&mut states, *lit)).collect();
        let lasso = states.forever(c, a, &told).expect("no budget");
        assert_eq!(lasso.is_some(), expected, "{seed}");
        let Some(lasso) = lasso else {
            ending += 1;
            continue;
        };
        endless += 1;
        let cycles = played(&netlist, &lasso.run);
        let back_to = lasso.back_to.expect("few states");
        assert_eq!(
            cycles[back_to].0,
            cycles.last().expect("a state").0,
            "{seed}"
        );
        let inside = &cycles[back_to..cycles.len() - 1];
        assert!(!inside.is_empty(), "{seed}");
        twice += usize::from(inside.len() > 2);
        assert!(
            fair.iter()
                .all(|lit| inside.iter().any(|(_, v)| value(v, *lit))),
            "{seed}"
        );
        // The cycle with `begin` is before the loop, and all behind it stay.
        let stays = |list: &[(usize, Vec<bool>)]| list.iter().all(|(_, v)| value(v, using));
        let begins = (0..back_to)
            .any(|k| value(&cycles[k].1, begin) && stays(&cycles[k + 1..cycles.len() - 1]));
        assert!(begins, "{seed}");
    }
    assert!(
        lost > 300 && never_lost > 300 && endless > 300 && ending > 300 && twice > 20,
        "{lost} {never_lost} {endless} {ending} {twice}"
    );
}
