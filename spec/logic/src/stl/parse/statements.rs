//! Instructions.

use stillpoint_lang::diag::nearest;

use super::super::ast::{Logic, Op, Relation, Source, TimerKind, Value, Word};
use super::super::lex::Kind;
use super::super::operand::{Area, Bit, Cell};
use super::super::words::{Dialect, Mnemonic, all, mnemonic, refused};
use super::Parser;
use super::operands::Operand;
use crate::fault::{Checked, Fault, Span};

impl Parser<'_> {
    /// One instruction; a wrong one is told, and the rest of its line left out.
    pub(super) fn instruction(&mut self) {
        let label = self.label();
        // A label may stand on a line of its own.
        while label.is_some() && matches!(self.peek(), Kind::Newline) && !self.is_over() {
            self.next();
        }
        let start = self.span();
        match self.op() {
            Ok(None) => {}
            Ok(Some(op)) => {
                let span = start.start..self.before().end;
                self.push(label, op, span);
                if !self.ends_statement() {
                    let fault = self.unexpected(
                        "one instruction stands in a line",
                        "begin a new line, or write `;` between them",
                    );
                    self.fault(fault);
                    self.skip_line();
                }
            }
            Err(fault) => {
                self.fault(fault);
                self.skip_line();
            }
        }
    }

    /// `QUI1:`
    fn label(&mut self) -> Option<Word> {
        let Kind::Word(text) = self.peek().clone() else {
            return None;
        };
        if !matches!(self.ahead(1), Kind::Sign(":")) {
            return None;
        }
        let span = self.span();
        self.next();
        self.next();
        if self.is_word("END_FUNCTION") || self.is_over() {
            let message = format!("the label {text} stands before no instruction");
            self.fault(Fault::new(&span, message, "write `NOP 0` after it"));
        }
        Some(Word { text, span })
    }

    fn op(&mut self) -> Checked<Option<Op>> {
        let start = self.span();
        let op = match self.peek().clone() {
            Kind::Sign("=") => {
                self.next();
                Op::Assign(self.written_bit("`= M 100.0`")?)
            }
            Kind::Sign(")") => {
                self.next();
                Op::Close
            }
            Kind::Sign(sign @ ("==" | "<>" | ">" | "<" | ">=" | "<=")) => {
                self.next();
                self.comparison(sign, &start)?
            }
            Kind::Word(word) => return self.of_mnemonic(&word.to_uppercase(), &start),
            _ => {
                return Err(self.unexpected(
                    "an instruction is missing here",
                    "write U, UN, O, ON (A, AN, O, ON), =, S, R or another instruction",
                ));
            }
        };
        Ok(Some(op))
    }

    fn comparison(&mut self, sign: &str, start: &Span) -> Checked<Op> {
        let relation = match sign {
            "==" => Relation::Equal,
            "<>" => Relation::Unequal,
            ">" => Relation::Greater,
            "<" => Relation::Less,
            ">=" => Relation::GreaterEqual,
            _ => Relation::LessEqual,
        };
        match self.word().as_deref() {
            Some("I" | "D") => {
                self.next();
                Ok(Op::Compare(relation))
            }
            _ => Err(Fault::new(
                start,
                "only whole numbers are compared",
                format!("write `{sign}I`"),
            )),
        }
    }

    fn of_mnemonic(&mut self, word: &str, start: &Span) -> Checked<Option<Op>> {
        let [german, english] = mnemonic(word);
        let (meaning, both) = match (german, english) {
            (Some(g), Some(e)) if g == e => (g, true),
            // SE, whose meaning is settled at the end.
            (Some(g), Some(_)) => (g, true),
            (Some(g), None) => {
                self.shows(Dialect::German, start)?;
                (g, false)
            }
            (None, Some(e)) => {
                self.shows(Dialect::English, start)?;
                (e, false)
            }
            (None, None) => return Err(unknown(word, start)),
        };
        self.next();
        let ambiguous = both && german != english;
        self.meant(meaning, ambiguous, start)
    }

    fn meant(&mut self, meaning: Mnemonic, ambiguous: bool, start: &Span) -> Checked<Option<Op>> {
        let check = |logic, not| (logic, not);
        let (logic, not) = match meaning {
            Mnemonic::And => check(Logic::And, false),
            Mnemonic::AndNot => check(Logic::And, true),
            Mnemonic::Or => check(Logic::Or, false),
            Mnemonic::OrNot => check(Logic::Or, true),
            Mnemonic::Xor => check(Logic::Xor, false),
            Mnemonic::XorNot => check(Logic::Xor, true),
            other => return self.acts(other, ambiguous, start),
        };
        if self.take_sign("(") {
            return Ok(Some(Op::Open { logic, not }));
        }
        if meaning == Mnemonic::Or && self.ends_statement() {
            return Ok(Some(Op::OrBlock));
        }
        let of = self.source("`U M 100.0` (A M 100.0)")?;
        Ok(Some(Op::Check { logic, not, of }))
    }

    fn acts(&mut self, meaning: Mnemonic, ambiguous: bool, start: &Span) -> Checked<Option<Op>> {
        let op = match meaning {
            Mnemonic::Set => match self.source("`S M 100.0`")? {
                Source::Timer(_) => {
                    return Err(Fault::new(
                        start,
                        "S does not start a timer",
                        "load a time and start it: `L S5T#1S`, `SE T 20` (SD)",
                    ));
                }
                Source::Bit(bit) => {
                    self.writable(bit, &self.before())?;
                    Op::Set(Source::Bit(bit))
                }
            },
            Mnemonic::Reset => match self.source("`R M 100.0`")? {
                Source::Bit(bit) => {
                    self.writable(bit, &self.before())?;
                    Op::Reset(Source::Bit(bit))
                }
                timer => Op::Reset(timer),
            },
            Mnemonic::Rising | Mnemonic::Falling => Op::Edge {
                falling: meaning == Mnemonic::Falling,
                memory: self.written_bit(
                    "`FP M 210.1`: the bit that keeps the result of the cycle before",
                )?,
            },
            Mnemonic::Not => Op::Not,
            Mnemonic::SetResult => Op::SetResult,
            Mnemonic::ClearResult => Op::ClearResult,
            Mnemonic::Load => Op::Load(self.loaded()?),
            Mnemonic::Transfer => Op::Transfer(self.transferred()?),
            Mnemonic::Start(kind) => return self.start(kind, ambiguous, start).map(Some),
            Mnemonic::Jump(when) => match self.peek().clone() {
                Kind::Word(text) => {
                    let span = self.span();
                    self.next();
                    Op::Jump {
                        when,
                        to: Word { text, span },
                    }
                }
                _ => {
                    return Err(
                        self.unexpected("the label to jump to is missing", "write `SPB M001` (JC)")
                    );
                }
            },
            Mnemonic::End { conditional } => Op::End { conditional },
            Mnemonic::Call => Op::Call(self.call(false)?),
            Mnemonic::ConditionalCall => Op::Call(self.call(true)?),
            Mnemonic::Nothing => {
                if matches!(self.peek(), Kind::Word(_)) {
                    self.next();
                }
                Op::Nothing
            }
            Mnemonic::OpenBlock => {
                let span = self.span();
                match self.operand()? {
                    Operand::Data(block) => self.data_block = Some(block),
                    _ => {
                        return Err(Fault::new(
                            &(span.start..self.before().end),
                            "only a data block is opened",
                            "write `AUF DB 33` (OPN); a symbol of a data block needs its number under SYMBOLS: `\"Axis3\" : DB 33`",
                        ));
                    }
                }
                return Ok(None);
            }
            // Checks are read above.
            _ => Op::Nothing,
        };
        Ok(Some(op))
    }

    fn start(&mut self, kind: TimerKind, ambiguous: bool, start: &Span) -> Checked<Op> {
        let span = self.span();
        match self.operand()? {
            Operand::Timer(timer) => {
                if ambiguous {
                    let unit = self.units.len().saturating_sub(1);
                    let at = self.units.last().map_or(0, |unit| unit.body.len());
                    self.ambiguous.push((unit, at));
                }
                Ok(Op::Start(kind, timer))
            }
            _ => Err(Fault::new(
                &(start.start..span.end),
                "this starts a timer, and no timer stands here",
                "write `SE T 20` (SD)",
            )),
        }
    }

    fn source(&mut self, example: &str) -> Checked<Source> {
        let span = self.span();
        match self.operand()? {
            Operand::Bit(bit) => Ok(Source::Bit(bit)),
            Operand::Timer(timer) => Ok(Source::Timer(timer)),
            Operand::Block(super::super::ast::Block::Symbol(name)) => Err(Fault::new(
                &span,
                format!("nothing is called \"{name}\""),
                "define it before its use: SYMBOLS, `\"Test\" : M 211.0`, END_SYMBOLS",
            )),
            _ => Err(Fault::new(
                &(span.start..self.before().end),
                "this is no bit",
                format!("write a bit or a timer: {example}"),
            )),
        }
    }

    fn written_bit(&mut self, example: &str) -> Checked<Bit> {
        let span = self.span();
        match self.source(example)? {
            Source::Bit(bit) => {
                self.writable(bit, &(span.start..self.before().end))?;
                Ok(bit)
            }
            Source::Timer(_) => Err(Fault::new(
                &(span.start..self.before().end),
                "a timer is not assigned",
                format!("write {example}"),
            )),
        }
    }

    /// Inputs come from the machine, and some variables of the SPL from the control.
    fn writable(&self, bit: Bit, span: &Span) -> Checked<()> {
        if bit.area == Area::Input {
            return Err(Fault::new(
                span,
                format!("{bit} is an input, and is not written"),
                "use a marker or an output; an input has the value that comes from the machine",
            ));
        }
        Ok(())
    }

    fn loaded(&mut self) -> Checked<Value> {
        let span = self.span();
        match self.operand()? {
            Operand::Int(number) => Ok(Value::Int(number)),
            Operand::Time(us, true) => Ok(Value::Time(us)),
            Operand::Time(_, false) => Err(Fault::new(
                &(span.start..self.before().end),
                "a timer is started with a time of its own form",
                "write `L S5T#1S`",
            )),
            Operand::Cell(cell) => {
                self.narrow(cell, &(span.start..self.before().end))?;
                Ok(Value::Cell(cell))
            }
            _ => Err(Fault::new(
                &(span.start..self.before().end),
                "this is not loaded",
                "load a number, a byte or a time: `L 1`, `L MB 194`, `L S5T#1S`",
            )),
        }
    }

    fn transferred(&mut self) -> Checked<Cell> {
        let span = self.span();
        match self.operand()? {
            Operand::Cell(cell) if cell.area == Area::Input => Err(Fault::new(
                &(span.start..self.before().end),
                format!("{cell} are inputs, and are not written"),
                "use markers or outputs",
            )),
            Operand::Cell(cell) => Ok(cell),
            _ => Err(Fault::new(
                &(span.start..self.before().end),
                "only a byte, word or double word is transferred to",
                "write `T MB 194`",
            )),
        }
    }

    fn narrow(&self, cell: Cell, span: &Span) -> Checked<()> {
        match cell.width {
            4 => Err(Fault::new(
                span,
                format!("{cell} has 2^32 values, which are not explored"),
                "load its bytes",
            )),
            _ => Ok(()),
        }
    }
}

fn unknown(word: &str, span: &Span) -> Fault {
    if let Some(why) = refused(word) {
        return Fault::new(span, format!("the instruction {word} is not taken"), why);
    }
    let help = match nearest(word, all()) {
        Some(near) => format!("did you mean {near}?"),
        None => "instructions are U UN O ON X XN (A AN O ON X XN), =, S, R, FP, FN, NOT, SET, CLR, L, T, SE SA SI SV SS (SD SF SP SE SS), SPA SPB SPBN (JU JC JCN), BEA BEB BE (BEU BEC BE), CALL, CC, AUF (OPN) and NOP".to_owned(),
    };
    Fault::new(span, format!("there is no instruction {word}"), help)
}
