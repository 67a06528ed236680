//! `reaction`: the reaction chains of a machine from the sensor to standstill, each summand with its source and, where an
//! explored property bounds it, with that property; and the way of the axis meanwhile.

mod document;
mod text;
mod travel;

use std::collections::BTreeMap;

use serde_json::{Value, json};
use stillpoint_lang::catalogue::{self, Catalogue};
use stillpoint_lang::diag::Diagnostics;
use stillpoint_machine::Machine;
use stillpoint_machine::reaction::{Basis, Chain, Claim, Reactions, Step};
use stillpoint_machine::units::Dimension;
use stillpoint_model::Verdict;

pub use document::document;
pub use text::text;
pub use travel::{End, Motion, end};

use stillpoint_engine::check::Checked;
use stillpoint_engine::subject::Subject;
use stillpoint_engine::verdict_name;

/// What the exploration says about a summand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Proof {
    /// No property speaks of it.
    None,
    /// The property holds, and its slowest case fits the summand: that many microseconds.
    Proven(i128),
    /// The property does not hold, or its slowest case takes longer: why.
    Refuted(String),
    /// The property says nothing here: why.
    Open(String),
}

/// A chain with what was explored and computed for it.
#[derive(Debug, Clone)]
pub struct Result {
    /// The chain.
    pub chain: Chain,
    /// For each of its summands.
    pub proofs: Vec<Proof>,
    /// Speed and acceleration.
    pub motion: Motion,
    /// What the speed is.
    pub speed_text: String,
    /// For each outcome.
    pub ends: Vec<End>,
}

/// All chains of a machine.
#[derive(Debug, Clone)]
pub struct Judged {
    /// The data.
    pub reactions: Reactions,
    /// One for each chain shown.
    pub results: Vec<Result>,
    /// The place in the manual of each requirement named.
    pub sources: BTreeMap<String, String>,
}

/// Speeds and accelerations named by the user: for one axis, or for all that the unit fits.
#[derive(Debug, Clone, Default)]
pub struct Wishes {
    /// (axis, value) of `--speed`.
    pub speed: Vec<(Option<String>, String)>,
    /// (axis, value) of `--acceleration`.
    pub acceleration: Vec<(Option<String>, String)>,
    /// The only axes to be shown; empty: all.
    pub axes: Vec<String>,
}

/// Why chains cannot be judged.
#[derive(Debug)]
pub enum Error {
    /// A file is wrong.
    Input(Diagnostics),
    /// Anything else: one sentence.
    Other(String),
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Input(diagnostics)
    }
}

/// Checks what the user wishes before anything is explored.
///
/// # Errors
/// An axis that does not exist, a value that is no speed or acceleration of any axis it is meant for.
pub fn check_wishes(machine: &Machine, wishes: &Wishes) -> std::result::Result<(), Error> {
    let names = || machine.axes.iter().map(|a| a.name.as_str());
    let named = wishes.speed.iter().chain(&wishes.acceleration);
    let named = named.filter_map(|(axis, _)| axis.as_ref());
    for axis in named.chain(&wishes.axes) {
        if names().all(|name| name != axis) {
            let all: Vec<&str> = names().collect();
            let all = all.join(", ");
            let message = format!("there is no axis '{axis}'; axes of this machine: {all}");
            return Err(Error::Other(message));
        }
    }
    type Of = fn(stillpoint_machine::reaction::Dimensions) -> Dimension;
    let speed: (&str, &Vec<_>, Of) = ("speed", &wishes.speed, |d| d.speed);
    let acceleration: (&str, &Vec<_>, Of) =
        ("acceleration", &wishes.acceleration, |d| d.acceleration);
    for (option, list, of) in [speed, acceleration] {
        for (axis, text) in list {
            let mut fits = Vec::new();
            let meant = machine.axes.iter();
            for one in meant.filter(|a| axis.as_ref().is_none_or(|name| *name == a.name)) {
                fits.push((of(one.kind.dimensions()), one));
            }
            let good = |(dimension, _): &(Dimension, _)| {
                value(text, *dimension).is_some_and(|value| value >= 0)
            };
            if !fits.iter().any(good) {
                let units = fits
                    .first()
                    .map_or_else(String::new, |(d, _)| d.unit_list());
                let message = format!(
                    "--{option}: '{text}' is no {option} of {}; write a number that is not negative with {units}, or with the unit of the axis that is meant, in front of it the axis: X=...",
                    axis.as_deref()
                        .map_or("any axis".to_owned(), |name| format!("axis {name}")),
                );
                return Err(Error::Other(message));
            }
        }
    }
    Ok(())
}

fn value(text: &str, dimension: Dimension) -> Option<i64> {
    stillpoint_machine::units::parse(text, dimension).ok()
}

/// The last value that is meant for this axis and fits it.
fn wished(list: &[(Option<String>, String)], axis: &str, dimension: Dimension) -> Option<i64> {
    let meant = list.iter().rev();
    let mut meant = meant.filter(|(name, _)| name.as_ref().is_none_or(|name| name == axis));
    meant.find_map(|(_, text)| value(text, dimension))
}

/// Joins the chains with what was explored.
///
/// # Errors
/// The catalogue cannot be read, or the data name a requirement that is not in it, or a property of no explored system.
pub fn judge(
    machine: &Machine,
    reactions: Reactions,
    subject: &Subject,
    checked: &[Checked],
    wishes: &Wishes,
) -> std::result::Result<Judged, Error> {
    let folder = machine.family_folder();
    let catalogue = catalogue::load(folder.parent().unwrap_or(folder))?;
    let mut sources = BTreeMap::new();
    let mut results = Vec::new();
    let shown = |chain: &&Chain| wishes.axes.is_empty() || wishes.axes.contains(&chain.axis);
    for chain in reactions.chains.iter().filter(shown) {
        let mut proofs = Vec::new();
        for (k, step) in chain.steps.iter().enumerate() {
            for id in &step.id {
                sources.insert(id.clone(), source(&catalogue, id)?);
            }
            proofs.push(match &step.property {
                Some(claim) => {
                    let covered = &chain.steps[(k + 1).saturating_sub(claim.spans)..=k];
                    prove(machine, subject, checked, &chain.axis, claim, covered)?
                }
                None => Proof::None,
            });
        }
        let dimensions = chain.kind.dimensions();
        let speed = wished(&wishes.speed, &chain.axis, dimensions.speed);
        let acceleration = wished(&wishes.acceleration, &chain.axis, dimensions.acceleration);
        let motion = Motion {
            speed: speed.unwrap_or(chain.speed),
            acceleration: acceleration.unwrap_or(0),
        };
        let ends = reactions.outcomes.iter();
        let ends = ends.map(|o| end(&chain.steps, o, reactions.accelerates, motion));
        results.push(Result {
            ends: ends.collect(),
            proofs,
            motion,
            speed_text: match speed {
                Some(_) => "as wished".to_owned(),
                None => chain.speed_text.clone(),
            },
            chain: chain.clone(),
        });
    }
    let place = |result: &Result| {
        let axes = machine.axes.iter();
        axes.take_while(|axis| axis.name != result.chain.axis)
            .count()
    };
    results.sort_by_key(place);
    Ok(Judged {
        reactions,
        results,
        sources,
    })
}

fn source(catalogue: &Catalogue, id: &str) -> std::result::Result<String, Error> {
    let named = catalogue::requirement_id(id);
    let found = catalogue.requirements.iter().find(|r| r.id == named);
    let found = found.ok_or_else(|| {
        Error::Other(format!(
            "the reaction chains name the requirement {id}, which is in no catalogue"
        ))
    })?;
    Ok(found.source.clone())
}

/// The name of a system without that of its file.
fn short(system: &str) -> &str {
    system.rsplit_once('/').map_or(system, |(_, name)| name)
}

/// What the explorations say about the summands that a property covers.
fn prove(
    machine: &Machine,
    subject: &Subject,
    checked: &[Checked],
    axis: &str,
    claim: &Claim,
    covered: &[Step],
) -> std::result::Result<Proof, Error> {
    let mut tasks = subject.tasks.iter().zip(checked);
    let Some((task, done)) = tasks.find(|(task, _)| {
        short(&task.bound.system.name) == claim.system && task.axes.iter().any(|a| a == axis)
    }) else {
        let why = format!("{} is not explored for this axis", claim.system);
        return Ok(Proof::Open(why));
    };
    let properties = &task.bound.system.properties;
    let Some(k) = properties.iter().position(|p| p.id == claim.id) else {
        return Err(Error::Other(format!(
            "the reaction chains name the property {}, which the system {} does not have",
            claim.id, claim.system
        )));
    };
    let Some(judged) = done.outcome.report.properties.get(k) else {
        return Ok(Proof::Open("not judged".to_owned()));
    };
    let verdict = judged.verdict;
    match (verdict, judged.bound) {
        (Verdict::Holds, Some(bound)) => {
            let slowest = i128::from(bound) * i128::from(machine.monitoring_cycle);
            let allowed: i128 = covered.iter().filter_map(|s| s.time).map(i128::from).sum();
            let shown = slowest / i128::from(claim.per);
            Ok(if slowest <= allowed * i128::from(claim.per) {
                Proof::Proven(shown)
            } else {
                Proof::Refuted(format!("its slowest case takes {}", time(shown)))
            })
        }
        (Verdict::Violated, _) => {
            let more = done.outcome.refuted.get(&k).map(String::as_str);
            Ok(Proof::Refuted(more.unwrap_or("it is violated").to_owned()))
        }
        _ => Ok(Proof::Open(format!(
            "its verdict is {}",
            verdict_name(verdict)
        ))),
    }
}

impl Judged {
    /// 1 if a property contradicts a summand, 3 if one says nothing because a limit was reached, else 0.
    pub fn exit_status(&self, checked: &[Checked]) -> u8 {
        let refuted = |p: &Proof| matches!(p, Proof::Refuted(_));
        if self.results.iter().any(|r| r.proofs.iter().any(refuted)) {
            1
        } else if checked.iter().any(|c| !c.outcome.report.complete) {
            3
        } else {
            0
        }
    }

    /// How many of a chain's timed summands are proven, and how many there are.
    pub fn proven(result: &Result) -> (usize, usize) {
        let timed = result.chain.steps.iter().zip(&result.proofs);
        let timed: Vec<_> = timed.filter(|(s, _)| s.time.is_some()).collect();
        let proven = timed.iter().filter(|(_, p)| matches!(p, Proof::Proven(_)));
        (proven.count(), timed.len())
    }

    /// The time until the stages before `stage` are over, in microseconds.
    pub fn until(result: &Result, stage: usize) -> i128 {
        let steps = result.chain.steps.iter().filter(|s| s.stage < stage);
        steps.filter_map(|s| s.time).map(i128::from).sum()
    }

    /// Everything as JSON.
    pub fn to_json(&self, machine: &Machine, subject: &Subject, checked: &[Checked]) -> Value {
        let chains: Vec<Value> = self.results.iter().map(|r| self.chain_json(r)).collect();
        let tasks = subject.tasks.iter().zip(checked);
        let explored = tasks.map(|(task, done)| {
            json!({
                "system": task.bound.system.name, "axes": task.axes,
                "states": done.outcome.report.states, "complete": done.outcome.report.complete,
            })
        });
        json!({
            "machine": machine.name, "monitoring_cycle_us": machine.monitoring_cycle,
            "source": self.reactions.source, "notes": self.reactions.notes,
            "chains": chains, "explored": explored.collect::<Vec<_>>(),
        })
    }

    fn chain_json(&self, result: &Result) -> Value {
        let chain = &result.chain;
        let steps = chain.steps.iter().zip(&result.proofs).map(|(step, proof)| {
            let id = step.id.iter();
            let id = id.map(|id| json!({"id": id, "source": self.sources.get(id)}));
            let values = step.values.iter();
            let values = values.map(|(name, value)| json!({"name": name, "value": value}));
            json!({
                "stage": self.reactions.stages.get(step.stage), "text": step.text,
                "formula": step.formula, "values": values.collect::<Vec<_>>(),
                "time_us": step.time, "basis": basis(step.basis, proof),
                "property": step.property.as_ref().map(|c| json!({
                    "id": c.id, "system": c.system, "summands": c.spans,
                    "slowest_us": match proof { Proof::Proven(us) => json!(us), _ => Value::Null },
                    "note": match proof { Proof::Refuted(why) | Proof::Open(why) => json!(why), _ => Value::Null },
                })),
                "requirements": id.collect::<Vec<_>>(),
            })
        });
        let ends = self.reactions.outcomes.iter().zip(&result.ends);
        let dimensions = chain.kind.dimensions();
        let ends = ends.map(|(outcome, end)| {
            json!({
                "title": outcome.title, "time_us": end.time, "over_travel": result.way(end),
                "rest_to_be_measured": end.open,
            })
        });
        json!({
            "name": chain.name, "title": chain.title, "axis": chain.axis,
            "speed": result.speed(), "speed_text": result.speed_text,
            "acceleration": dimensions.acceleration.show(result.motion.acceleration),
            "steps": steps.collect::<Vec<_>>(), "outcomes": ends.collect::<Vec<_>>(),
        })
    }
}

/// Where a time comes from, in a word.
fn basis(basis: Basis, proof: &Proof) -> &'static str {
    match (proof, basis) {
        (Proof::Proven(_), _) => "proven",
        (Proof::Refuted(_), _) => "refuted",
        (_, Basis::Manual) => "manual",
        (_, Basis::Computed) => "computed",
        (_, Basis::Measured) => "measured",
    }
}

/// Microseconds as a reader writes them.
fn time(us: i128) -> String {
    Dimension::Time.show(i64::try_from(us).unwrap_or(i64::MAX))
}

impl Result {
    /// The way to this end; of a speed that nobody stated none is known.
    fn way(&self, end: &End) -> String {
        match self.motion.speed {
            0 => "?".to_owned(),
            _ => {
                let way = i64::try_from(end.way).unwrap_or(i64::MAX);
                self.chain.kind.dimensions().way.show(way)
            }
        }
    }

    /// The speed from which the ways are.
    fn speed(&self) -> String {
        match self.motion.speed {
            0 => "a speed that is not stated".to_owned(),
            speed => self.chain.kind.dimensions().speed.show(speed),
        }
    }
}

/// Microseconds in monitoring cycles, with one decimal, rounded up.
fn cycles(us: i128, cycle: i64) -> String {
    let tenths = (us * 10 + i128::from(cycle) - 1) / i128::from(cycle.max(1));
    match tenths % 10 {
        0 => (tenths / 10).to_string(),
        rest => format!("{}.{rest}", tenths / 10),
    }
}
