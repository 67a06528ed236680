//! Statements: each is run once; branches are run both, and what they leave behind is merged.

use std::rc::Rc;

use super::declare::upper;
use super::{Check, Entry, Env, Lowering, MAX_WORK, Role, Scope, Slot};
use crate::ast::{Expr, ExprKind, For, Label, Stmt, StmtKind};
use crate::fault::{Checked, Fault, Span};
use crate::lower::blocks::silent;
use crate::term::{Term, Ty};

impl<'a> Lowering<'a> {
    /// The statements of a body or branch, as far as no RETURN or EXIT ends them.
    pub(super) fn body(&mut self, statements: &'a [Stmt], scope: &Scope<'a>) {
        for (k, statement) in statements.iter().enumerate() {
            self.work += 1;
            if self.work > MAX_WORK {
                if self.work == MAX_WORK + 1 {
                    self.fault(Fault::new(
                        &statement.span,
                        format!("a cycle of the program has more than {MAX_WORK} statements"),
                        "make its loops shorter",
                    ));
                }
                return;
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
            return;
        }
    }

    /// Whether a RETURN or EXIT was met.
    fn gone(&self) -> Term {
        self.value(Slot::Return).or(&self.value(Slot::Exit))
    }

    fn statement(&mut self, statement: &'a Stmt, scope: &Scope<'a>) -> Checked<()> {
        match &statement.kind {
            StmtKind::Assign(target, value) => {
                let hint = self.target_type(target, scope);
                let term = self.expr(value, scope, hint);
                // Both sides are looked at, so that each fault is told.
                let target_fault = self.target(target, scope).err();
                let term = match (term, target_fault) {
                    (Ok(term), None) => term,
                    (Err(fault), None) => return Err(fault),
                    (Err(fault), Some(other)) => {
                        self.fault(fault);
                        return Err(other);
                    }
                    (Ok(_), Some(other)) => return Err(other),
                };
                let id = self.target(target, scope)?;
                self.assign_as(id, term, &value.span, &statement.span)
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
        branches: &'a [crate::ast::Branch],
        rest: &'a [Stmt],
        scope: &Scope<'a>,
    ) -> Checked<()> {
        let Some(((condition, body), others)) = branches.split_first() else {
            self.body(rest, scope);
            return Ok(());
        };
        let guard = match self.typed(condition, scope, Ty::Bool) {
            Ok(term) => self.named(
                "if",
                &condition.span,
                term,
                Some(format!("IF {}", self.quoted(&condition.span))),
            )?,
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
            let text = format!("{base} after the IF, CASE or loop");
            let merged = self.named(&base, span, merged, Some(text))?;
            self.env.insert(slot, Rc::new(merged));
        }
        Ok(())
    }

    /// One branch under its condition: the values it leaves behind, and how many checks there were before it.
    fn alone(&mut self, guard: &Term, run: impl FnOnce(&mut Self)) -> (Env, usize) {
        let checks = self.checks.len();
        self.path.push(guard.clone());
        run(self);
        self.path.pop();
        (std::mem::take(&mut self.env), checks)
    }

    /// The type of what is assigned, where that is a variable.
    fn target_type(&self, target: &Expr, scope: &Scope<'a>) -> Option<Ty> {
        let entry = match &target.kind {
            ExprKind::Name(name) => scope.names.get(&upper(name)).cloned(),
            ExprKind::Member(base, member) => self.member(base, member, scope).ok(),
            _ => None,
        };
        match entry {
            Some(Entry::Variable(id)) => Some(self.variables[id].ty),
            _ => None,
        }
    }

    /// The variable that is assigned.
    fn target(&self, target: &Expr, scope: &Scope<'a>) -> Checked<usize> {
        let not = |what: &str, help: &str| Err(Fault::new(&target.span, what, help));
        match &target.kind {
            ExprKind::Name(name) => match scope.names.get(&upper(name)) {
                Some(Entry::Variable(id)) => {
                    if self.variables[*id].role == Role::BlockInput {
                        return not(
                            &format!("'{name}' is an input, and is not assigned"),
                            "assign to a variable of your own under VAR, and use that",
                        );
                    }
                    self.free_of_loops(*id, &target.span)?;
                    Ok(*id)
                }
                Some(Entry::Input(_)) => not(
                    &format!("'{name}' is an input, and is not assigned"),
                    "what an input is comes from the machine: assign to a variable of your own under VAR, and use that",
                ),
                Some(Entry::Constant(_)) => not(
                    &format!("'{name}' is a constant, and is not assigned"),
                    "declare it under VAR",
                ),
                Some(Entry::Block(_)) => not(
                    &format!("'{name}' is a function block, and is not assigned"),
                    "call it: `name(IN := x);`",
                ),
                Some(Entry::Failed) => Err(silent(&target.span)),
                None => Err(self.unknown(name, &target.span, scope)),
            },
            ExprKind::Member(base, member) => match self.member(base, member, scope)? {
                Entry::Variable(id) if self.variables[id].role == Role::BlockInput => Ok(id),
                Entry::Variable(_) => not(
                    "an output of a block is not assigned from outside",
                    "give the block other inputs",
                ),
                _ => not(
                    "the time of a block is given in its call or declaration",
                    "write `t1(IN := x, PT := T#100ms);`",
                ),
            },
            _ => not(
                "this cannot be assigned",
                "write the name of a variable before `:=`",
            ),
        }
    }

    fn free_of_loops(&self, id: usize, span: &Span) -> Checked<()> {
        match self.loops.contains(&id) {
            false => Ok(()),
            true => Err(Fault::new(
                span,
                format!("'{}' counts the loop around it", self.variables[id].name),
                "use another variable",
            )),
        }
    }

    /// Stores what a block gives out.
    pub(super) fn store(&mut self, target: &Expr, term: Term, scope: &Scope<'a>) -> Checked<()> {
        let id = self.target(target, scope)?;
        self.assign(id, term, &target.span)
    }

    pub(super) fn assign(&mut self, id: usize, term: Term, span: &Span) -> Checked<()> {
        self.assign_as(id, term, span, span)
    }

    /// Assigns, if the type fits; a value that can leave the range of the variable is checked in each cycle.
    fn assign_as(&mut self, id: usize, term: Term, span: &Span, whole: &Span) -> Checked<()> {
        let variable = &self.variables[id];
        let name = variable.name.clone();
        if term.ty != variable.ty {
            return Err(self.wrong_type(variable.ty, &term, span));
        }
        let text = self.quoted(whole);
        // A standard block keeps its ranges by itself.
        let bounds = variable.bounds.clone().filter(|_| self.site.is_none());
        let Some((low, high)) = bounds else {
            let term = self.named(&name, whole, term, Some(text))?;
            self.set(id, term);
            return Ok(());
        };
        let term = self.named(&name, whole, term, Some(text.clone()))?;
        if term.high < low.low || term.low > high.high {
            return Err(Fault::new(
                span,
                format!(
                    "this is {}..{}, '{name}' holds {}..{}",
                    term.low, term.high, low.text, high.text
                ),
                "widen the range of the variable, or limit the value: LIMIT(low, value, high)",
            ));
        }
        let inside = term.low >= low.high && term.high <= high.low;
        if inside || term.text == low.text || term.text == high.text {
            self.set(id, term);
            return Ok(());
        }
        // The check is part of the rule of the table; after it the value lies in its range.
        let path = self
            .path
            .iter()
            .fold(Term::bool(true), |all, one| all.and(one));
        let path = self.named("path", whole, path, None)?;
        let kept = Term::limit(&low, &term, &high);
        self.checks.push(Check {
            path,
            value: term,
            variable: id,
        });
        let kept = self.named(&name, whole, kept, Some(text))?;
        self.set(id, kept);
        Ok(())
    }
}
