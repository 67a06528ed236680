//! What the solver learns while it refutes, for whoever wants to check it: clauses, each of which follows from those before by unit
//! propagation.

use batsat::{Callbacks, SolverInterface, lbool};

use super::sat::{Budget, Spent, Term, Watch};

/// Notes every clause that is learnt.
struct Notes {
    watch: Watch,
    learnt: Vec<Vec<Term>>,
    most: usize,
}

impl Callbacks for Notes {
    fn on_new_clause(&mut self, clause: &[Term], _: batsat::clause::Kind) {
        self.learnt.push(clause.to_vec());
    }

    fn stop(&self) -> bool {
        self.learnt.len() >= self.most || self.watch.stop()
    }
}

/// Refutes lists of literals one after the other, each together with all clauses. Literals are numbers of variables from 1 on, negative
/// for the opposite. The clauses learnt; none if one of the lists can hold.
///
/// # Errors
/// The budget is spent, or there are more of them than `most`.
pub fn lemmas(
    clauses: &[Vec<i32>],
    goals: &[Vec<i32>],
    most: usize,
    budget: &Budget,
) -> Result<Option<Vec<Vec<i32>>>, Spent> {
    let notes = Notes {
        watch: Watch::new(budget),
        learnt: Vec::new(),
        most,
    };
    let mut solver = batsat::Solver::new(batsat::SolverOpts::default(), notes);
    // Only variables that occur are the solver's: the others would be decided too.
    let mut own = std::collections::BTreeMap::new();
    let mut names = Vec::new();
    let all = clauses.iter().chain(goals).flatten();
    for number in all.map(|literal| literal.unsigned_abs()) {
        own.entry(number).or_insert_with(|| {
            names.push(number);
            solver.new_var_default()
        });
    }
    let term = |literal: &i32| Term::new(own[&literal.unsigned_abs()], *literal > 0);
    for clause in clauses {
        solver.add_clause_reuse(&mut clause.iter().map(term).collect());
    }
    for goal in goals {
        if budget.spent() || solver.cb().learnt.len() >= most {
            return Err(Spent);
        }
        let assumed: Vec<Term> = goal.iter().map(term).collect();
        let answer = solver.solve_limited(&assumed);
        if answer == lbool::TRUE {
            return Ok(None);
        }
        if answer != lbool::FALSE {
            return Err(Spent);
        }
    }
    let number = |term: &Term| {
        let number = names[term.var().idx() as usize] as i32;
        if term.sign() { number } else { -number }
    };
    let learnt = std::mem::take(&mut solver.cb_mut().learnt).into_iter();
    let learnt = learnt.filter(|clause| !clause.is_empty());
    Ok(Some(
        learnt.map(|c| c.iter().map(number).collect()).collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_can_hold_has_no_lemmas_and_what_cannot_has_some() {
        // Of three no two hold, but of each two one.
        let none: Vec<Vec<i32>> = vec![vec![-3, -7], vec![-3, -9], vec![-7, -9]];
        let some: Vec<Vec<i32>> = vec![vec![3, 7], vec![3, 9], vec![7, 9]];
        let budget = Budget::default();
        assert_eq!(lemmas(&none, &[vec![3]], 9, &budget), Ok(None));
        let both = [none, some].concat();
        assert_eq!(lemmas(&both, &[vec![]], 0, &budget), Err(Spent));
        let learnt = lemmas(&both, &[vec![]], 9, &budget);
        let learnt = learnt.expect("no limit").expect("nothing satisfies them");
        let known = |literal: &i32| [3, 7, 9].contains(&literal.abs());
        assert!(!learnt.is_empty() && learnt.iter().flatten().all(known));
    }
}
