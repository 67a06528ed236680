//! The report of `check`, for readers and as JSON.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_model::{Storage, Trace, Verdict};
use stillpoint_show::diagram::{Diagram, Mark};
use stillpoint_spec::bind::Bound;
use stillpoint_spec::ir::Topic;

use crate::check::{Checked, Settings, Summary, Unfired, exit_status, violations};
use crate::engine::{Evaluator, replay};
use crate::reduce;
use crate::subject::{Subject, Task};
use crate::timing;
use crate::topics;

/// Property texts are wrapped at this width.
const WIDTH: usize = 100;

/// A verdict as it stands in JSON.
pub fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Holds => "holds",
        Verdict::Violated => "violated",
        Verdict::Vacuous => "vacuous",
        Verdict::Reached => "reached",
        Verdict::Unreachable => "unreachable",
        Verdict::Inconclusive => "inconclusive",
    }
}

/// A number with thin groups of three: `4 024 036`.
pub fn grouped(n: u128) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (k, d) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k) % 3 == 0 {
            out.push(' ');
        }
        out.push(d);
    }
    out
}

/// The timing diagram of a run, with a mark at its last cycle.
pub fn diagram(bound: &Bound, trace: &Trace, mark: &str) -> Diagram {
    let cycles = replay(bound, trace);
    let mut diagram = timing::of_run(bound, &cycles);
    diagram.marks.push(Mark {
        column: cycles.len(),
        text: mark.to_owned(),
        fault: true,
    });
    // A loop starts with the step of that number, which makes the column after it.
    diagram.loop_start = trace.loop_start.map(|k| k + 1);
    diagram
}

/// The whole report as text.
pub fn text(subject: &Subject, checked: &[Checked], summaries: &[Summary]) -> String {
    let mut out = String::new();
    headline(&mut out, subject, checked, summaries);
    if let Some(machine) = &subject.machine {
        for group in &machine.groups {
            let _ = writeln!(out, "Coupled, explored together: {}.", group.join(", "));
        }
        let alone: Vec<&str> = machine
            .axes
            .iter()
            .map(|a| a.name.as_str())
            .filter(|a| !machine.groups.iter().any(|g| g.iter().any(|m| m == a)))
            .collect();
        if !alone.is_empty() {
            let _ = writeln!(
                out,
                "On its own, explored separately: {}.",
                alone.join(", ")
            );
        }
        for item in &machine.not_explored {
            let _ = writeln!(out, "Not explored: {item}");
        }
        out.push('\n');
    }
    for violation in violations(subject, checked) {
        let _ = writeln!(out, "VIOLATED  {}  {}", violation.id, violation.text);
        let _ = writeln!(out, "  in: {}", violation.task.title);
        if let Some(reason) = violation.refuted {
            let _ = writeln!(out, "  {reason}");
        }
        match violation.trace {
            Some(trace) => {
                let _ = writeln!(out, "  shortest run, {} cycles:", trace.steps.len());
                out.push_str(&diagram(&violation.task.bound, trace, "violated here").text());
                if let Some(second) = violation.second {
                    out.push_str("  against the run that differs only in the inputs named:\n");
                    out.push_str(&diagram(&violation.task.bound, second, "violated here").text());
                }
            }
            None if violation.refuted.is_some() => {}
            None => out.push_str("  (no run could be rebuilt within the limits)\n"),
        }
        out.push('\n');
    }
    properties(&mut out, subject, checked);
    for topic in [Topic::Fault, Topic::Reaction] {
        topics::text(&mut out, subject, checked, topic);
    }
    for (n, (task, done)) in subject.tasks.iter().zip(checked).enumerate() {
        run(&mut out, n + 1, task, done);
    }
    out
}

/// Every property once, with the runs in which it was judged; what differs between runs is told.
fn properties(out: &mut String, subject: &Subject, checked: &[Checked]) {
    // The same id may be stated differently in different systems: those are rows of their own.
    let mut rows: Vec<Row> = Vec::new();
    for (n, (task, done)) in subject.tasks.iter().zip(checked).enumerate() {
        let both = task
            .bound
            .system
            .properties
            .iter()
            .zip(&done.outcome.report.properties);
        for (property, judged) in both {
            let known = rows.iter_mut().find(|r| {
                r.id == property.id && r.text == property.text && r.verdict == judged.verdict
            });
            let row = match known {
                Some(row) => row,
                None => {
                    rows.push(Row {
                        id: &property.id,
                        text: &property.text,
                        verdict: judged.verdict,
                        runs: Vec::new(),
                    });
                    let last = rows.len() - 1;
                    &mut rows[last]
                }
            };
            let bound = (judged.fastest, judged.bound);
            match row.runs.iter_mut().find(|(b, _)| *b == bound) {
                Some((_, runs)) if runs.last() == Some(&(n + 1)) => {} // another copy of an index
                Some((_, runs)) => runs.push(n + 1),
                None => row.runs.push((bound, vec![n + 1])),
            }
        }
    }
    rows.sort_by_key(|r| {
        !matches!(
            r.verdict,
            Verdict::Violated | Verdict::Unreachable | Verdict::Inconclusive
        )
    });
    let width = rows.iter().map(|r| r.id.chars().count()).max().unwrap_or(0);
    let several = subject.tasks.len() > 1;
    for row in &rows {
        let told: Vec<String> = row
            .runs
            .iter()
            .map(|(bound, runs)| {
                let list = runs
                    .iter()
                    .map(usize::to_string)
                    .collect::<Vec<_>>()
                    .join(", ");
                let runs = if several {
                    format!("run {list}")
                } else {
                    String::new()
                };
                let cycles = match bound {
                    (Some(0), Some(0)) => "in the same cycle".to_owned(),
                    (Some(1), Some(1)) => "in 1 cycle".to_owned(),
                    (Some(a), Some(b)) if a == b => format!("in {a} cycles"),
                    (Some(a), Some(b)) => format!("in {a} to {b} cycles"),
                    (Some(a), None) => format!("in {a} cycles or more"),
                    (None, Some(b)) => format!("within {b} cycles"),
                    (None, None) => String::new(),
                };
                format!("{cycles} {runs}").trim().to_owned()
            })
            .filter(|t| !t.is_empty())
            .collect();
        let told = if told.is_empty() {
            String::new()
        } else {
            format!(" [{}]", told.join("; "))
        };
        let head = format!("  {:<12} {:<width$}", verdict_name(row.verdict), row.id);
        wrapped(out, &head, &format!("{}{told}", row.text));
    }
    out.push('\n');
}

/// Copies of one property with one verdict.
struct Row<'a> {
    id: &'a str,
    text: &'a str,
    verdict: Verdict,
    /// The runs (from 1) with the same fastest reaction and the same least bound.
    runs: Vec<(Times, Vec<usize>)>,
}

/// Cycles of the fastest reaction and of the least bound.
type Times = (Option<u64>, Option<u64>);

fn headline(out: &mut String, subject: &Subject, checked: &[Checked], summaries: &[Summary]) {
    let count = |v: Verdict| summaries.iter().filter(|s| s.verdict == v).count();
    let complete = checked.iter().all(|c| c.outcome.report.complete);
    let verdict = match exit_status(summaries, checked) {
        0 if summaries.is_empty() => "EXPLORED, no property is stated",
        0 => "ALL PROPERTIES HOLD",
        1 => "VIOLATED",
        _ => "INCONCLUSIVE: a limit was reached first",
    };
    let states: u128 = checked
        .iter()
        .map(|c| u128::from(c.outcome.report.states))
        .sum();
    let transitions: u128 = checked.iter().map(|c| c.outcome.report.transitions).sum();
    let seconds: f64 = checked.iter().map(|c| c.outcome.report.seconds).sum();
    let _ = writeln!(out, "{}: {verdict}", subject.name);
    if !subject.title.is_empty() {
        let _ = writeln!(out, "{}", subject.title);
    }
    let list: Vec<String> = [
        Verdict::Violated,
        Verdict::Unreachable,
        Verdict::Inconclusive,
        Verdict::Holds,
        Verdict::Reached,
        Verdict::Vacuous,
    ]
    .into_iter()
    .filter(|v| count(*v) > 0)
    .map(|v| format!("{} {}", count(v), verdict_name(v)))
    .collect();
    let _ = writeln!(
        out,
        "{} properties{}, {} states, {} transitions, {}, {seconds:.1} s",
        summaries.len(),
        if list.is_empty() {
            String::new()
        } else {
            format!(" ({})", list.join(", "))
        },
        grouped(states),
        grouped(transitions),
        if complete { "complete" } else { "NOT complete" },
    );
    let findings = checked
        .iter()
        .flat_map(|c| &c.unfired)
        .filter(|(_, u)| *u == Unfired::Unexplained)
        .count();
    if findings > 0 {
        let _ = writeln!(
            out,
            "FINDING: {findings} rules never fire and nothing says why; see below."
        );
    }
    out.push('\n');
}

fn run(out: &mut String, n: usize, task: &Task, done: &Checked) {
    let report = &done.outcome.report;
    let _ = writeln!(out, "Run {n}: {}", task.title);
    let _ = writeln!(out, "  system {}", task.bound.system.name);
    let params: Vec<String> = params(&task.bound)
        .iter()
        .map(|(n, v)| format!("{n} = {v}"))
        .collect();
    if !params.is_empty() {
        wrapped(out, "  with ", &params.join(", "));
    }
    for item in &task.abstractions {
        wrapped(out, "  abstraction: ", item);
    }
    let storage = match report.storage {
        Storage::Bitmap => "exact bitmap",
        Storage::Hash64 | Storage::Hash128 => "exact hash set",
        Storage::Intervals => "intervals of a timer's values",
    };
    let evaluator = match done.outcome.evaluator {
        Evaluator::Generated => "generated step",
        Evaluator::Interpreter => "interpreter",
    };
    if let Some(reduction) = &done.outcome.reduction {
        reduce::text(out, &task.bound, reduction);
    }
    if !reduced(done) {
        let _ = writeln!(
            out,
            "  {} states of {} ({storage}, {evaluator}), {} transitions, depth {}, {} absorbing, {:.2} s",
            grouped(u128::from(report.states)),
            grouped(report.index_space),
            grouped(report.transitions),
            report.depth,
            grouped(u128::from(report.absorbing)),
            report.seconds,
        );
    }
    unfired(out, done);
    for warning in &task.bound.system.warnings {
        wrapped(out, "  warning: ", warning);
    }
    for skipped in &task.analysis.skipped {
        wrapped(
            out,
            "  not analysed: ",
            &format!("guards of {skipped} read too many values"),
        );
    }
    out.push('\n');
}

/// Whether less than the whole system was explored.
fn reduced(done: &Checked) -> bool {
    let reduction = done.outcome.reduction.as_ref();
    reduction.is_some_and(|r| r.whole.is_none())
}

/// Rules that never fired, one line for each reason; the copies of one machine's rule are named once.
fn unfired(out: &mut String, done: &Checked) {
    let mut reasons: Vec<(String, Vec<String>)> = Vec::new();
    for (rule, why) in &done.unfired {
        let why = match why {
            Unfired::Parameters => "excluded by these parameters".to_owned(),
            Unfired::Explained(reason) => reason.clone(),
            Unfired::Unexplained => "FINDING, nothing says why".to_owned(),
            Unfired::Unknown => "not fired before the limit was reached".to_owned(),
        };
        match reasons.iter_mut().find(|(w, _)| *w == why) {
            Some((_, rules)) => rules.push(rule.clone()),
            None => reasons.push((why, vec![rule.clone()])),
        }
    }
    for (why, rules) in reasons {
        wrapped(
            out,
            "  rules not fired: ",
            &format!("{} ({why})", rules.join(", ")),
        );
    }
}

/// Words after a head, in lines of readable length, indented below the first word.
pub(crate) fn wrapped(out: &mut String, head: &str, text: &str) {
    let indent = head.chars().count().min(48);
    let mut line = head.to_owned();
    let mut used = line.chars().count();
    for word in text.split_whitespace() {
        let n = word.chars().count();
        if used + n + 1 > WIDTH && used > indent {
            let _ = writeln!(out, "{}", line.trim_end());
            line = " ".repeat(indent);
            used = indent;
        }
        if !line.ends_with(' ') {
            line.push(' ');
            used += 1;
        }
        line.push_str(word);
        used += n;
    }
    let _ = writeln!(out, "{}", line.trim_end());
}

/// Parameters with their values as a reader wants to see them, without the readings' options.
pub fn params(bound: &Bound) -> Vec<(String, String)> {
    let all = bound.system.params.iter().zip(&bound.values);
    all.filter(|(p, _)| p.reading.is_none())
        .map(|(p, v)| {
            (
                p.var.name.clone(),
                bound.system.show(p.var.ty, i64::from(*v)),
            )
        })
        .collect()
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
                    let counterexample = (j.verdict == Verdict::Violated)
                        .then(|| j.trace.as_ref().map(|t| steps(t, &task.bound)));
                    json!({
                        "id": p.id, "index": p.index, "text": p.text, "requirements": p.req,
                        "verdict": verdict_name(j.verdict), "length": j.length, "bound": j.bound, "fastest": j.fastest,
                        "refuted": done.outcome.refuted.get(&k),
                        "counterexample": counterexample.flatten(),
                    })
                })
                .collect();
            let rules: Vec<Value> = system
                .rules()
                .zip(&report.coverage)
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
                "abstractions": task.abstractions,
                "parameters": params(&task.bound).into_iter().collect::<BTreeMap<_, _>>(),
                "readings": task.bound.readings().into_iter().collect::<BTreeMap<_, _>>(),
                "states": report.states, "transitions": number(report.transitions),
                "depth": report.depth, "seconds": report.seconds, "complete": report.complete,
                "resumable": report.resumable,
                "absorbing": (!reduced(done)).then_some(report.absorbing), "memory": report.memory,
                "bytes_per_state": report.bytes_per_state(),
                "index_space": number(report.index_space),
                "evaluator": match done.outcome.evaluator {
                    Evaluator::Generated => "generated", Evaluator::Interpreter => "interpreter",
                },
                "properties": properties, "rules": rules, "unfired": unfired,
                "reduction": done.outcome.reduction.as_ref().map(|r| reduce::to_json(&task.bound, r)),
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
        "seconds": reports().map(|r| r.seconds).sum::<f64>(),
        "complete": reports().all(|r| r.complete),
        "properties": summaries.iter().map(|s| json!({
            "id": s.id, "verdict": verdict_name(s.verdict), "length": s.length,
        })).collect::<Vec<_>>(),
        "faults": topics::to_json(subject, checked, Topic::Fault),
        "reactions": topics::to_json(subject, checked, Topic::Reaction),
        "runs": runs,
    })
}

/// A count; beyond 64 bits a float, since JSON readers would lose digits anyway.
fn number(n: u128) -> Value {
    u64::try_from(n).map_or(json!(n as f64), |n| json!(n))
}

/// What would help where a limit was reached; nothing if none was.
pub fn further(checked: &[Checked], settings: &Settings) -> String {
    let short: Vec<_> = checked
        .iter()
        .map(|c| &c.outcome.report)
        .filter(|r| !r.complete)
        .collect();
    if short.is_empty() {
        return String::new();
    }
    let covered: u64 = short.iter().map(|r| r.states).sum();
    let mut out = format!(
        "\nA limit ended {} of {} explorations; in them {} states were found, those up to the depth told explored.\n",
        short.len(),
        checked.len(),
        grouped(u128::from(covered))
    );
    let hashed = short.iter().filter(|r| r.storage != Storage::Bitmap);
    let needs = hashed.map(|r| r.index_space.div_ceil(4)).max();
    if let Some(bytes) = needs.filter(|b| settings.memory.is_some() && *b < 1 << 34) {
        out.push_str(&format!(
            "  With --memory {}MiB the states of each system fit a bitmap.\n",
            (bytes / 3 * 4 + (1 << 24)) >> 20
        ));
    }
    match (&settings.keep, short.iter().all(|r| r.resumable)) {
        (Some(keep), true) => out.push_str(&format!(
            "  To continue with other limits: the same command with --resume {}\n",
            keep.folder().display()
        )),
        (Some(_), false) => out.push_str(
            "  The last checkpoint could not be written; an earlier one may be there to resume from.\n",
        ),
        (None, _) => out.push_str(
            "  With --checkpoint DIR the next check can be continued with other limits (--resume DIR).\n",
        ),
    }
    out.push_str(
        "  Smaller domains, or one system or property at a time (--reduce slice), need less.\n",
    );
    out
}
