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
    /// Whether it shows that `bad` cannot be reached: by three questions to a solver, with nothing of what found it. The conditions
    /// that the netlist calls invariants are shown with it.
    ///
    /// # Errors
    /// The budget is spent.
    pub fn check(&self, netlist: &Netlist, bad: Lit) -> Result<Result<(), Defect>, Spent> {
        let problem = &Problem::new(netlist, bad);
        for (first, defect) in [(true, Defect::Start), (false, Defect::Cycle)] {
            if !self.excludes(problem, first, None)? {
                return Ok(Err(defect));
            }
        }
        let safe = self.excludes(problem, false, Some(bad))?;
        Ok(if safe { Ok(()) } else { Err(Defect::Bad) })
    }

    /// Without `bad`: whether all conditions hold at the start (`first`), or after a cycle before which they hold. With it: whether
    /// it cannot be where they hold.
    fn excludes(&self, problem: &Problem, first: bool, bad: Option<Lit>) -> Result<bool, Spent> {
        let netlist = problem.netlist;
        let mut graph = netlist.graph.clone();
        let mut given = problem.assumed.clone();
        let own = self.over(&mut graph, netlist);
        let mut shown = own.clone();
        if first {
            given.extend(&problem.start);
            for latch in problem.cone() {
                given.extend(latch.init.map(|init| latch.lit.flipped(!init)));
            }
            shown.extend(&problem.invariants);
        } else {
            given.extend(own);
            given.extend(&problem.invariants);
        }
        let question = match (bad, first) {
            (Some(bad), _) => bad,
            (None, true) => {
                let all = graph.all(shown);
                !all
            }
            (None, false) => {
                let mut after = Vec::new();
                for clause in &self.clauses {
                    let list = clause.iter();
                    let list = list.map(|(k, v)| netlist.latches[*k].next.flipped(!*v));
                    let list: Vec<Lit> = list.collect();
                    after.push(graph.any(list));
                }
                after.extend(over_next(&mut graph, netlist, &problem.invariants));
                !graph.all(after)
            }
        };
        let mut solver = Solver::new(&Budget::default());
        let mut encoding = Encoding::new(&graph);
        for lit in given.into_iter().chain([question]) {
            let term = encoding.term(&mut solver, &graph, lit);
            solver.clause([term]);
        }
        Ok(!solver.solve(&[])?)
    }

    /// The clauses over the state before the cycle.
    fn over(&self, graph: &mut Graph, netlist: &Netlist) -> Vec<Lit> {
        let mut clause = |clause: &Vec<(usize, bool)>| {
            let list = clause.iter();
            let list = list.map(|(k, v)| netlist.latches[*k].lit.flipped(!*v));
            graph.any(list.collect::<Vec<_>>())
        };
        self.clauses.iter().map(&mut clause).collect()
    }
}
