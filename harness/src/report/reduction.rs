//! What a reduced exploration tells about itself.

use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_engine::{Evaluator, Explored, Reduction, Reductions};
use stillpoint_lang::bind::Bound;

use super::words::{grouped, wrapped};

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
        wrapped(out, "   ", &line(bound, part, true));
    }
    for (id, other) in &reduction.images {
        wrapped(
            out,
            "   ",
            &format!("{id}: by symmetry as {other}, not judged again"),
        );
    }
}

/// What [`text`] tells, each line apart and without times.
pub fn lines(bound: &Bound, reduction: &Reduction) -> Vec<String> {
    let names = names(reduction.wanted).join(", ");
    if let Some(reason) = &reduction.whole {
        return vec![format!("Reduction ({names}): none, {reason}")];
    }
    let parts = reduction.parts.iter();
    let parts = parts.map(|p| format!("Reduction ({names}): {}", line(bound, p, false)));
    let images = reduction.images.iter();
    let images =
        images.map(|(id, other)| format!("{id}: by symmetry as {other}, not judged again"));
    parts.chain(images).collect()
}

fn line(bound: &Bound, part: &Explored, timed: bool) -> String {
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
    let seconds = match timed {
        true => format!(", {:.2} s", part.seconds),
        false => String::new(),
    };
    format!(
        "{} of {} variables, {} of {} inputs, {} {orbits}, {evaluator}{seconds}: {}",
        part.variables,
        bound.states.len(),
        part.inputs,
        bound.inputs.len(),
        grouped(u128::from(part.states)),
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
