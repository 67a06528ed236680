//! Runs with inputs drawn at random, 64 at a time: what one of their states breaks is no invariant. They are drawn from a fixed sequence,
//! the same with every call.

use super::graph::{Graph, Lit, Node};
use super::netlist::Problem;
use super::sat::{Budget, Encoding, Solver, Spent, Term};

/// How often it begins anew, and the cycles of each time.
const ROUNDS: usize = 12;
const CYCLES: usize = 256;

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
    /// Those that some functions consist of.
    fn new(graph: &'a Graph, roots: impl IntoIterator<Item = Lit>) -> Self {
        let mut lanes = Lanes {
            graph,
            nodes: Vec::new(),
            values: vec![0; graph.size()],
        };
        lanes.only(roots);
        lanes
    }

    /// Leaves out what these functions do not consist of.
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

/// Of candidates, conditions on latches, whether no state of some runs breaks them.
///
/// # Errors
/// The budget is spent.
pub(super) fn unbroken(
    problem: &Problem,
    candidates: &[Lit],
    budget: &Budget,
) -> Result<Vec<bool>, Spent> {
    let netlist = problem.netlist();
    let mut draw = Draw(SEED);
    let mut starts = Starts::new(problem, budget)?;
    let mut left = vec![true; candidates.len()];
    let mut kept: Vec<(usize, Lit)> = candidates.iter().copied().enumerate().collect();
    let next = problem.cone().map(|latch| latch.next);
    let fixed: Vec<Lit> = next.chain(problem.assumed.iter().copied()).collect();
    let roots = |kept: &[(usize, Lit)]| -> Vec<Lit> {
        let kept = kept.iter().map(|(_, lit)| *lit);
        fixed.iter().copied().chain(kept).collect()
    };
    let mut lanes = Lanes::new(&netlist.graph, roots(&kept));
    for round in 0..ROUNDS {
        if kept.is_empty() {
            break;
        }
        let Some(mut state) = starts.draw(problem, &mut draw)? else {
            return Ok(left);
        };
        // Each input is seldom set, or often, or seldom not.
        let rare: Vec<(u32, bool)> = (problem.inputs.iter())
            .map(|_| (1 + (draw.next() % 5) as u32, draw.next() % 4 == 0))
            .collect();
        // Most are broken soon.
        let cycles = if round == 0 { CYCLES / 16 } else { CYCLES };
        for _ in 0..cycles {
            if budget.spent() {
                return Err(Spent);
            }
            for (latch, bits) in problem.cone().zip(&state) {
                lanes.set(latch.lit, *bits);
            }
            for (place, (rare, negated)) in problem.inputs.iter().zip(&rare) {
                let bits = draw.bits(*rare);
                let bits = if *negated { !bits } else { bits };
                lanes.set(netlist.inputs[*place].lit, bits);
            }
            lanes.evaluate();
            kept.retain(|(k, lit)| {
                left[*k] = lanes.of(*lit) == u64::MAX;
                left[*k]
            });
            // Where these inputs are not possible the state stays, for others to be drawn.
            let goes = lanes.all(&problem.assumed);
            for (latch, bits) in problem.cone().zip(&mut state) {
                *bits = lanes.of(latch.next) & goes | *bits & !goes;
            }
        }
        lanes.only(roots(&kept));
    }
    Ok(left)
}

/// States at the start.
struct Starts {
    solver: Solver,
    encoding: Encoding,
    /// Bits that may be chosen.
    free: Vec<Term>,
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
                free.push(term);
            }
        }
        Ok(Starts {
            solver,
            encoding,
            free,
        })
    }

    /// The bits of each latch in 64 states; none if there is no state. Bits that may be chosen are seldom set in most states, so that
    /// numbers are small.
    fn draw(&mut self, problem: &Problem, draw: &mut Draw) -> Result<Option<Vec<u64>>, Spent> {
        let latches: Vec<_> = problem.cone().collect();
        let mut state = vec![0u64; latches.len()];
        for lane in 0..64 {
            let rare = 1 + (draw.next() % 6) as u32;
            let free = self.free.iter();
            let mut assumed: Vec<Term> = free
                .map(|term| term.apply_sign(draw.bits(rare) & 1 == 1))
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
