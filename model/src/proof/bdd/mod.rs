//! All states at once: sets of states as binary decision diagrams, what a cycle makes of them, and fixed points.
//!
//! A set is one function over the latches. [`States::reach`] finds the reachable ones, ring by ring, with their exact number and
//! shortest runs; [`States::lost`] those from which a goal cannot be reached, [`States::forever`] those where a run without an end
//! goes on (`fixpoint`). What a set costs is no matter of how many states it has, but of the order of the variables (`order`).

mod fixpoint;
mod order;
mod path;
mod relation;
mod store;

use std::collections::HashMap;

use super::graph::{Graph, Lit, Node};
use super::netlist::{Problem, Run};
use super::sat::{Budget, Spent};
use order::Levels;
pub use path::Lasso;
use relation::{PART, Schedule, joined};
use store::{Diagrams, Edge, FIRST, Kept};

/// A condition on a cycle, over latches and inputs, of the [`States`] that were asked for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Condition(Kept);

/// A set of states.
type Set = Edge;

/// The states of a problem: of those latches and inputs that are in its cone.
pub struct States {
    diagrams: Diagrams,
    levels: Levels,
    /// Levels of the variables, by their nodes.
    variables: HashMap<usize, u32>,
    /// What the latches of the cone become.
    next: Vec<Kept>,
    /// What the inputs keep to.
    assumed: Kept,
    forward: Schedule,
    backward: Schedule,
    /// By number of cycles, the states that are reached by so many and no fewer.
    rings: Vec<Kept>,
    /// All of them.
    reached: Kept,
    /// There are no others.
    complete: bool,
}

impl States {
    /// The states at the start.
    ///
    /// # Errors
    /// The budget, or a gigabyte, was spent.
    pub fn new(problem: &Problem, budget: &Budget) -> Result<Self, Spent> {
        States::sized(problem, budget, (FIRST, PART))
    }

    /// The same; functions that are not needed are forgotten whenever there are so many nodes, and parts of the cycle are joined up to so many,
    /// which is for tests.
    ///
    /// # Errors
    /// As [`States::new`].
    pub fn sized(
        problem: &Problem,
        budget: &Budget,
        (first, part): (usize, usize),
    ) -> Result<Self, Spent> {
        let mut diagrams = Diagrams::new(budget, first);
        let levels = Levels::new(problem);
        let variables = levels.variables(problem);
        let graph = problem.graph();
        let cone: Vec<_> = problem.cone().collect();
        let conditions = [&problem.start[..], &problem.invariants, &problem.assumed];
        let next = cone.iter().map(|latch| latch.next);
        let asked: Vec<Lit> = conditions.concat().into_iter().chain(next).collect();
        let values = functions(graph, &variables, &asked, &mut diagrams)?;
        let values: Option<Vec<Edge>> = values.into_iter().collect();
        // All of them are in the cone.
        let mut values = values.ok_or(Spent)?.into_iter();
        let mut all = |diagrams: &mut Diagrams, count: usize| -> Result<Edge, Spent> {
            let mut values = values.by_ref().take(count);
            values.try_fold(Edge::TRUE, |all, one| diagrams.and(all, one))
        };
        let mut start = all(&mut diagrams, problem.start.len())?;
        let invariants = all(&mut diagrams, problem.invariants.len())?;
        let assumed = all(&mut diagrams, problem.assumed.len())?;
        let assumed = diagrams.keep(assumed);
        start = diagrams.and(start, invariants)?;
        for (latch, level) in cone.iter().zip(&levels.latches) {
            if let Some(init) = latch.init {
                let variable = diagrams.variable(*level)?;
                start = diagrams.and(start, variable.flipped(!init))?;
            }
        }
        let start = diagrams.keep(start);
        let reached = diagrams.keep(diagrams.get(start));
        let next: Vec<Kept> = values.map(|function| diagrams.keep(function)).collect();
        // In the order of their levels: small parts with the same variables are joined.
        let mut order: Vec<usize> = (0..next.len()).collect();
        order.sort_by_key(|k| levels.latches[*k]);
        let mut parts = vec![assumed];
        for k in order {
            let after = diagrams.variable(levels.latches[k] + 1)?;
            let same = diagrams.same(after, diagrams.get(next[k]))?;
            parts.push(diagrams.keep(same));
            diagrams.collect(&mut []);
        }
        let parts = joined(&mut diagrams, &parts, part)?;
        let now = [&levels.latches[..], &levels.inputs].concat();
        let forward = Schedule::new(&mut diagrams, &parts, &now)?;
        let then = levels.latches.iter().map(|level| level + 1);
        let then: Vec<u32> = then.chain(levels.inputs.iter().copied()).collect();
        let backward = Schedule::new(&mut diagrams, &parts, &then)?;
        Ok(States {
            diagrams,
            levels,
            variables,
            next,
            assumed,
            forward,
            backward,
            rings: vec![start],
            reached,
            complete: false,
        })
    }

    /// Another budget from now on. What was found before stays known.
    pub fn limit(&mut self, budget: &Budget) {
        self.diagrams.limit(budget);
    }

    /// That this holds in a cycle; none if it depends on what is not in the cone.
    ///
    /// # Errors
    /// The budget was spent.
    pub fn condition(&mut self, graph: &Graph, lit: Lit) -> Result<Option<Condition>, Spent> {
        let found = functions(graph, &self.variables, &[lit], &mut self.diagrams)?;
        Ok(found[0].map(|function| Condition(self.diagrams.keep(function))))
    }

    /// A shortest run to a cycle with a condition. Without one, or if there is none, all reachable states are known then.
    ///
    /// # Errors
    /// The budget was spent.
    pub fn reach(&mut self, end: Option<Condition>) -> Result<Option<Run>, Spent> {
        let end = match end {
            Some(condition) => {
                let states = self.permitting(condition)?;
                Some((condition, self.diagrams.keep(states)))
            }
            None => None,
        };
        let mut ring = 0;
        loop {
            if let Some((condition, end)) = end {
                let set = self.diagrams.get(self.rings[ring]);
                let seen = self.diagrams.and(set, self.diagrams.get(end))?;
                if seen != Edge::FALSE {
                    let (mut run, state) = self.run(ring, seen)?;
                    run.cycles.push(self.making(&state, condition)?);
                    return Ok(Some(run));
                }
            }
            ring += 1;
            if ring == self.rings.len() && (self.complete || !self.another()?) {
                return Ok(None);
            }
        }
    }

    /// Finds one more ring; whether there is one.
    fn another(&mut self) -> Result<bool, Spent> {
        let last = self.diagrams.get(self.rings[self.rings.len() - 1]);
        let image = self.after(last, &mut [])?;
        let reached = self.diagrams.get(self.reached);
        let new = self.diagrams.and(image, !reached)?;
        self.complete = new == Edge::FALSE;
        if !self.complete {
            let all = self.diagrams.or(reached, new)?;
            self.diagrams.set(self.reached, all);
            let ring = self.diagrams.keep(new);
            self.rings.push(ring);
        }
        Ok(!self.complete)
    }

    /// The number of states that were reached; none if they are more than 2^128 - 1.
    pub fn count(&self) -> Option<u128> {
        let mut levels = self.levels.latches.clone();
        levels.sort_unstable();
        let reached = self.diagrams.get(self.reached);
        self.diagrams.count(reached, &levels)
    }

    /// The number of cycles to the farthest of them.
    pub fn depth(&self) -> usize {
        self.rings.len() - 1
    }

    /// The states to which a cycle leads from a set of states with inputs.
    fn after(&mut self, set: Edge, also: &mut [&mut Edge]) -> Result<Set, Spent> {
        let image = self.forward.apply(&mut self.diagrams, set, also)?;
        self.diagrams.shifted(image, false)
    }
}

/// Functions of a graph; none for one with another variable.
fn functions(
    graph: &Graph,
    variables: &HashMap<usize, u32>,
    asked: &[Lit],
    diagrams: &mut Diagrams,
) -> Result<Vec<Option<Edge>>, Spent> {
    let needed = graph.below(asked.iter().copied());
    let mut values = vec![Some(Edge::FALSE); needed.len()];
    let value = |values: &[Option<Edge>], lit: Lit| {
        values[lit.node()].map(|edge| edge.flipped(lit.negated()))
    };
    for node in (0..needed.len()).filter(|node| needed[*node]) {
        values[node] = match graph.node(node) {
            Node::Constant => Some(Edge::FALSE),
            Node::Leaf => match variables.get(&node) {
                Some(level) => Some(diagrams.variable(*level)?),
                None => None,
            },
            Node::And(a, b) => match (value(&values, a), value(&values, b)) {
                (Some(a), Some(b)) => Some(diagrams.and(a, b)?),
                _ => None,
            },
        };
    }
    Ok(asked.iter().map(|lit| value(&values, *lit)).collect())
}
