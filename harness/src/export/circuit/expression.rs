//! Expressions as terms.

use stillpoint_lang::ir::{BinaryOp, Node, Space, Ty};

use super::build::Builder;
use super::{Id, Op};
use crate::export::Unsupported;
use crate::export::types::{is_arithmetic, type_of, variable};

impl Builder<'_, '_> {
    /// Whether a cell holds a truth value.
    pub(super) fn holds_truth(&self, space: Space, k: u32) -> bool {
        variable(&self.folded.bound.system, space, k).is_some_and(|v| v.ty == Ty::Bool)
    }

    fn is_truth(&self, node: &Node) -> bool {
        type_of(&self.folded.bound.system, node) == Some(Ty::Bool)
    }

    /// A truth value.
    pub(super) fn truth(&mut self, node: &Node) -> Result<Id, Unsupported> {
        self.like(node, true)
    }

    /// A number.
    pub(super) fn number(&mut self, node: &Node) -> Result<Id, Unsupported> {
        self.like(node, false)
    }

    /// A truth value or a number. Which it is, the surroundings say: a literal alone does not.
    pub(super) fn like(&mut self, node: &Node, truth: bool) -> Result<Id, Unsupported> {
        match node {
            Node::Const(v) if truth => Ok(self.terms.truth(*v != 0)),
            Node::Const(v) => Ok(self.terms.number(*v)),
            Node::Cell(space, k) => Ok(self.cell(*space, *k)),
            Node::Lazy(k) => self.named(*k as usize, truth),
            Node::Element {
                space,
                base,
                lo,
                len,
                index,
            } => {
                let cells = (*base..base + len).map(|k| self.cell(*space, k)).collect();
                let index = self.number(index)?;
                self.pick(index, *lo, cells)
            }
            Node::Not(a) => {
                let a = self.truth(a)?;
                Ok(self.terms.not(a))
            }
            Node::Neg(a) => {
                let a = self.number(a)?;
                self.terms.neg(a)
            }
            Node::Abs(a) => {
                let a = self.number(a)?;
                self.terms.abs(a)
            }
            Node::Binary(op, a, b) => self.operator(*op, a, b),
            Node::Sel(g, a, b) => {
                let g = self.truth(g)?;
                let (a, b) = (self.like(a, truth)?, self.like(b, truth)?);
                self.terms.choice(g, b, a)
            }
            Node::Mux(k, values) => {
                let k = self.number(k)?;
                let values: Result<Vec<Id>, _> =
                    values.iter().map(|v| self.like(v, truth)).collect();
                self.pick(k, 0, values?)
            }
            Node::Min(values) => self.extreme(values, BinaryOp::Lt),
            Node::Max(values) => self.extreme(values, BinaryOp::Gt),
        }
    }

    fn operator(&mut self, op: BinaryOp, a: &Node, b: &Node) -> Result<Id, Unsupported> {
        use BinaryOp::{And, Or, Xor};
        let truth = match op {
            And | Or | Xor => true,
            _ if is_arithmetic(op) => false,
            // Both sides of a comparison have one type; a literal takes that of the other.
            _ => self.is_truth(a) || self.is_truth(b),
        };
        let (a, b) = (self.like(a, truth)?, self.like(b, truth)?);
        self.terms.binary(op, a, b)
    }

    fn cell(&mut self, space: Space, k: u32) -> Id {
        let bound = self.folded.bound;
        let truth = self.holds_truth(space, k);
        let k = k as usize;
        match space {
            Space::Param => {
                let value = bound.values[k];
                self.terms.variable(Op::State(k), truth, (value, value))
            }
            Space::Before => self.terms.variable(Op::State(k), truth, bound.states[k]),
            Space::Input => self.terms.variable(Op::Input(k), truth, bound.inputs[k]),
            Space::Now => self.values.now[k],
        }
    }

    /// A named expression, which has one value a cycle: whatever it reads of a state after its change must have its value
    /// when the first reads it.
    fn named(&mut self, k: usize, truth: bool) -> Result<Id, Unsupported> {
        if let Some(id) = self.named[k] {
            return Ok(id);
        }
        let folded = self.folded;
        let lazy = &folded.bound.system.lazies[k];
        let mut early = false;
        folded.lazies[k].visit(&mut |n| match n {
            Node::Cell(Space::Now, k) => early |= !self.stepped[*k as usize],
            Node::Element {
                space: Space::Now,
                base,
                len,
                ..
            } => early |= (*base..base + len).any(|k| !self.stepped[k as usize]),
            _ => {}
        });
        if early {
            return Err(Unsupported(format!(
                "`{}` is read before the state it speaks of has made its step",
                lazy.name
            )));
        }
        let id = self.like(&folded.lazies[k], truth)?;
        self.terms.name(id, "v_", &lazy.name);
        self.named[k] = Some(id);
        Ok(id)
    }

    /// The one of `values` whose number is `index`; the first has number `first`.
    fn pick(&mut self, index: Id, first: i64, mut values: Vec<Id>) -> Result<Id, Unsupported> {
        let Some(mut picked) = values.pop() else {
            return Ok(self.terms.number(0));
        };
        for (n, value) in values.into_iter().enumerate().rev() {
            let place = self.terms.number(first + n as i64);
            let here = self.terms.binary(BinaryOp::Eq, index, place)?;
            picked = self.terms.choice(here, value, picked)?;
        }
        Ok(picked)
    }

    /// The least (`<`) or greatest (`>`) value.
    fn extreme(&mut self, values: &[Node], order: BinaryOp) -> Result<Id, Unsupported> {
        let mut best = None;
        for value in values {
            let value = self.number(value)?;
            best = Some(match best {
                None => value,
                Some(other) if order == BinaryOp::Lt => self.terms.least(other, value)?,
                Some(other) => self.terms.greatest(other, value)?,
            });
        }
        Ok(best.unwrap_or_else(|| self.terms.number(0)))
    }
}
