//! A system as BTOR2, for word-level checkers.
//!
//! One step is one cycle. Truth values have one bit; numbers as many as their range needs, in two's complement if it goes
//! below zero. Each operator is computed in a width that holds its operands and its result, then brought to that of its
//! result, so nothing wraps around. Each `always` or `never` property is one `bad`, a `reachable` one an `output`. A cycle
//! with a range fault leaves the state as it is and is a `bad` of its own.

use std::collections::HashMap;
use std::fmt::Write;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::BinaryOp;

use super::Unsupported;
use super::about::{about, not_carried};
use super::circuit::{Circuit, Claim, Id, Op, Sort};
use super::folded::{Folded, Range, hull};
use super::types::is_arithmetic;
use super::writer::{meaning, statement};

/// Symbol of the `bad` that a value leaves its range.
pub const RANGE: &str = "range";

/// The model of a system with its parameter values. `title` stands at its top. With `only`, the one property with this id
/// (or [`RANGE`]) is its only `bad`: some checkers take no more than one.
///
/// # Errors
/// A system with values that need more than 32 bits; an id that names no `always` or `never` property.
pub fn btor2(bound: &Bound, title: &str, only: Option<&str>) -> Result<String, Unsupported> {
    let folded = Folded::new(bound)?;
    let mut circuit = Circuit::new(&folded)?;
    if let Some(id) = only {
        keep(&mut circuit, id)?;
    }
    let mut emitter = Emitter {
        circuit: &circuit,
        range: only.is_none_or(|id| id == RANGE),
        out: String::new(),
        last: 0,
        sorts: HashMap::new(),
        constants: HashMap::new(),
        nodes: HashMap::new(),
        resized: HashMap::new(),
    };
    emitter.header(title);
    emitter.states();
    emitter.inputs();
    for id in circuit.terms.below(&circuit.roots()) {
        emitter.term(id);
    }
    emitter.successors();
    emitter.properties();
    Ok(emitter.out)
}

/// Leaves out every property but one.
fn keep(circuit: &mut Circuit, id: &str) -> Result<(), Unsupported> {
    let mut ids: Vec<String> = circuit.claims.iter().map(Claim::id).collect();
    ids.extend(circuit.fault.map(|_| RANGE.to_owned()));
    if !ids.iter().any(|known| known == id) {
        return Err(Unsupported(format!(
            "there is no `always` or `never` property `{id}`; there are {}",
            ids.join(", ")
        )));
    }
    circuit.claims.retain(|c| c.id() == id);
    circuit.goals.clear();
    Ok(())
}

/// Number of a line.
type Node = usize;

/// How a number is represented.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Shape {
    width: u32,
    signed: bool,
}

impl Shape {
    /// The least that holds a range.
    fn of((lo, hi): Range) -> Self {
        let bits = |v: i64| 64 - v.leading_zeros();
        if lo >= 0 {
            let width = bits(hi).max(1);
            return Shape {
                width,
                signed: false,
            };
        }
        Shape {
            width: bits(hi.max(0)).max(bits(-(lo + 1))) + 1,
            signed: true,
        }
    }

    /// Least and greatest value it can hold.
    fn range(self) -> Range {
        if self.signed {
            let half = 1 << (self.width - 1);
            (-half, half - 1)
        } else {
            (0, (1 << self.width) - 1)
        }
    }
}

struct Emitter<'a> {
    circuit: &'a Circuit<'a>,
    /// Whether a range fault is a `bad`.
    range: bool,
    out: String,
    /// Number of the last line.
    last: Node,
    /// Sorts by width.
    sorts: HashMap<u32, Node>,
    /// Constants by value and width.
    constants: HashMap<(i64, u32), Node>,
    /// Lines of terms.
    nodes: HashMap<Id, Node>,
    /// Terms in other widths than their own.
    resized: HashMap<(Id, u32), Node>,
}

impl Emitter<'_> {
    fn line(&mut self, text: &str) -> Node {
        self.last += 1;
        let _ = writeln!(self.out, "{} {text}", self.last);
        self.last
    }

    fn comment(&mut self, text: &str) {
        let _ = writeln!(self.out, "{}", format!("; {text}").trim_end());
    }

    fn sort(&mut self, width: u32) -> Node {
        if let Some(known) = self.sorts.get(&width) {
            return *known;
        }
        let node = self.line(&format!("sort bitvec {width}"));
        self.sorts.insert(width, node);
        node
    }

    /// An operator whose result has this many bits.
    fn operator(&mut self, width: u32, text: &str) -> Node {
        let (word, operands) = text.split_once(' ').unwrap_or((text, ""));
        let sort = self.sort(width);
        self.line(&format!("{word} {sort} {operands}"))
    }

    fn constant(&mut self, value: i64, width: u32) -> Node {
        if let Some(known) = self.constants.get(&(value, width)) {
            return *known;
        }
        let node = self.operator(width, &format!("constd {value}"));
        self.constants.insert((value, width), node);
        node
    }

    fn range(&self, id: Id) -> Range {
        self.circuit.terms.sort(id).range()
    }

    fn shape(&self, id: Id) -> Shape {
        Shape::of(self.range(id))
    }

    /// A term in this shape: extended, or with its upper bits cut off where they are known to say nothing.
    fn fit(&mut self, id: Id, to: Shape) -> Node {
        match self.circuit.terms.op(id) {
            Op::Number(v) => return self.constant(v, to.width),
            Op::Truth(v) => return self.constant(i64::from(v), to.width),
            _ => {}
        }
        let node = self.nodes[&id];
        let own = self.shape(id);
        if own.width == to.width {
            return node;
        }
        if let Some(known) = self.resized.get(&(id, to.width)) {
            return *known;
        }
        let resized = self.resize(node, own, to);
        self.resized.insert((id, to.width), resized);
        resized
    }

    fn resize(&mut self, node: Node, own: Shape, to: Shape) -> Node {
        if to.width < own.width {
            return self.operator(to.width, &format!("slice {node} {} 0", to.width - 1));
        }
        let word = if own.signed { "sext" } else { "uext" };
        let more = to.width - own.width;
        match more {
            0 => node,
            _ => self.operator(to.width, &format!("{word} {node} {more}")),
        }
    }

    fn truth(&mut self, id: Id) -> Node {
        self.fit(id, Shape::of((0, 1)))
    }

    fn header(&mut self, title: &str) {
        let mut lines = about(self.circuit.bound, title);
        lines.push(String::new());
        lines
            .push("Each bad is a property, by its symbol; each output is to be seen 1.".to_owned());
        lines.extend(not_carried(&self.circuit.left_out()));
        lines.iter().for_each(|line| self.comment(line));
    }

    fn states(&mut self) {
        let circuit = self.circuit;
        let bound = circuit.bound;
        // A start value stands before the state it is for.
        for k in circuit.variables() {
            if let Some(v) = bound.initial[k] {
                let range = (i64::from(bound.states[k].0), i64::from(bound.states[k].1));
                self.constant(i64::from(v), Shape::of(range).width);
            }
        }
        for k in circuit.variables() {
            let var = &bound.system.states[k].var;
            self.comment(&meaning(circuit, var));
            let range = (i64::from(bound.states[k].0), i64::from(bound.states[k].1));
            let shape = Shape::of(range);
            let sort = self.sort(shape.width);
            let node = self.line(&format!("state {sort} {}", symbol(&var.name)));
            self.nodes.insert(circuit.state(k), node);
            match bound.initial[k] {
                Some(v) => {
                    let value = self.constant(i64::from(v), shape.width);
                    self.line(&format!("init {sort} {node} {value}"));
                }
                // Any value of the range at the start; later it never leaves it.
                None => self.within(node, range),
            }
        }
    }

    fn inputs(&mut self) {
        let circuit = self.circuit;
        let bound = circuit.bound;
        for id in circuit.terms.below(&circuit.roots()) {
            let Op::Input(k) = circuit.terms.op(id) else {
                continue;
            };
            let var = &bound.system.inputs[k];
            self.comment(&meaning(circuit, var));
            let range = self.range(id);
            let sort = self.sort(Shape::of(range).width);
            let node = self.line(&format!("input {sort} {}", symbol(&var.name)));
            self.nodes.insert(id, node);
            self.within(node, range);
        }
    }

    /// Constrains a variable to its range, where its bits could hold more.
    fn within(&mut self, node: Node, (lo, hi): Range) {
        let shape = Shape::of((lo, hi));
        let (least, most) = shape.range();
        let sign = if shape.signed { 's' } else { 'u' };
        for (bound, word, needed) in [(lo, "gte", lo > least), (hi, "lte", hi < most)] {
            if needed {
                let limit = self.constant(bound, shape.width);
                let holds = self.operator(1, &format!("{sign}{word} {node} {limit}"));
                self.line(&format!("constraint {holds}"));
            }
        }
    }

    fn term(&mut self, id: Id) {
        let terms = &self.circuit.terms;
        let own = self.shape(id);
        let node = match terms.op(id) {
            // A constant stands where it is used, in the width used there; variables are declared.
            Op::Truth(_) | Op::Number(_) | Op::State(_) | Op::Input(_) => return,
            Op::Not(a) => {
                let a = self.truth(a);
                self.operator(1, &format!("not {a}"))
            }
            Op::Neg(a) => {
                let common = Shape::of(hull([self.range(a), self.range(id)].into_iter()));
                let a = self.fit(a, common);
                let node = self.operator(common.width, &format!("neg {a}"));
                self.resize(node, common, own)
            }
            Op::Choice(c, a, b) => {
                let c = self.truth(c);
                let (a, b) = (self.fit(a, own), self.fit(b, own));
                self.operator(own.width, &format!("ite {c} {a} {b}"))
            }
            Op::Binary(op, a, b) => {
                let mut ranges = vec![self.range(a), self.range(b)];
                if is_arithmetic(op) {
                    ranges.push(self.range(id));
                }
                let common = Shape::of(hull(ranges.into_iter()));
                let (a, b) = (self.fit(a, common), self.fit(b, common));
                let word = word(op, common.signed);
                if terms.sort(id) == Sort::Truth {
                    self.operator(1, &format!("{word} {a} {b}"))
                } else {
                    let node = self.operator(common.width, &format!("{word} {a} {b}"));
                    self.resize(node, common, own)
                }
            }
        };
        self.nodes.insert(id, node);
    }

    fn successors(&mut self) {
        let circuit = self.circuit;
        for k in circuit.variables() {
            let state = circuit.state(k);
            let shape = self.shape(state);
            let node = self.nodes[&state];
            let mut next = self.fit(circuit.next[k], shape);
            if let (Some(fault), true) = (circuit.fault, circuit.next[k] != state) {
                let fault = self.truth(fault);
                next = self.operator(shape.width, &format!("ite {fault} {node} {next}"));
            }
            let sort = self.sort(shape.width);
            self.line(&format!("next {sort} {node} {next}"));
        }
    }

    fn properties(&mut self) {
        let circuit = self.circuit;
        if let (Some(fault), true) = (circuit.fault, self.range) {
            self.comment("a value leaves its range");
            let fault = self.truth(fault);
            self.line(&format!("bad {fault} {RANGE}"));
        }
        for claim in &circuit.claims {
            self.comment(&statement(claim));
            let holds = self.truth(claim.term);
            let broken = self.operator(1, &format!("not {holds}"));
            self.line(&format!("bad {broken} {}", symbol(&claim.id())));
        }
        for goal in &circuit.goals {
            self.comment(&statement(goal));
            let seen = self.truth(goal.term);
            self.line(&format!("output {seen} {}", symbol(&goal.id())));
        }
    }
}

/// A name as one word.
fn symbol(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}

fn word(op: BinaryOp, signed: bool) -> &'static str {
    match (op, signed) {
        (BinaryOp::And, _) => "and",
        (BinaryOp::Or, _) => "or",
        (BinaryOp::Xor | BinaryOp::Ne, _) => "neq",
        (BinaryOp::Eq, _) => "eq",
        (BinaryOp::Lt, true) => "slt",
        (BinaryOp::Lt, false) => "ult",
        (BinaryOp::Gt, true) => "sgt",
        (BinaryOp::Gt, false) => "ugt",
        (BinaryOp::Le, true) => "slte",
        (BinaryOp::Le, false) => "ulte",
        (BinaryOp::Ge, true) => "sgte",
        (BinaryOp::Ge, false) => "ugte",
        (BinaryOp::Add, _) => "add",
        (BinaryOp::Sub, _) => "sub",
        (BinaryOp::Mul, _) => "mul",
        // Truncated, the remainder with the sign of the dividend.
        (BinaryOp::Div, true) => "sdiv",
        (BinaryOp::Div, false) => "udiv",
        (BinaryOp::Mod, true) => "srem",
        (BinaryOp::Mod, false) => "urem",
    }
}
