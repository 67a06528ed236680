//! Which lines of a program decide a cycle. What a program computes stands in the tables as named expressions
//! whose description begins with their line: `line 12: x := a AND b;`.

use std::collections::BTreeSet;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::Frame;
use stillpoint_lang::ir::{BinaryOp, Lazy, LazyKind, Node, Property};
use stillpoint_model::Trace;

use crate::{Cycle, replay};

/// A line of a program, and what it gave in a cycle.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Line {
    /// Its number, from 1.
    pub number: usize,
    /// What stands there.
    pub text: String,
    /// The value that it computed.
    pub value: String,
    /// So many cycles before the last one of the run.
    pub before: usize,
}

/// What these lines are, in words.
pub fn heading(lines: &[Line]) -> String {
    let when = match lines.first().map_or(0, |line| line.before) {
        0 => "what the program computes in the last cycle".to_owned(),
        1 => "what the program computed when it ran last, in the cycle before".to_owned(),
        n => format!("what the program computed when it ran last, {n} cycles before"),
    };
    format!("{when}, as far as it decides this")
}

/// The lines that decide what a property says of the last cycle of a run, in the order of the program: for a choice the branch
/// that was taken, for AND and OR the operand that decides. Where the property reads nothing of the program itself, the lines that
/// decide what the program gives in that cycle. A program that has a cycle of its own need not run in that one: then it is the cycle in
/// which it ran last. None where no program is part of the system.
pub fn deciding(bound: &Bound, property: &Property, trace: &Trace) -> Vec<Line> {
    let told = bound.system.lazies.iter();
    let told = told.filter(|lazy| line(&lazy.text).is_some());
    let programs: BTreeSet<Option<&str>> = told.map(|lazy| instance(&lazy.name)).collect();
    if programs.is_empty() {
        return Vec::new();
    }
    let several = programs.len() > 1;
    let cycles = replay(bound, trace);
    let latest = cycles.iter().rev().enumerate();
    let mut found =
        latest.map(|(before, cycle)| Search::new(bound, cycle, before, several).of(property));
    found.find(|lines| !lines.is_empty()).unwrap_or_default()
}

/// The line of a program that the text of a named expression begins with.
fn line(text: &str) -> Option<(usize, &str)> {
    let (number, text) = text.strip_prefix("line ")?.split_once(": ")?;
    Some((number.parse().ok()?, text))
}

/// The instance that a name belongs to.
fn instance(name: &str) -> Option<&str> {
    name.split_once('.').map(|(instance, _)| instance)
}

struct Search<'a> {
    bound: &'a Bound,
    cycle: &'a Cycle,
    /// How many cycles come after it.
    before: usize,
    /// Several programs have lines: each is told with the instance that it belongs to.
    several: bool,
    seen: BTreeSet<u32>,
    lines: BTreeSet<Line>,
}

impl<'a> Search<'a> {
    fn new(bound: &'a Bound, cycle: &'a Cycle, before: usize, several: bool) -> Self {
        Self {
            bound,
            cycle,
            before,
            several,
            seen: BTreeSet::new(),
            lines: BTreeSet::new(),
        }
    }

    /// The lines that decide the property, if this is the last cycle; where there are none, those that decide what the program gives.
    fn of(mut self, property: &Property) -> Vec<Line> {
        if self.before == 0 {
            let system = &self.bound.system;
            let (atoms, observed) = property.form.expressions();
            atoms.iter().for_each(|k| self.visit(&system.atoms[*k]));
            let observed = observed.iter();
            observed.for_each(|k| self.visit(&system.observed[*k]));
        }
        if self.lines.is_empty() {
            self.outputs();
        }
        self.lines.into_iter().collect()
    }

    fn value(&self, node: &Node) -> i64 {
        let mut frame: Frame = self.cycle.frame.clone();
        // An input that nobody read decides nothing: any value will do.
        self.bound
            .value(node, &mut frame, &mut |i| self.bound.inputs[i].0)
    }

    /// What a property does not read of the program acts through what the program gives: everything that it gives.
    fn outputs(&mut self) {
        let lazies = &self.bound.system.lazies;
        let told = lazies.iter().filter(|lazy| line(&lazy.text).is_some());
        let of: BTreeSet<&str> = told.filter_map(|lazy| instance(&lazy.name)).collect();
        let given = |lazy: &Lazy| {
            lazy.kind == LazyKind::Output && instance(&lazy.name).is_some_and(|i| of.contains(i))
        };
        let given = (0..).zip(lazies).filter(|(_, lazy)| given(lazy));
        let given: Vec<u32> = given.map(|(k, _)| k).collect();
        given.into_iter().for_each(|k| self.visit(&Node::Lazy(k)));
    }

    /// Adds the line of a named expression, if it has one.
    fn note(&mut self, k: u32) {
        let lazy = &self.bound.system.lazies[k as usize];
        let Some((number, text)) = line(&lazy.text) else {
            return;
        };
        let value = self.value(&Node::Lazy(k));
        let text = match instance(&lazy.name).filter(|_| self.several) {
            Some(program) => format!("{program}: {text}"),
            None => text.to_owned(),
        };
        self.lines.insert(Line {
            number,
            text,
            value: self.bound.system.show(lazy.ty, value),
            before: self.before,
        });
    }

    fn visit(&mut self, node: &Node) {
        match node {
            Node::Lazy(k) => {
                if self.seen.insert(*k) {
                    self.note(*k);
                    let bound = self.bound;
                    self.visit(&bound.system.lazies[*k as usize].value);
                }
            }
            Node::Sel(guard, no, yes) => {
                // Why the branch was taken is its own line's matter.
                if let Node::Lazy(k) = **guard {
                    self.note(k);
                }
                let taken = self.value(guard) != 0;
                self.visit(if taken { yes } else { no });
            }
            Node::Binary(op @ (BinaryOp::And | BinaryOp::Or), a, b) => {
                let decides = i64::from(*op == BinaryOp::Or);
                match (self.value(a) == decides, self.value(b) == decides) {
                    (true, _) => self.visit(a),
                    (false, true) => self.visit(b),
                    (false, false) => {
                        self.visit(a);
                        self.visit(b);
                    }
                }
            }
            _ => node
                .children()
                .into_iter()
                .for_each(|part| self.visit(part)),
        }
    }
}
