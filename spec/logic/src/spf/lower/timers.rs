//! Timers. A timer is `start + n * T`: the number it was set to, and the cycles since. Times are whole microseconds, so `t > L` is
//! `t >= L + 1 µs`, that is `n >= (L + 1 µs - start) / T`, rounded up: the rounding that all durations of a program have. So each
//! comparison is exact, also where a limit is no whole number of cycles. The count stops at the largest limit, above which no comparison
//! tells anything apart.

use std::collections::BTreeMap;

use super::super::ast::{Action, Expr as Source, ExprKind as SourceKind, Relation, Value};
use super::super::{Program, Variable};
use crate::fault::Span;
use crate::st::ast::{BinaryOp, Expr, Stmt, TypeKind, VarDecl};
use crate::tree::{
    assign, binary, bounds, call, name, not, number, only_if, time, truth, variable,
};

/// A timer of the program: S840D-LANG-706.
pub(super) struct Timer {
    /// The variable that counts its cycles.
    count: String,
    /// The variable that says whether it runs.
    runs: String,
    /// The variable that says which of `starts` it was set to; only if there are several.
    from: String,
    /// The numbers that it is set to, and 0, which it begins with; in microseconds, ascending.
    starts: Vec<i64>,
    /// The largest limit, in microseconds; 0 if no comparison depends on the time.
    longest: i64,
    title: String,
    span: Span,
}

/// The limits that a comparison looks at, in microseconds: whether the time is at least that.
fn limits(relation: Relation, limit: i64) -> Vec<i64> {
    match relation {
        Relation::Greater | Relation::LessEqual => vec![limit + 1],
        Relation::GreaterEqual | Relation::Less => vec![limit],
        Relation::Equal | Relation::Unequal => vec![limit, limit + 1],
    }
}

/// A comparison of a timer with a number: the timer, the relation as seen from it, and the number.
pub(super) fn comparison(e: &Source) -> Option<(&Variable, Relation, i64)> {
    let SourceKind::Compare(relation, a, b) = &e.kind else {
        return None;
    };
    match (&a.kind, &b.kind) {
        (SourceKind::Variable(v), SourceKind::Number(n)) if v.is_timer() => {
            Some((v, *relation, n.millionths))
        }
        (SourceKind::Number(n), SourceKind::Variable(v)) if v.is_timer() => {
            Some((v, relation.turned(), n.millionths))
        }
        _ => None,
    }
}

/// What a comparison says of a time that does not change.
pub(super) fn compared(relation: Relation, value: i64, limit: i64) -> bool {
    match relation {
        Relation::Equal => value == limit,
        Relation::Unequal => value != limit,
        Relation::Greater => value > limit,
        Relation::Less => value < limit,
        Relation::GreaterEqual => value >= limit,
        Relation::LessEqual => value <= limit,
    }
}

impl Timer {
    /// The timers that a program sets; `fresh` gives names.
    pub fn all(
        program: &Program,
        mut fresh: impl FnMut(&str) -> String,
    ) -> BTreeMap<Variable, Timer> {
        let places = program.places();
        let timers = places
            .iter()
            .filter(|(variable, places)| variable.is_timer() && places.written.is_some());
        timers
            .map(|(variable, places)| {
                let base = variable.identifier();
                let title = program
                    .title(variable)
                    .unwrap_or_else(|| variable.to_string());
                let mut timer = Timer {
                    count: fresh(&base),
                    runs: fresh(&format!("{base}_runs")),
                    from: fresh(&format!("{base}_from")),
                    starts: vec![0],
                    longest: 0,
                    title,
                    span: program.place(variable, places),
                };
                timer.collect(variable, &program.actions);
                (variable.clone(), timer)
            })
            .collect()
    }

    fn collect(&mut self, variable: &Variable, actions: &[Action]) {
        let mut ends = Vec::new();
        let mut look = |e: &Source| {
            e.each(&mut |part| {
                if let Some((_, relation, limit)) =
                    comparison(part).filter(|(of, ..)| *of == variable)
                {
                    ends.extend(limits(relation, limit));
                }
            });
        };
        for action in actions {
            action.condition.iter().for_each(&mut look);
            for one in &action.assigns {
                let Value::Expr(value) = &one.value else {
                    continue;
                };
                look(value);
                if let (SourceKind::Variable(target), SourceKind::Number(to)) =
                    (&one.target.kind, &value.kind)
                {
                    if target == variable && to.millionths >= 0 {
                        self.starts.push(to.millionths);
                    }
                }
            }
        }
        self.starts.sort_unstable();
        self.starts.dedup();
        let most = ends.into_iter().max().unwrap_or(0);
        self.longest = most.max(0);
    }

    /// Whether any comparison depends on it.
    const fn counts(&self) -> bool {
        self.longest > 0
    }

    /// Its variables.
    pub fn declared(&self, begins_large: bool) -> Vec<VarDecl> {
        if !self.counts() {
            return Vec::new();
        }
        let span = &self.span;
        let title = |what: &str| Some(format!("{}{what}", self.title));
        let range = bounds(time(0, span), time(self.longest, span));
        // From 0 it takes the longest limit to be above all of them.
        let init = if begins_large { self.longest } else { 0 };
        let mut out = vec![
            variable(
                &self.count,
                title(""),
                TypeKind::Kept(range),
                Some(time(init, span)),
                span,
            ),
            variable(
                &self.runs,
                title(" runs"),
                TypeKind::Bool,
                Some(truth(false, span)),
                span,
            ),
        ];
        if self.starts.len() > 1 {
            let last = self.starts.len() as i64 - 1;
            let range = bounds(number(0, span), number(last, span));
            let ty = TypeKind::Int("INT".to_owned(), range);
            out.push(variable(
                &self.from,
                title(" from"),
                ty,
                Some(number(0, span)),
                span,
            ));
        }
        out
    }

    /// At the beginning of a cycle: a running timer is a cycle further.
    pub fn tick(&self) -> Option<Stmt> {
        let span = &self.span;
        let next = binary(
            BinaryOp::Add,
            name(&self.count, span),
            name("CYCLE", span),
            span,
        );
        let next = call("MIN", vec![next, time(self.longest, span)], span);
        self.counts().then(|| {
            only_if(
                name(&self.runs, span),
                vec![assign(&self.count, next, span)],
            )
        })
    }

    /// It is set to a number: a negative one stops it, and it keeps its time.
    pub fn set(&self, to: i64, span: &Span) -> Vec<Stmt> {
        if !self.counts() {
            return Vec::new();
        }
        if to < 0 {
            return vec![assign(&self.runs, truth(false, span), span)];
        }
        let mut out = vec![
            assign(&self.count, time(0, span), span),
            assign(&self.runs, truth(true, span), span),
        ];
        if self.starts.len() > 1 {
            let place = self.starts.iter().position(|start| *start == to);
            let place = place.unwrap_or_default() as i64;
            out.push(assign(&self.from, number(place, span), span));
        }
        out
    }

    /// A comparison with a number.
    pub fn compare(&self, relation: Relation, limit: i64, span: &Span) -> Expr {
        match relation {
            Relation::Greater => self.reached(limit + 1, span),
            Relation::GreaterEqual => self.reached(limit, span),
            Relation::Less => not(self.reached(limit, span)),
            Relation::LessEqual => not(self.reached(limit + 1, span)),
            Relation::Equal => {
                let above = not(self.reached(limit + 1, span));
                binary(BinaryOp::And, self.reached(limit, span), above, span)
            }
            Relation::Unequal => not(self.compare(Relation::Equal, limit, span)),
        }
    }

    /// Whether its time is at least `limit`.
    fn reached(&self, limit: i64, span: &Span) -> Expr {
        // No time is below 0.
        if limit <= 0 {
            return truth(true, span);
        }
        let after = |start: i64| match limit - start {
            rest if rest <= 0 => truth(true, span),
            rest => binary(
                BinaryOp::Ge,
                name(&self.count, span),
                time(rest, span),
                span,
            ),
        };
        if let [start] = self.starts[..] {
            return after(start);
        }
        let mut any = truth(false, span);
        for (k, start) in self.starts.iter().enumerate() {
            let from = binary(
                BinaryOp::Eq,
                name(&self.from, span),
                number(k as i64, span),
                span,
            );
            let both = binary(BinaryOp::And, from, after(*start), span);
            any = binary(BinaryOp::Or, any, both, span);
        }
        any
    }
}
