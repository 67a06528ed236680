//! The report as JSON.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use stillpoint_engine::Evaluator;
use stillpoint_engine::check::{By, Checked, Summary, Unfired};
use stillpoint_engine::excluded::{Decisive, Exclusion};
use stillpoint_engine::lines;
use stillpoint_engine::subject::Subject;
use stillpoint_engine::verdict_name;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Topic;
use stillpoint_machine::Abstraction;
use stillpoint_model::{Trace, Verdict};

use super::{coarser, params, reduced, reduction, topics, values};
use crate::guarantees::{Answer, answers};

/// The whole report as JSON: the design's keys at the top, details under `runs`.
pub fn to_json(subject: &Subject, checked: &[Checked], summaries: &[Summary]) -> Value {
    let runs: Vec<Value> = subject
        .tasks
        .iter()
        .zip(checked)
        .map(|(task, done)| {
            let report = &done.outcome.report;
            let system = &task.bound.system;
            let properties: Vec<Value> = system
                .properties
                .iter()
                .zip(&report.properties)
                .enumerate()
                .map(|(k, (p, j))| {
                    let broken = j.trace.as_ref().filter(|_| j.verdict == Verdict::Violated);
                    let lines = broken.map_or_else(Vec::new, |t| lines::deciding(&task.bound, p, t));
                    let lines: Vec<Value> = (lines.iter())
                        .map(|l| json!({ "line": l.number, "value": l.value, "text": l.text, "before": l.before }))
                        .collect();
                    let by = done.decisive.get(&k).map_or(&[][..], Vec::as_slice);
                    let by: Vec<Value> = by.iter().map(decisive).collect();
                    let counterexample = (j.verdict == Verdict::Violated)
                        .then(|| j.trace.as_ref().map(|t| steps(t, &task.bound)));
                    json!({
                        "id": p.id, "index": p.index, "text": p.text, "requirements": p.req,
                        "verdict": verdict_name(j.verdict), "theorem": done.cited.contains(&k), "length": j.length, "bound": j.bound, "fastest": j.fastest,
                        "excluded": done.excluded.get(&k).map(excluded),
                        "refuted": done.outcome.refuted.get(&k),
                        "counterexample": counterexample.flatten(), "lines": lines, "decided_by": by,
                    })
                })
                .collect();
            let rules: Vec<Value> = system
                .rules()
                .zip(&report.coverage)
                .filter(|_| done.explored())
                .map(|(r, n)| json!({ "rule": r.name, "requirements": r.ids, "fired": n }))
                .collect();
            let unfired: Vec<Value> = done
                .unfired
                .iter()
                .map(|(rule, why)| {
                    let why = match why {
                        Unfired::Parameters => "excluded by the parameters",
                        Unfired::Explained(reason) => reason,
                        Unfired::Unexplained => "unexplained",
                        Unfired::Unknown => "not explored to the end",
                    };
                    json!({ "rule": rule, "reason": why })
                })
                .collect();
            json!({
                "title": task.title, "system": system.name, "axes": task.axes,
                "abstractions": coarser(task, done).collect::<Vec<_>>(),
                "parameters": params(&task.bound).into_iter().collect::<BTreeMap<_, _>>(),
                "readings": task.bound.readings().into_iter().collect::<BTreeMap<_, _>>(),
                "states": report.states, "transitions": number(report.transitions),
                "depth": report.depth, "seconds": report.seconds, "again": done.again,
                "explored": done.explored(),
                "by": match done.by {
                    By::Exploration => "exploration", By::Theorems => "theorems", By::Proofs => "proofs",
                },
                "complete": report.complete,
                "resumable": report.resumable,
                "absorbing": (!reduced(done)).then_some(report.absorbing), "memory": report.memory,
                "bytes_per_state": report.bytes_per_state(),
                "index_space": number(report.index_space),
                "evaluator": match done.outcome.evaluator {
                    Evaluator::Generated => "generated", Evaluator::Interpreter => "interpreter",
                },
                "properties": properties, "rules": rules, "unfired": unfired,
                "reduction": done.outcome.reduction.as_ref().map(|r| reduction::to_json(&task.bound, r)),
                "warnings": system.warnings,
            })
        })
        .collect();
    let reports = || checked.iter().map(|c| &c.outcome.report);
    json!({
        "name": subject.name,
        "file": subject.path.display().to_string(),
        "states": reports().map(|r| r.states).sum::<u64>(),
        "transitions": number(reports().map(|r| r.transitions).sum()),
        "depth": reports().map(|r| r.depth).max().unwrap_or(0),
        "seconds": super::seconds(checked),
        "complete": reports().all(|r| r.complete),
        "properties": summaries.iter().map(|s| json!({
            "id": s.id, "verdict": verdict_name(s.verdict), "length": s.length, "excluded": s.excluded,
        })).collect::<Vec<_>>(),
        "guarantees": guarantees(subject, checked),
        "faults": topics::to_json(subject, checked, Topic::Fault),
        "reactions": topics::to_json(subject, checked, Topic::Reaction),
        "warnings": values::to_json(subject.machine.as_ref(), &subject.path.display().to_string()),
        "runs": runs,
    })
}

/// What the machine file asks of its machine, each with its answer; times in microseconds.
pub fn guarantees(subject: &Subject, checked: &[Checked]) -> Vec<Value> {
    let answer = |answer: &Answer<'_>| {
        let runs = answer.runs.iter().map(|run| {
            let values = run.values.iter();
            let values =
                values.map(|v| json!({ "name": v.name, "value": v.value, "axes": v.axes }));
            json!({
                "axes": run.task.axes, "title": run.task.title, "faults": run.task.faults, "verdict": verdict_name(run.verdict), "bound_us": run.bound,
                "way": run.way.as_ref().map(|(way, _)| way), "way_at": run.way.as_ref().map(|(_, speed)| speed),
                "values": values.collect::<Vec<_>>(), "abstractions": Abstraction::texts(&run.task.abstractions),
            })
        });
        let asked = answer.guarantee;
        json!({
            "name": asked.name, "pattern": asked.pattern, "door": asked.door, "text": asked.text,
            "source": asked.source, "verdict": verdict_name(answer.verdict), "runs": runs.collect::<Vec<_>>(),
        })
    };
    answers(subject, checked).iter().map(answer).collect()
}

/// A parameter that alone decides that a guarantee is broken.
fn decisive(d: &Decisive) -> Value {
    json!({ "parameter": d.name, "value": d.value, "holds_with": d.instead, "from": d.source })
}

/// The parameters that exclude a witness.
fn excluded(exclusion: &Exclusion) -> Value {
    let by = exclusion.by.iter().map(|d| {
        json!({ "parameter": d.name, "value": d.value, "reached_with": d.instead, "from": d.source })
    });
    json!({ "by": by.collect::<Vec<_>>(), "exact": exclusion.exact })
}

fn steps(trace: &Trace, bound: &Bound) -> Value {
    let names = |step: &Vec<(u32, u32)>| -> Value {
        step.iter()
            .filter_map(|(k, v)| {
                let input = bound.system.inputs.get(*k as usize)?;
                let (lo, _) = bound.inputs[*k as usize];
                Some((
                    input.name.clone(),
                    json!(bound.system.show(input.ty, i64::from(lo) + i64::from(*v))),
                ))
            })
            .collect::<serde_json::Map<_, _>>()
            .into()
    };
    json!({ "steps": trace.steps.iter().map(names).collect::<Vec<_>>(), "loop_start": trace.loop_start })
}

/// A count; beyond 64 bits a float, since JSON readers would lose digits anyway.
fn number(n: u128) -> Value {
    u64::try_from(n).map_or(json!(n as f64), |n| json!(n))
}
