//! Types of resolved expressions.

use stillpoint_lang::ir::{BinaryOp, Node, Space, System, Ty, Var};

/// The variable of a cell; none if there is no such cell.
pub fn variable(system: &System, space: Space, k: u32) -> Option<&Var> {
    let k = k as usize;
    match space {
        Space::Param => system.params.get(k).map(|p| &p.var),
        Space::Before | Space::Now => system.states.get(k).map(|s| &s.var),
        Space::Input => system.inputs.get(k),
    }
}

/// The type of an expression where a cell or operator fixes it; a literal has none.
pub fn type_of(system: &System, node: &Node) -> Option<Ty> {
    match node {
        Node::Const(_) => None,
        Node::Cell(space, k) | Node::Element { space, base: k, .. } => {
            variable(system, *space, *k).map(|v| v.ty)
        }
        Node::Lazy(k) => system.lazies.get(*k as usize).map(|l| l.ty),
        Node::Not(_) => Some(Ty::Bool),
        Node::Neg(_) | Node::Abs(_) => Some(Ty::Int),
        Node::Binary(op, ..) if is_arithmetic(*op) => Some(Ty::Int),
        Node::Binary(..) => Some(Ty::Bool),
        Node::Sel(_, a, b) => type_of(system, a).or_else(|| type_of(system, b)),
        Node::Mux(_, v) | Node::Min(v) | Node::Max(v) => v.iter().find_map(|n| type_of(system, n)),
    }
}

/// Whether the result is a number and no truth value.
pub fn is_arithmetic(op: BinaryOp) -> bool {
    use BinaryOp::{Add, Div, Mod, Mul, Sub};
    matches!(op, Add | Sub | Mul | Div | Mod)
}
