//! The reaction chains of a machine: from the sensor to standstill, summand by summand.
//!
//! The data stand in `reaction-chain.toml` in the folder of the family: which summands a chain has, their formulas over the
//! parameters, where they come from, and the explored systems whose properties bound them.

use std::num::NonZeroU32;

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::entry::{Premise, Reader};
use super::explore_file::ExploreData;
use super::family::{Family, Formula};
use super::family_file::Check;
use super::ground::{About, DataFile, Ground, Subjects, read_names};
use super::runs;
use super::template::{Template, Words};
use super::units::Dimension;
use super::{AxisKind, Machine, Run};
use stillpoint_lang::diag::Result;

/// The chains of one machine.
#[derive(Debug, Clone)]
pub struct Reactions {
    /// Where the manual speaks of reaction times.
    pub source: String,
    /// What the figures do not contain: one sentence each.
    pub notes: Vec<String>,
    /// The titles of the stages, in order.
    pub stages: Vec<String>,
    /// The stages before this one, from 0, are those in which a drive may still accelerate.
    pub accelerates: usize,
    /// How a reaction can end.
    pub outcomes: Vec<Outcome>,
    /// The chains, in the order of the data, then of the axes.
    pub chains: Vec<Chain>,
    /// The explorations whose properties bound summands.
    pub runs: Vec<Run>,
}

/// How a reaction can end.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// A few words.
    pub title: String,
    /// What the axis does meanwhile.
    pub text: String,
    /// How many stages it passes through, from the first.
    pub stages: usize,
    /// The stage, from 0, in which the axis brakes evenly to standstill; none: it never brakes.
    pub brakes: Option<usize>,
}

/// One chain.
#[derive(Debug, Clone)]
pub struct Chain {
    /// A short name: `SG1`.
    pub name: String,
    /// What violates what.
    pub title: String,
    /// The axis.
    pub axis: String,
    /// Its kind.
    pub kind: AxisKind,
    /// The speed that the over-travel is counted at, in base units, if nobody names another one.
    pub speed: i64,
    /// What that speed is.
    pub speed_text: String,
    /// The summands in order.
    pub steps: Vec<Step>,
}

/// A summand.
#[derive(Debug, Clone)]
pub struct Step {
    /// Its stage, from 0.
    pub stage: usize,
    /// What takes the time.
    pub text: String,
    /// The formula as the data have it.
    pub formula: String,
    /// The parameters in the formula and in the named expressions that it reads: name and value.
    pub values: Vec<(String, String)>,
    /// The greatest time in microseconds; none: it has to be measured.
    pub time: Option<i64>,
    /// A way that belongs to the summand whatever the speed is, in base units.
    pub length: i64,
    /// What the monitors tolerate above the speed so far, in base units.
    pub margin: i64,
    /// Where the time comes from.
    pub basis: Basis,
    /// The requirements that say so.
    pub id: Vec<String>,
    /// The property whose bound shows it.
    pub property: Option<Claim>,
}

/// What an explored property shows about a summand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// The property.
    pub id: String,
    /// The system it belongs to.
    pub system: String,
    /// How many cycles of the system one monitoring cycle is.
    pub per: i64,
    /// How many summands its bound covers, this one and those before it.
    pub spans: usize,
}

/// Where a time comes from, beside exploration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// The manual states it.
    Manual,
    /// It follows from parameters of the machine.
    Computed,
    /// It depends on the mechanics and has to be measured.
    Measured,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileData {
    source: String,
    notes: Vec<String>,
    stages: Vec<String>,
    accelerates: usize,
    outcome: Vec<Outcome>,
    #[serde(default)]
    words: IndexMap<String, Vec<String>>,
    explore: Vec<ExploreData>,
    group: IndexMap<String, Vec<StepData>>,
    chain: Vec<ChainData>,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
struct StepData {
    stage: Spanned<usize>,
    text: Spanned<String>,
    when: Option<Spanned<String>>,
    time: Option<Spanned<String>>,
    length: Option<Spanned<String>>,
    margin: Option<Spanned<String>>,
    basis: Basis,
    #[serde(deserialize_with = "stillpoint_lang::catalogue::once")]
    id: Vec<String>,
    property: Option<PropertyData>,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
struct PropertyData {
    id: String,
    system: String,
    #[serde(default = "one")]
    per: NonZeroU32,
    #[serde(default = "one")]
    spans: NonZeroU32,
}

fn one() -> NonZeroU32 {
    NonZeroU32::MIN
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ChainData {
    name: Spanned<String>,
    title: Spanned<String>,
    of: About,
    #[serde(default)]
    each: Vec<i64>,
    when: Spanned<String>,
    #[serde(default, rename = "let")]
    lets: IndexMap<String, Spanned<String>>,
    speed: Spanned<String>,
    speed_text: Spanned<String>,
    groups: Vec<Spanned<String>>,
}

/// A chain of the data, checked.
struct Plan {
    premise: Premise,
    name: Template,
    title: Template,
    speed: Formula,
    speed_text: Template,
    steps: Vec<StepPlan>,
}

struct StepPlan {
    stage: usize,
    text: Template,
    when: Option<Formula>,
    time: Option<Formula>,
    length: Option<Formula>,
    margin: Option<Formula>,
    basis: Basis,
    id: Vec<String>,
    property: Option<PropertyData>,
}

impl Machine {
    /// The reaction chains of this machine.
    ///
    /// # Errors
    /// The family has no `reaction-chain.toml`, or the file is wrong.
    pub fn reactions(&self) -> Result<Reactions> {
        let family = &self.basis.family;
        let file = DataFile::read(&family.folder, "reaction-chain.toml", "reaction chains")?;
        let data: FileData = file.parse()?;
        let mut check = file.check();
        let explore = check.explores(data.explore, &family.known);
        let words: Vec<_> = data.words.into_iter().collect();
        let mut plans = Vec::new();
        for chain in data.chain {
            let stages = data.stages.len();
            plans.extend(plan(&mut check, chain, family, &words, &data.group, stages));
        }
        check.findings.finish(())?;
        let mut chains = Vec::new();
        let mut subjects = Subjects::of(self);
        for plan in &plans {
            for ground in plan.premise.grounds(&file, &mut subjects)? {
                chains.push(plan.chain(&file, &ground)?);
            }
        }
        let (judged, logic) = (&self.basis.judged, &self.basis.logic);
        let runs = runs::plan(family, &explore, self.parts(), judged, logic)?.runs;
        Ok(Reactions {
            source: data.source,
            notes: data.notes,
            stages: data.stages,
            accelerates: data.accelerates,
            outcomes: data.outcome,
            chains,
            runs,
        })
    }
}

/// `None` leaves a finding.
fn plan(
    check: &mut Check,
    data: ChainData,
    family: &Family,
    words: &[(String, Vec<String>)],
    groups: &IndexMap<String, Vec<StepData>>,
    stages: usize,
) -> Option<Plan> {
    let none = Vec::new();
    let (premise, known) = Premise::read(
        check, family, data.of, none, data.each, data.when, data.lets,
    )?;
    let names = Words {
        about: data.of,
        known: &known,
        words,
    };
    let mut reader = Reader {
        check,
        names: &names,
    };
    let mut steps = Vec::new();
    for name in data.groups {
        let Some(list) = groups.get(name.get_ref()) else {
            let message = format!("there is no group '{}'", name.get_ref());
            let known: Vec<&str> = groups.keys().map(String::as_str).collect();
            let help = format!("groups of this file: {}", known.join(", "));
            let findings = &mut reader.check.findings;
            findings.add(name.span(), message, "this group", help);
            return None;
        };
        for step in list {
            steps.push(step_plan(&mut reader, step.clone(), stages)?);
        }
    }
    Some(Plan {
        name: reader.text(data.name)?,
        title: reader.text(data.title)?,
        speed_text: reader.text(data.speed_text)?,
        speed: reader.check.formula(data.speed, &known)?,
        premise,
        steps,
    })
}

fn step_plan(reader: &mut Reader<'_>, data: StepData, stages: usize) -> Option<StepPlan> {
    let findings = &mut reader.check.findings;
    if *data.stage.get_ref() >= stages {
        let help = format!("stages are numbered from 0 to {}", stages.saturating_sub(1));
        let message = format!("there is no stage {}", data.stage.get_ref());
        findings.add(data.stage.span(), message, "this stage", help);
    }
    if data.time.is_none() != (data.basis == Basis::Measured) {
        let help = "what is measured has no formula, everything else needs one: time = \"...\"";
        let message = "a summand has either a time or the basis \"measured\"";
        findings.add(data.text.span(), message, "this summand", help);
    }
    Some(StepPlan {
        stage: data.stage.into_inner(),
        when: reader.formula(data.when)?,
        time: reader.formula(data.time)?,
        length: reader.formula(data.length)?,
        margin: reader.formula(data.margin)?,
        text: reader.text(data.text)?,
        basis: data.basis,
        id: data.id,
        property: data.property,
    })
}

impl Plan {
    /// The chain for one subject.
    fn chain(&self, file: &DataFile, ground: &Ground<'_>) -> Result<Chain> {
        let mut steps = Vec::new();
        for step in &self.steps {
            steps.extend(step.step(file, ground)?);
        }
        Ok(Chain {
            name: self.name.fill(file, ground)?,
            title: self.title.fill(file, ground)?,
            axis: ground.title("axis").unwrap_or_default(),
            kind: ground.kind(),
            speed: ground.value(file, &self.speed)?,
            speed_text: self.speed_text.fill(file, ground)?,
            steps,
        })
    }
}

impl StepPlan {
    fn step(&self, file: &DataFile, ground: &Ground<'_>) -> Result<Option<Step>> {
        let value = |formula: &Option<Formula>| ground.optional(file, formula);
        if value(&self.when)? == Some(0) {
            return Ok(None);
        }
        let claim = |data: &PropertyData| Claim {
            id: data.id.clone(),
            system: data.system.clone(),
            per: i64::from(data.per.get()),
            spans: data.spans.get() as usize,
        };
        let mut values: Vec<(String, String)> = Vec::new();
        let formulas = [&self.time, &self.length, &self.margin];
        for formula in formulas.into_iter().flatten() {
            let named = read_names(&formula.expr);
            let family = &ground.machine.basis.family;
            let named = named.iter().filter_map(|name| family.named(name));
            for formula in [formula].into_iter().chain(named) {
                let read = ground.reads(&formula.expr).into_iter();
                values.extend(
                    read.filter(|(name, _)| values.iter().all(|(n, _)| n != name))
                        .collect::<Vec<_>>(),
                );
            }
        }
        let time = value(&self.time)?;
        let formula = self.time.as_ref().map(|f| f.text.get_ref().clone());
        Ok(Some(Step {
            stage: self.stage,
            text: self.text.fill(file, ground)?,
            formula: formula.unwrap_or_default(),
            values,
            time,
            length: value(&self.length)?.unwrap_or(0),
            margin: value(&self.margin)?.unwrap_or(0),
            basis: self.basis,
            id: self.id.clone(),
            property: self.property.as_ref().map(claim),
        }))
    }
}

/// What the figures of a chain are written in: the dimensions of way, speed and acceleration of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dimensions {
    /// Of a way.
    pub way: Dimension,
    /// Of a speed; a base unit is one of the way in a minute.
    pub speed: Dimension,
    /// Of an acceleration; a base unit is one of the way in a second squared.
    pub acceleration: Dimension,
}

impl AxisKind {
    /// The dimensions of an axis of this kind.
    pub fn dimensions(self) -> Dimensions {
        match self {
            Self::Linear => Dimensions {
                way: Dimension::Length,
                speed: Dimension::Speed,
                acceleration: Dimension::Acceleration,
            },
            Self::Rotary => Dimensions {
                way: Dimension::Angle,
                speed: Dimension::Rotation,
                acceleration: Dimension::AngularAcceleration,
            },
        }
    }
}
