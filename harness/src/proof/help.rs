//! Help for bounded responses: what ties the cycles left of a duty to the timers of the system.
//!
//! An engine would learn "while the duty is open, the timer is at most the cycles left" value by value. Here such sentences are
//! candidates, and those that hold by induction with each other are known beforehand. Where parameters are part of the state, so are
//! "the timer is at most this parameter".

use stillpoint_certify::proof::clause::{Clause, Literal};
use stillpoint_model::proof::{Budget, Graph, Lit, Netlist, Spent, Word, inductive};

use super::monitor::Duty;
use super::question::Asked;

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
    /// Where a variable has a value, or always, duty or not: a timer is at most a parameter.
    Limited(Option<(usize, i64)>, usize, usize),
}

/// State variables with more than one value that are no parameters, and parameters, as numbers with their ranges and names.
struct Variables {
    own: Vec<(Word, (i64, i64))>,
    own_names: Vec<String>,
    parameters: Vec<Word>,
    parameter_names: Vec<String>,
}

/// A system with what helps among its invariants.
pub(super) struct Help {
    pub netlist: Netlist,
    /// What helps, for a certificate.
    pub sentences: Vec<Clause>,
}

/// The system with what helps to decide about a duty among its invariants; none if nothing does.
pub(super) fn helped(asked: &Asked, duty: &Duty, budget: &Budget) -> Result<Option<Help>, Spent> {
    if duty.rest.bits().len() <= SHORT {
        return Ok(None);
    }
    let translated = &asked.translated;
    let named = |k: usize| (translated.variable(k), asked.name(k));
    let own = (0..asked.own)
        .map(named)
        .filter(|((_, (lo, hi)), _)| lo < hi);
    let parameters = (asked.parameters.iter().map(|k| named(*k)))
        .filter(|((_, (lo, hi)), _)| hi - lo >= TIMER)
        .map(|((word, _), name)| (word, name));
    let (own, own_names) = own.unzip();
    let (parameters, parameter_names) = parameters.unzip();
    let variables = Variables {
        own,
        own_names,
        parameters,
        parameter_names,
    };
    let all = candidates(&variables);
    let mut netlist = translated.netlist.clone();
    let lits: Vec<Lit> = (all.iter())
        .map(|candidate| build(&mut netlist, &variables, duty, candidate))
        .collect();
    let kept = inductive(&netlist, &lits, budget)?;
    // Without the functions of all the others.
    let mut helped = translated.netlist.clone();
    let mut sentences = Vec::new();
    for (candidate, lit) in all.iter().zip(&lits) {
        if kept.contains(lit) {
            let own = build(&mut helped, &variables, duty, candidate);
            if own != Lit::TRUE {
                helped.invariants.push(own);
                sentences.push(sentence(&variables, candidate));
            }
        }
    }
    Ok(Some(Help {
        netlist: helped,
        sentences,
    }))
}

/// What a candidate says, as a clause.
fn sentence(variables: &Variables, candidate: &Candidate) -> Clause {
    let open = || Literal::Bit {
        name: "@pending".to_owned(),
        bit: 0,
        set: false,
    };
    let other = |(k, value): (usize, i64)| Literal::Is {
        name: variables.own_names[k].clone(),
        value,
        equal: false,
    };
    let most = |timer: usize, other: &str, shift: i64| Literal::Most {
        name: variables.own_names[timer].clone(),
        other: Some(other.to_owned()),
        shift,
    };
    let mut literals = Vec::new();
    match candidate {
        Candidate::Excluded(k, value) => literals.extend([open(), other((*k, *value))]),
        Candidate::Below(phase, timer, shift) => {
            literals.push(open());
            literals.extend(phase.map(other));
            literals.push(most(*timer, "@rest", *shift));
        }
        Candidate::Limited(phase, timer, parameter) => {
            literals.extend(phase.map(other));
            literals.push(most(*timer, &variables.parameter_names[*parameter], 0));
        }
    }
    Clause(literals)
}

fn candidates(variables: &Variables) -> Vec<Candidate> {
    let size = |range: &(i64, i64)| range.1 - range.0 + 1;
    let mut list = Vec::new();
    let mut phases = vec![None];
    for (k, (_, range)) in variables.own.iter().enumerate() {
        if size(range) <= PHASE {
            for value in range.0..=range.1 {
                list.push(Candidate::Excluded(k, value));
                phases.push(Some((k, value)));
            }
        }
    }
    for (k, (_, range)) in variables.own.iter().enumerate() {
        if size(range) >= TIMER && range.0 >= 0 {
            for phase in &phases {
                for shift in [-1, 0, 1] {
                    list.push(Candidate::Below(*phase, k, shift));
                }
                for parameter in 0..variables.parameters.len() {
                    list.push(Candidate::Limited(*phase, k, parameter));
                }
            }
        }
    }
    list
}

fn build(netlist: &mut Netlist, variables: &Variables, duty: &Duty, candidate: &Candidate) -> Lit {
    let graph = &mut netlist.graph;
    let has = |graph: &mut Graph, (k, value): (usize, i64)| {
        variables.own[k].0.equals(graph, &Word::constant(value))
    };
    let mut open = duty.pending;
    let against = match candidate {
        Candidate::Excluded(k, value) => has(graph, (*k, *value)),
        Candidate::Below(phase, timer, shift) => {
            let phase = phase.map_or(Lit::TRUE, |phase| has(graph, phase));
            let limit = duty.rest.plus(graph, &Word::constant(*shift));
            let above = limit.less(graph, &variables.own[*timer].0);
            graph.and(phase, above)
        }
        Candidate::Limited(phase, timer, parameter) => {
            open = Lit::TRUE;
            let phase = phase.map_or(Lit::TRUE, |phase| has(graph, phase));
            let above = variables.parameters[*parameter].less(graph, &variables.own[*timer].0);
            graph.and(phase, above)
        }
    };
    !graph.and(open, against)
}
