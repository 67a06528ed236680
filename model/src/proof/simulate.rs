//! Runs with inputs drawn at random, 64 at a time: what one of their states breaks is no invariant. They are drawn from a fixed sequence,
//! the same with every call.

use super::graph::{Graph, Lit, Node};
use super::netlist::Problem;
use super::sat::{Budget, Encoding, Solver, Spent, Term};

/// How often it begins anew at most, how often in vain, and the cycles of each time.
const ROUNDS: usize = 64;
const IDLE: usize = 4;
const CYCLES: usize = 256;

/// The cycles from a state that somebody else has found.
const AROUND: usize = 64;

const SEED: u64 = 0x9e37_79b9_7f4a_7c15;

/// A sequence of numbers (xorshift).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Bits of which one in `2^rare` is set.
    fn bits(&mut self, rare: u32) -> u64 {
        (0..rare).fold(u64::MAX, |bits, _| bits & self.next())
    }
}

/// The values of nodes in 64 cases.
struct Lanes<'a> {
    graph: &'a Graph,
    nodes: Vec<usize>,
    values: Vec<u64>,
}

impl<'a> Lanes<'a> {
    fn new(graph: &'a Graph) -> Self {
        Lanes {
            graph,
            nodes: Vec::new(),
            values: vec![0; graph.size()],
        }
    }

    /// From now on only those that these functions consist of.
    fn only(&mut self, roots: impl IntoIterator<Item = Lit>) {
        let below = self.graph.below(roots);
        self.nodes = (0..below.len()).filter(|node| below[*node]).collect();
    }

    fn set(&mut self, lit: Lit, bits: u64) {
        self.values[lit.node()] = bits;
    }

    fn evaluate(&mut self) {
        for node in &self.nodes {
            if let Node::And(a, b) = self.graph.node(*node) {
                self.values[*node] = self.of(a) & self.of(b);
            }
        }
    }

    fn of(&self, lit: Lit) -> u64 {
        match lit.negated() {
            false => self.values[lit.node()],
            true => !self.values[lit.node()],
        }
    }

    fn all(&self, list: &[Lit]) -> u64 {
        list.iter().fold(u64::MAX, |all, lit| all & self.of(*lit))
    }
}

/// Runs that show what is no invariant.
pub(super) struct Runs<'a> {
    problem: &'a Problem<'a>,
    lanes: Lanes<'a>,
    draw: Draw,
    /// What no run has broken yet, each with its number.
    kept: Vec<(usize, Lit)>,
}

impl<'a> Runs<'a> {
    /// Of candidates, conditions on latches.
    pub(super) fn new(problem: &'a Problem, candidates: &[Lit]) -> Self {
        let kept: Vec<(usize, Lit)> = candidates.iter().copied().enumerate().collect();
        let mut runs = Runs {
            problem,
            lanes: Lanes::new(problem.graph()),
            draw: Draw(SEED),
            kept,
        };
        runs.only_kept();
        runs
    }

    /// Leaves out what is no longer asked.
    fn only_kept(&mut self) {
        let next = self.problem.cone().map(|latch| latch.next);
        let fixed = next.chain(self.problem.assumed.iter().copied());
        self.lanes
            .only(fixed.chain(self.kept.iter().map(|(_, lit)| *lit)));
    }

    /// Of candidates, whether no state of some runs from the start breaks them.
    ///
    /// # Errors
    /// The budget is spent.
    pub(super) fn drawn(&mut self, left: &mut [bool], budget: &Budget) -> Result<(), Spent> {
        let mut starts = Starts::new(self.problem, budget)?;
        let mut idle = 0;
        for round in 0..ROUNDS {
            if self.kept.is_empty() || idle == IDLE {
                break;
            }
            let before = self.kept.len();
            let Some(state) = starts.draw(self.problem, &mut self.draw)? else {
                break;
            };
            // Most are broken soon.
            let cycles = if round == 0 { CYCLES / 16 } else { CYCLES };
            self.run(state, cycles, left, budget)?;
            idle = if self.kept.len() == before {
                idle + 1
            } else {
                0
            };
        }
        Ok(())
    }

    /// The same from a state in which all of them hold that are left: none that a run from there breaks is kept by every cycle together
    /// with the others.
    ///
    /// # Errors
    /// The budget is spent.
    pub(super) fn around(
        &mut self,
        holds: impl Fn(Lit) -> bool,
        left: &mut [bool],
        budget: &Budget,
    ) -> Result<(), Spent> {
        let latches = self.problem.cone();
        let state = latches.map(|latch| if holds(latch.lit) { u64::MAX } else { 0 });
        self.run(state.collect(), AROUND, left, budget)
    }

    fn run(
        &mut self,
        mut state: Vec<u64>,
        cycles: usize,
        left: &mut [bool],
        budget: &Budget,
    ) -> Result<(), Spent> {
        let (problem, asked) = (self.problem, self.kept.len());
        // Each input is seldom set, or often, or seldom not; or it stays for some cycles as it is, so that times run out.
        let rare: Vec<(u32, bool, bool)> = (problem.inputs.iter())
            .map(|_| {
                let rare = 1 + (self.draw.next() % 5) as u32;
                (rare, self.draw.next() % 4 == 0, self.draw.next() % 2 == 0)
            })
            .collect();
        let mut before: Vec<u64> = rare.iter().map(|_| self.draw.next()).collect();
        for _ in 0..cycles {
            if budget.spent() {
                return Err(Spent);
            }
            let lanes = &mut self.lanes;
            for (latch, bits) in problem.cone().zip(&state) {
                lanes.set(latch.lit, *bits);
            }
            let inputs = problem.inputs.iter().zip(&rare).zip(&mut before);
            for ((place, (rare, negated, stays)), before) in inputs {
                let bits = self.draw.bits(*rare);
                let bits = match (stays, negated) {
                    (true, _) => *before ^ bits,
                    (false, true) => !bits,
                    (false, false) => bits,
                };
                *before = bits;
                lanes.set(problem.netlist().inputs[*place].lit, bits);
            }
            lanes.evaluate();
            self.kept.retain(|(k, lit)| {
                left[*k] &= lanes.of(*lit) == u64::MAX;
                left[*k]
            });
            // Where these inputs are not possible the state stays, for others to be drawn.
            let goes = lanes.all(&problem.assumed);
            for (latch, bits) in problem.cone().zip(&mut state) {
                *bits = lanes.of(latch.next) & goes | *bits & !goes;
            }
        }
        if self.kept.len() < asked {
            self.only_kept();
        }
        Ok(())
    }
}

/// The place of a bit in its number, with which its name ends; 0 for what is no number.
fn place(name: &str) -> u32 {
    let end = name.rsplit_once('.').map(|(_, end)| end.parse());
    end.and_then(Result::ok).unwrap_or(0)
}

/// States at the start.
struct Starts {
    solver: Solver,
    encoding: Encoding,
    /// Bits that may be chosen, each with its place in its number.
    free: Vec<(Term, u32)>,
}

impl Starts {
    fn new(problem: &Problem, budget: &Budget) -> Result<Self, Spent> {
        let mut solver = Solver::new(budget);
        let mut encoding = Encoding::new(problem.graph());
        for lit in problem.begin().chain(problem.invariants.iter().copied()) {
            let term = encoding.term(&mut solver, problem.graph(), lit);
            solver.clause([term]);
        }
        let mut free = Vec::new();
        for latch in problem.cone() {
            let term = encoding.term(&mut solver, problem.graph(), latch.lit);
            if latch.init.is_none() && solver.solve(&[term])? && solver.solve(&[!term])? {
                free.push((term, place(&latch.name)));
            }
        }
        Ok(Starts {
            solver,
            encoding,
            free,
        })
    }

    /// The bits of each latch in 64 states; none if there is no state. Bits that may be chosen are seldom set in half of them, and in
    /// the other half numbers have no more than a few bits: times so short that all that follows each other is seen.
    fn draw(&mut self, problem: &Problem, draw: &mut Draw) -> Result<Option<Vec<u64>>, Spent> {
        let latches: Vec<_> = problem.cone().collect();
        let mut state = vec![0u64; latches.len()];
        for lane in 0..64 {
            let (rare, bits) = match lane % 2 {
                0 => (1 + (draw.next() % 6) as u32, u32::MAX),
                _ => (1, 1 + (draw.next() % 3) as u32),
            };
            let free = self.free.iter();
            let mut assumed: Vec<Term> = free
                .map(|(term, place)| term.apply_sign(*place < bits && draw.bits(rare) & 1 == 1))
                .collect();
            // Those that do not go together with what stands before them give way.
            while !self.solver.solve(&assumed)? {
                match assumed.iter().rposition(|term| self.solver.failed(*term)) {
                    Some(last) => assumed.remove(last),
                    None => return Ok(None),
                };
            }
            for (latch, bits) in latches.iter().zip(&mut state) {
                let set = self.encoding.value(&self.solver, latch.lit);
                *bits |= u64::from(set.unwrap_or(false)) << lane;
            }
        }
        Ok(Some(state))
    }
}
