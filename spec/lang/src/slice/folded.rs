//! Constant folding of a whole system, its parameter values put in: what they settle depends on nothing any more.

use crate::bind::Bound;
use crate::fold;
use crate::interval::Ranges;
use crate::ir::{Node, Stmt};

/// `bound` with its parameter values in every expression and range. Cells, named expressions, atoms and properties keep their
/// numbers; rules that cannot fire are gone, and so are checks of values that fit these ranges.
pub(super) fn folded(bound: &Bound) -> Bound {
    let mut out = fold::folded(bound);
    let system = &mut out.system;
    for instance in &mut system.instances {
        instance.rules.retain(|rule| rule.when != Node::Const(0));
    }
    let constant = |v: i32| Node::Const(i64::from(v));
    for (k, state) in system.states.iter_mut().enumerate() {
        (state.var.lo, state.var.hi) = (constant(bound.states[k].0), constant(bound.states[k].1));
        state.init = bound.initial[k].map(constant);
    }
    for (input, (lo, hi)) in system.inputs.iter_mut().zip(&bound.inputs) {
        (input.lo, input.hi) = (constant(*lo), constant(*hi));
    }
    unchecked(&mut out);
    out
}

/// Takes the check from assignments whose value fits whatever the state and the inputs are.
fn unchecked(bound: &mut Bound) {
    let system = &bound.system;
    let ranges = Ranges {
        params: &system.params,
        states: &system.states,
        inputs: &system.inputs,
        lazies: &system.lazies,
    };
    let mut instances = system.instances.clone();
    for rule in instances.iter_mut().flat_map(|i| &mut i.rules) {
        settle(&mut rule.then, &ranges, &bound.states);
    }
    bound.system.instances = instances;
}

fn settle(list: &mut [Stmt], ranges: &Ranges, states: &[(i32, i32)]) {
    for statement in list {
        match statement {
            Stmt::Assign {
                base,
                index,
                value,
                checked,
                ..
            } => {
                let (lo, hi) = ranges.of(value);
                let len = index.as_ref().map_or(1, |(_, _, len)| *len);
                let mut targets = (*base..*base + len).map(|k| states[k as usize]);
                *checked &= targets.any(|(a, b)| lo < i128::from(a) || hi > i128::from(b));
            }
            Stmt::If(branches, rest) => {
                for (_, body) in branches {
                    settle(body, ranges, states);
                }
                settle(rest, ranges, states);
            }
        }
    }
}
