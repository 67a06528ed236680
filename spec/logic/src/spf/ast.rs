//! A program as it was read.

use super::variable::{Ty, Variable};
use crate::fault::Span;

/// A number as it is written; times are whole microseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Number {
    /// In millionths.
    pub millionths: i64,
    /// Whether it has a decimal point.
    pub real: bool,
}

/// An expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Expr {
    pub kind: ExprKind,
    pub span: Span,
}

/// Words between truth values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Logic {
    And,
    Or,
    Xor,
}

/// Comparisons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Relation {
    Equal,
    Unequal,
    Greater,
    Less,
    GreaterEqual,
    LessEqual,
}

impl Logic {
    pub const fn word(self) -> &'static str {
        match self {
            Logic::And => "AND",
            Logic::Or => "OR",
            Logic::Xor => "XOR",
        }
    }
}

impl Relation {
    pub const fn symbol(self) -> &'static str {
        match self {
            Relation::Equal => "==",
            Relation::Unequal => "<>",
            Relation::Greater => ">",
            Relation::Less => "<",
            Relation::GreaterEqual => ">=",
            Relation::LessEqual => "<=",
        }
    }

    /// The same with its sides exchanged.
    pub const fn turned(self) -> Self {
        match self {
            Relation::Greater => Relation::Less,
            Relation::Less => Relation::Greater,
            Relation::GreaterEqual => Relation::LessEqual,
            Relation::LessEqual => Relation::GreaterEqual,
            same => same,
        }
    }
}

/// The kinds of expressions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum ExprKind {
    Bool(bool),
    Number(Number),
    Variable(Variable),
    /// A name that a fragment does not define.
    Unknown(String),
    Not(Box<Expr>),
    Logic(Logic, Box<Expr>, Box<Expr>),
    Compare(Relation, Box<Expr>, Box<Expr>),
}

impl Expr {
    /// Its type, as far as its outermost form says.
    pub fn ty(&self) -> Ty {
        match &self.kind {
            ExprKind::Bool(_) | ExprKind::Not(_) | ExprKind::Logic(..) | ExprKind::Compare(..) => {
                Ty::Bool
            }
            ExprKind::Number(number) if number.real => Ty::Real,
            ExprKind::Number(_) => Ty::Int,
            ExprKind::Variable(variable) => variable.kind().ty,
            ExprKind::Unknown(_) => Ty::Unknown,
        }
    }

    /// Calls `see` with it and each of its parts.
    pub fn each<'e>(&'e self, see: &mut impl FnMut(&'e Expr)) {
        see(self);
        match &self.kind {
            ExprKind::Not(inner) => inner.each(see),
            ExprKind::Logic(_, a, b) | ExprKind::Compare(_, a, b) => {
                a.each(see);
                b.each(see);
            }
            ExprKind::Bool(_)
            | ExprKind::Number(_)
            | ExprKind::Variable(_)
            | ExprKind::Unknown(_) => {}
        }
    }
}

/// What is assigned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Value {
    Expr(Expr),
    /// `SIRELAY(x)`: one step of a relay, and its status.
    Relay(u8),
}

/// `target = value`
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Assign {
    /// A variable, or a name that a fragment does not define.
    pub target: Expr,
    pub value: Value,
    pub span: Span,
}

/// When an action fires: S840D-LANG-705.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trigger {
    Always,
    Whenever,
    Every,
    /// Once, in the first cycle in which its condition holds; `WHEN TRUE` presets a variable (S840D-SPLSTART-014).
    When,
    From,
}

/// A synchronous action: S840D-LANG-703.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Action {
    pub id: u8,
    pub id_span: Span,
    /// `ID`, not `IDS`.
    pub modal: bool,
    pub trigger: Trigger,
    pub condition: Option<Expr>,
    pub assigns: Vec<Assign>,
    pub span: Span,
}

/// The set-up of a safety relay, as far as it is there.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Relay {
    /// Q1, Q2, E1, E2, E3.
    pub inputs: Option<(Vec<Expr>, Span)>,
    /// A0 to A3.
    pub outputs: Option<(Vec<Expr>, Span)>,
    /// TM1, TI1 to TI3, in microseconds.
    pub times: Option<(Vec<i64>, Span)>,
}

/// A name that a program gives to a variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Name {
    pub name: String,
    pub variable: Variable,
    pub span: Span,
}
