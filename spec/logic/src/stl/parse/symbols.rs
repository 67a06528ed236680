//! The symbol table: `SYMBOLS` to `END_SYMBOLS`. It stands for the table of the project and the declaration of DB18, which STEP 7
//! keeps outside of the sources.

use std::collections::BTreeMap;

use stillpoint_lang::diag::nearest;

use super::super::ast::Block;
use super::super::lex::Kind;
use super::super::operand::Bit;
use super::Parser;
use super::operands::Operand;
use crate::fault::{Checked, Fault, Span};

/// What a symbol stands for.
pub(super) struct Symbol {
    /// As it is written.
    written: String,
    operand: Operand,
    line: usize,
}

/// The names of bits, as they are written.
pub(super) fn bits(symbols: &BTreeMap<String, Symbol>) -> BTreeMap<Bit, String> {
    let mut names = BTreeMap::new();
    for symbol in symbols.values() {
        if let Operand::Bit(bit) = symbol.operand {
            names.entry(bit).or_insert_with(|| symbol.written.clone());
        }
    }
    names
}

impl Parser<'_> {
    /// `"SPL".NOT_HALT : MARKERSIP[2]`, one a line.
    pub(super) fn symbol_table(&mut self) -> Checked<()> {
        let start = self.span();
        self.next();
        loop {
            self.skip_ends();
            if self.take_word("END_SYMBOLS") {
                return Ok(());
            }
            if self.is_over() {
                return Err(Fault::new(
                    &start,
                    "the symbol table has no end",
                    "write END_SYMBOLS after it",
                ));
            }
            if let Err(fault) = self.entry() {
                self.fault(fault);
                self.skip_line();
            }
        }
    }

    fn entry(&mut self) -> Checked<()> {
        let start = self.span();
        let written = match self.peek().clone() {
            Kind::Quoted(name) => {
                self.next();
                self.member(name)?
            }
            _ => {
                return Err(self.unexpected(
                    "a symbol stands in quotation marks",
                    "write `\"SPL\".NOT_HALT : MARKERSIP[2]` or `\"Test\" : M 211.0`",
                ));
            }
        };
        let span = start.start..self.before().end;
        self.expect_sign(":", "write the address after a colon: `\"Test\" : M 211.0`")?;
        let operand = self.operand()?;
        if !self.ends_statement() {
            return Err(self.unexpected("one symbol stands in a line", "begin a new line"));
        }
        let line = super::super::line_of(self.source, start.start);
        let symbol = Symbol {
            written: written.clone(),
            operand,
            line,
        };
        match self.symbols.insert(written.to_uppercase(), symbol) {
            Some(before) => Err(Fault::new(
                &span,
                format!("{written} is defined twice, first in line {}", before.line),
                "give each symbol one address",
            )),
            None => Ok(()),
        }
    }

    /// `"SPL".NOT_HALT` as it is looked up; the name has been read.
    fn member(&mut self, name: String) -> Checked<String> {
        if !self.take_sign(".") {
            return Ok(format!("\"{name}\""));
        }
        match self.peek().clone() {
            Kind::Word(member) => {
                self.next();
                Ok(format!("\"{name}\".{member}"))
            }
            _ => Err(self.unexpected("a name is missing here", "write `\"SPL\".NOT_HALT`")),
        }
    }

    /// What a symbol stands for; one without a definition names a block.
    pub(super) fn symbol(&mut self, name: &str, start: &Span) -> Checked<Operand> {
        self.next();
        let is_member = self.is_sign(".");
        let written = self.member(name.to_owned())?;
        if let Some(symbol) = self.symbols.get(&written.to_uppercase()) {
            return Ok(symbol.operand.clone());
        }
        if !is_member {
            return Ok(Operand::Block(Block::Symbol(name.to_uppercase())));
        }
        let span = start.start..self.before().end;
        let known = || self.symbols.values().map(|symbol| symbol.written.as_str());
        let help = match nearest(&written, known()) {
            Some(near) => format!("did you mean {near}?"),
            None => format!(
                "define it before its use: SYMBOLS, `{written} : MARKERSIP[2]`, END_SYMBOLS"
            ),
        };
        Err(Fault::new(
            &span,
            format!("nothing is called {written}"),
            help,
        ))
    }
}
