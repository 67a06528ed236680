//! Parameter values put into a system: what they settle depends on nothing any more.

use crate::bind::Bound;
use crate::eval::{Cells, Frame, value};
use crate::interval::Ranges;
use crate::ir::{BinaryOp, Node, Rule, Space, Stmt};

/// `bound` with its parameter values in every expression. Cells, named expressions, atoms and properties keep their
/// numbers; rules that cannot fire are gone, and so are checks of values that fit these ranges.
pub(super) fn folded(bound: &Bound) -> Bound {
    let mut folder = Folder {
        bound,
        lazies: vec![None; bound.system.lazies.len()],
    };
    let mut out = bound.clone();
    let system = &mut out.system;
    for (k, lazy) in system.lazies.iter_mut().enumerate() {
        lazy.value = folder.lazy(k);
    }
    for instance in &mut system.instances {
        let mut rules = Vec::new();
        for rule in &instance.rules {
            let when = folder.node(&rule.when);
            if when == Node::Const(0) {
                continue;
            }
            let last = matches!(when, Node::Const(_));
            rules.push(Rule {
                when,
                then: folder.statements(&rule.then),
                ..rule.clone()
            });
            if last {
                break;
            }
        }
        instance.rules = rules;
    }
    for node in system.atoms.iter_mut().chain(&mut system.observed) {
        *node = folder.node(node);
    }
    let constant = |v: i32| Node::Const(i64::from(v));
    for (k, state) in system.states.iter_mut().enumerate() {
        (state.var.lo, state.var.hi) = (constant(bound.states[k].0), constant(bound.states[k].1));
        state.init = bound.initial[k].map(constant);
    }
    for (input, (lo, hi)) in system.inputs.iter_mut().zip(&bound.inputs) {
        (input.lo, input.hi) = (constant(*lo), constant(*hi));
    }
    unchecked(&mut out);
    out
}

/// Takes the check from assignments whose value fits whatever the state and the inputs are.
fn unchecked(bound: &mut Bound) {
    let system = &bound.system;
    let ranges = Ranges {
        params: &system.params,
        states: &system.states,
        inputs: &system.inputs,
        lazies: &system.lazies,
    };
    let mut instances = system.instances.clone();
    for rule in instances.iter_mut().flat_map(|i| &mut i.rules) {
        settle(&mut rule.then, &ranges, &bound.states);
    }
    bound.system.instances = instances;
}

fn settle(list: &mut [Stmt], ranges: &Ranges, states: &[(i32, i32)]) {
    for statement in list {
        match statement {
            Stmt::Assign {
                base,
                index,
                value,
                checked,
                ..
            } => {
                let (lo, hi) = ranges.of(value);
                let len = index.as_ref().map_or(1, |(_, _, len)| *len);
                let mut targets = (*base..*base + len).map(|k| states[k as usize]);
                *checked &= targets.any(|(a, b)| lo < i128::from(a) || hi > i128::from(b));
            }
            Stmt::If(branches, rest) => {
                for (_, body) in branches {
                    settle(body, ranges, states);
                }
                settle(rest, ranges, states);
            }
        }
    }
}

struct Folder<'a> {
    bound: &'a Bound,
    lazies: Vec<Option<Node>>,
}

impl Folder<'_> {
    fn lazy(&mut self, k: usize) -> Node {
        if let Some(node) = &self.lazies[k] {
            return node.clone();
        }
        let bound = self.bound;
        let node = self.node(&bound.system.lazies[k].value);
        self.lazies[k] = Some(node.clone());
        node
    }

    fn node(&mut self, node: &Node) -> Node {
        let range = match node {
            Node::Cell(Space::Before | Space::Now, k) => self.bound.states[*k as usize],
            Node::Cell(Space::Input, k) => self.bound.inputs[*k as usize],
            Node::Cell(Space::Param, k) => {
                return Node::Const(i64::from(self.bound.values[*k as usize]));
            }
            Node::Lazy(k) => {
                return match self.lazy(*k as usize) {
                    Node::Const(v) => Node::Const(v),
                    _ => node.clone(),
                };
            }
            _ => {
                let node = node.map(&mut |n| self.node(n));
                return self.simplified(node);
            }
        };
        match range {
            (lo, hi) if lo == hi => Node::Const(i64::from(lo)),
            _ => node.clone(),
        }
    }

    /// The value of an expression of constants; else what constant operands leave of it.
    fn simplified(&mut self, node: Node) -> Node {
        let constant = |n: &Node| match n {
            Node::Const(v) => Some(*v),
            _ => None,
        };
        let all = node.children().iter().all(|n| constant(n).is_some());
        let left = match &node {
            Node::Element {
                space,
                base,
                lo,
                index,
                ..
            } => constant(index).and_then(|k| {
                let cell = u32::try_from(k - lo).ok()?;
                Some(self.node(&Node::Cell(*space, base + cell)))
            }),
            Node::Binary(op, a, b) => match (op, constant(a), constant(b)) {
                (BinaryOp::And, Some(0), _) | (BinaryOp::And, _, Some(0)) => Some(Node::Const(0)),
                (BinaryOp::Or, Some(1), _) | (BinaryOp::Or, _, Some(1)) => Some(Node::Const(1)),
                (BinaryOp::And, Some(1), _) | (BinaryOp::Or, Some(0), _) => Some((**b).clone()),
                (BinaryOp::And, _, Some(1)) | (BinaryOp::Or, _, Some(0)) => Some((**a).clone()),
                _ => None,
            },
            Node::Sel(g, a, b) => match constant(g) {
                Some(0) => Some((**a).clone()),
                Some(_) => Some((**b).clone()),
                None => (a == b).then(|| (**a).clone()),
            },
            Node::Mux(k, values) => constant(k)
                .and_then(|k| usize::try_from(k).ok())
                .and_then(|k| values.get(k).cloned()),
            _ => None,
        };
        match left {
            Some(node) => node,
            // The loader has settled that no divisor is 0 and that 64 bits hold every result.
            None if all && !matches!(node, Node::Element { .. }) => {
                let cells = Cells {
                    params: &[],
                    lazies: &[],
                };
                Node::Const(value(&node, cells, &mut Frame::empty(), &mut |_| 0))
            }
            None => node,
        }
    }

    fn statements(&mut self, list: &[Stmt]) -> Vec<Stmt> {
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
                    let index = index.as_ref().map(|(k, lo, len)| (self.node(k), *lo, *len));
                    // A constant index names its cell.
                    let (base, index) = match index {
                        Some((Node::Const(k), lo, len)) => match u32::try_from(k - lo) {
                            Ok(offset) if offset < len => (base + offset, None),
                            _ => (*base, Some((Node::Const(k), lo, len))),
                        },
                        other => (*base, other),
                    };
                    out.push(Stmt::Assign {
                        base,
                        index,
                        value: self.node(value),
                        checked: *checked,
                        site: *site,
                    });
                }
                Stmt::If(branches, rest) => {
                    let mut kept = Vec::new();
                    let mut rest = rest.as_slice();
                    for (guard, body) in branches {
                        match self.node(guard) {
                            Node::Const(0) => {}
                            Node::Const(_) => {
                                rest = body;
                                break;
                            }
                            guard => kept.push((guard, self.statements(body))),
                        }
                    }
                    let rest = self.statements(rest);
                    if kept.is_empty() {
                        out.extend(rest);
                    } else {
                        out.push(Stmt::If(kept, rest));
                    }
                }
            }
        }
        out
    }
}
