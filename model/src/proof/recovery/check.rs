//! Checks ways that were found, by other questions than those that have found them.

use super::super::graph::Lit;
use super::super::netlist::{Problem, moved};
use super::super::sat::{Budget, Encoding, Solver, Spent, Term};
use super::{Recovery, Values, Ways};

impl Ways {
    /// Whether they lead to the goal from every reachable state: by questions to a solver, with nothing of what found them.
    ///
    /// # Errors
    /// The budget is spent.
    pub fn check(&self, recovery: &Recovery, budget: &Budget) -> Result<bool, Spent> {
        let mut netlist = recovery.netlist.clone();
        let clauses = (self.invariant).over(&mut netlist.graph, |k| netlist.latches[k].lit);
        let holds = netlist.graph.all(clauses.iter().copied());
        let kept = self.invariant.check(&netlist, !holds, budget)?.is_ok();
        let map = moved(&netlist, netlist.graph.size());
        let latches = netlist.latches.iter().map(|latch| (latch.lit, latch.next));
        let (now, next): (Vec<Lit>, Vec<Lit>) = latches.unzip();
        let inputs: Vec<Lit> = netlist.inputs.iter().map(|input| input.lit).collect();
        let cube = |values: &Values, lits: &[Lit]| -> Vec<Lit> {
            values.iter().map(|(k, v)| lits[*k].flipped(!v)).collect()
        };
        // Inputs on which nothing of this depends have possible values by themselves.
        let end = netlist.graph.and(recovery.goal, recovery.using);
        let assumed = Problem::new(&netlist, end).assumed;
        let graph = &mut netlist.graph;
        let given = [&netlist.invariants[..], &clauses].concat();
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
}
