//! A resolved system as JSON: everything named and written out, for tools of one's own.

use serde_json::{Value, json};
use stillpoint_lang::bind::{Bound, Bounds};
use stillpoint_lang::ir::{Form, LazyKind, Ty, Var};

use super::text::{effect, expression};

/// The system: states, inputs, parameters, readings, named expressions, rules with their requirement ids, properties.
///
/// Expressions are Structured Text in which a state variable is its value after the step and `PREV(x)` the one before.
pub fn json(bound: &Bound) -> Value {
    let system = &bound.system;
    let cell = |var: &Var, range: Option<Bounds>| {
        json!({
            "name": var.name, "type": type_name(bound, var.ty), "range": range.map(|(lo, hi)| [lo, hi]),
            "text": var.text, "requirements": var.ids,
        })
    };
    let with = |mut value: Value, key: &str, more: Value| {
        if let Some(object) = value.as_object_mut() {
            object.insert(key.to_owned(), more);
        }
        value
    };
    let states: Vec<Value> = system
        .states
        .iter()
        .enumerate()
        .map(|(k, s)| {
            let initial = bound.initial[k].map(|v| system.show(s.var.ty, i64::from(v)));
            // Null: any value of the range.
            with(
                cell(&s.var, Some(bound.states[k])),
                "initial",
                json!(initial),
            )
        })
        .collect();
    let inputs: Vec<Value> = system
        .inputs
        .iter()
        .zip(&bound.inputs)
        .map(|(v, r)| cell(v, Some(*r)))
        .collect();
    let params: Vec<Value> = system
        .params
        .iter()
        .zip(&bound.values)
        .filter(|(p, _)| p.reading.is_none())
        .map(|(p, v)| {
            with(
                cell(&p.var, None),
                "value",
                json!(system.show(p.var.ty, i64::from(*v))),
            )
        })
        .collect();
    let chosen = bound.readings();
    let readings: Vec<Value> = system
        .readings
        .iter()
        .map(|r| {
            let option = chosen
                .iter()
                .find(|(id, _)| *id == r.id)
                .map(|(_, option)| option);
            json!({ "id": r.id, "text": r.text, "options": r.options, "chosen": option })
        })
        .collect();
    let named: Vec<Value> = system
        .lazies
        .iter()
        .map(|l| {
            let kind = match l.kind {
                LazyKind::Let => "let",
                LazyKind::Output => "output",
                LazyKind::Wire => "wire",
            };
            json!({
                "name": l.name, "kind": kind, "type": type_name(bound, l.ty), "value": expression(system, &l.value),
                "text": l.text, "requirements": l.ids,
            })
        })
        .collect();
    let instances: Vec<Value> = system
        .instances
        .iter()
        .map(|i| {
            let rules: Vec<Value> = i
                .rules
                .iter()
                .map(|r| {
                    json!({
                        "name": r.name, "requirements": r.ids, "note": r.note,
                        "when": expression(system, &r.when), "then": effect(system, &r.then),
                    })
                })
                .collect();
            json!({ "name": i.name, "machine": i.machine, "rules": rules })
        })
        .collect();
    let properties: Vec<Value> = system
        .properties
        .iter()
        .map(|p| {
            let written: serde_json::Map<String, Value> =
                p.written.iter().map(|(k, t)| (k.clone(), json!(t))).collect();
            json!({
                "id": p.id, "index": p.index, "form": form_name(&p.form), "text": p.text, "note": p.note,
                "requirements": p.req, "written": written,
            })
        })
        .collect();
    json!({
        "system": system.name, "text": system.text, "note": system.note, "cycle_us": system.cycle_us,
        "enums": system.enums.iter().map(|e| json!({ "name": e.name, "values": e.values })).collect::<Vec<_>>(),
        "parameters": params, "readings": readings, "states": states, "inputs": inputs, "named": named,
        "instances": instances, "properties": properties,
    })
}

fn type_name(bound: &Bound, ty: Ty) -> String {
    match ty {
        Ty::Bool => "BOOL".to_owned(),
        Ty::Int => "INT".to_owned(),
        Ty::Enum(e) => bound
            .system
            .enums
            .get(e)
            .map_or("INT".to_owned(), |e| e.name.clone()),
    }
}

fn form_name(form: &Form) -> &'static str {
    match form {
        Form::Always { .. } => "always",
        Form::LeadsTo {
            within: Some(_), ..
        } => "bounded response",
        Form::LeadsTo { .. } => "response",
        Form::Unless { .. } => "weak until",
        Form::CanAlwaysReach { .. } => "recoverable",
        Form::Reachable { .. } => "reachable",
        Form::Independent { .. } => "independent",
    }
}
