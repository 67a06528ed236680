//! Numbers: what the accumulators hold, what is transferred and compared.

use super::super::ast::{Logic, Relation, Value};
use super::super::operand::{Bit, Cell};
use super::Making;
use super::unit::Run;
use super::wiring::{Role, bits_of};
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{BinaryOp, TypeKind};
use crate::tree::{assign, binary, name, number, truth};

/// What an accumulator holds.
#[derive(Clone)]
pub(super) enum Accumulator {
    Int(i64),
    Time,
    /// A variable, with the largest value that it can have.
    Variable(String, i64),
}

impl Making<'_> {
    pub(super) fn load(&mut self, run: &mut Run<'_>, value: &Value, span: &Span) {
        let loaded = match value {
            Value::Int(number) => Accumulator::Int(*number),
            Value::Time(_) => Accumulator::Time,
            Value::Cell(cell) => {
                let text = self.temp("accu", TypeKind::Int("INT".to_owned(), None), span);
                run.segment
                    .push(assign(&text, self.cell(*cell, span), span));
                Accumulator::Variable(text, cell.most())
            }
        };
        let [first, second] = &mut run.accumulators;
        *second = first.replace(loaded);
    }

    pub(super) fn transfer(&mut self, run: &mut Run<'_>, cell: Cell, span: &Span) -> Checked<()> {
        let Some(value) = run.accumulators[0].clone() else {
            return Err(Fault::new(
                span,
                "what is transferred is not known here",
                "load it before: `L 1`; behind a label or a call it may be anything",
            ));
        };
        // A string of checks may be open: what it has seen stays.
        self.settle(run, span);
        let whole = span.clone();
        let bits: Vec<Bit> = bits_of(&self.uses, cell).collect();
        if !bits.is_empty() {
            let Accumulator::Int(number) = value else {
                return Err(Fault::new(
                    span,
                    format!("bits of {cell} are used, and it is given a value that is no constant"),
                    "write the bits one by one",
                ));
            };
            fits(number, cell, span)?;
            for bit in bits {
                let made = self.set_bit(bit, truth(cell.bit_of(bit, number), span), &whole);
                run.segment.extend(made);
            }
            return Ok(());
        }
        let value = match value {
            Accumulator::Int(value) => {
                fits(value, cell, span)?;
                number(value, span)
            }
            Accumulator::Variable(text, most) if most <= cell.most() => name(&text, span),
            Accumulator::Variable(..) => {
                return Err(Fault::new(
                    span,
                    format!("a word does not fit into {cell}"),
                    "transfer it to a word, or load a byte",
                ));
            }
            Accumulator::Time => {
                return Err(Fault::new(
                    span,
                    "a time is transferred to no byte",
                    "start a timer with it: `SE T 20` (SD)",
                ));
            }
        };
        if let Some(Role::State(text)) = self.wiring.cells.get(&cell) {
            run.segment.push(assign(text, value, &whole));
        }
        Ok(())
    }

    pub(super) fn compare(
        &mut self,
        run: &mut Run<'_>,
        relation: Relation,
        span: &Span,
    ) -> Checked<()> {
        if run.flow.begun {
            return Err(Fault::new(
                span,
                "a comparison takes the place of the result so far",
                "put it into brackets: `U(` (A(), the loads and the comparison, `)`",
            ));
        }
        let expr = |accumulator: &Option<Accumulator>| match accumulator {
            Some(Accumulator::Int(value)) => Some(number(*value, span)),
            Some(Accumulator::Variable(text, _)) => Some(name(text, span)),
            _ => None,
        };
        let [first, second] = &run.accumulators;
        let (Some(first), Some(second)) = (expr(first), expr(second)) else {
            return Err(Fault::new(
                span,
                "what is compared is not known here",
                "load both numbers before: `L MB 194`, `L 1`, `==I`",
            ));
        };
        let op = match relation {
            Relation::Equal => BinaryOp::Eq,
            Relation::Unequal => BinaryOp::Ne,
            Relation::Greater => BinaryOp::Gt,
            Relation::Less => BinaryOp::Lt,
            Relation::GreaterEqual => BinaryOp::Ge,
            Relation::LessEqual => BinaryOp::Le,
        };
        run.flow
            .check(Logic::And, binary(op, second, first, span), span);
        Ok(())
    }
}

fn fits(number: i64, cell: Cell, span: &Span) -> Checked<()> {
    match (0..=cell.most()).contains(&number) {
        true => Ok(()),
        false => Err(Fault::new(
            span,
            format!("{number} does not fit into {cell}"),
            format!("its numbers are 0 to {}", cell.most()),
        )),
    }
}
