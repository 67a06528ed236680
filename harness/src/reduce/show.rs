//! What a reduced exploration tells about itself.

use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_spec::bind::Bound;

use super::{Explored, Reduction, Reductions};
use crate::engine::Evaluator;
use crate::report::{grouped, wrapped};

fn names(wanted: Reductions) -> Vec<&'static str> {
    let both = [(wanted.slice, "slice"), (wanted.symmetry, "symmetry")];
    both.iter().filter(|(on, _)| *on).map(|(_, n)| *n).collect()
}

/// Lines for readers, below a run.
pub fn text(out: &mut String, bound: &Bound, reduction: &Reduction) {
    let names = names(reduction.wanted).join(", ");
    if let Some(reason) = &reduction.whole {
        wrapped(
            out,
            &format!("  reduction ({names}): "),
            &format!("none, {reason}"),
        );
        return;
    }
    let _ = writeln!(
        out,
        "  reduction ({names}): {}; rule coverage and absorbing states are not told",
        match reduction.parts.len() {
            1 => "1 exploration".to_owned(),
            n => format!("{n} explorations"),
        }
    );
    for part in &reduction.parts {
        wrapped(out, "   ", &line(bound, part));
    }
    for (id, other) in &reduction.images {
        wrapped(
            out,
            "   ",
            &format!("{id}: by symmetry as {other}, not judged again"),
        );
    }
}

fn line(bound: &Bound, part: &Explored) -> String {
    let mut judged = part.properties.clone();
    if part.faults {
        judged.push("no assignment leaves its range".to_owned());
    }
    if judged.is_empty() {
        judged.push("no claim".to_owned());
    }
    let orbits = match part.permutations {
        1 => "states".to_owned(),
        n => format!("orbits under {n} permutations"),
    };
    let evaluator = match part.evaluator {
        Evaluator::Generated => "generated step",
        Evaluator::Interpreter => "interpreter",
    };
    format!(
        "{} of {} variables, {} of {} inputs, {} {orbits}, {evaluator}, {:.2} s: {}",
        part.variables,
        bound.states.len(),
        part.inputs,
        bound.inputs.len(),
        grouped(u128::from(part.states)),
        part.seconds,
        judged.join(", ")
    )
}

/// For the report as JSON.
pub fn to_json(bound: &Bound, reduction: &Reduction) -> Value {
    let parts: Vec<Value> = reduction
        .parts
        .iter()
        .map(|p| {
            json!({
                "properties": p.properties, "faults": p.faults,
                "variables": p.variables, "inputs": p.inputs, "permutations": p.permutations,
                "states": p.states, "seconds": p.seconds,
                "evaluator": match p.evaluator {
                    Evaluator::Generated => "generated", Evaluator::Interpreter => "interpreter",
                },
            })
        })
        .collect();
    let images: Vec<Value> = reduction
        .images
        .iter()
        .map(|(id, other)| json!({ "property": id, "as": other }))
        .collect();
    json!({
        "wanted": names(reduction.wanted), "whole": reduction.whole,
        "variables": bound.states.len(), "inputs": bound.inputs.len(),
        "explorations": parts, "images": images,
    })
}
