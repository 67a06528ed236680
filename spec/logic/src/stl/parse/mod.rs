//! From text to blocks of instructions.

mod calls;
mod operands;
mod statements;
mod symbols;

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Program;
use super::ast::{Block, Instruction, Op, Unit, Word};
use super::lex::{Kind, Token, lex};
use super::words::Dialect;
use crate::fault::{Checked, Fault, Span};
use operands::Operand;

/// More faults than these help nobody.
const MAX_FAULTS: usize = 40;

/// No program has more instructions.
const MOST: usize = 20_000;

/// Reads a program.
///
/// # Errors
/// Everything that is wrong in its form, in its order.
pub(super) fn program(file: &str, source: &Arc<str>) -> Result<Program, Vec<Fault>> {
    let mut parser = Parser {
        source,
        tokens: lex(source),
        at: 0,
        symbols: BTreeMap::new(),
        dialect: None,
        ambiguous: Vec::new(),
        faults: Vec::new(),
        units: Vec::new(),
        data_block: None,
        count: 0,
    };
    parser.whole();
    parser.settle();
    let Parser {
        mut faults,
        units,
        dialect,
        symbols,
        ..
    } = parser;
    faults.sort_by_key(|fault| fault.span.start);
    match faults.is_empty() {
        true => Ok(Program {
            file: file.to_owned(),
            source: source.clone(),
            german: dialect.is_none_or(|(dialect, _)| dialect == Dialect::German),
            units,
            names: symbols::bits(&symbols),
        }),
        false => Err(faults),
    }
}

struct Parser<'a> {
    source: &'a str,
    tokens: Vec<Token>,
    at: usize,
    /// By the written form in upper case: `"SPL".NOT_HALT`.
    symbols: BTreeMap<String, symbols::Symbol>,
    /// The language of the mnemonics, and the first word that shows it.
    dialect: Option<(Dialect, Span)>,
    /// Instructions whose meaning depends on the language, which nothing has shown yet: unit and place in it.
    ambiguous: Vec<(usize, usize)>,
    faults: Vec<Fault>,
    units: Vec<Unit>,
    /// The data block that AUF (OPN) has opened.
    data_block: Option<u16>,
    count: usize,
}

impl<'a> Parser<'a> {
    fn peek(&self) -> &Kind {
        self.ahead(0)
    }

    fn ahead(&self, by: usize) -> &Kind {
        let token = self.tokens.get(self.at + by).or(self.tokens.last());
        token.map_or(&Kind::Newline, |token| &token.kind)
    }

    fn span(&self) -> Span {
        let token = self.tokens.get(self.at).or(self.tokens.last());
        token.map_or(0..0, |token| token.span.clone())
    }

    /// The place of the token before.
    fn before(&self) -> Span {
        let token = self.tokens.get(self.at.saturating_sub(1));
        token.map_or(0..0, |token| token.span.clone())
    }

    fn is_over(&self) -> bool {
        self.at + 1 >= self.tokens.len()
    }

    fn next(&mut self) {
        if !self.is_over() {
            self.at += 1;
        }
    }

    fn is_sign(&self, sign: &str) -> bool {
        matches!(self.peek(), Kind::Sign(is) if *is == sign)
    }

    fn take_sign(&mut self, sign: &str) -> bool {
        let is = self.is_sign(sign);
        if is {
            self.next();
        }
        is
    }

    fn expect_sign(&mut self, sign: &'static str, help: &str) -> Checked<()> {
        match self.take_sign(sign) {
            true => Ok(()),
            false => Err(self.unexpected(&format!("`{sign}` is missing here"), help)),
        }
    }

    /// The word here, in upper case.
    fn word(&self) -> Option<String> {
        match self.peek() {
            Kind::Word(word) => Some(word.to_uppercase()),
            _ => None,
        }
    }

    fn is_word(&self, word: &str) -> bool {
        self.word().is_some_and(|is| is == word)
    }

    fn take_word(&mut self, word: &str) -> bool {
        let is = self.is_word(word);
        if is {
            self.next();
        }
        is
    }

    /// What stands here, for messages.
    fn here(&self) -> String {
        match self.peek() {
            Kind::Word(word) => format!("`{word}`"),
            Kind::Quoted(name) => format!("`\"{name}\"`"),
            Kind::Sign(sign) => format!("`{sign}`"),
            Kind::Other(c) => format!("`{c}`"),
            Kind::Newline => "the end of the line".to_owned(),
        }
    }

    fn unexpected(&self, message: &str, help: &str) -> Fault {
        Fault::new(&self.span(), message, help).label(format!("here is {}", self.here()))
    }

    fn fault(&mut self, fault: Fault) {
        if self.faults.len() < MAX_FAULTS {
            self.faults.push(fault);
        }
    }

    fn ends_statement(&self) -> bool {
        matches!(self.peek(), Kind::Newline) || self.is_sign(";")
    }

    fn skip_line(&mut self) {
        while !matches!(self.peek(), Kind::Newline) {
            self.next();
        }
    }

    fn skip_ends(&mut self) {
        while !self.is_over() && self.ends_statement() {
            self.next();
        }
    }

    /// Everything up to this word.
    fn skip_to(&mut self, word: &str) {
        while !self.is_over() && !self.take_word(word) {
            self.next();
        }
    }

    fn whole(&mut self) {
        self.skip_ends();
        while !self.is_over() {
            let start = self.span();
            let done = match self.word().as_deref() {
                Some("FUNCTION") => self.unit("END_FUNCTION"),
                Some("ORGANIZATION_BLOCK") => self.unit("END_ORGANIZATION_BLOCK"),
                Some("SYMBOLS") => self.symbol_table(),
                Some(word @ ("FUNCTION_BLOCK" | "DATA_BLOCK" | "TYPE")) => {
                    let end = format!("END_{}", word);
                    let message = format!("{word} is not read");
                    self.skip_to(&end);
                    Err(Fault::new(
                        &start,
                        message,
                        "a program has functions (FC) and organization blocks; names of bits in data blocks stand under SYMBOLS",
                    ))
                }
                _ if self.units.is_empty() => {
                    self.bare();
                    Ok(())
                }
                _ => {
                    let fault = self.unexpected(
                        "a block begins with FUNCTION or ORGANIZATION_BLOCK",
                        "write `FUNCTION FC 96 : VOID` before its instructions, and END_FUNCTION after them",
                    );
                    self.skip_line();
                    Err(fault)
                }
            };
            if let Err(fault) = done {
                self.fault(fault);
            }
            self.skip_ends();
        }
        if self.units.is_empty() && self.faults.is_empty() {
            self.fault(Fault::new(
                &(0..0),
                "the file has no instructions",
                "write the blocks of the safe logic: `ORGANIZATION_BLOCK OB 1`, `FUNCTION FC 96 : VOID`",
            ));
        }
    }

    /// Instructions without a block around them.
    fn bare(&mut self) {
        let name = Word {
            text: "PLC".to_owned(),
            span: self.span(),
        };
        self.open_unit(Block::Bare, name);
        self.body(None);
    }

    fn open_unit(&mut self, block: Block, name: Word) {
        let same = self.units.iter().find(|unit| unit.block == block);
        if let Some(same) = same.filter(|unit| unit.block != Block::Bare) {
            let line = super::line_of(self.source, same.name.span.start);
            let message = format!("{block} stands there twice, first in line {line}");
            self.fault(Fault::new(
                &name.span,
                message,
                "give one of them another number",
            ));
        }
        self.data_block = None;
        self.units.push(Unit {
            block,
            end: name.span.end,
            name,
            body: Vec::new(),
        });
    }

    /// `FUNCTION FC 96 : VOID` with its instructions.
    fn unit(&mut self, end: &'static str) -> Checked<()> {
        self.next();
        let start = self.span();
        let block = match self.operand() {
            Ok(Operand::Block(block)) => block,
            Ok(_) => {
                self.skip_to(end);
                return Err(Fault::new(
                    &start,
                    "a block has a number or a name in quotation marks",
                    "write `FUNCTION FC 96 : VOID` or `ORGANIZATION_BLOCK OB 1`",
                ));
            }
            Err(fault) => {
                self.skip_to(end);
                return Err(fault);
            }
        };
        let span = start.start..self.before().end;
        let text = self.source.get(span.clone()).unwrap_or_default().to_owned();
        if self.take_sign(":") && !self.take_word("VOID") {
            let fault = self.unexpected(
                "a function of the safe logic returns nothing",
                "write `: VOID`",
            );
            self.fault(fault);
        }
        self.skip_line();
        self.open_unit(block, Word { text, span });
        self.body(Some(end));
        Ok(())
    }

    /// Instructions up to the end of the block, or of the file.
    fn body(&mut self, end: Option<&'static str>) {
        loop {
            self.skip_ends();
            if self.is_over() {
                if let (Some(end), Some(unit)) = (end, self.units.last()) {
                    let message = format!("{} has no end", unit.block);
                    let fault =
                        Fault::new(&unit.name.span, message, format!("write {end} after it"));
                    self.fault(fault);
                }
                return;
            }
            match self.word().as_deref() {
                Some(word) if Some(word) == end => {
                    self.next();
                    return;
                }
                Some(
                    word @ ("END_FUNCTION"
                    | "END_ORGANIZATION_BLOCK"
                    | "FUNCTION"
                    | "ORGANIZATION_BLOCK"),
                ) => {
                    let message = format!("{word} stands within another block");
                    let fault = Fault::new(
                        &self.span(),
                        message,
                        "end each block before the next one begins",
                    );
                    self.fault(fault);
                    self.next();
                    return;
                }
                // What says nothing of the logic.
                Some("TITLE" | "VERSION" | "AUTHOR" | "FAMILY" | "NAME" | "KNOW_HOW_PROTECT")
                    if !matches!(self.ahead(1), Kind::Word(_))
                        || self.is_word("KNOW_HOW_PROTECT") =>
                {
                    self.skip_line();
                }
                Some("BEGIN" | "NETWORK") => self.next(),
                Some(word) if word.starts_with("VAR") => {
                    let fault = Fault::new(
                        &self.span(),
                        "local variables of a block are not read",
                        "use markers (M 100.0), whose values others can see",
                    );
                    self.fault(fault);
                    self.skip_to("END_VAR");
                }
                _ => self.instruction(),
            }
        }
    }

    fn push(&mut self, label: Option<Word>, op: Op, span: Span) {
        self.count += 1;
        if self.count == MOST + 1 {
            let message = format!("the program has more than {MOST} instructions");
            self.fault(Fault::new(
                &span,
                message,
                "leave out what does not belong to the safe logic",
            ));
        }
        if let (Some(unit), true) = (self.units.last_mut(), self.count <= MOST) {
            unit.end = unit.end.max(span.end);
            unit.body.push(Instruction { label, op, span });
        }
    }

    /// The language of words that have two meanings is known at the end.
    fn settle(&mut self) {
        let german = match &self.dialect {
            Some((dialect, _)) => *dialect == Dialect::German,
            None => {
                let first = self.ambiguous.first();
                let place = first.and_then(|(unit, at)| self.units.get(*unit)?.body.get(*at));
                if let Some(span) = place.map(|instruction| instruction.span.clone()) {
                    self.fault(Fault::new(
                        &span,
                        "SE is an on-delay in German and a pulse in English, and nothing shows which of them the program is in",
                        "write SE with U and SA, or SD with A and SF",
                    ));
                }
                return;
            }
        };
        for (unit, at) in std::mem::take(&mut self.ambiguous) {
            let instruction = self
                .units
                .get_mut(unit)
                .and_then(|unit| unit.body.get_mut(at));
            if let Some(Op::Start(kind, _)) = instruction.map(|i| &mut i.op) {
                *kind = match german {
                    true => super::ast::TimerKind::OnDelay,
                    false => super::ast::TimerKind::ExtendedPulse,
                };
            }
        }
    }

    /// A word belongs to one of the languages: all have to belong to the same.
    fn shows(&mut self, dialect: Dialect, span: &Span) -> Checked<()> {
        match &self.dialect {
            None => self.dialect = Some((dialect, span.clone())),
            Some((known, _)) if *known == dialect => {}
            Some((known, first)) => {
                let text =
                    |span: &Span| self.source.get(span.clone()).unwrap_or_default().to_owned();
                let line = super::line_of(self.source, first.start);
                return Err(Fault::new(
                    span,
                    format!(
                        "`{}` is {}, and the program is in {}: line {line} has `{}`",
                        text(span),
                        dialect.name(),
                        known.name(),
                        text(first)
                    ),
                    "write all of it in one of them: some words mean something else in the other",
                ));
            }
        }
        Ok(())
    }
}
