//! The report as text.

use std::collections::BTreeSet;
use std::fmt::Write;

use stillpoint_engine::check::{Checked, Settings, Summary, Unfired, violations};
use stillpoint_engine::excluded::Decisive;
use stillpoint_engine::lines::{self, Line};
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_engine::{Evaluator, verdict_name};
use stillpoint_lang::cells::together;
use stillpoint_lang::ir::Topic;
use stillpoint_model::{Storage, Verdict};

use super::properties::{Row, rows};
use super::words::wrapped;
use super::{
    cited, coarser, counted, counts, diagram, findings, grouped, params, reduced, reduction,
    result, storage_name, theorems, topics, values, word,
};
use crate::guarantees::{answers, time, unasked};

/// The whole report as text.
///
/// For a machine file the parameters of each system and the rules that did not fire are told if `all` asks for it: that is
/// about the tables, not about the machine.
pub fn text(subject: &Subject, checked: &[Checked], summaries: &[Summary], all: bool) -> String {
    let mut out = String::new();
    headline(&mut out, subject, checked, summaries);
    guaranteed(&mut out, subject, checked);
    if let Some(machine) = &subject.machine {
        for sentence in machine.coverage() {
            let _ = writeln!(out, "{sentence}");
        }
        for item in &machine.not_explored {
            let _ = writeln!(out, "Not explored: {item}");
        }
        out.push('\n');
        let values = values::text(machine, &subject.path.display().to_string());
        if !values.is_empty() {
            let _ = writeln!(out, "{values}");
        }
    }
    for violation in violations(subject, checked) {
        let _ = writeln!(out, "VIOLATED  {}  {}", violation.id, violation.text);
        let _ = writeln!(out, "  in: {}", violation.task.title);
        for fault in &violation.task.faults {
            wrapped(&mut out, "  ", &format!("after this fault: {fault}"));
        }
        if let Some(reason) = violation.refuted {
            let _ = writeln!(out, "  {reason}");
        }
        if !violation.decisive.is_empty() {
            let list: Vec<String> = violation.decisive.iter().map(Decisive::text).collect();
            let what = format!("each of these values decides it: {}", list.join("; "));
            wrapped(&mut out, "  ", &what);
        }
        match violation.trace {
            Some(trace) => {
                let _ = writeln!(
                    out,
                    "  shortest run, {}:",
                    counted(trace.steps.len() as u64, "cycle")
                );
                out.push_str(&diagram(&violation.task.bound, trace, "violated here").text());
                if let Some(property) = violation.property {
                    program(
                        &mut out,
                        &lines::deciding(&violation.task.bound, property, trace),
                    );
                }
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
    missing(&mut out, subject, checked);
    properties(&mut out, subject, checked);
    for topic in [Topic::Fault, Topic::Reaction] {
        topics::text(&mut out, subject, checked, topic);
    }
    for (n, (task, done)) in subject.tasks.iter().zip(checked).enumerate() {
        run(
            &mut out,
            n + 1,
            task,
            done,
            all || subject.machine.is_none(),
        );
    }
    if subject.machine.is_some() && !all {
        out.push_str("With -v also the parameters of each system and the rules that did not fire, with the reason.\n");
    }
    out
}

/// What the machine file asks of its machine, each with its answer.
fn guaranteed(out: &mut String, subject: &Subject, checked: &[Checked]) {
    if let Some(what) = unasked(subject) {
        wrapped(out, "", &what);
        out.push('\n');
    }
    let answers = answers(subject, checked);
    if answers.is_empty() {
        return;
    }
    out.push_str("This machine:\n");
    for answer in &answers {
        let verdict = word(answer.verdict, false);
        let _ = writeln!(out, "  {verdict:<12} {}", answer.guarantee.name);
        let text = format!("{} [{}]", answer.guarantee.text, answer.guarantee.source);
        wrapped(out, &" ".repeat(15), &text);
        // What is decided in parts is told part by part.
        let systems: BTreeSet<&str> = (answer.runs.iter())
            .map(|run| run.task.bound.system.name.as_str())
            .collect();
        let mut before = String::new();
        // Most runs of a guarantee answer the same faults: they are told once.
        let mut told: &[String] = &[];
        for run in &answer.runs {
            let bound = match run.bound {
                Some(bound) => format!("in at most {}{}", time(bound), run.travelled()),
                None => verdict_name(run.verdict).to_owned(),
            };
            let part = match systems.len() {
                1 if answer.runs.iter().all(|run| run.task.faults.is_empty()) => {
                    run.task.axes.join(", ")
                }
                _ => run.task.title.clone(),
            };
            wrapped(out, &" ".repeat(15), &format!("{part}: {bound}"));
            let faults = run.task.faults.as_slice();
            if !faults.is_empty() && faults == told {
                wrapped(out, &" ".repeat(17), "also after these faults");
            } else {
                for fault in faults {
                    let line = format!("also after this fault: {fault}");
                    wrapped(out, &" ".repeat(17), &line);
                }
            }
            told = faults;
            let values = run.told().collect::<Vec<_>>().join("; ");
            if values != before {
                wrapped(out, &" ".repeat(17), &format!("with {values}"));
            }
            before = values;
        }
    }
    out.push('\n');
}

/// Witnesses that must exist and do not, though no value of a machine excludes them.
fn missing(out: &mut String, subject: &Subject, checked: &[Checked]) {
    let rows = rows(subject, checked);
    let missing = |r: &&Row| r.verdict == Verdict::Unreachable && r.excluded.is_empty();
    for row in rows.iter().filter(missing) {
        let _ = writeln!(out, "MISSING  {}  {}", row.id, row.text);
        let why = match subject.machine {
            Some(_) => {
                "no run gets there, neither with the values of this file nor with the family's own: the tables are wrong"
            }
            None => "a run that gets there must exist, and none does",
        };
        let _ = writeln!(out, "  {why}\n");
    }
}

/// Every property once, with the runs in which it was judged; what differs between runs is told.
fn properties(out: &mut String, subject: &Subject, checked: &[Checked]) {
    let rows = rows(subject, checked);
    let width = rows.iter().map(|r| r.id.chars().count()).max().unwrap_or(0);
    for row in &rows {
        let told = row.told(subject.tasks.len() > 1, " ");
        let told = if told.is_empty() {
            String::new()
        } else {
            format!(" [{}]", told.join("; "))
        };
        let verdict = word(row.verdict, !row.excluded.is_empty());
        let head = format!("  {verdict:<12} {:<width$}", row.id);
        let reasons: String = row.excluded.iter().map(|r| format!(" ({r})")).collect();
        wrapped(out, &head, &format!("{}{reasons}{told}", row.text));
    }
    out.push('\n');
}

fn headline(out: &mut String, subject: &Subject, checked: &[Checked], summaries: &[Summary]) {
    let complete = checked.iter().all(|c| c.outcome.report.complete);
    let verdict = result(subject, summaries, checked);
    let states: u128 = checked
        .iter()
        .map(|c| u128::from(c.outcome.report.states))
        .sum();
    let transitions: u128 = checked.iter().map(|c| c.outcome.report.transitions).sum();
    let seconds = super::seconds(checked);
    let _ = writeln!(out, "{}: {verdict}", subject.name);
    if !subject.title.is_empty() {
        let _ = writeln!(out, "{}", subject.title);
    }
    let list = counts(summaries);
    let _ = writeln!(
        out,
        "{}{}{}, {} states, {} transitions, {}, {seconds:.1} s",
        counted(summaries.len() as u64, "property"),
        if list.is_empty() {
            String::new()
        } else {
            format!(" ({list})")
        },
        match cited(subject, checked) {
            0 => String::new(),
            n => format!(", {n} of them theorems of the family"),
        },
        grouped(states),
        grouped(transitions),
        if complete { "complete" } else { "NOT complete" },
    );
    let findings = findings(subject, checked);
    if findings > 0 {
        let rules = counted(findings, "rule");
        let _ = writeln!(
            out,
            "FINDING: {rules} without effect, and nothing says why; see below."
        );
    }
    out.push('\n');
}

fn run(out: &mut String, n: usize, task: &Task, done: &Checked, all: bool) {
    let report = &done.outcome.report;
    let _ = writeln!(out, "Run {n}: {}", task.title);
    let _ = writeln!(out, "  system {}", task.bound.system.name);
    let params: Vec<String> = together(params(&task.bound))
        .iter()
        .map(|(n, v)| format!("{n} = {v}"))
        .collect();
    if !params.is_empty() && all {
        wrapped(out, "  with ", &params.join(", "));
    }
    for item in coarser(task, done) {
        wrapped(out, "  abstraction: ", item);
    }
    let storage = storage_name(report.storage);
    let evaluator = match done.outcome.evaluator {
        Evaluator::Generated => "generated step",
        Evaluator::Interpreter => "interpreter",
    };
    if let Some(reduction) = &done.outcome.reduction {
        reduction::text(out, &task.bound, reduction);
    }
    let cited = theorems(done);
    if !cited.is_empty() {
        wrapped(out, "  ", &cited);
    }
    if done.explored() && !reduced(done) {
        let _ = writeln!(
            out,
            "  {} states of {} ({storage}, {evaluator}), {} transitions, depth {}, {} absorbing, {}",
            grouped(u128::from(report.states)),
            grouped(report.index_space),
            grouped(report.transitions),
            report.depth,
            grouped(u128::from(report.absorbing)),
            match done.again {
                true => "the same as a run before".to_owned(),
                false => format!("{:.2} s", report.seconds),
            },
        );
    }
    if all {
        unfired(out, done);
    }
    // What nothing in the tables reads is their matter.
    for warning in task.bound.system.warnings.iter().filter(|_| all) {
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

/// The lines of a program that decide the last cycle of a run.
fn program(out: &mut String, lines: &[Line]) {
    if !lines.is_empty() {
        let _ = writeln!(out, "  {}:", lines::heading(lines));
    }
    for Line {
        number,
        text,
        value,
        ..
    } in lines
    {
        let _ = writeln!(out, "    line {number:>4}  {value:<6} {text}");
    }
}

/// Rules that never fired, one line for each reason; the copies of one machine's rule are named once.
fn unfired(out: &mut String, done: &Checked) {
    let mut reasons: Vec<(String, Vec<String>)> = Vec::new();
    for (rule, why) in &done.unfired {
        let why = match why {
            Unfired::Parameters => "excluded by these parameters".to_owned(),
            Unfired::Explained(reason) => reason.clone(),
            Unfired::Unexplained => "nothing says why".to_owned(),
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

/// What would help where a limit was reached; nothing if none was.
pub fn further(checked: &[Checked], settings: &Settings) -> String {
    let explored = || checked.iter().filter(|done| !done.product);
    let short: Vec<_> = explored()
        .map(|c| &c.outcome.report)
        .filter(|r| !r.complete)
        .collect();
    if short.is_empty() {
        return String::new();
    }
    let covered: u64 = short.iter().map(|r| r.states).sum();
    let mut out = format!(
        "\n{} ended {} of {} explorations; in them {} states were found, those up to the depth told explored.\n",
        if settings.interrupted() {
            "An interrupt"
        } else {
            "A limit"
        },
        short.len(),
        explored().count(),
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
