//! Cones of influence: what decides the value of an expression, in this and in earlier cycles.

use crate::ir::{Instance, Node, Property, Space, Stmt, System};

/// The cells and named expressions that something depends on. Whatever decides one of them is in it too.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cone {
    pub(super) states: Vec<bool>,
    pub(super) inputs: Vec<bool>,
    pub(super) lazies: Vec<bool>,
}

fn count(marks: &[bool]) -> usize {
    marks.iter().filter(|m| **m).count()
}

fn joined(a: &[bool], b: &[bool]) -> Vec<bool> {
    a.iter().zip(b).map(|(a, b)| *a || *b).collect()
}

impl Cone {
    fn empty(system: &System) -> Self {
        Self {
            states: vec![false; system.states.len()],
            inputs: vec![false; system.inputs.len()],
            lazies: vec![false; system.lazies.len()],
        }
    }

    /// Whether state variable `k` is in it.
    pub fn has_state(&self, k: usize) -> bool {
        self.states.get(k).is_some_and(|m| *m)
    }

    /// Whether input `k` is in it.
    pub fn has_input(&self, k: usize) -> bool {
        self.inputs.get(k).is_some_and(|m| *m)
    }

    /// Number of its state variables.
    pub fn states(&self) -> usize {
        count(&self.states)
    }

    /// Number of its inputs.
    pub fn inputs(&self) -> usize {
        count(&self.inputs)
    }

    /// Both together: again a cone.
    pub fn join(&self, other: &Cone) -> Cone {
        Cone {
            states: joined(&self.states, &other.states),
            inputs: joined(&self.inputs, &other.inputs),
            lazies: joined(&self.lazies, &other.lazies),
        }
    }

    /// Whether the other one lies within it.
    pub fn contains(&self, other: &Cone) -> bool {
        self.join(other) == *self
    }
}

/// Collects a cone: what is marked and not yet followed waits in a list.
pub(super) struct Reach<'a> {
    system: &'a System,
    cone: Cone,
    states: Vec<u32>,
    lazies: Vec<u32>,
}

impl<'a> Reach<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        Self {
            system,
            cone: Cone::empty(system),
            states: Vec::new(),
            lazies: Vec::new(),
        }
    }

    /// Adds what a property speaks of.
    pub(super) fn property(mut self, property: &Property) -> Self {
        let (atoms, observed) = property.form.expressions();
        for k in atoms {
            self.read(&self.system.atoms[k]);
        }
        for k in observed {
            self.read(&self.system.observed[k]);
        }
        self
    }

    /// Adds the targets of every assignment that a step must check.
    pub(super) fn faults(mut self) -> Self {
        for rule in self.system.rules() {
            self.checked(&rule.then);
        }
        self
    }

    fn checked(&mut self, list: &'a [Stmt]) {
        for statement in list {
            match statement {
                Stmt::Assign {
                    base,
                    index,
                    checked: true,
                    ..
                } => self.mark(*base, index.as_ref().map_or(1, |(_, _, len)| *len)),
                Stmt::Assign { .. } => {}
                Stmt::If(branches, rest) => {
                    branches.iter().for_each(|(_, body)| self.checked(body));
                    self.checked(rest);
                }
            }
        }
    }

    /// Everything that decides what was added.
    pub(super) fn close(mut self) -> Cone {
        let system = self.system;
        loop {
            if let Some(k) = self.lazies.pop() {
                self.read(&system.lazies[k as usize].value);
            } else if let Some(cell) = self.states.pop() {
                let owner = system.instances.iter().find(|i| i.states.contains(&cell));
                if let Some(owner) = owner {
                    self.assigned(owner, cell);
                }
            } else {
                return self.cone;
            }
        }
    }

    /// What decides how a step of its machine changes a cell. The first rule that matches wins: so the guards of all rules up
    /// to the last one that assigns it count, whatever the rules between them do.
    fn assigned(&mut self, owner: &'a Instance, cell: u32) {
        let mut last = None;
        for (n, rule) in owner.rules.iter().enumerate() {
            if self.statements(&rule.then, cell) {
                last = Some(n);
            }
        }
        if let Some(last) = last {
            for rule in &owner.rules[..=last] {
                self.read(&rule.when);
            }
        }
    }

    /// Adds what decides the assignments to a cell in a list of statements; whether there is one.
    fn statements(&mut self, list: &'a [Stmt], cell: u32) -> bool {
        let mut any = false;
        for statement in list {
            match statement {
                Stmt::Assign {
                    base, index, value, ..
                } => {
                    let len = index.as_ref().map_or(1, |(_, _, len)| *len);
                    if !(*base..*base + len).contains(&cell) {
                        continue;
                    }
                    any = true;
                    if let Some((k, ..)) = index {
                        self.read(k);
                        // A computed index can mean any element: the array stays together.
                        self.mark(*base, len);
                    }
                    self.read(value);
                }
                Stmt::If(branches, rest) => {
                    // A branch runs if its guard is TRUE and none before it: they count up to the last branch that assigns.
                    let mut guards = 0;
                    for (n, (_, body)) in branches.iter().enumerate() {
                        if self.statements(body, cell) {
                            guards = n + 1;
                        }
                    }
                    if self.statements(rest, cell) {
                        guards = branches.len();
                    }
                    any |= guards > 0;
                    for (guard, _) in &branches[..guards] {
                        self.read(guard);
                    }
                }
            }
        }
        any
    }

    fn mark(&mut self, base: u32, len: u32) {
        for cell in base..base + len {
            if !std::mem::replace(&mut self.cone.states[cell as usize], true) {
                self.states.push(cell);
            }
        }
    }

    /// Adds what an expression reads.
    fn read(&mut self, node: &'a Node) {
        node.visit(&mut |n| {
            let (space, base, len) = match n {
                Node::Cell(space, k) => (*space, *k, 1),
                Node::Element {
                    space, base, len, ..
                } => (*space, *base, *len),
                Node::Lazy(k) => {
                    if !std::mem::replace(&mut self.cone.lazies[*k as usize], true) {
                        self.lazies.push(*k);
                    }
                    return;
                }
                _ => return,
            };
            match space {
                Space::Param => {}
                Space::Before | Space::Now => self.mark(base, len),
                Space::Input => {
                    self.cone.inputs[base as usize..(base + len) as usize].fill(true);
                }
            }
        });
    }
}
