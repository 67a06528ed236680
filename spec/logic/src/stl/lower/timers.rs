//! Timers. Each is a clock that goes on by itself, with the result of its last start; a clock that nobody waits for stands at its end.

use super::super::ast::TimerKind;
use crate::fault::Span;
use crate::st::ast::{BinaryOp, Expr, Stmt, StmtKind, TypeKind, VarDecl};
use crate::tree::{assign, binary, bounds, name, not, only_if, time, truth, variable};

/// A timer that is started somewhere.
#[derive(Clone)]
pub(super) struct Timer {
    pub kind: TimerKind,
    /// In microseconds.
    pub length: i64,
    /// Where it is started.
    pub span: Span,
    clock: String,
    /// The result at its last start.
    was: String,
    /// It waits or has waited for its end; of delays only.
    runs: String,
    title: String,
}

impl Timer {
    pub fn new(
        number: u16,
        kind: TimerKind,
        us: u64,
        span: &Span,
        mut fresh: impl FnMut(&str) -> String,
    ) -> Self {
        Self {
            kind,
            length: i64::try_from(us).unwrap_or(i64::MAX),
            span: span.clone(),
            clock: fresh(&format!("t_{number}")),
            was: fresh(&format!("t_{number}_was")),
            runs: fresh(&format!("t_{number}_runs")),
            title: format!("T {number}"),
        }
    }

    /// Its variables.
    pub fn declared(&self) -> Vec<VarDecl> {
        let span = &self.span;
        let title = |what: &str| Some(format!("{}{what}", self.title));
        let range = bounds(time(0, span), self.end(span));
        let flag = |text: &str, what: &str| {
            variable(
                text,
                title(what),
                TypeKind::Bool,
                Some(truth(false, span)),
                span,
            )
        };
        let clock = TypeKind::Clock(range);
        let mut out = vec![
            variable(&self.clock, title(""), clock, Some(self.end(span)), span),
            flag(&self.was, " start"),
        ];
        if self.delays() {
            out.push(flag(&self.runs, " runs"));
        }
        out
    }

    fn delays(&self) -> bool {
        matches!(self.kind, TimerKind::OnDelay | TimerKind::RetentiveOnDelay)
    }

    fn end(&self, span: &Span) -> Expr {
        time(self.length, span)
    }

    /// The instruction that starts it, with the result.
    pub fn start(&self, result: &Expr, span: &Span) -> Vec<Stmt> {
        let rises = binary(
            BinaryOp::And,
            result.clone(),
            not(name(&self.was, span)),
            span,
        );
        let begin = assign(&self.clock, time(0, span), span);
        let rest = assign(&self.clock, self.end(span), span);
        let runs = |value| assign(&self.runs, truth(value, span), span);
        let was = assign(&self.was, result.clone(), span);
        match self.kind {
            TimerKind::Pulse => vec![
                only_if(rises, vec![begin]),
                only_if(not(result.clone()), vec![rest]),
                was,
            ],
            TimerKind::ExtendedPulse => vec![only_if(rises, vec![begin]), was],
            TimerKind::OnDelay => vec![
                only_if(rises, vec![begin, runs(true)]),
                only_if(not(result.clone()), vec![rest, runs(false)]),
                was,
            ],
            TimerKind::RetentiveOnDelay => vec![only_if(rises, vec![begin, runs(true)]), was],
            TimerKind::OffDelay => {
                let falls = name(&self.was, span);
                let branches = vec![(result.clone(), vec![rest]), (falls, vec![begin])];
                let choice = Stmt {
                    kind: StmtKind::If(branches, Vec::new()),
                    span: span.clone(),
                };
                vec![choice, was]
            }
        }
    }

    /// `R T 23` with this result; none: it has no meaning that the manual of the CPU says in one way.
    pub fn reset(&self, result: Expr, span: &Span) -> Option<Stmt> {
        let rest = assign(&self.clock, self.end(span), span);
        let runs = assign(&self.runs, truth(false, span), span);
        match self.kind {
            TimerKind::OffDelay => None,
            TimerKind::Pulse | TimerKind::ExtendedPulse => Some(only_if(result, vec![rest])),
            TimerKind::OnDelay | TimerKind::RetentiveOnDelay => {
                Some(only_if(result, vec![rest, runs]))
            }
        }
    }

    /// What a check of it sees.
    pub fn is_on(&self, span: &Span) -> Expr {
        let clock = || name(&self.clock, span);
        let running = binary(BinaryOp::Lt, clock(), self.end(span), span);
        let over = binary(BinaryOp::Ge, clock(), self.end(span), span);
        match self.kind {
            TimerKind::Pulse | TimerKind::ExtendedPulse => running,
            TimerKind::OnDelay | TimerKind::RetentiveOnDelay => {
                binary(BinaryOp::And, name(&self.runs, span), over, span)
            }
            TimerKind::OffDelay => binary(BinaryOp::Or, name(&self.was, span), running, span),
        }
    }
}
