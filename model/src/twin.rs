//! Two runs of one system side by side, for "does not depend on" (self-composition).

use crate::report::Trace;
use crate::system::{Choices, Domain, Fault, System};

/// Marks an input of the second run that may differ from the first run's.
const OTHER: u32 = 1 << 31;

/// Two runs from the same initial state whose inputs are equal, except that the listed inputs may differ in cycles in
/// which the condition holds in both runs. The state is the state of the first run followed by that of the second.
///
/// Two atoms exist: [`Twin::AGREE`] and [`Twin::BOTH`]; `Always { when: Some(BOTH), then: AGREE }` is the property
/// "independent", vacuous if the condition never holds in both. Input numbers of the system must be below 2^31. The
/// transitions counted include the pairs of input combinations that an equal listed input makes coincide.
pub struct Twin<'a, S> {
    system: &'a S,
    listed: Vec<(u32, u32)>,
    during: Option<usize>,
    observed: Vec<usize>,
    domains: Vec<Domain>,
}

/// The work areas of both runs.
pub struct TwinWork<W> {
    runs: [W; 2],
    /// What each run has read of each listed input in this cycle.
    values: [Vec<Option<u32>>; 2],
    /// The listed inputs are the same in both runs in this cycle.
    equal: bool,
    both: bool,
    discarded: bool,
}

impl<W: Clone> Clone for TwinWork<W> {
    fn clone(&self) -> Self {
        TwinWork {
            runs: self.runs.clone(),
            values: self.values.clone(),
            ..*self
        }
    }

    // Without new memory: the explorer copies work areas all the time.
    fn clone_from(&mut self, other: &Self) {
        self.runs.clone_from(&other.runs);
        self.values.clone_from(&other.values);
        (self.equal, self.both, self.discarded) = (other.equal, other.both, other.discarded);
    }
}

impl<'a, S: System> Twin<'a, S> {
    /// Atom: where the condition holds in both runs, all observed expressions agree.
    pub const AGREE: usize = 0;
    /// Atom: the condition holds in both runs.
    pub const BOTH: usize = 1;

    /// Two runs of `system`. `listed`: the inputs that may differ, with their sizes; `during`: the atom of the
    /// condition (none: always); `observed`: the numbers of the expressions to compare.
    pub fn new(
        system: &'a S,
        listed: Vec<(u32, u32)>,
        during: Option<usize>,
        observed: Vec<usize>,
    ) -> Self {
        let domains = [system.domains(), system.domains()].concat();
        Twin {
            system,
            listed,
            during,
            observed,
            domains,
        }
    }

    /// The two runs of a trace of the twin.
    pub fn split(&self, trace: &Trace) -> [Trace; 2] {
        let run = |second: bool| {
            let step = |step: &Vec<(u32, u32)>| {
                let mut own: Vec<(u32, u32)> = step
                    .iter()
                    .copied()
                    .filter(|(i, _)| i & OTHER == 0)
                    .collect();
                for (input, value) in step.iter().filter(|(i, _)| i & OTHER != 0) {
                    let input = input & !OTHER;
                    match own.iter_mut().find(|(i, _)| *i == input) {
                        // What one run did not read is the same in both.
                        None => own.push((input, *value)),
                        Some(pair) if second => pair.1 = *value,
                        Some(_) => (),
                    }
                }
                own
            };
            Trace {
                steps: trace.steps.iter().map(step).collect(),
                ..trace.clone()
            }
        };
        [run(false), run(true)]
    }

    fn during<C: Choices>(
        &self,
        work: &mut TwinWork<S::Work>,
        run: usize,
        choices: &mut C,
    ) -> bool {
        let Some(atom) = self.during else { return true };
        let (inner, mut side) = self.side(work, run, choices);
        self.system.atom(inner, atom, &mut side).unwrap_or(false)
    }

    fn side<'w, C>(
        &'w self,
        work: &'w mut TwinWork<S::Work>,
        run: usize,
        choices: &'w mut C,
    ) -> (&'w mut S::Work, Side<'w, C>) {
        let TwinWork {
            runs,
            values,
            equal,
            ..
        } = work;
        (
            &mut runs[run],
            Side {
                choices,
                listed: &self.listed,
                values,
                run,
                equal: *equal,
            },
        )
    }

    fn agree<C: Choices>(
        &self,
        work: &mut TwinWork<S::Work>,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        for expression in self.observed.iter().copied() {
            let mut values = [0; 2];
            for (run, value) in values.iter_mut().enumerate() {
                let (inner, mut side) = self.side(work, run, choices);
                *value = self.system.observe(inner, expression, &mut side)?;
            }
            if values[0] != values[1] {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The inputs as one run sees them.
struct Side<'w, C> {
    choices: &'w mut C,
    listed: &'w [(u32, u32)],
    values: &'w mut [Vec<Option<u32>>; 2],
    run: usize,
    equal: bool,
}

impl<C: Choices> Choices for Side<'_, C> {
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        match self.listed.iter().position(|(listed, _)| *listed == input) {
            Some(place) => {
                let own = if self.run == 1 && !self.equal {
                    input | OTHER
                } else {
                    input
                };
                let value = self.choices.choose(own, size);
                self.values[self.run][place] = Some(value);
                value
            }
            None => self.choices.choose(input, size),
        }
    }
}

impl<S: System> System for Twin<'_, S> {
    type Work = TwinWork<S::Work>;

    fn work(&self) -> Self::Work {
        let values = || vec![None; self.listed.len()];
        TwinWork {
            runs: [self.system.work(), self.system.work()],
            values: [values(), values()],
            equal: false,
            both: false,
            discarded: false,
        }
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        let sizes = self.listed.iter().map(|(_, size)| u128::from(*size));
        sizes.fold(self.system.combinations(), u128::wrapping_mul)
    }

    fn initial<C: Choices>(&self, work: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        let (first, second) = state.split_at_mut(self.domains.len() / 2);
        self.system.initial(&mut work.runs[0], choices, first);
        second.copy_from_slice(first);
    }

    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        let half = self.domains.len() / 2;
        let after = after.split_at_mut(half);
        work.values.iter_mut().for_each(|values| values.fill(None));
        work.equal = false;
        work.discarded = false;
        let (inner, mut side) = self.side(work, 0, choices);
        self.system
            .next(inner, &before[..half], &mut side, after.0)?;
        // Where the condition does not hold in the first run, the second one gets the same inputs.
        let first = self.during(work, 0, choices);
        work.equal = !first;
        let (inner, mut side) = self.side(work, 1, choices);
        self.system
            .next(inner, &before[half..], &mut side, after.1)?;
        work.both = first && self.during(work, 1, choices);
        let [one, other] = &work.values;
        let differ = one
            .iter()
            .zip(other)
            .any(|(a, b)| a.is_some() && b.is_some() && a != b);
        let gone = work.runs.iter().any(|run| self.system.discarded(run));
        work.discarded = gone || (differ && !work.both);
        Ok(())
    }

    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        if atom == Self::BOTH {
            return Ok(work.both);
        }
        Ok(!work.both || self.agree(work, choices)?)
    }

    fn discarded(&self, work: &Self::Work) -> bool {
        work.discarded
    }
}
