//! Which values of an input a renaming exchanges: where a wire of one instance says `chosen = 1` and the same wire of the
//! other one says `chosen = 2`, the values 1 and 2 of `chosen` change places. A guess like the others: it is checked.

use std::collections::BTreeMap;

use super::{Symmetry, selection};
use crate::bind::Bound;
use crate::ir::Node;

/// Completes a renaming with the values that its named expressions and rules suggest.
pub(super) fn values(bound: &Bound, guess: &mut Symmetry) {
    let system = &bound.system;
    let mut pairs = Vec::new();
    for (k, lazy) in system.lazies.iter().enumerate() {
        let image = &system.lazies[guess.lazies[k] as usize];
        compare(&lazy.value, &image.value, guess, &mut pairs);
    }
    for instance in &system.instances {
        let Some(first) = instance.states.clone().min() else {
            continue;
        };
        let to = guess.states[first as usize];
        let Some(image) = system.instances.iter().find(|i| i.states.contains(&to)) else {
            continue;
        };
        for (rule, counterpart) in instance.rules.iter().zip(&image.rules) {
            compare(&rule.when, &counterpart.when, guess, &mut pairs);
        }
    }
    let mut found: Vec<BTreeMap<i64, i64>> = vec![BTreeMap::new(); bound.inputs.len()];
    for (input, from, to) in pairs {
        found[input as usize].entry(from).or_insert(to);
    }
    // A value that stays where it is needs no entry, but one that others want to become is in the way.
    for map in &mut found {
        map.retain(|from, to| from != to);
    }
    guess.values = found;
}

/// Walks two expressions of the same shape and notes (input, constant, constant of the other).
fn compare(a: &Node, b: &Node, guess: &Symmetry, pairs: &mut Vec<(u32, i64, i64)>) {
    if let (Node::Binary(op, x, y), Node::Binary(same, u, v)) = (a, b) {
        if let (true, Some((input, from)), Some((image, to))) =
            (op == same, selection(x, y), selection(u, v))
        {
            if guess.inputs[input as usize] == image {
                pairs.push((input, from, to));
            }
            return;
        }
    }
    if std::mem::discriminant(a) == std::mem::discriminant(b) {
        for (x, y) in a.children().into_iter().zip(b.children()) {
            compare(x, y, guess, pairs);
        }
    }
}
