//! Statements: definitions, actions, set-ups, end codes.

use super::super::ast::{Action, Assign, Expr, ExprKind, Name, Trigger, Value};
use super::super::lex::{MILLION, Token};
use super::super::listing::{Repair, shortened};
use super::super::names::{Known, Meaning, is_reserved};
use super::super::variable::Variable;
use super::{END_CODES, Parser};
use crate::fault::{Checked, Fault, Span};
use stillpoint_lang::diag::nearest;

/// The statements of the language; anything else is refused: S840D-LANG-702.
const STATEMENTS: [&str; 13] = [
    "IDS",
    "ID",
    "DEFINE",
    "DEF",
    "PROC",
    "MSG",
    "SIRELIN",
    "SIRELOUT",
    "SIRELTIME",
    "M17",
    "M30",
    "M02",
    "M2",
];

/// The longest name.
const LONGEST: usize = 32;

const ACTION: &str = "write `IDS=number DO target = value`, with WHENEVER, EVERY, WHEN or FROM and a condition before DO";

impl Parser<'_, '_> {
    /// One block. Definitions have been read before.
    pub(super) fn statement(&mut self) -> Checked<()> {
        let span = self.span();
        if let Some(end) = self.reader.ended.clone() {
            let line = self.reader.line(end.start);
            return Err(Fault::new(
                &span,
                format!("this stands after the end code at line {line}"),
                "the end code is the last block: what follows is never run",
            ));
        }
        match self.upper().as_str() {
            "DEFINE" | "DEF" => return Ok(()),
            "IDS" | "ID" => self.action()?,
            "PROC" => self.proc()?,
            "MSG" => self.message()?,
            "SIRELIN" | "SIRELOUT" | "SIRELTIME" => self.relay()?,
            word if END_CODES.contains(&word) => self.end_code(),
            _ => return self.no_statement(),
        }
        self.rest()
    }

    /// Nothing follows; in printed texts what follows is a comment that lost its `;`.
    fn rest(&mut self) -> Checked<()> {
        if *self.peek() == Token::End {
            return Ok(());
        }
        if self.reader.printed && self.is_text() {
            self.cut();
            return Ok(());
        }
        Err(Fault::new(
            &self.span(),
            format!(
                "{} stands after the end of the block",
                self.peek().describe()
            ),
            "each block has a line of its own; a comment begins with `;`",
        ))
    }

    fn is_text(&self) -> bool {
        matches!(
            self.peek(),
            Token::Word(_) | Token::Junk(_) | Token::Sym("(" | "-")
        )
    }

    /// R7: the rest of the block is a comment.
    fn cut(&mut self) {
        let start = self.span().start;
        let end = self.tokens.last().map_or(start, |(_, span)| span.end);
        let text = self.reader.source.get(start..end).unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        let text = format!("`{}` is read as a comment", shortened(&words.join(" ")));
        self.reader.repairs.push(Repair::new(start, "R7", text));
        self.at = self.tokens.len() - 1;
    }

    fn end_code(&mut self) {
        self.reader.ended = Some(self.span());
        self.at += 1;
    }

    fn no_statement(&mut self) -> Checked<()> {
        let span = self.span();
        let calls = |(token, _): &(Token, Span)| matches!(token, Token::Word(w) if w.eq_ignore_ascii_case("SIRELAY"));
        if self.tokens.iter().any(calls) {
            return Err(Fault::new(
                &span,
                "SIRELAY is called outside of a synchronous action: alarm 12080",
                "write `IDS=1 DO $AC_MARKER[1] = SIRELAY(1)`",
            ));
        }
        let assigned = self
            .tokens
            .iter()
            .any(|(token, _)| *token == Token::Sym("="));
        let misspelt = self
            .tokens
            .iter()
            .any(|(token, _)| *token == Token::Word("DO".to_owned()));
        if assigned && !misspelt && matches!(self.peek(), Token::Word(_) | Token::System(_)) {
            return Err(Fault::new(
                &span,
                format!(
                    "{} is assigned outside of a synchronous action",
                    self.peek().describe()
                ),
                "write `IDS=1 DO target = value`; for an initial value `IDS=1 WHEN TRUE DO target = value`",
            ));
        }
        let help = match nearest(&self.upper(), STATEMENTS) {
            Some(near) => format!("did you mean {near}?"),
            None => format!("a block begins with one of {}", STATEMENTS.join(", ")),
        };
        Err(Fault::new(
            &span,
            format!(
                "{} begins no block of the safe logic",
                self.peek().describe()
            ),
            help,
        ))
    }

    /// `PROC SAFE SBLOF DISPLOF`
    fn proc(&mut self) -> Checked<()> {
        self.at += 1;
        let (name, _) = self.new_name("the name of the program")?;
        self.reader.name.get_or_insert(name);
        while self.word("SBLOF") || self.word("DISPLOF") {}
        Ok(())
    }

    /// `MSG("text")`
    fn message(&mut self) -> Checked<()> {
        const HELP: &str = "write `MSG(\"text\")`";
        self.at += 1;
        self.expect("(", HELP)?;
        match self.peek() {
            Token::Text(_) => self.at += 1,
            _ => return self.wanted("a text", HELP),
        }
        self.expect(")", HELP)
    }

    /// A name that is defined here.
    fn new_name(&mut self, what: &str) -> Checked<(String, Span)> {
        let span = self.span();
        let Token::Word(name) = self.peek().clone() else {
            return self.wanted(
                what,
                "a name has letters, digits and `_`, and begins with no digit",
            );
        };
        if is_reserved(&name) {
            return Err(Fault::new(
                &span,
                format!("`{name}` is a word of the language"),
                "choose another name",
            ));
        }
        if name.len() > LONGEST {
            return Err(Fault::new(
                &span,
                format!("the name '{name}' has {} letters", name.len()),
                format!("at most {LONGEST} are allowed"),
            ));
        }
        self.at += 1;
        Ok((name, span))
    }

    /// `DEFINE name AS $A_INSE[1]` or `DEF INT a, b`.
    pub(super) fn definition(&mut self) -> Checked<()> {
        if self.word("DEF") {
            return self.locals();
        }
        self.at += 1;
        let (name, span) = self.new_name("a name")?;
        if !self.word("AS") {
            return self.wanted("AS", "write `DEFINE NAME AS $A_INSE[1]`");
        }
        let meaning = self.meaning()?;
        if let Some(known) = self.reader.names.get(&name) {
            let line = self.reader.line(known.span.start);
            if known.meaning != meaning {
                return Err(Fault::new(
                    &span,
                    format!("'{name}' is defined at line {line} with another meaning"),
                    "choose another name",
                ));
            }
            let text = format!("'{name}' is defined at line {line} already, with the same meaning");
            self.reader.note(span.start, "DEFINE", text);
            return self.rest();
        }
        if let Meaning::Variable(variable) = &meaning {
            self.reader.defined.push(Name {
                name: name.clone(),
                variable: variable.clone(),
                span: span.clone(),
            });
        }
        self.reader.names.insert(Known {
            name,
            meaning,
            span,
        });
        self.rest()
    }

    fn meaning(&mut self) -> Checked<Meaning> {
        match self.peek().clone() {
            Token::System(_) => Ok(Meaning::Variable(self.system()?)),
            Token::Number(..) | Token::Sym("-") => {
                let number = self.number()?;
                Ok(Meaning::Number(number.millionths, number.real))
            }
            _ => self.wanted(
                "a system variable or number",
                "a name stands for one of them: `DEFINE NAME AS $A_INSE[1]`",
            ),
        }
    }

    /// `$A_INSE[3]`
    pub(super) fn system(&mut self) -> Checked<Variable> {
        let start = self.span().start;
        let Token::System(name) = self.peek().clone() else {
            return self.wanted("a system variable", "write `$A_INSE[1]`");
        };
        self.at += 1;
        let mut index = None;
        if self.sym("[") {
            index = Some(match self.peek() {
                Token::Word(axis) => axis.clone(),
                Token::Number(number, false) => (number / MILLION).to_string(),
                other => other.describe(),
            });
            self.at += usize::from(*self.peek() != Token::End);
            self.expect("]", "close the index: `$A_INSE[1]`")?;
        }
        let span = self.since(start);
        let (name, printed) = (name, self.reader.printed);
        let made = Variable::new(&name, index.as_deref());
        made.map_err(|(message, help)| {
            let help = match name.contains('_') || printed {
                true => help,
                false => format!("{help}; system variables of the safe logic begin with `$A_`"),
            };
            Fault::new(&span, message, help)
        })
    }

    /// `DEF INT STAT_IN, STAT_OUT`
    fn locals(&mut self) -> Checked<()> {
        if !["INT", "REAL", "BOOL"].iter().any(|ty| self.word(ty)) {
            return self.wanted("a type", "write INT, REAL or BOOL: `DEF INT STAT_IN`");
        }
        loop {
            let (name, span) = self.new_name("a name")?;
            if let Some(known) = self.reader.names.get(&name) {
                let line = self.reader.line(known.span.start);
                return Err(Fault::new(
                    &span,
                    format!("'{name}' is defined at line {line} already"),
                    "choose another name",
                ));
            }
            self.reader.names.insert(Known {
                name,
                meaning: Meaning::Local,
                span,
            });
            if !self.sym(",") {
                return self.rest();
            }
        }
    }

    /// `IDS=10 EVERY a == 1 DO b = 0 c = 1`
    fn action(&mut self) -> Checked<()> {
        let start = self.span().start;
        let modal = self.is_word("ID");
        self.at += 1;
        self.expect("=", ACTION)?;
        let id_span = self.span();
        let id = match *self.peek() {
            Token::Number(number, false) => {
                u8::try_from(number / MILLION).ok().filter(|id| *id > 0)
            }
            _ => return self.wanted("the id of the action, 1..255,", ACTION),
        };
        let Some(id) = id else {
            return Err(Fault::new(
                &id_span,
                format!("the id {} does not exist", self.peek().describe()),
                "ids of actions are 1..255",
            ));
        };
        self.at += 1;
        let trigger = match self.upper().as_str() {
            "WHENEVER" => Trigger::Whenever,
            "EVERY" => Trigger::Every,
            "WHEN" => Trigger::When,
            "FROM" => Trigger::From,
            _ => Trigger::Always,
        };
        let mut condition = None;
        if trigger != Trigger::Always {
            self.at += 1;
            condition = Some(self.condition()?);
        }
        if !self.word("DO") {
            let help = match self.peek() {
                Token::Sym("=") => "`=` assigns; a comparison is written `==`",
                _ => ACTION,
            };
            return self.wanted("DO", help);
        }
        let mut assigns = Vec::new();
        loop {
            match self.peek() {
                Token::End => break,
                Token::Word(_) if END_CODES.contains(&self.upper().as_str()) => {
                    self.end_code();
                    break;
                }
                Token::Word(_) | Token::System(_) => {
                    if self.reader.printed && !assigns.is_empty() && !self.at_target() {
                        self.cut();
                        break;
                    }
                    assigns.push(self.assign()?);
                }
                _ if assigns.is_empty() => break,
                _ => {
                    self.rest()?;
                    break;
                }
            }
        }
        if assigns.is_empty() {
            return self.wanted("an assignment", ACTION);
        }
        self.reader.actions.push(Action {
            id,
            id_span,
            modal,
            trigger,
            condition,
            assigns,
            span: self.since(start),
        });
        Ok(())
    }

    /// Whether a target with its `=` stands here.
    fn at_target(&self) -> bool {
        let indexed = matches!(self.token(1).0, Token::Sym("["));
        let ahead = if indexed { 4 } else { 1 };
        self.token(ahead).0 == Token::Sym("=")
    }

    fn assign(&mut self) -> Checked<Assign> {
        let start = self.span().start;
        if ["SIRELIN", "SIRELOUT", "SIRELTIME"].contains(&self.upper().as_str()) {
            return Err(Fault::new(
                &self.span(),
                format!(
                    "{} stands in a synchronous action: alarm 12571",
                    self.upper()
                ),
                "a relay is set up in a block of its own, before the actions; here it is called: `status = SIRELAY(1)`",
            ));
        }
        let target = self.target()?;
        if self.is_sym("==") {
            return Err(Fault::new(
                &self.span(),
                "`==` compares; here something is assigned",
                "write `=`",
            ));
        }
        self.expect("=", "write `target = value`")?;
        let value = match self.is_word("SIRELAY") {
            true => Value::Relay(self.relay_call()?),
            false => Value::Expr(self.expr()?),
        };
        let assign = Assign {
            target,
            value,
            span: self.since(start),
        };
        self.assignable(&assign)?;
        Ok(assign)
    }

    fn target(&mut self) -> Checked<Expr> {
        let span = self.span();
        let kind = match self.peek().clone() {
            Token::System(_) => ExprKind::Variable(self.system()?),
            Token::Word(word) if is_reserved(&word) => {
                return self.wanted(
                    "a target",
                    "after a value stands the next `target = value`, or the end of the block",
                );
            }
            Token::Word(name) => {
                self.at += 1;
                match self.known(&name, &span)?.meaning {
                    Meaning::Variable(variable) => ExprKind::Variable(variable),
                    Meaning::Undefined => ExprKind::Unknown(name),
                    Meaning::Number(..) => {
                        return Err(Fault::new(
                            &span,
                            format!("'{name}' is a number, and is not assigned"),
                            "assign to a system variable",
                        ));
                    }
                    Meaning::Local => return Err(local(&name, &span)),
                }
            }
            _ => return self.wanted("a target", "write `target = value`"),
        };
        let span = self.since(span.start);
        Ok(Expr { kind, span })
    }
}

/// A variable of DEF in a synchronous action.
pub(super) fn local(name: &str, span: &Span) -> Fault {
    Fault::new(
        span,
        format!("'{name}' is a variable of DEF, which synchronous actions do not see"),
        "use a marker: `$A_MARKERSI[1]`, or `$AC_MARKER[1]` for a number",
    )
}
