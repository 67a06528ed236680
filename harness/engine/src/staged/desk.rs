//! Where the step of one instance is made: the cells that it may read, and all combinations of the inputs that it reads.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::{Memory, UNSET};

use super::plan::{Cell, Stage};

/// The cells of a cycle as far as one stage knows them.
pub(super) struct Desk {
    before: Vec<i32>,
    now: Vec<i32>,
    inputs: Vec<i32>,
    names: Vec<i32>,
    ranges: Vec<(i32, i32)>,
    /// The inputs read here, in this order, with their values; the last one turns fastest.
    choices: Vec<(usize, i32)>,
    at: usize,
    rule: usize,
}

impl Desk {
    pub(super) fn new(bound: &Bound) -> Self {
        Self {
            before: vec![UNSET; bound.states.len()],
            now: vec![UNSET; bound.states.len()],
            inputs: vec![UNSET; bound.inputs.len()],
            names: vec![UNSET; bound.system.lazies.len()],
            ranges: bound.inputs.clone(),
            choices: Vec::new(),
            at: 0,
            rule: 0,
        }
    }

    /// The first combination comes next.
    pub(super) fn begin(&mut self) {
        self.choices.clear();
    }

    /// Lays out what a stage may look at: state variables before the cycle, and what was left to it.
    pub(super) fn start(&mut self, before: &[i32], stage: &Stage, cells: &[Cell], values: &[i32]) {
        self.at = 0;
        self.rule = 0;
        self.inputs.fill(UNSET);
        self.names.fill(UNSET);
        self.before.fill(UNSET);
        self.now.fill(UNSET);
        for k in &stage.reads {
            self.before[*k] = before[*k];
            // Its own variables, and those of instances that have made no step yet.
            self.now[*k] = before[*k];
        }
        for (cell, value) in cells.iter().zip(values) {
            match cell {
                Cell::Now(k) => self.now[*k] = *value,
                Cell::Input(k) => self.inputs[*k] = *value,
                Cell::Named(k) => self.names[*k] = *value,
            }
        }
    }

    /// The values of these cells.
    pub(super) fn class(&self, cells: &[Cell]) -> Box<[i32]> {
        let value = |cell: &Cell| match cell {
            Cell::Now(k) => self.now[*k],
            Cell::Input(k) => self.inputs[*k],
            Cell::Named(k) => self.names[*k],
        };
        cells.iter().map(value).collect()
    }

    pub(super) fn after(&self, k: usize) -> i32 {
        self.now[k]
    }

    /// The rule that fired, from 0.
    pub(super) fn rule(&self) -> Option<usize> {
        self.rule.checked_sub(1)
    }

    /// The combinations of the inputs read here.
    pub(super) fn combinations(&self) -> u64 {
        let sizes = self.choices[..self.at].iter().map(|(k, _)| {
            let (lo, hi) = self.ranges[*k];
            u64::from(hi.abs_diff(lo)) + 1
        });
        sizes.product()
    }

    /// The next combination; false if there is none.
    pub(super) fn advance(&mut self) -> bool {
        self.choices.truncate(self.at);
        while let Some((k, value)) = self.choices.last_mut() {
            if *value < self.ranges[*k].1 {
                *value += 1;
                return true;
            }
            self.choices.pop();
        }
        false
    }
}

impl Memory for Desk {
    fn before(&mut self, k: usize) -> i32 {
        debug_assert_ne!(self.before[k], UNSET, "more is read than was foreseen");
        self.before[k]
    }

    fn now(&mut self, k: usize) -> i32 {
        debug_assert_ne!(self.now[k], UNSET, "more is read than was foreseen");
        self.now[k]
    }

    fn input(&mut self, k: usize) -> i32 {
        if self.inputs[k] == UNSET {
            if self.at == self.choices.len() {
                self.choices.push((k, self.ranges[k].0));
            }
            let (asked, value) = self.choices[self.at];
            debug_assert_eq!(asked, k, "the same answers led to another question");
            self.at += 1;
            self.inputs[k] = value;
        }
        self.inputs[k]
    }

    fn named(&mut self, k: usize) -> Option<i32> {
        Some(self.names[k]).filter(|value| *value != UNSET)
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
