//! Interval arithmetic over expressions: which values can an expression have at all?

use crate::ir::{BinaryOp, Lazy, Node, Param, Space, State, Var};

/// Both ends included; wide enough that no combination of 64-bit values overflows it.
pub(crate) type Interval = (i128, i128);

/// The cells whose ranges bound an expression.
#[derive(Clone, Copy)]
pub(crate) struct Ranges<'a> {
    pub params: &'a [Param],
    pub states: &'a [State],
    pub inputs: &'a [Var],
    pub lazies: &'a [Lazy],
}

impl Ranges<'_> {
    fn var(&self, var: &Var) -> Interval {
        (self.of(&var.lo).0, self.of(&var.hi).1)
    }

    fn cell(&self, space: Space, k: usize) -> Interval {
        let var = match space {
            Space::Param => self.params.get(k).map(|p| &p.var),
            Space::Before | Space::Now => self.states.get(k).map(|s| &s.var),
            Space::Input => self.inputs.get(k),
        };
        var.map_or((0, 0), |v| self.var(v))
    }

    /// All values `node` can have for any parameters, state and inputs of their ranges.
    pub(crate) fn of(&self, node: &Node) -> Interval {
        match node {
            Node::Const(v) => (i128::from(*v), i128::from(*v)),
            Node::Cell(space, k) => self.cell(*space, *k as usize),
            Node::Lazy(k) => self
                .lazies
                .get(*k as usize)
                .map_or((0, 0), |l| (i128::from(l.lo), i128::from(l.hi))),
            Node::Element {
                space, base, len, ..
            } => (*base..*base + *len)
                .map(|k| self.cell(*space, k as usize))
                .reduce(join)
                .unwrap_or((0, 0)),
            Node::Not(_) => (0, 1),
            Node::Neg(a) => {
                let (lo, hi) = self.of(a);
                (-hi, -lo)
            }
            Node::Abs(a) => {
                let (lo, hi) = self.of(a);
                if lo >= 0 {
                    (lo, hi)
                } else {
                    (if hi >= 0 { 0 } else { -hi }, hi.max(-lo))
                }
            }
            Node::Sel(_, a, b) => join(self.of(a), self.of(b)),
            Node::Mux(_, values) => values
                .iter()
                .map(|v| self.of(v))
                .reduce(join)
                .unwrap_or((0, 0)),
            Node::Min(values) => values
                .iter()
                .map(|v| self.of(v))
                .reduce(|a, b| (a.0.min(b.0), a.1.min(b.1)))
                .unwrap_or((0, 0)),
            Node::Max(values) => values
                .iter()
                .map(|v| self.of(v))
                .reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)))
                .unwrap_or((0, 0)),
            Node::Binary(op, a, b) => self.binary(*op, a, b),
        }
    }

    fn binary(&self, op: BinaryOp, a: &Node, b: &Node) -> Interval {
        let corners = |f: &dyn Fn(i128, i128) -> i128| {
            let (x, y) = (self.of(a), self.of(b));
            let all = [f(x.0, y.0), f(x.0, y.1), f(x.1, y.0), f(x.1, y.1)];
            (
                all.iter().copied().min().unwrap_or(0),
                all.iter().copied().max().unwrap_or(0),
            )
        };
        match op {
            BinaryOp::Add => corners(&|x, y| x.saturating_add(y)),
            BinaryOp::Sub => corners(&|x, y| x.saturating_sub(y)),
            BinaryOp::Mul => corners(&|x, y| x.saturating_mul(y)),
            BinaryOp::Div => {
                let (lo, hi) = self.of(a);
                let most = hi.abs().max(lo.abs());
                // The quotient's size is at most the dividend's; exact for a positive constant divisor.
                match self.of(b) {
                    (d, e) if d == e && d > 0 => (lo / d, hi / d),
                    (d, _) if d > 0 => (lo.min(0), hi.max(0)),
                    _ => (-most, most),
                }
            }
            BinaryOp::Mod => {
                let (d, e) = self.of(b);
                let most = (d.abs().max(e.abs()) - 1).max(0);
                let (lo, hi) = self.of(a);
                (
                    if lo < 0 { (-most).max(lo) } else { 0 },
                    if hi > 0 { most.min(hi) } else { 0 },
                )
            }
            _ => (0, 1),
        }
    }
}

fn join(a: Interval, b: Interval) -> Interval {
    (a.0.min(b.0), a.1.max(b.1))
}
