//! A system with its parameter values put in: constants folded, small named expressions inlined, ranges known.

use stillpoint_spec::bind::Bound;
use stillpoint_spec::ir::{BinaryOp, Form, Node, Space, Stmt};

use super::Unsupported;

/// Named expressions of at most so many nodes stand where they are used.
const INLINE: usize = 4;

/// A rule with its parameters put in.
pub struct Rule {
    /// Guard.
    pub when: Node,
    /// Effect.
    pub then: Vec<Stmt>,
}

/// A system without parameters.
pub struct Folded<'a> {
    /// Where it comes from.
    pub bound: &'a Bound,
    /// Rules of each instance; those that cannot fire are left out, with their places in the system's instance.
    pub rules: Vec<Vec<(usize, Rule)>>,
    /// Named expressions, those inlined included.
    pub lazies: Vec<Node>,
    /// Ranges of the named expressions.
    pub ranges: Vec<(i64, i64)>,
    /// Atoms of the properties.
    pub atoms: Vec<Node>,
}

impl<'a> Folded<'a> {
    /// Puts the parameter values of `bound` in.
    ///
    /// # Errors
    /// An expression whose possible values leave 32 bits, which the target's integers have.
    pub fn new(bound: &'a Bound) -> Result<Self, Unsupported> {
        let system = &bound.system;
        let mut folder = Folder {
            bound,
            done: vec![None; system.lazies.len()],
        };
        let lazies: Vec<Node> = (0..system.lazies.len()).map(|k| folder.lazy(k)).collect();
        let mut rules = Vec::new();
        for instance in &system.instances {
            let mut list = Vec::new();
            for (n, rule) in instance.rules.iter().enumerate() {
                let when = folder.node(&rule.when);
                if when == Node::Const(0) {
                    continue;
                }
                let last = matches!(when, Node::Const(_));
                list.push((
                    n,
                    Rule {
                        when,
                        then: folder.statements(&rule.then),
                    },
                ));
                if last {
                    break;
                }
            }
            rules.push(list);
        }
        let atoms = system.atoms.iter().map(|n| folder.node(n)).collect();
        let mut folded = Self {
            bound,
            rules,
            lazies,
            ranges: Vec::new(),
            atoms,
        };
        folded.ranges = folded.check()?;
        Ok(folded)
    }

    /// The atoms of the properties that speak of single cycles.
    pub fn claims(&self) -> Vec<usize> {
        let mut out = Vec::new();
        for property in &self.bound.system.properties {
            if let Form::Always { when, then } = &property.form {
                out.extend(when.iter().chain([then]));
            }
        }
        out
    }

    /// Ranges of the named expressions, after a look at every expression there is.
    fn check(&self) -> Result<Vec<(i64, i64)>, Unsupported> {
        let mut ranges = Ranges {
            folded: self,
            lazies: vec![None; self.lazies.len()],
        };
        for rule in self.rules.iter().flatten() {
            ranges.of(&rule.1.when)?;
            let mut found = Ok(());
            rule.1.then.iter().for_each(|s| {
                s.expressions(&mut |n| {
                    if let Err(e) = ranges.of(n) {
                        found = Err(e);
                    }
                });
            });
            found?;
        }
        for node in &self.atoms {
            ranges.of(node)?;
        }
        (0..self.lazies.len())
            .map(|k| ranges.of(&Node::Lazy(k as u32)))
            .collect()
    }
}

/// Number of nodes of an expression.
pub fn size(node: &Node) -> usize {
    let mut n = 0;
    node.visit(&mut |_| n += 1);
    n
}

struct Folder<'a> {
    bound: &'a Bound,
    done: Vec<Option<Node>>,
}

impl Folder<'_> {
    fn lazy(&mut self, k: usize) -> Node {
        if let Some(node) = &self.done[k] {
            return node.clone();
        }
        let bound = self.bound;
        let node = self.node(&bound.system.lazies[k].value);
        self.done[k] = Some(node.clone());
        node
    }

    fn statements(&mut self, list: &[Stmt]) -> Vec<Stmt> {
        let mut out = Vec::new();
        for statement in list {
            match statement {
                Stmt::Assign {
                    base,
                    index,
                    value,
                    checked,
                    site,
                } => out.push(Stmt::Assign {
                    base: *base,
                    index: index.as_ref().map(|(n, lo, len)| (self.node(n), *lo, *len)),
                    value: self.node(value),
                    checked: *checked,
                    site: *site,
                }),
                Stmt::If(branches, rest) => {
                    let mut kept = Vec::new();
                    let mut rest = rest.as_slice();
                    for (guard, body) in branches {
                        match self.node(guard) {
                            Node::Const(0) => {}
                            Node::Const(_) => {
                                rest = body;
                                break;
                            }
                            guard => kept.push((guard, self.statements(body))),
                        }
                    }
                    let rest = self.statements(rest);
                    if kept.is_empty() {
                        out.extend(rest);
                    } else {
                        out.push(Stmt::If(kept, rest));
                    }
                }
            }
        }
        out
    }

    fn node(&mut self, node: &Node) -> Node {
        match node {
            Node::Cell(Space::Param, k) => Node::Const(i64::from(self.bound.values[*k as usize])),
            Node::Cell(Space::Before | Space::Now, k) => {
                fixed(node, self.bound.states[*k as usize])
            }
            Node::Cell(Space::Input, k) => fixed(node, self.bound.inputs[*k as usize]),
            Node::Lazy(k) => {
                let value = self.lazy(*k as usize);
                if size(&value) <= INLINE {
                    value
                } else {
                    node.clone()
                }
            }
            _ => {
                let node = node.map(&mut |n| self.node(n));
                simplify(&node, &self.bound.values).unwrap_or(node)
            }
        }
    }
}

/// A cell whose range has one value is that value.
fn fixed(node: &Node, (lo, hi): (i32, i32)) -> Node {
    if lo == hi {
        Node::Const(i64::from(lo))
    } else {
        node.clone()
    }
}

/// What an expression becomes when parts of it are constants; none if they change nothing.
fn simplify(node: &Node, params: &[i32]) -> Option<Node> {
    let constant = |n: &Node| {
        if let Node::Const(v) = n {
            Some(*v)
        } else {
            None
        }
    };
    let constants = |values: &[Node]| values.iter().map(constant).collect::<Option<Vec<i64>>>();
    match node {
        Node::Element {
            space,
            base,
            lo,
            index,
            ..
        } => {
            let cell = *base as usize + usize::try_from(constant(index)? - lo).ok()?;
            match space {
                Space::Param => params.get(cell).map(|v| Node::Const(i64::from(*v))),
                _ => Some(Node::Cell(*space, u32::try_from(cell).ok()?)),
            }
        }
        Node::Not(a) => constant(a).map(|v| Node::Const(i64::from(v == 0))),
        Node::Neg(a) => constant(a).and_then(i64::checked_neg).map(Node::Const),
        Node::Abs(a) => constant(a).and_then(i64::checked_abs).map(Node::Const),
        Node::Binary(op, a, b) => match (op, constant(a), constant(b)) {
            (BinaryOp::And, Some(0), _) | (BinaryOp::And, _, Some(0)) => Some(Node::Const(0)),
            (BinaryOp::Or, Some(1), _) | (BinaryOp::Or, _, Some(1)) => Some(Node::Const(1)),
            (BinaryOp::And, Some(1), _) | (BinaryOp::Or, Some(0), _) => Some((**b).clone()),
            (BinaryOp::And, _, Some(1)) | (BinaryOp::Or, _, Some(0)) => Some((**a).clone()),
            (_, Some(x), Some(y)) => binary(*op, x, y).map(Node::Const),
            _ => None,
        },
        Node::Sel(g, a, b) => match constant(g) {
            Some(0) => Some((**a).clone()),
            Some(_) => Some((**b).clone()),
            None => (a == b).then(|| (**a).clone()),
        },
        Node::Mux(k, values) => values.get(usize::try_from(constant(k)?).ok()?).cloned(),
        Node::Min(values) => constants(values)?.into_iter().min().map(Node::Const),
        Node::Max(values) => constants(values)?.into_iter().max().map(Node::Const),
        Node::Const(_) | Node::Cell(..) | Node::Lazy(_) => None,
    }
}

fn binary(op: BinaryOp, x: i64, y: i64) -> Option<i64> {
    match op {
        BinaryOp::And => Some(i64::from(x != 0 && y != 0)),
        BinaryOp::Or => Some(i64::from(x != 0 || y != 0)),
        BinaryOp::Xor | BinaryOp::Ne => Some(i64::from(x != y)),
        BinaryOp::Eq => Some(i64::from(x == y)),
        BinaryOp::Lt => Some(i64::from(x < y)),
        BinaryOp::Gt => Some(i64::from(x > y)),
        BinaryOp::Le => Some(i64::from(x <= y)),
        BinaryOp::Ge => Some(i64::from(x >= y)),
        BinaryOp::Add => x.checked_add(y),
        BinaryOp::Sub => x.checked_sub(y),
        BinaryOp::Mul => x.checked_mul(y),
        BinaryOp::Div => x.checked_div(y),
        BinaryOp::Mod => x.checked_rem(y),
    }
}

/// Possible values of expressions, over every value of the cells.
struct Ranges<'a, 'b> {
    folded: &'a Folded<'b>,
    lazies: Vec<Option<(i64, i64)>>,
}

/// Least and greatest value.
pub type Range = (i64, i64);

impl Ranges<'_, '_> {
    fn of(&mut self, node: &Node) -> Result<Range, Unsupported> {
        let (lo, hi) = self.raw(node)?;
        if lo < i64::from(i32::MIN) || hi > i64::from(i32::MAX) {
            return Err(Unsupported(format!(
                "an expression can have the values {lo} to {hi}, which needs more than 32 bits"
            )));
        }
        Ok((lo, hi))
    }

    fn raw(&mut self, node: &Node) -> Result<Range, Unsupported> {
        let bound = self.folded.bound;
        let wide = |(lo, hi): (i32, i32)| (i64::from(lo), i64::from(hi));
        let cell = |space: Space, k: usize| match space {
            Space::Param => (i64::from(bound.values[k]), i64::from(bound.values[k])),
            Space::Before | Space::Now => wide(bound.states[k]),
            Space::Input => wide(bound.inputs[k]),
        };
        Ok(match node {
            Node::Const(v) => (*v, *v),
            Node::Cell(space, k) => cell(*space, *k as usize),
            Node::Lazy(k) => {
                let k = *k as usize;
                match self.lazies[k] {
                    Some(range) => range,
                    None => {
                        let range = self.of(&self.folded.lazies[k])?;
                        self.lazies[k] = Some(range);
                        range
                    }
                }
            }
            Node::Element {
                space,
                base,
                len,
                index,
                ..
            } => {
                self.of(index)?;
                let base = *base as usize;
                hull((base..base + *len as usize).map(|k| cell(*space, k)))
            }
            Node::Not(a) => {
                self.of(a)?;
                (0, 1)
            }
            Node::Neg(a) => {
                let (lo, hi) = self.of(a)?;
                (-hi, -lo)
            }
            Node::Abs(a) => {
                let (lo, hi) = self.of(a)?;
                let least = if lo <= 0 && hi >= 0 {
                    0
                } else {
                    lo.abs().min(hi.abs())
                };
                (least, lo.abs().max(hi.abs()))
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.of(a)?, self.of(b)?);
                arithmetic(*op, a, b)
            }
            Node::Sel(g, a, b) => {
                self.of(g)?;
                hull([self.of(a)?, self.of(b)?].into_iter())
            }
            Node::Mux(k, values) => {
                self.of(k)?;
                hull(self.all(values)?.into_iter())
            }
            Node::Min(values) => {
                let all = self.all(values)?;
                (
                    least(all.iter().map(|r| r.0)),
                    least(all.iter().map(|r| r.1)),
                )
            }
            Node::Max(values) => {
                let all = self.all(values)?;
                (most(all.iter().map(|r| r.0)), most(all.iter().map(|r| r.1)))
            }
        })
    }

    fn all(&mut self, values: &[Node]) -> Result<Vec<Range>, Unsupported> {
        values.iter().map(|v| self.of(v)).collect()
    }
}

fn least(values: impl Iterator<Item = i64>) -> i64 {
    values.min().unwrap_or(0)
}

fn most(values: impl Iterator<Item = i64>) -> i64 {
    values.max().unwrap_or(0)
}

/// The least range that has all of them in it.
pub fn hull(ranges: impl Iterator<Item = Range> + Clone) -> Range {
    (
        least(ranges.clone().map(|r| r.0)),
        most(ranges.map(|r| r.1)),
    )
}

/// The values of an operator over those of its operands, which are within 32 bits, so that 64 bits hold every result.
pub fn arithmetic(op: BinaryOp, (a, b): Range, (c, d): Range) -> Range {
    let corners = |f: fn(i64, i64) -> i64| {
        hull(
            [f(a, c), f(a, d), f(b, c), f(b, d)]
                .map(|v| (v, v))
                .into_iter(),
        )
    };
    match op {
        BinaryOp::Add => (a + c, b + d),
        BinaryOp::Sub => (a - d, b - c),
        BinaryOp::Mul => corners(|x, y| x * y),
        // No divisor is zero, so one whose range has no zero in it takes its extremes with those of the dividend.
        BinaryOp::Div if c > 0 || d < 0 => corners(|x, y| x / y),
        // The quotient is never further from zero than the dividend.
        BinaryOp::Div => (
            -most([a.abs(), b.abs()].into_iter()),
            most([a.abs(), b.abs()].into_iter()),
        ),
        // The remainder has the sign of the dividend and is no further from zero than that.
        BinaryOp::Mod => {
            let most = most([c.abs(), d.abs()].into_iter()).max(1) - 1;
            (
                if a < 0 { a.max(-most) } else { 0 },
                if b > 0 { b.min(most) } else { 0 },
            )
        }
        _ => (0, 1),
    }
}
