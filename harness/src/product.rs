//! Products of parts of a machine, which are too large to be explored: judged by the proof engines beside the exploration of the parts.

use std::time::{Duration, Instant};

use stillpoint_engine::check::{Checked, Settings};
use stillpoint_engine::subject::{Readings, Subject, Task, of_runs};
use stillpoint_engine::theorems::Cited;
use stillpoint_engine::{Evaluator, Outcome};
use stillpoint_lang::diag::Result;
use stillpoint_model::{FaultReport, Judgement, Progress, Verdict};

use crate::proof::{self, Judged, judge};

/// The most wall time for a property: what takes longer is told as open, and `check --whole` asks it for as long as is wanted.
const EACH: Duration = Duration::from_secs(60);

/// The products of a machine; none where its family describes none.
///
/// # Errors
/// The family's description of them is wrong.
pub fn products(subject: &Subject, readings: &Readings) -> Result<Option<Subject>> {
    let products = subject.machine.as_ref().map(|machine| machine.products());
    let products = products.transpose()?.unwrap_or_default();
    match &subject.machine {
        Some(machine) if !products.is_empty() => {
            of_runs(&subject.path, machine.clone(), &products, readings).map(Some)
        }
        _ => Ok(None),
    }
}

/// Judges products of a machine, what is a theorem of its family apart; `begin` is told of each.
pub fn judged(
    tasks: Vec<Task>,
    settings: &Settings,
    begin: &mut dyn FnMut(&Task) -> Box<dyn Progress>,
) -> Vec<(Task, Checked)> {
    let start = Instant::now();
    let one = |mut task: Task| {
        let shown = begin(&task);
        let mut cited = Cited::take(settings.theorems.as_deref(), &mut task);
        let engines = proof::Settings {
            time: (settings.time).map(|time| time.saturating_sub(start.elapsed())),
            each: Some(EACH),
            memory: settings.memory,
            interrupt: settings.interrupt.clone(),
            ..proof::Settings::default()
        };
        let judged = match cited.all {
            true => Vec::new(),
            false => judge(&task.bound, &engines),
        };
        drop(shown);
        let mut outcome = outcome(&task, judged);
        cited.put_back(&mut task, &mut outcome);
        (task, Checked::of_product(outcome, cited))
    };
    tasks.into_iter().map(one).collect()
}

/// What the engines found, as the outcome of an exploration of nothing.
fn outcome(task: &Task, judged: Vec<Judged>) -> Outcome {
    let system = &task.bound.system;
    let mut outcome = Outcome {
        evaluator: Evaluator::Interpreter,
        ..Outcome::nothing(system)
    };
    let report = &mut outcome.report;
    // The sum of nothing is -0.
    report.seconds = judged.iter().map(|one| one.seconds).sum::<f64>() + 0.0;
    for (k, one) in judged.into_iter().enumerate() {
        report.complete &= one.verdict != Verdict::Inconclusive;
        // What holds has neither: they would be of a run that puts it to the test.
        let shown = matches!(one.verdict, Verdict::Violated | Verdict::Reached);
        if k < system.properties.len() {
            let reason = one.reason.filter(|_| one.verdict == Verdict::Violated);
            outcome.refuted.extend(reason.map(|reason| (k, reason)));
            report.properties.push(Judgement {
                id: one.id,
                verdict: one.verdict,
                length: one.length.filter(|_| shown),
                bound: None,
                fastest: None,
                trace: one.trace.filter(|_| shown),
            });
        } else if one.verdict == Verdict::Violated {
            report.faults.push(FaultReport {
                code: u32::MAX,
                length: one.length,
                trace: one.trace,
            });
        }
    }
    outcome
}
