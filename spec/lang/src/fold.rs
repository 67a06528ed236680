//! Constant folding (partial evaluation): what is left of expressions and effects when the parameters have their values.

use crate::bind::Bound;
use crate::eval::{Cells, Driven, Frame, value};
use crate::ir::{BinaryOp, Node, Rule, Space, Stmt};

/// Puts the parameter values of a system into its expressions.
pub struct Folder<'a> {
    bound: &'a Bound,
    inline: usize,
    lazies: Vec<Option<Node>>,
}

/// A system with its parameter values in every expression: what they settle reads nothing any more. Everything keeps its number; a rule
/// that cannot fire has the guard FALSE and no effect.
pub fn folded(bound: &Bound) -> Bound {
    // Names stay: inlined, one of a variable that is stepped meanwhile could have two values in one cycle.
    let mut folder = Folder::new(bound, 0);
    let mut out = bound.clone();
    let system = &mut out.system;
    for (k, lazy) in system.lazies.iter_mut().enumerate() {
        lazy.value = folder.lazy(k);
    }
    for instance in &mut system.instances {
        let mut kept = folder.rules(&instance.rules).into_iter().peekable();
        for (number, rule) in instance.rules.iter_mut().enumerate() {
            let left = kept.next_if(|(place, ..)| *place == number);
            let (when, then) =
                left.map_or((Node::Const(0), Vec::new()), |(_, when, then)| (when, then));
            (rule.when, rule.then) = (when, then);
        }
    }
    for node in system.atoms.iter_mut().chain(&mut system.observed) {
        *node = folder.node(node);
    }
    out
}

impl<'a> Folder<'a> {
    /// Named expressions of at most `inline` nodes, and constants, stand where they are used.
    pub fn new(bound: &'a Bound, inline: usize) -> Self {
        Folder {
            bound,
            inline,
            lazies: vec![None; bound.system.lazies.len()],
        }
    }

    /// The rules that can fire, up to the first one that always does: each with its place, guard and effect.
    pub fn rules(&mut self, rules: &[Rule]) -> Vec<(usize, Node, Vec<Stmt>)> {
        let mut kept = Vec::new();
        for (number, rule) in rules.iter().enumerate() {
            let when = self.node(&rule.when);
            if when == Node::Const(0) {
                continue;
            }
            let last = matches!(when, Node::Const(_));
            kept.push((number, when, self.statements(&rule.then)));
            if last {
                break;
            }
        }
        kept
    }

    /// The value of a named expression.
    pub fn lazy(&mut self, k: usize) -> Node {
        if let Some(node) = &self.lazies[k] {
            return node.clone();
        }
        let bound = self.bound;
        let node = self.node(&bound.system.lazies[k].value);
        self.lazies[k] = Some(node.clone());
        node
    }

    /// What is left of an expression.
    pub fn node(&mut self, node: &Node) -> Node {
        let range = match node {
            Node::Cell(Space::Before | Space::Now, k) => self.bound.states[*k as usize],
            Node::Cell(Space::Input, k) => self.bound.inputs[*k as usize],
            Node::Cell(Space::Param, k) => {
                return Node::Const(i64::from(self.bound.values[*k as usize]));
            }
            Node::Lazy(k) => {
                let value = self.lazy(*k as usize);
                let small = matches!(value, Node::Const(_)) || value.size() <= self.inline;
                return if small { value } else { node.clone() };
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
                let memory = &mut Driven {
                    frame: &mut Frame::empty(),
                    read: &mut |_| 0,
                };
                Node::Const(value(&node, cells, memory))
            }
            None => node,
        }
    }

    /// What is left of an effect.
    pub fn statements(&mut self, list: &[Stmt]) -> Vec<Stmt> {
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
