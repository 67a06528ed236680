//! Candidates for invariants, and those of them that hold together (Houdini: C. Flanagan and K. R. M. Leino, 2001).

use super::graph::Lit;
use super::netlist::{Netlist, Problem, after};
use super::sat::{Budget, Encoding, Solver, Spent, Term};

/// Those candidates that hold in every reachable state by induction with each other: the largest such set. A candidate is a
/// condition on latches.
///
/// # Errors
/// The budget is spent.
pub fn inductive(
    netlist: &Netlist,
    candidates: &[Lit],
    budget: &Budget,
) -> Result<Vec<Lit>, Spent> {
    let mut graph = netlist.graph.clone();
    let all = graph.all(candidates.iter().copied());
    let mut widened = netlist.clone();
    widened.graph = graph;
    // Whatever one of them depends on.
    let problem = Problem::new(&widened, all);
    let kept = at_start(&problem, candidates, budget)?;
    kept_by_cycles(&problem, kept, budget)
}

/// Those that hold in every start state.
fn at_start(problem: &Problem, candidates: &[Lit], budget: &Budget) -> Result<Vec<Lit>, Spent> {
    let mut solver = Solver::new(budget);
    let mut encoding = Encoding::new(problem.graph());
    let fixed = problem
        .cone()
        .filter_map(|latch| Some(latch.lit.flipped(!latch.init?)));
    let given: Vec<Lit> = (problem.start.iter().copied())
        .chain(problem.invariants.iter().copied())
        .chain(fixed)
        .collect();
    for lit in given {
        let term = encoding.term(&mut solver, problem.graph(), lit);
        solver.clause([term]);
    }
    let mut kept = Vec::new();
    for lit in candidates {
        if budget.spent() {
            return Err(Spent);
        }
        let term = encoding.term(&mut solver, problem.graph(), *lit);
        if !solver.solve(&[!term])? {
            kept.push(*lit);
        }
    }
    Ok(kept)
}

/// Those that a cycle from a state in which all of them hold keeps, left alone.
fn kept_by_cycles(
    problem: &Problem,
    mut kept: Vec<Lit>,
    budget: &Budget,
) -> Result<Vec<Lit>, Spent> {
    let netlist = problem.netlist();
    let mut graph = netlist.graph.clone();
    let moved = after(&mut graph, netlist, &kept);
    let mut next: Vec<Lit> = moved;
    let mut solver = Solver::new(budget);
    let mut encoding = Encoding::new(&graph);
    for lit in problem.invariants.iter().chain(&problem.assumed) {
        let term = encoding.term(&mut solver, &graph, *lit);
        solver.clause([term]);
    }
    while !kept.is_empty() {
        // The solvers of small questions hardly ever look at the time.
        if budget.spent() {
            return Err(Spent);
        }
        let given: Vec<Term> = (kept.iter())
            .map(|lit| encoding.term(&mut solver, &graph, *lit))
            .collect();
        let after: Vec<Term> = (next.iter())
            .map(|lit| encoding.term(&mut solver, &graph, *lit))
            .collect();
        // One assumption for all of them: each by itself would be a level of the search, begun anew with every restart.
        let switch = solver.variable();
        for term in given {
            solver.clause([!switch, term]);
        }
        solver.clause([!switch].into_iter().chain(after.iter().map(|t| !*t)));
        if !solver.solve(&[switch])? {
            break;
        }
        let holds: Vec<bool> = after.iter().map(|t| solver.value(*t)).collect();
        solver.clause([!switch]);
        let mut holds_kept = holds.iter();
        kept.retain(|_| holds_kept.next().is_some_and(|h| *h));
        let mut holds_next = holds.iter();
        next.retain(|_| holds_next.next().is_some_and(|h| *h));
    }
    Ok(kept)
}
