//! Expressions: what has to be chosen before they have a value, and their text.

use stillpoint_lang::ir::{BinaryOp, Node, Space};

use super::{Emitter, SMALL, choose, scratch, wide};
use crate::export::known::Status;

impl Emitter<'_> {
    /// Chooses the inputs and evaluates the named expressions that the value of `node` needs.
    pub(super) fn need(&mut self, node: &Node) {
        if self.known.satisfies(node) {
            return;
        }
        match node {
            Node::Cell(Space::Input, k) => self.read(*k as usize),
            Node::Lazy(k) => self.evaluate(*k as usize),
            Node::Element {
                space,
                base,
                len,
                index,
                ..
            } => {
                self.need(index);
                if *space == Space::Input {
                    (*base..base + len).for_each(|k| self.read(k as usize));
                }
            }
            Node::Binary(op @ (BinaryOp::And | BinaryOp::Or), a, b) => {
                self.need(a);
                if self.known.satisfies(b) {
                    return;
                }
                let condition = self.value(a);
                match op {
                    BinaryOp::And => self.branch(&condition, |e| e.need(b), |_| ()),
                    _ => self.branch(&condition, |_| (), |e| e.need(b)),
                }
            }
            Node::Sel(g, a, b) => {
                self.need(g);
                if !self.known.satisfies(a) || !self.known.satisfies(b) {
                    let condition = self.value(g);
                    self.branch(&condition, |e| e.need(b), |e| e.need(a));
                }
            }
            Node::Mux(k, values) => {
                self.need(k);
                self.need_of(k, 0, values);
            }
            _ => node.children().into_iter().for_each(|n| self.need(n)),
        }
    }

    /// What the chosen one of `values` needs, of which the first has number `first`.
    pub(super) fn need_of(&mut self, selector: &Node, first: usize, values: &[Node]) {
        match values {
            [] => {}
            [last] => self.need(last),
            [_, ..] if values.iter().all(|v| self.known.satisfies(v)) => {}
            [value, rest @ ..] => {
                let k = self.value(selector);
                let condition = format!("({k} == {first})");
                self.branch(
                    &condition,
                    |e| e.need(value),
                    |e| e.need_of(selector, first + 1, rest),
                );
            }
        }
    }

    pub(super) fn read(&mut self, k: usize) {
        let shared = self.shared;
        let flagged = self.used.chosen.contains(&k);
        self.found.inputs.insert(k);
        let any = |e: &mut Self| {
            choose(
                &mut e.out,
                &"\t".repeat(e.depth),
                &shared.inputs[k],
                wide(shared.folded.bound.inputs[k]),
            );
            if flagged {
                e.line(&format!("{} = 1;", shared.chosen[k]));
            }
        };
        match self.known.inputs[k] {
            Status::Yes => {}
            Status::No => any(self),
            Status::Maybe => {
                self.found.chosen.insert(k);
                self.branch(&shared.chosen[k], |_| (), any);
            }
        }
        self.known.inputs[k] = Status::Yes;
    }

    pub(super) fn evaluate(&mut self, k: usize) {
        let shared = self.shared;
        let node = &shared.folded.lazies[k];
        let flagged = self.used.evaluated.contains(&k);
        self.found.lazies.insert(k);
        let compute = |e: &mut Self| {
            e.need(node);
            let text = e.value(node);
            e.line(&format!("{} = {text};", shared.lazies[k]));
            if flagged {
                e.line(&format!("{} = 1;", shared.evaluated[k]));
            }
        };
        let status = self.known.lazies[k];
        // Evaluating again what needs no choice is shorter than asking.
        if status == Status::No || shared.without_inputs[k] || self.known.satisfies(node) {
            compute(self);
        } else {
            self.found.evaluated.insert(k);
            self.branch(&shared.evaluated[k], |_| (), compute);
        }
        self.known.lazies[k] = Status::Yes;
    }

    /// The text of an expression, which must be satisfied. Scratch variables of earlier ones are free again.
    pub(super) fn value(&mut self, node: &Node) -> String {
        self.scratch = 0;
        self.text(node)
    }

    /// A scratch variable with a value.
    pub(super) fn keep(&mut self, text: &str) -> String {
        let name = scratch(self.scratch);
        self.scratch += 1;
        self.found.scratch = self.found.scratch.max(self.scratch);
        self.line(&format!("{name} = {text};"));
        name
    }

    /// The text of an expression that will stand several times.
    pub(super) fn small(&mut self, node: &Node) -> String {
        let text = self.text(node);
        if node.size() <= SMALL && !matches!(node, Node::Min(_) | Node::Max(_)) {
            text
        } else {
            self.keep(&text)
        }
    }

    /// What is evaluated without being needed has a value too: every variable always holds one of its range.
    pub(super) fn text(&mut self, node: &Node) -> String {
        match node {
            Node::Const(v) if *v < 0 => format!("({v})"),
            Node::Const(v) => v.to_string(),
            Node::Cell(space, k) => self.cell(*space, *k as usize),
            Node::Lazy(k) => {
                self.found.lazies.insert(*k as usize);
                self.shared.lazies[*k as usize].clone()
            }
            Node::Element {
                space,
                base,
                lo,
                len,
                index,
            } => {
                let k = self.small(index);
                let cells: Vec<String> = (*base..base + len)
                    .map(|cell| self.cell(*space, cell as usize))
                    .collect();
                pick(&k, *lo, cells)
            }
            Node::Not(a) => format!("!({})", self.text(a)),
            Node::Neg(a) => format!("(-({}))", self.text(a)),
            Node::Abs(a) => {
                let a = self.small(a);
                format!("({a} < 0 -> -({a}) : {a})")
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.text(a), self.text(b));
                format!("({a} {} {b})", operator(*op))
            }
            Node::Sel(g, a, b) => {
                let (g, a, b) = (self.text(g), self.text(a), self.text(b));
                format!("({g} -> {b} : {a})")
            }
            Node::Mux(k, values) => {
                let k = self.small(k);
                let values = values.iter().map(|v| self.text(v)).collect();
                pick(&k, 0, values)
            }
            Node::Min(values) => self.extreme("<", values),
            Node::Max(values) => self.extreme(">", values),
        }
    }

    pub(super) fn extreme(&mut self, order: &str, values: &[Node]) -> String {
        let Some((first, rest)) = values.split_first() else {
            return "0".to_owned();
        };
        let mut best = if rest.is_empty() {
            self.text(first)
        } else {
            self.small(first)
        };
        for (n, value) in rest.iter().enumerate() {
            let other = self.small(value);
            let text = format!("({best} {order} {other} -> {best} : {other})");
            best = if n + 1 < rest.len() {
                self.keep(&text)
            } else {
                text
            };
        }
        best
    }

    pub(super) fn cell(&mut self, space: Space, k: usize) -> String {
        let shared = self.shared;
        if matches!(space, Space::Before | Space::Now) {
            self.found.read.insert(k);
        }
        match space {
            // Folded where the index is constant.
            Space::Param => shared.folded.bound.values[k].to_string(),
            Space::Now => shared.states[k].clone(),
            Space::Before => {
                let (instance, begun) = self.at;
                let owner = shared.owner[k];
                if owner < instance || (owner == instance && begun) {
                    self.found.before.insert(k);
                    shared.before[k].clone()
                } else {
                    shared.states[k].clone()
                }
            }
            Space::Input => {
                self.found.inputs.insert(k);
                shared.inputs[k].clone()
            }
        }
    }
}

/// The one of `values` whose number is `k`; the first has number `first`, the last stands for all others.
fn pick(k: &str, first: i64, mut values: Vec<String>) -> String {
    let Some(mut text) = values.pop() else {
        return "0".to_owned();
    };
    for (n, value) in values.iter().enumerate().rev() {
        text = format!("({k} == {} -> {value} : {text})", first + n as i64);
    }
    text
}

fn operator(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::And => "&&",
        BinaryOp::Or => "||",
        BinaryOp::Xor | BinaryOp::Ne => "!=",
        BinaryOp::Eq => "==",
        BinaryOp::Lt => "<",
        BinaryOp::Gt => ">",
        BinaryOp::Le => "<=",
        BinaryOp::Ge => ">=",
        BinaryOp::Add => "+",
        BinaryOp::Sub => "-",
        BinaryOp::Mul => "*",
        BinaryOp::Div => "/",
        BinaryOp::Mod => "%",
    }
}
