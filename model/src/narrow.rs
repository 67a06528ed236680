//! A part of a system, run by the step function of the whole.

use crate::system::{Choices, Domain, Fault, System};

/// Which state variables, inputs and expressions of the whole system a part has.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// For each state variable of the part its number in the whole.
    pub states: Vec<u32>,
    /// For each input of the part its number in the whole, rising.
    pub inputs: Vec<u32>,
    /// For each atom of the part its number in the whole.
    pub atoms: Vec<u32>,
    /// For each observed expression of the part its number in the whole.
    pub observed: Vec<u32>,
}

/// The part of a system that some state variables and inputs make up, when nothing else influences them and no cycle can
/// meet a fault outside it: both are the caller's to know.
///
/// Each cycle starts with any fixed values of the variables outside; inputs outside read their least value. So the step of the
/// whole system serves the part, and nothing is enumerated that the part does not read.
pub struct Narrow<'a, S> {
    system: &'a S,
    part: &'a Part,
    domains: Vec<Domain>,
    combinations: u128,
    /// For each input of the whole its number in the part.
    input: Vec<Option<u32>>,
    state: Vec<Option<u32>>,
}

/// The work area of the whole system with a state before and one after the cycle.
pub struct NarrowWork<W> {
    inner: W,
    before: Vec<i32>,
    after: Vec<i32>,
}

impl<W: Clone> Clone for NarrowWork<W> {
    fn clone(&self) -> Self {
        NarrowWork {
            inner: self.inner.clone(),
            before: self.before.clone(),
            after: self.after.clone(),
        }
    }

    // Without new memory: the explorer copies work areas all the time.
    fn clone_from(&mut self, other: &Self) {
        self.inner.clone_from(&other.inner);
        self.before.clone_from(&other.before);
        self.after.clone_from(&other.after);
    }
}

/// Passes on what the part asks.
struct Filter<'c, C> {
    choices: &'c mut C,
    numbers: &'c [Option<u32>],
}

impl<C: Choices> Choices for Filter<'_, C> {
    #[inline]
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        match self.numbers.get(input as usize).copied().flatten() {
            Some(own) => self.choices.choose(own, size),
            None => 0,
        }
    }
}

fn numbers(kept: &[u32], whole: usize) -> Vec<Option<u32>> {
    let mut out = vec![None; whole];
    for (own, number) in (0..).zip(kept) {
        if let Some(slot) = out.get_mut(*number as usize) {
            *slot = Some(own);
        }
    }
    out
}

impl<'a, S: System> Narrow<'a, S> {
    /// The `part` of `system`, which has `inputs` inputs; `combinations` of the part's inputs belong to a cycle.
    pub fn new(system: &'a S, part: &'a Part, inputs: usize, combinations: u128) -> Self {
        let whole = system.domains();
        let domains = part.states.iter().filter_map(|k| whole.get(*k as usize));
        Narrow {
            domains: domains.copied().collect(),
            combinations,
            input: numbers(&part.inputs, inputs),
            state: numbers(&part.states, whole.len()),
            system,
            part,
        }
    }
}

impl<S: System> System for Narrow<'_, S> {
    type Work = NarrowWork<S::Work>;

    fn work(&self) -> Self::Work {
        let least: Vec<i32> = self.system.domains().iter().map(|d| d.lo).collect();
        NarrowWork {
            inner: self.system.work(),
            before: least.clone(),
            after: least,
        }
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn timer(&self) -> Option<usize> {
        let timer = self.system.timer()?;
        self.part.states.iter().position(|k| *k as usize == timer)
    }

    fn combinations(&self) -> u128 {
        self.combinations
    }

    fn initial<C: Choices>(&self, work: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        let mut filter = Filter {
            choices,
            numbers: &self.state,
        };
        self.system
            .initial(&mut work.inner, &mut filter, &mut work.after);
        for (own, k) in state.iter_mut().zip(&self.part.states) {
            *own = work.after[*k as usize];
        }
    }

    #[inline]
    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        for (own, k) in before.iter().zip(&self.part.states) {
            work.before[*k as usize] = *own;
        }
        let mut filter = Filter {
            choices,
            numbers: &self.input,
        };
        self.system
            .next(&mut work.inner, &work.before, &mut filter, &mut work.after)?;
        for (own, k) in after.iter_mut().zip(&self.part.states) {
            *own = work.after[*k as usize];
        }
        Ok(())
    }

    #[inline]
    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        let mut filter = Filter {
            choices,
            numbers: &self.input,
        };
        let number = self.part.atoms[atom] as usize;
        self.system.atom(&mut work.inner, number, &mut filter)
    }

    fn observe<C: Choices>(
        &self,
        work: &mut Self::Work,
        expression: usize,
        choices: &mut C,
    ) -> Result<i64, Fault> {
        let mut filter = Filter {
            choices,
            numbers: &self.input,
        };
        let number = *self
            .part
            .observed
            .get(expression)
            .ok_or(Fault::NO_OBSERVATION)?;
        self.system
            .observe(&mut work.inner, number as usize, &mut filter)
    }

    fn discarded(&self, work: &Self::Work) -> bool {
        self.system.discarded(&work.inner)
    }
}
