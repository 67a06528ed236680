//! What the engines found, as text and JSON.

use std::fmt::Write;

use serde_json::{Value, json};
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_engine::verdict_name;
use stillpoint_model::Verdict;

use super::{Engine, Judged, Proof};
use crate::report::diagram;

/// The tasks of a file with what was found about each.
pub struct Told<'a> {
    /// The file.
    pub subject: &'a Subject,
    /// As its tasks.
    pub judged: &'a [Vec<Judged>],
}

impl Engine {
    /// Its name, as `--engine` has it.
    pub fn name(self) -> &'static str {
        match self {
            Engine::Explorer => "explorer",
            Engine::Bmc => "bmc",
            Engine::Induction => "kinduction",
            Engine::Pdr => "pdr",
            Engine::Bdd => "bdd",
        }
    }
}

impl Proof {
    /// In words.
    pub fn text(&self) -> String {
        let counted = |n: usize, what: &str| match n {
            1 => format!("1 {what}"),
            _ => format!("{n} {what}s"),
        };
        match self {
            Proof::Nothing => "excluded in every state, reachable or not".to_owned(),
            Proof::Induction(k, _) => format!("induction over {}", counted(*k, "cycle")),
            Proof::Invariant(invariant) => format!(
                "invariant of {}, checked",
                counted(invariant.clauses.len(), "clause")
            ),
            Proof::Ways(ways) => format!(
                "ways out of {}, invariant of {}",
                counted(ways.steps.len(), "region"),
                counted(ways.invariant.clauses.len(), "clause")
            ),
            Proof::Measured(measure, proof) => {
                let rounds = counted(measure.rounds.unsigned_abs() as usize, "idle round");
                let steps = match measure.numbers.len() {
                    0 => String::new(),
                    n => format!(" or steps back of {}", counted(n, "number")),
                };
                format!("measure of at most {rounds}{steps}, {}", proof.text())
            }
            Proof::States(states) => format!("all {states} states"),
            Proof::Reached { states, cycles } => {
                let states = states.map_or("at least 2^128".to_owned(), |n| n.to_string());
                let cycles = counted(*cycles, "cycle");
                format!("all {states} states, the farthest after {cycles}")
            }
        }
    }
}

impl Told<'_> {
    fn all(&self) -> impl Iterator<Item = (&Task, &Judged)> {
        let tasks = self.subject.tasks.iter().zip(self.judged);
        tasks.flat_map(|(task, list)| list.iter().map(move |judged| (task, judged)))
    }

    /// The report; with `seconds` also what each property took.
    pub fn text(&self, seconds: bool) -> String {
        let mut out = format!("{}\n\n", self.subject.name);
        for (task, judged) in self.all() {
            if judged.verdict == Verdict::Violated {
                violated(&mut out, task, judged);
            }
        }
        for (task, list) in self.subject.tasks.iter().zip(self.judged) {
            let _ = writeln!(out, "{}\n  system {}", task.title, task.bound.system.name);
            for judged in list {
                let _ = writeln!(out, "  {}", line(judged, seconds));
            }
            out.push('\n');
        }
        let count = |engine: Option<Engine>| {
            self.all()
                .filter(|(_, judged)| judged.engine == engine)
                .count()
        };
        let mut parts = Vec::new();
        for engine in [
            Engine::Explorer,
            Engine::Bmc,
            Engine::Induction,
            Engine::Pdr,
            Engine::Bdd,
        ] {
            parts.push((count(Some(engine)), engine.name()));
        }
        parts.push((count(None), "open"));
        let parts: Vec<String> = (parts.into_iter().filter(|(n, _)| *n > 0))
            .map(|(n, what)| format!("{n} {what}"))
            .collect();
        let _ = writeln!(out, "properties by engine: {}", parts.join(", "));
        out
    }
}

fn line(judged: &Judged, seconds: bool) -> String {
    let engine = judged.engine.map_or("-", Engine::name);
    let mut out = format!(
        "{:<12} {:<10} {:<28}",
        verdict_name(judged.verdict),
        engine,
        judged.id
    );
    let mut remarks = Vec::new();
    remarks.extend(judged.proof.as_ref().map(Proof::text));
    if let Some(length) = judged.length {
        let what = match judged.verdict {
            Verdict::Violated => "broken",
            Verdict::Reached => "seen",
            _ => "first put to the test",
        };
        let cycles = if length == 1 { "cycle" } else { "cycles" };
        remarks.push(format!("{what} after {length} {cycles}"));
    }
    remarks.extend(judged.reason.clone());
    if seconds {
        remarks.push(format!("{:.2} s", judged.seconds));
    }
    let _ = write!(out, " {}", remarks.join("; "));
    out.trim_end().to_owned()
}

fn violated(out: &mut String, task: &Task, judged: &Judged) {
    let _ = writeln!(out, "VIOLATED  {}  {}", judged.id, judged.text);
    let _ = writeln!(out, "  in: {}", task.title);
    if let Some(reason) = &judged.reason {
        let _ = writeln!(out, "  {reason}");
    }
    if let Some(trace) = &judged.trace {
        let what = match trace.loop_start {
            Some(_) => "a run without an end",
            None => "a shortest run",
        };
        let _ = writeln!(out, "  {what}, {} cycles:", trace.steps.len());
        out.push_str(&diagram(&task.bound, trace, "violated here").text());
    }
    out.push('\n');
}

/// The same as JSON.
pub fn to_json(told: &Told) -> Value {
    let task = |(task, list): (&Task, &Vec<Judged>)| {
        let properties: Vec<Value> = (list.iter())
            .map(|judged| {
                json!({
                    "id": judged.id,
                    "verdict": verdict_name(judged.verdict),
                    "length": judged.length,
                    "engine": judged.engine.map(Engine::name),
                    "proof": judged.proof.as_ref().map(Proof::text),
                    "reason": judged.reason,
                    "seconds": judged.seconds,
                })
            })
            .collect();
        json!({
            "title": task.title,
            "system": task.bound.system.name,
            "properties": properties,
        })
    };
    let tasks = told.subject.tasks.iter().zip(told.judged);
    json!({
        "name": told.subject.name,
        "runs": tasks.map(task).collect::<Vec<_>>(),
    })
}

/// 1 if a property is broken or a witness does not exist, 3 if something is open, else 0.
pub fn exit_status(told: &Told) -> u8 {
    let any = |verdict: Verdict| told.all().any(|(_, judged)| judged.verdict == verdict);
    if any(Verdict::Violated) || any(Verdict::Unreachable) {
        1
    } else if any(Verdict::Inconclusive) {
        3
    } else {
        0
    }
}
