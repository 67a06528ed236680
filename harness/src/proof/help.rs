//! Help for bounded responses: what ties the cycles left of a duty to the timers of the system.
//!
//! An engine would learn "while the duty is open, the timer is at most the cycles left" value by value. Here such sentences are
//! candidates, and those that hold by induction with each other are known beforehand.

use stillpoint_model::proof::{Budget, Graph, Lit, Netlist, Spent, Word, inductive};

use super::monitor::Duty;
use crate::export::Translated;

/// Shorter bounds need no help.
const SHORT: usize = 3;

/// A variable of at most so many values tells in which phase a duty is.
const PHASE: i64 = 16;

/// A variable of at least so many values may be a timer.
const TIMER: i64 = 4;

/// While the duty is open: the first or the second.
enum Candidate {
    /// A variable has not this value.
    Excluded(usize, i64),
    /// Where a variable has a value, or always: a timer is at most the cycles left and this shift.
    Below(Option<(usize, i64)>, usize, i64),
}

/// The system with what helps to decide about a duty among its invariants; none if nothing does.
pub(super) fn helped(
    translated: &Translated,
    duty: &Duty,
    budget: &Budget,
) -> Result<Option<Netlist>, Spent> {
    if duty.rest.bits().len() <= SHORT {
        return Ok(None);
    }
    let variables = translated.variables();
    let all = candidates(&variables);
    let mut netlist = translated.netlist.clone();
    let lits: Vec<Lit> = (all.iter())
        .map(|candidate| build(&mut netlist, &variables, duty, candidate))
        .collect();
    let kept = inductive(&netlist, &lits, budget)?;
    // Without the functions of all the others.
    let mut helped = translated.netlist.clone();
    for (candidate, lit) in all.iter().zip(&lits) {
        if kept.contains(lit) {
            let own = build(&mut helped, &variables, duty, candidate);
            if own != Lit::TRUE {
                helped.invariants.push(own);
            }
        }
    }
    Ok(Some(helped))
}

fn candidates(variables: &[(Word, (i64, i64))]) -> Vec<Candidate> {
    let size = |range: &(i64, i64)| range.1 - range.0 + 1;
    let mut list = Vec::new();
    let mut phases = vec![None];
    for (k, (_, range)) in variables.iter().enumerate() {
        if size(range) <= PHASE {
            for value in range.0..=range.1 {
                list.push(Candidate::Excluded(k, value));
                phases.push(Some((k, value)));
            }
        }
    }
    for (k, (_, range)) in variables.iter().enumerate() {
        if size(range) >= TIMER && range.0 >= 0 {
            for phase in &phases {
                for shift in [-1, 0, 1] {
                    list.push(Candidate::Below(*phase, k, shift));
                }
            }
        }
    }
    list
}

fn build(
    netlist: &mut Netlist,
    variables: &[(Word, (i64, i64))],
    duty: &Duty,
    candidate: &Candidate,
) -> Lit {
    let graph = &mut netlist.graph;
    let has = |graph: &mut Graph, (k, value): (usize, i64)| {
        variables[k].0.equals(graph, &Word::constant(value))
    };
    let against = match candidate {
        Candidate::Excluded(k, value) => has(graph, (*k, *value)),
        Candidate::Below(phase, timer, shift) => {
            let phase = phase.map_or(Lit::TRUE, |phase| has(graph, phase));
            let limit = duty.rest.plus(graph, &Word::constant(*shift));
            let above = limit.less(graph, &variables[*timer].0);
            graph.and(phase, above)
        }
    };
    !graph.and(duty.pending, against)
}
