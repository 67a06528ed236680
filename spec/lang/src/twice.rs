//! Two runs of a system side by side, as one system (self-composition): "does not depend on" as a sentence about single cycles.
//!
//! The second run gets the inputs of the first one; those that may differ have their own values where the condition holds in the first
//! run. In a cycle in which it then does not hold in the second run nothing is claimed, yet the runs go on: there may be more of them
//! than the property speaks of. What holds of all of them holds; what one of them breaks is open.

use std::collections::BTreeSet;

use crate::bind::Bound;
use crate::ir::{BinaryOp, Form, Instance, Lazy, LazyKind, Node, Property, Rule, Space, Stmt};

/// Two runs as one system. The state variables of the first run come first, then those of the second one; what no instance steps is
/// the same in both. The inputs are those of the first run, then those that may differ as the second one has them.
pub struct Twice {
    /// The system, with one property: where the condition holds in both runs, all that is observed agrees.
    pub bound: Bound,
    /// How many atoms one run has; those of the first one keep their numbers.
    pub atoms: usize,
    /// State variables that each run has by itself: of the first run, of the second one.
    pub pairs: Vec<(usize, usize)>,
    /// How many inputs one run has.
    pub inputs: usize,
    /// Those that may differ, in the order in which they stand behind these as the second run has them.
    pub differ: Vec<usize>,
}

/// Two runs of `bound` for a property that says that something does not depend on inputs. None for another property, for runs that begin
/// anywhere, and where an input that may differ is one of an array that is indexed.
pub fn twice(bound: &Bound, property: &Property) -> Option<Twice> {
    let Form::Independent {
        observe,
        of,
        condition,
    } = &property.form
    else {
        return None;
    };
    let system = &bound.system;
    let stepped = |k: u32| system.instances.iter().any(|i| i.states.contains(&k));
    let anywhere = |k: usize| stepped(k as u32) && system.states[k].init.is_none();
    if (0..system.states.len()).any(anywhere) {
        return None;
    }
    let mut indexed = false;
    system.nodes(&mut |node| {
        if let Node::Element {
            space: Space::Input,
            base,
            len,
            ..
        } = node
        {
            let read = *base as usize..(*base + *len) as usize;
            indexed |= of.iter().any(|k| read.contains(k));
        }
    });
    if indexed {
        return None;
    }
    let mut second = Second {
        states: (0..system.states.len() as u32)
            .map(|k| if stepped(k) { Some(k) } else { None })
            .collect(),
        inputs: vec![None; system.inputs.len()],
        names: (system.lazies.len() + of.len()) as u32,
    };
    let mut out = bound.clone();
    let own = second.states.iter_mut().flatten();
    for (next, place) in (system.states.len() as u32..).zip(own) {
        let k = std::mem::replace(place, next) as usize;
        let mut state = system.states[k].clone();
        state.var.name = format!("{}'", state.var.name);
        out.system.states.push(state);
        out.states.push(bound.states[k]);
        out.initial.push(bound.initial[k]);
    }
    // The inputs of the second run are named after what the first run has settled.
    let holds = condition.map(|k| system.atoms[k].clone());
    for k in of {
        let mut var = system.inputs[*k].clone();
        var.name = format!("{}'", var.name);
        let (own, same) = (out.system.inputs.len() as u32, *k as u32);
        let cell = |k| Box::new(Node::Cell(Space::Input, k));
        let (lo, hi) = bound.inputs[*k];
        second.inputs[*k] = Some(out.system.lazies.len() as u32);
        out.system.lazies.push(Lazy {
            name: var.name.clone(),
            kind: LazyKind::Wire,
            ty: var.ty,
            value: match &holds {
                Some(holds) => Node::Sel(Box::new(holds.clone()), cell(same), cell(own)),
                None => *cell(own),
            },
            lo: i64::from(lo),
            hi: i64::from(hi),
            ids: Vec::new(),
            text: String::new(),
        });
        out.system.inputs.push(var);
        out.inputs.push((lo, hi));
    }
    for lazy in &system.lazies {
        let value = second.node(&lazy.value);
        let name = format!("{}'", lazy.name);
        out.system.lazies.push(Lazy {
            name,
            value,
            ..lazy.clone()
        });
    }
    let atoms: Vec<Node> = system.atoms.iter().map(|n| second.node(n)).collect();
    let observed: Vec<Node> = system.observed.iter().map(|n| second.node(n)).collect();
    let copies: Vec<Instance> = system
        .instances
        .iter()
        .map(|i| second.instance(i))
        .collect();
    out.system.instances = ordered(bound, holds.as_ref(), &copies);
    let both = match condition {
        Some(k) => and(system.atoms[*k].clone(), atoms[*k].clone()),
        None => Node::Const(1),
    };
    let same = |k: &usize| {
        let pair = (system.observed[*k].clone(), observed[*k].clone());
        Node::Binary(BinaryOp::Eq, Box::new(pair.0), Box::new(pair.1))
    };
    let agree = observe.iter().map(same).reduce(and);
    let count = system.atoms.len();
    out.system.atoms.extend(atoms);
    out.system
        .atoms
        .extend([both, agree.unwrap_or(Node::Const(1))]);
    out.system.observed.clear();
    out.system.properties = vec![Property {
        form: Form::Always {
            when: Some(2 * count),
            then: 2 * count + 1,
        },
        ..property.clone()
    }];
    let pair = |(k, place): (usize, &Option<u32>)| place.map(|other| (k, other as usize));
    Some(Twice {
        bound: out,
        atoms: count,
        pairs: (0..).zip(&second.states).filter_map(pair).collect(),
        inputs: system.inputs.len(),
        differ: of.clone(),
    })
}

fn and(a: Node, b: Node) -> Node {
    Node::Binary(BinaryOp::And, Box::new(a), Box::new(b))
}

/// The instances of both runs in the order of stepping: those of the first run that settle whether the condition holds, then the same of the
/// second one, then by turns, so that what both need of the inputs is needed for a short time.
fn ordered(bound: &Bound, holds: Option<&Node>, copies: &[Instance]) -> Vec<Instance> {
    let instances = &bound.system.instances;
    let mut cells = BTreeSet::new();
    if let Some(node) = holds {
        settling(bound, node, &mut BTreeSet::new(), &mut cells);
    }
    let settled = |i: &Instance| cells.iter().any(|k| i.states.contains(k));
    let first = instances.iter().rposition(settled).map_or(0, |k| k + 1);
    let mut list: Vec<Instance> = instances[..first].to_vec();
    list.extend_from_slice(&copies[..first]);
    for pair in instances.iter().zip(copies).skip(first) {
        list.extend([pair.0.clone(), pair.1.clone()]);
    }
    list
}

/// The state variables whose new values an expression reads.
fn settling(bound: &Bound, node: &Node, names: &mut BTreeSet<u32>, cells: &mut BTreeSet<u32>) {
    let mut more = Vec::new();
    node.visit(&mut |node| {
        cells.extend(node.cells(Space::Now));
        match node {
            Node::Lazy(k) if names.insert(*k) => more.push(*k),
            _ => {}
        }
    });
    for k in more {
        settling(bound, &bound.system.lazies[k as usize].value, names, cells);
    }
}

/// The second run in terms of both.
struct Second {
    /// By state variable the one of the second run; none where both have the same.
    states: Vec<Option<u32>>,
    /// By input the name of the one that the second run has; none where both have the same.
    inputs: Vec<Option<u32>>,
    /// Its named expressions begin here.
    names: u32,
}

impl Second {
    fn node(&self, node: &Node) -> Node {
        match node {
            Node::Lazy(k) => return Node::Lazy(self.names + *k),
            Node::Cell(Space::Input, k) => {
                if let Some(name) = self.inputs[*k as usize] {
                    return Node::Lazy(name);
                }
            }
            _ => {}
        }
        // The elements of an array are stepped by one instance, or all are the same.
        let mut place = |space, k: u32| match space {
            Space::Before | Space::Now => (space, self.states[k as usize].unwrap_or(k)),
            Space::Input | Space::Param => (space, k),
        };
        node.placed(&mut place, &mut |part| self.node(part))
    }

    fn instance(&self, instance: &Instance) -> Instance {
        let rule = |rule: &Rule| Rule {
            name: format!("{}'", rule.name),
            when: self.node(&rule.when),
            then: self.statements(&rule.then),
            ..rule.clone()
        };
        let rules = instance.rules.iter().map(rule).collect();
        let moved = |k: u32| self.states.get(k as usize).copied().flatten();
        let count = instance.states.len() as u32;
        let start = moved(instance.states.start).unwrap_or(0);
        Instance {
            name: format!("{}'", instance.name),
            machine: instance.machine.clone(),
            rules,
            states: start..start + count,
        }
    }

    fn statements(&self, list: &[Stmt]) -> Vec<Stmt> {
        list.iter()
            .map(|statement| match statement {
                Stmt::Assign {
                    base,
                    index,
                    value,
                    checked,
                    site,
                } => Stmt::Assign {
                    base: self.states[*base as usize].unwrap_or(*base),
                    index: index.as_ref().map(|(k, lo, len)| (self.node(k), *lo, *len)),
                    value: self.node(value),
                    checked: *checked,
                    site: *site,
                },
                Stmt::If(branches, rest) => Stmt::If(
                    branches
                        .iter()
                        .map(|(guard, body)| (self.node(guard), self.statements(body)))
                        .collect(),
                    self.statements(rest),
                ),
            })
            .collect()
    }
}
