//! Candidates for invariants, and those of them that hold together (Houdini: C. Flanagan and K. R. M. Leino, 2001).

use super::graph::{Lit, value};
use super::netlist::{Netlist, Problem, after};
use super::sat::{Budget, Encoding, Solver, Spent, Term};
use super::simulate::unbroken;

/// Candidates, conditions on latches, some of which follow from others.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    lits: Vec<Lit>,
    /// By candidate those that it follows from.
    stronger: Vec<Vec<usize>>,
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

/// The candidates that hold in every reachable state by induction with each other, the largest such set, without those that follow from
/// others of it: their numbers.
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
    let mut left = unbroken(&problem, &candidates.lits, budget)?;
    at_start(&problem, candidates, &mut left, budget)?;
    kept_by_cycles(&problem, candidates, left, budget)
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
    mut left: Vec<bool>,
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
    loop {
        // The solvers of small questions hardly ever look at the time.
        if budget.spent() {
            return Err(Spent);
        }
        let strongest = candidates.strongest(&left);
        let given: Vec<Term> = (strongest.iter())
            .map(|k| encoding.term(&mut solver, &graph, candidates.lits[*k]))
            .collect();
        let after: Vec<Term> = (strongest.iter())
            .map(|k| encoding.term(&mut solver, &graph, moved[*k]))
            .collect();
        // One assumption for all of them: each by itself would be a level of the search, begun anew with every restart.
        let switch = solver.variable();
        for term in given {
            solver.clause([!switch, term]);
        }
        solver.clause([!switch].into_iter().chain(after.into_iter().map(|t| !t)));
        if !solver.solve(&[switch])? {
            return Ok(strongest);
        }
        // Of all that are left those that this cycle does not keep, not only of the strongest.
        let bit = |node| encoding.value(&solver, Lit::of(node)).unwrap_or(false);
        let values = graph.values(bit);
        for (left, moved) in left.iter_mut().zip(&moved) {
            *left &= value(&values, *moved);
        }
        solver.clause([!switch]);
    }
}
