//! Properties about two runs ("does not depend on"), asked of the system of both ([`stillpoint_lang::twice`]).
//!
//! That most variables are the same in both runs an engine would learn bit by bit. So it is known beforehand of those of which it
//! holds by induction.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Property;
use stillpoint_lang::twice::twice;
use stillpoint_model::proof::{Lit, Spent, inductive};

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
    alike(&mut asked, pairs, &judge).ok()?;
    judge.prove(Ok(asked), &|_, _| None);
    judge.out.into_iter().next()
}

/// Adds to the invariants which variables are the same in both runs.
fn alike(asked: &mut Asked, pairs: &[(usize, usize)], judge: &Judge) -> Result<(), Spent> {
    let words = |(one, other): &(usize, usize)| {
        let word = |k: usize| asked.translated.variable(k).0;
        (word(*one), word(*other))
    };
    let words: Vec<_> = pairs.iter().map(words).collect();
    let netlist = &mut asked.translated.netlist;
    let same: Vec<Lit> = (words.iter())
        .map(|(one, other)| one.equals(&mut netlist.graph, other))
        .filter(|lit| *lit != Lit::TRUE)
        .collect();
    let kept = inductive(netlist, &same, &judge.budget)?;
    netlist.invariants.extend(kept);
    Ok(())
}
