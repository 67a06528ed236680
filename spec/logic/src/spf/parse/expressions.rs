//! Expressions, with their types: checks C1 to C4.

use super::super::ast::{Assign, Expr, ExprKind, Logic, Number, Relation, Value};
use super::super::lex::{MILLION, Token, decimal};
use super::super::names::{Meaning, is_reserved};
use super::super::variable::{Access, Ty, Values};
use super::statements::local;
use super::{MAX_DEPTH, Parser};
use crate::fault::{Checked, Fault, Span};

/// An expression, and whether its outermost word is a bare AND, OR, XOR or NOT.
struct Read {
    expr: Expr,
    bare: bool,
}

const OPERAND: &str = "write a variable, a name, a number, TRUE or FALSE";

const PRECEDENCE: &str = "AND, OR, XOR, NOT bind stronger than a comparison: put the comparison into parentheses, `(a > 1) AND b`";

/// The longest time that a timer is compared with, in microseconds: 24 days.
const LONGEST: i64 = 24 * 86_400 * MILLION;

impl Parser<'_, '_> {
    /// The condition of an action.
    pub(super) fn condition(&mut self) -> Checked<Expr> {
        let expr = self.expr()?;
        truth(&expr, "a condition is TRUE or FALSE")?;
        Ok(expr)
    }

    /// An expression; the comparison binds weakest, and is not mixed with words without parentheses.
    pub(super) fn expr(&mut self) -> Checked<Expr> {
        let left = self.or()?;
        let Some(relation) = self.relation() else {
            return Ok(left.expr);
        };
        let sign = self.span();
        self.at += 1;
        // A word after the right side would take it away from the comparison.
        let right = self.unary()?;
        let word = ["AND", "OR", "XOR"].contains(&self.upper().as_str());
        if left.bare || right.bare || word || self.relation().is_some() {
            return Err(Fault::new(
                &sign,
                format!(
                    "`{}` stands beside other operators without parentheses",
                    relation.symbol()
                ),
                PRECEDENCE,
            ));
        }
        let span = left.expr.span.start..right.expr.span.end;
        let (a, b) = (left.expr, right.expr);
        comparable(relation, &a, &b, &span)?;
        Ok(Expr {
            kind: ExprKind::Compare(relation, Box::new(a), Box::new(b)),
            span,
        })
    }

    fn relation(&self) -> Option<Relation> {
        Some(match self.peek() {
            Token::Sym("==") => Relation::Equal,
            Token::Sym("<>") => Relation::Unequal,
            Token::Sym(">") => Relation::Greater,
            Token::Sym("<") => Relation::Less,
            Token::Sym(">=") => Relation::GreaterEqual,
            Token::Sym("<=") => Relation::LessEqual,
            _ => return None,
        })
    }

    fn or(&mut self) -> Checked<Read> {
        self.chain(Logic::Or, |me| {
            me.chain(Logic::Xor, |me| me.chain(Logic::And, Self::unary))
        })
    }

    /// Operands with one word between them, which groups to the left.
    fn chain(&mut self, word: Logic, read: impl Fn(&mut Self) -> Checked<Read>) -> Checked<Read> {
        let mut left = read(self)?;
        let mut length = 0;
        while self.word(word.word()) {
            let right = read(self)?;
            length += 1;
            if length > MAX_DEPTH * 4 {
                return Err(deep(&right.expr.span));
            }
            for side in [&left.expr, &right.expr] {
                truth(side, &format!("{} combines truth values", word.word()))?;
            }
            let span = left.expr.span.start..right.expr.span.end;
            let (a, b) = (Box::new(left.expr), Box::new(right.expr));
            left = Read {
                expr: Expr {
                    kind: ExprKind::Logic(word, a, b),
                    span,
                },
                bare: true,
            };
        }
        Ok(left)
    }

    fn unary(&mut self) -> Checked<Read> {
        let start = self.span();
        if !self.word("NOT") {
            return self.primary();
        }
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(deep(&start));
        }
        let inner = self.unary()?;
        self.depth -= 1;
        truth(&inner.expr, "NOT turns a truth value")?;
        let span = start.start..inner.expr.span.end;
        let kind = ExprKind::Not(Box::new(inner.expr));
        Ok(Read {
            expr: Expr { kind, span },
            bare: true,
        })
    }

    fn primary(&mut self) -> Checked<Read> {
        let span = self.span();
        let kind = match self.peek().clone() {
            Token::Sym("(") => {
                self.at += 1;
                self.depth += 1;
                if self.depth > MAX_DEPTH {
                    return Err(deep(&span));
                }
                let mut expr = self.expr()?;
                self.depth -= 1;
                self.expect(")", "close the parenthesis that was opened before")?;
                expr.span = self.since(span.start);
                return Ok(Read { expr, bare: false });
            }
            Token::Number(..) | Token::Sym("-") => ExprKind::Number(self.number()?),
            Token::System(_) => ExprKind::Variable(self.system()?),
            Token::Word(word) if word.eq_ignore_ascii_case("TRUE") => {
                self.at += 1;
                ExprKind::Bool(true)
            }
            Token::Word(word) if word.eq_ignore_ascii_case("FALSE") => {
                self.at += 1;
                ExprKind::Bool(false)
            }
            Token::Word(word) if word.eq_ignore_ascii_case("SIRELAY") => {
                return Err(Fault::new(
                    &span,
                    "SIRELAY stands in an expression",
                    "its status is assigned alone: `$AC_MARKER[1] = SIRELAY(1)`",
                ));
            }
            Token::Word(word) if is_reserved(&word) => return self.wanted("a value", OPERAND),
            Token::Word(name) => {
                self.at += 1;
                match self.known(&name, &span)?.meaning {
                    Meaning::Variable(variable) => ExprKind::Variable(variable),
                    Meaning::Number(millionths, real) => {
                        ExprKind::Number(Number { millionths, real })
                    }
                    Meaning::Undefined => ExprKind::Unknown(name),
                    Meaning::Local => return Err(local(&name, &span)),
                }
            }
            _ => return self.wanted("a value", OPERAND),
        };
        let expr = Expr {
            kind,
            span: self.since(span.start),
        };
        readable(&expr)?;
        Ok(Read { expr, bare: false })
    }

    /// A number with its sign.
    pub(super) fn number(&mut self) -> Checked<Number> {
        let negative = self.sym("-");
        match *self.peek() {
            Token::Number(millionths, real) => {
                self.at += 1;
                let millionths = if negative { -millionths } else { millionths };
                Ok(Number { millionths, real })
            }
            _ => self.wanted("a number", "write 5, -1 or 0.4"),
        }
    }

    /// Checks C3 and C4: what is assigned may be written, and the value is of its type. S840D-LANG-708.
    pub(super) fn assignable(&mut self, assign: &Assign) -> Checked<()> {
        let target = &assign.target;
        let (ty, written) = match &target.kind {
            ExprKind::Variable(variable) => {
                if variable.kind().access == Access::Read {
                    return Err(Fault::new(
                        &target.span,
                        format!("`{}` is an input, and is not assigned", variable.written()),
                        "outputs are $A_OUTSE, $A_OUTSI, $A_PLCSIOUT; what is only used inside is a marker: $A_MARKERSI",
                    )
                    .label("cannot be written"));
                }
                (variable.kind().ty, variable.written())
            }
            _ => (Ty::Unknown, String::new()),
        };
        let expr = match &assign.value {
            Value::Relay(_) if matches!(ty, Ty::Int | Ty::Unknown) => return Ok(()),
            Value::Relay(_) => {
                return Err(Fault::new(
                    &target.span,
                    format!(
                        "`{written}` is {}, and SIRELAY answers with a number",
                        ty.name()
                    ),
                    "assign it to an INT such as `$AC_MARKER[1]`",
                ));
            }
            Value::Expr(expr) => expr,
        };
        let number = match &expr.kind {
            ExprKind::Number(number) => Some(*number),
            _ => None,
        };
        let wrong = |help: &str| {
            let is = match number {
                Some(number) => format!("`{}`", decimal(number.millionths, number.real)),
                None => expr.ty().name().to_owned(),
            };
            Err(Fault::new(
                &expr.span,
                format!("`{written}` is {}, this is {is}", ty.name()),
                help,
            ))
        };
        match (ty, expr.ty(), number) {
            (Ty::Unknown, ..) | (_, Ty::Unknown, _) | (Ty::Bool, Ty::Bool, _) => Ok(()),
            (Ty::Bool, Ty::Int, Some(number)) if [0, MILLION].contains(&number.millionths) => {
                Ok(())
            }
            (Ty::Bool, Ty::Int, None) => wrong("compare the number: `target = (number == 1)`"),
            (Ty::Bool, ..) => wrong("write 0, 1, TRUE, FALSE, or an expression of truth values"),
            (Ty::Int, Ty::Int, _) => Ok(()),
            (Ty::Int, ..) => wrong("write a whole number, or a variable with one"),
            (Ty::Real, _, Some(number)) if number.millionths <= LONGEST => Ok(()),
            (Ty::Real, _, Some(_)) => wrong("at most 24 days: 2073600"),
            (Ty::Real, ..) => Err(Fault::new(
                &expr.span,
                format!("`{written}` is a timer, and is set to a number only"),
                "write seconds: 0 starts it, -1 stops it and keeps its value",
            )),
        }
    }
}

fn deep(span: &Span) -> Fault {
    Fault::new(
        span,
        "this expression is too long or nested too deep",
        "give parts of it to a marker in an action before",
    )
}

/// Check C4 for reading.
fn readable(expr: &Expr) -> Checked<()> {
    match &expr.kind {
        ExprKind::Variable(variable) if variable.kind().access == Access::Write => Err(Fault::new(
            &expr.span,
            format!("`{}` can be written only", variable.written()),
            "keep what was written in a marker: $A_MARKERSI",
        )),
        _ => Ok(()),
    }
}

/// Check C1: a truth value. S840D-LANG-707.
fn truth(expr: &Expr, why: &str) -> Checked<()> {
    let help = match (expr.ty(), &expr.kind) {
        (Ty::Bool | Ty::Unknown, _) => return Ok(()),
        (_, ExprKind::Number(_)) => "write TRUE or FALSE",
        (Ty::Real, _) => "compare the timer: `(timer > 1.0)`",
        (_, _) => "compare it: `(x == 1)`; a byte of the PLC is turned into a marker by comparison",
    };
    let message = format!("{why}, this is {}", expr.ty().name());
    Err(Fault::new(&expr.span, message, help).label(format!("is {}", expr.ty().name())))
}

/// Check C2: a truth value with 0, 1, FALSE or TRUE; a number or timer with a number.
fn comparable(relation: Relation, a: &Expr, b: &Expr, span: &Span) -> Checked<()> {
    let literal = |e: &Expr| matches!(e.kind, ExprKind::Number(_) | ExprKind::Bool(_));
    let (value, with) = match (literal(a), literal(b)) {
        (false, true) => (a, b),
        (true, false) => (b, a),
        (true, true) => {
            return Err(Fault::new(
                span,
                "this compares two constants, and is always the same",
                "compare a variable with a constant",
            ));
        }
        (false, false) => {
            let help = match a.ty() {
                Ty::Bool => {
                    "one side is 0, 1, FALSE or TRUE; write `a XOR b` for `a <> b`, `NOT (a XOR b)` for `a == b`"
                }
                _ => "one side is a number: compare each with it, and combine what comes out",
            };
            let message = format!(
                "`{}` stands between two values that change",
                relation.symbol()
            );
            return Err(Fault::new(span, message, help));
        }
    };
    let order = !matches!(relation, Relation::Equal | Relation::Unequal);
    let number = match &with.kind {
        ExprKind::Number(number) => Some(*number),
        _ => None,
    };
    match (value.ty(), number) {
        (Ty::Bool, _) if order => Err(Fault::new(
            span,
            format!("`{}`: truth values have no order", relation.symbol()),
            "use == or <>",
        )),
        (Ty::Bool, Some(number)) if number.real || ![0, MILLION].contains(&number.millionths) => {
            Err(Fault::new(
                &with.span,
                format!(
                    "a truth value is never `{}`",
                    decimal(number.millionths, number.real)
                ),
                "compare it with 0, 1, FALSE or TRUE",
            ))
        }
        (Ty::Int | Ty::Real, None) => Err(Fault::new(
            &with.span,
            format!("{} is not compared with a truth value", value.ty().name()),
            "write a number",
        )),
        (Ty::Int, Some(number)) if number.real => Err(Fault::new(
            &with.span,
            format!(
                "INT is not compared with `{}`",
                decimal(number.millionths, true)
            ),
            "write a whole number",
        )),
        (Ty::Int, Some(number)) => possible(value, with, number),
        (Ty::Real, Some(number)) if number.millionths > LONGEST => Err(Fault::new(
            &with.span,
            "no timer is waited for that long",
            "at most 24 days: 2073600",
        )),
        _ => Ok(()),
    }
}

/// A number that its variable can have.
fn possible(value: &Expr, with: &Expr, number: Number) -> Checked<()> {
    let ExprKind::Variable(variable) = &value.kind else {
        return Ok(());
    };
    let Values::Range(low, high) = variable.kind().values else {
        return Ok(());
    };
    let number = number.millionths / MILLION;
    match (low..=high).contains(&number) {
        true => Ok(()),
        false => Err(Fault::new(
            &with.span,
            format!("`{}` is never {number}", variable.written()),
            format!("it is {low}..{high}"),
        )),
    }
}
