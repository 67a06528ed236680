//! Statements.

use super::Parser;
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{For, Label, Stmt, StmtKind};
use crate::st::lex::Token;

impl Parser {
    /// Statements up to one of these words, which stays.
    pub(super) fn statements(&mut self, ends: &[&str]) -> Checked<Vec<Stmt>> {
        let mut out = Vec::new();
        loop {
            while self.sym(";") {}
            let word = self.upper();
            // Another closing word is told by whoever misses his own.
            let closing =
                word.starts_with("END_") || word == "ELSE" || word == "ELSIF" || word == "UNTIL";
            if ends.contains(&word.as_str()) || closing || *self.peek() == Token::End {
                return Ok(out);
            }
            if ends.contains(&"END_CASE") && self.at_label() {
                return Ok(out);
            }
            out.push(self.nested(Self::statement)?);
        }
    }

    fn statement(&mut self) -> Checked<Stmt> {
        let start = self.span();
        let kind = match self.upper().as_str() {
            "IF" => self.if_statement(&start)?,
            "CASE" => self.case(&start)?,
            "FOR" => self.for_loop(&start)?,
            "RETURN" => {
                self.at += 1;
                StmtKind::Return
            }
            "EXIT" => {
                self.at += 1;
                StmtKind::Exit
            }
            word @ ("WHILE" | "REPEAT") => return Err(endless(word, &start)),
            word @ ("CONTINUE" | "GOTO" | "JMP") => {
                return Err(Fault::new(
                    &start,
                    format!("{word} is not taken"),
                    "put what is left out into IF ... END_IF",
                ));
            }
            _ => self.simple()?,
        };
        let span = self.since(start.start);
        self.semicolon()?;
        Ok(Stmt { kind, span })
    }

    /// An assignment or a call.
    fn simple(&mut self) -> Checked<StmtKind> {
        let target = self.reference()?;
        if self.is_sym("(") {
            return Ok(StmtKind::Call(target, self.arguments()?));
        }
        if self.is_sym("=") {
            return Err(Fault::new(
                &self.span(),
                "`=` compares; here something is assigned",
                "write `:=`",
            ));
        }
        if !self.sym(":=") {
            return self.wanted("`:=` or `(`");
        }
        Ok(StmtKind::Assign(target, self.expr()?))
    }

    fn if_statement(&mut self, start: &Span) -> Checked<StmtKind> {
        self.at += 1;
        let mut branches = Vec::new();
        let mut rest = Vec::new();
        loop {
            let condition = self.expr()?;
            self.expect_word("THEN")?;
            branches.push((condition, self.statements(&[])?));
            few(branches.len(), start)?;
            if self.word("ELSIF") {
                continue;
            }
            if self.word("ELSE") {
                rest = self.statements(&[])?;
            }
            self.close("END_IF", "IF", start)?;
            return Ok(StmtKind::If(branches, rest));
        }
    }

    fn case(&mut self, start: &Span) -> Checked<StmtKind> {
        self.at += 1;
        let selector = self.expr()?;
        self.expect_word("OF")?;
        let mut branches = Vec::new();
        while self.at_label() {
            let mut labels = Vec::new();
            loop {
                let first = self.expr()?;
                let last = match self.sym("..") {
                    true => Some(self.expr()?),
                    false => None,
                };
                labels.push(Label { first, last });
                if !self.sym(",") {
                    break;
                }
            }
            self.expect(":")?;
            branches.push((labels, self.statements(&["END_CASE"])?));
            few(branches.len(), start)?;
        }
        let rest = match self.word("ELSE") {
            true => self.statements(&[])?,
            false => Vec::new(),
        };
        self.close("END_CASE", "CASE", start)?;
        if branches.is_empty() {
            return Err(Fault::new(
                start,
                "this CASE has no values",
                "write `value : statements` for each of them",
            ));
        }
        Ok(StmtKind::Case(selector, branches, rest))
    }

    /// Whether a label of a CASE stands here: values up to a `:` before anything of a statement.
    fn at_label(&self) -> bool {
        for ahead in 0.. {
            match &self.token(ahead).0 {
                Token::Sym(":") => return ahead > 0,
                Token::Sym("," | ".." | "#" | "-") | Token::Int(_) | Token::Time(_) => {}
                Token::Word(word) if !super::is_keyword(word) => {}
                Token::Word(word)
                    if ["TRUE", "FALSE"]
                        .iter()
                        .any(|w| word.eq_ignore_ascii_case(w)) => {}
                _ => return false,
            }
        }
        false
    }

    fn for_loop(&mut self, start: &Span) -> Checked<StmtKind> {
        self.at += 1;
        let variable = self.name()?;
        self.expect(":=")?;
        let from = self.expr()?;
        self.expect_word("TO")?;
        let to = self.expr()?;
        let by = match self.word("BY") {
            true => Some(self.expr()?),
            false => None,
        };
        self.expect_word("DO")?;
        let body = self.statements(&[])?;
        self.close("END_FOR", "FOR", start)?;
        Ok(StmtKind::For(Box::new(For {
            variable,
            from,
            to,
            by,
            body,
        })))
    }
}

/// More branches than a reader can follow, and than are run within one another.
const MAX_BRANCHES: usize = 100;

fn few(branches: usize, span: &Span) -> Checked<()> {
    match branches > MAX_BRANCHES {
        false => Ok(()),
        true => Err(Fault::new(
            span,
            format!("this has more than {MAX_BRANCHES} branches"),
            "group them: several values in one branch, or one CASE within another",
        )),
    }
}

fn endless(word: &str, span: &Span) -> Fault {
    Fault::new(
        span,
        format!(
            "{word} is not taken: nothing says that it ends, and a cycle of the safe PLC has to end"
        ),
        "use FOR with constant bounds, or do one step of the work in each cycle",
    )
    .label("a loop of unknown length")
}
