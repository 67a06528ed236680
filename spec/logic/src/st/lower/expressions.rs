//! Expressions: types, ranges, and their text in the language of the tables.

use super::declare::upper;
use super::{Entry, Lowering, Scope, Slot};
use crate::fault::{Checked, Fault, Span};
use crate::st::ast::{BinaryOp, Expr, ExprKind, Language, UnaryOp, Word};
use crate::st::lower::blocks::silent;
use crate::st::term::{Term, Ty, Use};
use stillpoint_lang::diag::nearest;

/// The name of the time between two runs of the program.
const CYCLE: &str = "CYCLE";

impl<'a> Lowering<'a> {
    /// An expression; `hint` is the type that a bare enum value would get.
    pub(super) fn expr(
        &mut self,
        e: &'a Expr,
        scope: &Scope<'a>,
        hint: Option<Ty>,
    ) -> Checked<Term> {
        match &e.kind {
            ExprKind::Call(name, args) => self.call_function(name, args, e, scope, hint),
            ExprKind::Unary(UnaryOp::Not, inner) => Ok(self.typed(inner, scope, Ty::Bool)?.not()),
            ExprKind::Unary(UnaryOp::Neg, inner) => {
                let term = self.expr(inner, scope, hint)?;
                self.negative(&term, e)
            }
            ExprKind::Binary(op, a, b) => self.binary(*op, a, b, e, scope),
            ExprKind::Typed(of, inner) if self.signature.enum_named(&of.text).is_none() => {
                self.typed_literal(of, inner, scope)
            }
            _ => self.plain(e, scope, hint),
        }
    }

    /// A literal, a name, or a member.
    fn plain(&mut self, e: &Expr, scope: &Scope<'a>, hint: Option<Ty>) -> Checked<Term> {
        match &e.kind {
            ExprKind::Bool(value) => Ok(Term::bool(*value)),
            ExprKind::Int(value) => Ok(Term::number(*value, Ty::Int)),
            ExprKind::Time(us) => Ok(self.duration(*us)),
            ExprKind::Name(name) => self.name(name, &e.span, scope, hint),
            ExprKind::Member(base, member) => {
                let entry = self.member(base, member, scope)?;
                self.entry(&entry, &e.span)
            }
            ExprKind::Typed(of, inner) => self.enum_value(of, inner),
            _ => Err(Fault::new(
                &e.span,
                "a constant is needed here",
                "write a literal or the name of a CONSTANT",
            )),
        }
    }

    /// An expression of literals, constants and parameters, of one type.
    pub(super) fn fixed(
        &mut self,
        e: &Expr,
        scope: &Scope<'a>,
        want: Ty,
        what: &str,
    ) -> Checked<Term> {
        let term = match &e.kind {
            ExprKind::Unary(UnaryOp::Not, inner) => self.fixed(inner, scope, Ty::Bool, what)?.not(),
            ExprKind::Unary(UnaryOp::Neg, inner) => {
                let term = self.fixed(inner, scope, want, what)?;
                self.negative(&term, e)?
            }
            ExprKind::Binary(op, a, b) if want == Ty::Int || want == Ty::Time => {
                let right = match (op, want) {
                    (BinaryOp::Mul | BinaryOp::Div, Ty::Time) => Ty::Int,
                    _ => want,
                };
                let (x, y) = (
                    self.fixed(a, scope, want, what)?,
                    self.fixed(b, scope, right, what)?,
                );
                self.combine(*op, &x, &y, e, b)?
            }
            _ => self.plain(e, scope, Some(want))?,
        };
        if !term.fixed {
            return Err(Fault::new(
                &e.span,
                format!("{what} has to be constant"),
                "use literals, CONSTANTs of the program and parameters of the family",
            ));
        }
        match term.ty == want {
            true => Ok(term),
            false => Err(self.wrong_type(want, &term, &e.span)),
        }
    }

    /// An expression of one type.
    pub(super) fn typed(&mut self, e: &'a Expr, scope: &Scope<'a>, want: Ty) -> Checked<Term> {
        let term = self.expr(e, scope, Some(want))?;
        match term.ty == want {
            true => Ok(term),
            false => Err(self.wrong_type(want, &term, &e.span)),
        }
    }

    pub(super) fn wrong_type(&self, want: Ty, term: &Term, span: &Span) -> Fault {
        let (want_name, is) = (self.signature.name(want), self.signature.name(term.ty));
        let help = match (want, term.ty) {
            (Ty::Bool, Ty::Int) => {
                "compare it, as in `x <> 0`; TRUE and FALSE are no numbers".to_owned()
            }
            (Ty::Bool, _) => "compare it, as in `x = value`".to_owned(),
            (Ty::Int, Ty::Bool) => "write SEL(condition, 0, 1)".to_owned(),
            (Ty::Time, Ty::Int) => "write the number as a time, such as T#100ms".to_owned(),
            (Ty::Enum(of), _) => format!(
                "its values are {}",
                self.signature.enums[of].values.join(", ")
            ),
            _ => format!("use a value of type {want_name}"),
        };
        Fault::new(
            span,
            format!("a value of type {want_name} is needed, this is {is}"),
            help,
        )
        .label(format!("is {is}"))
    }

    /// A literal time: whole cycles, rounded up where the table is bound to a cycle.
    fn duration(&mut self, us: u64) -> Term {
        if us == 0 {
            return Term::number(0, Ty::Time);
        }
        let name = match self.durations.get(&us) {
            Some(name) => name.clone(),
            None => {
                let long = |us: u64| match us {
                    _ if us % 1_000_000 == 0 => format!("{}s", us / 1_000_000),
                    _ if us % 1_000 == 0 => format!("{}ms", us / 1_000),
                    _ => format!("{us}us"),
                };
                let base = match self.tree.language {
                    Language::StructuredText => format!("st_{}", long(us)),
                    // Times are whole microseconds: one more than a limit is the first time above it.
                    Language::SafeLogic if us % 1_000 == 1 => format!("spf_over_{}", long(us - 1)),
                    Language::SafeLogic => format!("spf_{}", long(us)),
                    Language::StatementList => format!("stl_{}", long(us)),
                };
                let name = self.fresh(&base);
                self.durations.insert(us, name.clone());
                name
            }
        };
        let mut term =
            Term::leaf(name, Ty::Time, 0, super::emit::most_cycles(us)).reading(Use::Duration(us));
        term.fixed = true;
        term
    }

    fn name(
        &mut self,
        name: &str,
        span: &Span,
        scope: &Scope<'a>,
        hint: Option<Ty>,
    ) -> Checked<Term> {
        if let Some(entry) = scope.names.get(&upper(name)) {
            return self.entry(entry, span);
        }
        if let Some(port) = self
            .signature
            .params
            .iter()
            .find(|p| p.name.eq_ignore_ascii_case(name))
        {
            return Ok(port.term(true));
        }
        if name.eq_ignore_ascii_case(CYCLE) {
            return Ok(Term::number(1, Ty::Time));
        }
        if let Some(Ty::Enum(of)) = hint {
            if let Some(value) = self.signature.value(of, name) {
                return Ok(value);
            }
        }
        let enums = 0..self.signature.enums.len();
        let mut found: Vec<Term> = enums
            .filter_map(|of| self.signature.value(of, name))
            .collect();
        match (found.pop(), found.pop()) {
            (Some(one), None) => Ok(one),
            (Some(a), Some(b)) => Err(Fault::new(
                span,
                format!("'{name}' is a value of more than one enum"),
                format!("write {} or {}", b.text, a.text),
            )),
            (None, _) => Err(self.unknown(name, span, scope)),
        }
    }

    fn entry(&self, entry: &Entry<'a>, span: &Span) -> Checked<Term> {
        match entry {
            Entry::Input(term) | Entry::Constant(term) => Ok(term.clone()),
            Entry::Variable(id) => Ok((*self.value(Slot::Variable(*id))).clone()),
            Entry::Failed => Err(silent(span)),
            Entry::Block(instance) => Err(Fault::new(
                span,
                format!("'{}' is a function block, not a value", instance.name),
                "name one of its outputs, as in `t1.Q`",
            )),
        }
    }

    /// `Som#SOM_1`
    fn enum_value(&self, of: &Word, inner: &Expr) -> Checked<Term> {
        let Some(k) = self.signature.enum_named(&of.text) else {
            return Err(self.no_enum(of));
        };
        if let ExprKind::Name(name) = &inner.kind {
            if let Some(value) = self.signature.value(k, name) {
                return Ok(value);
            }
        }
        let values = &self.signature.enums[k].values;
        Err(Fault::new(
            &inner.span,
            format!("{} has no such value", of.text),
            format!("its values are {}", values.join(", ")),
        ))
    }

    fn no_enum(&self, of: &Word) -> Fault {
        let known = self.signature.enums.iter().map(|e| e.name.as_str());
        let help = match nearest(&of.text, known) {
            Some(near) => format!("did you mean '{near}'?"),
            None => "before `#` stands an enum, a type of the standard, or T for a time".to_owned(),
        };
        Fault::new(&of.span, format!("there is no type '{}'", of.text), help)
    }

    /// `INT#5`, `BOOL#1`
    fn typed_literal(&mut self, of: &Word, inner: &Expr, scope: &Scope<'a>) -> Checked<Term> {
        match (upper(&of.text).as_str(), &inner.kind) {
            ("BOOL", ExprKind::Int(value @ (0 | 1))) => Ok(Term::bool(*value == 1)),
            ("BOOL", ExprKind::Bool(value)) => Ok(Term::bool(*value)),
            (name, ExprKind::Int(_) | ExprKind::Unary(..)) if name.ends_with("INT") => {
                self.fixed(inner, scope, Ty::Int, "a literal")
            }
            _ => Err(self.no_enum(of)),
        }
    }

    fn negative(&self, term: &Term, e: &Expr) -> Checked<Term> {
        match (term.ty, term.constant()) {
            (Ty::Int, Some(value)) => Ok(Term::number(-value, Ty::Int)),
            (Ty::Int | Ty::Time, _) => {
                let zero = Term::number(0, term.ty);
                zero.infix("-", 5, term, term.ty, (-term.high, -term.low))
                    .held(&e.span)
            }
            _ => Err(self.wrong_type(Ty::Int, term, &e.span)),
        }
    }

    fn binary(
        &mut self,
        op: BinaryOp,
        a: &'a Expr,
        b: &'a Expr,
        e: &'a Expr,
        scope: &Scope<'a>,
    ) -> Checked<Term> {
        match op {
            BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => {
                let x = self.typed(a, scope, Ty::Bool);
                let y = self.typed(b, scope, Ty::Bool);
                let (x, y) = match (x, y) {
                    (Ok(x), Ok(y)) => (x, y),
                    (Err(x), Err(y)) => {
                        self.fault(x);
                        return Err(y);
                    }
                    (Err(fault), _) | (_, Err(fault)) => return Err(fault),
                };
                Ok(match op {
                    BinaryOp::And => x.and(&y),
                    BinaryOp::Or => x.or(&y),
                    _ => match (x.constant(), y.constant()) {
                        (Some(x), Some(y)) => Term::bool(x != y),
                        _ => x.infix("XOR", 1, &y, Ty::Bool, (0, 1)),
                    },
                })
            }
            _ => {
                let (x, y) = self.pair(a, b, scope)?;
                self.combine(op, &x, &y, e, b)
            }
        }
    }

    /// Two operands; a bare enum value takes the type of the other one.
    fn pair(&mut self, a: &'a Expr, b: &'a Expr, scope: &Scope<'a>) -> Checked<(Term, Term)> {
        match self.expr(a, scope, None) {
            Ok(x) => {
                let y = self.expr(b, scope, Some(x.ty))?;
                Ok((x, y))
            }
            // A bare name may become clear by the other side; a whole expression is looked at once.
            Err(first) if !matches!(a.kind, ExprKind::Name(_)) => Err(first),
            Err(first) => {
                let Ok(y) = self.expr(b, scope, None) else {
                    return Err(first);
                };
                let x = self.expr(a, scope, Some(y.ty))?;
                Ok((x, y))
            }
        }
    }

    /// Comparisons and arithmetic.
    fn combine(&self, op: BinaryOp, x: &Term, y: &Term, e: &Expr, right: &Expr) -> Checked<Term> {
        use BinaryOp::{Add, Div, Eq, Ge, Gt, Le, Lt, Mod, Mul, Ne, Sub};
        let names = || (self.signature.name(x.ty), self.signature.name(y.ty));
        if matches!(op, Eq | Ne | Lt | Le | Gt | Ge) {
            if x.ty != y.ty {
                let (a, b) = names();
                return Err(Fault::new(
                    &e.span,
                    format!("{a} and {b} cannot be compared"),
                    "compare values of one type",
                ));
            }
            if x.ty == Ty::Bool && !matches!(op, Eq | Ne) {
                return Err(Fault::new(
                    &e.span,
                    "truth values have no order",
                    "use = or <>",
                ));
            }
            return Ok(self.compare(op.symbol(), x, y));
        }
        let ty = match (op, x.ty, y.ty) {
            (Add | Sub | Mul | Div | Mod, Ty::Int, Ty::Int) => Ty::Int,
            (Add | Sub, Ty::Time, Ty::Time) | (Mul | Div, Ty::Time, Ty::Int) => Ty::Time,
            _ => {
                let (a, b) = names();
                return Err(Fault::new(
                    &e.span,
                    format!("{a} {} {b} has no meaning", op.symbol()),
                    "numbers are added, subtracted, multiplied and divided; times are added, subtracted, and multiplied \
                     or divided by a number",
                ));
            }
        };
        if matches!(op, Div | Mod) && y.low <= 0 && y.high >= 0 {
            return Err(Fault::new(
                &right.span,
                format!("the divisor can be 0: it is {}..{}", y.low, y.high),
                "write MAX(x, 1), or declare the variable with a range without 0",
            )
            .label("can be 0"));
        }
        let range = arithmetic(op, (x.low, x.high), (y.low, y.high));
        if let (Some(_), Some(_)) = (x.constant(), y.constant()) {
            if range.0 == range.1 {
                return Term::number(range.0, ty).held(&e.span);
            }
        }
        let strength = if matches!(op, Add | Sub) { 5 } else { 6 };
        x.infix(op.symbol(), strength, y, ty, range).held(&e.span)
    }

    /// `a op b` of two values of one type.
    pub(super) fn compare(&self, op: &str, x: &Term, y: &Term) -> Term {
        if let (Some(a), Some(b)) = (x.constant(), y.constant()) {
            return Term::bool(match op {
                "=" => a == b,
                "<>" => a != b,
                "<" => a < b,
                "<=" => a <= b,
                ">" => a > b,
                _ => a >= b,
            });
        }
        let strength = if matches!(op, "=" | "<>") { 3 } else { 4 };
        x.infix(op, strength, y, Ty::Bool, (0, 1))
    }
}

/// The range of a result, as wide as the tables take it.
fn arithmetic(op: BinaryOp, x: (i64, i64), y: (i64, i64)) -> (i64, i64) {
    let corners = |f: &dyn Fn(i64, i64) -> i64| {
        let all = [f(x.0, y.0), f(x.0, y.1), f(x.1, y.0), f(x.1, y.1)];
        let least = all.iter().copied().min().unwrap_or(0);
        (least, all.iter().copied().max().unwrap_or(0))
    };
    match op {
        BinaryOp::Add => corners(&|a, b| a + b),
        BinaryOp::Sub => corners(&|a, b| a - b),
        BinaryOp::Mul => corners(&|a, b| a * b),
        BinaryOp::Div => {
            let most = x.0.abs().max(x.1.abs());
            match y {
                (d, e) if d == e && d != 0 && x.0 == x.1 => (x.0 / d, x.0 / d),
                (d, e) if d == e && d > 0 => (x.0 / d, x.1 / d),
                (d, _) if d > 0 => (x.0.min(0), x.1.max(0)),
                _ => (-most, most),
            }
        }
        _ => {
            if x.0 == x.1 && y.0 == y.1 && y.0 != 0 {
                return (x.0 % y.0, x.0 % y.0);
            }
            let most = (y.0.abs().max(y.1.abs()) - 1).max(0);
            let low = if x.0 < 0 { (-most).max(x.0) } else { 0 };
            (low, if x.1 > 0 { most.min(x.1) } else { 0 })
        }
    }
}
