//! Symmetry reduction, exploration of the quotient by a group of renamings: one state of each orbit stands for all of them.
//!
//! A [`Permutation`] renames state variables, inputs and values of inputs so that every cycle becomes a cycle again: the
//! caller answers for that. [`Symmetric`] replaces the state after each cycle by the least of its images. The states so
//! reached are exactly one of each orbit of reachable states, at the same depths, and every cycle from one of them is an
//! image of a cycle of the system itself. What that keeps of a property is the caller's to know: everything where no
//! permutation changes an atom; for a property about single cycles it is enough that its images are judged with it.

use std::collections::BTreeMap;

use crate::choices::Replay;
use crate::report::{Step, Trace};
use crate::system::{Choices, Domain, Fault, System};

/// A loop is closed within this many cycles, or the run is not told.
const LONGEST: usize = 100_000;

/// A renaming of state variables and inputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Permutation {
    /// For each state variable, which variable of the image has its value.
    pub states: Vec<u32>,
    /// For each input, which input of the image has its value.
    pub inputs: Vec<u32>,
    /// For each input, what becomes of its values (counted from the least); empty where they stay.
    pub values: Vec<BTreeMap<u32, u32>>,
}

impl Permutation {
    /// The renaming that changes nothing.
    pub fn identity(states: usize, inputs: usize) -> Self {
        Permutation {
            states: (0..states as u32).collect(),
            inputs: (0..inputs as u32).collect(),
            values: vec![BTreeMap::new(); inputs],
        }
    }

    /// First this one, then the other.
    pub fn then(&self, other: &Permutation) -> Permutation {
        let all = |a: &[u32], b: &[u32]| a.iter().map(|k| b[*k as usize]).collect();
        let values = (0..self.inputs.len()).map(|k| {
            let (first, second) = (&self.values[k], &other.values[self.inputs[k] as usize]);
            let image = |v: u32| {
                let middle = first.get(&v).copied().unwrap_or(v);
                second.get(&middle).copied().unwrap_or(middle)
            };
            let moved = first.keys().chain(second.keys()).map(|v| (*v, image(*v)));
            moved.filter(|(v, to)| v != to).collect()
        });
        Permutation {
            states: all(&self.states, &other.states),
            inputs: all(&self.inputs, &other.inputs),
            values: values.collect(),
        }
    }

    /// The renaming that undoes this one.
    pub fn inverse(&self) -> Permutation {
        let turned = |map: &[u32]| {
            let mut out = vec![0; map.len()];
            for (k, to) in (0..).zip(map) {
                out[*to as usize] = k;
            }
            out
        };
        let inputs = turned(&self.inputs);
        let values = inputs.iter().map(|k| {
            let own = &self.values[*k as usize];
            own.iter().map(|(from, to)| (*to, *from)).collect()
        });
        Permutation {
            states: turned(&self.states),
            values: values.collect(),
            inputs,
        }
    }

    /// The image of the choices of one cycle.
    pub fn step(&self, step: &Step) -> Step {
        let image = |(input, value): &(u32, u32)| {
            let k = *input as usize;
            let new = self.values[k].get(value).copied().unwrap_or(*value);
            (self.inputs[k], new)
        };
        step.iter().map(image).collect()
    }

    /// The image of the choices of an initial state, which are numbered like the state variables.
    pub fn initial(&self, step: &Step) -> Step {
        let image = |(cell, value): &(u32, u32)| (self.states[*cell as usize], *value);
        step.iter().map(image).collect()
    }

    /// The image of a run.
    pub fn trace(&self, trace: &Trace) -> Trace {
        Trace {
            initial: self.initial(&trace.initial),
            steps: trace.steps.iter().map(|s| self.step(s)).collect(),
            loop_start: trace.loop_start,
        }
    }
}

/// The permutations that a set of them generates.
#[derive(Clone, Debug)]
pub struct Group {
    /// The first one is the identity.
    elements: Vec<Permutation>,
    generators: Vec<usize>,
}

impl Group {
    /// More elements than this are not worth comparing after each cycle.
    pub const MOST: usize = 720;

    /// The group of these generators. A generator with which it would have more than [`Group::MOST`] elements is left out,
    /// so that the group stays a group.
    pub fn new(states: usize, inputs: usize, generators: &[Permutation]) -> Self {
        let mut used: Vec<Permutation> = Vec::new();
        let mut numbers = Vec::new();
        let mut elements = vec![Permutation::identity(states, inputs)];
        for (number, generator) in generators.iter().enumerate() {
            used.push(generator.clone());
            match closure(elements[0].clone(), &used) {
                Some(larger) => {
                    elements = larger;
                    numbers.push(number);
                }
                None => {
                    used.pop();
                }
            }
        }
        Group {
            elements,
            generators: numbers,
        }
    }

    /// The numbers of the generators that were not left out.
    pub fn generators(&self) -> &[usize] {
        &self.generators
    }

    /// Its elements, the identity first.
    pub fn elements(&self) -> &[Permutation] {
        &self.elements
    }

    /// Whether the identity is its only element.
    pub fn is_trivial(&self) -> bool {
        self.elements.len() == 1
    }
}

fn closure(identity: Permutation, generators: &[Permutation]) -> Option<Vec<Permutation>> {
    let mut elements = vec![identity];
    let mut at = 0;
    while at < elements.len() {
        for generator in generators {
            let next = elements[at].then(generator);
            if !elements.contains(&next) {
                if elements.len() == Group::MOST {
                    return None;
                }
                elements.push(next);
            }
        }
        at += 1;
    }
    Some(elements)
}

/// A system explored up to a group of permutations.
pub struct Symmetric<'a, S> {
    system: &'a S,
    group: &'a Group,
    /// For each element and each variable of the image, where its value comes from.
    sources: Vec<Vec<u32>>,
}

/// The work area of the system, and a place for an image.
pub struct SymmetricWork<W> {
    inner: W,
    image: Vec<i32>,
}

impl<W: Clone> Clone for SymmetricWork<W> {
    fn clone(&self) -> Self {
        SymmetricWork {
            inner: self.inner.clone(),
            image: self.image.clone(),
        }
    }

    // Without new memory: the explorer copies work areas all the time.
    fn clone_from(&mut self, other: &Self) {
        self.inner.clone_from(&other.inner);
        self.image.clone_from(&other.image);
    }
}

impl<'a, S: System> Symmetric<'a, S> {
    /// `system` up to `group`, whose permutations must be automorphisms of it.
    pub fn new(system: &'a S, group: &'a Group) -> Self {
        let sources = group.elements.iter().map(|p| p.inverse().states);
        Symmetric {
            system,
            group,
            sources: sources.collect(),
        }
    }

    /// Replaces a state by its least image; the number of the permutation that gave it.
    fn least(&self, state: &mut [i32], image: &mut Vec<i32>) -> usize {
        let mut best = 0;
        for (number, sources) in self.sources.iter().enumerate().skip(1) {
            let smaller = sources
                .iter()
                .zip(&self.sources[best])
                .map(|(new, old)| state[*new as usize].cmp(&state[*old as usize]))
                .find(|order| order.is_ne());
            if smaller == Some(std::cmp::Ordering::Less) {
                best = number;
            }
        }
        if best > 0 {
            image.clear();
            image.extend(self.sources[best].iter().map(|k| state[*k as usize]));
            state.copy_from_slice(image);
        }
        best
    }

    /// The run of the system itself that a run found here stands for; its last cycle before a loop is the very cycle that
    /// was judged. A loop that ends in another image of its first state goes on until it has returned to the state itself. None
    /// if that takes more than a hundred thousand cycles.
    pub fn unfold(&self, trace: &Trace) -> Option<Trace> {
        let mut work = self.work();
        let mut state = vec![0; self.domains().len()];
        let mut after = state.clone();
        self.system.initial(
            &mut work.inner,
            &mut Replay::new(&trace.initial),
            &mut state,
        );
        let mut turned = self.least(&mut state, &mut work.image);
        // The permutation from the true state to the one seen here, before each cycle and after the last one.
        let mut views = vec![self.group.elements[turned].clone()];
        let mut steps: Vec<&Step> = trace.steps.iter().collect();
        let mut at = 0;
        let mut laps = vec![];
        while at < steps.len() {
            if trace.loop_start.is_some_and(|s| s == at) {
                laps.push((at, views[at].clone()));
            }
            let mut answers = Replay::new(steps[at]);
            let made = self
                .system
                .next(&mut work.inner, &state, &mut answers, &mut after);
            at += 1;
            if made.is_err() {
                break;
            }
            turned = self.least(&mut after, &mut work.image);
            state.copy_from_slice(&after);
            views.push(views[at - 1].then(&self.group.elements[turned]));
            if let (true, Some(start)) = (at == steps.len(), trace.loop_start) {
                // The end of the loop: the true state is that of the lap that began with the same view.
                if !laps.iter().any(|(_, view)| *view == views[at]) {
                    if at > LONGEST {
                        return None;
                    }
                    laps.push((at, views[at].clone()));
                    steps.extend(&trace.steps[start..]);
                }
            }
        }
        let start = views.get(at).and_then(|last| {
            let lap = laps.iter().find(|(_, view)| view == last);
            lap.map(|(at, _)| *at)
        });
        // Seen from the last cycle that was judged as it was found.
        let judged = trace.loop_start.unwrap_or(trace.steps.len()).max(1) - 1;
        let last = &views[judged.min(views.len() - 1)];
        let seen = |view: &Permutation| view.inverse().then(last);
        Some(Trace {
            initial: last.initial(&trace.initial),
            steps: steps
                .iter()
                .zip(&views)
                .map(|(step, view)| seen(view).step(step))
                .collect(),
            loop_start: trace.loop_start.and(start),
        })
    }
}

impl<S: System> System for Symmetric<'_, S> {
    type Work = SymmetricWork<S::Work>;

    fn work(&self) -> Self::Work {
        SymmetricWork {
            inner: self.system.work(),
            image: Vec::with_capacity(self.domains().len()),
        }
    }

    fn domains(&self) -> &[Domain] {
        self.system.domains()
    }

    fn timer(&self) -> Option<usize> {
        self.system.timer()
    }

    fn combinations(&self) -> u128 {
        self.system.combinations()
    }

    fn initial<C: Choices>(&self, work: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        self.system.initial(&mut work.inner, choices, state);
        self.least(state, &mut work.image);
    }

    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        self.system.next(&mut work.inner, before, choices, after)?;
        self.least(after, &mut work.image);
        Ok(())
    }

    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        self.system.atom(&mut work.inner, atom, choices)
    }

    fn rules(&self) -> usize {
        self.system.rules()
    }

    fn fired(&self, work: &Self::Work, each: &mut impl FnMut(usize)) {
        self.system.fired(&work.inner, each);
    }

    fn discarded(&self, work: &Self::Work) -> bool {
        self.system.discarded(&work.inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Variables and inputs k of three: exchange of a and b; the values a and b of input 3 change places too.
    fn exchange(a: u32, b: u32) -> Permutation {
        let mut out = Permutation::identity(3, 4);
        out.states.swap(a as usize, b as usize);
        out.inputs.swap(a as usize, b as usize);
        out.values[3] = BTreeMap::from([(a, b), (b, a)]);
        out
    }

    #[test]
    fn permutations_compose_and_invert() {
        let (p, q) = (exchange(0, 1), exchange(1, 2));
        let both = p.then(&q);
        assert_eq!(both.states, [2, 0, 1]);
        let step = vec![(0, 7), (3, 0), (2, 5)];
        assert_eq!(both.step(&step), q.step(&p.step(&step)));
        assert_eq!(both.step(&step), [(2, 7), (3, 2), (1, 5)]);
        assert_eq!(both.initial(&vec![(0, 7)]), [(2, 7)]);
        assert_eq!(both.then(&both.inverse()), Permutation::identity(3, 4));
        assert_eq!(both.inverse(), q.then(&p));
        assert_ne!(both.inverse(), both);
    }

    #[test]
    fn a_group_is_closed_and_leaves_out_what_makes_it_too_large() {
        let group = Group::new(3, 4, &[exchange(0, 1), exchange(1, 2)]);
        assert_eq!(
            (group.elements().len(), group.generators()),
            (6, &[0, 1][..])
        );
        for a in group.elements() {
            for b in group.elements() {
                assert!(group.elements().contains(&a.then(b)));
            }
        }
        let swap = |k: u32| {
            let mut out = Permutation::identity(8, 0);
            out.states.swap(k as usize, k as usize + 1);
            out
        };
        // Seven variables in any order are 5040 permutations: too many; the last exchange still goes with the first five.
        let chain: Vec<Permutation> = (0..6).map(swap).collect();
        let group = Group::new(8, 0, &chain);
        assert_eq!(
            (group.elements().len(), group.generators()),
            (720, &[0, 1, 2, 3, 4][..])
        );
        assert!(Group::new(8, 0, &[]).is_trivial());
    }

    /// Two bits; a cycle turns the one that input 0 names. Variable 2 counts the cycles modulo 3.
    struct Bits([Domain; 3]);

    impl System for Bits {
        type Work = Vec<i32>;

        fn work(&self) -> Vec<i32> {
            Vec::new()
        }

        fn domains(&self) -> &[Domain] {
            &self.0
        }

        fn combinations(&self) -> u128 {
            2
        }

        fn initial<C: Choices>(&self, _: &mut Vec<i32>, _: &mut C, state: &mut [i32]) {
            state.fill(0);
        }

        fn next<C: Choices>(
            &self,
            work: &mut Vec<i32>,
            before: &[i32],
            choices: &mut C,
            after: &mut [i32],
        ) -> Result<(), Fault> {
            after.copy_from_slice(before);
            after[choices.choose(0, 2) as usize] ^= 1;
            after[2] = (before[2] + 1) % 3;
            *work = after.to_vec();
            Ok(())
        }

        fn atom<C: Choices>(
            &self,
            work: &mut Vec<i32>,
            atom: usize,
            _: &mut C,
        ) -> Result<bool, Fault> {
            Ok(work[atom] == 1)
        }
    }

    #[test]
    fn a_run_of_orbits_is_unfolded_to_a_run_with_a_closed_loop() {
        let domain = |hi| Domain { lo: 0, hi };
        let bits = Bits([domain(1), domain(1), domain(2)]);
        let mut swap = Permutation::identity(3, 1);
        swap.states.swap(0, 1);
        swap.values[0] = BTreeMap::from([(0, 1), (1, 0)]);
        let group = Group::new(3, 1, &[swap]);
        let orbits = Symmetric::new(&bits, &group);
        // Orbits: the least of 00, 01, 11. From 01 turning bit 0 gives 11, turning bit 0 again gives 01.
        let trace = Trace {
            initial: vec![],
            steps: [0, 0, 0, 1, 1, 0, 0].map(|v| vec![(0, v)]).to_vec(),
            loop_start: Some(1),
        };
        let run = orbits.unfold(&trace).expect("it closes");
        let mut state = vec![0; 3];
        let mut seen = vec![state.clone()];
        for step in &run.steps {
            let mut after = state.clone();
            let made = bits.next(&mut Vec::new(), &state, &mut Replay::new(step), &mut after);
            assert_eq!(made, Ok(()));
            state = after;
            seen.push(state.clone());
        }
        let start = run.loop_start.expect("a loop");
        assert_eq!(seen[start], seen[seen.len() - 1]);
        assert!(run.steps.len() >= trace.steps.len());
        // Up to the exchange it is the run that was found.
        let mut work = orbits.work();
        let mut orbit = vec![0; 3];
        for (k, step) in trace.steps.iter().enumerate() {
            let mut least = seen[k].clone();
            least[..2].sort_unstable();
            assert_eq!(orbit, least, "cycle {k}");
            let mut after = orbit.clone();
            let made = orbits.next(&mut work, &orbit, &mut Replay::new(step), &mut after);
            assert_eq!(made, Ok(()));
            orbit = after;
        }
    }
}
