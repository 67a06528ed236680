//! A run that shows a property: its counterexample or its witness, found by exploring.

use stillpoint_engine::verdict_name;
use stillpoint_engine::{self as engine, Outcome};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;
use stillpoint_model::{Error, Limits, Options, Trace, Until, Verdict};

use super::Bounds;
use super::path::{MOST_CYCLES, Path};
use super::walk::path_of;
use crate::report::{counted, grouped};

/// What exploring for one property gave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jump {
    /// The verdict.
    pub verdict: Verdict,
    /// What was found, in a sentence or two.
    pub text: String,
    /// The run, if there is one to show.
    pub path: Option<Path>,
    /// The run beside it, for a property that compares two.
    pub other: Option<Path>,
}

/// Explores for property number `property` of the system alone, until it is decided or a bound is reached.
///
/// # Errors
/// A system that cannot be explored.
pub fn jump(bound: &Bound, property: usize, bounds: Bounds) -> Result<Jump, Error> {
    let mut alone = bound.clone();
    alone.system.properties = alone
        .system
        .properties
        .into_iter()
        .skip(property)
        .take(1)
        .collect();
    let options = Options {
        until: Until::Decided,
        ..options(bounds)
    };
    let outcome = engine::run(&alone, &options, false, &mut ())?;
    Ok(told(&alone, &outcome, bounds))
}

/// How to explore within these bounds.
pub(super) fn options(bounds: Bounds) -> Options {
    Options {
        limits: Limits {
            memory: Some(bounds.memory),
            time: Some(bounds.time),
            threads: bounds.threads,
        },
        ..Options::default()
    }
}

fn told(bound: &Bound, outcome: &Outcome, bounds: Bounds) -> Jump {
    let judged = outcome.report.properties.first();
    let form = bound.system.properties.first().map(|p| &p.form);
    let verdict = judged.map_or(Verdict::Inconclusive, |j| j.verdict);
    let trace = judged.and_then(|j| j.trace.as_ref());
    let short = |trace: &&Trace| trace.steps.len() <= MOST_CYCLES;
    let path = trace.filter(short).map(|trace| path_of(bound, trace));
    let pair = outcome.pairs.values().next();
    let second = pair.and_then(|pair| pair.second.as_ref());
    let explored = match pair {
        Some(pair) => format!("{} pairs of states", grouped(u128::from(pair.states))),
        None => format!(
            "{} states, depth {}",
            grouped(u128::from(outcome.report.states)),
            outcome.report.depth
        ),
    };
    let mut text = match (verdict, outcome.refuted.values().next()) {
        (Verdict::Inconclusive, _) => format!(
            "Not found, and not excluded: a limit ({} s, {} MiB) was reached after {explored}. \
             Start with a larger --time or --memory, or use `stillpoint check`.",
            bounds.time.as_secs_f64(),
            bounds.memory >> 20
        ),
        (Verdict::Vacuous, _) => format!("Vacuous: its condition never holds ({explored})."),
        (Verdict::Unreachable, _) => format!("Unreachable: no run gets there ({explored})."),
        (_, Some(reason)) => format!("Violated: {reason} ({explored})."),
        (verdict, None) => {
            let mut name = verdict_name(verdict).to_owned();
            name[..1].make_ascii_uppercase();
            format!("{name} ({explored}).")
        }
    };
    let stated = !outcome.refuted.is_empty();
    match (trace, path.is_some()) {
        (Some(trace), true) => {
            let what = match (verdict, form) {
                (Verdict::Violated, _) if !stated => "Counterexample:",
                (_, Some(Form::Always { when: None, .. })) => "Any run shows it; this one has",
                (_, Some(Form::Reachable { .. } | Form::CanAlwaysReach { .. })) => {
                    "Shortest run to the goal:"
                }
                (_, Some(Form::Independent { .. })) => "A run:",
                _ => "Shortest run to its condition:",
            };
            text.push_str(&format!(
                " {what} {}.",
                counted(trace.steps.len() as u64, "cycle")
            ));
            if let Some(start) = trace.loop_start {
                text.push_str(&format!(
                    " From cycle {} on it repeats for ever.",
                    start + 1
                ));
            }
        }
        (Some(trace), false) => text.push_str(&format!(
            " Its run has {} cycles, more than the {MOST_CYCLES} of a walk.",
            trace.steps.len()
        )),
        (None, _) if verdict == Verdict::Violated && !stated => {
            text.push_str(" Its run could not be rebuilt within the limits.");
        }
        (None, _) => {}
    }
    Jump {
        verdict,
        text,
        path,
        other: second.filter(short).map(|trace| path_of(bound, trace)),
    }
}
