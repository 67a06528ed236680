//! Safety relays: each is an instance of the block SIRELAY, called where the program calls it.

use super::super::ast::{Expr as Source, ExprKind as SourceKind, Relay};
use super::super::{Program, Variable};
use super::wiring::Role;
use super::{Making, Trigger, Value};
use crate::fault::{Fault, Span};
use crate::st::ast::{BinaryOp, Expr, ExprKind, Stmt, TypeKind};
use crate::tree::{
    assign, binary, call_block, expr, name, not, number, time, truth, variable, word,
};

/// The variables of a relay.
#[derive(Clone)]
pub(super) struct Instance {
    block: String,
    /// Q1 and Q2 of the call before.
    was: [String; 2],
}

/// Calls that are not explored: not in every cycle, or more than one.
pub(super) fn faults(program: &Program, faults: &mut Vec<Fault>) {
    let mut calls: Vec<(u8, &Span)> = Vec::new();
    for action in &program.actions {
        for one in &action.assigns {
            let Value::Relay(number) = one.value else {
                continue;
            };
            if action.trigger != Trigger::Always {
                faults.push(Fault::new(
                    &one.span,
                    format!("the relay {number} is called under a condition"),
                    "the times of a relay count its calls: call it in an action without condition",
                ));
            }
            if calls.iter().any(|(known, _)| *known == number) {
                faults.push(Fault::new(
                    &one.span,
                    format!("the relay {number} is called a second time"),
                    "the times of a relay count its calls: call it once in a cycle",
                ));
            }
            calls.push((number, &one.span));
        }
    }
}

/// What the call answers: 1, 2 and 4 for inputs, outputs and times that were not set up (S840D-RELAY-012).
fn status(relay: Option<&Relay>) -> i64 {
    let missing = |is: bool, bit: i64| if is { 0 } else { bit };
    relay.map_or(7, |relay| {
        missing(relay.inputs.is_some(), 1)
            + missing(relay.outputs.is_some(), 2)
            + missing(relay.times.is_some(), 4)
    })
}

/// Declares a block for each relay that is set up and called.
pub(super) fn declare(making: &mut Making<'_>) {
    for (relay, span) in making.program.called() {
        if status(making.program.relays.get(&relay)) != 0 {
            continue;
        }
        let mut fresh = |what: &str| making.wiring.fresh(&format!("sirelay_{relay}{what}"));
        let instance = Instance {
            block: fresh(""),
            was: [fresh("_q1"), fresh("_q2")],
        };
        let ty = TypeKind::Named("SIRELAY".to_owned());
        making
            .kept
            .push(variable(&instance.block, None, ty, None, &span));
        let first = making.interface.readings.first_sample_is_no_edge;
        for was in &instance.was {
            let init = Some(truth(first, &span));
            making
                .kept
                .push(variable(was, None, TypeKind::Bool, init, &span));
        }
        making.instances.insert(relay, instance);
    }
}

/// `target = SIRELAY(relay)`
pub(super) fn call(making: &Making<'_>, relay: u8, target: &Variable, span: &Span) -> Vec<Stmt> {
    let set_up = making.program.relays.get(&relay);
    let mut out = Vec::new();
    let written = |list: &[Source]| -> Vec<String> {
        let names = list.iter().filter_map(|e| match &e.kind {
            SourceKind::Variable(of) => making.wiring.roles.get(of),
            _ => None,
        });
        names
            .filter_map(|role| match role {
                Role::State(text) => Some(text.clone()),
                Role::Input(_) | Role::Zero => None,
            })
            .collect()
    };
    let outputs = set_up.and_then(|relay| relay.outputs.as_ref());
    let outputs = outputs.map_or_else(Vec::new, |(list, _)| written(list));
    match (set_up, making.instances.get(&relay)) {
        (Some(set_up), Some(instance)) => {
            out.extend(step(making, set_up, instance, &outputs, span));
        }
        // A relay that is not set up leaves its outputs at 0.
        _ => out.extend(
            outputs
                .iter()
                .map(|text| assign(text, truth(false, span), span)),
        ),
    }
    if let Some(Role::State(text)) = making.wiring.roles.get(target) {
        out.push(assign(text, number(status(set_up), span), span));
    }
    out
}

fn step(
    making: &Making<'_>,
    relay: &Relay,
    instance: &Instance,
    outputs: &[String],
    span: &Span,
) -> Vec<Stmt> {
    let inputs = relay.inputs.iter().flat_map(|(list, _)| list);
    let inputs: Vec<Expr> = inputs.map(|e| making.truth(e)).collect();
    let level = making.interface.readings.relay_acknowledged_by_level;
    let acknowledged = |k: usize| {
        let q = inputs[k].clone();
        let rises = not(name(&instance.was[k], span));
        if level {
            q
        } else {
            binary(BinaryOp::And, q, rises, span)
        }
    };
    let all = inputs[2..].iter().cloned();
    let all = all.reduce(|a, b| binary(BinaryOp::And, a, b, span));
    let times = relay.times.as_ref().map_or(&[][..], |(times, _)| times);
    let mut given = vec![
        ("E", all.unwrap_or_else(|| truth(true, span))),
        ("ACK1", acknowledged(0)),
        ("ACK2", acknowledged(1)),
    ];
    for (k, parameter) in ["TM1", "TI1", "TI2", "TI3"].into_iter().enumerate() {
        given.push((parameter, time(times.get(k).copied().unwrap_or(0), span)));
    }
    // Q1 and Q2 as they were before the relay writes its outputs, which may be among them.
    let kept: Vec<Stmt> = (0..2)
        .map(|k| assign(&instance.was[k], inputs[k].clone(), span))
        .collect();
    let mut out = vec![call_block(&instance.block, given, span)];
    out.extend(kept);
    for (parameter, target) in ["A0", "A1", "A2", "A3"].into_iter().zip(outputs) {
        let block = Box::new(name(&instance.block, span));
        let value = expr(ExprKind::Member(block, word(parameter, span)), span);
        out.push(assign(target, value, span));
    }
    out
}
