//! Property-directed reachability (IC3): clauses learned from states that lead to what is looked for, until they are an inductive
//! invariant, or until such a state is a start state.
//!
//! After A. Bradley, *SAT-based model checking without unrolling* (2011), N. Eén, A. Mishchenko and R. Brayton, *Efficient
//! implementation of property directed reachability* (2011), and Z. Hassan, A. Bradley and F. Somenzi, *Better generalization in
//! IC3* (2013).

mod cube;
mod frames;
mod lift;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::graph::Lit;
use super::invariant::Invariant;
use super::netlist::{Problem, Run};
use super::sat::{Budget, Spent};
use cube::{Cube, Fixed};
use frames::{Answer, Frames, next};
use lift::Lift;

/// What it finds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reachability {
    /// Nowhere, by this invariant.
    Proved(Invariant),
    /// A run, not always a shortest one.
    Found(Run),
}

/// What it took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Levels.
    pub levels: usize,
    /// Lemmas learned.
    pub lemmas: usize,
    /// Cubes to be shown out of reach.
    pub obligations: usize,
}

/// How many counterexamples to a generalisation are shown out of reach for its sake, and how deep that goes.
const AROUND: usize = 3;
const DEPTH: usize = 1;

/// Decides whether `bad` can be reached.
///
/// # Errors
/// The budget is spent.
pub fn reachability(problem: &Problem, budget: &Budget) -> Result<(Reachability, Effort), Spent> {
    let mut engine = Engine::new(problem, usize::MAX, budget);
    let found = engine.decide()?;
    Ok((found, engine.effort))
}

/// Decides whether `bad` can be reached, if that takes no more than so many obligations.
///
/// # Errors
/// The budget is spent.
pub fn attempt(
    problem: &Problem,
    most: usize,
    budget: &Budget,
) -> Result<Option<Reachability>, Spent> {
    let mut engine = Engine::new(problem, most, budget);
    match engine.decide() {
        Err(Spent) if engine.weary() => Ok(None),
        found => found.map(Some),
    }
}

/// States that lead to what is looked for.
struct Obligation {
    cube: Cube,
    /// Inputs with which each of its states leads into those of `then`, or is bad itself.
    inputs: Vec<bool>,
    then: Option<usize>,
}

struct Engine<'a> {
    problem: &'a Problem<'a>,
    frames: Frames<'a>,
    lift: Lift,
    budget: &'a Budget,
    /// The most obligations.
    most: usize,
    obligations: Vec<Obligation>,
    effort: Effort,
}

impl<'a> Engine<'a> {
    fn new(problem: &'a Problem<'a>, most: usize, budget: &'a Budget) -> Self {
        Engine {
            problem,
            frames: Frames::new(problem, budget),
            lift: Lift::new(
                problem.graph(),
                &problem.nodes,
                problem.cone().map(|l| l.lit),
            ),
            budget,
            most,
            obligations: Vec::new(),
            effort: Effort::default(),
        }
    }

    /// Whether there were more obligations than there may be.
    fn weary(&self) -> bool {
        self.effort.obligations > self.most
    }

    fn decide(&mut self) -> Result<Reachability, Spent> {
        // A run of one cycle.
        if let Some(mut values) = self.frames.bad(0)? {
            let first = self.ending(&mut values);
            return Ok(Reachability::Found(self.run(first, &values)));
        }
        loop {
            self.frames.raise();
            let top = self.frames.top();
            self.effort.levels = top;
            while let Some(mut values) = self.frames.bad(top)? {
                let first = self.ending(&mut values);
                if let Some(run) = self.block(first, top)? {
                    return Ok(Reachability::Found(run));
                }
                self.obligations.clear();
            }
            if let Some(level) = self.propagate()? {
                return Ok(Reachability::Proved(self.invariant(level)));
            }
        }
    }

    /// The obligation from values with which a state is bad.
    fn ending(&mut self, values: &mut [bool]) -> usize {
        let cube = self.lifted(&[self.problem.bad], values);
        self.oblige(cube, values, None)
    }

    fn oblige(&mut self, cube: Cube, values: &[bool], then: Option<usize>) -> usize {
        let inputs = self.problem.inputs.iter();
        let inputs = inputs
            .map(|k| values[self.problem.netlist.inputs[*k].lit.node()])
            .collect();
        self.effort.obligations += 1;
        self.obligations.push(Obligation { cube, inputs, then });
        self.obligations.len() - 1
    }

    /// States that lead into a cube, from values with which one does.
    fn before(&mut self, cube: &Cube, values: &mut [bool]) -> Cube {
        let latches = &self.frames.latches;
        let roots = cube.list().iter().map(|fixed| next(latches, *fixed));
        let roots: Vec<Lit> = roots.collect();
        self.lifted(&roots, values)
    }

    /// States in which `roots` have the values that they have with these, and the inputs are allowed, which may depend on the state.
    fn lifted(&mut self, roots: &[Lit], values: &mut [bool]) -> Cube {
        let roots = roots.iter().chain(&self.problem.assumed).copied();
        self.lift.cube(self.problem.graph(), values, roots)
    }

    /// Shows that the states of an obligation are out of reach at a level, with all that this takes, or finds a run.
    fn block(&mut self, first: usize, level: usize) -> Result<Option<Run>, Spent> {
        if let Answer::Reached(values) = self.frames.start(&self.obligations[first].cube.clone())? {
            return Ok(Some(self.run(first, &values)));
        }
        let mut open = BinaryHeap::from([Reverse((level, first))]);
        while let Some(Reverse((level, number))) = open.pop() {
            // The solvers of small questions hardly ever look at the time.
            if self.budget.spent() || self.weary() {
                return Err(Spent);
            }
            let cube = self.obligations[number].cube.clone();
            if self.frames.excluded(level, &cube) {
                if level < self.frames.top() {
                    open.push(Reverse((level + 1, number)));
                }
                continue;
            }
            match self.frames.enters(level - 1, &cube, true)? {
                Answer::Blocked(core) => {
                    let core = self.off_start(core, &cube)?;
                    let lemma = self.generalise(core, level, 0)?;
                    let at = self.push(lemma, level)?;
                    if at < self.frames.top() {
                        open.push(Reverse((at + 1, number)));
                    }
                }
                Answer::Reached(mut values) => {
                    let before = self.before(&cube, &mut values);
                    let earlier = self.oblige(before.clone(), &values, Some(number));
                    if let Answer::Reached(values) = self.frames.start(&before)? {
                        return Ok(Some(self.run(earlier, &values)));
                    }
                    open.push(Reverse((level - 1, earlier)));
                    open.push(Reverse((level, number)));
                }
            }
        }
        Ok(None)
    }

    /// A part of a cube off the start, with values of the cube added that keep it off.
    fn off_start(&mut self, part: Cube, cube: &Cube) -> Result<Cube, Spent> {
        if let Answer::Blocked(_) = self.frames.start(&part)? {
            return Ok(part);
        }
        match self.frames.start(cube)? {
            Answer::Blocked(off) => Ok(cube.only(|f| part.has(f) || off.has(f))),
            Answer::Reached(_) => Ok(cube.clone()),
        }
    }

    /// A larger cube that is out of reach at a level as well: values are left out as long as that holds.
    fn generalise(&mut self, cube: Cube, level: usize, depth: usize) -> Result<Cube, Spent> {
        let mut order: Vec<Fixed> = cube.list().to_vec();
        // First those that stand in few lemmas.
        order.sort_by(|a, b| {
            let (x, y) = (self.frames.activity(*a), self.frames.activity(*b));
            x.total_cmp(&y).then(a.cmp(b))
        });
        let mut best = cube;
        for fixed in order {
            if best.list().len() > 1 && best.has(fixed) {
                if let Some(larger) = self.down(best.without(fixed), level, depth)? {
                    best = larger;
                }
            }
        }
        Ok(best)
    }

    /// The cube or a larger one, if it is out of reach at a level. States that lead there are shown out of reach, or joined.
    fn down(&mut self, cube: Cube, level: usize, depth: usize) -> Result<Option<Cube>, Spent> {
        let mut cube = cube;
        let mut around = 0;
        loop {
            if let Answer::Reached(_) = self.frames.start(&cube)? {
                return Ok(None);
            }
            let mut values = match self.frames.enters(level - 1, &cube, true)? {
                Answer::Blocked(core) => return self.off_start(core, &cube).map(Some),
                Answer::Reached(values) => values,
            };
            if depth >= DEPTH {
                return Ok(None);
            }
            let before = self.before(&cube, &mut values);
            if around < AROUND && level > 1 {
                if let Answer::Blocked(_) = self.frames.start(&before)? {
                    if let Answer::Blocked(core) = self.frames.enters(level - 2, &before, true)? {
                        around += 1;
                        let core = self.off_start(core, &before)?;
                        let lemma = self.generalise(core, level - 1, depth + 1)?;
                        self.push(lemma, level - 1)?;
                        continue;
                    }
                }
            }
            around = 0;
            // What the state that leads there has in common with the cube.
            let same = |fixed: Fixed| {
                let lit = self.frames.latches[fixed.latch()].lit;
                values[lit.node()] == fixed.value()
            };
            let joined = cube.only(same);
            if joined.list().is_empty() || joined == cube {
                return Ok(None);
            }
            cube = joined;
        }
    }

    /// Learns a lemma at the highest level where it holds, which is the answer.
    fn push(&mut self, lemma: Cube, level: usize) -> Result<usize, Spent> {
        let (mut lemma, mut level) = (lemma, level);
        while level < self.frames.top() {
            let Answer::Blocked(core) = self.frames.enters(level, &lemma, true)? else {
                break;
            };
            lemma = self.off_start(core, &lemma)?;
            level += 1;
        }
        self.effort.lemmas += 1;
        self.frames.fade();
        self.frames.learn(level, lemma);
        Ok(level)
    }

    /// Moves lemmas up. A level that has none of its own left is an invariant.
    fn propagate(&mut self) -> Result<Option<usize>, Spent> {
        for level in 1..self.frames.top() {
            for lemma in self.frames.lemmas(level).to_vec() {
                // It may be gone by now, with one that says more.
                if !self.frames.lemmas(level).contains(&lemma) {
                    continue;
                }
                if let Answer::Blocked(core) = self.frames.enters(level, &lemma, false)? {
                    let lemma = self.off_start(core, &lemma)?;
                    self.frames.learn(level + 1, lemma);
                }
            }
            if self.frames.lemmas(level).is_empty() {
                return Ok(Some(level));
            }
        }
        Ok(None)
    }

    fn invariant(&self, level: usize) -> Invariant {
        let levels = level + 1..=self.frames.top();
        let lemmas = levels.flat_map(|level| self.frames.lemmas(level));
        let clause = |cube: &Cube| {
            let part = |f: &Fixed| (self.problem.latches[f.latch()], !f.value());
            cube.list().iter().map(part).collect()
        };
        Invariant {
            clauses: lemmas.map(clause).collect(),
        }
    }

    /// The run from the start state with these values through an obligation to its end.
    fn run(&self, first: usize, values: &[bool]) -> Run {
        let netlist = self.problem.netlist;
        let mut start = vec![None; netlist.latches.len()];
        for place in &self.problem.latches {
            start[*place] = Some(values[netlist.latches[*place].lit.node()]);
        }
        let mut cycles = Vec::new();
        let mut at = Some(first);
        while let Some(number) = at {
            let obligation = &self.obligations[number];
            let mut cycle = vec![None; netlist.inputs.len()];
            for (place, value) in self.problem.inputs.iter().zip(&obligation.inputs) {
                cycle[*place] = Some(*value);
            }
            cycles.push(cycle);
            at = obligation.then;
        }
        Run { start, cycles }
    }
}
