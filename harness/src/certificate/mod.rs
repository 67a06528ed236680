//! Certificates, inductive invariants with ranking functions and witnesses: files with everything that is needed to check the verdicts of a report again.
//!
//! What a certificate has to show is defined by its checker, the crate `stillpoint-certify`. This module finds the sets,
//! ranks and runs it asks for, with another walk through the reachable states; nothing that is confirmed rests on it.

mod cycle;
pub mod proofs;
mod ranks;
mod search;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use stillpoint_certify::format::{Body, Kind, Proof, Run, Task, Verdict};
use stillpoint_certify::states::Radix;
use stillpoint_certify::{subject, write};
use stillpoint_engine::check::Checked;
use stillpoint_engine::subject::{Subject, Task as Explored};
use stillpoint_engine::table::{Generated, Interpreted};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::Form;
use stillpoint_model::{self as model, Judgement, Trace};

use crate::atomic::write_with;
use search::Search;

/// What was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Written {
    /// Claims.
    pub claims: usize,
    /// Properties about which nothing is claimed.
    pub open: usize,
}

/// Writes a certificate of a report to `path`; `threads` is 0 for all processors. `progress` is told, from any thread, of how
/// many systems of how many the claims are ready.
///
/// # Errors
/// One sentence: files that cannot be read or written, a specification that has changed since the check.
pub fn certify(
    path: &Path,
    subject: &Subject,
    checked: &[Checked],
    threads: usize,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Written, String> {
    if subject.tasks.iter().any(|task| task.loosely) {
        return Err("a certificate is about the systems themselves: check them exactly".to_owned());
    }
    let subject::Subject { mut header, bounds } = read_again(subject, &subject.tasks)?;
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        given => given,
    };
    let next = AtomicUsize::new(0);
    let done = Mutex::new(BTreeMap::new());
    let worker = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let (Some(bound), Some(task), Some(checked)) = (
                bounds.get(number),
                header.task.get(number),
                checked.get(number),
            ) else {
                break;
            };
            let built = build(bound, checked, task.clone());
            if let Ok(mut done) = done.lock() {
                done.insert(number, built);
                progress(done.len(), bounds.len());
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.min(bounds.len()) {
            scope.spawn(worker);
        }
        worker();
    });
    let done = done.into_inner().map_err(|_| "a thread failed")?;
    let (tasks, bodies): (Vec<Task>, Vec<Body>) = done
        .into_values()
        .collect::<Result<Vec<_>, String>>()?
        .into_iter()
        .unzip();
    header.task = tasks;
    write_with(path, |out| write(out, &header, &bodies))
        .map_err(|e| format!("{} cannot be written: {e}", path.display()))?;
    let properties = || header.task.iter().flat_map(|task| &task.property);
    let open = properties().filter(|p| p.verdict == Verdict::Open).count();
    Ok(Written {
        claims: properties().count() - open,
        open,
    })
}

/// The file of a subject, read again as whoever checks a certificate or a report reads it; `tasks` are its own.
///
/// # Errors
/// It cannot be read any more, or its systems are not those that were checked.
pub(crate) fn read_again(
    subject: &Subject,
    tasks: &[Explored],
) -> Result<subject::Subject, String> {
    let kind = match subject.machine {
        Some(_) => Kind::Machine,
        None => Kind::Specification,
    };
    let all = || tasks.iter();
    let readings: BTreeMap<String, String> = all().flat_map(|t| t.bound.readings()).collect();
    let read = subject::Subject::load(&subject.path, kind, &readings).map_err(|e| e.to_string())?;
    let mut pairs = read.bounds.iter().zip(all().map(|task| task.own()));
    let same = read.bounds.len() == tasks.len()
        && pairs.all(|(a, b)| a.system == b.system && a.values == b.values);
    match same {
        true => Ok(read),
        false => Err("the specification was changed during the check".to_owned()),
    }
}

/// The claims about one task and what shows them.
fn build(bound: &Bound, checked: &Checked, mut task: Task) -> Result<(Task, Body), String> {
    let report = &checked.outcome.report;
    let radix = Radix::new(bound).ok_or("the states need more than 128 bits")?;
    let mut body = Body::default();
    for (number, (property, judged)) in task.property.iter_mut().zip(&report.properties).enumerate()
    {
        let (verdict, reason) = claim(judged, checked.outcome.refuted.contains_key(&number));
        property.verdict = verdict;
        property.reason = reason.to_owned();
        let second = checked
            .outcome
            .pairs
            .get(&number)
            .and_then(|p| p.second.as_ref());
        let mut proof = Proof::default();
        if matches!(verdict, Verdict::Violated | Verdict::Reached) {
            let traces = judged.trace.iter().chain(second);
            proof.runs = traces.map(|trace| run(bound, &radix, trace)).collect();
        }
        body.proofs.push(proof);
    }
    let about_all = |(form, verdict): (&Form, Verdict)| match verdict {
        Verdict::Holds | Verdict::Vacuous | Verdict::Unreachable => true,
        Verdict::Violated => matches!(form, Form::CanAlwaysReach { .. }),
        Verdict::Reached | Verdict::Open => false,
    };
    let forms = bound.system.properties.iter().map(|p| &p.form);
    let mut claims = forms.zip(task.property.iter().map(|p| p.verdict));
    if report.complete || claims.any(about_all) {
        let verdicts: Vec<Verdict> = task.property.iter().map(|p| p.verdict).collect();
        let found = match Generated::find(bound) {
            Some(system) => Search::run(bound, &system, radix, &verdicts)
                .and_then(|search| search.prove(&mut task, &mut body)),
            None => Search::run(bound, &Interpreted::new(bound), radix, &verdicts)
                .and_then(|search| search.prove(&mut task, &mut body)),
        };
        found.map_err(|e| format!("{}: no certificate can be made: {e}", task.system))?;
    } else {
        for fault in &report.faults {
            let site = bound.system.sites.get(fault.code as usize);
            if let (Some(site), Some(trace)) = (site, &fault.trace) {
                if !task.faults.contains(&site.name) {
                    task.faults.push(site.name.clone());
                    body.faults.push(run(bound, &radix, trace));
                }
            }
        }
    }
    Ok((task, body))
}

/// What is claimed for a judgement; for an open one the reason.
fn claim(judged: &Judgement, refuted: bool) -> (Verdict, &'static str) {
    match judged.verdict {
        _ if refuted => (
            Verdict::Open,
            "the recorded bounds differ from those found; certificates do not cover recorded bounds",
        ),
        model::Verdict::Violated if judged.trace.is_none() => {
            (Verdict::Open, "no run could be rebuilt within the limits")
        }
        model::Verdict::Holds => (Verdict::Holds, ""),
        model::Verdict::Violated => (Verdict::Violated, ""),
        model::Verdict::Vacuous => (Verdict::Vacuous, ""),
        model::Verdict::Reached if judged.trace.is_none() => {
            (Verdict::Open, "no run could be rebuilt within the limits")
        }
        model::Verdict::Reached => (Verdict::Reached, ""),
        model::Verdict::Unreachable => (Verdict::Unreachable, ""),
        model::Verdict::Inconclusive => (Verdict::Open, "a limit was reached before a verdict"),
    }
}

/// A run of the explorer in the certificate's terms.
fn run(bound: &Bound, radix: &Radix, trace: &Trace) -> Run {
    let chosen = |k: usize| trace.initial.iter().find(|(cell, _)| *cell as usize == k);
    let cells = bound.initial.iter().zip(&bound.states).enumerate();
    let state: Vec<i32> = cells
        .map(|(k, (init, (lo, _)))| {
            init.unwrap_or(lo.wrapping_add_unsigned(chosen(k).map_or(0, |(_, value)| *value)))
        })
        .collect();
    Run {
        initial: radix.index(&state).unwrap_or(u128::MAX),
        steps: trace.steps.clone(),
        repeats: trace.loop_start,
    }
}
