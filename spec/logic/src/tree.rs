//! Pieces of a syntax tree in Structured Text, with places in the program.

use crate::fault::Span;
use crate::st::ast::{
    Arg, BinaryOp, Bounds, Expr, ExprKind, Init, Stmt, StmtKind, TypeKind, TypeRef, UnaryOp,
    VarDecl, Word,
};

pub(crate) fn word(text: impl Into<String>, span: &Span) -> Word {
    Word {
        text: text.into(),
        span: span.clone(),
    }
}

pub(crate) fn expr(kind: ExprKind, span: &Span) -> Expr {
    Expr {
        kind,
        span: span.clone(),
    }
}

pub(crate) fn name(text: impl Into<String>, span: &Span) -> Expr {
    expr(ExprKind::Name(text.into()), span)
}

pub(crate) fn truth(value: bool, span: &Span) -> Expr {
    expr(ExprKind::Bool(value), span)
}

pub(crate) fn number(value: i64, span: &Span) -> Expr {
    expr(ExprKind::Int(value), span)
}

/// A time in microseconds, not negative.
pub(crate) fn time(us: i64, span: &Span) -> Expr {
    expr(ExprKind::Time(us.unsigned_abs()), span)
}

pub(crate) fn not(inner: Expr) -> Expr {
    let span = inner.span.clone();
    expr(ExprKind::Unary(UnaryOp::Not, Box::new(inner)), &span)
}

pub(crate) fn binary(op: BinaryOp, a: Expr, b: Expr, span: &Span) -> Expr {
    expr(ExprKind::Binary(op, Box::new(a), Box::new(b)), span)
}

pub(crate) fn call(function: &str, values: Vec<Expr>, span: &Span) -> Expr {
    let args = values.into_iter().map(|value| Arg {
        name: None,
        out: false,
        value,
    });
    expr(ExprKind::Call(word(function, span), args.collect()), span)
}

pub(crate) fn assign(target: &str, value: Expr, span: &Span) -> Stmt {
    Stmt {
        kind: StmtKind::Assign(name(target, span), value),
        span: span.clone(),
    }
}

pub(crate) fn only_if(condition: Expr, body: Vec<Stmt>) -> Stmt {
    let span = condition.span.clone();
    Stmt {
        kind: StmtKind::If(vec![(condition, body)], Vec::new()),
        span,
    }
}

/// `block(NAME := value)`
pub(crate) fn call_block(block: &str, inputs: Vec<(&str, Expr)>, span: &Span) -> Stmt {
    let args = inputs.into_iter().map(|(parameter, value)| Arg {
        name: Some(word(parameter, span)),
        out: false,
        value,
    });
    Stmt {
        kind: StmtKind::Call(name(block, span), args.collect()),
        span: span.clone(),
    }
}

pub(crate) fn bounds(low: Expr, high: Expr) -> Bounds {
    Some(Box::new((low, high)))
}

pub(crate) fn variable(
    identifier: &str,
    title: Option<String>,
    kind: TypeKind,
    init: Option<Expr>,
    span: &Span,
) -> VarDecl {
    VarDecl {
        name: word(identifier, span),
        ty: TypeRef {
            kind,
            span: span.clone(),
        },
        init: init.map(Init::Value),
        title,
    }
}
