//! Where the step of one instance is made: the cells that it may read, and all combinations of the inputs that it reads.

use std::sync::Arc;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::{Memory, UNSET};

use super::plan::{Cell, Stage};
use super::recall::{NONE, Part, Places};

/// The cells of a cycle as far as one stage knows them.
pub(super) struct Desk {
    before: Vec<i32>,
    now: Vec<i32>,
    inputs: Vec<i32>,
    names: Vec<i32>,
    ranges: Vec<(i32, i32)>,
    /// The state variables as the step finds them.
    found: Vec<i32>,
    /// The inputs read here, in this order, with their values; the last one turns fastest.
    choices: Vec<(usize, i32)>,
    at: usize,
    /// The names evaluated here, in this order, each with the number of inputs read until then.
    log: Vec<(usize, usize)>,
    rule: usize,
    /// The state variables assigned in this combination.
    assigned: Vec<bool>,
    /// The places of the given values, and which of them were not asked for yet.
    places: Arc<Places>,
    unasked: Vec<bool>,
    /// What was asked for in all combinations, in this order, and the answers.
    asked: Vec<(u32, i32)>,
}

impl Desk {
    pub(super) fn new(bound: &Bound) -> Self {
        Self {
            before: vec![UNSET; bound.states.len()],
            now: vec![UNSET; bound.states.len()],
            inputs: vec![UNSET; bound.inputs.len()],
            names: vec![UNSET; bound.system.lazies.len()],
            ranges: bound.inputs.clone(),
            found: vec![UNSET; bound.states.len()],
            choices: Vec::new(),
            at: 0,
            log: Vec::new(),
            rule: 0,
            assigned: vec![false; bound.states.len()],
            places: Arc::default(),
            unasked: Vec::new(),
            asked: Vec::new(),
        }
    }

    /// Lays out what a stage may look at: state variables before the cycle, and what was left to it. The first combination comes next.
    pub(super) fn start(&mut self, before: &[i32], stage: &Stage, cells: &[Cell], values: &[i32]) {
        self.choices.clear();
        self.log.clear();
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
        self.found.copy_from_slice(&self.now);
        self.assigned.fill(false);
        self.places = Arc::clone(&stage.places);
        self.unasked.clear();
        self.unasked.resize(stage.reads.len() + cells.len(), true);
        self.asked.clear();
    }

    /// What a step leaves in a cell.
    pub(super) fn left(&self, cell: Cell) -> Part {
        let (place, own) = match cell {
            Cell::Now(k) => return self.after(k),
            Cell::Input(k) => (self.places.inputs[k], self.inputs[k]),
            Cell::Named(k) => (self.places.names[k], self.names[k]),
        };
        // What was given and asked for is the same wherever this is recalled.
        match place == NONE || !self.unasked[place as usize] {
            true => Part::Own(own),
            false => Part::Given(place),
        }
    }

    /// What a step leaves in a state variable.
    pub(super) fn after(&self, k: usize) -> Part {
        match self.assigned[k] {
            true => Part::Own(self.now[k]),
            false => Part::Given(self.places.now[k]),
        }
    }

    /// Notes a question for a given value, and its answer.
    #[inline]
    fn ask(&mut self, place: u32, answer: i32) {
        if place != NONE && std::mem::replace(&mut self.unasked[place as usize], false) {
            self.asked.push((place, answer));
        }
    }

    /// What was asked for, by place, and the answers.
    pub(super) fn asked(&self) -> &[(u32, i32)] {
        &self.asked
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
    ///
    /// The step up to the first input that has another value is what it was. So the inputs before it count as read, and what was
    /// named before it was read keeps its value.
    pub(super) fn advance(&mut self, stage: &Stage) -> bool {
        self.choices.truncate(self.at);
        while let Some((k, value)) = self.choices.last_mut() {
            self.inputs[*k] = UNSET;
            if *value < self.ranges[*k].1 {
                *value += 1;
                self.at = self.choices.len() - 1;
                self.rule = 0;
                self.now.copy_from_slice(&self.found);
                stage.writes.iter().for_each(|k| self.assigned[*k] = false);
                let kept = self.log.partition_point(|(_, read)| *read <= self.at);
                for (name, _) in self.log.drain(kept..) {
                    self.names[name] = UNSET;
                }
                return true;
            }
            self.choices.pop();
        }
        false
    }
}

impl Memory for Desk {
    #[inline]
    fn before(&mut self, k: usize) -> i32 {
        debug_assert_ne!(self.before[k], UNSET, "more is read than was foreseen");
        self.ask(self.places.before[k], self.before[k]);
        self.before[k]
    }

    #[inline]
    fn now(&mut self, k: usize) -> i32 {
        debug_assert_ne!(self.now[k], UNSET, "more is read than was foreseen");
        if !self.assigned[k] {
            self.ask(self.places.now[k], self.now[k]);
        }
        self.now[k]
    }

    #[inline]
    fn input(&mut self, k: usize) -> i32 {
        self.ask(self.places.inputs[k], self.inputs[k]);
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

    #[inline]
    fn named(&mut self, k: usize) -> Option<i32> {
        self.ask(self.places.names[k], self.names[k]);
        Some(self.names[k]).filter(|value| *value != UNSET)
    }

    #[inline]
    fn assign(&mut self, k: usize, value: i32) {
        self.now[k] = value;
        self.assigned[k] = true;
    }

    #[inline]
    fn name(&mut self, k: usize, value: i32) {
        self.names[k] = value;
        self.log.push((k, self.at));
    }

    #[inline]
    fn fired(&mut self, _: usize, rule: usize) {
        self.rule = rule;
    }
}
