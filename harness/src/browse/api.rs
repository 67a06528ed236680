//! Requests and their answers, apart from how they are carried.

use std::sync::{MutexGuard, TryLockError};

use serde::Deserialize;
use serde_json::{Value, json};
use stillpoint_engine::label;
use stillpoint_engine::subject::Task;
use stillpoint_engine::verdict_name;
use stillpoint_lang::bind::Bound;

use super::Walks;
use super::jump::{jump, options};
use super::path::Path;
use super::walk::{Walk, size, walk};
use super::{recording, view};
use crate::recording::ndjson;
use crate::states::{Budget, control_states};

/// A refusal: the HTTP status and the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// 400 for a request that makes no sense, 404 for what there is not, 409 for a link to another specification, 503 while
    /// an exploration runs.
    pub status: u16,
    /// One sentence.
    pub reason: String,
}

fn refuse<T>(status: u16, reason: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal {
        status,
        reason: reason.into(),
    })
}

/// Asks for the state at the end of a walk, or at one of its cycles.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct View {
    system: String,
    hash: String,
    path: String,
    /// The cycle to show; the last one if it is missing.
    at: Option<usize>,
    /// Inputs held in the next cycle: `3=1!5=0` for number 3 at its second and number 5 at its least value.
    #[serde(default)]
    held: String,
}

/// Asks for a run that shows a property.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Run {
    system: String,
    hash: String,
    property: String,
}

/// Asks about a system as a whole.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Whole {
    system: String,
    hash: String,
}

fn parsed<'a, T: Deserialize<'a>>(body: &'a str) -> Result<T, Refusal> {
    serde_json::from_str(body)
        .or_else(|e| refuse(400, format!("the request is not understood: {e}")))
}

/// The answer to a view request.
///
/// # Errors
/// A request that makes no sense for this file.
pub fn view(walks: &Walks, body: &str) -> Result<Value, Refusal> {
    let asked: View = parsed(body)?;
    let bound = system(walks, &asked.system, &asked.hash)?;
    let walk = walked(bound, &asked.path)?;
    let length = walk.cycles.len();
    let at = asked.at.unwrap_or(length);
    if at > length {
        return refuse(
            400,
            format!("cycle {at} is asked for; the walk has {length}"),
        );
    }
    let held = held(bound, &asked.held)?;
    Ok(view::view(bound, &walk, at, &held))
}

/// The timing diagram of a walk as an SVG file.
///
/// # Errors
/// A request that makes no sense for this file.
pub fn svg(walks: &Walks, body: &str) -> Result<String, Refusal> {
    let asked: View = parsed(body)?;
    let bound = system(walks, &asked.system, &asked.hash)?;
    Ok(view::svg(bound, &walked(bound, &asked.path)?))
}

/// A walk as a recording, the text of a file for `diff --trace`.
///
/// # Errors
/// A request that makes no sense for this file; a system without signals of an axis.
pub fn recording(walks: &Walks, body: &str) -> Result<String, Refusal> {
    let asked: View = parsed(body)?;
    let task = task(walks, &asked.system, &asked.hash)?;
    let walk = walked(&task.bound, &asked.path)?;
    let machine = walks.subject().machine.as_ref();
    let recording =
        recording::recording(machine, task, &walk).or_else(|reason| refuse(400, reason))?;
    let mut bytes = Vec::new();
    ndjson::write(&recording, &mut bytes)
        .or_else(|e| refuse(400, format!("the recording cannot be written: {e}")))?;
    String::from_utf8(bytes).or_else(|e| refuse(400, format!("the recording is no text: {e}")))
}

/// The answer to a run request.
///
/// # Errors
/// A request that makes no sense for this file; another exploration is running.
pub fn run(walks: &Walks, body: &str) -> Result<Value, Refusal> {
    let asked: Run = parsed(body)?;
    let bound = system(walks, &asked.system, &asked.hash)?;
    let mut properties = bound.system.properties.iter();
    let Some(property) = properties.position(|p| label(p) == asked.property) else {
        return refuse(404, format!("there is no property `{}`", asked.property));
    };
    let _alone = alone(walks)?;
    let jump = match jump(bound, property, walks.bounds) {
        Ok(jump) => jump,
        Err(e) => return refuse(400, format!("the system cannot be explored: {e}")),
    };
    Ok(json!({
        "property": asked.property, "verdict": verdict_name(jump.verdict), "text": jump.text,
        "path": jump.path.map(|p| p.to_string()), "other": jump.other.map(|p| p.to_string()),
    }))
}

/// The control states of the machines of a system; none of them where a limit is reached first.
///
/// # Errors
/// A request that makes no sense for this file; another exploration is running.
pub fn control(walks: &Walks, body: &str) -> Result<Value, Refusal> {
    let asked: Whole = parsed(body)?;
    let bound = system(walks, &asked.system, &asked.hash)?;
    let _alone = alone(walks)?;
    let everything = Budget {
        generated: u64::MAX,
        interpreted: u64::MAX,
    };
    let drawn = match control_states(bound, everything, &options(walks.bounds)) {
        Ok(drawn) => drawn,
        Err(e) => return refuse(400, format!("the system cannot be explored: {e}")),
    };
    let graphs = drawn.map(|drawn| {
        let graphs = drawn
            .into_iter()
            .map(|(machine, graph)| json!({ "machine": machine, "svg": graph.svg() }));
        graphs.collect::<Vec<_>>()
    });
    Ok(json!({ "graphs": graphs }))
}

/// The right to explore, which one request has at a time.
fn alone(walks: &Walks) -> Result<MutexGuard<'_, ()>, Refusal> {
    match walks.exploring.try_lock() {
        Ok(guard) => Ok(guard),
        Err(TryLockError::Poisoned(guard)) => Ok(guard.into_inner()),
        Err(TryLockError::WouldBlock) => {
            refuse(503, "another exploration is running; try again after it")
        }
    }
}

fn system<'a>(walks: &'a Walks, name: &str, hash: &str) -> Result<&'a Bound, Refusal> {
    task(walks, name, hash).map(|task| &task.bound)
}

fn task<'a>(walks: &'a Walks, name: &str, hash: &str) -> Result<&'a Task, Refusal> {
    let Some((task, _, own)) = walks.systems().find(|(_, known, _)| *known == name) else {
        let known: Vec<&str> = walks.systems().map(|(_, name, _)| name).collect();
        return refuse(
            404,
            format!(
                "there is no system `{name}`; this file has {}",
                known.join(", ")
            ),
        );
    };
    if own != hash {
        return refuse(
            409,
            format!(
                "the link was made for another specification, with the hash {hash}; this one has {own}"
            ),
        );
    }
    Ok(task)
}

fn walked(bound: &Bound, path: &str) -> Result<Walk, Refusal> {
    let path = Path::parse(path).and_then(|path| walk(bound, &path));
    path.or_else(|reason| refuse(400, reason))
}

fn held(bound: &Bound, text: &str) -> Result<Vec<(u32, u32)>, Refusal> {
    let mut out: Vec<(u32, u32)> = Vec::new();
    for one in text.split('!').filter(|one| !one.is_empty()) {
        let pair = one
            .split_once('=')
            .and_then(|(k, v)| Some((k.parse::<u32>().ok()?, v.parse::<u32>().ok()?)));
        let Some((input, value)) = pair else {
            return refuse(
                400,
                "an input to be held is written as its number, `=` and a value",
            );
        };
        match size(bound, input) {
            None => return refuse(400, format!("there is no input number {input} to be held")),
            Some(size) if value >= size => {
                return refuse(
                    400,
                    format!(
                        "value {value} of input number {input}; it has the values 0 to {}",
                        size.saturating_sub(1)
                    ),
                );
            }
            Some(_) if out.iter().any(|(k, _)| *k == input) => {
                return refuse(400, format!("input number {input} is held twice"));
            }
            Some(_) => out.push((input, value)),
        }
    }
    Ok(out)
}
