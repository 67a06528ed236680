//! Candidates for invariants, and those of them that hold together (Houdini: C. Flanagan and K. R. M. Leino, 2001).

use std::collections::HashSet;

use super::graph::{Graph, Lit, value};
use super::netlist::{Netlist, Problem, after};
use super::sat::{Budget, Encoding, Solver, Spent, Term};
use super::simulate::Runs;

/// Candidates, conditions on latches, some of which follow from others.
#[derive(Clone, Debug)]
pub struct Candidates {
    lits: Vec<Lit>,
    /// By candidate those that it follows from.
    stronger: Vec<Vec<usize>>,
    /// How many clauses may be learnt for an answer about some of them before fewer are asked about.
    pub soon: u64,
    /// How many for one about a single one, when nothing else is left to ask, before it is dropped.
    pub late: u64,
}

impl Default for Candidates {
    fn default() -> Self {
        Candidates {
            lits: Vec::new(),
            stronger: Vec::new(),
            soon: 150,
            late: 2000,
        }
    }
}

impl Candidates {
    /// One more, which follows from each of these; its number.
    pub fn add(&mut self, lit: Lit, stronger: Vec<usize>) -> usize {
        self.lits.push(lit);
        self.stronger.push(stronger);
        self.lits.len() - 1
    }

    /// The strongest ones of those that are left: from them the others follow.
    fn strongest(&self, left: &[bool]) -> Vec<usize> {
        let follows = |k: usize| self.stronger[k].iter().any(|s| left[*s]);
        (0..left.len())
            .filter(|k| left[*k] && !follows(*k))
            .collect()
    }
}

/// Candidates that hold in every reachable state by induction with each other, without those that follow from others of them: their
/// numbers. Of such sets it is the largest one, but for candidates about which the solver finds out too little.
///
/// # Errors
/// The budget is spent.
pub fn inductive(
    netlist: &Netlist,
    candidates: &Candidates,
    budget: &Budget,
) -> Result<Vec<usize>, Spent> {
    // Whatever one of them depends on.
    let problem = Problem::with(netlist, Lit::FALSE, &candidates.lits);
    let mut left = vec![true; candidates.lits.len()];
    let mut runs = Runs::new(&problem, &candidates.lits);
    runs.drawn(&mut left, budget)?;
    at_start(&problem, candidates, &mut left, budget)?;
    kept_by_cycles(&problem, candidates, left, &mut runs, budget)
}

/// Leaves those that hold in every start state.
fn at_start(
    problem: &Problem,
    candidates: &Candidates,
    left: &mut [bool],
    budget: &Budget,
) -> Result<(), Spent> {
    let mut solver = Solver::new(budget);
    let mut encoding = Encoding::new(problem.graph());
    for lit in problem.begin().chain(problem.invariants.iter().copied()) {
        let term = encoding.term(&mut solver, problem.graph(), lit);
        solver.clause([term]);
    }
    let mut asked = vec![false; left.len()];
    loop {
        let mut strongest = candidates.strongest(left);
        strongest.retain(|k| !std::mem::replace(&mut asked[*k], true));
        if strongest.is_empty() {
            return Ok(());
        }
        for k in strongest {
            if budget.spent() {
                return Err(Spent);
            }
            let term = encoding.term(&mut solver, problem.graph(), candidates.lits[k]);
            left[k] = !solver.solve(&[!term])?;
        }
    }
}

/// Those that a cycle from a state in which all of them hold keeps, left alone.
fn kept_by_cycles(
    problem: &Problem,
    candidates: &Candidates,
    left: Vec<bool>,
    runs: &mut Runs,
    budget: &Budget,
) -> Result<Vec<usize>, Spent> {
    let netlist = problem.netlist();
    let mut graph = netlist.graph.clone();
    let moved = after(&mut graph, netlist, &candidates.lits);
    let mut solver = Solver::new(budget);
    let mut encoding = Encoding::new(&graph);
    for lit in problem.invariants.iter().chain(&problem.assumed) {
        let term = encoding.term(&mut solver, &graph, *lit);
        solver.clause([term]);
    }
    let mut cycles = Cycles {
        candidates,
        graph,
        moved,
        solver,
        encoding,
        left,
        doubtful: HashSet::new(),
        runs,
        budget,
    };
    loop {
        let strongest = candidates.strongest(&cycles.left);
        // One assumption for all of them: each by itself would be a level of the search, begun anew with every restart.
        let given = cycles.solver.variable();
        for k in &strongest {
            let term = cycles.term(candidates.lits[*k]);
            cycles.solver.clause([!given, term]);
        }
        let sure = strongest.iter().filter(|k| !cycles.doubtful.contains(k));
        let sure: Vec<usize> = sure.copied().collect();
        let all = cycles.keep(given, sure, false)? && cycles.keep_doubtful(given, &strongest)?;
        cycles.solver.clause([!given]);
        if all {
            return Ok(strongest);
        }
    }
}

/// A cycle from a state in which candidates hold.
struct Cycles<'a, 'b> {
    candidates: &'a Candidates,
    graph: Graph,
    /// By candidate what it says after the cycle.
    moved: Vec<Lit>,
    solver: Solver,
    encoding: Encoding,
    left: Vec<bool>,
    doubtful: HashSet<usize>,
    runs: &'a mut Runs<'b>,
    budget: &'a Budget,
}

impl Cycles<'_, '_> {
    fn term(&mut self, lit: Lit) -> Term {
        self.encoding.term(&mut self.solver, &self.graph, lit)
    }

    /// Whether none of these candidates was dropped, as a cycle keeps all of them where all that are given hold, but for those of which
    /// that is not soon found out: they are doubtful from now on. It ends with the first answer that drops some, or goes through all.
    fn keep(&mut self, given: Term, mut asked: Vec<usize>, through: bool) -> Result<bool, Spent> {
        let mut all = true;
        loop {
            asked.retain(|k| self.left[*k]);
            if asked.is_empty() {
                return Ok(all);
            }
            match (self.ask(given, &asked, self.candidates.soon)?, &asked[..]) {
                (Some(true), _) => return Ok(all),
                (Some(false), _) if !through => return Ok(false),
                (Some(false), _) => all = false,
                (None, [one]) => {
                    self.doubtful.insert(*one);
                    return Ok(all);
                }
                (None, _) => {
                    let others = asked.split_off(asked.len() / 2);
                    let some = self.keep(given, asked, true)?;
                    let others = self.keep(given, others, true)?;
                    return Ok(all && some && others);
                }
            }
        }
    }

    /// Whether a cycle keeps the doubtful ones of these, up to the first that it does not keep, or of which that is not found out either.
    fn keep_doubtful(&mut self, given: Term, candidates: &[usize]) -> Result<bool, Spent> {
        for k in candidates {
            if self.doubtful.contains(k)
                && self.ask(given, &[*k], self.candidates.late)? != Some(true)
            {
                self.left[*k] = false;
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether a cycle keeps these, if so many clauses are enough to know. Of all that are left those that it does not keep are dropped.
    fn ask(&mut self, given: Term, asked: &[usize], clauses: u64) -> Result<Option<bool>, Spent> {
        // The solvers of small questions hardly ever look at the time.
        if self.budget.spent() {
            return Err(Spent);
        }
        let switch = self.solver.variable();
        let broken: Vec<Term> = asked.iter().map(|k| !self.term(self.moved[*k])).collect();
        self.solver.clause([!switch].into_iter().chain(broken));
        let found = self.solver.attempt(&[given, switch], clauses)?;
        if found == Some(true) {
            self.drop_broken()?;
        }
        self.solver.clause([!switch]);
        Ok(found.map(|found| !found))
    }

    /// Of all that are left those that the cycle found does not keep, nor a run from its first state.
    fn drop_broken(&mut self) -> Result<(), Spent> {
        let bit = |node| {
            self.encoding
                .value(&self.solver, Lit::of(node))
                .unwrap_or(false)
        };
        let values = self.graph.values(bit);
        for (left, moved) in self.left.iter_mut().zip(&self.moved) {
            *left &= value(&values, *moved);
        }
        self.runs
            .around(|lit| value(&values, lit), &mut self.left, self.budget)
    }
}
