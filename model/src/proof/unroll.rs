//! Cycles one after the other (unrolling): an and-inverter graph over the inputs of each cycle.

use super::graph::{Graph, Lit, value};
use super::netlist::{Problem, Run};
use super::sat::{Budget, Encoding, Solver, Spent};

/// Where the cycles begin.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum From {
    /// In a start state.
    Start,
    /// In any state that keeps the invariants.
    Anywhere,
}

/// Cycles, and a solver that knows what holds in them.
pub(super) struct Unrolling<'a> {
    problem: &'a Problem<'a>,
    graph: Graph,
    solver: Solver,
    encoding: Encoding,
    /// The latches of the cone at the start of each cycle, and after the last one.
    states: Vec<Vec<Lit>>,
    /// The inputs of the cone in each cycle.
    inputs: Vec<Vec<Lit>>,
    /// What is looked for, in each cycle.
    bad: Vec<Lit>,
}

impl<'a> Unrolling<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, from: From, budget: &Budget) -> Self {
        let mut graph = Graph::default();
        let state = problem
            .cone()
            .map(|latch| match latch.init {
                Some(value) if from == From::Start => Lit::constant(value),
                _ => graph.leaf(),
            })
            .collect();
        let encoding = Encoding::new(&graph);
        let mut unrolling = Unrolling {
            problem,
            graph,
            solver: Solver::new(budget),
            encoding,
            states: vec![state],
            inputs: Vec::new(),
            bad: Vec::new(),
        };
        if from == From::Start {
            unrolling.hold(&problem.start);
        }
        unrolling
    }

    /// Cycles so far.
    pub(super) fn cycles(&self) -> usize {
        self.bad.len()
    }

    /// These conditions on the latches hold in the first cycle.
    fn hold(&mut self, conditions: &[Lit]) {
        let map = (self.problem).copy(&mut self.graph, &self.states[0], &[]);
        for lit in conditions {
            let lit = map[lit.node()].flipped(lit.negated());
            self.require(lit);
        }
    }

    /// One cycle more.
    pub(super) fn extend(&mut self) {
        let problem = self.problem;
        let inputs: Vec<Lit> = problem.inputs.iter().map(|_| self.graph.leaf()).collect();
        let map = problem.copy(&mut self.graph, &self.states[self.bad.len()], &inputs);
        let at = |lit: Lit| map[lit.node()].flipped(lit.negated());
        for lit in problem.invariants.iter().chain(&problem.assumed) {
            self.require(at(*lit));
        }
        self.bad.push(at(problem.bad));
        self.inputs.push(inputs);
        self.states
            .push(problem.cone().map(|latch| at(latch.next)).collect());
    }

    /// A condition that must hold.
    pub(super) fn require(&mut self, lit: Lit) {
        let term = self.encoding.term(&mut self.solver, &self.graph, lit);
        self.solver.clause([term]);
    }

    /// What is looked for does not happen in this cycle.
    pub(super) fn exclude(&mut self, cycle: usize) {
        self.require(!self.bad[cycle]);
    }

    /// Whether what is looked for can happen in this cycle.
    pub(super) fn possible(&mut self, cycle: usize) -> Result<bool, Spent> {
        let bad = self.bad[cycle];
        if bad == Lit::FALSE {
            return Ok(false);
        }
        let term = self.encoding.term(&mut self.solver, &self.graph, bad);
        self.solver.solve(&[term])
    }

    /// Two cycles that begin in the same state in the solver's answer, if there are any.
    pub(super) fn repeated(&self) -> Option<(usize, usize)> {
        // Only the variables are read off: a conjunction need not be one of the solver's.
        let values = (self.graph).values(|node| self.value(Lit::of(node)).unwrap_or(false));
        let state = |k: usize| -> Vec<bool> {
            let lits = self.states[k].iter();
            lits.map(|lit| value(&values, *lit)).collect()
        };
        let states: Vec<Vec<bool>> = (0..self.cycles()).map(state).collect();
        (1..states.len()).find_map(|later| {
            (0..later)
                .find(|k| states[*k] == states[later])
                .map(|k| (k, later))
        })
    }

    /// Two cycles begin in different states.
    pub(super) fn separate(&mut self, one: usize, other: usize) {
        let pairs: Vec<(Lit, Lit)> = (self.states[one].iter().copied())
            .zip(self.states[other].iter().copied())
            .collect();
        let mut differ = Lit::FALSE;
        for (a, b) in pairs {
            let here = self.graph.xor(a, b);
            differ = self.graph.or(differ, here);
        }
        self.require(differ);
    }

    fn value(&self, lit: Lit) -> Option<bool> {
        match lit.known() {
            Some(value) => Some(value),
            None => self.encoding.value(&self.solver, lit),
        }
    }

    /// The run of the solver's answer, up to this cycle.
    pub(super) fn run(&self, last: usize) -> Run {
        let netlist = self.problem.netlist;
        let mut start = vec![None; netlist.latches.len()];
        for (place, lit) in self.problem.latches.iter().zip(&self.states[0]) {
            start[*place] = Some(self.value(*lit).unwrap_or(false));
        }
        let cycle = |inputs: &Vec<Lit>| {
            let mut all = vec![None; netlist.inputs.len()];
            for (place, lit) in self.problem.inputs.iter().zip(inputs) {
                all[*place] = Some(self.value(*lit).unwrap_or(false));
            }
            all
        };
        Run {
            start,
            cycles: self.inputs[..=last].iter().map(cycle).collect(),
        }
    }
}
