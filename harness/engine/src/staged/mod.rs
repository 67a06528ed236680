//! The steps of the instances as stages of a cycle, by the interpreter: what an instance does is a function of the state variables and
//! inputs that it may read, and of what the instances before it have left for it and for those after it.
//!
//! `plan` finds what that is. What an expression of a property, or a named expression, needs of the inputs is worked out as soon as
//! it can be, so that inputs are forgotten early. `desk` makes the step of one instance.

mod conditions;
mod desk;
mod plan;

use foldhash::fast::FixedState;
use indexmap::IndexSet;
use stillpoint_lang::bind::Bound;
use stillpoint_model::{Condition, Fault, Outcome, Stages};

use desk::Desk;
use plan::{Mark, Plan};

/// The most input vectors of one step of an instance: so many are made without a look at the limits.
const MOST_VECTORS: u32 = 1 << 16;

/// The stages of a system; none if it has fewer than two instances, or one reads a name before what it names is known.
pub(crate) fn stages(bound: &Bound, conditions: &[Condition]) -> Option<Box<dyn Stages>> {
    let plan = Plan::new(bound, conditions)?;
    let classes = plan.boundaries.iter().map(|_| Classes::default());
    let mut staged = Staged {
        desk: Desk::new(&plan.bound),
        classes: classes.collect(),
        plan,
    };
    let first = staged.desk.class(&staged.plan.boundaries[0]);
    staged.classes[0].number(first);
    Some(Box::new(staged))
}

/// What a stage may leave to the next one, numbered.
#[derive(Default)]
struct Classes {
    values: IndexSet<Box<[i32]>, FixedState>,
    bytes: u64,
}

impl Classes {
    fn number(&mut self, values: Box<[i32]>) -> u32 {
        let bytes = size_of_val(&*values) as u64 + 48;
        let (number, fresh) = self.values.insert_full(values);
        if fresh {
            self.bytes += bytes;
        }
        number as u32
    }

    fn values(&self, number: u32) -> &[i32] {
        &self.values[number as usize]
    }
}

struct Staged {
    plan: Plan,
    desk: Desk,
    /// For each boundary, the first one being before the first stage.
    classes: Vec<Classes>,
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
        let Staged {
            plan,
            desk,
            classes,
        } = self;
        let own = &plan.stages[stage];
        let values = classes[stage].values(class);
        desk.start(before, own, &plan.boundaries[stage], values);
        let mut vectors = 0;
        loop {
            vectors += 1;
            if vectors > MOST_VECTORS {
                // The states that need it are made one by one.
                return Err(Fault::OUT_OF_DOMAIN);
            }
            let step = plan.bound.step_over(stage, desk);
            step.map_err(|code| Fault { code })?;
            for name in &own.forced {
                plan.bound.value_over(name, desk);
            }
            let class = desk.class(&plan.boundaries[stage + 1]);
            list.push(Outcome {
                after: own.writes.iter().map(|k| desk.after(*k)).collect(),
                class: classes[stage + 1].number(class),
                rule: desk.rule().map(|rule| own.first_rule + rule),
                share: own.combinations / desk.combinations(),
            });
            if !desk.advance() {
                return Ok(());
            }
        }
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
        self.classes.iter().map(|classes| classes.bytes).sum()
    }
}
