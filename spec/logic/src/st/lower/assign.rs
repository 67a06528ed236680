//! Assignments: what may be assigned, and whether the value fits.

use super::blocks::silent;
use super::declare::upper;
use super::{Check, Entry, Lowering, Role, Scope, Slot};
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{Expr, ExprKind};
use crate::st::term::{Term, Ty};

impl<'a> Lowering<'a> {
    /// `target := value;`; both sides are looked at, so that each fault is told.
    pub(super) fn assignment(
        &mut self,
        target: &'a Expr,
        value: &'a Expr,
        whole: &Span,
        scope: &Scope<'a>,
    ) -> Checked<()> {
        let hint = self.target_type(target, scope);
        let term = self.expr(value, scope, hint);
        let id = match self.target(target, scope) {
            Ok(id) => id,
            Err(fault) => {
                self.note(term);
                return Err(fault);
            }
        };
        let done = term.and_then(|term| self.assign_as(id, term, &value.span, whole));
        if done.is_err() {
            // It is assigned, if not rightly.
            let kept = (*self.value(Slot::Variable(id))).clone();
            self.set(id, kept);
        }
        done
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

    pub(super) fn free_of_loops(&self, id: usize, span: &Span) -> Checked<()> {
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
        let kept = self.site.is_some() || variable.role == Role::Standard;
        let bounds = variable.bounds.clone().filter(|_| !kept);
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
