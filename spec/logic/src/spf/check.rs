//! What is told of a program that is right: check C6, and what check C10 warns of.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::Note;
use super::ast::{Action, Expr, ExprKind, Relay, Value};
use super::variable::{Ty, Variable};
use crate::fault::Span;

/// The longest window for a temporary acknowledgement that the manual gives a relay, in microseconds.
const WINDOW: i64 = 1_000_000;

/// The notes of a program.
pub(crate) fn notes(
    source: &Arc<str>,
    actions: &[Action],
    relays: &BTreeMap<u8, Relay>,
) -> Vec<Note> {
    let mut notes = Vec::new();
    let mut note = |span: &Span, rule: &'static str, text: String| {
        notes.push(Note::new(source, span.start, rule, text));
    };
    let kept = || actions.iter().filter(|action| !action.modal);
    if let (Some(first), Some(last)) = (kept().next(), kept().next_back()) {
        let text = format!(
            "ids {}..{} have to lie in the protected range: MD11500[0] at most {}, MD11500[1] at least {}",
            first.id, last.id, first.id, last.id
        );
        note(&first.id_span, "C6", text);
    }
    for action in actions.iter().filter(|action| action.modal) {
        let text = format!(
            "the action {} begins with ID: it ends when the mode changes; it is explored as if it stayed, as IDS does",
            action.id
        );
        note(&action.id_span, "ID", text);
    }
    let mut written: BTreeMap<&Variable, (BTreeSet<u8>, Span)> = BTreeMap::new();
    for action in actions {
        for assign in &action.assigns {
            if let ExprKind::Variable(variable) = &assign.target.kind {
                let place = || (BTreeSet::new(), assign.target.span.clone());
                written
                    .entry(variable)
                    .or_insert_with(place)
                    .0
                    .insert(action.id);
            }
        }
    }
    for (variable, (by, span)) in &written {
        // To start and stop a timer takes two actions.
        if by.len() > 1 && variable.kind().ty != Ty::Real {
            let list: Vec<String> = by.iter().map(u8::to_string).collect();
            let text = format!("{variable} is written by the actions {}", list.join(", "));
            note(span, "C10", text);
        }
    }
    let outputs = relays.values().filter_map(|relay| relay.outputs.as_ref());
    let driven: BTreeSet<&Variable> = outputs
        .flat_map(|(list, _)| list.iter().filter_map(variable))
        .collect();
    let mut silent: BTreeMap<&Variable, Span> = BTreeMap::new();
    for action in actions {
        let conditions = action.condition.iter();
        let values = action
            .assigns
            .iter()
            .filter_map(|assign| match &assign.value {
                Value::Expr(expr) => Some(expr),
                Value::Relay(_) => None,
            });
        let called = action
            .assigns
            .iter()
            .filter_map(|assign| match &assign.value {
                Value::Relay(number) => relays.get(number)?.inputs.as_ref(),
                Value::Expr(_) => None,
            });
        let connected = called.flat_map(|(list, _)| list);
        for expr in conditions.chain(values).chain(connected) {
            expr.each(&mut |part| {
                if let Some(variable) = variable(part) {
                    let known = written.contains_key(variable) || driven.contains(variable);
                    if variable.kind().own && !known {
                        silent.entry(variable).or_insert_with(|| part.span.clone());
                    }
                }
            });
        }
    }
    for (variable, span) in silent {
        let text = format!("{variable} is read and never written: it is 0");
        note(&span, "C10", text);
    }
    for (number, relay) in relays {
        if let Some((times, span)) = &relay.times {
            if times.first().is_some_and(|window| *window > WINDOW) {
                let text = format!(
                    "the window of the relay {number} is longer than 1 s: the comparison with the PLC tells an error before it ends"
                );
                note(span, "C7", text);
            }
        }
    }
    notes
}

fn variable(expr: &Expr) -> Option<&Variable> {
    match &expr.kind {
        ExprKind::Variable(variable) => Some(variable),
        _ => None,
    }
}
