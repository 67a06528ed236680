//! Reads through trivial wires: a port wired to an input, a state cell or a small expression over them costs nothing.

use crate::ir::{LazyKind, Node, Stmt, System};

/// Wired expressions of at most this many nodes are repeated at each reader instead of being kept in a cell.
const SMALL: usize = 3;

/// Replaces each reading of a trivial wire by what it is wired to.
pub(super) fn trivial_wires(system: &mut System) {
    // Wires to wires need one pass for each link of the chain.
    while let Some(table) = table(system) {
        for instance in &mut system.instances {
            for rule in &mut instance.rules {
                rule.when = through(&rule.when, &table);
                rule.then.iter_mut().for_each(|s| statement(s, &table));
            }
        }
        for lazy in &mut system.lazies {
            lazy.value = through(&lazy.value, &table);
        }
        for node in system.atoms.iter_mut().chain(&mut system.observed) {
            *node = through(node, &table);
        }
    }
}

/// For each wire that something reads and that is trivial, its value; none if nothing is left to replace.
fn table(system: &System) -> Option<Vec<Option<Node>>> {
    let mut read = vec![false; system.lazies.len()];
    system.nodes(&mut |n| {
        if let Node::Lazy(k) = n {
            read[*k as usize] = true;
        }
    });
    let trivial = |k: usize| {
        let lazy = &system.lazies[k];
        let mut nodes = 0;
        let mut plain = true;
        lazy.value.visit(&mut |n| {
            nodes += 1;
            plain &= !matches!(n, Node::Lazy(_)) || nodes == 1;
        });
        // A wire to a named expression is that expression; anything larger keeps its cell.
        lazy.kind == LazyKind::Wire
            && read[k]
            && plain
            && nodes <= SMALL
            && lazy.value != Node::Lazy(k as u32)
    };
    let out: Vec<Option<Node>> = (0..system.lazies.len())
        .map(|k| trivial(k).then(|| system.lazies[k].value.clone()))
        .collect();
    out.iter().any(Option::is_some).then_some(out)
}

fn through(node: &Node, table: &[Option<Node>]) -> Node {
    if let Node::Lazy(k) = node {
        if let Some(value) = &table[*k as usize] {
            return value.clone();
        }
    }
    node.map(&mut |child| through(child, table))
}

fn statement(s: &mut Stmt, table: &[Option<Node>]) {
    match s {
        Stmt::Assign { index, value, .. } => {
            if let Some((k, ..)) = index {
                *k = through(k, table);
            }
            *value = through(value, table);
        }
        Stmt::If(branches, rest) => {
            for (guard, body) in branches {
                *guard = through(guard, table);
                body.iter_mut().for_each(|s| statement(s, table));
            }
            rest.iter_mut().for_each(|s| statement(s, table));
        }
    }
}
