//! The classes of inputs of a state: the cycles that can come next, those with the same outcome put together.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::ControlFlow;

use stillpoint_engine::table::Interpreted;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::{Frame, UNSET};
use stillpoint_lang::ir::Form;
use stillpoint_model::{Fault, Held, cycles};

use super::path::Choice;
use super::truth::Teller;
use super::walk::{choice, size};

/// Cycles that are made from one state at most.
pub const MOST_CYCLES: usize = 20_000;

/// The cycles of a state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Classes {
    /// In the order of their first cycle.
    pub classes: Vec<Class>,
    /// The input combinations they stand for, of those that agree with the inputs held.
    pub combinations: u128,
    /// The cycles made: combinations of the inputs that were really read.
    pub cycles: usize,
    /// Whether these are all. Else holding an input at a value helps.
    pub complete: bool,
    /// The inputs that a cycle of this state may read, held ones included.
    pub read: BTreeSet<u32>,
}

/// Cycles with the same state after them, the same rules fired and the same properties broken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Class {
    /// The choice that makes its first cycle.
    pub choice: Choice,
    /// The state after it, or the fault.
    pub after: Result<Vec<i32>, Fault>,
    /// For each instance the number of the rule that fired, from 1; 0 for none.
    pub fired: Vec<i32>,
    /// The properties about single cycles that it breaks, by number.
    pub broken: Vec<usize>,
    /// The input combinations it stands for.
    pub combinations: u128,
    /// The values with which its cycles read an input that all of them read: (input, distances from the least value).
    pub when: Vec<(u32, Vec<u32>)>,
    /// Whether `when` says exactly which inputs lead here; else it is only a condition they all satisfy.
    pub exact: bool,
}

/// What a cycle leads to: those with the same outcome are of one class.
#[derive(PartialEq, Eq, Hash)]
struct Outcome {
    after: Result<Vec<i32>, u32>,
    fired: Vec<i32>,
    broken: Vec<usize>,
}

/// A class that grows.
struct Growing {
    choice: Choice,
    cycles: usize,
    combinations: u128,
    /// By input: in how many cycles it was read, and its values there.
    seen: BTreeMap<u32, (usize, BTreeSet<u32>)>,
}

/// The classes of the inputs that agree with `held`: (number, distance from the least value), one pair for an input.
pub fn classes(bound: &Bound, state: &[i32], held: &[(u32, u32)]) -> Classes {
    let system = Interpreted::new(bound);
    let fixed: Vec<Held> = held
        .iter()
        .filter_map(|(input, value)| {
            Some(Held {
                input: *input,
                size: size(bound, *input)?,
                value: *value,
            })
        })
        .collect();
    let mut order: Vec<Outcome> = Vec::new();
    let mut growing: Vec<Growing> = Vec::new();
    let mut known: HashMap<u64, Vec<usize>> = HashMap::new();
    let mut out = Classes {
        classes: Vec::new(),
        combinations: 0,
        cycles: 0,
        complete: true,
        read: BTreeSet::new(),
    };
    cycles(&system, state, &fixed, |cycle| {
        if out.cycles == MOST_CYCLES {
            out.complete = false;
            return ControlFlow::Break(());
        }
        out.cycles += 1;
        out.combinations = out.combinations.saturating_add(cycle.weight);
        out.read.extend(read_in(cycle.work));
        let outcome = Outcome {
            after: cycle.after.map(<[i32]>::to_vec).map_err(|f| f.code),
            fired: cycle.work.fired.clone(),
            broken: match cycle.after {
                Ok(_) => broken(bound, cycle.work, held),
                Err(_) => Vec::new(),
            },
        };
        let bucket = known.entry(hash(&outcome)).or_default();
        let at = bucket.iter().copied().find(|k| order[*k] == outcome);
        let at = at.unwrap_or_else(|| {
            let step: Vec<_> = cycle.reads.iter().chain(held).copied().collect();
            growing.push(Growing {
                choice: choice(&system, state, &step),
                cycles: 0,
                combinations: 0,
                seen: BTreeMap::new(),
            });
            order.push(outcome);
            bucket.push(order.len() - 1);
            order.len() - 1
        });
        let class = &mut growing[at];
        class.cycles += 1;
        class.combinations = class.combinations.saturating_add(cycle.weight);
        for (input, value) in cycle.reads {
            let (count, values) = class.seen.entry(input).or_default();
            *count += 1;
            values.insert(value);
        }
        ControlFlow::Continue(())
    });
    let free = fixed.iter().fold(bound.combinations(), |all, h| {
        all / u128::from(h.size.max(1))
    });
    let both = order.into_iter().zip(growing);
    out.classes = both
        .map(|(outcome, growing)| finish(bound, free, out.complete, outcome, growing))
        .collect();
    out
}

fn hash(outcome: &Outcome) -> u64 {
    use std::hash::{DefaultHasher, Hash, Hasher};
    let mut hasher = DefaultHasher::new();
    outcome.hash(&mut hasher);
    hasher.finish()
}

/// The inputs read in the cycle just made.
fn read_in(frame: &Frame) -> impl Iterator<Item = u32> {
    let set = frame.inputs.iter().enumerate();
    set.filter(|(_, v)| **v != UNSET).map(|(k, _)| k as u32)
}

/// The properties about single cycles that the cycle just made surely breaks.
fn broken(bound: &Bound, frame: &Frame, held: &[(u32, u32)]) -> Vec<usize> {
    let mut teller = Teller::new(bound, frame, held);
    let mut is = |atom: usize, value: bool| teller.truth(atom) == Ok(value);
    let all = bound.system.properties.iter().enumerate();
    all.filter(|(_, property)| match &property.form {
        Form::Always { when, then } => when.is_none_or(|when| is(when, true)) && is(*then, false),
        _ => false,
    })
    .map(|(k, _)| k)
    .collect()
}

fn finish(bound: &Bound, free: u128, complete: bool, outcome: Outcome, growing: Growing) -> Class {
    let mut when = Vec::new();
    // The combinations in which the inputs read by all cycles have one of their values here: at least those of the class.
    let mut box_of = free;
    for (input, (count, values)) in growing.seen {
        let size = size(bound, input).unwrap_or(1);
        if count == growing.cycles && values.len() < size as usize {
            box_of = box_of / u128::from(size.max(1)) * values.len() as u128;
            when.push((input, values.into_iter().collect()));
        }
    }
    Class {
        choice: growing.choice,
        after: outcome.after.map_err(|code| Fault { code }),
        fired: outcome.fired,
        broken: outcome.broken,
        combinations: growing.combinations,
        when,
        exact: complete && free < u128::MAX && box_of == growing.combinations,
    }
}
