//! The steps of the instances as stages of a cycle, by the interpreter: what an instance does is a function of the state variables and
//! inputs that it may read, and of what the instances before it have left for it and for those after it.
//!
//! `plan` finds what that is. What an expression of a property, or a named expression, needs of the inputs is worked out as soon as
//! it can be, so that inputs are forgotten early. `desk` makes the step of one instance.

mod conditions;
mod desk;
mod plan;
mod recall;

use foldhash::fast::FixedState;
use indexmap::IndexSet;
use std::sync::{Arc, Mutex, PoisonError};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::UNSET;
use stillpoint_model::{Condition, Fault, Outcome, Stages};

use desk::Desk;
use plan::{Mark, Plan};
use recall::{Recall, given};

/// The most input vectors of one step of an instance: so many are made without a look at the limits.
const MOST_VECTORS: usize = 1 << 16;

/// A plan and its conditions; none if the system has no stages.
type Planned = (Vec<Condition>, Option<Arc<Plan>>);

/// The plan made last: each thread asks for the same.
#[derive(Default)]
pub(crate) struct Plans(Mutex<Option<Planned>>);

impl Plans {
    fn plan(&self, bound: &Bound, conditions: &[Condition]) -> Option<Arc<Plan>> {
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &*last {
            Some((of, plan)) if *of == conditions => plan.clone(),
            _ => {
                let plan = Plan::new(bound, conditions).map(Arc::new);
                *last = Some((conditions.to_vec(), plan.clone()));
                plan
            }
        }
    }
}

/// The stages of a system; none if it has fewer than two instances, or one reads a name before what it names is known.
pub(crate) fn stages(
    plans: &Plans,
    bound: &Bound,
    conditions: &[Condition],
) -> Option<Box<dyn Stages>> {
    let plan = plans.plan(bound, conditions)?;
    let classes = plan.boundaries.iter().map(|_| Classes::default());
    let recalls = plan.stages.iter().map(|_| Recall::default());
    let mut staged = Staged {
        desk: Desk::new(&plan.bound),
        classes: classes.collect(),
        recalls: recalls.collect(),
        values: Vec::new(),
        plan,
    };
    let first = staged.plan.boundaries[0].iter().map(|_| UNSET);
    let first: Vec<i32> = first.collect();
    staged.classes[0].number(&first);
    Some(Box::new(staged))
}

/// What a stage may leave to the next one, numbered.
#[derive(Default)]
struct Classes {
    values: IndexSet<Box<[i32]>, FixedState>,
    bytes: u64,
}

impl Classes {
    fn number(&mut self, values: &[i32]) -> u32 {
        let number = self.values.get_index_of(values).unwrap_or_else(|| {
            self.bytes += size_of_val(values) as u64 + 48;
            self.values.insert_full(values.into()).0
        });
        number as u32
    }

    fn values(&self, number: u32) -> &[i32] {
        &self.values[number as usize]
    }
}

struct Staged {
    plan: Arc<Plan>,
    desk: Desk,
    /// For each boundary, the first one being before the first stage.
    classes: Vec<Classes>,
    /// For each stage.
    recalls: Vec<Recall>,
    /// Of one outcome: after the cycle, and what is left.
    values: Vec<i32>,
}

impl Staged {
    /// Has a stage make its outcomes. The number of what is made.
    fn make(&mut self, stage: usize, before: &[i32], class: u32) -> u32 {
        let Staged {
            plan,
            desk,
            classes,
            recalls,
            ..
        } = self;
        let own = &plan.stages[stage];
        let values = classes[stage].values(class);
        desk.start(before, own, &plan.boundaries[stage], values);
        let recall = &mut recalls[stage];
        recall.begin();
        let mut vectors = 0;
        let fault = loop {
            if vectors == MOST_VECTORS {
                // The states that need it are made one by one.
                break Some(Fault::OUT_OF_DOMAIN);
            }
            if let Err(code) = plan.bound.step_over(stage, desk) {
                break Some(Fault { code });
            }
            for name in &own.forced {
                plan.bound.value_over(name, desk);
            }
            vectors += 1;
            let after = own.writes.iter().map(|k| desk.after(*k));
            let left = plan.boundaries[stage + 1].iter();
            let left = left.map(|cell| desk.left(*cell));
            let rule = desk.rule().map(|rule| own.first_rule + rule);
            let share = own.combinations / desk.combinations();
            recall.push(after.chain(left), rule, share);
            if !desk.advance(own) {
                break None;
            }
        };
        recall.add(desk.asked(), fault)
    }
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
        each: &mut dyn FnMut(Outcome),
    ) -> Result<(), Fault> {
        let reads = &self.plan.stages[stage].reads;
        let values = self.classes[stage].values(class);
        let known = self.recalls[stage].find(given(reads, before, values));
        let end = known.unwrap_or_else(|| self.make(stage, before, class));
        let (own, recall) = (&self.plan.stages[stage], &self.recalls[stage]);
        let (earlier, later) = self.classes.split_at_mut(stage + 1);
        let given = given(&own.reads, before, earlier[stage].values(class));
        let (writes, left) = (own.writes.len(), self.plan.boundaries[stage + 1].len());
        for one in recall.made(end)? {
            let parts = recall.parts(one)[..writes + left].iter();
            self.values.clear();
            self.values.extend(parts.map(|part| part.value(&given)));
            let (after, left) = self.values.split_at(writes);
            each(Outcome {
                after,
                class: later[0].number(left),
                rule: one.rule,
                share: one.share,
            });
        }
        Ok(())
    }

    fn conditions(&self, class: u32) -> u128 {
        let last = self.plan.stages.len();
        let values = self.classes[last].values(class);
        let holds = |mark: &Mark| match mark {
            Mark::Fixed(holds) => *holds,
            Mark::At(place) => values[*place] != 0,
        };
        let bits = self.plan.marks.iter().enumerate();
        bits.fold(0, |all, (n, mark)| all | u128::from(holds(mark)) << n)
    }

    fn bytes(&self) -> u64 {
        let recalls = self.recalls.iter().map(Recall::bytes);
        let classes = self.classes.iter().map(|classes| classes.bytes);
        recalls.chain(classes).sum()
    }

    fn forget(&mut self) {
        self.recalls.fill_with(Recall::default);
    }
}
