//! The conditions of properties as named expressions, each part of which is evaluated as soon as what it needs is known. So a condition
//! needs a single truth value between two stages, and the inputs that it speaks of may be forgotten.

use stillpoint_lang::ir::{BinaryOp, Lazy, LazyKind, Node, System, Ty};
use stillpoint_model::Condition;

use super::plan::Order;

/// Adds conditions to the named expressions of a system. Each result is a name or a constant.
pub(super) fn add(system: &mut System, order: &mut Order, conditions: &[Condition]) -> Vec<Node> {
    let mut all = Parts { system, order };
    let mut add = |condition: &Condition| {
        let mut operands = Vec::new();
        for (atom, value) in condition {
            let node = all.system.atoms[*atom].clone();
            operands.push(pushed(&node, !value));
        }
        let whole = joined(BinaryOp::And, operands);
        let placed = all.placed(&whole);
        match placed {
            Node::Const(v) => Node::Const(i64::from(v != 0)),
            other => all.named(other),
        }
    };
    conditions.iter().map(&mut add).collect()
}

/// The conjunction or disjunction of some expressions.
fn joined(op: BinaryOp, operands: Vec<Node>) -> Node {
    let all = operands.into_iter();
    let whole = all.reduce(|a, b| Node::Binary(op, Box::new(a), Box::new(b)));
    whole.unwrap_or(Node::Const(i64::from(op == BinaryOp::And)))
}

/// A truth value, negated if asked for, with the negations inside.
fn pushed(node: &Node, negated: bool) -> Node {
    match node {
        Node::Not(a) => pushed(a, !negated),
        Node::Binary(op @ (BinaryOp::And | BinaryOp::Or), a, b) => {
            let op = match (op, negated) {
                (BinaryOp::And, false) | (BinaryOp::Or, true) => BinaryOp::And,
                _ => BinaryOp::Or,
            };
            joined(op, vec![pushed(a, negated), pushed(b, negated)])
        }
        Node::Const(v) => Node::Const(i64::from((*v != 0) != negated)),
        other if negated => Node::Not(Box::new(other.clone())),
        other => other.clone(),
    }
}

/// The operands of a chain of one operator.
fn operands(op: BinaryOp, node: &Node, list: &mut Vec<Node>) {
    match node {
        Node::Binary(own, a, b) if *own == op => {
            operands(op, a, list);
            operands(op, b, list);
        }
        other => list.push(other.clone()),
    }
}

/// Whether an expression is a truth value by its form.
fn is_truth(node: &Node) -> bool {
    match node {
        Node::Not(_) => true,
        Node::Binary(op, ..) => !matches!(
            op,
            BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div | BinaryOp::Mod
        ),
        _ => false,
    }
}

struct Parts<'a> {
    system: &'a mut System,
    order: &'a mut Order,
}

impl Parts<'_> {
    /// An expression of the same value in which what can be evaluated earlier than the whole has a name.
    fn placed(&mut self, node: &Node) -> Node {
        match node {
            Node::Binary(op @ (BinaryOp::And | BinaryOp::Or), ..) => {
                let mut all = Vec::new();
                operands(*op, node, &mut all);
                let stage = |parts: &Self, node: &Node| parts.order.of(node);
                all.sort_by_key(|node| stage(self, node));
                let last = all.last().map_or(0, |node| stage(self, node));
                let mut chain: Vec<Node> = Vec::new();
                let mut at = 0;
                for operand in all {
                    let own = stage(self, &operand);
                    if own > at && !chain.is_empty() {
                        // What is decided by now is one truth value.
                        let known = joined(*op, std::mem::take(&mut chain));
                        chain.push(self.named(known));
                    }
                    at = own;
                    let placed = self.placed(&operand);
                    chain.push(placed);
                }
                debug_assert_eq!(at, last);
                joined(*op, chain)
            }
            Node::Const(_) | Node::Cell(..) | Node::Lazy(_) => node.clone(),
            other => {
                let whole = self.order.of(other);
                other.map(&mut |part| {
                    let placed = self.placed(part);
                    // A number may need more bits than a name has.
                    match is_truth(part) && self.order.of(part) < whole {
                        true => self.named(placed),
                        false => placed,
                    }
                })
            }
        }
    }

    /// A name for a truth value.
    fn named(&mut self, node: Node) -> Node {
        if matches!(node, Node::Const(_) | Node::Lazy(_)) {
            return node;
        }
        let known = self.system.lazies.iter().position(|l| l.value == node);
        let place = known.unwrap_or_else(|| {
            let stage = self.order.of(&node);
            self.order.push(stage);
            self.system.lazies.push(Lazy {
                name: String::new(),
                kind: LazyKind::Let,
                ty: Ty::Bool,
                value: node,
                lo: 0,
                hi: 1,
                ids: Vec::new(),
                text: String::new(),
            });
            self.system.lazies.len() - 1
        });
        Node::Lazy(place as u32)
    }
}
