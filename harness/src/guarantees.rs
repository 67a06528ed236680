//! The guarantees of a machine file as they are answered: each with its verdict, its tightest bound and the values it depends on.

use indexmap::IndexSet;
use stillpoint_engine::check::{Checked, severity};
use stillpoint_engine::subject::{Subject, Task};
use stillpoint_machine::guarantee::Guarantee;
use stillpoint_model::Verdict;

/// A guarantee and what was found about it.
#[derive(Debug)]
pub struct Answer<'a> {
    /// What was asked.
    pub guarantee: &'a Guarantee,
    /// The worst verdict of its runs.
    pub verdict: Verdict,
    /// Each run that decides it.
    pub runs: Vec<Decided<'a>>,
}

/// What one run says about a guarantee, for the axes it stands for.
#[derive(Debug)]
pub struct Decided<'a> {
    /// The run.
    pub task: &'a Task,
    /// Its verdict.
    pub verdict: Verdict,
    /// The longest time that a response takes in any run, in microseconds; none where there is no bound.
    pub bound: Option<u64>,
    /// How far an axis goes in this time at the fastest of its limits: way and speed as texts. An axis that accelerates goes farther.
    pub way: Option<(String, String)>,
    /// What it was computed from.
    pub values: Vec<Value>,
}

/// A parameter or a function of a machine file that a guarantee depends on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Value {
    /// Its name.
    pub name: String,
    /// Its value as users write it.
    pub value: String,
    /// The axes for which it has this value.
    pub axes: Vec<String>,
}

/// The guarantees of a machine, in the order of its file.
pub fn answers<'a>(subject: &'a Subject, checked: &'a [Checked]) -> Vec<Answer<'a>> {
    let guarantees = subject.machine.iter().flat_map(|m| &m.guarantees);
    let answer = |guarantee: &'a Guarantee| {
        let decided = subject.tasks.iter().zip(checked);
        let own = decided.filter(|(task, _)| task.guarantee.as_ref() == Some(&guarantee.name));
        let runs: Vec<Decided> = own
            .map(|(task, done)| decided_by(subject, guarantee, task, done))
            .collect();
        let verdict = runs
            .iter()
            .map(|run| run.verdict)
            .max_by_key(|v| severity(*v));
        Answer {
            guarantee,
            verdict: verdict.unwrap_or(Verdict::Inconclusive),
            runs,
        }
    };
    guarantees.map(answer).collect()
}

fn decided_by<'a>(
    subject: &Subject,
    guarantee: &Guarantee,
    task: &'a Task,
    done: &Checked,
) -> Decided<'a> {
    let report = &done.outcome.report;
    let verdicts = report.properties.iter().map(|p| p.verdict);
    let faulty = (!report.faults.is_empty()).then_some(Verdict::Violated);
    let verdict = verdicts.chain(faulty).max_by_key(|v| severity(*v));
    let cycles = report.properties.iter().filter_map(|p| p.bound).max();
    let cycle = task.bound.system.cycle_us;
    // It begins at any moment between two cycles.
    let bound = cycles.map(|n| task.before + (n + 1) * cycle);
    Decided {
        task,
        verdict: verdict.unwrap_or(Verdict::Inconclusive),
        way: bound.and_then(|bound| way(subject, task, bound)),
        bound,
        values: values(subject, guarantee, task),
    }
}

/// How far an axis of a run goes in a time, in microseconds, at the speed of the run, and what its monitor lets it move.
fn way(subject: &Subject, task: &Task, bound: u64) -> Option<(String, String)> {
    const MINUTE: i128 = 60_000_000;
    let first = task.axes.first()?;
    let mut axes = subject.machine.iter().flat_map(|m| &m.axes);
    let dimensions = axes.find(|a| a.name == *first)?.kind.dimensions();
    let way = i128::from(task.travel) * i128::from(bound);
    let way = way / MINUTE + i128::from(way % MINUTE != 0) + i128::from(task.window);
    let way = i64::try_from(way).ok()?;
    (task.travel > 0).then(|| (dimensions.way.show(way), dimensions.speed.show(task.travel)))
}

/// What the axes of a run depend on, each value once.
fn values(subject: &Subject, guarantee: &Guarantee, task: &Task) -> Vec<Value> {
    let mut list: Vec<Value> = Vec::new();
    for axis in &task.axes {
        let machine = subject.machine.iter();
        for (name, value) in machine.flat_map(|m| m.depends(guarantee, axis)) {
            match list
                .iter_mut()
                .find(|v| (&v.name, &v.value) == (&name, &value))
            {
                Some(known) => known.axes.push(axis.clone()),
                None => list.push(Value {
                    name,
                    value,
                    axes: vec![axis.clone()],
                }),
            }
        }
    }
    // Values of one parameter beside each other, in the order of the first.
    let order: IndexSet<String> = list.iter().map(|v| v.name.clone()).collect();
    list.sort_by_key(|v| order.get_index_of(&v.name));
    list
}

impl Decided<'_> {
    /// The way as a text to follow the time.
    pub fn travelled(&self) -> String {
        let way = self.way.as_ref();
        way.map_or(String::new(), |(way, speed)| format!(", {way} at {speed}"))
    }

    /// The values as texts, `STANDSTILL_TOL = 0.5 mm`; of which axes, where it is not that of all.
    pub fn told(&self) -> impl Iterator<Item = String> {
        self.values.iter().map(|v| {
            let of = match v.axes.len() < self.task.axes.len() {
                true => format!(" ({})", v.axes.join(", ")),
                false => String::new(),
            };
            format!("{} = {}{of}", v.name, v.value)
        })
    }
}

/// The time as its readers write it: `96 ms`, `1.2 s`.
pub fn time(micros: u64) -> String {
    let micros = i64::try_from(micros).unwrap_or(i64::MAX);
    stillpoint_machine::units::Dimension::Time.show(micros)
}

/// What is to be asked of a machine that its file asks nothing of; none for a family without patterns, or where something is asked.
pub fn unasked(subject: &Subject) -> Option<String> {
    let machine = subject.machine.as_ref()?;
    let patterns = machine.patterns();
    (machine.guarantees.is_empty() && !patterns.is_empty()).then(|| {
        let patterns: Vec<String> = patterns.iter().map(|p| format!("\"{p}\"")).collect();
        format!(
            "This file asks nothing of the machine: what follows is true of its family with these values. State what must be true \
             of this machine: [guarantee.NAME] with pattern = {}.",
            patterns.join(" or ")
        )
    })
}
