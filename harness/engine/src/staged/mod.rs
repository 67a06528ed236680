//! The steps of the instances as stages of a cycle, by the interpreter: what an instance does is a function of the state variables and
//! inputs that it may read, and of what the instances before it have left for it and for those after it.
//!
//! `plan` finds what that is. What an expression of a property, or a named expression, needs of the inputs is worked out as soon as
//! it can be, so that inputs are forgotten early. `desk` makes the step of one instance, `paths` keeps what it did, `steps` goes through all
//! combinations of its inputs.

mod conditions;
mod desk;
mod paths;
mod plan;
mod rows;
mod steps;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::UNSET;
use stillpoint_model::{Condition, Fault, Outcome, Stages};

use paths::Paths;
use plan::{Mark, Plan, Source};
use rows::Rows;
use steps::Steps;

/// The stages of a system; none if it has fewer than two instances, or one reads a name before what it names is known.
pub(crate) fn stages(bound: &Bound, conditions: &[Condition]) -> Option<Box<dyn Stages>> {
    let plan = Plan::new(bound, conditions)?;
    let mut classes: Vec<Rows> = plan.widths.iter().map(|width| Rows::new(*width)).collect();
    // Before the first stage nothing is known: class 0.
    classes[0].number(&vec![UNSET; plan.widths[0]]);
    Some(Box::new(Staged {
        paths: plan.stages.iter().map(|_| Paths::default()).collect(),
        classes,
        kept: Vec::new(),
        plan,
    }))
}

struct Staged {
    plan: Plan,
    /// Of each stage.
    paths: Vec<Paths>,
    /// What may be left, numbered, at each boundary; the first one is before the first stage.
    classes: Vec<Rows>,
    /// The row of a stage as it is where the step makes nothing.
    kept: Vec<i32>,
}

impl Stages for Staged {
    fn number(&self) -> usize {
        self.plan.stages.len()
    }

    fn reads(&self, stage: usize) -> &[usize] {
        &self.plan.stages[stage].reads
    }

    fn writes(&self, stage: usize) -> &[usize] {
        &self.plan.stages[stage].writes
    }

    fn combinations(&self, stage: usize) -> u64 {
        self.plan.stages[stage].combinations
    }

    fn outcomes(
        &mut self,
        stage: usize,
        before: &[i32],
        class: u32,
        list: &mut Vec<Outcome>,
    ) -> Result<(), Fault> {
        let own = &self.plan.stages[stage];
        let (left, leaves) = self.classes.split_at_mut(stage + 1);
        let left = left[stage].row(class);
        self.kept.clear();
        self.kept.extend(own.kept.iter().map(|source| match source {
            Some(Source::Before(k)) => before[*k],
            Some(Source::Left(place)) => left[*place],
            Some(Source::Free(_)) | None => UNSET,
        }));
        let mut steps = Steps {
            bound: &self.plan.bound,
            stage,
            own,
            paths: &mut self.paths[stage],
            before,
            left,
            kept: &self.kept,
            row: Vec::new(),
            leaves: &mut leaves[0],
            chosen: Vec::new(),
            list,
        };
        steps.from(0, own.combinations)
    }

    fn conditions(&self, class: u32) -> u128 {
        let last = self.plan.stages.len();
        let values = self.classes[last].row(class);
        let holds = |mark: &Mark| match mark {
            Mark::Fixed(holds) => *holds,
            Mark::At(place) => values[*place] != 0,
        };
        let bits = self.plan.marks.iter().enumerate();
        bits.fold(0, |all, (n, mark)| all | u128::from(holds(mark)) << n)
    }

    fn bytes(&self) -> u64 {
        let classes = self.classes.iter().map(Rows::bytes).sum::<u64>();
        classes + self.paths.iter().map(Paths::bytes).sum::<u64>()
    }
}
