//! Functions: those of the standard, and those of the program.

use std::collections::BTreeMap;

use super::declare::{Body, Shape, upper};
use super::{Entry, Lowering, MAX_NESTING, Role, Scope, Slot, Variable};
use crate::fault::{Checked, Fault};
use crate::st::ast::{Arg, Expr, ExprKind, Pou, SectionKind, Word};
use crate::st::lower::blocks::{silent, too_deep};
use crate::st::term::{Term, Ty};
use stillpoint_lang::diag::nearest;

/// Standard functions, with what they take.
const FUNCTIONS: [(&str, &str); 6] = [
    ("SEL", "SEL(condition, value if FALSE, value if TRUE)"),
    ("MUX", "MUX(number from 0, value 0, value 1, ...)"),
    ("MIN", "MIN(a, b, ...)"),
    ("MAX", "MAX(a, b, ...)"),
    ("LIMIT", "LIMIT(least, value, greatest)"),
    ("ABS", "ABS(number)"),
];

impl<'a> Lowering<'a> {
    pub(super) fn call_function(
        &mut self,
        name: &Word,
        args: &'a [Arg],
        e: &'a Expr,
        scope: &Scope<'a>,
        hint: Option<Ty>,
    ) -> Checked<Term> {
        let tree = self.tree;
        if let Some(own) = tree
            .functions
            .iter()
            .find(|f| f.name.text.eq_ignore_ascii_case(&name.text))
        {
            return self.own_function(own, args, e, scope);
        }
        let key = upper(&name.text);
        let Some((key, usage)) = FUNCTIONS.iter().find(|(known, _)| *known == key) else {
            return Err(self.no_function(name, scope));
        };
        let fits = match *key {
            "ABS" => args.len() == 1,
            "SEL" | "LIMIT" => args.len() == 3,
            "MUX" => args.len() >= 3,
            _ => args.len() >= 2,
        };
        if !fits {
            return Err(Fault::new(
                &e.span,
                format!("{key} has {} values here", args.len()),
                format!("write {usage}"),
            ));
        }
        if let Some(named) = args.iter().find_map(|a| a.name.as_ref()) {
            return Err(Fault::new(
                &named.span,
                format!("values of {key} are given in their order"),
                format!("write {usage}"),
            ));
        }
        let values: Vec<&'a Expr> = args.iter().map(|a| &a.value).collect();
        match *key {
            "SEL" => {
                let guard = self.typed(values[0], scope, Ty::Bool)?;
                let values = self.alike(&values[1..], scope, hint)?;
                Ok(Term::select(&guard, &values[0], &values[1]))
            }
            "MUX" => {
                let number = self.typed(values[0], scope, Ty::Int)?;
                let rest = self.alike(&values[1..], scope, hint)?;
                if number.low < 0 || number.high >= rest.len() as i64 {
                    return Err(Fault::new(
                        &values[0].span,
                        format!(
                            "the number can be {}..{}, and there are {} values from 0",
                            number.low,
                            number.high,
                            rest.len()
                        ),
                        "narrow the range of the number, or use LIMIT",
                    ));
                }
                let range = (
                    rest.iter().map(|t| t.low).min(),
                    rest.iter().map(|t| t.high).max(),
                );
                let parts: Vec<&Term> = std::iter::once(&number).chain(&rest).collect();
                Ok(Term::call(
                    "MUX",
                    &parts,
                    rest[0].ty,
                    (range.0.unwrap_or(0), range.1.unwrap_or(0)),
                ))
            }
            "ABS" => {
                let term = self.typed(values[0], scope, Ty::Int)?;
                let most = term.high.max(-term.low);
                let least = if term.low >= 0 {
                    term.low
                } else {
                    (-term.high).max(0)
                };
                Ok(Term::call("ABS", &[&term], Ty::Int, (least, most)))
            }
            _ => {
                let terms = self.alike(&values, scope, hint)?;
                if terms[0].ty == Ty::Bool {
                    return Err(Fault::new(
                        &e.span,
                        "truth values have no order",
                        "use AND, OR or SEL",
                    ));
                }
                Ok(ordered(key, &terms))
            }
        }
    }

    /// Values of one type; the first that has one of its own gives it to bare enum values.
    fn alike(
        &mut self,
        values: &[&'a Expr],
        scope: &Scope<'a>,
        hint: Option<Ty>,
    ) -> Checked<Vec<Term>> {
        let mut ty = hint.filter(|t| matches!(t, Ty::Enum(_)));
        let mut known: Vec<Option<Term>> = vec![None; values.len()];
        for (value, known) in values.iter().zip(&mut known) {
            if ty.is_some() {
                break;
            }
            match self.expr(value, scope, None) {
                Ok(term) => ty = Some(known.insert(term).ty),
                // A bare name may become clear by the others; a whole expression is looked at once.
                Err(_) if matches!(value.kind, ExprKind::Name(_)) => {}
                Err(fault) => return Err(fault),
            }
        }
        let mut terms: Vec<Term> = Vec::new();
        for (value, known) in values.iter().zip(known) {
            let term = match known {
                Some(term) => term,
                None => self.expr(value, scope, ty)?,
            };
            let want = *ty.get_or_insert(term.ty);
            if term.ty != want {
                return Err(self.wrong_type(want, &term, &value.span));
            }
            terms.push(term);
        }
        Ok(terms)
    }

    fn no_function(&self, name: &Word, scope: &Scope<'a>) -> Fault {
        if matches!(scope.names.get(&upper(&name.text)), Some(Entry::Block(_))) {
            return Fault::new(
                &name.span,
                format!(
                    "'{}' is a function block: its call is a statement",
                    name.text
                ),
                format!(
                    "call it before, `{0}(IN := x);`, and use its output, `{0}.Q`",
                    name.text
                ),
            );
        }
        let own = self.tree.functions.iter().map(|f| f.name.text.as_str());
        let known = FUNCTIONS.iter().map(|(name, _)| *name).chain(own);
        let help = match nearest(&name.text, known.clone()) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("functions are {}", known.collect::<Vec<_>>().join(", ")),
        };
        Fault::new(
            &name.span,
            format!("there is no function '{}'", name.text),
            help,
        )
    }

    /// A function of the program: its body is run here, with variables of its own.
    fn own_function(
        &mut self,
        own: &'a Pou,
        args: &'a [Arg],
        e: &'a Expr,
        scope: &Scope<'a>,
    ) -> Checked<Term> {
        let key = upper(&own.name.text);
        if self.nesting.contains(&key) {
            return Err(Fault::new(
                &e.span,
                format!("the function '{}' calls itself", own.name.text),
                "a cycle of the safe PLC has to end: use FOR",
            ));
        }
        if self.nesting.len() >= MAX_NESTING {
            return Err(too_deep(&e.span));
        }
        self.works(&e.span)?;
        let inputs: Vec<&Word> = (own.sections.iter())
            .filter(|s| s.kind == SectionKind::Input)
            .flat_map(|s| s.variables.iter().map(|v| &v.name))
            .collect();
        let mut inner = self.declare(
            own,
            Body::Function,
            format!("{}.", own.name.text),
            &BTreeMap::new(),
        );
        let result = self.result(own, &inner)?;
        inner.names.insert(key.clone(), Entry::Variable(result));
        let usage = || {
            let list: Vec<&str> = inputs.iter().map(|w| w.text.as_str()).collect();
            format!("write {}({})", own.name.text, list.join(", "))
        };
        let mut given = Vec::new();
        for (k, arg) in args.iter().enumerate() {
            let input = match &arg.name {
                Some(name) => inputs
                    .iter()
                    .find(|i| i.text.eq_ignore_ascii_case(&name.text)),
                None => inputs.get(k),
            };
            let Some(input) = input.filter(|_| !arg.out) else {
                let span = arg.name.as_ref().map_or(&arg.value.span, |n| &n.span);
                return Err(Fault::new(
                    span,
                    format!("'{}' takes no such value", own.name.text),
                    usage(),
                ));
            };
            let Some(Entry::Variable(id)) = inner.names.get(&upper(&input.text)) else {
                return Err(silent(&e.span));
            };
            let id = *id;
            let term = self.expr(&arg.value, scope, Some(self.variables[id].ty))?;
            given.push((id, term, &arg.value.span));
        }
        let mut ids: Vec<usize> = given.iter().map(|(id, ..)| *id).collect();
        ids.sort_unstable();
        ids.dedup();
        if ids.len() != inputs.len() || given.len() != ids.len() {
            return Err(Fault::new(
                &e.span,
                format!(
                    "'{}' takes {} values, each once",
                    own.name.text,
                    inputs.len()
                ),
                usage(),
            ));
        }
        self.nesting.push(key);
        self.set(result, self.variables[result].init.clone());
        let failed = self.run_function(own, &inner, given);
        self.nesting.pop();
        failed?;
        Ok((*self.value(Slot::Variable(result))).clone())
    }

    fn run_function(
        &mut self,
        own: &'a Pou,
        inner: &Scope<'a>,
        given: Vec<(usize, Term, &crate::fault::Span)>,
    ) -> Checked<()> {
        // The values come after the initial ones, which `run_body` sets.
        let outer = self.env.remove(&Slot::Return);
        let exit = self.env.remove(&Slot::Exit);
        let loops = std::mem::take(&mut self.loops);
        self.begin_temps(inner);
        let assigned = given
            .into_iter()
            .try_for_each(|(id, term, span)| self.assign(id, term, span));
        if assigned.is_ok() {
            self.body(&own.body, inner);
        }
        self.loops = loops;
        for (slot, value) in [(Slot::Return, outer), (Slot::Exit, exit)] {
            match value {
                Some(value) => self.env.insert(slot, value),
                None => self.env.remove(&slot),
            };
        }
        assigned
    }

    /// The variable of a function's name, which it returns.
    fn result(&mut self, own: &'a Pou, inner: &Scope<'a>) -> Checked<usize> {
        let Some(ty) = &own.result else {
            return Err(silent(&own.name.span));
        };
        let Shape::Value(ty, bounds) = self.shape(ty, inner)? else {
            return Err(Fault::new(
                &ty.span,
                "a function returns a value",
                "give it the type BOOL, INT, TIME or an enum",
            ));
        };
        let init = match ty {
            Ty::Bool => Term::bool(false),
            Ty::Enum(of) => {
                let first = self.signature.enums[of].values.first();
                let value = first.and_then(|name| self.signature.value(of, name));
                value.unwrap_or_else(|| Term::number(0, ty))
            }
            Ty::Int | Ty::Time => bounds
                .as_ref()
                .map_or_else(|| Term::number(0, ty), |(low, _)| low.clone()),
        };
        let table = self.fresh(&own.name.text);
        self.variables.push(Variable {
            name: own.name.text.clone(),
            table,
            ty,
            bounds,
            init,
            role: Role::Temp,
            span: own.name.span.clone(),
        });
        Ok(self.variables.len() - 1)
    }
}

/// MIN, MAX, LIMIT with the ranges that the tables compute.
fn ordered(key: &str, terms: &[Term]) -> Term {
    if let ("LIMIT", [low, value, high]) = (key, terms) {
        return Term::limit(low, value, high);
    }
    let lows = terms.iter().map(|t| t.low);
    let highs = terms.iter().map(|t| t.high);
    let range = match key {
        "MIN" => (lows.min(), highs.min()),
        _ => (lows.max(), highs.max()),
    };
    let parts: Vec<&Term> = terms.iter().collect();
    Term::call(
        key,
        &parts,
        terms[0].ty,
        (range.0.unwrap_or(0), range.1.unwrap_or(0)),
    )
}
