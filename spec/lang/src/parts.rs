//! The parts of a system that have nothing in common but inputs: the connected components of what reads and writes what.
//!
//! Two instances belong to one part if one of them reads or writes a state variable that the other one reads or writes;
//! a property keeps everything it speaks of in one part. So each part makes its steps as if it were alone, and a cycle
//! of the system is a cycle of each part under the same inputs.

use crate::ir::{Node, Space, Stmt, System};

/// A part of a system.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Part {
    /// Its state variables, ascending.
    pub states: Vec<usize>,
    /// Its instances, in the order of their steps.
    pub instances: Vec<usize>,
    /// The atoms about its state variables, ascending. (One about none belongs to the part of its property.)
    pub atoms: Vec<usize>,
}

/// The parts of a system, in the order of their first state variables. Parts without a state variable do not exist.
pub fn parts(system: &System) -> Vec<Part> {
    let (states, instances) = (system.states.len(), system.instances.len());
    let atoms = system.atoms.len();
    let mut groups = Groups::new(states + instances + atoms);
    for (k, instance) in system.instances.iter().enumerate() {
        let place = states + k;
        for cell in instance.states.clone() {
            groups.unite(place, cell as usize);
        }
        let mut reader = Reader::new(system);
        for rule in &instance.rules {
            reader.node(&rule.when);
            rule.then.iter().for_each(|s| reader.statement(s));
        }
        reader.unite(&mut groups, place);
    }
    for (k, atom) in system.atoms.iter().enumerate() {
        let mut reader = Reader::new(system);
        reader.node(atom);
        reader.unite(&mut groups, states + instances + k);
    }
    for property in &system.properties {
        let (all, _) = property.form.expressions();
        for pair in all.windows(2) {
            groups.unite(states + instances + pair[0], states + instances + pair[1]);
        }
    }
    let mut found: Vec<(usize, Part)> = Vec::new();
    for cell in 0..states {
        let group = groups.find(cell);
        match found.iter_mut().find(|(g, _)| *g == group) {
            Some((_, part)) => part.states.push(cell),
            None => {
                let states = vec![cell];
                found.push((
                    group,
                    Part {
                        states,
                        ..Part::default()
                    },
                ));
            }
        }
    }
    for (group, part) in &mut found {
        let mut of = |from: usize, count: usize| -> Vec<usize> {
            (0..count)
                .filter(|k| groups.find(from + k) == *group)
                .collect()
        };
        part.instances = of(states, instances);
        part.atoms = of(states + instances, atoms);
    }
    found.into_iter().map(|(_, part)| part).collect()
}

/// Collects the state variables that expressions and statements mention, through named expressions.
struct Reader<'a> {
    system: &'a System,
    states: Vec<bool>,
    lazies: Vec<bool>,
}

impl<'a> Reader<'a> {
    fn new(system: &'a System) -> Self {
        Reader {
            system,
            states: vec![false; system.states.len()],
            lazies: vec![false; system.lazies.len()],
        }
    }

    fn cells(&mut self, space: Space, base: u32, len: u32) {
        if matches!(space, Space::Before | Space::Now) {
            let first = base as usize;
            self.states[first..first + len as usize].fill(true);
        }
    }

    fn node(&mut self, node: &Node) {
        let system = self.system;
        match node {
            Node::Cell(space, k) => self.cells(*space, *k, 1),
            Node::Element {
                space, base, len, ..
            } => self.cells(*space, *base, *len),
            Node::Lazy(k) => {
                let seen = std::mem::replace(&mut self.lazies[*k as usize], true);
                if !seen {
                    self.node(&system.lazies[*k as usize].value);
                }
            }
            _ => (),
        }
        node.children().into_iter().for_each(|n| self.node(n));
    }

    fn statement(&mut self, statement: &Stmt) {
        statement.expressions(&mut |n| self.node(n));
        self.targets(statement);
    }

    fn targets(&mut self, statement: &Stmt) {
        match statement {
            Stmt::Assign { base, index, .. } => {
                self.cells(
                    Space::Now,
                    *base,
                    index.as_ref().map_or(1, |(_, _, len)| *len),
                );
            }
            Stmt::If(branches, rest) => {
                let bodies = branches.iter().flat_map(|(_, body)| body).chain(rest);
                bodies.for_each(|s| self.targets(s));
            }
        }
    }

    fn unite(&self, groups: &mut Groups, place: usize) {
        for (cell, _) in self.states.iter().enumerate().filter(|(_, read)| **read) {
            groups.unite(place, cell);
        }
    }
}

/// Disjoint sets of numbers.
struct Groups(Vec<usize>);

impl Groups {
    fn new(size: usize) -> Self {
        Groups((0..size).collect())
    }

    fn find(&mut self, mut k: usize) -> usize {
        while self.0[k] != k {
            self.0[k] = self.0[self.0[k]];
            k = self.0[k];
        }
        k
    }

    fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        // The least number stands for the group.
        self.0[a.max(b)] = a.min(b);
    }
}
