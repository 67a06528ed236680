//! Specification tables as systems to explore: interpreted, or through their generated step functions.

use std::sync::OnceLock;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval;
use stillpoint_lang::ir;
use stillpoint_model::{
    Choices, Component, Condition, Domain, Fault, Form, Property, Stages, System,
};
use stillpoint_native::{Family, Table};

use crate::staged;

static FAMILIES: OnceLock<&'static [Family]> = OnceLock::new();

/// Gives the program generated tables; only the first call counts. Without them every table is interpreted.
///
/// The engine does not name their crates, so that an edit of a table does not build the engine.
pub fn provide(families: &'static [Family]) {
    let _ = FAMILIES.set(families);
}

/// The generated table of a system, if it was generated from exactly this specification.
pub fn find(bound: &Bound) -> Option<&'static Table> {
    let (name, fingerprint) = (&bound.system.name, bound.system.fingerprint());
    let families = FAMILIES.get().copied().unwrap_or_default().iter();
    let mut tables = families.flat_map(|family| family.tables);
    tables.find(|table| table.name == *name && table.fingerprint == fingerprint)
}

/// What both evaluators share: ranges, and where the rules of each machine start.
struct Shape {
    domains: Vec<Domain>,
    inputs: Vec<(i32, u32)>,
    first_rule: Vec<usize>,
    rules: usize,
    combinations: u128,
    plans: staged::Plans,
}

impl Shape {
    fn new(bound: &Bound) -> Self {
        let mut first_rule = Vec::new();
        let mut rules = 0;
        for instance in &bound.system.instances {
            first_rule.push(rules);
            rules += instance.rules.len();
        }
        Self {
            domains: bound
                .states
                .iter()
                .map(|(lo, hi)| Domain { lo: *lo, hi: *hi })
                .collect(),
            inputs: bound
                .inputs
                .iter()
                .map(|(lo, hi)| {
                    (
                        *lo,
                        u32::try_from(i64::from(*hi) - i64::from(*lo) + 1).unwrap_or(u32::MAX),
                    )
                })
                .collect(),
            first_rule,
            rules,
            combinations: bound.combinations(),
            plans: staged::Plans::default(),
        }
    }

    #[inline]
    fn read<C: Choices>(&self, choices: &mut C, k: usize) -> i32 {
        let (lo, size) = self.inputs[k];
        // The value is below `size`, so the sum stays within the input's range.
        lo.wrapping_add(choices.choose(k as u32, size) as i32)
    }

    fn initial<C: Choices>(&self, bound: &Bound, choices: &mut C, state: &mut [i32]) {
        for (k, cell) in state.iter_mut().enumerate() {
            *cell = match bound.initial[k] {
                Some(v) => v,
                None => {
                    let domain = self.domains[k];
                    let size = u32::try_from(domain.size()).unwrap_or(u32::MAX);
                    domain
                        .lo
                        .wrapping_add(choices.choose(k as u32, size) as i32)
                }
            };
        }
    }

    fn fired(&self, fired: &[i32], each: &mut impl FnMut(usize)) {
        for (first, rule) in self.first_rule.iter().zip(fired) {
            if *rule > 0 {
                each(first + *rule as usize - 1);
            }
        }
    }
}

/// A table run by the interpreter.
pub struct Interpreted<'a> {
    bound: &'a Bound,
    shape: Shape,
    /// The instances that step.
    instances: Vec<usize>,
}

impl<'a> Interpreted<'a> {
    /// A system over `bound`.
    pub fn new(bound: &'a Bound) -> Self {
        Self {
            bound,
            shape: Shape::new(bound),
            instances: (0..bound.system.instances.len()).collect(),
        }
    }

    /// The table and its parameter values.
    pub fn bound(&self) -> &'a Bound {
        self.bound
    }
}

impl System for Interpreted<'_> {
    type Work = eval::Frame;

    fn work(&self) -> Self::Work {
        eval::Frame::new(self.bound)
    }

    fn domains(&self) -> &[Domain] {
        &self.shape.domains
    }

    fn combinations(&self) -> u128 {
        self.shape.combinations
    }

    fn initial<C: Choices>(&self, _: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        self.shape.initial(self.bound, choices, state);
    }

    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        work.start(before);
        let mut read = |k| self.shape.read(choices, k);
        for instance in &self.instances {
            let step = self.bound.step_instance(*instance, work, &mut read);
            step.map_err(|code| Fault { code })?;
        }
        after.copy_from_slice(&work.now);
        Ok(())
    }

    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        Ok(self
            .bound
            .atom(atom, work, &mut |k| self.shape.read(choices, k)))
    }

    fn rules(&self) -> usize {
        self.shape.rules
    }

    fn fired(&self, work: &Self::Work, each: &mut impl FnMut(usize)) {
        self.shape.fired(&work.fired, each);
    }

    fn components(&self) -> Vec<Component<'_>> {
        components(self.bound)
    }

    fn timer(&self) -> Option<usize> {
        timer(self.bound)
    }

    fn stages(&self, conditions: &[Condition]) -> Option<Box<dyn Stages + '_>> {
        // A part of a system is explored by itself.
        let whole = self.instances.len() == self.bound.system.instances.len();
        whole
            .then(|| staged::stages(&self.shape.plans, self.bound, conditions))
            .flatten()
    }

    fn observe<C: Choices>(
        &self,
        work: &mut Self::Work,
        expression: usize,
        choices: &mut C,
    ) -> Result<i64, Fault> {
        Ok(self
            .bound
            .observe(expression, work, &mut |k| self.shape.read(choices, k)))
    }
}

/// Of the variables that merely count down the one with the most values.
fn timer(bound: &Bound) -> Option<usize> {
    let size = |k: &usize| i64::from(bound.states[*k].1) - i64::from(bound.states[*k].0);
    let all = stillpoint_lang::timers::countdowns(&bound.system);
    all.into_iter().max_by_key(size)
}

/// The parts that share nothing but inputs, each run by the interpreter as if there were no others.
fn components(bound: &Bound) -> Vec<Component<'_>> {
    let component = |part: stillpoint_lang::parts::Part| {
        let system = Interpreted {
            instances: part.instances,
            ..Interpreted::new(bound)
        };
        Component::new(part.states, part.atoms, system)
    };
    let found = stillpoint_lang::parts::parts(&bound.system);
    found.into_iter().map(component).collect()
}

/// A table run by its generated step function.
pub struct Generated<'a> {
    bound: &'a Bound,
    table: &'static Table,
    shape: Shape,
}

impl<'a> Generated<'a> {
    /// A system over `bound`, if generated code belongs to exactly this specification.
    pub fn find(bound: &'a Bound) -> Option<Self> {
        let table = find(bound)?;
        Some(Self {
            bound,
            table,
            shape: Shape::new(bound),
        })
    }
}

impl System for Generated<'_> {
    type Work = Box<[i32]>;

    fn work(&self) -> Self::Work {
        vec![0; self.table.cells].into_boxed_slice()
    }

    fn domains(&self) -> &[Domain] {
        &self.shape.domains
    }

    fn combinations(&self) -> u128 {
        self.shape.combinations
    }

    fn initial<C: Choices>(&self, _: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        self.shape.initial(self.bound, choices, state);
    }

    #[inline]
    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        (self.table.step)(before, work, &self.bound.values, &mut |k| {
            self.shape.read(choices, k)
        })
        .map_err(|code| Fault { code })?;
        after.copy_from_slice(&work[..after.len()]);
        Ok(())
    }

    #[inline]
    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        (self.table.atom)(atom, work, &self.bound.values, &mut |k| {
            self.shape.read(choices, k)
        })
        .map_err(|code| Fault { code })
    }

    fn rules(&self) -> usize {
        self.shape.rules
    }

    #[inline]
    fn fired(&self, work: &Self::Work, each: &mut impl FnMut(usize)) {
        self.shape
            .fired(&work[self.table.cells - self.table.fired..], each);
    }

    fn components(&self) -> Vec<Component<'_>> {
        components(self.bound)
    }

    fn timer(&self) -> Option<usize> {
        timer(self.bound)
    }

    fn stages(&self, conditions: &[Condition]) -> Option<Box<dyn Stages + '_>> {
        staged::stages(&self.shape.plans, self.bound, conditions)
    }

    fn observe<C: Choices>(
        &self,
        work: &mut Self::Work,
        expression: usize,
        choices: &mut C,
    ) -> Result<i64, Fault> {
        (self.table.observe)(expression, work, &self.bound.values, &mut |k| {
            self.shape.read(choices, k)
        })
        .map_err(|code| Fault { code })
    }
}

/// The properties of a table that speak of single runs, in the explorer's terms, with their place in
/// `bound.system.properties`. The `independent` ones speak of two runs, see [`stillpoint_model::Twin`].
pub fn properties(bound: &Bound) -> Vec<(usize, Property)> {
    let mut out = Vec::new();
    for (k, p) in bound.system.properties.iter().enumerate() {
        let form = match &p.form {
            ir::Form::Always { when, then } => Form::Always {
                when: *when,
                then: *then,
            },
            ir::Form::LeadsTo {
                when,
                goal,
                within,
                fair,
                assuming,
            } => Form::LeadsTo {
                when: *when,
                goal: *goal,
                within: within
                    .as_ref()
                    .map(|n| u32::try_from(bound.constant(n).max(0)).unwrap_or(u32::MAX)),
                fair: fair.clone(),
                assuming: *assuming,
            },
            ir::Form::Unless {
                when,
                holds,
                unless,
            } => Form::Unless {
                when: *when,
                holds: *holds,
                unless: *unless,
            },
            ir::Form::CanAlwaysReach { goal, using } => Form::CanAlwaysReach {
                goal: *goal,
                using: *using,
            },
            ir::Form::Reachable { goal } => Form::Reachable { goal: *goal },
            ir::Form::Independent { .. } => continue,
        };
        let index = p.index.map_or(String::new(), |i| format!("[{i}]"));
        out.push((
            k,
            Property {
                id: format!("{}{index}", p.id),
                form,
            },
        ));
    }
    out
}
