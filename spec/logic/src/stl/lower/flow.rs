//! The result of the logic operation (RLO) as it is computed: what is combined, what is pending before O and in brackets.

use super::super::ast::Logic;
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{BinaryOp, Expr};
use crate::tree::{binary, not};

/// More brackets within each other than a CPU has.
const MOST_BRACKETS: usize = 7;

/// What a bracket waits with.
struct Outer {
    begun: bool,
    result: Option<Expr>,
    pending: Option<Expr>,
    logic: Logic,
    not: bool,
    span: Span,
}

/// The state of the logic operation at a place of a block.
#[derive(Default)]
pub(super) struct Flow {
    /// A string of checks has begun: the next one is combined with it.
    pub begun: bool,
    /// The result, where one is known.
    pub result: Option<Expr>,
    /// The operand of an O that stands before an AND.
    pending: Option<Expr>,
    outer: Vec<Outer>,
    /// Where the string of checks began.
    pub from: usize,
    /// Checks since the result was put into a variable.
    length: usize,
}

impl Flow {
    /// Nothing is known: after a label, at the beginning of a block.
    pub fn forget(&mut self) {
        self.begun = false;
        self.result = None;
        self.pending = None;
    }

    /// A check, with the value that it looks at.
    pub fn check(&mut self, logic: Logic, value: Expr, span: &Span) {
        if !self.begun {
            if self.outer.is_empty() && self.pending.is_none() {
                self.from = span.start;
                self.length = 0;
            }
            self.begun = true;
            self.result = Some(value);
            return;
        }
        self.grows();
        if logic != Logic::And {
            self.join();
        }
        let Some(result) = self.result.take() else {
            self.result = Some(value);
            return;
        };
        let op = match logic {
            Logic::And => BinaryOp::And,
            Logic::Or => BinaryOp::Or,
            Logic::Xor => BinaryOp::Xor,
        };
        self.result = Some(binary(op, result, value, &(self.from..span.end)));
    }

    /// One more operation stands in the result.
    pub fn grows(&mut self) {
        self.length += 1;
    }

    /// `O` without operand.
    pub fn or_block(&mut self, span: &Span) -> Checked<()> {
        if !self.begun {
            return Err(Fault::new(
                span,
                "nothing stands before this O",
                "O without operand combines the checks before it with those after it: write them before",
            ));
        }
        self.join();
        self.pending = self.result.take();
        self.begun = false;
        Ok(())
    }

    /// What waits for the AND behind O is combined with it.
    fn join(&mut self) {
        if let (Some(pending), Some(result)) = (self.pending.take(), &self.result) {
            let span = pending.span.start.min(result.span.start)..result.span.end;
            self.result = Some(binary(BinaryOp::Or, pending, result.clone(), &span));
        }
    }

    pub fn open(&mut self, logic: Logic, not: bool, span: &Span) -> Checked<()> {
        if self.outer.len() >= MOST_BRACKETS {
            return Err(Fault::new(
                span,
                format!("more than {MOST_BRACKETS} brackets within each other"),
                "put the result of the inner ones into a marker",
            ));
        }
        if self.outer.is_empty() && !self.begun && self.pending.is_none() {
            self.from = span.start;
            self.length = 0;
        }
        self.outer.push(Outer {
            begun: std::mem::take(&mut self.begun),
            result: self.result.take(),
            pending: self.pending.take(),
            logic,
            not,
            span: span.clone(),
        });
        Ok(())
    }

    pub fn close(&mut self, span: &Span) -> Checked<()> {
        if self.outer.is_empty() {
            return Err(Fault::new(
                span,
                "no bracket is open here",
                "write `U(` (A() before the checks that belong together",
            ));
        }
        if !self.begun {
            return Err(Fault::new(
                span,
                "nothing stands in this bracket, or behind its O",
                "write the checks that belong together between `U(` (A() and `)`",
            ));
        }
        self.join();
        let inner = self.result.take();
        let Some(outer) = self.outer.pop() else {
            return Ok(());
        };
        self.begun = outer.begun;
        self.result = outer.result;
        self.pending = outer.pending;
        if let Some(inner) = inner {
            let value = if outer.not { not(inner) } else { inner };
            self.check(outer.logic, value, &(outer.span.start..span.end));
        }
        Ok(())
    }

    /// The result for an instruction that depends on it; the string of checks goes on.
    pub fn so_far(&mut self, span: &Span) -> Checked<Expr> {
        if self.pending.is_some() && !self.begun {
            return Err(Fault::new(
                span,
                "nothing stands behind the O before this",
                "write the checks that O combines with those before it",
            ));
        }
        self.join();
        self.result.clone().ok_or_else(|| {
            Fault::new(
                span,
                "the result of the logic is not known here",
                "begin with a check, such as `U M 100.0` (A M 100.0), or with SET: behind a label, a jump or a call it may be either",
            )
        })
    }

    /// The result for an instruction that ends the string of checks.
    pub fn taken(&mut self, span: &Span) -> Checked<Expr> {
        self.no_brackets()?;
        let result = self.so_far(span)?;
        self.begun = false;
        Ok(result)
    }

    /// No bracket is open, and no O waits.
    pub fn no_brackets(&self) -> Checked<()> {
        match self.outer.last() {
            None => Ok(()),
            Some(outer) => Err(Fault::new(
                &outer.span,
                "this bracket is still open at the next instruction that needs the result",
                "write `)` before it",
            )),
        }
    }

    /// No string of checks is left without use.
    pub fn at_rest(&self, span: &Span, what: &str) -> Checked<()> {
        self.no_brackets()?;
        match self.begun || self.pending.is_some() {
            false => Ok(()),
            true => Err(Fault::new(
                span,
                format!("the checks before {what} lead to nothing"),
                "use their result first, with =, S or R",
            )),
        }
    }

    /// All values that are not settled yet, to be put into variables; whether there are many checks in them.
    pub fn values(&mut self) -> impl Iterator<Item = &mut Expr> {
        let outer = self.outer.iter_mut();
        let outer = outer.flat_map(|o| [o.result.as_mut(), o.pending.as_mut()]);
        outer
            .chain([self.pending.as_mut(), self.result.as_mut()])
            .flatten()
    }

    /// Whether so many checks stand in one expression that it should be put into a variable.
    pub fn is_long(&mut self) -> bool {
        let long = self.length >= 32;
        if long {
            self.length = 0;
        }
        long
    }
}
