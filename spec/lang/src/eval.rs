//! The interpreter: one step of a system over the cells of a cycle.

use crate::bind::Bound;
use crate::ir::{BinaryOp, Lazy, Node, Space, Stmt};

/// Marks a cell that has no value yet in this cycle. No variable can have this value.
pub const UNSET: i32 = i32::MIN;

/// The values of one cycle.
#[derive(Debug, PartialEq, Eq)]
pub struct Frame {
    /// State at the start of the cycle.
    pub before: Vec<i32>,
    /// State as the rules have changed it.
    pub now: Vec<i32>,
    /// Inputs, [`UNSET`] until read.
    pub inputs: Vec<i32>,
    /// Named expressions, [`UNSET`] until evaluated.
    pub lazies: Vec<i32>,
    /// For each instance the number of the rule that fired, from 1; 0 for none.
    pub fired: Vec<i32>,
}

impl Clone for Frame {
    fn clone(&self) -> Self {
        Self {
            before: self.before.clone(),
            now: self.now.clone(),
            inputs: self.inputs.clone(),
            lazies: self.lazies.clone(),
            fired: self.fired.clone(),
        }
    }

    // The explorer copies frames all the time: without new memory.
    fn clone_from(&mut self, other: &Self) {
        self.before.clone_from(&other.before);
        self.now.clone_from(&other.now);
        self.inputs.clone_from(&other.inputs);
        self.lazies.clone_from(&other.lazies);
        self.fired.clone_from(&other.fired);
    }
}

impl Frame {
    /// A frame without cells.
    pub(crate) fn empty() -> Self {
        Self {
            before: Vec::new(),
            now: Vec::new(),
            inputs: Vec::new(),
            lazies: Vec::new(),
            fired: Vec::new(),
        }
    }

    /// A frame for `bound`, with nothing set.
    pub fn new(bound: &Bound) -> Self {
        let s = &bound.system;
        Self {
            before: vec![UNSET; s.states.len()],
            now: vec![UNSET; s.states.len()],
            inputs: vec![UNSET; s.inputs.len()],
            lazies: vec![UNSET; s.lazies.len()],
            fired: vec![0; s.instances.len()],
        }
    }

    /// Starts a cycle in state `before`.
    pub fn start(&mut self, before: &[i32]) {
        self.before.copy_from_slice(before);
        self.now.copy_from_slice(before);
        self.inputs.fill(UNSET);
        self.lazies.fill(UNSET);
        self.fired.fill(0);
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Cells<'a> {
    pub params: &'a [i32],
    pub lazies: &'a [Lazy],
}

/// Reads input `k` from the environment.
pub trait Read: FnMut(usize) -> i32 {}
impl<F: FnMut(usize) -> i32> Read for F {}

/// The cells of one cycle as the interpreter meets them: it reads and writes nothing else. So what it does is a function of what
/// it has read here.
pub trait Memory {
    /// State variable `k` at the start of the cycle.
    fn before(&mut self, k: usize) -> i32;
    /// State variable `k` as the rules have changed it.
    fn now(&mut self, k: usize) -> i32;
    /// Input `k`, the same in the whole cycle.
    fn input(&mut self, k: usize) -> i32;
    /// Named expression `k`, if it has been evaluated in this cycle.
    fn named(&mut self, k: usize) -> Option<i32>;
    /// Assigns to state variable `k`.
    fn assign(&mut self, k: usize, value: i32);
    /// Named expression `k` has been evaluated.
    fn name(&mut self, k: usize, value: i32);
    /// In the step of an instance the rule of this number fired, from 1; 0 for none.
    fn fired(&mut self, _instance: usize, _rule: usize) {}
}

/// A frame whose inputs are read from the environment when they are first needed.
pub(crate) struct Driven<'a, R> {
    pub frame: &'a mut Frame,
    pub read: &'a mut R,
}

impl<R: Read> Memory for Driven<'_, R> {
    fn before(&mut self, k: usize) -> i32 {
        self.frame.before[k]
    }

    fn now(&mut self, k: usize) -> i32 {
        self.frame.now[k]
    }

    fn input(&mut self, k: usize) -> i32 {
        let cell = &mut self.frame.inputs[k];
        if *cell == UNSET {
            *cell = (self.read)(k);
        }
        *cell
    }

    fn named(&mut self, k: usize) -> Option<i32> {
        Some(self.frame.lazies[k]).filter(|v| *v != UNSET)
    }

    fn assign(&mut self, k: usize, value: i32) {
        self.frame.now[k] = value;
    }

    fn name(&mut self, k: usize, value: i32) {
        self.frame.lazies[k] = value;
    }

    fn fired(&mut self, instance: usize, rule: usize) {
        self.frame.fired[instance] = rule as i32;
    }
}

impl Bound {
    fn cells(&self) -> Cells<'_> {
        Cells {
            params: &self.values,
            lazies: &self.system.lazies,
        }
    }

    /// One step from the state with which the frame was started; `read(k)` gives input `k` when it is first needed.
    ///
    /// # Errors
    /// The index of the assignment (in `system.sites`) whose value left its range.
    pub fn step(&self, f: &mut Frame, read: &mut impl Read) -> Result<(), u32> {
        (0..self.system.instances.len()).try_for_each(|k| self.step_instance(k, f, read))
    }

    /// The step of instance `k` alone, after those of the instances before it.
    ///
    /// # Errors
    /// As [`Bound::step`].
    pub fn step_instance(&self, k: usize, f: &mut Frame, read: &mut impl Read) -> Result<(), u32> {
        self.step_over(k, &mut Driven { frame: f, read })
    }

    /// The step of instance `k` over any memory.
    ///
    /// # Errors
    /// As [`Bound::step`].
    pub fn step_over(&self, k: usize, m: &mut impl Memory) -> Result<(), u32> {
        let cells = self.cells();
        let rules = &self.system.instances[k].rules;
        let mut fired = 0;
        for (n, rule) in rules.iter().enumerate() {
            if value(&rule.when, cells, m) != 0 {
                fired = n + 1;
                break;
            }
        }
        m.fired(k, fired);
        match fired {
            0 => Ok(()),
            _ => self.run(&rules[fired - 1].then, m),
        }
    }

    fn run(&self, list: &[Stmt], m: &mut impl Memory) -> Result<(), u32> {
        let cells = self.cells();
        for s in list {
            match s {
                Stmt::Assign {
                    base,
                    index,
                    value: node,
                    checked,
                    site,
                } => {
                    let offset = match index {
                        Some((k, lo, _)) => (value(k, cells, m) - lo) as usize,
                        None => 0,
                    };
                    let v = value(node, cells, m);
                    let cell = *base as usize + offset;
                    let (lo, hi) = self.states[cell];
                    if *checked && (v < i64::from(lo) || v > i64::from(hi)) {
                        return Err(*site);
                    }
                    m.assign(cell, v as i32);
                }
                Stmt::If(branches, rest) => {
                    let mut body = rest;
                    for (g, then) in branches {
                        if value(g, cells, m) != 0 {
                            body = then;
                            break;
                        }
                    }
                    self.run(body, m)?;
                }
            }
        }
        Ok(())
    }

    /// Atom `k` over the cycle just made.
    pub fn atom(&self, k: usize, f: &mut Frame, read: &mut impl Read) -> bool {
        self.value(&self.system.atoms[k], f, read) != 0
    }

    /// Observed expression `k` over the cycle just made.
    pub fn observe(&self, k: usize, f: &mut Frame, read: &mut impl Read) -> i64 {
        self.value(&self.system.observed[k], f, read)
    }

    /// Named expression `k` over the cycle just made.
    pub fn lazy(&self, k: usize, f: &mut Frame, read: &mut impl Read) -> i64 {
        self.value(&Node::Lazy(k as u32), f, read)
    }

    /// Any expression of this system over the cycle just made.
    pub fn value(&self, node: &Node, f: &mut Frame, read: &mut impl Read) -> i64 {
        self.value_over(node, &mut Driven { frame: f, read })
    }

    /// Any expression of this system over any memory.
    pub fn value_over(&self, node: &Node, m: &mut impl Memory) -> i64 {
        value(node, self.cells(), m)
    }
}

#[inline]
fn load(space: Space, k: usize, cells: Cells, m: &mut impl Memory) -> i64 {
    i64::from(match space {
        Space::Param => cells.params[k],
        Space::Before => m.before(k),
        Space::Now => m.now(k),
        Space::Input => m.input(k),
    })
}

/// Value of a part of an expression. Most parts are single values, which need no call.
#[inline(always)]
fn part(node: &Node, cells: Cells, m: &mut impl Memory) -> i64 {
    match node {
        Node::Const(v) => *v,
        Node::Cell(space, k) => load(*space, *k as usize, cells, m),
        other => value(other, cells, m),
    }
}

/// Value of an expression. Truth values are 0 and 1.
pub(crate) fn value(node: &Node, cells: Cells, m: &mut impl Memory) -> i64 {
    match node {
        Node::Const(v) => *v,
        Node::Cell(space, k) => load(*space, *k as usize, cells, m),
        Node::Lazy(k) => {
            let k = *k as usize;
            let known = m.named(k).unwrap_or_else(|| {
                let v = value(&cells.lazies[k].value, cells, m) as i32;
                m.name(k, v);
                v
            });
            i64::from(known)
        }
        Node::Element {
            space,
            base,
            lo,
            index,
            ..
        } => {
            let offset = part(index, cells, m) - lo;
            load(*space, *base as usize + offset as usize, cells, m)
        }
        Node::Not(a) => i64::from(part(a, cells, m) == 0),
        Node::Neg(a) => -part(a, cells, m),
        Node::Abs(a) => part(a, cells, m).abs(),
        Node::Binary(op, a, b) => binary(*op, a, b, cells, m),
        Node::Sel(g, a, b) => {
            let chosen = if part(g, cells, m) == 0 { a } else { b };
            part(chosen, cells, m)
        }
        Node::Mux(k, values) => {
            let k = part(k, cells, m) as usize;
            part(&values[k], cells, m)
        }
        Node::Min(values) => {
            let mut least = i64::MAX;
            for v in values {
                least = least.min(value(v, cells, m));
            }
            least
        }
        Node::Max(values) => {
            let mut most = i64::MIN;
            for v in values {
                most = most.max(value(v, cells, m));
            }
            most
        }
    }
}

#[inline]
fn binary(op: BinaryOp, a: &Node, b: &Node, cells: Cells, m: &mut impl Memory) -> i64 {
    let x = part(a, cells, m);
    match op {
        BinaryOp::And if x == 0 => return 0,
        BinaryOp::Or if x != 0 => return 1,
        _ => {}
    }
    let y = part(b, cells, m);
    match op {
        BinaryOp::And | BinaryOp::Or => i64::from(y != 0),
        BinaryOp::Xor | BinaryOp::Ne => i64::from(x != y),
        BinaryOp::Eq => i64::from(x == y),
        BinaryOp::Lt => i64::from(x < y),
        BinaryOp::Gt => i64::from(x > y),
        BinaryOp::Le => i64::from(x <= y),
        BinaryOp::Ge => i64::from(x >= y),
        BinaryOp::Add => x + y,
        BinaryOp::Sub => x - y,
        BinaryOp::Mul => x * y,
        BinaryOp::Div => x / y,
        BinaryOp::Mod => x % y,
    }
}
