//! Random netlists: the engines against enumeration of all their states, and what is written as AIGER against what it is of.

use std::collections::BTreeSet;

use crate::aiger::Read;
use crate::common::Random;
use stillpoint_model::proof::{
    Bounded, Budget, Candidates, Defect, Induction, Invariant, Lit, Netlist, Problem, Reachability,
    aiger, induction, inductive, reachability, value,
};

/// A netlist with something to look for; some have start values that are open, with a condition on them.
pub fn random_netlist(seed: u64) -> (Netlist, Lit) {
    let mut random = Random(seed);
    let mut netlist = Netlist::default();
    let (latches, inputs) = (1 + random.below(6), random.below(4));
    let mut known = Vec::new();
    for k in 0..latches {
        let init = match random.below(4) {
            0 => None,
            other => Some(other == 1),
        };
        known.push(netlist.latch(format!("l{k}"), init));
    }
    let states = known.clone();
    for k in 0..inputs {
        known.push(netlist.input(format!("i{k}")));
    }
    let graph = &mut netlist.graph;
    let pick = |random: &mut Random, known: &[Lit]| {
        known[random.below(known.len())].flipped(random.below(2) == 0)
    };
    let over_states = {
        let (a, b) = (pick(&mut random, &states), pick(&mut random, &states));
        graph.or(a, b)
    };
    for _ in 0..random.below(30) {
        let (a, b) = (pick(&mut random, &known), pick(&mut random, &known));
        let new = match random.below(3) {
            0 => graph.xor(a, b),
            _ => graph.and(a, b),
        };
        known.push(new);
    }
    let mut bad = Lit::TRUE;
    for _ in 0..1 + random.below(5) {
        let part = pick(&mut random, &known);
        bad = graph.and(bad, part);
    }
    for latch in &mut netlist.latches {
        latch.next = pick(&mut random, &known);
    }
    if random.below(3) == 0 {
        netlist.start.push(over_states);
    }
    if inputs > 1 && random.below(3) == 0 {
        let all: Vec<Lit> = netlist.inputs.iter().map(|i| i.lit).collect();
        let some = netlist.graph.or(all[0], !all[1]);
        netlist.assumed.push(some);
    }
    // As an input whose range depends on a parameter: there is always a value of it.
    if inputs > 0 && random.below(3) == 0 {
        let parameter = random.below(latches);
        netlist.latches[parameter].next = states[parameter];
        let at_most = states[parameter].flipped(random.below(2) == 0);
        let keeps = netlist.graph.or(!netlist.inputs[0].lit, at_most);
        netlist.assumed.push(keeps);
    }
    (netlist, bad)
}

fn bits(number: usize, count: usize) -> impl Iterator<Item = bool> {
    (0..count).map(move |k| number >> k & 1 == 1)
}

/// Values of all nodes in a state with inputs.
pub fn cycle(netlist: &Netlist, state: usize, inputs: usize) -> Vec<bool> {
    let mut leaves = vec![false; netlist.graph.size()];
    for (latch, bit) in netlist.latches.iter().zip(bits(state, 32)) {
        leaves[latch.lit.node()] = bit;
    }
    for (input, bit) in netlist.inputs.iter().zip(bits(inputs, 32)) {
        leaves[input.lit.node()] = bit;
    }
    netlist.graph.values(|node| leaves[node])
}

/// The length of a shortest run to a bad cycle, state by state.
pub fn naive(netlist: &Netlist, bad: Lit) -> Option<usize> {
    explored(netlist, bad).0
}

fn holds(values: &[bool], list: &[Lit]) -> bool {
    list.iter().all(|lit| value(values, *lit))
}

/// The states at the start.
fn starts(netlist: &Netlist) -> BTreeSet<usize> {
    let starts = (0..1 << netlist.latches.len()).filter(|state| {
        let right = netlist.latches.iter().zip(bits(*state, 32));
        let right = right
            .into_iter()
            .all(|(latch, bit)| latch.init.is_none_or(|init| init == bit));
        right && holds(&cycle(netlist, *state, 0), &netlist.start)
    });
    starts.collect()
}

/// Those candidates that are kept by every cycle from a state in which all of them hold, and hold at the start: by enumeration.
fn kept_by_enumeration(netlist: &Netlist, candidates: &[Lit]) -> Vec<Lit> {
    let starts: Vec<Vec<bool>> = (starts(netlist).iter())
        .map(|state| cycle(netlist, *state, 0))
        .collect();
    let mut kept = candidates.to_vec();
    kept.retain(|lit| starts.iter().all(|values| value(values, *lit)));
    loop {
        let before = kept.len();
        for state in 0..1 << netlist.latches.len() {
            for inputs in 0..1 << netlist.inputs.len() {
                let values = cycle(netlist, state, inputs);
                if !holds(&values, &netlist.assumed) || !holds(&values, &kept) {
                    continue;
                }
                let next = netlist.latches.iter().enumerate();
                let next = next.fold(0, |n, (k, l)| n | usize::from(value(&values, l.next)) << k);
                let values = cycle(netlist, next, 0);
                kept.retain(|lit| value(&values, *lit));
            }
        }
        if kept.len() == before {
            return kept;
        }
    }
}

/// The length of a shortest run to a bad cycle, and the states seen before it.
pub fn explored(netlist: &Netlist, bad: Lit) -> (Option<usize>, BTreeSet<usize>) {
    let mut level = starts(netlist);
    let mut seen = level.clone();
    for length in 1.. {
        let mut after = BTreeSet::new();
        for state in &level {
            for inputs in 0..1 << netlist.inputs.len() {
                let values = cycle(netlist, *state, inputs);
                if !holds(&values, &netlist.assumed) {
                    continue;
                }
                if value(&values, bad) {
                    return (Some(length), seen);
                }
                let next = netlist.latches.iter().enumerate();
                let next = next.fold(0, |n, (k, l)| n | usize::from(value(&values, l.next)) << k);
                after.insert(next);
            }
        }
        level = after.into_iter().filter(|s| seen.insert(*s)).collect();
        if level.is_empty() {
            return (None, seen);
        }
    }
    (None, seen)
}

/// Whether the netlist has a start state at all, and an input in each cycle: else nothing can be asked of it.
pub fn sensible(netlist: &Netlist) -> bool {
    naive(netlist, Lit::TRUE).is_some()
}

#[test]
fn engines_agree_with_enumeration_on_random_netlists() {
    let budget = Budget::default();
    let (mut reached, mut longest, mut proved, mut clauses) = (0, 0, 0, 0);
    for seed in 0..6000 {
        let (netlist, bad) = random_netlist(seed);
        if !sensible(&netlist) {
            continue;
        }
        let known = naive(&netlist, bad);
        let problem = Problem::new(&netlist, bad);
        let states = 1 << netlist.latches.len();
        let bounded = Bounded::new(&problem, &budget).within(states);
        let bounded = bounded.expect("time");
        assert_eq!(
            bounded.as_ref().map(|run| run.cycles.len()),
            known,
            "{seed}"
        );
        assert!(
            bounded.iter().all(|run| problem.shows(run)),
            "{seed}: bounded"
        );
        match induction(&problem, states + 1, &budget).expect("time") {
            Induction::Proved(..) => assert_eq!(known, None, "{seed}: induction"),
            Induction::Found(run) => {
                assert_eq!(Some(run.cycles.len()), known, "{seed}: induction");
            }
            Induction::Open => panic!("{seed}: induction must end"),
        }
        match reachability(&problem, &budget).expect("time").0 {
            Reachability::Proved(invariant) => {
                assert_eq!(known, None, "{seed}: reachability");
                assert_eq!(
                    invariant.check(&netlist, bad, &budget),
                    Ok(Ok(())),
                    "{seed}"
                );
                proved += 1;
                clauses += invariant.clauses.len();
            }
            Reachability::Found(run) => {
                let shortest = known.unwrap_or_else(|| panic!("{seed}: there is no run"));
                assert!(problem.shows(&run), "{seed}: {run:?}");
                assert!(run.cycles.len() >= shortest, "{seed}");
                reached += 1;
                longest = longest.max(shortest);
            }
        }
    }
    assert!(
        reached > 1000 && proved > 1000,
        "{reached} reached, {proved} proved"
    );
    assert!(
        longest > 5 && clauses > 300,
        "longest {longest}, {clauses} clauses"
    );
}

#[test]
fn candidates_that_are_kept_hold_in_every_reachable_state() {
    let (mut tried, mut kept_all, mut missed, mut fewer) = (0, 0, 0, 0);
    for seed in 0..1500 {
        let (mut netlist, _) = random_netlist(seed);
        if !sensible(&netlist) {
            continue;
        }
        let latches: Vec<Lit> = netlist.latches.iter().map(|l| l.lit).collect();
        let mut candidates = Vec::new();
        let mut flat = Candidates::default();
        let mut ordered = Candidates::default();
        let mut follows: Vec<Vec<usize>> = Vec::new();
        let mut add = |lit: Lit, stronger: Vec<usize>| {
            candidates.push(lit);
            flat.add(lit, Vec::new());
            follows.push(stronger.clone());
            ordered.add(lit, stronger)
        };
        let single: Vec<[usize; 2]> = (latches.iter())
            .map(|a| [*a, !*a].map(|lit| add(lit, Vec::new())))
            .collect();
        for (a, of_a) in latches.iter().zip(&single) {
            for (b, of_b) in latches.iter().zip(&single) {
                for (not_a, not_b) in [(false, false), (false, true), (true, true)] {
                    let either = netlist.graph.or(a.flipped(not_a), b.flipped(not_b));
                    add(
                        either,
                        vec![of_a[usize::from(not_a)], of_b[usize::from(not_b)]],
                    );
                }
            }
        }
        let kept = inductive(&netlist, &flat, &Budget::default()).expect("time");
        // Those that follow from what is kept are the ones that are kept where nothing is known to follow.
        let strongest = inductive(&netlist, &ordered, &Budget::default()).expect("time");
        for (k, stronger) in follows.iter().enumerate() {
            let known = |k: &usize| strongest.contains(k);
            let follows = known(&k) || stronger.iter().any(known);
            assert_eq!(kept.contains(&k), follows, "{seed}: {k}");
            assert!(!known(&k) || !stronger.iter().any(known), "{seed}: {k}");
        }
        let kept: Vec<Lit> = kept.into_iter().map(|k| candidates[k]).collect();
        let expected = kept_by_enumeration(&netlist, &candidates);
        assert_eq!(kept, expected, "{seed}");
        // Asked one by one it is the same set; where nothing is found out, one that is inductive.
        for late in [2000, 0] {
            (flat.soon, flat.late) = (0, late);
            let single = inductive(&netlist, &flat, &Budget::default()).expect("time");
            let single: Vec<Lit> = single.into_iter().map(|k| candidates[k]).collect();
            assert_eq!(single, kept_by_enumeration(&netlist, &single), "{seed}");
            assert!(single.iter().all(|lit| expected.contains(lit)), "{seed}");
            assert!(late == 0 || single == expected, "{seed}");
            fewer += usize::from(single.len() < expected.len());
        }
        let (_, states) = explored(&netlist, Lit::FALSE);
        for lit in &candidates {
            let mut cycles = states.iter().map(|state| cycle(&netlist, *state, 0));
            let holds = cycles.all(|values| value(&values, *lit));
            assert!(holds || !kept.contains(lit), "{seed}: {lit:?}");
            tried += usize::from(holds);
            missed += usize::from(holds && !kept.contains(lit));
        }
        kept_all += kept.iter().filter(|lit| **lit != Lit::TRUE).count();
    }
    assert!(
        kept_all > 1000 && missed > 0 && fewer > 0,
        "{kept_all} of {tried}, {missed} missed"
    );
}

/// A counter from 0 to 5 that never gets to 7.
fn counter() -> (Netlist, Lit) {
    let mut netlist = Netlist::default();
    let go = netlist.input("go".to_owned());
    let bits = [0, 1, 2].map(|k| netlist.latch(format!("n[{k}]"), Some(false)));
    let graph = &mut netlist.graph;
    let last = graph.all([bits[0], !bits[1], bits[2]]);
    let mut carry = go;
    for (k, bit) in bits.iter().enumerate() {
        let sum = graph.xor(*bit, carry);
        carry = graph.and(*bit, carry);
        netlist.latches[k].next = graph.choice(last, Lit::FALSE, sum);
    }
    let bad = graph.all(bits);
    (netlist, bad)
}

#[test]
fn a_weak_or_wrong_invariant_is_refused() {
    let (netlist, bad) = counter();
    let check = |clauses: &[&[(usize, bool)]]| {
        let clauses = clauses.iter().map(|c| c.to_vec()).collect();
        Invariant { clauses }
            .check(&netlist, bad, &Budget::default())
            .expect("time")
    };
    assert_eq!(check(&[]), Err(Defect::Bad));
    assert_eq!(check(&[&[(1, false), (2, false)]]), Ok(()));
    assert_eq!(check(&[&[(2, true)]]), Err(Defect::Start));
    assert_eq!(
        check(&[&[(0, false), (1, false), (2, false)]]),
        Err(Defect::Cycle)
    );
}

#[test]
fn a_run_that_is_none_is_refused() {
    let (netlist, _) = counter();
    let two = netlist.latches[1].lit;
    let problem = Problem::new(&netlist, two);
    let mut run = Bounded::new(&problem, &Budget::default())
        .within(9)
        .expect("time")
        .expect("a run");
    assert_eq!(run.cycles.len(), 3);
    assert!(problem.shows(&run));
    run.cycles[0] = vec![Some(false)];
    assert!(!problem.shows(&run));
    run.cycles[0] = vec![Some(true)];
    run.start[1] = Some(true);
    assert!(!problem.shows(&run));
}

#[test]
fn written_netlists_are_what_they_are_of() {
    for seed in 0..500 {
        let (netlist, bad) = random_netlist(seed);
        let marks = aiger::Marks {
            bad: vec![("bad".to_owned(), bad)],
            outputs: vec![("first".to_owned(), netlist.latches[0].next)],
            comment: vec!["random".to_owned()],
        };
        let ascii = Read::of(&aiger::aiger(&netlist, &marks, false));
        let binary = Read::of(&aiger::aiger(&netlist, &marks, true));
        assert_eq!(ascii, binary, "{seed}");
        assert_eq!(ascii.symbols["b0"], "bad");
        assert_eq!(ascii.symbols["i0"].is_empty(), netlist.inputs.is_empty());
        let own = netlist.latches.len();
        for (latch, read) in netlist.latches.iter().zip(&ascii.latches) {
            assert_eq!(latch.init, read.2);
        }
        let first = usize::from(ascii.latches.len() > own);
        for state in 0..1 << own {
            for inputs in 0..1 << netlist.inputs.len() {
                let values = cycle(&netlist, state, inputs);
                // The further latch tells the first cycle.
                let mut known: Vec<bool> = bits(inputs, netlist.inputs.len()).collect();
                known.extend(bits(state, own));
                known.extend((0..first).map(|_| false));
                let read = ascii.values(&known);
                assert_eq!(read.lit(ascii.bad[0]), value(&values, bad), "{seed}");
                let next = netlist.latches.iter().zip(&ascii.latches);
                for (latch, other) in next {
                    assert_eq!(read.lit(other.1), value(&values, latch.next), "{seed}");
                }
                let allowed = netlist.assumed.iter().chain(&netlist.start);
                let allowed = allowed.into_iter().all(|lit| value(&values, *lit));
                let read = ascii.constraints.iter().all(|lit| read.lit(*lit));
                assert_eq!(read, allowed, "{seed}");
            }
        }
    }
}
