//! A run that shows a property: its counterexample or its witness, found by exploring.

use stillpoint_model::table::{Generated, Interpreted, properties};
use stillpoint_model::{Error, Form, Limits, Options, Report, Verdict, explore};
use stillpoint_spec::bind::Bound;

use super::Bounds;
use super::path::{MOST_CYCLES, Path};
use super::walk::path_of;
use crate::report::{grouped, verdict_name};

/// What exploring for one property gave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jump {
    /// The verdict, as `check --json` names it; none where no exploration was made.
    pub verdict: Option<&'static str>,
    /// What was found, in a sentence or two.
    pub text: String,
    /// The run, if there is one to show.
    pub path: Option<Path>,
}

impl Jump {
    fn none(text: impl Into<String>) -> Self {
        Self {
            verdict: None,
            text: text.into(),
            path: None,
        }
    }
}

/// Explores for property number `property` of the system alone, until it is decided or a bound is reached.
///
/// # Errors
/// A system that cannot be explored.
pub fn jump(bound: &Bound, property: usize, bounds: Bounds) -> Result<Jump, Error> {
    let listed = properties(bound);
    let Some((_, wanted)) = listed.into_iter().find(|(k, _)| *k == property) else {
        return Ok(Jump::none(
            "This property compares two runs that differ in some inputs, so no single walk shows it; `stillpoint check` judges it.",
        ));
    };
    let options = Options {
        limits: Limits {
            memory: Some(bounds.memory),
            time: Some(bounds.time),
            threads: bounds.threads,
        },
        stop_when_decided: true,
        ..Options::default()
    };
    let form = wanted.form.clone();
    let wanted = [wanted];
    let report = match Generated::find(bound) {
        Some(system) => explore(&system, &wanted, &options, &mut ())?,
        None => explore(&Interpreted::new(bound), &wanted, &options, &mut ())?,
    };
    Ok(told(bound, &form, &report, bounds))
}

fn told(bound: &Bound, form: &Form, report: &Report, bounds: Bounds) -> Jump {
    let Some(judged) = report.properties.first() else {
        return Jump::none("The exploration gave no verdict.");
    };
    let explored = format!(
        "{} states, depth {}",
        grouped(u128::from(report.states)),
        report.depth
    );
    let trace = judged.trace.as_ref();
    let path = trace.filter(|t| t.steps.len() <= MOST_CYCLES);
    let path = path.map(|trace| path_of(bound, trace));
    let cycles = trace.map_or(0, |t| t.steps.len());
    let found = match judged.verdict {
        Verdict::Violated => "violated",
        Verdict::Holds => "holds",
        Verdict::Vacuous => "vacuous: its condition never holds",
        Verdict::Reached => "reached",
        Verdict::Unreachable => "unreachable: no run gets there",
        Verdict::Inconclusive => "not decided",
    };
    let mut text = format!("{found} ({explored}).");
    match (judged.verdict, path.is_some()) {
        (Verdict::Inconclusive, _) => {
            text = format!(
                "Not found, and not excluded: a limit ({} s, {} MiB) was reached after {explored}. \
                 Start with a larger --time or --memory, or use `stillpoint check`.",
                bounds.time.as_secs_f64(),
                bounds.memory >> 20
            );
        }
        (Verdict::Violated, true) => {
            text.push_str(&format!(" Counterexample: {cycles} cycles."));
        }
        (Verdict::Holds, true) => {
            let what = match form {
                Form::Always { when: None, .. } => "Any run shows it; this one has",
                Form::CanAlwaysReach { .. } => "Shortest run to the goal:",
                _ => "Shortest run to its condition:",
            };
            text.push_str(&format!(" {what} {}.", count(cycles)));
        }
        (Verdict::Reached, true) => {
            text.push_str(&format!(" Shortest run: {}.", count(cycles)));
        }
        (Verdict::Vacuous | Verdict::Unreachable, _) => {}
        (_, false) => match trace {
            Some(_) => text.push_str(&format!(
                " Its run has {cycles} cycles, more than the {MOST_CYCLES} of a walk."
            )),
            None => text.push_str(" There is no run to show."),
        },
    }
    if let Some(start) = trace.and_then(|t| t.loop_start).filter(|_| path.is_some()) {
        text.push_str(&format!(
            " From cycle {} on the run repeats for ever.",
            start + 1
        ));
    }
    Jump {
        verdict: Some(verdict_name(judged.verdict)),
        text,
        path,
    }
}

fn count(cycles: usize) -> String {
    match cycles {
        1 => "1 cycle".to_owned(),
        n => format!("{n} cycles"),
    }
}
