//! The frames: for each level k the states that are not known to be out of reach in k cycles, as clauses in a solver.

use super::cube::{Cube, Fixed};
use crate::proof::graph::Lit;
use crate::proof::netlist::{Latch, Problem};
use crate::proof::sat::{Budget, Encoding, Solver, Spent, Term};

/// A solver is made anew after so many clauses for one question each.
const TEMPORARY: usize = 2000;

/// The solver of a level.
pub(super) struct Frame {
    solver: Solver,
    encoding: Encoding,
    temporary: usize,
}

/// What a frame answers to a question about a cube.
pub(super) enum Answer {
    /// No state of the frame leads there; these of its values are enough for that.
    Blocked(Cube),
    /// Values of the variables, by node, with which one does.
    Reached(Vec<bool>),
}

impl Frame {
    fn new(problem: &Problem, first: bool, budget: &Budget) -> Self {
        let graph = problem.graph();
        let mut frame = Frame {
            solver: Solver::new(budget),
            encoding: Encoding::new(graph),
            temporary: 0,
        };
        let inputs = problem.inputs.iter();
        let inputs = inputs.map(|k| problem.netlist.inputs[*k].lit);
        let variables: Vec<Lit> = problem.cone().map(|l| l.lit).chain(inputs).collect();
        for lit in variables {
            frame.encoding.term(&mut frame.solver, graph, lit);
        }
        let mut conditions = [&problem.invariants[..], &problem.assumed[..]].concat();
        if first {
            conditions.extend(problem.begin());
        }
        for lit in conditions {
            let term = frame.encoding.term(&mut frame.solver, graph, lit);
            frame.solver.clause([term]);
        }
        frame
    }

    fn term(&mut self, problem: &Problem, lit: Lit) -> Term {
        self.encoding.term(&mut self.solver, problem.graph(), lit)
    }

    /// The states of a cube are out of reach.
    fn exclude(&mut self, problem: &Problem, latches: &[&Latch], cube: &Cube) {
        let clause: Vec<Term> = (cube.list().iter())
            .map(|fixed| !self.term(problem, now(latches, *fixed)))
            .collect();
        self.solver.clause(clause);
    }

    /// The values of all variables in the solver's answer, by node.
    fn values(&self, problem: &Problem) -> Vec<bool> {
        let mut values = vec![false; problem.graph().size()];
        let inputs = problem.inputs.iter();
        let inputs = inputs.map(|k| problem.netlist.inputs[*k].lit);
        for lit in problem.cone().map(|l| l.lit).chain(inputs) {
            values[lit.node()] = self.encoding.value(&self.solver, lit).unwrap_or(false);
        }
        values
    }
}

/// That a latch has this value.
fn now(latches: &[&Latch], fixed: Fixed) -> Lit {
    latches[fixed.latch()].lit.flipped(!fixed.value())
}

/// That a latch has this value after the cycle.
pub(super) fn next(latches: &[&Latch], fixed: Fixed) -> Lit {
    latches[fixed.latch()].next.flipped(!fixed.value())
}

/// All frames. Level 0 is the start; each other one has the lemmas of its own level and of all above.
pub(super) struct Frames<'a> {
    problem: &'a Problem<'a>,
    pub(super) latches: Vec<&'a Latch>,
    frames: Vec<Frame>,
    /// Cubes out of reach, each at the highest level where that is known.
    lemmas: Vec<Vec<Cube>>,
    /// How often each latch has stood in a lemma, the last ones counting more.
    activity: Vec<f64>,
    budget: Budget,
}

impl<'a> Frames<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, budget: &Budget) -> Self {
        Frames {
            problem,
            latches: problem.cone().collect(),
            frames: vec![Frame::new(problem, true, budget)],
            lemmas: vec![Vec::new()],
            activity: vec![0.0; problem.latches.len()],
            budget: budget.clone(),
        }
    }

    /// The highest level.
    pub(super) fn top(&self) -> usize {
        self.frames.len() - 1
    }

    /// A level more, where nothing is known yet.
    pub(super) fn raise(&mut self) {
        self.frames
            .push(Frame::new(self.problem, false, &self.budget));
        self.lemmas.push(Vec::new());
    }

    pub(super) fn lemmas(&self, level: usize) -> &[Cube] {
        &self.lemmas[level]
    }

    pub(super) fn activity(&self, fixed: Fixed) -> f64 {
        self.activity[fixed.latch()]
    }

    /// Values with which what is looked for happens in a state of a level, if there are any.
    pub(super) fn bad(&mut self, level: usize) -> Result<Option<Vec<bool>>, Spent> {
        let problem = self.problem;
        let frame = &mut self.frames[level];
        let bad = frame.term(problem, problem.bad);
        let found = frame.solver.solve(&[bad])?;
        Ok(found.then(|| frame.values(problem)))
    }

    /// A start state in a cube, as values of the variables by node; else those of its values that keep it off the start.
    pub(super) fn start(&mut self, cube: &Cube) -> Result<Answer, Spent> {
        // Mostly a latch with a fixed start value tells.
        let off = |fixed: &Fixed| self.latches[fixed.latch()].init == Some(!fixed.value());
        if let Some(fixed) = cube.list().iter().copied().find(off) {
            return Ok(Answer::Blocked(Cube::new(vec![fixed])));
        }
        let frame = &mut self.frames[0];
        let mut assumed = Vec::with_capacity(cube.list().len());
        for fixed in cube.list() {
            assumed.push(frame.term(self.problem, now(&self.latches, *fixed)));
        }
        if frame.solver.solve(&assumed)? {
            return Ok(Answer::Reached(frame.values(self.problem)));
        }
        let mut terms = assumed.iter();
        Ok(Answer::Blocked(cube.only(|_| {
            terms.next().is_some_and(|t| frame.solver.failed(*t))
        })))
    }

    /// Whether a cycle leads from a state of a level, and with `outside` from one that is not in the cube, into the cube.
    pub(super) fn enters(
        &mut self,
        level: usize,
        cube: &Cube,
        outside: bool,
    ) -> Result<Answer, Spent> {
        let problem = self.problem;
        if self.frames[level].temporary > TEMPORARY {
            self.renew(level);
        }
        let frame = &mut self.frames[level];
        let mut assumed = Vec::with_capacity(cube.list().len() + 1);
        for fixed in cube.list() {
            assumed.push(frame.term(problem, next(&self.latches, *fixed)));
        }
        let mut only_here = None;
        if outside {
            let switch = frame.solver.variable();
            let mut clause = vec![!switch];
            for fixed in cube.list() {
                clause.push(!frame.term(problem, now(&self.latches, *fixed)));
            }
            frame.solver.clause(clause);
            frame.temporary += 1;
            assumed.push(switch);
            only_here = Some(switch);
        }
        let reached = frame.solver.solve(&assumed)?;
        let answer = if reached {
            Answer::Reached(frame.values(problem))
        } else {
            let mut terms = assumed.iter();
            Answer::Blocked(cube.only(|_| terms.next().is_some_and(|t| frame.solver.failed(*t))))
        };
        if let Some(switch) = only_here {
            frame.solver.clause([!switch]);
        }
        Ok(answer)
    }

    /// A solver without what was added for one question each.
    fn renew(&mut self, level: usize) {
        let mut frame = Frame::new(self.problem, level == 0, &self.budget);
        if level > 0 {
            for cube in self.lemmas[level..].iter().flatten() {
                frame.exclude(self.problem, &self.latches, cube);
            }
        }
        self.frames[level] = frame;
    }

    /// Whether a lemma says that a cube is out of reach at a level.
    pub(super) fn excluded(&self, level: usize, cube: &Cube) -> bool {
        (self.lemmas[level..].iter().flatten()).any(|lemma| lemma.covers(cube))
    }

    /// A cube is out of reach up to a level.
    pub(super) fn learn(&mut self, level: usize, cube: Cube) {
        for known in &mut self.lemmas[1..=level] {
            known.retain(|other| !cube.covers(other));
        }
        for frame in &mut self.frames[1..=level] {
            frame.exclude(self.problem, &self.latches, &cube);
        }
        for fixed in cube.list() {
            self.activity[fixed.latch()] += 1.0;
        }
        if cube.list().iter().any(|f| self.activity[f.latch()] > 1e6) {
            self.activity.iter_mut().for_each(|a| *a *= 1e-6);
        }
        self.lemmas[level].push(cube);
    }

    /// Lemmas count less than those that follow.
    pub(super) fn fade(&mut self) {
        self.activity.iter_mut().for_each(|a| *a *= 0.99);
    }
}
