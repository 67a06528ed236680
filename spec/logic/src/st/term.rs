//! Values as expressions of the tables: text, type, range, and what they read.

use crate::fault::{Checked, Fault, Span};

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ty {
    Bool,
    Int,
    /// In cycles.
    Time,
    /// Index into the enums of the signature.
    Enum(usize),
}

/// What a value reads, as far as it has to be declared in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Use {
    /// A named expression.
    Let(usize),
    /// The value that a variable has from the cycle before.
    State(usize),
    /// A duration in microseconds.
    Duration(u64),
    /// An input: index into those of the signature.
    Input(usize),
}

/// An expression of the tables that a program has computed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Term {
    pub text: String,
    /// How strongly it binds, [`ATOM`] for what needs no brackets anywhere.
    strength: u8,
    pub ty: Ty,
    /// The values it can have at all, as the tables compute them.
    pub low: i64,
    pub high: i64,
    /// Whether it is the same in each cycle of a run: made of literals and parameters.
    pub fixed: bool,
    /// Whether the value is `low` itself.
    known: bool,
    pub uses: Vec<Use>,
}

/// Names, literals, calls.
const ATOM: u8 = 9;

/// What a cell of the tables holds.
const CELL: i64 = i32::MAX as i64;

impl Term {
    /// A name or call of the tables.
    pub fn leaf(text: String, ty: Ty, low: i64, high: i64) -> Self {
        Self {
            text,
            strength: ATOM,
            ty,
            low,
            high,
            fixed: false,
            known: false,
            uses: Vec::new(),
        }
    }

    pub fn reading(mut self, what: Use) -> Self {
        self.uses = vec![what];
        self
    }

    /// The same as a literal: its range is one value.
    pub fn known(mut self) -> Self {
        self.known = true;
        self.fixed = true;
        self
    }

    pub fn bool(value: bool) -> Self {
        let text = if value { "TRUE" } else { "FALSE" };
        Self::leaf(
            text.to_owned(),
            Ty::Bool,
            i64::from(value),
            i64::from(value),
        )
        .known()
    }

    /// A number, or cycles of time.
    pub fn number(value: i64, ty: Ty) -> Self {
        let text = match value < 0 {
            true => format!("({value})"),
            false => value.to_string(),
        };
        Self::leaf(text, ty, value, value).known()
    }

    /// Its value, where that is a literal.
    pub fn constant(&self) -> Option<i64> {
        self.known.then_some(self.low)
    }

    pub fn is(&self, value: bool) -> bool {
        self.ty == Ty::Bool && self.constant() == Some(i64::from(value))
    }

    /// Whether it needs no name of its own to be written more than once.
    pub fn is_atom(&self) -> bool {
        self.strength == ATOM && (self.known || !self.text.contains('('))
    }

    /// The text with brackets, where an operator of this strength needs them.
    fn within(&self, strength: u8) -> String {
        match self.strength >= strength {
            true => self.text.clone(),
            false => format!("({})", self.text),
        }
    }

    fn made(text: String, strength: u8, ty: Ty, (low, high): (i64, i64), parts: &[&Term]) -> Self {
        let mut uses: Vec<Use> = parts.iter().flat_map(|p| p.uses.iter().copied()).collect();
        uses.sort_unstable();
        uses.dedup();
        Self {
            text,
            strength,
            ty,
            low,
            high,
            fixed: parts.iter().all(|p| p.fixed),
            known: false,
            uses,
        }
    }

    /// `NOT a`
    pub fn not(&self) -> Self {
        match self.constant() {
            Some(value) => Self::bool(value == 0),
            None => match self.text.strip_prefix("NOT ") {
                Some(inner) if self.strength == 8 => {
                    Self::made(inner.to_owned(), ATOM, Ty::Bool, (0, 1), &[self])
                }
                _ => Self::made(
                    format!("NOT {}", self.within(ATOM)),
                    8,
                    Ty::Bool,
                    (0, 1),
                    &[self],
                ),
            },
        }
    }

    /// `a AND b`
    pub fn and(&self, other: &Self) -> Self {
        match (self.constant(), other.constant()) {
            (Some(0), _) | (_, Some(1)) => self.clone(),
            (Some(_), _) | (_, Some(_)) => other.clone(),
            _ => self.infix("AND", 2, other, Ty::Bool, (0, 1)),
        }
    }

    /// `a OR b`
    pub fn or(&self, other: &Self) -> Self {
        match (self.constant(), other.constant()) {
            (Some(0), _) | (_, Some(1)) => other.clone(),
            (Some(_), _) | (_, Some(_)) => self.clone(),
            _ => self.infix("OR", 1, other, Ty::Bool, (0, 1)),
        }
    }

    /// `a op b` with the operator's strength in the tables, whose operators group to the left.
    pub fn infix(&self, op: &str, strength: u8, other: &Self, ty: Ty, range: (i64, i64)) -> Self {
        let text = format!(
            "{} {op} {}",
            self.within(strength),
            other.within(strength + 1)
        );
        Self::made(text, strength, ty, range, &[self, other])
    }

    /// `NAME(a, b)`
    pub fn call(name: &str, parts: &[&Term], ty: Ty, range: (i64, i64)) -> Self {
        let list: Vec<&str> = parts.iter().map(|p| p.text.as_str()).collect();
        Self::made(
            format!("{name}({})", list.join(", ")),
            ATOM,
            ty,
            range,
            parts,
        )
    }

    /// `SEL(g, a, b)`: a where g is FALSE.
    pub fn select(guard: &Term, no: &Term, yes: &Term) -> Self {
        match guard.constant() {
            Some(0) => return no.clone(),
            Some(_) => return yes.clone(),
            None if no == yes => return no.clone(),
            None if no.is(false) && yes.is(true) => return guard.clone(),
            None if no.is(true) && yes.is(false) => return guard.not(),
            None => {}
        }
        let range = (no.low.min(yes.low), no.high.max(yes.high));
        Self::call("SEL", &[guard, no, yes], no.ty, range)
    }

    /// The value kept within bounds.
    pub fn limit(low: &Term, value: &Term, high: &Term) -> Self {
        let top = value.high.min(high.high);
        let bottom = value.low.min(high.low);
        let range = (low.low.max(bottom), low.high.max(top));
        Self::call("LIMIT", &[low, value, high], value.ty, range)
    }

    /// Itself, if the tables can hold it.
    pub fn held(self, span: &Span) -> Checked<Self> {
        match self.low < -CELL || self.high > CELL {
            true => Err(Fault::new(
                span,
                format!(
                    "this can be {}..{}, more than 32 bits hold",
                    self.low, self.high
                ),
                "give the variables in it a smaller range",
            )),
            false => Ok(self),
        }
    }
}
