//! Calls of blocks with their parameters.

use super::super::ast::{Actual, Block, Call, Param, Word};
use super::super::lex::Kind;
use super::Parser;
use super::operands::Operand;
use crate::fault::{Checked, Fault};

impl Parser<'_> {
    /// What follows CALL: `FC 60 (start := M 211.1, ...)`, `FB 10, DB 80 (...)`. The parameters may stand on several lines, in
    /// parentheses or without.
    pub(super) fn call(&mut self, conditional: bool) -> Checked<Call> {
        // Where a called block leaves the data block register is not known.
        self.data_block = None;
        let start = self.span();
        let block = match self.operand()? {
            Operand::Block(block) => block,
            _ => {
                return Err(Fault::new(
                    &(start.start..self.before().end),
                    "only a block is called",
                    "write `CALL FC 96`",
                ));
            }
        };
        let span = start.start..self.before().end;
        if self.take_sign(",") {
            let place = self.span();
            match self.operand()? {
                Operand::Data(_) | Operand::Block(Block::Symbol(_)) => {}
                _ => {
                    return Err(Fault::new(
                        &(place.start..self.before().end),
                        "an instance is a data block",
                        "write `CALL FB 10, DB 80 (...)`",
                    ));
                }
            }
        }
        let mut params = Vec::new();
        if self.take_sign("(") {
            loop {
                self.skip_newlines();
                if self.take_sign(")") {
                    break;
                }
                if self.is_over() {
                    return Err(Fault::new(
                        &span,
                        "the parameters of this call have no end",
                        "write `)` after the last of them",
                    ));
                }
                params.push(self.param()?);
                self.skip_newlines();
                if !self.take_sign(",") && !self.is_sign(")") {
                    return Err(self.unexpected(
                        "parameters stand between commas",
                        "write `start := M 211.1,`",
                    ));
                }
            }
        } else {
            // Without parentheses: one parameter a line.
            while self.param_follows() {
                self.skip_newlines();
                params.push(self.param()?);
                self.take_sign(",");
            }
        }
        Ok(Call {
            block,
            conditional,
            params,
            span,
        })
    }

    fn skip_newlines(&mut self) {
        while !self.is_over() && matches!(self.peek(), Kind::Newline) {
            self.next();
        }
    }

    /// Whether `name :=` stands on the next line.
    fn param_follows(&self) -> bool {
        let mut by = 0;
        while matches!(self.ahead(by), Kind::Newline) && self.at + by + 1 < self.tokens.len() {
            by += 1;
        }
        by > 0
            && matches!(self.ahead(by), Kind::Word(_))
            && matches!(self.ahead(by + 1), Kind::Sign(":="))
    }

    fn param(&mut self) -> Checked<Param> {
        let start = self.span();
        let Kind::Word(text) = self.peek().clone() else {
            return Err(self.unexpected(
                "the name of a parameter is missing",
                "write `start := M 211.1`",
            ));
        };
        let name = Word {
            text,
            span: start.clone(),
        };
        self.next();
        self.expect_sign(":=", "write `start := M 211.1`")?;
        self.skip_newlines();
        let value = match self.operand()? {
            Operand::Bit(bit) => Actual::Bit(bit),
            Operand::Cell(cell) => Actual::Cell(cell),
            Operand::Bool(value) => Actual::Bool(value),
            Operand::Int(number) => Actual::Int(number),
            Operand::Time(us, _) => Actual::Time(us),
            Operand::Pointer(Some(cell)) => Actual::Byte(cell),
            Operand::Block(Block::Symbol(name)) => {
                return Err(Fault::new(
                    &self.before(),
                    format!("nothing is called \"{name}\""),
                    "define it before its use: SYMBOLS, `\"Test\" : M 211.0`, END_SYMBOLS",
                ));
            }
            Operand::Pointer(None)
            | Operand::Real
            | Operand::Timer(_)
            | Operand::Data(_)
            | Operand::Block(_) => Actual::Other,
        };
        let span = start.start..self.before().end;
        Ok(Param { name, value, span })
    }
}
