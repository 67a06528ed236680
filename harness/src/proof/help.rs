//! Help for bounded responses: what ties the cycles left of a duty to the timers of the system.
//!
//! An engine would learn "while the duty is open, the timer is at most the cycles left" value by value. Here such sentences are
//! candidates, and those that hold by induction with each other are known beforehand. Where parameters are part of the state, so are
//! "the timer is at most this parameter", "these parameters together are at most the cycles left", and of a timer that counts up "this
//! parameter is at most the cycles left and the timer". That two variables differ is what a comparison of channels waits for.

use std::collections::HashMap;
use std::ops::RangeInclusive;

use stillpoint_certify::proof::clause::{Clause, Literal};
use stillpoint_lang::ir::Ty;
use stillpoint_model::proof::{Budget, Candidates, Graph, Lit, Netlist, Spent, Word, inductive};

use super::monitor::Duty;
use super::question::Asked;

/// Shorter bounds need no help.
const SHORT: usize = 3;

/// A variable of at most so many values tells in which phase a duty is.
const PHASE: i64 = 16;

/// A variable of at least so many values may be a timer, a parameter of more its start.
const TIMER: i64 = 4;

/// What the cycles left may be short of, or have over, where the bound has no more or less cycles beside its parameters.
const SHIFTS: (i64, i64) = (-2, 1);

/// The most cycles beside the parameters of a bound that are told apart.
const BESIDE: i64 = 16;

/// The most values of which pairs are looked at.
const APART: usize = 96;

/// The most sums of parameters.
const SUMS: i64 = 128;

/// What may be known beforehand; of the parameters those that the bound is about. Only limits hold without an open duty.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Candidate {
    /// A variable has not this value.
    Excluded(usize, i64),
    /// Where a variable has a value, or always: a sum is at most the cycles left and this shift.
    Below(Phase, Sum, i64),
    /// Where a variable has a value, or always, duty or not: a timer is at most a parameter.
    Limited(Phase, usize, usize),
    /// Two variables differ while the duty is open.
    Differ(usize, usize),
    /// Two variables do not have these values together while it is open.
    Apart((usize, i64), (usize, i64)),
}

/// A variable and its value, or always.
type Phase = Option<(usize, i64)>;

/// What may be compared with the cycles left.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Sum {
    timer: Timer,
    /// By parameter how often it is in it.
    times: Vec<i64>,
}

/// The timer of a sum.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Timer {
    None,
    /// It counts down: what is left of it is part of the sum.
    Down(usize),
    /// It counts up: what it has counted is taken off.
    Up(usize),
}

/// What candidates are made of.
struct Variables {
    /// State variables with more than one value that are no parameters.
    own: Vec<Variable>,
    /// Which of them may be timers.
    timers: Vec<usize>,
    parameters: Vec<Parameter>,
    shifts: RangeInclusive<i64>,
}

struct Variable {
    word: Word,
    range: (i64, i64),
    name: String,
}

impl Variable {
    /// How many values it has.
    fn size(&self) -> i64 {
        self.range.1 - self.range.0 + 1
    }
}

struct Parameter {
    word: Word,
    name: String,
    /// The multiple that the bound has of it.
    multiple: i64,
}

impl Variables {
    /// By parameter how often it is in a sum at most: as in the bound, or once, or never, as there are not too many sums then.
    fn times(&self) -> Vec<i64> {
        let few = |all: &Vec<i64>| {
            let sums = |sums: i64, most: &i64| sums.saturating_mul(most.saturating_add(1));
            all.iter().fold(1, sums) <= SUMS
        };
        let multiples = self.parameters.iter().map(|p| p.multiple).collect();
        let [once, never] = [1, 0].map(|times| vec![times; self.parameters.len()]);
        [multiples, once].into_iter().find(few).unwrap_or(never)
    }
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
    let variable = |k: usize| {
        let (word, range) = translated.variable(k);
        let name = asked.name(k);
        Variable { word, range, name }
    };
    let states = &translated.bound.system.states;
    let own = (0..asked.own).map(|k| (variable(k), states[k].var.ty));
    let own: Vec<(Variable, Ty)> = own.filter(|(v, _)| v.size() > 1).collect();
    // What is one of some states does not count.
    let timer = |(v, ty): &(Variable, Ty)| *ty == Ty::Int && v.size() >= TIMER && v.range.0 >= 0;
    let timers = (0..own.len()).filter(|k| timer(&own[*k])).collect();
    let parameters = duty.about.parameters.iter().filter_map(|(k, times)| {
        let Variable { word, range, name } = variable(*k);
        let multiple = *times.max(&1);
        (range.0 >= 0 && range.1 - range.0 >= TIMER).then_some(Parameter {
            word,
            name,
            multiple,
        })
    });
    let beside = duty.about.number.clamp(-BESIDE, BESIDE);
    let variables = Variables {
        timers,
        parameters: parameters.collect(),
        own: own.into_iter().map(|(variable, _)| variable).collect(),
        shifts: SHIFTS.0 - (beside - 1).max(0)..=SHIFTS.1 + (-beside).max(0),
    };
    let all = candidates(&variables);
    let mut netlist = translated.netlist.clone();
    let (mut offered, mut numbers) = (Candidates::default(), HashMap::new());
    for candidate in &all {
        let lit = build(&mut netlist, &variables, duty, candidate);
        let stronger = stronger(&variables, candidate);
        let stronger = stronger.iter().filter_map(|s| numbers.get(s).copied());
        let number = offered.add(lit, stronger.collect());
        numbers.insert(candidate.clone(), number);
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
        name: variables.own[k].name.clone(),
        value,
        equal: false,
    };
    let most = |name: &String, other: &String, shift: i64| Literal::Most {
        sum: vec![name.clone()],
        most: vec![other.clone()],
        shift,
    };
    let mut literals = Vec::new();
    match candidate {
        Candidate::Excluded(k, value) => literals.extend([open(), other((*k, *value))]),
        Candidate::Below(phase, total, shift) => {
            literals.push(open());
            literals.extend(phase.map(other));
            let parameters = total.times.iter().zip(&variables.parameters);
            let parameters = parameters.flat_map(|(n, p)| vec![p.name.clone(); *n as usize]);
            let (mut sum, mut most) = (Vec::new(), vec!["@rest".to_owned()]);
            match total.timer {
                Timer::None => (),
                Timer::Down(timer) => sum.push(variables.own[timer].name.clone()),
                Timer::Up(timer) => most.push(variables.own[timer].name.clone()),
            }
            sum.extend(parameters);
            let shift = *shift;
            literals.push(Literal::Most { sum, most, shift });
        }
        Candidate::Limited(phase, timer, parameter) => {
            literals.extend(phase.map(other));
            let (timer, parameter) = (&variables.own[*timer], &variables.parameters[*parameter]);
            literals.push(most(&timer.name, &parameter.name, 0));
        }
        Candidate::Apart(one, another) => {
            literals.push(open());
            literals.extend([one, another].map(|phase| other(*phase)));
        }
        Candidate::Differ(a, b) => {
            literals.push(open());
            let [a, b] = [a, b].map(|k| &variables.own[*k].name);
            literals.extend([most(a, b, -1), most(b, a, -1)]);
        }
    }
    Clause(literals)
}

/// All candidates, each behind those that it follows from.
fn candidates(variables: &Variables) -> Vec<Candidate> {
    let few = |(_, own): &(usize, &Variable)| own.size() <= PHASE;
    let few = || variables.own.iter().enumerate().filter(few);
    let values = few().flat_map(|(k, own)| (own.range.0..=own.range.1).map(move |v| (k, v)));
    let values: Vec<(usize, i64)> = values.collect();
    let excluded = values.iter().map(|(k, v)| Candidate::Excluded(*k, *v));
    let mut list: Vec<Candidate> = excluded.collect();
    for (k, own) in few() {
        let alike = |other: &usize| variables.own[*other].range == own.range;
        let others = (k + 1..variables.own.len()).filter(alike);
        list.extend(others.map(|other| Candidate::Differ(k, other)));
    }
    if values.len() <= APART {
        for (k, one) in values.iter().enumerate() {
            let others = values[..k].iter().filter(|other| other.0 != one.0);
            list.extend(others.map(|other| Candidate::Apart(*one, *other)));
        }
    }
    let always = std::iter::once(None);
    let phases: Vec<Phase> = always.chain(values.into_iter().map(Some)).collect();
    for sum in sums(variables) {
        for phase in &phases {
            let shifts = variables.shifts.clone();
            list.extend(shifts.map(|shift| Candidate::Below(*phase, sum.clone(), shift)));
        }
    }
    for k in &variables.timers {
        // What a variable says of itself is nothing new.
        for phase in phases.iter().filter(|p| p.is_none_or(|(own, _)| own != *k)) {
            let parameters = 0..variables.parameters.len();
            list.extend(parameters.map(|p| Candidate::Limited(*phase, *k, p)));
        }
    }
    list
}

/// What may be compared with the cycles left, each behind those that it follows from. Of too many parameters none is in a sum.
fn sums(variables: &Variables) -> Vec<Sum> {
    let mut all = vec![Vec::new()];
    for most in variables.times() {
        all = (all.into_iter())
            .flat_map(|sum| (0..=most).rev().map(move |n| [&sum[..], &[n]].concat()))
            .collect();
    }
    // What has not begun yet has all its time before it.
    let timers = variables.timers.iter().copied();
    let (down, up) = (timers.clone().map(Timer::Down), timers.map(Timer::Up));
    let timers = down.chain([Timer::None]).chain(up);
    let sums = timers.flat_map(|timer| all.iter().cloned().map(move |times| Sum { timer, times }));
    sums.filter(|sum| matches!(sum.timer, Timer::Down(_)) || sum.times.iter().any(|n| *n > 0))
        .collect()
}

/// What a candidate follows from: the same always, or with less time left, or of a larger sum; that the phase does not occur.
fn stronger(variables: &Variables, candidate: &Candidate) -> Vec<Candidate> {
    match candidate {
        Candidate::Excluded(..) | Candidate::Differ(..) => Vec::new(),
        Candidate::Apart(one, other) => [one, other]
            .map(|(k, value)| Candidate::Excluded(*k, *value))
            .into(),
        Candidate::Below(phase, sum, shift) => {
            let always = phase.map(|_| Candidate::Below(None, sum.clone(), *shift));
            let never = phase.map(|(k, value)| Candidate::Excluded(k, value));
            let less = Candidate::Below(*phase, sum.clone(), shift - 1);
            let larger = larger(variables, sum).into_iter();
            let larger = larger.map(|sum| Candidate::Below(*phase, sum, *shift));
            (always.into_iter().chain(never).chain([less]).chain(larger)).collect()
        }
        Candidate::Limited(phase, timer, parameter) => {
            let always = phase.map(|_| Candidate::Limited(None, *timer, *parameter));
            always.into_iter().collect()
        }
    }
}

/// The next larger sums.
fn larger(variables: &Variables, sum: &Sum) -> Vec<Sum> {
    let mut list = Vec::new();
    for k in 0..variables.parameters.len() {
        let mut more = sum.clone();
        more.times[k] += 1;
        list.push(more);
    }
    let timers: Vec<Timer> = match sum.timer {
        Timer::Down(_) => Vec::new(),
        Timer::None => variables.timers.iter().copied().map(Timer::Down).collect(),
        Timer::Up(_) => vec![Timer::None],
    };
    list.extend(timers.into_iter().map(|timer| Sum {
        timer,
        times: sum.times.clone(),
    }));
    list
}

fn build(netlist: &mut Netlist, variables: &Variables, duty: &Duty, candidate: &Candidate) -> Lit {
    let graph = &mut netlist.graph;
    let has = |graph: &mut Graph, (k, value): (usize, i64)| {
        variables.own[k].word.equals(graph, &Word::constant(value))
    };
    let mut open = duty.pending;
    let against = match candidate {
        Candidate::Excluded(k, value) => has(graph, (*k, *value)),
        Candidate::Below(phase, sum, shift) => {
            let phase = phase.map_or(Lit::TRUE, |phase| has(graph, phase));
            let mut limit = duty.rest.plus(graph, &Word::constant(*shift));
            let mut total = Word::constant(0);
            match sum.timer {
                Timer::None => (),
                Timer::Down(timer) => total = variables.own[timer].word.clone(),
                Timer::Up(timer) => limit = limit.plus(graph, &variables.own[timer].word),
            }
            for (parameter, times) in variables.parameters.iter().zip(&sum.times) {
                total = (0..*times).fold(total, |total, _| total.plus(graph, &parameter.word));
            }
            let above = limit.less(graph, &total);
            graph.and(phase, above)
        }
        Candidate::Limited(phase, timer, parameter) => {
            open = Lit::TRUE;
            let phase = phase.map_or(Lit::TRUE, |phase| has(graph, phase));
            let above = variables.parameters[*parameter]
                .word
                .less(graph, &variables.own[*timer].word);
            graph.and(phase, above)
        }
        Candidate::Differ(a, b) => variables.own[*a]
            .word
            .equals(graph, &variables.own[*b].word),
        Candidate::Apart(one, other) => {
            let (one, other) = (has(graph, *one), has(graph, *other));
            graph.and(one, other)
        }
    };
    !graph.and(open, against)
}
