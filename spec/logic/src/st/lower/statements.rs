//! Statements: each is run once; branches are run both, and what they leave behind is merged.

use std::rc::Rc;

use super::declare::upper;
use super::{Entry, Env, Lowering, MAX_DEPTH, MAX_FAULTS, MAX_WORK, Scope, Slot};
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{Expr, For, Label, Stmt, StmtKind};
use crate::st::lower::blocks::silent;
use crate::st::term::{Term, Ty};

impl<'a> Lowering<'a> {
    /// The statements of a body or branch, as far as no RETURN or EXIT ends them.
    pub(super) fn body(&mut self, statements: &'a [Stmt], scope: &Scope<'a>) {
        for (k, statement) in statements.iter().enumerate() {
            let result = self.works(&statement.span);
            if let Err(fault) = result {
                self.fault(fault);
                break;
            }
            if self.faults.len() >= MAX_FAULTS {
                break;
            }
            if let Err(fault) = self.statement(statement, scope) {
                self.fault(fault);
            }
            let gone = self.gone();
            if gone.is(false) {
                continue;
            }
            let rest = &statements[k + 1..];
            if !rest.is_empty() {
                let result = self.branch(&gone, &statement.span, |_| {}, |me| me.body(rest, scope));
                self.note(result);
            }
            break;
        }
    }

    /// Whether a RETURN or EXIT was met.
    fn gone(&self) -> Term {
        self.value(Slot::Return).or(&self.value(Slot::Exit))
    }

    fn statement(&mut self, statement: &'a Stmt, scope: &Scope<'a>) -> Checked<()> {
        match &statement.kind {
            StmtKind::Assign(target, value) => {
                self.assignment(target, value, &statement.span, scope)
            }
            StmtKind::Call(target, args) => self.call_block(target, args, &statement.span, scope),
            StmtKind::If(branches, rest) => self.choose(branches, rest, scope),
            StmtKind::Case(selector, branches, rest) => self.case(selector, branches, rest, scope),
            StmtKind::For(counted) => self.counted(counted, &statement.span, scope),
            StmtKind::Return => {
                self.env.insert(Slot::Return, Rc::new(Term::bool(true)));
                Ok(())
            }
            StmtKind::Exit if self.loops.is_empty() => Err(Fault::new(
                &statement.span,
                "EXIT leaves a loop, and there is none around it",
                "use RETURN to end the program or block",
            )),
            StmtKind::Exit => {
                self.env.insert(Slot::Exit, Rc::new(Term::bool(true)));
                Ok(())
            }
        }
    }

    fn choose(
        &mut self,
        branches: &'a [crate::st::ast::Branch],
        rest: &'a [Stmt],
        scope: &Scope<'a>,
    ) -> Checked<()> {
        let Some(((condition, body), others)) = branches.split_first() else {
            self.body(rest, scope);
            return Ok(());
        };
        let guard = match self.typed(condition, scope, Ty::Bool) {
            Ok(term) => {
                let quoted = self.quoted(&condition.span);
                let text = match self.site {
                    Some(_) => quoted,
                    None => format!("IF {quoted}"),
                };
                self.named("if", &condition.span, term, Some(text))?
            }
            Err(fault) => {
                // The branches are looked at all the same.
                self.fault(fault);
                Term::bool(false)
            }
        };
        self.branch(
            &guard,
            &condition.span,
            |me| me.body(body, scope),
            |me| {
                let result = me.choose(others, rest, scope);
                me.note(result);
            },
        )
    }

    fn case(
        &mut self,
        selector: &'a Expr,
        branches: &'a [(Vec<Label>, Vec<Stmt>)],
        rest: &'a [Stmt],
        scope: &Scope<'a>,
    ) -> Checked<()> {
        let term = self.expr(selector, scope, None)?;
        if matches!(term.ty, Ty::Bool | Ty::Time) {
            return Err(Fault::new(
                &selector.span,
                format!(
                    "CASE chooses by a number or an enum, this is {}",
                    self.signature.name(term.ty)
                ),
                "use IF",
            ));
        }
        let term = self.named("case", &selector.span, term, None)?;
        self.case_branch(&term, branches, rest, scope, &mut Vec::new())
    }

    fn case_branch(
        &mut self,
        selector: &Term,
        branches: &'a [(Vec<Label>, Vec<Stmt>)],
        rest: &'a [Stmt],
        scope: &Scope<'a>,
        seen: &mut Vec<(i64, i64)>,
    ) -> Checked<()> {
        let Some(((labels, body), others)) = branches.split_first() else {
            self.body(rest, scope);
            return Ok(());
        };
        let mut guard = Term::bool(false);
        for label in labels {
            match self.label(selector, label, scope, seen) {
                Ok(matches) => guard = guard.or(&matches),
                Err(fault) => self.fault(fault),
            }
        }
        let span = labels.first().map_or(0..0, |l| l.first.span.clone());
        let guard = self.named("case", &span, guard, None)?;
        self.branch(
            &guard,
            &span,
            |me| me.body(body, scope),
            |me| {
                let result = me.case_branch(selector, others, rest, scope, seen);
                me.note(result);
            },
        )
    }

    /// Whether the selector is one of the values of a label.
    fn label(
        &mut self,
        selector: &Term,
        label: &Label,
        scope: &Scope<'a>,
        seen: &mut Vec<(i64, i64)>,
    ) -> Checked<Term> {
        let mut ends = Vec::new();
        for end in [Some(&label.first), label.last.as_ref()]
            .into_iter()
            .flatten()
        {
            let term = self.fixed(end, scope, selector.ty, "a value of CASE")?;
            let Some(value) = term.constant() else {
                return Err(Fault::new(
                    &end.span,
                    "a value of CASE has to be a literal",
                    "write the number",
                ));
            };
            ends.push((term, value));
        }
        let (Some((first, low)), Some((last, high))) = (ends.first(), ends.last()) else {
            return Err(silent(&label.first.span));
        };
        let span = label.first.span.start..label.last.as_ref().unwrap_or(&label.first).span.end;
        if low > high {
            return Err(Fault::new(
                &span,
                "this range is empty",
                "the smaller value comes first",
            ));
        }
        if seen.iter().any(|(a, b)| low <= b && a <= high) {
            return Err(Fault::new(
                &span,
                format!("`{}` stands in this CASE already", self.quoted(&span)),
                "each value belongs to one branch; what is left belongs to ELSE",
            ));
        }
        seen.push((*low, *high));
        if *high < selector.low || *low > selector.high {
            return Err(Fault::new(
                &span,
                format!(
                    "the selector is never `{}`: it is {}..{}",
                    self.quoted(&span),
                    selector.low,
                    selector.high
                ),
                "take the branch out, or widen the range of the variable",
            ));
        }
        Ok(match low == high {
            true => self.compare("=", selector, first),
            false => {
                let above = self.compare(">=", selector, first);
                above.and(&self.compare("<=", selector, last))
            }
        })
    }

    /// FOR: its body once for each value of its variable.
    fn counted(&mut self, counted: &'a For, span: &Span, scope: &Scope<'a>) -> Checked<()> {
        let name = &counted.variable;
        let id = match scope.names.get(&upper(&name.text)) {
            Some(Entry::Variable(id)) if self.variables[*id].ty == Ty::Int => *id,
            Some(Entry::Failed) => return Err(silent(&name.span)),
            Some(_) => {
                return Err(Fault::new(
                    &name.span,
                    format!(
                        "'{}' cannot count: it is no variable of type INT",
                        name.text
                    ),
                    "declare it under VAR: `i : INT (0..7);`",
                ));
            }
            None => return Err(self.unknown(&name.text, &name.span, scope)),
        };
        self.free_of_loops(id, &name.span)?;
        let bound = |me: &mut Self, e: &Expr| -> Checked<i64> {
            let term = me.fixed(e, scope, Ty::Int, "a bound of FOR")?;
            term.constant().ok_or_else(|| {
                Fault::new(
                    &e.span,
                    "a bound of FOR has to be a literal or a constant of the program",
                    "write the number",
                )
            })
        };
        let (from, to) = (bound(self, &counted.from)?, bound(self, &counted.to)?);
        let by = match &counted.by {
            Some(by) => bound(self, by)?,
            None => 1,
        };
        if by == 0 {
            return Err(Fault::new(
                &counted
                    .by
                    .as_ref()
                    .map_or(span.clone(), |by| by.span.clone()),
                "a FOR by 0 never ends",
                "count by 1, or by another number",
            ));
        }
        let kept = self.env.remove(&Slot::Exit);
        self.loops.push(id);
        let mut value = from;
        while (by > 0 && value <= to) || (by < 0 && value >= to) {
            let round = |me: &mut Self| -> Checked<()> {
                let loops = std::mem::take(&mut me.loops);
                let counted_up = me.assign(id, Term::number(value, Ty::Int), &name.span);
                me.loops = loops;
                counted_up?;
                me.body(&counted.body, scope);
                Ok(())
            };
            let gone = self.gone();
            if gone.is(true) || self.work > MAX_WORK {
                break;
            }
            let mut failed = None;
            self.branch(&gone, span, |_| {}, |me| failed = round(me).err())?;
            if let Some(fault) = failed {
                self.loops.pop();
                return Err(fault);
            }
            // An empty body is work too.
            self.work += 1;
            value += by;
        }
        self.loops.pop();
        match kept {
            Some(kept) => self.env.insert(Slot::Exit, kept),
            None => self.env.remove(&Slot::Exit),
        };
        Ok(())
    }

    /// Runs both branches, and chooses between the values that they leave behind.
    pub(super) fn branch(
        &mut self,
        guard: &Term,
        span: &Span,
        yes: impl FnOnce(&mut Self),
        no: impl FnOnce(&mut Self),
    ) -> Checked<()> {
        if self.depth >= MAX_DEPTH {
            return Err(Fault::new(
                span,
                format!(
                    "more than {MAX_DEPTH} branches and places of RETURN lie within one another"
                ),
                "give a result to a variable and go on, in place of RETURN; nest fewer branches and blocks",
            ));
        }
        let guard = self.named("if", span, guard.clone(), None)?;
        let known = self.variables.len();
        let before = self.env.clone();
        let (after_yes, checks) = self.alone(&guard, yes);
        self.env.clone_from(&before);
        // A branch that is never taken is looked at, and leaves nothing behind.
        if guard.is(false) {
            self.checks.truncate(checks);
        }
        let (after_no, checks) = self.alone(&guard.not(), no);
        if guard.is(true) {
            self.checks.truncate(checks);
        }
        self.env = before;
        let mut slots: Vec<Slot> = after_yes.keys().chain(after_no.keys()).copied().collect();
        slots.sort_unstable();
        slots.dedup();
        for slot in slots {
            // Variables of functions that were called in a branch ended with their call.
            if matches!(slot, Slot::Variable(id) if id >= known) {
                continue;
            }
            let side =
                |env: &Env, me: &Self| env.get(&slot).cloned().unwrap_or_else(|| me.value(slot));
            let (a, b) = (side(&after_yes, self), side(&after_no, self));
            let merged = Term::select(&guard, &b, &a);
            let base = match slot {
                Slot::Variable(id) => self.variables[id].name.clone(),
                Slot::Return => "returned".to_owned(),
                Slot::Exit => "left".to_owned(),
            };
            let merged = self.unquoted(&base, span, merged, "after line")?;
            self.env.insert(slot, Rc::new(merged));
        }
        Ok(())
    }

    /// One branch under its condition: the values it leaves behind, and how many checks there were before it.
    fn alone(&mut self, guard: &Term, run: impl FnOnce(&mut Self)) -> (Env, usize) {
        let checks = self.checks.len();
        self.path.push(guard.clone());
        self.depth += 1;
        run(self);
        self.depth -= 1;
        self.path.pop();
        (std::mem::take(&mut self.env), checks)
    }
}
