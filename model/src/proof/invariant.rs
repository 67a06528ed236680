//! Inductive invariants, and the check that one is: it holds at the start, a cycle keeps it, and nothing bad happens in it.

use super::graph::{Graph, Lit};
use super::netlist::{Netlist, Problem, after as over_next};
use super::sat::{Budget, Encoding, Solver, Spent};

/// Clauses over the latches: in every reachable state each has a latch, by its place in the netlist, with this value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Invariant {
    /// The clauses.
    pub clauses: Vec<Vec<(usize, bool)>>,
}

/// Why an invariant shows nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Defect {
    /// It does not hold at the start.
    #[error("it does not hold at the start")]
    Start,
    /// A cycle leads out of it.
    #[error("a cycle leads out of it")]
    Cycle,
    /// What must not happen is possible in it.
    #[error("it does not exclude what must not happen")]
    Bad,
}

impl Invariant {
    /// Whether it shows that `bad` cannot be reached: by questions to a solver, one for each clause at the start and after a cycle, and
    /// with nothing of what found it. The conditions that the netlist calls invariants are shown with it.
    ///
    /// # Errors
    /// The budget is spent.
    pub fn check(
        &self,
        netlist: &Netlist,
        bad: Lit,
        budget: &Budget,
    ) -> Result<Result<(), Defect>, Spent> {
        let problem = &Problem::new(netlist, bad);
        let mut graph = netlist.graph.clone();
        let own = self.over(&mut graph, |k| netlist.latches[k].lit);
        let all = [&own[..], &problem.invariants[..]].concat();
        let mut after = self.over(&mut graph, |k| netlist.latches[k].next);
        after.extend(over_next(&mut graph, netlist, &problem.invariants));
        let fixed = problem.cone().filter_map(|latch| {
            let init = latch.init?;
            Some(latch.lit.flipped(!init))
        });
        let start: Vec<Lit> = problem.start.iter().copied().chain(fixed).collect();
        for (given, shown, defect) in [
            (&start, &all, Defect::Start),
            (&all, &after, Defect::Cycle),
            (&all, &vec![!bad], Defect::Bad),
        ] {
            let mut solver = Solver::new(budget);
            let mut encoding = Encoding::new(&graph);
            for lit in given.iter().chain(&problem.assumed) {
                let term = encoding.term(&mut solver, &graph, *lit);
                solver.clause([term]);
            }
            for lit in shown {
                let term = encoding.term(&mut solver, &graph, *lit);
                if solver.solve(&[!term])? {
                    return Ok(Err(defect));
                }
            }
        }
        Ok(Ok(()))
    }

    /// The clauses, where `value` gives a latch before or after the cycle.
    pub(super) fn over(&self, graph: &mut Graph, value: impl Fn(usize) -> Lit) -> Vec<Lit> {
        let mut out = Vec::with_capacity(self.clauses.len());
        for clause in &self.clauses {
            let parts = clause.iter().map(|(k, v)| value(*k).flipped(!*v));
            let parts: Vec<Lit> = parts.collect();
            out.push(graph.any(parts));
        }
        out
    }
}
