//! Resolves names and types of expressions: syntax trees become typed nodes over cells.

use std::cell::Cell;
use std::collections::HashMap;

use crate::diag::{Diagnostic, nearest};
use crate::interval::Ranges;
use crate::ir::{BinaryOp, Node, Space, Ty};
use crate::schema::Text;
use crate::spec::Spec;
use crate::syntax::ast::{Expr, Kind, Span, UnaryOp};

mod calls;

/// What a name stands for.
#[derive(Debug, Clone)]
pub(crate) enum Meaning {
    /// A value.
    Value(Ty, Node),
    /// State: its first cell; an array has (lower index bound, length).
    State(Ty, u32, Option<(i64, u32)>),
    /// An array of parameters or inputs.
    Array(Ty, Space, u32, i64, u32),
}

/// In which tense state is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tense {
    /// Guards and lets: state at the start of the cycle.
    Start,
    /// Effects, outputs, wires, properties: state as it is now; `PREV` gives the start.
    Now,
    /// No state at all: constants.
    None,
}

/// The names visible to an expression.
pub(crate) struct Scope<'a> {
    pub spec: &'a Spec,
    pub file: usize,
    pub text: &'a Text,
    pub names: &'a HashMap<String, Meaning>,
    /// `instance.member`, with the instance's full name as first key; empty inside machines.
    pub members: &'a HashMap<String, HashMap<String, Meaning>>,
    /// Lengths of instance arrays.
    pub arrays: &'a HashMap<String, i64>,
    /// Index variables.
    pub index: Vec<(String, i64)>,
    pub options: &'a HashMap<String, u32>,
    pub ranges: Ranges<'a>,
    pub tense: Tense,
    pub cycle_us: u64,
    /// Functions being expanded, against recursion.
    pub calls: Vec<String>,
    /// Nodes that this text may still make, see [`BUDGET`].
    pub left: Cell<usize>,
}

/// Nodes that one text may make. Functions and quantifiers are expanded where they stand, so a short text can be a long
/// expression; and where a type must be inferred, a part may be resolved more than once.
pub(crate) const BUDGET: usize = 1_000_000;

type Typed = Result<(Ty, Node), Diagnostic>;

const BUILTINS: [&str; 9] = [
    "SEL", "MUX", "MIN", "MAX", "LIMIT", "ABS", "ORD", "PREV", "T#",
];

impl Scope<'_> {
    pub(crate) fn error(&self, span: &Span, message: impl Into<String>) -> Diagnostic {
        self.spec.error(
            self.file,
            self.spec.locate(self.file, self.text, span),
            message,
        )
    }

    fn type_name(&self, ty: Ty) -> String {
        match ty {
            Ty::Bool => "BOOL".to_owned(),
            Ty::Int => "INT".to_owned(),
            Ty::Enum(e) => self
                .spec
                .enums
                .get_index(e)
                .map_or("enum", |(n, _)| n)
                .to_owned(),
        }
    }

    /// Resolves an expression that must have type `want`.
    pub(crate) fn expect(&mut self, e: &Expr, want: Ty) -> Result<Node, Diagnostic> {
        let (ty, node) = self.resolve(e, Some(want))?;
        if ty == want {
            return Ok(node);
        }
        let (want, got) = (self.type_name(want), self.type_name(ty));
        Err(self
            .error(
                &e.span,
                format!("a value of type {want} is needed, this is {got}"),
            )
            .help(match (want.as_str(), got.as_str()) {
                ("BOOL", _) => "compare it, for example with `= value`".to_owned(),
                ("INT", "BOOL") => "use SEL(condition, 0, 1)".to_owned(),
                ("INT", _) => "use ORD(value) for the number of an enum value".to_owned(),
                _ => format!("name a value of {want}"),
            }))
    }

    /// Resolves an expression; `hint` is the type that a bare enum value would get.
    pub(crate) fn resolve(&mut self, e: &Expr, hint: Option<Ty>) -> Typed {
        self.spend(1, e)?;
        match &e.kind {
            Kind::Int(v) => Ok((Ty::Int, Node::Const(*v))),
            Kind::Bool(b) => Ok((Ty::Bool, Node::Const(i64::from(*b)))),
            Kind::Time(us) => {
                let cycles = us.div_ceil(self.cycle_us.max(1));
                let cycles = i64::try_from(cycles).unwrap_or(i64::MAX);
                Ok((Ty::Int, Node::Const(cycles)))
            }
            Kind::Name(name) => self.name(name, e, hint),
            Kind::Qualified(of, value) => self.qualified(of, value, e),
            Kind::Member(base, member) => {
                let meaning = self.member(base, member, e)?;
                self.value_of(meaning, e)
            }
            Kind::Index(base, index) => self.element(base, index, e),
            Kind::Call(name, args) => self.call(name, args, e, hint),
            Kind::Unary(UnaryOp::Not, a) => {
                Ok((Ty::Bool, Node::Not(Box::new(self.expect(a, Ty::Bool)?))))
            }
            Kind::Unary(UnaryOp::Neg, a) => {
                let node = self.expect(a, Ty::Int)?;
                self.int(fold_neg(node), e)
            }
            Kind::Binary(op, a, b) => self.binary(*op, a, b, e),
            Kind::Quantified(q, var, array, body) => self.quantified(*q, var, array, body, e, hint),
        }
    }

    fn name(&mut self, name: &str, e: &Expr, hint: Option<Ty>) -> Typed {
        if let Some((_, v)) = self.index.iter().rev().find(|(n, _)| n == name) {
            return Ok((Ty::Int, Node::Const(*v)));
        }
        if let Some(meaning) = self.names.get(name).cloned() {
            return self.value_of(meaning, e);
        }
        if let Some(option) = self.options.get(name) {
            return Ok((Ty::Bool, Node::Cell(Space::Param, *option)));
        }
        let find = |values: &[Text]| values.iter().position(|v| v.get_ref() == name);
        if let Some(Ty::Enum(k)) = hint {
            if let Some((_, def)) = self.spec.enums.get_index(k) {
                if let Some(ordinal) = find(&def.def.values) {
                    return Ok((Ty::Enum(k), Node::Const(ordinal as i64)));
                }
            }
        }
        let mut hits = self
            .spec
            .enums
            .values()
            .enumerate()
            .filter_map(|(k, def)| find(&def.def.values).map(|o| (k, o)));
        match (hits.next(), hits.next()) {
            (Some((k, ordinal)), None) => Ok((Ty::Enum(k), Node::Const(ordinal as i64))),
            (Some(_), Some(_)) => Err(self
                .error(
                    &e.span,
                    format!("`{name}` is a value of more than one enum"),
                )
                .help(format!("write it with its enum, as in `Level#{name}`"))),
            (None, _) => Err(self.unknown(name, e)),
        }
    }

    fn unknown(&self, name: &str, e: &Expr) -> Diagnostic {
        let known = self
            .names
            .keys()
            .map(String::as_str)
            .chain(self.members.keys().map(String::as_str))
            .chain(self.options.keys().map(String::as_str))
            .chain(
                self.spec
                    .enums
                    .values()
                    .flat_map(|d| d.def.values.iter().map(|v| v.get_ref().as_str())),
            );
        let help = match nearest(name, known) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "declare it, or check the spelling (names are case sensitive)".to_owned(),
        };
        self.error(&e.span, format!("`{name}` is not known here"))
            .help(help)
    }

    fn qualified(&self, of: &str, value: &str, e: &Expr) -> Typed {
        let Some((k, _, def)) = self.spec.enums.get_full(of) else {
            let help = nearest(of, self.spec.enums.keys().map(String::as_str))
                .map_or("declare it under [enum]".to_owned(), |n| {
                    format!("did you mean `{n}`?")
                });
            return Err(self
                .error(&e.span, format!("there is no enum `{of}`"))
                .help(help));
        };
        match def.def.values.iter().position(|v| v.get_ref() == value) {
            Some(ordinal) => Ok((Ty::Enum(k), Node::Const(ordinal as i64))),
            None => {
                let all: Vec<&str> = def
                    .def
                    .values
                    .iter()
                    .map(|v| v.get_ref().as_str())
                    .collect();
                Err(self
                    .error(&e.span, format!("enum `{of}` has no value `{value}`"))
                    .help(format!("its values are {}", all.join(", "))))
            }
        }
    }

    /// Takes `nodes` from the budget.
    fn spend(&self, nodes: usize, e: &Expr) -> Result<(), Diagnostic> {
        match self.left.get().checked_sub(nodes) {
            Some(left) => {
                self.left.set(left);
                Ok(())
            }
            None => {
                self.left.set(0);
                Err(self
                    .error(
                        &e.span,
                        "this expression is too large once its functions are expanded",
                    )
                    .help("name parts of it with `let`"))
            }
        }
    }

    fn value_of(&self, meaning: Meaning, e: &Expr) -> Typed {
        match meaning {
            Meaning::Value(ty, node) => {
                // An argument is copied to each place of the function that names it.
                let mut nodes = 0;
                node.visit(&mut |_| nodes += 1);
                self.spend(nodes, e)?;
                Ok((ty, node))
            }
            Meaning::State(ty, base, None) => Ok((ty, Node::Cell(self.state_space(e)?, base))),
            Meaning::State(_, _, Some(_)) | Meaning::Array(..) => Err(self
                .error(&e.span, "this is an array, not one value")
                .help("name an element: `name[index]`")),
        }
    }

    fn state_space(&self, e: &Expr) -> Result<Space, Diagnostic> {
        match self.tense {
            Tense::Start => Ok(Space::Before),
            Tense::Now => Ok(Space::Now),
            Tense::None => Err(self
                .error(&e.span, "state is not constant")
                .help("use numbers and parameters here")),
        }
    }

    /// Full name of an instance: `stop` or `stop[1]`.
    fn instance(&mut self, base: &Expr) -> Result<String, Diagnostic> {
        match &base.kind {
            Kind::Name(name) if self.members.contains_key(name) => Ok(name.clone()),
            Kind::Name(name) if self.arrays.contains_key(name) => Err(self
                .error(&base.span, format!("`{name}` is an array of instances"))
                .help(format!("write `{name}[i]` or `{name}[1]`"))),
            Kind::Name(name) => Err(self.unknown(name, base)),
            Kind::Index(array, index) => {
                let Kind::Name(name) = &array.kind else {
                    return Err(self
                        .error(&array.span, "an instance array is needed")
                        .help("write `instance[i].name`"));
                };
                let Some(count) = self.arrays.get(name).copied() else {
                    return Err(self
                        .error(
                            &array.span,
                            format!("`{name}` is not an array of instances"),
                        )
                        .help("give the instance a `count`, or leave out the index"));
                };
                let node = self.expect(index, Ty::Int)?;
                match constant(&node) {
                    Some(k) if (1..=count).contains(&k) => Ok(format!("{name}[{k}]")),
                    Some(k) => Err(self
                        .error(&index.span, format!("index {k} is outside 1..{count}"))
                        .help(format!("`{name}` has {count} instances, counted from 1"))),
                    None => Err(self
                        .error(&index.span, "the index of an instance must be constant")
                        .help("use a number or the index variable `i`")),
                }
            }
            _ => Err(self
                .error(&base.span, "an instance name is needed before the dot")
                .help("write `instance.name`")),
        }
    }

    fn member(&mut self, base: &Expr, member: &str, e: &Expr) -> Result<Meaning, Diagnostic> {
        let instance = self.instance(base)?;
        let members = self.members.get(&instance);
        if let Some(meaning) = members.and_then(|m| m.get(member)) {
            return Ok(meaning.clone());
        }
        let names = members
            .into_iter()
            .flat_map(|m| m.keys().map(String::as_str));
        let help = match nearest(member, names) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "name an output, state variable or input of the machine".to_owned(),
        };
        Err(self
            .error(
                &e.span,
                format!("`{instance}` has nothing named `{member}`"),
            )
            .help(help))
    }

    fn element(&mut self, base: &Expr, index: &Expr, e: &Expr) -> Typed {
        let meaning = match &base.kind {
            Kind::Name(name) => match self.names.get(name) {
                Some(m) => m.clone(),
                None => return Err(self.unknown(name, base)),
            },
            Kind::Member(inner, member) => self.member(inner, member, base)?,
            _ => {
                return Err(self
                    .error(&base.span, "this cannot be indexed")
                    .help("only arrays have elements"));
            }
        };
        let (ty, space, base_cell, lo, len) = match meaning {
            Meaning::Array(ty, space, base, lo, len) => (ty, space, base, lo, len),
            Meaning::State(ty, base, Some((lo, len))) => (ty, self.state_space(e)?, base, lo, len),
            _ => {
                return Err(self
                    .error(&base.span, "this is not an array")
                    .help("leave out the index"));
            }
        };
        let index_node = self.index_node(index, lo, len)?;
        if let Some(k) = constant(&index_node) {
            return Ok((ty, Node::Cell(space, base_cell + (k - lo) as u32)));
        }
        Ok((
            ty,
            Node::Element {
                space,
                base: base_cell,
                lo,
                len,
                index: Box::new(index_node),
            },
        ))
    }

    /// An index that cannot leave the array.
    pub(crate) fn index_node(
        &mut self,
        index: &Expr,
        lo: i64,
        len: u32,
    ) -> Result<Node, Diagnostic> {
        let node = self.expect(index, Ty::Int)?;
        let (least, most) = self.ranges.of(&node);
        let hi = lo + i64::from(len) - 1;
        if least < i128::from(lo) || most > i128::from(hi) {
            return Err(self
                .error(
                    &index.span,
                    format!("index can be {least}..{most}, the array has {lo}..{hi}"),
                )
                .help("narrow the type of the index, or use LIMIT"));
        }
        Ok(node)
    }

    fn int(&self, node: Node, e: &Expr) -> Typed {
        let (lo, hi) = self.ranges.of(&node);
        if lo < i128::from(i64::MIN) || hi > i128::from(i64::MAX) {
            return Err(self
                .error(&e.span, "the result can leave 64 bits")
                .help("narrow the types of the operands"));
        }
        Ok((Ty::Int, node))
    }

    fn binary(&mut self, op: BinaryOp, a: &Expr, b: &Expr, e: &Expr) -> Typed {
        use BinaryOp::{Add, And, Div, Eq, Ge, Gt, Le, Lt, Mod, Mul, Ne, Or, Sub, Xor};
        let make = |x, y| Node::Binary(op, Box::new(x), Box::new(y));
        match op {
            And | Or | Xor => {
                let x = self.expect(a, Ty::Bool)?;
                let y = self.expect(b, Ty::Bool)?;
                Ok((Ty::Bool, make(x, y)))
            }
            Eq | Ne | Lt | Gt | Le | Ge => {
                let [(ta, x), (tb, y)] = self.pair(a, b)?;
                if ta != tb {
                    return Err(self
                        .error(
                            &e.span,
                            format!(
                                "{} and {} cannot be compared",
                                self.type_name(ta),
                                self.type_name(tb)
                            ),
                        )
                        .help(
                            "compare values of one type; ORD(x) is the number of an enum value",
                        ));
                }
                if ta == Ty::Bool && !matches!(op, Eq | Ne) {
                    return Err(self
                        .error(&e.span, "truth values have no order")
                        .help("use = or <>"));
                }
                Ok((Ty::Bool, make(x, y)))
            }
            Add | Sub | Mul | Div | Mod => {
                let x = self.expect(a, Ty::Int)?;
                let y = self.expect(b, Ty::Int)?;
                if matches!(op, Div | Mod) {
                    let (lo, hi) = self.ranges.of(&y);
                    if lo <= 0 && hi >= 0 {
                        return Err(self
                            .error(
                                &b.span,
                                format!("the divisor can be 0 (its range is {lo}..{hi})"),
                            )
                            .help("use MAX(x, 1), or a type without 0"));
                    }
                }
                if let (Some(x), Some(y)) = (constant(&x), constant(&y)) {
                    let folded = match op {
                        Add => x.checked_add(y),
                        Sub => x.checked_sub(y),
                        Mul => x.checked_mul(y),
                        Div => x.checked_div(y),
                        _ => x.checked_rem(y),
                    };
                    if let Some(v) = folded {
                        return Ok((Ty::Int, Node::Const(v)));
                    }
                }
                self.int(make(x, y), e)
            }
        }
    }

    /// Two operands of one type; a bare enum value takes the other side's type.
    fn pair(&mut self, a: &Expr, b: &Expr) -> Result<[(Ty, Node); 2], Diagnostic> {
        if matches!(a.kind, Kind::Name(_)) && !matches!(b.kind, Kind::Name(_)) {
            let y = self.resolve(b, None)?;
            let x = self.resolve(a, Some(y.0))?;
            return Ok([x, y]);
        }
        match self.resolve(a, None) {
            Ok(x) => {
                let y = self.resolve(b, Some(x.0))?;
                Ok([x, y])
            }
            // `NONE = level`: the left side may need the right side's type.
            Err(first) => {
                let y = self.resolve(b, None).map_err(|_| first.clone())?;
                let x = self.resolve(a, Some(y.0)).map_err(|_| first)?;
                Ok([x, y])
            }
        }
    }

    /// Values of one type; the first that has a type of its own fixes it for bare enum values.
    fn alike(&mut self, args: &[Expr], hint: Option<Ty>) -> Result<(Ty, Vec<Node>), Diagnostic> {
        let mut ty = hint.filter(|t| matches!(t, Ty::Enum(_)));
        if ty.is_none() {
            ty = args
                .iter()
                .find_map(|a| self.resolve(a, None).ok().map(|(t, _)| t));
        }
        let mut nodes = Vec::new();
        for a in args {
            match ty {
                Some(t) => nodes.push(self.expect(a, t)?),
                None => {
                    let (t, node) = self.resolve(a, hint)?;
                    ty = Some(t);
                    nodes.push(node);
                }
            }
        }
        Ok((ty.unwrap_or(Ty::Int), nodes))
    }
}

/// The value of a constant node.
pub(crate) fn constant(node: &Node) -> Option<i64> {
    match node {
        Node::Const(v) => Some(*v),
        _ => None,
    }
}

fn fold_neg(node: Node) -> Node {
    match constant(&node).and_then(i64::checked_neg) {
        Some(v) => Node::Const(v),
        None => Node::Neg(Box::new(node)),
    }
}
