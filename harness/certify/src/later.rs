//! Live variables: which cells matter later in a cycle.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Node, Space};

use crate::cells::Layout;

/// What reads cells later on.
#[derive(Debug, Clone)]
pub(crate) struct Later {
    /// For each cell whether it is read.
    read: Vec<bool>,
    /// The cells that each named expression reads where it is evaluated.
    named: Vec<Vec<usize>>,
    first_named: usize,
}

impl Later {
    /// Nothing reads anything.
    pub(crate) fn new(bound: &Bound, layout: &Layout) -> Self {
        let cells = |value| {
            let mut cells = Vec::new();
            visit(value, layout, &mut |cell| cells.push(cell));
            cells
        };
        let named = bound.system.lazies.iter().map(|lazy| cells(&lazy.value));
        Self {
            read: vec![false; layout.named(bound.system.lazies.len())],
            named: named.collect(),
            first_named: layout.named(0),
        }
    }

    /// A cell is read.
    pub(crate) fn cell(&mut self, cell: usize) {
        self.read[cell] = true;
    }

    /// An expression is evaluated.
    pub(crate) fn node(&mut self, node: &Node, layout: &Layout) {
        visit(node, layout, &mut |cell| self.read[cell] = true);
    }

    /// All cells that may be read, where the named expressions in the cells `known` have their values already.
    pub(crate) fn all(&self, known: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut all = self.read.clone();
        let named = self.first_named..all.len();
        let mut todo: Vec<usize> = named.filter(|cell| all[*cell]).collect();
        while let Some(cell) = todo.pop() {
            if known(cell) {
                continue;
            }
            for inner in &self.named[cell - self.first_named] {
                if !std::mem::replace(&mut all[*inner], true) && *inner >= self.first_named {
                    todo.push(*inner);
                }
            }
        }
        all
    }
}

/// The cells that an expression itself may read, whatever the values.
fn visit(node: &Node, layout: &Layout, each: &mut impl FnMut(usize)) {
    node.visit(&mut |node| {
        let (space, range) = match node {
            Node::Lazy(k) => return each(layout.named(*k as usize)),
            Node::Cell(space, k) => (*space, *k..k + 1),
            Node::Element {
                space, base, len, ..
            } => (*space, *base..base + len),
            _ => return,
        };
        for k in range.map(|k| k as usize) {
            match space {
                Space::Before => each(layout.before(k)),
                Space::Now => each(layout.now(k)),
                Space::Input => each(layout.input(k)),
                Space::Param => {}
            }
        }
    });
}
