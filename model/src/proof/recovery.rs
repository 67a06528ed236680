//! Recoverability (`AG EF goal`): from every reachable state some inputs lead to a cycle with the goal.
//!
//! The proof is a ranking function in pieces: a list of regions, cubes of states, with inputs for each. With these inputs a cycle from a
//! region shows the goal, or ends in an earlier region, or stays in it while a number falls (or rises: it is bounded). Every state of an
//! inductive invariant is in a region. So from each reachable state the inputs of the regions lead to the goal, however long a timer
//! is, and whatever parameters are part of the state.
//!
//! Regions are found from states that are in none yet: the inputs of a short run from there into the regions, and then all states that
//! these inputs lead there alike. Where no short run does, inputs under which some number falls and nothing else changes.

use super::graph::{Graph, Lit, Node, value};
use super::invariant::Invariant;
use super::netlist::{Netlist, Problem};
use super::pdr::{Reachability, reachability};
use super::sat::{Budget, Encoding, Solver, Spent, Term};
use super::word::Word;

/// Cycles of the runs that are looked for, and of those that are looked for last.
const CYCLES: usize = 6;
const MORE: usize = 40;

/// A proof of more regions is none that anybody wants to read.
const REGIONS: usize = 2000;

/// How many states are looked at for the sake of one, and in all.
const DEPTH: usize = 40;
const LOOKS: usize = 20_000;

/// Values of bits, by the place of a latch or an input in the netlist.
pub type Values = Vec<(usize, bool)>;

/// A region and the way out of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// The states with these latches.
    pub region: Values,
    /// The inputs.
    pub inputs: Values,
    /// What falls as long as the region is not left.
    pub rank: Option<Rank>,
}

/// A number that falls with each cycle, or rises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rank {
    /// Its place in the list of numbers.
    pub number: usize,
    /// It rises.
    pub rises: bool,
}

/// Ways to the goal from all reachable states.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ways {
    /// What holds in every reachable state, beside the invariants of the netlist.
    pub invariant: Invariant,
    /// The regions, each of the states that are in none before.
    pub steps: Vec<Step>,
}

impl Ways {
    /// Whether they lead to the goal from every reachable state: by questions to a solver, with nothing of what found them.
    ///
    /// # Errors
    /// The budget is spent.
    pub fn check(&self, recovery: &Recovery, budget: &Budget) -> Result<bool, Spent> {
        let mut netlist = recovery.netlist.clone();
        let kept = self.kept(&mut netlist, budget)?;
        let map: Vec<Lit> = moved(&netlist);
        let latch = |k: &usize| (netlist.latches[*k].lit, netlist.latches[*k].next);
        let latches = (0..netlist.latches.len()).map(|k| latch(&k));
        let (now, next): (Vec<Lit>, Vec<Lit>) = latches.unzip();
        let inputs: Vec<Lit> = netlist.inputs.iter().map(|input| input.lit).collect();
        let cube = |values: &Values, lits: &[Lit]| -> Vec<Lit> {
            values.iter().map(|(k, v)| lits[*k].flipped(!v)).collect()
        };
        // Inputs on which nothing of this depends have possible values by themselves.
        let end = netlist.graph.and(recovery.goal, recovery.using);
        let assumed = Problem::new(&netlist, end).assumed;
        let graph = &mut netlist.graph;
        let mut given = netlist.invariants.clone();
        for clause in &self.invariant.clauses {
            let parts = clause.iter().map(|(k, v)| now[*k].flipped(!v));
            given.push(graph.any(parts.collect::<Vec<_>>()));
        }
        let used = assumed.into_iter().chain([recovery.using]);
        let used = graph.all(used.collect::<Vec<_>>());
        // For each region what is asked: a state of it, with its inputs, and no way out.
        let mut questions = Vec::new();
        let (mut outside, mut arrives) = (Vec::new(), recovery.goal);
        for step in &self.steps {
            let (here, there) = (cube(&step.region, &now), cube(&step.region, &next));
            let there = graph.all(there);
            let mut ends = arrives;
            if let Some(rank) = step.rank {
                let number = &recovery.numbers[rank.number];
                let (now, then) = (number.clone(), number.placed(&map));
                let (small, great) = if rank.rises { (now, then) } else { (then, now) };
                let moves = small.less(graph, &great);
                let stays = graph.and(there, moves);
                ends = graph.or(ends, stays);
            }
            let fine = graph.and(ends, used);
            let fixed = cube(&step.inputs, &inputs);
            questions.push([&outside[..], &here, &fixed, &[!fine]].concat());
            outside.push(!graph.all(here));
            arrives = graph.or(arrives, there);
        }
        questions.push(outside);
        let mut solver = Solver::new(budget);
        let mut encoding = Encoding::new(graph);
        for lit in given {
            let term = encoding.term(&mut solver, graph, lit);
            solver.clause([term]);
        }
        for question in questions {
            let terms: Vec<Term> = (question.iter())
                .map(|lit| encoding.term(&mut solver, graph, *lit))
                .collect();
            if solver.solve(&terms)? {
                return Ok(false);
            }
        }
        Ok(kept)
    }

    /// Whether the invariant is one.
    fn kept(&self, netlist: &mut Netlist, budget: &Budget) -> Result<bool, Spent> {
        let clauses = self.invariant.clauses.iter();
        let clauses: Vec<Vec<Lit>> = clauses
            .map(|clause| {
                let parts = clause.iter();
                let part = |(k, v): &(usize, bool)| netlist.latches[*k].lit.flipped(!v);
                parts.map(part).collect()
            })
            .collect();
        let mut holds = Lit::TRUE;
        for clause in clauses {
            let any = netlist.graph.any(clause);
            holds = netlist.graph.and(holds, any);
        }
        Ok(self.invariant.check(netlist, !holds, budget)?.is_ok())
    }
}

/// By node of a variable what it becomes in a cycle.
fn moved(netlist: &Netlist) -> Vec<Lit> {
    let mut map: Vec<Lit> = (0..netlist.graph.size()).map(Lit::of).collect();
    for latch in &netlist.latches {
        map[latch.lit.node()] = latch.next;
    }
    map
}

/// What a proof is looked for.
pub struct Recovery<'a> {
    /// The system.
    pub netlist: &'a Netlist,
    /// What must stay possible, over the state and the inputs of a cycle.
    pub goal: Lit,
    /// What must hold in each cycle on the way, the last one with the goal included.
    pub using: Lit,
    /// Numbers over the latches that may fall or rise.
    pub numbers: &'a [Word],
    /// Latches that may change while one of them does, by their places in the netlist.
    pub timers: &'a [usize],
}

/// Ways to the goal from all reachable states; none if they are not found, which says nothing.
///
/// # Errors
/// The budget is spent.
pub fn ways(recovery: &Recovery, budget: &Budget) -> Result<Option<Ways>, Spent> {
    let mut netlist = recovery.netlist.clone();
    let end = netlist.graph.and(recovery.goal, recovery.using);
    if end == Lit::FALSE {
        return Ok(None);
    }
    let problem = Problem::new(&netlist, end);
    let mut search = Search::new(&problem, recovery, budget);
    while let Some(state) = search.uncovered()? {
        if search.ways.steps.len() > REGIONS {
            return Ok(None);
        }
        if search.reach(&state, 0)? {
            continue;
        }
        // A state that is not reached needs no way. Where no inputs are possible the invariant need not exclude it.
        let invariant = unreachable(&netlist, &search, &state, budget)?;
        let Some(invariant) = invariant.filter(|own| search.excludes(own, &state)) else {
            return Ok(None);
        };
        search.learn(invariant);
    }
    Ok(Some(search.ways))
}

/// An invariant that excludes a state; none if it is reached.
fn unreachable(
    netlist: &Netlist,
    search: &Search,
    state: &[bool],
    budget: &Budget,
) -> Result<Option<Invariant>, Spent> {
    let mut netlist = netlist.clone();
    let graph = &mut netlist.graph;
    for clause in &search.ways.invariant.clauses {
        let parts = clause.iter();
        let parts = parts.map(|(k, v)| netlist.latches[*k].lit.flipped(!v));
        netlist
            .invariants
            .push(graph.any(parts.collect::<Vec<_>>()));
    }
    let here = search.problem.latches.iter().zip(state);
    let here = here.map(|(k, value)| netlist.latches[*k].lit.flipped(!value));
    let bad = graph.all(here.collect::<Vec<_>>());
    Ok(
        match reachability(&Problem::new(&netlist, bad), budget)?.0 {
            Reachability::Proved(invariant) => Some(invariant),
            Reachability::Found(_) => None,
        },
    )
}

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

struct Search<'a> {
    problem: &'a Problem<'a>,
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
    looks: usize,
    ways: Ways,
}

fn of(values: &[bool], lits: &[Lit]) -> Vec<bool> {
    lits.iter().map(|lit| value(values, *lit)).collect()
}

/// Inputs and the number that falls under them.
type Choice = (Vec<bool>, Rank);

impl<'a> Search<'a> {
    fn new(problem: &'a Problem<'a>, recovery: &'a Recovery<'a>, budget: &'a Budget) -> Self {
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
        let original = problem.graph();
        let mut map = vec![Lit::FALSE; original.size()];
        for (latch, lit) in problem.cone().zip(&state) {
            map[latch.lit.node()] = *lit;
        }
        for (place, lit) in problem.inputs.iter().zip(&inputs) {
            map[problem.netlist.inputs[*place].lit.node()] = *lit;
        }
        for node in &problem.nodes {
            if let Node::And(a, b) = original.node(*node) {
                let a = map[a.node()].flipped(a.negated());
                let b = map[b.node()].flipped(b.negated());
                map[*node] = self.graph.and(a, b);
            }
        }
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
    fn learn(&mut self, invariant: Invariant) {
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

    /// Whether the invariant has a clause that this state breaks.
    fn excludes(&self, invariant: &Invariant, state: &[bool]) -> bool {
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

    /// A state of the invariant that is in no region.
    fn uncovered(&mut self) -> Result<Option<Vec<bool>>, Spent> {
        let found = self.solve(&[!self.covered])?;
        Ok(found.then(|| of(&self.answer(), &self.frames[0].state)))
    }

    fn fixed(lits: &[Lit], values: &[bool]) -> Vec<Lit> {
        let pairs = lits.iter().zip(values);
        pairs.map(|(lit, value)| lit.flipped(!value)).collect()
    }

    /// Whether there are regions now that lead from this state to the goal.
    fn reach(&mut self, state: &[bool], depth: usize) -> Result<bool, Spent> {
        let here = Self::fixed(&self.frames[0].state, state);
        let known = [&here[..], &[self.covered]].concat();
        if self.solve(&known)? {
            return Ok(true);
        }
        self.looks += 1;
        if depth > DEPTH || self.looks > LOOKS {
            return Ok(false);
        }
        for cycles in 1..=CYCLES {
            if self.run(&here, cycles)? {
                return Ok(true);
            }
        }
        for number in 0..self.moves.len() {
            for rises in [false, true] {
                if self.accelerate(&here, state, Rank { number, rises }, depth)? {
                    return Ok(true);
                }
            }
        }
        for cycles in CYCLES + 1..=if depth == 0 { MORE } else { CYCLES } {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A stop that ends when its timer has run down and a reset comes. The timer begins with a limit, which has any value and never
    /// changes. A machine that is locked stays so.
    struct Stop {
        netlist: Netlist,
        free: Lit,
        numbers: Vec<Word>,
        timers: Vec<usize>,
    }

    const BITS: usize = 12;

    fn stop(lockable: bool) -> Stop {
        let mut netlist = Netlist::default();
        let stopped = netlist.latch("stopped".to_owned(), Some(false));
        let locked = netlist.latch("locked".to_owned(), Some(false));
        let word = |netlist: &mut Netlist, name: &str, init| -> Vec<Lit> {
            (0..BITS)
                .map(|k| netlist.latch(format!("{name}.{k}"), init))
                .collect()
        };
        let timer = word(&mut netlist, "timer", Some(false));
        let limit = word(&mut netlist, "limit", None);
        let inputs = ["stop", "reset", "lock"].map(|name| netlist.input(name.to_owned()));
        let [stop, reset, lock] = inputs;
        let graph = &mut netlist.graph;
        let number = |bits: &[Lit]| Word::variable(bits.to_vec(), 0);
        let zero = number(&timer).equals(graph, &Word::constant(0));
        let less = number(&timer).minus(graph, &Word::constant(1));
        let ends = graph.all([reset, zero, !locked]);
        let begins = graph.and(stop, !stopped);
        let stays = graph.and(stopped, !ends);
        let next = graph.or(begins, stays);
        let locks = match lockable {
            true => graph.and(lock, stopped),
            false => Lit::FALSE,
        };
        let locks = graph.or(locks, locked);
        let timers: Vec<Lit> = (0..BITS)
            .map(|k| {
                let run = graph.choice(zero, Lit::FALSE, less.bit(k));
                graph.choice(begins, limit[k], run)
            })
            .collect();
        let mut places = netlist.latches.iter_mut();
        places.next().expect("stopped").next = next;
        places.next().expect("locked").next = locks;
        places
            .zip(timers)
            .for_each(|(latch, next)| latch.next = next);
        Stop {
            free: !stopped,
            numbers: vec![Word::variable(timer, 0)],
            timers: (2..2 + 2 * BITS).collect(),
            netlist,
        }
    }

    fn recovery(stop: &Stop) -> Recovery {
        Recovery {
            netlist: &stop.netlist,
            goal: stop.free,
            using: Lit::TRUE,
            numbers: &stop.numbers,
            timers: &stop.timers,
        }
    }

    fn ways_of(stop: &Stop) -> Option<Ways> {
        ways(&recovery(stop), &Budget::default()).expect("no limit")
    }

    /// Whatever the limit is: 4096 configurations, none of them looked at by itself.
    #[test]
    fn a_timer_of_any_length_runs_down() {
        let ways = ways_of(&stop(false)).expect("there is a way");
        assert!(ways.steps.iter().any(|step| step.rank.is_some()));
        assert!(ways.steps.len() < 12, "{}", ways.steps.len());
        // Other code agrees; a region less, and a state is left out or not led anywhere.
        let stop = stop(false);
        let check = |ways: &Ways| ways.check(&recovery(&stop), &Budget::default());
        assert_eq!(check(&ways), Ok(true));
        for k in 0..ways.steps.len() {
            let mut less = ways.clone();
            less.steps.remove(k);
            assert_eq!(check(&less), Ok(false), "{k}");
            let mut other = ways.clone();
            other.steps[k].rank = match other.steps[k].rank {
                Some(_) => None,
                None => continue,
            };
            assert_eq!(check(&other), Ok(false), "{k}");
        }
        let mut unknown = ways.clone();
        unknown.invariant.clauses.clear();
        assert_eq!(check(&unknown), Ok(false));
        // What is locked is never reached, and has no way.
        assert!(!ways.invariant.clauses.is_empty());
    }

    #[test]
    fn a_state_that_nothing_leaves_has_no_way() {
        assert_eq!(ways_of(&stop(true)), None);
    }

    /// Every state of the invariant is led to the goal by its region, one after the other.
    #[test]
    fn the_ways_lead_to_the_goal() {
        let stop = stop(false);
        let ways = ways_of(&stop).expect("there is a way");
        let netlist = &stop.netlist;
        for limit in [0, 1, 2, 77, 4095] {
            for timer in [0, 1, limit / 2, limit] {
                let bit = |k: usize, number: usize| number >> (k % BITS) & 1 == 1;
                let mut state = vec![true, false];
                state.extend((0..BITS).map(|k| bit(k, timer)));
                state.extend((0..BITS).map(|k| bit(k, limit)));
                let mut cycles = 0;
                while state[0] {
                    let inside = |step: &&Step| step.region.iter().all(|(k, v)| state[*k] == *v);
                    let step = ways.steps.iter().find(inside).expect("a region");
                    let mut leaves = vec![false; netlist.graph.size()];
                    for (latch, value) in netlist.latches.iter().zip(&state) {
                        leaves[latch.lit.node()] = *value;
                    }
                    for (k, value) in &step.inputs {
                        leaves[netlist.inputs[*k].lit.node()] = *value;
                    }
                    let values = netlist.graph.values(|node| leaves[node]);
                    let next = netlist.latches.iter();
                    state = next.map(|latch| value(&values, latch.next)).collect();
                    cycles += 1;
                    assert!(cycles <= timer + 2, "{limit} {timer}");
                }
            }
        }
    }
}
