//! Terms: each stands once, however often it is used.

use std::collections::HashMap;

use stillpoint_lang::ir::BinaryOp;

use crate::export::Unsupported;
use crate::export::folded::{Range, arithmetic, hull};
use crate::export::types::is_arithmetic;

/// Number of a term.
pub type Id = usize;

/// What the value of a term is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sort {
    /// A truth value.
    Truth,
    /// A number of this range, both ends included.
    Number(i64, i64),
}

impl Sort {
    /// The range of the numbers, truth values as 0 and 1.
    pub fn range(self) -> Range {
        match self {
            Sort::Truth => (0, 1),
            Sort::Number(lo, hi) => (lo, hi),
        }
    }
}

/// How a term comes to its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Op {
    /// TRUE or FALSE.
    Truth(bool),
    /// A number.
    Number(i64),
    /// A state variable at the start of the cycle.
    State(usize),
    /// An input.
    Input(usize),
    /// Logical negation.
    Not(Id),
    /// Arithmetic negation.
    Neg(Id),
    /// Operator with two operands. XOR and the comparisons `=` and `<>` also take truth values.
    Binary(BinaryOp, Id, Id),
    /// Condition, value where it holds, value elsewhere.
    Choice(Id, Id, Id),
}

impl Op {
    /// The terms it consists of.
    pub fn parts(self) -> impl Iterator<Item = Id> {
        let [a, b, c] = match self {
            Op::Truth(_) | Op::Number(_) | Op::State(_) | Op::Input(_) => [None; 3],
            Op::Not(a) | Op::Neg(a) => [Some(a), None, None],
            Op::Binary(_, a, b) => [Some(a), Some(b), None],
            Op::Choice(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        [a, b, c].into_iter().flatten()
    }

    /// Whether it consists of no others.
    pub fn is_leaf(self) -> bool {
        self.parts().next().is_none()
    }
}

/// The terms of a circuit.
#[derive(Debug, Default)]
pub struct Terms {
    list: Vec<(Op, Sort)>,
    /// Terms by kind, number of the operator, and parts.
    known: HashMap<[i64; 4], Id>,
    labels: HashMap<Id, (&'static str, String)>,
}

impl Terms {
    /// How a term comes to its value.
    pub fn op(&self, id: Id) -> Op {
        self.list[id].0
    }

    /// What its value is.
    pub fn sort(&self, id: Id) -> Sort {
        self.list[id].1
    }

    /// Whether its value is a truth value.
    pub fn is_truth(&self, id: Id) -> bool {
        self.sort(id) == Sort::Truth
    }

    /// What it stands for, if something with a name: the prefix of the kind, the name.
    pub fn label(&self, id: Id) -> Option<(&'static str, &str)> {
        self.labels
            .get(&id)
            .map(|(prefix, name)| (*prefix, name.as_str()))
    }

    /// Names a term, unless it has a name already or is a variable or a constant.
    pub(super) fn name(&mut self, id: Id, prefix: &'static str, name: &str) {
        if !self.op(id).is_leaf() {
            self.labels
                .entry(id)
                .or_insert_with(|| (prefix, name.to_owned()));
        }
    }

    /// The terms that `roots` consist of, themselves included, in rising order.
    pub fn below(&self, roots: &[Id]) -> Vec<Id> {
        let mut seen = vec![false; self.list.len()];
        let mut open = roots.to_vec();
        while let Some(id) = open.pop() {
            if !std::mem::replace(&mut seen[id], true) {
                open.extend(self.op(id).parts());
            }
        }
        (0..seen.len()).filter(|id| seen[*id]).collect()
    }

    fn add(&mut self, op: Op, sort: Sort) -> Id {
        let number = |id: Id| id as i64;
        let key = match op {
            Op::Truth(v) => [0, i64::from(v), 0, 0],
            Op::Number(v) => [1, v, 0, 0],
            Op::State(k) => [2, number(k), 0, 0],
            Op::Input(k) => [3, number(k), 0, 0],
            Op::Not(a) => [4, number(a), 0, 0],
            Op::Neg(a) => [5, number(a), 0, 0],
            Op::Choice(a, b, c) => [6, number(a), number(b), number(c)],
            Op::Binary(op, a, b) => [7 + op as i64, number(a), number(b), 0],
        };
        *self.known.entry(key).or_insert_with(|| {
            self.list.push((op, sort));
            self.list.len() - 1
        })
    }

    /// A number term, whose range is known not to exceed 32 bits.
    fn number_term(&mut self, op: Op, (lo, hi): Range) -> Result<Id, Unsupported> {
        if lo < i64::from(i32::MIN) || hi > i64::from(i32::MAX) {
            return Err(Unsupported(format!(
                "an expression can have the values {lo} to {hi}, which needs more than 32 bits"
            )));
        }
        if lo == hi {
            return Ok(self.number(lo));
        }
        let id = self.add(op, Sort::Number(lo, hi));
        // The same term may have been made where less was known of its range.
        if let Sort::Number(a, b) = &mut self.list[id].1 {
            (*a, *b) = ((*a).max(lo), (*b).min(hi));
        }
        Ok(id)
    }

    fn range(&self, id: Id) -> Range {
        self.sort(id).range()
    }

    pub(super) fn truth(&mut self, value: bool) -> Id {
        self.add(Op::Truth(value), Sort::Truth)
    }

    pub(super) fn number(&mut self, value: i64) -> Id {
        self.add(Op::Number(value), Sort::Number(value, value))
    }

    /// A state variable or input; `truth` if it holds a truth value.
    pub(super) fn variable(&mut self, op: Op, truth: bool, (lo, hi): (i32, i32)) -> Id {
        let (lo, hi) = (i64::from(lo), i64::from(hi));
        match truth {
            true if lo == hi => self.truth(lo != 0),
            true => self.add(op, Sort::Truth),
            false if lo == hi => self.number(lo),
            false => self.add(op, Sort::Number(lo, hi)),
        }
    }

    pub(super) fn not(&mut self, a: Id) -> Id {
        match self.op(a) {
            Op::Truth(v) => self.truth(!v),
            Op::Not(b) => b,
            _ => self.add(Op::Not(a), Sort::Truth),
        }
    }

    pub(super) fn and(&mut self, a: Id, b: Id) -> Id {
        match (self.op(a), self.op(b)) {
            (Op::Truth(false), _) | (_, Op::Truth(true)) => a,
            (_, Op::Truth(false)) | (Op::Truth(true), _) => b,
            _ if a == b => a,
            _ => self.add(Op::Binary(BinaryOp::And, a, b), Sort::Truth),
        }
    }

    pub(super) fn or(&mut self, a: Id, b: Id) -> Id {
        match (self.op(a), self.op(b)) {
            (Op::Truth(true), _) | (_, Op::Truth(false)) => a,
            (_, Op::Truth(true)) | (Op::Truth(false), _) => b,
            _ if a == b => a,
            _ => self.add(Op::Binary(BinaryOp::Or, a, b), Sort::Truth),
        }
    }

    pub(super) fn neg(&mut self, a: Id) -> Result<Id, Unsupported> {
        let (lo, hi) = self.range(a);
        self.number_term(Op::Neg(a), (-hi, -lo))
    }

    /// Comparisons and arithmetic; both operands have the same sort.
    pub(super) fn binary(&mut self, op: BinaryOp, a: Id, b: Id) -> Result<Id, Unsupported> {
        use BinaryOp::{And, Eq, Ge, Gt, Le, Lt, Ne, Or, Xor};
        let ((a_lo, a_hi), (b_lo, b_hi)) = (self.range(a), self.range(b));
        let term = Op::Binary(op, a, b);
        // What the ranges alone decide.
        let decided = match op {
            And => return Ok(self.and(a, b)),
            Or => return Ok(self.or(a, b)),
            Lt | Ge if a_hi < b_lo => Some(op == Lt),
            Lt | Ge if a_lo >= b_hi => Some(op == Ge),
            Le | Gt if a_hi <= b_lo => Some(op == Le),
            Le | Gt if a_lo > b_hi => Some(op == Gt),
            Eq | Ne | Xor if a == b => Some(op == Eq),
            Eq | Ne | Xor if a_hi < b_lo || b_hi < a_lo => Some(op != Eq),
            Eq | Ne | Xor if a_lo == a_hi && (b_lo, b_hi) == (a_lo, a_hi) => Some(op == Eq),
            _ => None,
        };
        if let Some(value) = decided {
            return Ok(self.truth(value));
        }
        if !is_arithmetic(op) {
            // Comparing with TRUE or FALSE is the value or its opposite.
            let constant = match (self.op(a), self.op(b)) {
                (Op::Truth(v), _) => Some((v, b)),
                (_, Op::Truth(v)) => Some((v, a)),
                _ => None,
            };
            return Ok(match constant {
                Some((v, other)) if v == (op == Eq) => other,
                Some((_, other)) => self.not(other),
                None => self.add(term, Sort::Truth),
            });
        }
        self.number_term(term, arithmetic(op, (a_lo, a_hi), (b_lo, b_hi)))
    }

    /// `a` where the condition holds, else `b`.
    pub(super) fn choice(&mut self, condition: Id, a: Id, b: Id) -> Result<Id, Unsupported> {
        let range = hull([self.range(a), self.range(b)].into_iter());
        self.choice_within(condition, a, b, range)
    }

    fn choice_within(
        &mut self,
        condition: Id,
        a: Id,
        b: Id,
        range: Range,
    ) -> Result<Id, Unsupported> {
        match self.op(condition) {
            Op::Truth(true) => return Ok(a),
            Op::Truth(false) => return Ok(b),
            Op::Not(opposite) => return self.choice_within(opposite, b, a, range),
            _ if a == b => return Ok(a),
            _ => {}
        }
        if !self.is_truth(a) {
            return self.number_term(Op::Choice(condition, a, b), range);
        }
        Ok(match (self.op(a), self.op(b)) {
            (Op::Truth(true), _) => self.or(condition, b),
            (_, Op::Truth(false)) => self.and(condition, a),
            (Op::Truth(false), _) => {
                let not = self.not(condition);
                self.and(not, b)
            }
            (_, Op::Truth(true)) => {
                let not = self.not(condition);
                self.or(not, a)
            }
            _ => self.add(Op::Choice(condition, a, b), Sort::Truth),
        })
    }

    pub(super) fn least(&mut self, a: Id, b: Id) -> Result<Id, Unsupported> {
        let (x, y) = (self.range(a), self.range(b));
        if x.1 <= y.0 {
            return Ok(a);
        }
        if y.1 <= x.0 {
            return Ok(b);
        }
        let smaller = self.binary(BinaryOp::Lt, a, b)?;
        self.choice_within(smaller, a, b, (x.0.min(y.0), x.1.min(y.1)))
    }

    pub(super) fn greatest(&mut self, a: Id, b: Id) -> Result<Id, Unsupported> {
        let (x, y) = (self.range(a), self.range(b));
        if x.0 >= y.1 {
            return Ok(a);
        }
        if y.0 >= x.1 {
            return Ok(b);
        }
        let greater = self.binary(BinaryOp::Gt, a, b)?;
        self.choice_within(greater, a, b, (x.0.max(y.0), x.1.max(y.1)))
    }

    pub(super) fn abs(&mut self, a: Id) -> Result<Id, Unsupported> {
        let (lo, hi) = self.range(a);
        let zero = self.number(0);
        let negative = self.binary(BinaryOp::Lt, a, zero)?;
        let opposite = self.neg(a)?;
        let least = if lo <= 0 && hi >= 0 {
            0
        } else {
            lo.abs().min(hi.abs())
        };
        self.choice_within(negative, opposite, a, (least, lo.abs().max(hi.abs())))
    }
}
