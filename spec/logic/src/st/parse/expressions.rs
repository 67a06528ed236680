//! Expressions.

use super::Parser;
use crate::fault::{Checked, Fault};
use crate::st::ast::{Arg, BinaryOp, Expr, ExprKind, UnaryOp};
use crate::st::lex::Token;

/// Operators in one expression; more make it unreadable, and its translation too long.
const MAX_TOKENS: usize = 400;

impl Parser {
    pub(super) fn expr(&mut self) -> Checked<Expr> {
        let first = self.at;
        let read = self.nested(|p| p.binary(1))?;
        if self.at - first > MAX_TOKENS {
            return Err(Fault::new(
                &read.span,
                format!("this expression has more than {MAX_TOKENS} words and signs"),
                "give parts of it a variable of their own",
            ));
        }
        Ok(read)
    }

    fn operator(&self) -> Option<(BinaryOp, u8)> {
        Some(match self.peek() {
            Token::Word(_) => match self.upper().as_str() {
                "OR" => (BinaryOp::Or, 1),
                "XOR" => (BinaryOp::Xor, 2),
                "AND" => (BinaryOp::And, 3),
                "MOD" => (BinaryOp::Mod, 7),
                _ => return None,
            },
            Token::Sym(symbol) => match *symbol {
                "&" => (BinaryOp::And, 3),
                "=" => (BinaryOp::Eq, 4),
                "<>" => (BinaryOp::Ne, 4),
                "<" => (BinaryOp::Lt, 5),
                ">" => (BinaryOp::Gt, 5),
                "<=" => (BinaryOp::Le, 5),
                ">=" => (BinaryOp::Ge, 5),
                "+" => (BinaryOp::Add, 6),
                "-" => (BinaryOp::Sub, 6),
                "*" => (BinaryOp::Mul, 7),
                "/" => (BinaryOp::Div, 7),
                _ => return None,
            },
            _ => return None,
        })
    }

    /// Operators of at least this strength, as IEC 61131-3 has them: XOR between OR and AND, NOT before all.
    fn binary(&mut self, least: u8) -> Checked<Expr> {
        let mut left = self.unary()?;
        while let Some((op, strength)) = self.operator() {
            if strength < least {
                break;
            }
            self.at += 1;
            let right = self.nested(|p| p.binary(strength + 1))?;
            left = Expr {
                span: left.span.start..right.span.end,
                kind: ExprKind::Binary(op, Box::new(left), Box::new(right)),
            };
        }
        if self.is_sym("**") {
            return Err(Fault::new(
                &self.span(),
                "`**` is not taken",
                "multiply, or write the number",
            ));
        }
        Ok(left)
    }

    fn unary(&mut self) -> Checked<Expr> {
        let start = self.span().start;
        let op = if self.word("NOT") {
            UnaryOp::Not
        } else if self.sym("-") {
            UnaryOp::Neg
        } else {
            return self.primary();
        };
        let inner = self.nested(Self::unary)?;
        Ok(Expr {
            span: start..inner.span.end,
            kind: ExprKind::Unary(op, Box::new(inner)),
        })
    }

    fn primary(&mut self) -> Checked<Expr> {
        let start = self.span().start;
        let kind = match self.peek().clone() {
            Token::Int(value) => {
                self.at += 1;
                ExprKind::Int(value)
            }
            Token::Time(us) => {
                self.at += 1;
                ExprKind::Time(us)
            }
            Token::Sym("(") => {
                self.at += 1;
                let inner = self.expr()?;
                self.expect(")")?;
                // With its brackets, as a reader sees it.
                return Ok(Expr {
                    span: self.since(start),
                    ..inner
                });
            }
            Token::Word(word)
                if word.eq_ignore_ascii_case("TRUE") || word.eq_ignore_ascii_case("FALSE") =>
            {
                self.at += 1;
                ExprKind::Bool(word.eq_ignore_ascii_case("TRUE"))
            }
            Token::Word(word) if word.eq_ignore_ascii_case("IF") => {
                return Err(Fault::new(
                    &self.span(),
                    "IF is a statement; here a value is needed",
                    "write SEL(condition, value if FALSE, value if TRUE)",
                ));
            }
            Token::Word(_) => return self.value(),
            _ => return self.wanted("a value"),
        };
        Ok(Expr {
            kind,
            span: self.since(start),
        })
    }

    /// A name, a member, a call of a function, or a value with its type.
    fn value(&mut self) -> Checked<Expr> {
        let start = self.span().start;
        if matches!(self.token(1).0, Token::Sym("#")) {
            let of = self.name()?;
            self.expect("#")?;
            let inner = self.nested(Self::unary)?;
            return Ok(Expr {
                kind: ExprKind::Typed(of, Box::new(inner)),
                span: self.since(start),
            });
        }
        if matches!(self.token(1).0, Token::Sym("(")) {
            let name = self.name()?;
            return Ok(Expr {
                kind: ExprKind::Call(name, self.arguments()?),
                span: self.since(start),
            });
        }
        self.reference()
    }

    /// `name` or `block.member`.
    pub(super) fn reference(&mut self) -> Checked<Expr> {
        let name = self.name()?;
        let start = name.span.start;
        let mut base = Expr {
            kind: ExprKind::Name(name.text),
            span: name.span,
        };
        loop {
            if self.sym(".") {
                let member = self.name()?;
                base = Expr {
                    kind: ExprKind::Member(Box::new(base), member),
                    span: self.since(start),
                };
                // A chain of members nests to the left.
                if self.end() - start > 400 {
                    return self.wanted("a shorter name");
                }
            } else if self.is_sym("[") {
                return Err(Fault::new(
                    &self.span(),
                    "ARRAY is not taken",
                    "declare one variable for each element",
                ));
            } else {
                return Ok(base);
            }
        }
    }

    /// `(a, b)` or `(IN := a, Q => b)`.
    pub(super) fn arguments(&mut self) -> Checked<Vec<Arg>> {
        self.expect("(")?;
        let mut arguments = Vec::new();
        if self.sym(")") {
            return Ok(arguments);
        }
        loop {
            let named = matches!(self.token(1).0, Token::Sym(":=" | "=>"));
            let (name, out) = match named {
                true => {
                    let name = self.name()?;
                    let out = self.is_sym("=>");
                    self.at += 1;
                    (Some(name), out)
                }
                false => (None, false),
            };
            let value = self.expr()?;
            arguments.push(Arg { name, out, value });
            if self.sym(")") {
                return Ok(arguments);
            }
            self.expect(",")?;
        }
    }
}
