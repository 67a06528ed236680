//! A system after constant folding, its parameter values put in: small named expressions inlined, ranges known.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::fold::Folder;
use stillpoint_lang::ir::{BinaryOp, Form, Node, Space, Stmt};

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
    /// Least and greatest value of each state variable: constants, unless parameters are state variables themselves.
    pub limits: Vec<(Node, Node)>,
}

impl<'a> Folded<'a> {
    /// Puts the parameter values of `bound` in.
    ///
    /// # Errors
    /// An expression whose possible values leave 32 bits, which the target's integers have.
    pub fn new(bound: &'a Bound) -> Result<Self, Unsupported> {
        let system = &bound.system;
        let mut folder = Folder::new(bound, INLINE);
        let lazies: Vec<Node> = (0..system.lazies.len()).map(|k| folder.lazy(k)).collect();
        let mut rules = Vec::new();
        for instance in &system.instances {
            let list = folder.rules(&instance.rules).into_iter();
            let list = list.map(|(number, when, then)| (number, Rule { when, then }));
            rules.push(list.collect());
        }
        let atoms = system.atoms.iter().map(|n| folder.node(n)).collect();
        let vars = system.states.iter().map(|s| &s.var);
        let limits = vars
            .map(|var| (folder.node(&var.lo), folder.node(&var.hi)))
            .collect();
        let mut folded = Self {
            bound,
            rules,
            lazies,
            ranges: Vec::new(),
            atoms,
            limits,
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

/// Possible values of an expression that reads no named ones, over every value of the cells.
///
/// # Errors
/// As [`Folded::new`].
pub(crate) fn range_of(bound: &Bound, node: &Node) -> Result<Range, Unsupported> {
    let folded = &Folded {
        bound,
        rules: Vec::new(),
        lazies: Vec::new(),
        ranges: Vec::new(),
        atoms: Vec::new(),
        limits: Vec::new(),
    };
    let lazies = Vec::new();
    Ranges { folded, lazies }.of(node)
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
