//! Help for bounded responses: what ties the cycles left of a duty to the timers of the system.
//!
//! An engine would learn "while the duty is open, the timer is at most the cycles left" value by value. Here such sentences are
//! candidates, and those that hold by induction with each other are known beforehand. Where parameters are part of the state, so are
//! "the timer is at most this parameter" and "this parameter is at most the cycles left".

use std::collections::HashMap;

use stillpoint_certify::proof::clause::{Clause, Literal};
use stillpoint_model::proof::{Budget, Candidates, Graph, Lit, Netlist, Spent, Word, inductive};

use super::monitor::Duty;
use super::question::Asked;

/// Shorter bounds need no help.
const SHORT: usize = 3;

/// A variable of at most so many values tells in which phase a duty is.
const PHASE: i64 = 16;

/// A variable of at least so many values may be a timer, a parameter of more its start.
const TIMER: i64 = 4;

/// What the cycles left may be short of, or have over; the strongest first.
const SHIFTS: [i64; 4] = [-2, -1, 0, 1];

/// What may be known beforehand; of the parameters those that the bound is about. The first two are about the time in which the duty is open.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Candidate {
    /// A variable has not this value.
    Excluded(usize, i64),
    /// Where a variable has a value, or always: a timer or a parameter is at most the cycles left and this shift.
    Below(Phase, Number, i64),
    /// Where a variable has a value, or always, duty or not: a timer is at most a parameter.
    Limited(Phase, usize, usize),
}

/// A variable and its value, or always.
type Phase = Option<(usize, i64)>;

/// What may be compared with the cycles left.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Number {
    Timer(usize),
    Parameter(usize),
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
    let parameters = (duty.about.iter().map(|k| named(*k)))
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
    let (mut offered, mut numbers) = (Candidates::default(), HashMap::new());
    for candidate in &all {
        let lit = build(&mut netlist, &variables, duty, candidate);
        let stronger = stronger(candidate);
        let stronger = stronger.iter().filter_map(|s| numbers.get(s).copied());
        let number = offered.add(lit, stronger.collect());
        numbers.insert(*candidate, number);
    }
    let kept = inductive(&netlist, &offered, budget)?;
    // Without the functions of all the others.
    let mut helped = translated.netlist.clone();
    let mut sentences = Vec::new();
    for candidate in kept.into_iter().map(|k| &all[k]) {
        let own = build(&mut helped, &variables, duty, candidate);
        if own != Lit::TRUE {
            helped.invariants.push(own);
            sentences.push(sentence(&variables, candidate));
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
    let most = |number: Number, other: &str, shift: i64| Literal::Most {
        name: match number {
            Number::Timer(timer) => variables.own_names[timer].clone(),
            Number::Parameter(parameter) => variables.parameter_names[parameter].clone(),
        },
        other: Some(other.to_owned()),
        shift,
    };
    let mut literals = Vec::new();
    match candidate {
        Candidate::Excluded(k, value) => literals.extend([open(), other((*k, *value))]),
        Candidate::Below(phase, number, shift) => {
            literals.push(open());
            literals.extend(phase.map(other));
            literals.push(most(*number, "@rest", *shift));
        }
        Candidate::Limited(phase, timer, parameter) => {
            literals.extend(phase.map(other));
            let parameter = &variables.parameter_names[*parameter];
            literals.push(most(Number::Timer(*timer), parameter, 0));
        }
    }
    Clause(literals)
}

/// All candidates, each behind those that it follows from.
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
    let parameters = || 0..variables.parameters.len();
    for (k, (_, range)) in variables.own.iter().enumerate() {
        if size(range) >= TIMER && range.0 >= 0 {
            for phase in &phases {
                let below = SHIFTS.map(|shift| Candidate::Below(*phase, Number::Timer(k), shift));
                list.extend(below);
                // What a variable says of itself is nothing new.
                if phase.is_none_or(|(own, _)| own != k) {
                    list.extend(parameters().map(|p| Candidate::Limited(*phase, k, p)));
                }
            }
        }
    }
    // What has not begun yet has all its time before it.
    for phase in &phases {
        for number in parameters().map(Number::Parameter) {
            list.extend(SHIFTS.map(|shift| Candidate::Below(*phase, number, shift)));
        }
    }
    list
}

/// What a candidate follows from: the same always, or with less time left; that the phase does not occur.
fn stronger(candidate: &Candidate) -> Vec<Candidate> {
    match *candidate {
        Candidate::Excluded(..) => Vec::new(),
        Candidate::Below(phase, number, shift) => {
            let always = phase.map(|_| Candidate::Below(None, number, shift));
            let never = phase.map(|(k, value)| Candidate::Excluded(k, value));
            let less = Candidate::Below(phase, number, shift - 1);
            always.into_iter().chain(never).chain([less]).collect()
        }
        Candidate::Limited(phase, timer, parameter) => {
            let always = phase.map(|_| Candidate::Limited(None, timer, parameter));
            always.into_iter().collect()
        }
    }
}

fn build(netlist: &mut Netlist, variables: &Variables, duty: &Duty, candidate: &Candidate) -> Lit {
    let graph = &mut netlist.graph;
    let has = |graph: &mut Graph, (k, value): (usize, i64)| {
        variables.own[k].0.equals(graph, &Word::constant(value))
    };
    let mut open = duty.pending;
    let against = match candidate {
        Candidate::Excluded(k, value) => has(graph, (*k, *value)),
        Candidate::Below(phase, number, shift) => {
            let phase = phase.map_or(Lit::TRUE, |phase| has(graph, phase));
            let limit = duty.rest.plus(graph, &Word::constant(*shift));
            let number = match number {
                Number::Timer(timer) => &variables.own[*timer].0,
                Number::Parameter(parameter) => &variables.parameters[*parameter],
            };
            let above = limit.less(graph, number);
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
