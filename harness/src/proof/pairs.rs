//! Properties about two runs ("does not depend on"), asked of the system of both ([`stillpoint_lang::twice`]).
//!
//! That most variables are the same in both runs an engine would learn bit by bit. So it is known beforehand of those of which it
//! holds by induction. What k-induction shows beside that has no certificate: there the cycles that must differ may differ in any of these.

use stillpoint_certify::proof::clause::{Clause, Literal};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Property;
use stillpoint_lang::twice::twice;
use stillpoint_model::proof::{Candidates, Lit, Spent, inductive};

use super::question::Asked;
use super::{Every, Judge, Judged, Settings};
use crate::export::Unsupported;

/// Judges a property of a system; none if there is no system of both runs.
pub(super) fn judge(bound: &Bound, property: &Property, settings: &Settings) -> Option<Judged> {
    let both = twice(bound, property)?;
    judged(&both.bound, &both.pairs, Asked::new(&both.bound), settings)
}

/// The same for all values of its parameters.
pub(super) fn judge_every(
    every: &Every,
    property: &Property,
    settings: &Settings,
) -> Option<Judged> {
    let (both, pairs) = every.twice(property)?;
    judged(&both.bound, &pairs, Asked::every(&both), settings)
}

fn judged(
    both: &Bound,
    pairs: &[(usize, usize)],
    asked: Result<Asked, Unsupported>,
    settings: &Settings,
) -> Option<Judged> {
    let mut judge = Judge::new(both, settings);
    // What is broken need not be: the explorer is asked of the pairs themselves.
    judge.leave_to_explorer = false;
    judge.ranges = false;
    let mut asked = asked.ok()?;
    judge.known = alike(&mut asked, pairs, &judge).ok()?;
    judge.prove(Ok(asked), &|_, _| None);
    let mut one = judge.out.into_iter().next()?;
    // It is a run of both, which is no run of the system.
    let both = one.trace.take();
    one.shown = one.shown.filter(|shown| shown.induction.is_none());
    if let Some(shown) = &mut one.shown {
        shown.both = both;
    }
    Some(one)
}

/// Adds to the invariants which variables are the same in both runs, and tells it as clauses.
fn alike(asked: &mut Asked, pairs: &[(usize, usize)], judge: &Judge) -> Result<Vec<Clause>, Spent> {
    let mut same = Vec::new();
    for (one, other) in pairs {
        let word = |k: usize| asked.translated.variable(k).0;
        let (a, b) = (word(*one), word(*other));
        let lit = a.equals(&mut asked.translated.netlist.graph, &b);
        if lit != Lit::TRUE {
            same.push((lit, (*one, *other), a.bits().len()));
        }
    }
    let mut candidates = Candidates::default();
    for (lit, ..) in &same {
        candidates.add(*lit, Vec::new());
    }
    let kept = inductive(&asked.translated.netlist, &candidates, &judge.budget)?;
    let mut clauses = Vec::new();
    for (lit, (one, other), bits) in kept.into_iter().map(|k| &same[k]) {
        asked.translated.netlist.invariants.push(*lit);
        let names = (asked.name(*one), asked.name(*other));
        let literal = |name: &String, bit, set| Literal::Bit {
            name: name.clone(),
            bit,
            set,
        };
        for bit in 0..*bits {
            for set in [true, false] {
                let (a, b) = (literal(&names.0, bit, set), literal(&names.1, bit, !set));
                clauses.push(Clause(vec![a, b]));
            }
        }
    }
    Ok(clauses)
}
