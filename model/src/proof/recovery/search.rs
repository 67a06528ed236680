//! Finds regions and ways out of them.

use super::super::graph::{Graph, Lit, value};
use super::super::invariant::Invariant;
use super::super::netlist::Problem;
use super::super::sat::{Budget, Encoding, Solver, Spent, Term};
use super::{Rank, Recovery, Step, Values, Ways};

/// Cycles of the runs that are looked for, and of those that are looked for last.
const CYCLES: usize = 6;
const MORE: usize = 40;

/// How many states are looked at for the sake of one: one behind the other, and in all.
const DEPTH: usize = 40;
const LOOKS: usize = 20_000;

/// A cycle, over the graph of the search.
struct Frame {
    state: Vec<Lit>,
    inputs: Vec<Lit>,
    next: Vec<Lit>,
    /// It may be one of the way.
    used: Lit,
    /// It shows the goal, or ends in a region.
    arrives: Lit,
}

pub(super) struct Search<'a> {
    pub(super) problem: &'a Problem<'a>,
    recovery: &'a Recovery<'a>,
    budget: &'a Budget,
    graph: Graph,
    solver: Solver,
    encoding: Encoding,
    frames: Vec<Frame>,
    /// In the first cycle: that number falls, that it rises.
    moves: Vec<[Lit; 2]>,
    /// The first cycle begins in a region.
    covered: Lit,
    /// By place in the cone: latches that stay as they are while a number falls.
    phase: Vec<bool>,
    /// States looked at for the sake of one, and how many these may be.
    looks: usize,
    most: usize,
    pub(super) ways: Ways,
}

fn of(values: &[bool], lits: &[Lit]) -> Vec<bool> {
    lits.iter().map(|lit| value(values, *lit)).collect()
}

/// Inputs and the number that falls under them.
type Choice = (Vec<bool>, Rank);

impl<'a> Search<'a> {
    pub(super) fn new(
        problem: &'a Problem<'a>,
        recovery: &'a Recovery<'a>,
        budget: &'a Budget,
    ) -> Self {
        let graph = Graph::default();
        let phase = problem.latches.iter();
        let phase = phase.map(|k| !recovery.timers.contains(k)).collect();
        let mut search = Search {
            problem,
            recovery,
            budget,
            encoding: Encoding::new(&graph),
            graph,
            solver: Solver::new(budget),
            frames: Vec::new(),
            moves: Vec::new(),
            covered: Lit::FALSE,
            phase,
            looks: 0,
            most: LOOKS,
            ways: Ways::default(),
        };
        search.frame();
        // All of the state is the solver's, so that its answers are whole states.
        for lit in search.frames[0].state.clone() {
            search.term(lit);
        }
        search
    }

    fn term(&mut self, lit: Lit) -> Term {
        self.encoding.term(&mut self.solver, &self.graph, lit)
    }

    fn require(&mut self, lit: Lit) {
        let term = self.term(lit);
        self.solver.clause([term]);
    }

    /// One cycle more behind the others.
    fn frame(&mut self) {
        let problem = self.problem;
        let state: Vec<Lit> = match self.frames.last() {
            Some(last) => last.next.clone(),
            None => problem.cone().map(|_| self.graph.leaf()).collect(),
        };
        let inputs: Vec<Lit> = problem.inputs.iter().map(|_| self.graph.leaf()).collect();
        let map = problem.copy(&mut self.graph, &state, &inputs);
        let at = |lit: Lit| map[lit.node()].flipped(lit.negated());
        if self.frames.is_empty() {
            // Of later cycles this follows, if the inputs are possible: to require it would exclude those that are not.
            for lit in &problem.invariants {
                let term = self.encoding.term(&mut self.solver, &self.graph, at(*lit));
                self.solver.clause([term]);
            }
        }
        let next: Vec<Lit> = problem.cone().map(|latch| at(latch.next)).collect();
        let assumed = problem.assumed.iter().map(|lit| at(*lit));
        let used = assumed.chain([at(self.recovery.using)]);
        let used = self.graph.all(used.collect::<Vec<_>>());
        if self.frames.is_empty() {
            let mut moved = map.clone();
            for (latch, lit) in problem.cone().zip(&next) {
                moved[latch.lit.node()] = *lit;
            }
            for number in self.recovery.numbers {
                let (now, then) = (number.placed(&map), number.placed(&moved));
                let falls = then.less(&mut self.graph, &now);
                let rises = now.less(&mut self.graph, &then);
                self.moves.push([falls, rises]);
            }
        }
        let mut arrives = at(self.recovery.goal);
        for k in 0..self.ways.steps.len() {
            let region = self.ways.steps[k].region.clone();
            let region = self.inside(&region, &next);
            arrives = self.graph.or(arrives, region);
        }
        self.frames.push(Frame {
            state,
            inputs,
            next,
            used,
            arrives,
        });
    }

    /// The place of a latch in the cone.
    fn place(&self, latch: usize) -> Option<usize> {
        self.problem.latches.binary_search(&latch).ok()
    }

    /// That a state is in a region.
    fn inside(&mut self, region: &Values, state: &[Lit]) -> Lit {
        let parts = region.iter().map(|(latch, value)| {
            let place = self.problem.latches.binary_search(latch);
            place.map_or(Lit::FALSE, |place| state[place].flipped(!value))
        });
        self.graph.all(parts.collect::<Vec<_>>())
    }

    /// Every state keeps to this too. It may speak of latches that are not in the cone: then it says nothing here.
    pub(super) fn learn(&mut self, invariant: Invariant) {
        for clause in invariant.clauses {
            let state = &self.frames[0].state;
            let part =
                |(latch, value): &(usize, bool)| Some(state[self.place(*latch)?].flipped(!value));
            if let Some(parts) = clause.iter().map(part).collect::<Option<Vec<Lit>>>() {
                let any = self.graph.any(parts);
                self.require(any);
            }
            self.ways.invariant.clauses.push(clause);
        }
    }

    /// A state, or all those that differ from it in numbers only.
    pub(super) fn cube(&self, state: &[bool], numbers: bool) -> Values {
        let latches = self.problem.latches.iter().zip(state).zip(&self.phase);
        let kept = latches.filter(|(_, phase)| numbers || **phase);
        kept.map(|((latch, value), _)| (*latch, *value)).collect()
    }

    /// Whether the invariant has a clause that this state breaks.
    pub(super) fn excludes(&self, invariant: &Invariant, state: &[bool]) -> bool {
        let wrong = |(latch, value): &(usize, bool)| {
            let place = self.place(*latch);
            place.is_some_and(|place| state[place] != *value)
        };
        invariant.clauses.iter().any(|c| c.iter().all(wrong))
    }

    /// The solver's answer, by node. Only the variables are read off: a conjunction need not be one of the solver's.
    fn answer(&self) -> Vec<bool> {
        let leaf = |node| self.encoding.value(&self.solver, Lit::of(node));
        self.graph.values(|node| leaf(node).unwrap_or(false))
    }

    fn solve(&mut self, lits: &[Lit]) -> Result<bool, Spent> {
        // The solvers of small questions hardly ever look at the time.
        if self.budget.spent() {
            return Err(Spent);
        }
        if lits.contains(&Lit::FALSE) {
            return Ok(false);
        }
        let terms: Vec<Term> = lits.iter().map(|lit| self.term(*lit)).collect();
        self.solver.solve(&terms)
    }

    /// A state of the invariant that is in no region, and among `these`.
    pub(super) fn uncovered(&mut self, these: &[Lit]) -> Result<Option<Vec<bool>>, Spent> {
        let found = self.solve(&[these, &[!self.covered]].concat())?;
        Ok(found.then(|| of(&self.answer(), &self.frames[0].state)))
    }

    /// That a state differs from this one in more than numbers.
    pub(super) fn others(&mut self, state: &[bool]) -> Lit {
        let region = self.cube(state, false);
        let now = self.frames[0].state.clone();
        !self.inside(&region, &now)
    }

    fn fixed(lits: &[Lit], values: &[bool]) -> Vec<Lit> {
        let pairs = lits.iter().zip(values);
        pairs.map(|(lit, value)| lit.flipped(!value)).collect()
    }

    /// Whether there are regions now that lead from this state to the goal, where at most so many states are looked at; without a number as
    /// many as ever.
    pub(super) fn within(&mut self, state: &[bool], looks: Option<usize>) -> Result<bool, Spent> {
        (self.looks, self.most) = (0, looks.unwrap_or(LOOKS));
        self.reach(state, 0)
    }

    /// Whether there are regions now that lead from this state to the goal.
    fn reach(&mut self, state: &[bool], depth: usize) -> Result<bool, Spent> {
        let here = Self::fixed(&self.frames[0].state, state);
        let known = [&here[..], &[self.covered]].concat();
        if self.solve(&known)? {
            return Ok(true);
        }
        self.looks += 1;
        if depth > DEPTH || self.looks > self.most {
            return Ok(false);
        }
        for cycles in 1..=CYCLES {
            if self.run(&here, cycles)? {
                return Ok(true);
            }
        }
        for number in 0..self.moves.len() {
            for rises in [false, true] {
                // Too much was looked at: all that led here ends too.
                if self.looks > self.most {
                    return Ok(false);
                }
                if self.accelerate(&here, state, Rank { number, rises }, depth)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// The same by longer runs.
    pub(super) fn far(&mut self, state: &[bool]) -> Result<bool, Spent> {
        let here = Self::fixed(&self.frames[0].state, state);
        for cycles in CYCLES + 1..=MORE {
            if self.run(&here, cycles)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Looks for a run of so many cycles from a state into the regions, and makes a region of each of its cycles.
    fn run(&mut self, here: &[Lit], cycles: usize) -> Result<bool, Spent> {
        while self.frames.len() < cycles {
            self.frame();
        }
        let used = self.frames[..cycles].iter().map(|frame| frame.used);
        let mut asked: Vec<Lit> = here.iter().copied().chain(used).collect();
        asked.push(self.frames[cycles - 1].arrives);
        if !self.solve(&asked)? {
            return Ok(false);
        }
        let values = self.answer();
        let frames = self.frames[..cycles].iter();
        let way = frames.map(|frame| (of(&values, &frame.state), of(&values, &frame.inputs)));
        let way: Vec<(Vec<bool>, Vec<bool>)> = way.collect();
        for (state, inputs) in way.iter().rev() {
            let outside = Self::fixed(&self.frames[0].state, state);
            if !self.solve(&[&outside[..], &[!self.covered]].concat())? {
                continue;
            }
            let all = 0..state.len();
            let cube: Vec<(usize, bool)> = all.zip(state.iter().copied()).collect();
            let frame = &self.frames[0];
            let (given, ends) = (
                Self::fixed(&frame.inputs, inputs),
                [frame.used, frame.arrives],
            );
            let ends = self.graph.all(ends);
            let wrong = [&given[..], &[!ends, !self.covered]].concat();
            let Some(cube) = self.shrunk(cube, &wrong)? else {
                return Ok(false);
            };
            self.add(&cube, inputs, None);
        }
        Ok(true)
    }

    /// A smaller cube that cannot hold together with `wrong` either; none if it can.
    fn shrunk(
        &mut self,
        cube: Vec<(usize, bool)>,
        wrong: &[Lit],
    ) -> Result<Option<Vec<(usize, bool)>>, Spent> {
        let mut cube = cube;
        let lits = |search: &Self, cube: &[(usize, bool)]| -> Vec<Lit> {
            let state = &search.frames[0].state;
            let parts = cube.iter().map(|(k, value)| state[*k].flipped(!value));
            parts.chain(wrong.iter().copied()).collect()
        };
        let all = lits(self, &cube);
        if self.solve(&all)? {
            return Ok(None);
        }
        self.enough(&mut cube);
        let mut k = 0;
        // What changes most is left out first.
        cube.sort_by_key(|(k, _)| self.phase[*k]);
        while k < cube.len() {
            let mut less = cube.clone();
            less.remove(k);
            let asked = lits(self, &less);
            if self.solve(&asked)? {
                k += 1;
            } else {
                self.enough(&mut less);
                cube = less;
            }
        }
        Ok(Some(cube))
    }

    /// Of the cube of a question just answered with no those literals that are enough.
    fn enough(&mut self, cube: &mut Vec<(usize, bool)>) {
        let state = &self.frames[0].state;
        let (solver, encoding) = (&self.solver, &self.encoding);
        cube.retain(|(k, value)| {
            let term = encoding.made(state[*k].flipped(!value));
            term.is_some_and(|term| solver.failed(term))
        });
    }

    /// A region of this cube.
    fn add(&mut self, cube: &[(usize, bool)], inputs: &[bool], rank: Option<Rank>) {
        let latches = &self.problem.latches;
        let mut region: Values = cube.iter().map(|(k, v)| (latches[*k], *v)).collect();
        region.sort_unstable();
        let inputs = self.problem.inputs.iter().copied().zip(inputs.to_vec());
        let now = self.frames[0].state.clone();
        let here = self.inside(&region, &now);
        self.covered = self.graph.or(self.covered, here);
        for k in 0..self.frames.len() {
            let next = self.frames[k].next.clone();
            let there = self.inside(&region, &next);
            self.frames[k].arrives = self.graph.or(self.frames[k].arrives, there);
        }
        let inputs = inputs.collect();
        self.ways.steps.push(Step {
            region,
            inputs,
            rank,
        });
    }

    /// Looks for inputs under which a number falls from a state and nothing else changes, and makes a region of all states that differ in
    /// numbers only. States that leave it must be in regions before.
    fn accelerate(
        &mut self,
        here: &[Lit],
        state: &[bool],
        rank: Rank,
        depth: usize,
    ) -> Result<bool, Spent> {
        let moves = self.moves[rank.number][usize::from(rank.rises)];
        let cube: Vec<(usize, bool)> = (0..state.len())
            .filter(|k| self.phase[*k])
            .map(|k| (k, state[k]))
            .collect();
        let frame = &self.frames[0];
        let stays = cube.iter().map(|(k, v)| frame.next[*k].flipped(!v));
        let stays: Vec<Lit> = stays.collect();
        let asked = [here, &stays[..], &[moves, frame.used]].concat();
        if !self.solve(&asked)? {
            return Ok(false);
        }
        let choice = (of(&self.answer(), &self.frames[0].inputs), rank);
        for _ in 0..DEPTH {
            let asked = self.wrong(&cube, &choice);
            if !self.solve(&asked)? {
                let cube = self.widened(cube, &choice)?;
                self.add(&cube, &choice.0, Some(rank));
                return Ok(true);
            }
            let frame = &self.frames[0];
            let values = self.answer();
            let used = value(&values, frame.used);
            let (from, to) = (of(&values, &frame.state), of(&values, &frame.next));
            let inside = cube.iter().all(|(k, value)| to[*k] == *value);
            let other = if inside { from.clone() } else { to };
            if !used || from == state || !self.reach(&other, depth + 1)? {
                return Ok(false);
            }
        }
        Ok(false)
    }

    /// What shows that a cube is no region.
    fn wrong(&mut self, cube: &[(usize, bool)], (inputs, rank): &Choice) -> Vec<Lit> {
        let frame = &self.frames[0];
        let within = cube.iter().map(|(k, v)| frame.state[*k].flipped(!v));
        let mut asked: Vec<Lit> = within.collect();
        asked.extend(Self::fixed(&frame.inputs, inputs));
        let moves = self.moves[rank.number][usize::from(rank.rises)];
        let stays = cube.iter().map(|(k, v)| frame.next[*k].flipped(!v));
        let stays = self.graph.all(stays.chain([moves]).collect::<Vec<_>>());
        let frame = &self.frames[0];
        let arrives = self.graph.or(frame.arrives, stays);
        let fine = self.graph.and(arrives, self.frames[0].used);
        asked.extend([!fine, !self.covered]);
        asked
    }

    /// A region without what it need not say.
    fn widened(
        &mut self,
        cube: Vec<(usize, bool)>,
        choice: &Choice,
    ) -> Result<Vec<(usize, bool)>, Spent> {
        let mut cube = cube;
        let mut k = 0;
        while k < cube.len() {
            let mut less = cube.clone();
            less.remove(k);
            let asked = self.wrong(&less, choice);
            match self.solve(&asked)? {
                true => k += 1,
                false => cube = less,
            }
        }
        Ok(cube)
    }
}
