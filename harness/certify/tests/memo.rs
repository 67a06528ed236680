//! What the checker looks up is what the interpreter does: on walks at random through every shipped system.

mod shipped;

use std::collections::BTreeSet;

use shipped::{Random, side_by_side, subjects};
use stillpoint_certify::cycle::Cycle;
use stillpoint_certify::states::Radix;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;

/// The step with all inputs given, and the number of the state after it.
fn step(bound: &Bound, radix: &Radix, state: u128, inputs: &[i32]) -> (Frame, Result<u128, u32>) {
    let mut before = vec![0; bound.states.len()];
    assert!(radix.state(state, &mut before));
    let mut frame = Frame::new(bound);
    frame.start(&before);
    let made = bound.step(&mut frame, &mut |k| inputs[k]);
    let after = made.map(|()| radix.index(&frame.now).expect("a state"));
    (frame, after)
}

/// So many cycles of a state are compared at most.
const MOST: usize = 60;

/// Compares the cycles of states on a walk, of which `atoms` are asked; how many cycles, and from how many states all of them.
fn compare(bound: &Bound, radix: &Radix, atoms: &[usize], random: &mut Random) -> (usize, usize) {
    let mut cycles = Cycle::new(bound, radix, &[(1, atoms.to_vec())]);
    let first = |(init, range): (&Option<i32>, &(i32, i32))| init.unwrap_or(range.0);
    let initial: Vec<i32> = bound.initial.iter().zip(&bound.states).map(first).collect();
    let mut state = radix.index(&initial).expect("a state");
    let (mut compared, mut whole) = (0, 0);
    for _ in 0..12 {
        let mut made = 0;
        let mut found = BTreeSet::new();
        let each = cycles.each(state, |cycle, result| {
            // What was not read does not matter.
            let mut inputs = random.inputs(bound);
            let given = |cycle: &Cycle, inputs: &mut Vec<i32>| {
                for (k, above) in cycle.inputs() {
                    let (lo, _) = bound.inputs[k as usize];
                    inputs[k as usize] = lo.wrapping_add_unsigned(above);
                }
            };
            given(cycle, &mut inputs);
            let after = result.map(|()| cycle.after());
            let (frame, expected) = step(bound, radix, state, &inputs);
            assert_eq!(after, expected, "{}", bound.system.name);
            found.insert((after, None));
            for k in atoms.iter().filter(|_| after.is_ok()) {
                cycle.all(|cycle| {
                    let value = cycle.atom(*k);
                    given(cycle, &mut inputs);
                    let expected = bound.atom(*k, &mut frame.clone(), &mut |i| inputs[i]);
                    assert_eq!(value, expected, "{}, atom {k}", bound.system.name);
                    found.insert((after, Some((*k, value))));
                    true
                });
            }
            made += 1;
            if made < MOST { Ok(()) } else { Err(()) }
        });
        compared += made;
        // No cycle is left out.
        let mut next = state;
        for _ in 0..20 {
            let inputs = random.inputs(bound);
            let (mut frame, after) = step(bound, radix, state, &inputs);
            if each.is_ok() {
                assert!(found.contains(&(after, None)), "{}", bound.system.name);
                for k in atoms.iter().filter(|_| after.is_ok()) {
                    let value = bound.atom(*k, &mut frame, &mut |i| inputs[i]);
                    let seen = found.contains(&(after, Some((*k, value))));
                    assert!(seen, "{}, atom {k}", bound.system.name);
                }
            }
            next = after.unwrap_or(next);
        }
        state = next;
        whole += usize::from(each.is_ok());
    }
    (compared, whole)
}

/// Compares every so many-th system from one on: systems, cycles, states of which all cycles were compared.
fn share(bounds: &[&Bound], from: usize, step: usize) -> [usize; 3] {
    let mut count = [0; 3];
    for (k, bound) in bounds.iter().enumerate().skip(from).step_by(step) {
        let Some(radix) = Radix::new(bound) else {
            continue;
        };
        let mut random = Random(88_172_645_463_325_252 + k as u64);
        let all: Vec<usize> = (0..bound.system.atoms.len()).collect();
        // The fewer atoms are asked, the more cycles are the same.
        for atoms in [&all[..], &all[..all.len().min(1)]] {
            let (cycles, states) = compare(bound, &radix, atoms, &mut random);
            count[1] += cycles;
            count[2] += states;
        }
        count[0] += 1;
    }
    count
}

#[test]
fn what_is_looked_up_is_what_the_interpreter_does() {
    let subjects = subjects();
    let bounds: Vec<&Bound> = subjects.iter().flat_map(|s| &s.bounds).collect();
    let [systems, compared, whole] = side_by_side(|from, step| share(&bounds, from, step));
    println!("{systems} systems, {compared} cycles, all of {whole} states");
    assert!(
        systems > 200 && compared > 50_000 && whole > 2_000,
        "{systems}, {compared}, {whole}"
    );
}
