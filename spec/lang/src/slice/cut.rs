//! Cuts a system down to a cone.

use super::cone::Cone;
use crate::bind::Bound;
use crate::ir::{Form, Instance, Node, Property, Rule, Space, Stmt};

/// New numbers of what stays.
struct Numbers(Vec<Option<u32>>);

impl Numbers {
    fn of(kept: &[bool]) -> Self {
        let mut next = 0;
        let number = |kept: &bool| {
            kept.then(|| {
                next += 1;
                next - 1
            })
        };
        Self(kept.iter().map(number).collect())
    }

    /// The new number; a cone is closed, so what is asked for has stayed.
    fn get(&self, old: u32) -> u32 {
        self.0.get(old as usize).copied().flatten().unwrap_or(0)
    }

    fn old(&self) -> Vec<u32> {
        (0..)
            .zip(&self.0)
            .filter_map(|(old, new)| new.map(|_| old))
            .collect()
    }
}

pub(super) struct Cut<'a> {
    whole: &'a Bound,
    cone: &'a Cone,
    states: Numbers,
    inputs: Numbers,
    lazies: Numbers,
}

/// What stays of a list.
fn kept<T: Clone>(list: &[T], marks: &[bool]) -> Vec<T> {
    let both = list.iter().zip(marks);
    both.filter(|(_, m)| **m).map(|(x, _)| x.clone()).collect()
}

impl<'a> Cut<'a> {
    pub(super) fn new(whole: &'a Bound, cone: &'a Cone) -> Self {
        Self {
            whole,
            cone,
            states: Numbers::of(&cone.states),
            inputs: Numbers::of(&cone.inputs),
            lazies: Numbers::of(&cone.lazies),
        }
    }

    /// The slice with these properties, which must speak of the cone only.
    pub(super) fn slice(&self, properties: &[usize]) -> super::Slice {
        let whole = &self.whole.system;
        let mut atoms = vec![false; whole.atoms.len()];
        let mut observed = vec![false; whole.observed.len()];
        for k in properties {
            let (a, o) = whole.properties[*k].form.expressions();
            a.into_iter().for_each(|k| atoms[k] = true);
            o.into_iter().for_each(|k| observed[k] = true);
        }
        let (atom, observation) = (Numbers::of(&atoms), Numbers::of(&observed));
        let mut system = whole.clone();
        system.states = kept(&whole.states, &self.cone.states);
        system.inputs = kept(&whole.inputs, &self.cone.inputs);
        system.lazies = kept(&whole.lazies, &self.cone.lazies);
        for lazy in &mut system.lazies {
            lazy.value = self.node(&lazy.value);
        }
        system.instances = whole
            .instances
            .iter()
            .filter_map(|i| self.instance(i))
            .collect();
        system.atoms = self.nodes(&kept(&whole.atoms, &atoms));
        system.observed = self.nodes(&kept(&whole.observed, &observed));
        system.properties = properties
            .iter()
            .map(|k| {
                let property = &whole.properties[*k];
                Property {
                    form: self.form(&property.form, &atom, &observation),
                    ..property.clone()
                }
            })
            .collect();
        system.unreached.clear();
        system.warnings.clear();
        super::Slice {
            bound: Bound {
                system,
                values: self.whole.values.clone(),
                states: kept(&self.whole.states, &self.cone.states),
                inputs: kept(&self.whole.inputs, &self.cone.inputs),
                initial: kept(&self.whole.initial, &self.cone.states),
            },
            states: self.states.old(),
            inputs: self.inputs.old(),
            atoms: atom.old(),
            observed: observation.old(),
            properties: properties.to_vec(),
        }
    }

    /// An instance with what assigns a cell that stays, and with the guards of all rules before that.
    fn instance(&self, instance: &Instance) -> Option<Instance> {
        let mut rules: Vec<Rule> = instance
            .rules
            .iter()
            .map(|rule| Rule {
                then: self.statements(&rule.then),
                ..rule.clone()
            })
            .collect();
        let last = rules.iter().rposition(|r| !r.then.is_empty());
        rules.truncate(last.map_or(0, |n| n + 1));
        for rule in &mut rules {
            rule.when = self.node(&rule.when);
        }
        let before = |end: u32| {
            let marks = &self.cone.states[..end as usize];
            marks.iter().filter(|m| **m).count() as u32
        };
        let states = before(instance.states.start)..before(instance.states.end);
        if rules.is_empty() && states.is_empty() {
            return None;
        }
        Some(Instance {
            rules,
            states,
            ..instance.clone()
        })
    }

    fn statements(&self, list: &[Stmt]) -> Vec<Stmt> {
        let mut out = Vec::new();
        for statement in list {
            match statement {
                Stmt::Assign {
                    base,
                    index,
                    value,
                    checked,
                    site,
                } => {
                    if self.cone.states[*base as usize] {
                        out.push(Stmt::Assign {
                            base: self.states.get(*base),
                            index: index.as_ref().map(|(k, lo, len)| (self.node(k), *lo, *len)),
                            value: self.node(value),
                            checked: *checked,
                            site: *site,
                        });
                    }
                }
                Stmt::If(branches, rest) => {
                    let rest = self.statements(rest);
                    let bodies: Vec<_> = branches.iter().map(|(_, b)| self.statements(b)).collect();
                    let guards = if rest.is_empty() {
                        let last = bodies.iter().rposition(|b| !b.is_empty());
                        last.map_or(0, |n| n + 1)
                    } else {
                        branches.len()
                    };
                    if guards > 0 {
                        let both = branches.iter().zip(bodies).take(guards);
                        let branches = both.map(|((g, _), body)| (self.node(g), body)).collect();
                        out.push(Stmt::If(branches, rest));
                    }
                }
            }
        }
        out
    }

    fn nodes(&self, list: &[Node]) -> Vec<Node> {
        list.iter().map(|n| self.node(n)).collect()
    }

    fn node(&self, node: &Node) -> Node {
        let mut place = |space: Space, k: u32| match space {
            Space::Param => (space, k),
            Space::Before | Space::Now => (space, self.states.get(k)),
            Space::Input => (space, self.inputs.get(k)),
        };
        match node {
            Node::Lazy(k) => Node::Lazy(self.lazies.get(*k)),
            other => other.placed(&mut place, &mut |n| self.node(n)),
        }
    }

    fn form(&self, form: &Form, atoms: &Numbers, observed: &Numbers) -> Form {
        let atom = |k: usize| atoms.get(k as u32) as usize;
        let some = |k: &Option<usize>| k.map(atom);
        match form {
            Form::Always { when, then } => Form::Always {
                when: some(when),
                then: atom(*then),
            },
            Form::LeadsTo {
                when,
                goal,
                within,
                fair,
                assuming,
            } => Form::LeadsTo {
                when: atom(*when),
                goal: atom(*goal),
                within: within.clone(),
                fair: fair.iter().map(|k| atom(*k)).collect(),
                assuming: some(assuming),
            },
            Form::Unless {
                when,
                holds,
                unless,
            } => Form::Unless {
                when: atom(*when),
                holds: atom(*holds),
                unless: atom(*unless),
            },
            Form::CanAlwaysReach { goal, using } => Form::CanAlwaysReach {
                goal: atom(*goal),
                using: some(using),
            },
            Form::Reachable { goal } => Form::Reachable { goal: atom(*goal) },
            Form::Independent {
                observe,
                of,
                condition,
            } => Form::Independent {
                observe: observe
                    .iter()
                    .map(|k| observed.get(*k as u32) as usize)
                    .collect(),
                of: of
                    .iter()
                    .filter(|k| self.cone.inputs[**k])
                    .map(|k| self.inputs.get(*k as u32) as usize)
                    .collect(),
                condition: some(condition),
            },
        }
    }
}
