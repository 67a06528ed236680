//! State variables that merely count down.

use crate::ir::{BinaryOp, Node, Space, Stmt, System};

/// The state variables that some rule counts down and that no rule changes otherwise than by counting down or by setting
/// them anew, ascending.
pub fn countdowns(system: &System) -> Vec<usize> {
    let mut kinds = vec![Kind::Constant; system.states.len()];
    for rule in system.rules() {
        rule.then.iter().for_each(|s| assignments(s, &mut kinds));
    }
    let found = kinds.iter().enumerate();
    found
        .filter_map(|(cell, kind)| (*kind == Kind::CountsDown).then_some(cell))
        .collect()
}

/// What the assignments seen so far make of a variable.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Constant,
    CountsDown,
    Other,
}

fn assignments(statement: &Stmt, kinds: &mut [Kind]) {
    match statement {
        Stmt::Assign {
            base, index, value, ..
        } => {
            let (first, len) = (*base as usize, index.as_ref().map_or(1, |(.., len)| *len));
            for (cell, kind) in kinds.iter_mut().enumerate().skip(first).take(len as usize) {
                let reads = mentions(value, cell);
                *kind = match *kind {
                    Kind::Other => Kind::Other,
                    _ if index.is_none() && reads && is_less(value, cell) => Kind::CountsDown,
                    _ if reads => Kind::Other,
                    kind => kind,
                };
            }
        }
        Stmt::If(branches, rest) => {
            let bodies = branches.iter().flat_map(|(_, body)| body).chain(rest);
            bodies.for_each(|s| assignments(s, kinds));
        }
    }
}

/// `t - c` with a positive constant, or the greater of that and a constant.
fn is_less(value: &Node, cell: usize) -> bool {
    match value {
        Node::Binary(BinaryOp::Sub, a, b) => {
            is_cell(a, cell) && matches!(**b, Node::Const(c) if c > 0)
        }
        Node::Max(values) => {
            let (constant, other): (Vec<&Node>, Vec<&Node>) =
                values.iter().partition(|v| matches!(v, Node::Const(_)));
            !constant.is_empty() && matches!(other[..], [one] if is_less(one, cell))
        }
        _ => false,
    }
}

fn is_cell(node: &Node, cell: usize) -> bool {
    matches!(node, Node::Cell(Space::Now | Space::Before, k) if *k as usize == cell)
}

fn mentions(value: &Node, cell: usize) -> bool {
    let mut found = false;
    value.visit(&mut |node| {
        found |= is_cell(node, cell)
            // What a named expression or an element reads is not looked at: it may be the variable.
            || matches!(node, Node::Lazy(_) | Node::Element { .. });
    });
    found
}
