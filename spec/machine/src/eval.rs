//! Evaluates the expressions of a family's data over the values of an axis, in 64-bit base units.

use std::collections::BTreeMap;

use stillpoint_lang::syntax::ast::{BinaryOp, Expr, Kind, UnaryOp};

/// Values by name: one cell for a scalar, several for an array. `BOOL` is 0 or 1.
pub type Values = BTreeMap<String, Vec<i64>>;

/// Evaluates `expr`; `TIME` literals are microseconds, `CYCLES(t)` is `t` in whole cycles of `cycle` microseconds, rounded up.
///
/// # Errors
/// A text that names an unknown value, an index outside an array, a construct that has no meaning here, or an overflow.
pub fn eval(expr: &Expr, values: &Values, cycle: i64) -> Result<i64, String> {
    Evaluator { values, cycle }.value(expr)
}

/// The name under which the values say whether the machine file gives a parameter: what `GIVEN(parameter)` reads.
pub fn given(parameter: &str) -> String {
    format!("GIVEN({parameter})")
}

/// Calls `visit` with each name that `expr` reads, in order.
pub fn names<'a>(expr: &'a Expr, visit: &mut dyn FnMut(&'a str)) {
    walk(expr, &|_| None, visit);
}

/// Calls `visit` with each name that decides the value of `expr` with these values, in order: of `SEL` what it selects only.
pub fn deciding<'a>(expr: &'a Expr, values: &Values, cycle: i64, visit: &mut dyn FnMut(&'a str)) {
    walk(expr, &|g| eval(g, values, cycle).ok(), visit);
}

/// Visits the names of an expression; of `SEL` only what it selects where `known` tells the value of its condition.
fn walk<'a>(
    expr: &'a Expr,
    known: &dyn Fn(&'a Expr) -> Option<i64>,
    visit: &mut dyn FnMut(&'a str),
) {
    let mut within = |e: &'a Expr| walk(e, known, visit);
    match &expr.kind {
        Kind::Name(name) => visit(name),
        Kind::Call(name, args) => match (name.as_str(), args.as_slice()) {
            ("SEL", [g, a, b]) => {
                within(g);
                match known(g) {
                    Some(0) => within(a),
                    Some(_) => within(b),
                    None => [a, b].into_iter().for_each(within),
                }
            }
            _ => args.iter().for_each(within),
        },
        Kind::Index(a, b) | Kind::Binary(_, a, b) => {
            within(a);
            within(b);
        }
        Kind::Unary(_, a) | Kind::Member(a, _) | Kind::Quantified(_, _, _, a) => within(a),
        Kind::Int(_) | Kind::Bool(_) | Kind::Time(_) | Kind::Qualified(_, _) => {}
    }
}

struct Evaluator<'a> {
    values: &'a Values,
    cycle: i64,
}

impl Evaluator<'_> {
    fn value(&self, expr: &Expr) -> Result<i64, String> {
        match &expr.kind {
            Kind::Int(n) => Ok(*n),
            Kind::Bool(b) => Ok(i64::from(*b)),
            Kind::Time(us) => i64::try_from(*us).map_err(|_| "the time is too long".to_owned()),
            Kind::Name(name) => match self.cells(name)? {
                [one] => Ok(*one),
                many => Err(format!("'{name}' has {} values: write {name}[0]", many.len())),
            },
            Kind::Index(base, index) => self.element(base, index),
            Kind::Unary(UnaryOp::Not, a) => Ok(i64::from(self.value(a)? == 0)),
            Kind::Unary(UnaryOp::Neg, a) => self.value(a)?.checked_neg().ok_or_else(overflow),
            Kind::Binary(op, a, b) => self.binary(*op, a, b),
            Kind::Call(name, args) => self.call(name, args),
            Kind::Qualified(_, _) | Kind::Member(_, _) | Kind::Quantified(_, _, _, _) => Err(
                "only the values of the machine file can be used here, without '.', '#' and quantifiers"
                    .to_owned(),
            ),
        }
    }

    fn cells(&self, name: &str) -> Result<&[i64], String> {
        self.values
            .get(name)
            .map(Vec::as_slice)
            .ok_or_else(|| format!("unknown name '{name}'"))
    }

    fn element(&self, base: &Expr, index: &Expr) -> Result<i64, String> {
        let Kind::Name(name) = &base.kind else {
            return Err("only a named array can be indexed".to_owned());
        };
        let (cells, k) = (self.cells(name)?, self.value(index)?);
        usize::try_from(k)
            .ok()
            .and_then(|k| cells.get(k).copied())
            .ok_or_else(|| {
                format!(
                    "'{name}[{k}]' does not exist: it has {} values, the first has the index 0",
                    cells.len()
                )
            })
    }

    fn binary(&self, op: BinaryOp, a: &Expr, b: &Expr) -> Result<i64, String> {
        let a = self.value(a)?;
        match (op, a != 0) {
            (BinaryOp::And, false) => return Ok(0),
            (BinaryOp::Or, true) => return Ok(1),
            _ => {}
        }
        let b = self.value(b)?;
        let truth = |t: bool| Ok(i64::from(t));
        match op {
            BinaryOp::Or | BinaryOp::And => truth(b != 0),
            BinaryOp::Xor => truth((a != 0) != (b != 0)),
            BinaryOp::Eq => truth(a == b),
            BinaryOp::Ne => truth(a != b),
            BinaryOp::Lt => truth(a < b),
            BinaryOp::Gt => truth(a > b),
            BinaryOp::Le => truth(a <= b),
            BinaryOp::Ge => truth(a >= b),
            BinaryOp::Add => a.checked_add(b).ok_or_else(overflow),
            BinaryOp::Sub => a.checked_sub(b).ok_or_else(overflow),
            BinaryOp::Mul => a.checked_mul(b).ok_or_else(overflow),
            BinaryOp::Div => a.checked_div(b).ok_or_else(overflow),
            BinaryOp::Mod => a.checked_rem(b).ok_or_else(overflow),
        }
    }

    /// `MIN`, `MAX` and `SUM`; a list that is named stands for all its values, of which there may be none.
    fn over_all(&self, name: &str, args: &[Expr]) -> Result<i64, String> {
        let mut cells = Vec::new();
        for arg in args {
            match &arg.kind {
                Kind::Name(list) => cells.extend_from_slice(self.cells(list)?),
                _ => cells.push(self.value(arg)?),
            }
        }
        let mut all = cells.into_iter();
        match name {
            "MIN" => all.min().ok_or_else(nothing),
            "MAX" => all.max().ok_or_else(nothing),
            _ => all.try_fold(0_i64, i64::checked_add).ok_or_else(overflow),
        }
    }

    fn call(&self, name: &str, args: &[Expr]) -> Result<i64, String> {
        if let ("SEL", [g, a, b]) = (name, args) {
            return self.value(if self.value(g)? == 0 { a } else { b });
        }
        if let ("MIN" | "MAX" | "SUM", [_, ..]) = (name, args) {
            return self.over_all(name, args);
        }
        if let (
            "GIVEN",
            [
                Expr {
                    kind: Kind::Name(of),
                    ..
                },
            ],
        ) = (name, args)
        {
            return match self.cells(&given(of)) {
                Ok([one]) => Ok(*one),
                _ => Err(format!("nothing says whether '{of}' is given")),
            };
        }
        let args = args
            .iter()
            .map(|a| self.value(a))
            .collect::<Result<Vec<i64>, String>>()?;
        match (name, args.as_slice()) {
            ("ABS", [x]) => x.checked_abs().ok_or_else(overflow),
            ("LIMIT", [lo, x, hi]) => Ok(*x.min(hi).max(lo)),
            ("CYCLES", [t]) if *t >= 0 && self.cycle > 0 => {
                Ok(t / self.cycle + i64::from(t % self.cycle != 0))
            }
            ("CYCLES", [_]) => Err("CYCLES needs a time that is not negative".to_owned()),
            _ => Err(format!(
                "no function '{name}' with {} arguments: MIN, MAX, SUM, ABS, LIMIT, SEL and CYCLES can be used",
                args.len()
            )),
        }
    }
}

fn nothing() -> String {
    "the least or greatest of no values: name one that always exists too, as in MAX(0, list)"
        .to_owned()
}

fn overflow() -> String {
    "the result does not fit 64 bits, or a divisor is 0".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use stillpoint_lang::syntax::parse_expr;

    fn run(text: &str) -> Result<i64, String> {
        let values = Values::from([
            ("a".to_owned(), vec![7]),
            ("list".to_owned(), vec![1, 2, 3]),
            ("off".to_owned(), vec![0]),
            ("none".to_owned(), vec![]),
            (given("a"), vec![1]),
        ]);
        let expr = parse_expr(text).map_err(|e| e.message)?;
        eval(&expr, &values, 12_000)
    }

    #[test]
    fn values() {
        for (text, value) in [
            ("a + 2 * 3", 13),
            ("-a MOD 4", -3),
            ("list[2] > a OR a = 7", 1),
            ("off AND unknown", 0),
            ("NOT off XOR off", 1),
            ("SEL(off, a, unknown)", 7),
            ("MAX(list[0], list[1], 2) = MIN(2, a)", 1),
            ("CYCLES(T#100ms)", 9),
            ("CYCLES(T#96ms)", 8),
            ("CYCLES(0)", 0),
            ("LIMIT(0, a, 5)", 5),
            ("T#25ms", 25_000),
            ("SUM(list)", 6),
            ("SUM(none)", 0),
            ("MAX(list, a) + MIN(list)", 8),
            ("MAX(0, none)", 0),
            ("GIVEN(a) AND NOT off", 1),
        ] {
            assert_eq!(run(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn faults_are_errors() {
        for text in [
            "unknown",
            "list",
            "list[3]",
            "none[0]",
            "MAX(none)",
            "list[-1]",
            "a / off",
            "9223372036854775807 + a",
            "CYCLES(-1)",
            "NONSENSE(1)",
            "GIVEN(off)",
            "GIVEN(1)",
            "x.y",
        ] {
            assert!(run(text).is_err(), "{text}");
        }
    }
}
