//! The steps of one instance from one state, with all combinations of its inputs.

use stillpoint_lang::bind::Bound;
use stillpoint_model::{Fault, Outcome};

use super::desk::Desk;
use super::paths::{End, Node, Paths, after};
use super::plan::{Source, Stage};
use super::rows::Rows;

/// The most input vectors of one step of an instance: so many are made without a look at the limits.
const MOST_VECTORS: usize = 1 << 16;

pub(super) struct Steps<'a> {
    pub(super) bound: &'a Bound,
    pub(super) stage: usize,
    pub(super) own: &'a Stage,
    pub(super) paths: &'a mut Paths,
    /// The state variables before the cycle, and what is left to the stage.
    pub(super) before: &'a [i32],
    pub(super) left: &'a [i32],
    /// The row of the stage where the step makes nothing, and where it was made.
    pub(super) kept: &'a [i32],
    pub(super) row: Vec<i32>,
    pub(super) leaves: &'a mut Rows,
    /// The values of the free inputs on the way.
    pub(super) chosen: Vec<i32>,
    pub(super) list: &'a mut Vec<Outcome>,
}

impl Steps<'_> {
    /// All steps from a node on, each with its share of so many combinations.
    pub(super) fn from(&mut self, mut at: u32, share: u64) -> Result<(), Fault> {
        loop {
            let next = match self.paths.node(at) {
                Some(Node::Ask(Source::Before(k), next)) => after(next, self.before[*k]),
                Some(Node::Ask(Source::Left(place), next)) => after(next, self.left[*place]),
                Some(Node::Ask(Source::Free(k), _)) => return self.each(at, *k, share),
                Some(Node::End(End::Step { made, rule })) => {
                    if self.list.len() == MOST_VECTORS {
                        // The states that need it are made one by one.
                        return Err(Fault::OUT_OF_DOMAIN);
                    }
                    self.row.clear();
                    self.row.extend_from_slice(self.kept);
                    for (place, value) in made {
                        self.row[*place as usize] = *value;
                    }
                    let (writes, leaves) = self.row.split_at(self.own.writes.len());
                    self.list.push(Outcome {
                        after: writes.to_vec(),
                        class: self.leaves.number(leaves),
                        rule: rule.checked_sub(1).map(|rule| self.own.first_rule + rule),
                        share,
                    });
                    return Ok(());
                }
                Some(Node::End(End::Fault(code))) => return Err(Fault { code: *code }),
                None => None,
            };
            match next {
                Some(next) => at = next,
                None => self.make(),
            }
        }
    }

    /// The same for each value of the free input that a node asks for.
    fn each(&mut self, at: u32, input: usize, share: u64) -> Result<(), Fault> {
        let (lo, hi) = self.bound.inputs[input];
        let share = share / (u64::from(hi.abs_diff(lo)) + 1);
        for value in lo..=hi {
            self.chosen.push(value);
            while let Some(Node::Ask(_, next)) = self.paths.node(at) {
                match after(next, value) {
                    Some(next) => {
                        self.from(next, share)?;
                        break;
                    }
                    None => self.make(),
                }
            }
            self.chosen.pop();
        }
        Ok(())
    }

    /// Has the interpreter make the step whose path is missing.
    #[cold]
    fn make(&mut self) {
        let mut desk = Desk::new(self.bound, self.own, self.before, self.left, &self.chosen);
        let step = self.bound.step_over(self.stage, &mut desk);
        let end = match step {
            Err(code) => End::Fault(code),
            Ok(()) => {
                for name in &self.own.forced {
                    self.bound.value_over(name, &mut desk);
                }
                let cells = self.own.row.iter().enumerate();
                let made = cells.filter_map(|(n, cell)| Some((n as u32, desk.made(*cell)?)));
                End::Step {
                    made: made.collect(),
                    rule: desk.rule,
                }
            }
        };
        let asked = desk.asked;
        self.paths.add(asked, end);
    }
}
