//! What is known at a place of the generated step: which inputs are chosen, which named expressions have their value.

use std::collections::BTreeSet;

use stillpoint_lang::ir::{Node, Space};

use super::folded::Folded;

/// Whether something has its value at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// On no way to the place.
    No,
    /// On some ways: a flag tells.
    Maybe,
    /// On every way.
    Yes,
}

/// The knowledge at one place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Known {
    /// Inputs chosen.
    pub inputs: Vec<Status>,
    /// Named expressions evaluated.
    pub lazies: Vec<Status>,
}

impl Known {
    /// At the start of the cycle.
    pub fn nothing(folded: &Folded) -> Self {
        Self {
            inputs: vec![Status::No; folded.bound.inputs.len()],
            lazies: vec![Status::No; folded.lazies.len()],
        }
    }

    /// Where two ways meet.
    pub fn join(&mut self, other: &Known) {
        let pairs = self
            .inputs
            .iter_mut()
            .zip(&other.inputs)
            .chain(self.lazies.iter_mut().zip(&other.lazies));
        for (a, b) in pairs {
            if a != b {
                *a = Status::Maybe;
            }
        }
    }

    /// Whether an expression can be evaluated here as it stands.
    pub fn satisfies(&self, node: &Node) -> bool {
        let mut all = true;
        node.visit(&mut |n| {
            all &= match n {
                Node::Cell(Space::Input, k) => self.inputs[*k as usize] == Status::Yes,
                Node::Lazy(k) => self.lazies[*k as usize] == Status::Yes,
                Node::Element {
                    space: Space::Input,
                    base,
                    len,
                    ..
                } => (*base..base + len).all(|k| self.inputs[k as usize] == Status::Yes),
                _ => true,
            };
        });
        all
    }
}

/// For each named expression whether its value depends on no input, also not through others.
pub fn without_inputs(folded: &Folded) -> Vec<bool> {
    let mut memo = vec![None; folded.lazies.len()];
    (0..folded.lazies.len())
        .map(|k| free(folded, k, &mut memo))
        .collect()
}

fn free(folded: &Folded, k: usize, memo: &mut Vec<Option<bool>>) -> bool {
    if let Some(known) = memo[k] {
        return known;
    }
    let mut used = Vec::new();
    let mut free_here = true;
    folded.lazies[k].visit(&mut |n| match n {
        Node::Cell(Space::Input, _)
        | Node::Element {
            space: Space::Input,
            ..
        } => free_here = false,
        Node::Lazy(j) => used.push(*j as usize),
        _ => {}
    });
    let all = free_here && used.into_iter().all(|j| free(folded, j, memo));
    memo[k] = Some(all);
    all
}

/// The inputs that rules and properties of single cycles can read, directly or through named expressions.
pub fn read_anywhere(folded: &Folded) -> BTreeSet<usize> {
    let mut inputs = BTreeSet::new();
    let mut lazies = BTreeSet::new();
    let mut open = Vec::new();
    let mut see = |node: &Node, open: &mut Vec<usize>| {
        node.visit(&mut |n| match n {
            Node::Cell(Space::Input, k) => {
                inputs.insert(*k as usize);
            }
            Node::Element {
                space: Space::Input,
                base,
                len,
                ..
            } => {
                inputs.extend(*base as usize..(*base + *len) as usize);
            }
            Node::Lazy(k) => open.push(*k as usize),
            _ => {}
        });
    };
    for (_, rule) in folded.rules.iter().flatten() {
        see(&rule.when, &mut open);
        rule.then
            .iter()
            .for_each(|s| s.expressions(&mut |n| see(n, &mut open)));
    }
    folded
        .claims()
        .into_iter()
        .for_each(|k| see(&folded.atoms[k], &mut open));
    while let Some(k) = open.pop() {
        if lazies.insert(k) {
            see(&folded.lazies[k], &mut open);
        }
    }
    inputs
}
