//! Where the step of one instance is made: the cells that it may read, and a record of what it asked for.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::{Memory, UNSET};

use super::plan::{Cell, Source, Stage};

/// The cells of a cycle as far as one step has asked for them.
pub(super) struct Desk<'a> {
    stage: &'a Stage,
    before: &'a [i32],
    left: &'a [i32],
    /// The values of free inputs, in the order in which they are asked for; those that are missing are their least ones.
    chosen: &'a [i32],
    ranges: &'a [(i32, i32)],
    free: usize,
    /// State variables that were assigned, inputs that were read, names that were evaluated.
    now: Vec<i32>,
    inputs: Vec<i32>,
    names: Vec<i32>,
    /// Each question once, with the answer.
    pub(super) asked: Vec<(Source, i32)>,
    /// The rule that fired, from 1; 0 for none.
    pub(super) rule: usize,
}

impl<'a> Desk<'a> {
    pub(super) fn new(
        bound: &'a Bound,
        stage: &'a Stage,
        before: &'a [i32],
        left: &'a [i32],
        chosen: &'a [i32],
    ) -> Self {
        Self {
            stage,
            before,
            left,
            chosen,
            ranges: &bound.inputs,
            free: 0,
            now: vec![UNSET; bound.states.len()],
            inputs: vec![UNSET; bound.inputs.len()],
            names: vec![UNSET; bound.system.lazies.len()],
            asked: Vec::new(),
            rule: 0,
        }
    }

    /// The value that the step has given to a cell; none if the cell is as it was.
    pub(super) fn made(&self, cell: Cell) -> Option<i32> {
        let value = match cell {
            Cell::Now(k) => self.now[k],
            Cell::Input(k) => self.inputs[k],
            Cell::Named(k) => self.names[k],
        };
        Some(value).filter(|value| *value != UNSET)
    }

    fn ask(&mut self, source: Source) -> i32 {
        // A step asks for few cells.
        if let Some((_, value)) = self.asked.iter().find(|(old, _)| *old == source) {
            return *value;
        }
        let value = match source {
            Source::Before(k) => {
                let foreseen = self.stage.reads.binary_search(&k).is_ok();
                debug_assert!(foreseen, "more is read than was foreseen");
                self.before[k]
            }
            Source::Left(place) => self.left[place],
            Source::Free(k) => {
                self.free += 1;
                let chosen = self.chosen.get(self.free - 1);
                chosen.copied().unwrap_or(self.ranges[k].0)
            }
        };
        self.asked.push((source, value));
        value
    }

    /// A cell that this step has not made.
    fn found(&mut self, cell: Cell) -> i32 {
        self.stage
            .source(cell)
            .map_or(UNSET, |source| self.ask(source))
    }
}

impl Memory for Desk<'_> {
    fn before(&mut self, k: usize) -> i32 {
        self.ask(Source::Before(k))
    }

    fn now(&mut self, k: usize) -> i32 {
        match self.now[k] {
            UNSET => self.found(Cell::Now(k)),
            value => value,
        }
    }

    fn input(&mut self, k: usize) -> i32 {
        if self.inputs[k] == UNSET {
            self.inputs[k] = match self.found(Cell::Input(k)) {
                UNSET => self.ask(Source::Free(k)),
                value => value,
            };
        }
        self.inputs[k]
    }

    fn named(&mut self, k: usize) -> Option<i32> {
        if self.names[k] == UNSET {
            self.names[k] = self.found(Cell::Named(k));
        }
        self.made(Cell::Named(k))
    }

    fn assign(&mut self, k: usize, value: i32) {
        self.now[k] = value;
    }

    fn name(&mut self, k: usize, value: i32) {
        self.names[k] = value;
    }

    fn fired(&mut self, _: usize, rule: usize) {
        self.rule = rule;
    }
}
