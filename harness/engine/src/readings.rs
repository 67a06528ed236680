//! Which properties depend on how an ambiguity of the manual is read.

use std::fmt::Write;
use std::time::Instant;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::Diagnostics;
use stillpoint_lang::ir::{Node, Space};
use stillpoint_model::{Error, Judgement, Options, Progress};

use crate::check::{Checked, Settings};
use crate::outcome::{label, verdict_name};
use crate::reduce;
use crate::subject::{self, Readings, Subject};

/// The effect of one option of a reading.
#[derive(Debug, Clone)]
pub struct Compared {
    /// Reading.
    pub reading: String,
    /// What is ambiguous.
    pub text: String,
    /// The option compared with the chosen one.
    pub option: String,
    /// The option the main report was made with.
    pub against: String,
    /// Properties whose verdict, least bound or fastest reaction differs: (id, main result, result under the option).
    pub changes: Vec<(String, String, String)>,
    /// Tasks explored.
    pub tasks: usize,
    /// Whether every exploration ended.
    pub complete: bool,
}

/// Why the comparison could not be made.
#[derive(Debug)]
pub enum Failed {
    /// The input is wrong.
    Input(Diagnostics),
    /// A system cannot be explored: title and reason.
    Explore(String, Error),
}

/// Explores every task again under each other option of each reading that its system uses.
///
/// # Errors
/// As for checking.
pub fn compare(
    main: &Subject,
    checked: &[Checked],
    settings: &Settings,
    chosen: &Readings,
    progress: &mut dyn FnMut(&str) -> Box<dyn Progress>,
) -> Result<Vec<Compared>, Failed> {
    let start = Instant::now();
    let mut out: Vec<Compared> = Vec::new();
    let mut ids: Vec<(String, String, Vec<String>)> = Vec::new();
    for task in &main.tasks {
        for reading in &task.bound.system.readings {
            if !ids.iter().any(|(id, ..)| *id == reading.id) {
                ids.push((
                    reading.id.clone(),
                    reading.text.clone(),
                    reading.options.clone(),
                ));
            }
        }
    }
    for (id, text, options) in ids {
        let against = chosen
            .get(&id)
            .or(options.first())
            .cloned()
            .unwrap_or_default();
        for option in options.iter().filter(|o| **o != against) {
            let mut readings = chosen.clone();
            readings.insert(id.clone(), option.clone());
            let other = subject::load(&main.path, &readings).map_err(Failed::Input)?;
            let mut compared = Compared {
                reading: id.clone(),
                text: text.clone(),
                option: option.clone(),
                against: against.clone(),
                changes: Vec::new(),
                tasks: 0,
                complete: true,
            };
            for ((task, done), was) in other.tasks.iter().zip(checked).zip(&main.tasks) {
                if !uses(&was.bound, &id) {
                    continue;
                }
                let options = Options {
                    limits: settings.limits(start),
                    interrupt: settings.interrupt.clone(),
                    witnesses: false,
                    ..Options::default()
                };
                let title = format!("{id}={option}: {}", task.title);
                let outcome = reduce::run(
                    &task.bound,
                    &options,
                    settings.interpret,
                    settings.reductions,
                    progress(&title).as_mut(),
                )
                .map_err(|e| Failed::Explore(title, e))?;
                compared.tasks += 1;
                compared.complete &= outcome.report.complete;
                let results = done
                    .outcome
                    .report
                    .properties
                    .iter()
                    .zip(&outcome.report.properties);
                for (property, (a, b)) in task.bound.system.properties.iter().zip(results) {
                    let (a, b) = (shown(a), shown(b));
                    if a != b {
                        compared.changes.push((label(property), a, b));
                    }
                }
            }
            out.push(compared);
        }
    }
    Ok(out)
}

/// The verdict, with the least bound and the fastest reaction where they are known.
fn shown(judged: &Judgement) -> String {
    let mut text = verdict_name(judged.verdict).to_owned();
    for (word, cycles) in [("within", judged.bound), ("fastest", judged.fastest)] {
        if let Some(cycles) = cycles {
            let _ = write!(text, " {word} {cycles}");
        }
    }
    text
}

/// Whether any rule, output, property or initial value of the system reads an option of the reading.
fn uses(bound: &Bound, id: &str) -> bool {
    let system = &bound.system;
    let mut found = false;
    let mut look = |n: &Node| {
        if let Node::Cell(Space::Param, k) = n {
            found |= system.params[*k as usize].reading.as_deref() == Some(id);
        }
    };
    system.nodes(&mut look);
    let initial = system.states.iter().filter_map(|s| s.init.as_ref());
    initial.for_each(|n| n.visit(&mut look));
    found
}
