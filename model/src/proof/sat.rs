//! The incremental SAT solver (BatSat, a MiniSat in Rust) behind what the engines need of one, and graphs as clauses.

use std::cell::Cell;
use std::time::Instant;

use batsat::{Callbacks, SolverInterface, lbool};

use super::graph::{Graph, Lit, Node};
use crate::report::Interrupt;

/// A literal of a solver.
pub(super) type Term = batsat::Lit;

/// When to give up.
#[derive(Clone, Debug, Default)]
pub struct Budget {
    /// The time at which to end.
    pub until: Option<Instant>,
    /// What ends it from outside.
    pub interrupt: Option<Interrupt>,
}

impl Budget {
    /// Whether it is used up.
    pub fn spent(&self) -> bool {
        self.interrupt.as_ref().is_some_and(Interrupt::is_raised)
            || self.until.is_some_and(|until| Instant::now() >= until)
    }
}

/// The budget was used up before there was an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spent;

/// Asks for the time now and then only. Once it has said that the time is over it says so for ever: a search that was ended asks once more
/// before it gives up, and would begin anew.
pub(super) struct Watch {
    budget: Budget,
    asked: Cell<u32>,
    over: Cell<bool>,
    /// Clauses that may still be learnt.
    clauses: u64,
}

impl Watch {
    pub(super) fn new(budget: &Budget) -> Self {
        Watch {
            budget: budget.clone(),
            asked: Cell::new(0),
            over: Cell::new(false),
            clauses: u64::MAX,
        }
    }
}

impl Callbacks for Watch {
    fn on_new_clause(&mut self, _: &[Term], _: batsat::clause::Kind) {
        self.clauses = self.clauses.saturating_sub(1);
    }

    fn stop(&self) -> bool {
        if self.clauses == 0 {
            return true;
        }
        let asked = self.asked.get().wrapping_add(1);
        self.asked.set(asked);
        let over = self.over.get() || (asked % 16 == 0 && self.budget.spent());
        self.over.set(over);
        over
    }
}

/// A SAT solver that takes clauses at any time and answers under assumptions.
pub(super) struct Solver {
    inner: batsat::Solver<Watch>,
    always: Term,
    clause: Vec<Term>,
}

impl Solver {
    pub(super) fn new(budget: &Budget) -> Self {
        let mut inner = batsat::Solver::new(batsat::SolverOpts::default(), Watch::new(budget));
        let always = Term::new(inner.new_var_default(), true);
        inner.add_clause_reuse(&mut vec![always]);
        Solver {
            inner,
            always,
            clause: Vec::new(),
        }
    }

    /// A literal that is always TRUE.
    pub(super) fn always(&self) -> Term {
        self.always
    }

    /// A new variable.
    pub(super) fn variable(&mut self) -> Term {
        Term::new(self.inner.new_var_default(), true)
    }

    /// One of these must hold.
    pub(super) fn clause(&mut self, terms: impl IntoIterator<Item = Term>) {
        self.clause.clear();
        self.clause.extend(terms);
        self.inner.add_clause_reuse(&mut self.clause);
    }

    /// Whether all clauses and these assumptions can hold together.
    pub(super) fn solve(&mut self, assumptions: &[Term]) -> Result<bool, Spent> {
        let answer = self.inner.solve_limited(assumptions);
        if answer == lbool::TRUE {
            Ok(true)
        } else if answer == lbool::FALSE {
            Ok(false)
        } else {
            Err(Spent)
        }
    }

    /// The same if no more clauses than these have to be learnt for it; else none.
    pub(super) fn attempt(
        &mut self,
        assumptions: &[Term],
        clauses: u64,
    ) -> Result<Option<bool>, Spent> {
        self.inner.cb_mut().clauses = clauses;
        let answer = self.solve(assumptions);
        let weary = std::mem::replace(&mut self.inner.cb_mut().clauses, u64::MAX) == 0;
        match answer {
            Err(Spent) if weary => Ok(None),
            answer => answer.map(Some),
        }
    }

    /// After the answer that they can: the value of a term.
    pub(super) fn value(&self, term: Term) -> bool {
        self.inner.value_lit(term) == lbool::TRUE
    }

    /// After the answer that they cannot: whether this assumption is among those that are enough for it.
    pub(super) fn failed(&self, assumption: Term) -> bool {
        self.inner.unsat_core_contains_lit(!assumption)
    }
}

/// Nodes of a graph as terms of a solver: clauses for a conjunction are added when it is first needed (Tseitin's encoding).
pub(super) struct Encoding {
    terms: Vec<Option<Term>>,
}

impl Encoding {
    pub(super) fn new(graph: &Graph) -> Self {
        Encoding {
            terms: vec![None; graph.size()],
        }
    }

    /// The term of a literal.
    pub(super) fn term(&mut self, solver: &mut Solver, graph: &Graph, lit: Lit) -> Term {
        if self.terms.len() < graph.size() {
            self.terms.resize(graph.size(), None);
        }
        let mut open = vec![lit.node()];
        while let Some(node) = open.last().copied() {
            if self.terms[node].is_some() {
                open.pop();
                continue;
            }
            let term = match graph.node(node) {
                Node::Constant => !solver.always(),
                Node::Leaf => solver.variable(),
                Node::And(a, b) => match (self.made(a), self.made(b)) {
                    (Some(a), Some(b)) => {
                        let both = solver.variable();
                        solver.clause([!both, a]);
                        solver.clause([!both, b]);
                        solver.clause([both, !a, !b]);
                        both
                    }
                    (a_made, b_made) => {
                        open.extend(a_made.is_none().then_some(a.node()));
                        open.extend(b_made.is_none().then_some(b.node()));
                        continue;
                    }
                },
            };
            self.terms[node] = Some(term);
            open.pop();
        }
        self.made(lit).unwrap_or_else(|| solver.always())
    }

    /// The term of a literal that has one.
    pub(super) fn made(&self, lit: Lit) -> Option<Term> {
        let term = self.terms.get(lit.node()).copied().flatten()?;
        Some(term.apply_sign(!lit.negated()))
    }

    /// The value of a literal in the solver's answer; none if it has no term.
    pub(super) fn value(&self, solver: &Solver, lit: Lit) -> Option<bool> {
        self.made(lit).map(|term| solver.value(term))
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn an_attempt_that_takes_too_many_clauses_has_no_answer_and_does_no_harm() {
        let mut solver = Solver::new(&Budget::default());
        pigeons(&mut solver, 5);
        assert_eq!(solver.attempt(&[], 3), Ok(None));
        assert_eq!(
            solver.attempt(&[], 3),
            Ok(None),
            "the limit is that of each attempt"
        );
        assert_eq!(solver.attempt(&[], 100_000), Ok(Some(false)));
        let over = Budget {
            until: Some(Instant::now()),
            ..Budget::default()
        };
        let mut solver = Solver::new(&over);
        pigeons(&mut solver, 8);
        assert_eq!(
            solver.attempt(&[], 100_000),
            Err(Spent),
            "time is no such limit"
        );
    }

    #[test]
    fn answers_under_assumptions_name_those_that_are_enough() {
        let mut solver = Solver::new(&Budget::default());
        let [a, b, c] = [(); 3].map(|()| solver.variable());
        solver.clause([!a, b]);
        assert_eq!(solver.solve(&[a, c]), Ok(true));
        assert!(solver.value(b) && solver.value(c));
        assert_eq!(solver.solve(&[c, a, !b]), Ok(false));
        assert!(solver.failed(a) && solver.failed(!b) && !solver.failed(c));
        assert_eq!(solver.solve(&[!b]), Ok(true));
        assert!(!solver.value(a));
    }

    #[test]
    fn a_graph_as_clauses_has_the_values_of_the_graph() {
        let mut graph = Graph::default();
        let (a, b) = (graph.leaf(), graph.leaf());
        let xor = graph.xor(a, b);
        let mut solver = Solver::new(&Budget::default());
        let mut encoding = Encoding::new(&graph);
        let [a, b, xor] = [a, b, xor].map(|lit| encoding.term(&mut solver, &graph, lit));
        for (x, y) in [(false, false), (false, true), (true, false), (true, true)] {
            let given = [a.apply_sign(x), b.apply_sign(y)];
            assert_eq!(solver.solve(&given), Ok(true));
            assert_eq!(solver.value(xor), x != y);
            assert_eq!(
                solver.solve(&[given[0], given[1], xor.apply_sign(x == y)]),
                Ok(false)
            );
        }
    }

    /// One pigeon more than there are holes: by resolution that takes long.
    fn pigeons(solver: &mut Solver, holes: usize) {
        let all: Vec<Vec<Term>> = (0..=holes)
            .map(|_| (0..holes).map(|_| solver.variable()).collect())
            .collect();
        for pigeon in &all {
            solver.clause(pigeon.iter().copied());
        }
        for (one, pigeon) in all.iter().enumerate() {
            for other in &all[..one] {
                for (a, b) in pigeon.iter().zip(other) {
                    solver.clause([!*a, !*b]);
                }
            }
        }
    }

    #[test]
    fn a_spent_budget_gives_no_answer() {
        let budget = Budget {
            until: Some(Instant::now()),
            interrupt: None,
        };
        let mut solver = Solver::new(&budget);
        pigeons(&mut solver, 8);
        assert_eq!(solver.solve(&[]), Err(Spent));
    }

    /// The search asks again after it was told to end: without an answer that stays it goes on, here for ever.
    #[test]
    fn a_search_ends_when_its_time_is_over() {
        let budget = Budget {
            until: Some(Instant::now() + Duration::from_millis(20)),
            interrupt: None,
        };
        let mut solver = Solver::new(&budget);
        pigeons(&mut solver, 14);
        assert_eq!(solver.solve(&[]), Err(Spent));
    }
}
