//! Runs out of the rings, from a state backwards; runs without an end.

use std::collections::HashMap;

use super::super::netlist::Run;
use super::super::sat::Spent;
use super::store::{Edge, Kept};
use super::{Condition, Set, States};

/// Rounds after which no state that was there before is waited for any longer.
const ROUNDS: usize = 100_000;

/// A state: the values of the latches of the cone.
pub(super) type State = Vec<bool>;

/// The inputs of a cycle, as those of the netlist.
type Inputs = Vec<Option<bool>>;

/// A run whose last cycles are repeated for ever.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lasso {
    /// The run.
    pub run: Run,
    /// The cycle that comes after the last one again; none if it was not waited for.
    pub back_to: Option<usize>,
}

impl States {
    /// A shortest run to a reachable state of a set, and that state; none if there is none.
    pub(super) fn to(&mut self, set: Set) -> Result<Option<(Run, State)>, Spent> {
        for ring in 0..self.rings.len() {
            let seen = (self.diagrams).and(set, self.diagrams.get(self.rings[ring]))?;
            if seen != Edge::FALSE {
                return Ok(Some(self.run(ring, seen)?));
            }
        }
        Ok(None)
    }

    /// A run to a state of a set that is within a ring.
    pub(super) fn run(&mut self, ring: usize, set: Set) -> Result<(Run, State), Spent> {
        let rings = self.rings[..ring].to_vec();
        let last = self.state(set);
        let (first, cycles) = self.back(&rings, last.clone(), Edge::TRUE)?;
        let mut start = vec![None; self.levels.of.0];
        for (place, value) in self.levels.places.0.iter().zip(first) {
            start[*place] = Some(value);
        }
        Ok((Run { start, cycles }, last))
    }

    /// From a state back to the first ring, by cycles with a condition: the state there, and the inputs.
    fn back(
        &mut self,
        rings: &[Kept],
        state: State,
        condition: Edge,
    ) -> Result<(State, Vec<Inputs>), Spent> {
        let (mut state, mut cycles) = (state, Vec::new());
        let mut with = (self.diagrams).and(condition, self.diagrams.get(self.assumed))?;
        for ring in rings.iter().rev() {
            let from = self.diagrams.and(self.diagrams.get(*ring), with)?;
            let before = self.leading(from, &state)?;
            state = self.state(before);
            cycles.push(self.inputs(before));
            self.diagrams.collect(&mut [&mut with]);
        }
        cycles.reverse();
        Ok((state, cycles))
    }

    /// Inputs that make a condition hold in a state.
    pub(super) fn making(&mut self, state: &State, condition: Condition) -> Result<Inputs, Spent> {
        let with = self.with(state, condition)?;
        Ok(self.inputs(with))
    }

    /// From a state with a cycle that has `begin` into the set, and on in rounds of cycles with `stays`, each of which ends in the set with one of the
    /// conditions of the round, until a round begins where one has begun.
    pub(super) fn lasso(
        &mut self,
        run: Run,
        state: State,
        (begin, stays, rounds): (Condition, Condition, &[Condition]),
        set: Kept,
    ) -> Result<Lasso, Spent> {
        let mut lasso = Lasso { run, back_to: None };
        let (cycle, mut state) = self.into(&state, begin, set)?;
        lasso.run.cycles.push(cycle);
        let mut known: HashMap<State, usize> = HashMap::new();
        while known.len() < ROUNDS {
            if let Some(cycle) = known.get(&state) {
                lasso.back_to = Some(*cycle);
                break;
            }
            known.insert(state.clone(), lasso.run.cycles.len());
            for met in rounds {
                let (cycles, next) = self.walk(&state, stays, *met, set)?;
                lasso.run.cycles.extend(cycles);
                state = next;
            }
        }
        Ok(lasso)
    }

    /// The fewest cycles with `stays` from a state to one with `last` into a set.
    fn walk(
        &mut self,
        state: &State,
        stays: Condition,
        last: Condition,
        set: Kept,
    ) -> Result<(Vec<Inputs>, State), Spent> {
        let goal = self.before(self.diagrams.get(set), last, &mut [])?;
        let goal = self.diagrams.keep(goal);
        let begin = self.exactly(state)?;
        let all = self.diagrams.keep(begin);
        let mut rings = vec![self.diagrams.keep(begin)];
        loop {
            let ring = self.diagrams.get(rings[rings.len() - 1]);
            let seen = (self.diagrams).and(ring, self.diagrams.get(goal))?;
            // A set that is no fixed point: nothing is said, and nothing waited for.
            if ring == Edge::FALSE {
                return Err(Spent);
            }
            if seen != Edge::FALSE {
                let end = self.state(seen);
                let stays = self.diagrams.get(stays.0);
                let (_, mut cycles) = self.back(&rings[..rings.len() - 1], end.clone(), stays)?;
                let (cycle, next) = self.into(&end, last, set)?;
                cycles.push(cycle);
                self.diagrams.forget(goal);
                return Ok((cycles, next));
            }
            let with = (self.diagrams).and(ring, self.diagrams.get(stays.0))?;
            let image = self.after(with, &mut [])?;
            let known = self.diagrams.get(all);
            let new = self.diagrams.and(image, !known)?;
            let more = self.diagrams.or(known, new)?;
            self.diagrams.set(all, more);
            rings.push(self.diagrams.keep(new));
        }
    }

    /// Inputs that make a condition hold in a state and lead into a set, and where they lead.
    fn into(
        &mut self,
        state: &State,
        condition: Condition,
        set: Kept,
    ) -> Result<(Inputs, State), Spent> {
        let mut with = self.with(state, condition)?;
        let image = self.after(with, &mut [&mut with])?;
        let image = (self.diagrams).and(image, self.diagrams.get(set))?;
        let then = self.state(image);
        let leading = self.leading(with, &then)?;
        Ok((self.inputs(leading), then))
    }

    /// The set of one state.
    fn exactly(&mut self, state: &State) -> Result<Set, Spent> {
        let mut set = Edge::TRUE;
        for (level, value) in self.levels.latches.clone().into_iter().zip(state) {
            let bit = self.diagrams.variable(level)?.flipped(!value);
            set = self.diagrams.and(set, bit)?;
        }
        Ok(set)
    }

    /// A state with those inputs that make a condition hold.
    fn with(&mut self, state: &State, condition: Condition) -> Result<Edge, Spent> {
        let state = self.exactly(state)?;
        let with = (self.diagrams).and(state, self.diagrams.get(condition.0))?;
        (self.diagrams).and(with, self.diagrams.get(self.assumed))
    }

    /// Of states with inputs those that lead to a state.
    fn leading(&mut self, from: Edge, state: &State) -> Result<Edge, Spent> {
        let mut from = from;
        for (next, value) in self.next.iter().zip(state) {
            let next = self.diagrams.get(*next).flipped(!value);
            from = self.diagrams.and(from, next)?;
        }
        Ok(from)
    }

    /// A state of a set. What is not asked may have any value.
    fn state(&self, set: Set) -> State {
        let values = self.diagrams.example(set);
        let latches = self.levels.latches.iter();
        latches
            .map(|level| values.get(level) == Some(&true))
            .collect()
    }

    /// The inputs of an example.
    fn inputs(&self, set: Edge) -> Inputs {
        let values = self.diagrams.example(set);
        let mut inputs = vec![None; self.levels.of.1];
        for (place, level) in self.levels.places.1.iter().zip(&self.levels.inputs) {
            inputs[*place] = Some(values.get(level) == Some(&true));
        }
        inputs
    }
}
