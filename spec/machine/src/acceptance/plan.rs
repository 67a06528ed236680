//! One entry of the catalogue of tests: read, checked, and filled in for an axis, a door or the machine.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::super::Place;
use super::super::entry::{Premise, Reader};
use super::super::family::{Family, Formula};
use super::super::family_file::Check;
use super::super::ground::{About, DataFile, Ground, PATH, partners, read_names};
use super::super::template::{Template, Words};
use super::{Expect, Measure, Part, Simulated, Test};
use stillpoint_lang::diag::Result;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TestData {
    id: Spanned<String>,
    part: Spanned<String>,
    of: About,
    #[serde(default)]
    each: Vec<i64>,
    when: Spanned<String>,
    #[serde(default, rename = "let")]
    lets: IndexMap<String, Spanned<String>>,
    title: Spanned<String>,
    #[serde(deserialize_with = "stillpoint_lang::catalogue::once")]
    req: Vec<String>,
    requires: Vec<Spanned<String>>,
    steps: Vec<Spanned<String>>,
    expect: Vec<ExpectData>,
    #[serde(default)]
    measure: Vec<MeasureData>,
    #[serde(default)]
    simulate: Vec<SimulateData>,
    hardware: Option<Spanned<String>>,
    #[serde(default)]
    depends: Vec<Spanned<String>>,
}

/// A piece of a scenario.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SimulateData {
    #[serde(default)]
    text: Option<Spanned<String>>,
    /// In place of a text: why the test cannot be simulated with such values.
    unfit: Option<Spanned<String>>,
    when: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ExpectData {
    text: Spanned<String>,
    when: Option<Spanned<String>>,
    #[serde(default)]
    signal: String,
    value: Option<Spanned<String>>,
    after: Option<Spanned<String>>,
    tolerance: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MeasureData {
    text: Spanned<String>,
    unit: Spanned<String>,
    limit: Option<Spanned<String>>,
    when: Option<Spanned<String>>,
}

/// A test of the catalogue, checked.
pub(super) struct Plan {
    pub premise: Premise,
    part: usize,
    req: Vec<String>,
    id: Template,
    title: Template,
    requires: Vec<Template>,
    steps: Vec<Template>,
    expect: Vec<ExpectPlan>,
    measure: Vec<MeasurePlan>,
    simulate: SimulatePlan,
    depends: Vec<Formula>,
}

enum SimulatePlan {
    Scenario {
        pieces: Vec<(Option<Formula>, Template)>,
        unfit: Vec<(Option<Formula>, Template)>,
    },
    Hardware(Template),
}

struct ExpectPlan {
    text: Template,
    when: Option<Formula>,
    signal: String,
    value: Option<Template>,
    after: Option<Formula>,
    tolerance: Option<Formula>,
}

struct MeasurePlan {
    text: Template,
    unit: Template,
    limit: Option<Template>,
    when: Option<Formula>,
}

/// `None` leaves a finding.
pub(super) fn plan(
    check: &mut Check,
    data: TestData,
    family: &Family,
    words: &[(String, Vec<String>)],
    parts: &[Part],
    not_simulated: Option<&Spanned<String>>,
) -> Option<Plan> {
    let Some(part) = parts.iter().position(|p| p.name == *data.part.get_ref()) else {
        let names: Vec<&str> = parts.iter().map(|p| p.name.as_str()).collect();
        let help = format!("parts of this file: {}", names.join(", "));
        let message = format!("there is no part '{}'", data.part.get_ref());
        check
            .findings
            .add(data.part.span(), message, "this part", help);
        return None;
    };
    let none = Vec::new();
    let (premise, known) = Premise::read(
        check, family, data.of, none, data.each, data.when, data.lets,
    )?;
    let names = Words {
        about: data.of,
        known: &known,
        words,
    };
    let mut depends = Vec::new();
    for text in data.depends {
        depends.push(check.formula(text, &known)?);
    }
    let mut reader = Reader {
        check,
        names: &names,
    };
    let mut expect = Vec::new();
    for entry in data.expect {
        expect.push(ExpectPlan {
            text: reader.text(entry.text)?,
            when: reader.formula(entry.when)?,
            signal: entry.signal,
            value: reader.optional(entry.value)?,
            after: reader.formula(entry.after)?,
            tolerance: reader.formula(entry.tolerance)?,
        });
    }
    let mut measure = Vec::new();
    for entry in data.measure {
        measure.push(MeasurePlan {
            text: reader.text(entry.text)?,
            unit: reader.text(entry.unit)?,
            limit: reader.optional(entry.limit)?,
            when: reader.formula(entry.when)?,
        });
    }
    let hardware = match data.simulate.is_empty() {
        true => data.hardware.or_else(|| not_simulated.cloned()),
        false => data.hardware,
    };
    let simulate = reader.simulate(data.id.span(), data.simulate, hardware)?;
    Some(Plan {
        part,
        premise,
        req: data.req,
        id: reader.text(data.id)?,
        title: reader.text(data.title)?,
        requires: reader.texts(data.requires)?,
        steps: reader.texts(data.steps)?,
        simulate,
        expect,
        measure,
        depends,
    })
}

impl Reader<'_> {
    /// A test has a scenario, or a reason why it has none.
    fn simulate(
        &mut self,
        test: Place,
        pieces: Vec<SimulateData>,
        hardware: Option<Spanned<String>>,
    ) -> Option<SimulatePlan> {
        match (pieces.is_empty(), hardware) {
            (true, Some(reason)) => self.text(reason).map(SimulatePlan::Hardware),
            (false, None) => {
                let (mut texts, mut unfit) = (Vec::new(), Vec::new());
                for piece in pieces {
                    let when = self.formula(piece.when)?;
                    match (piece.text, piece.unfit) {
                        (Some(text), None) => texts.push((when, self.text(text)?)),
                        (None, Some(reason)) => unfit.push((when, self.text(reason)?)),
                        _ => {
                            let message = "a piece of a scenario has either a text or a reason why these values do not fit it";
                            let help = "write text = \"...\" or unfit = \"...\"";
                            self.check.findings.add(test, message, "of this test", help);
                            return None;
                        }
                    }
                }
                Some(SimulatePlan::Scenario {
                    pieces: texts,
                    unfit,
                })
            }
            (none, _) => {
                let message = match none {
                    true => "this test can neither be simulated nor is there a reason why not",
                    false => "this test has a scenario and a reason why it has none",
                };
                let help = "give it a scenario ([[test.simulate]]), or the reason why only the real machine shows it (hardware = \"...\")";
                self.check.findings.add(test, message, "this test", help);
                None
            }
        }
    }
}

impl Plan {
    fn formulas(&self) -> impl Iterator<Item = &Formula> {
        let expect = self.expect.iter();
        let expect = expect.flat_map(|e| [&e.when, &e.after, &e.tolerance]);
        let measure = self.measure.iter().map(|m| &m.when);
        let lets = self.premise.lets.iter().map(|(_, f)| f);
        [&self.premise.when]
            .into_iter()
            .chain(lets)
            .chain(&self.depends)
            .chain(expect.chain(measure).flatten())
    }

    /// All texts but the scenario, which serves the test and is no part of it.
    fn templates(&self) -> impl Iterator<Item = &Template> {
        let expect = self.expect.iter();
        let expect = expect.flat_map(|e| [Some(&e.text), e.value.as_ref()]);
        let measure = self.measure.iter();
        let measure = measure.flat_map(|m| [Some(&m.text), Some(&m.unit), m.limit.as_ref()]);
        [&self.id, &self.title]
            .into_iter()
            .chain(&self.requires)
            .chain(&self.steps)
            .chain(expect.chain(measure).flatten())
    }

    /// Every name that the test reads.
    pub fn reads(&self) -> Vec<String> {
        let formulas = self.formulas().flat_map(|f| read_names(&f.expr));
        formulas
            .chain(self.templates().flat_map(Template::reads))
            .collect()
    }

    /// The test for one subject.
    pub fn test(&self, file: &DataFile, ground: &Ground<'_>) -> Result<Test> {
        let texts = |list: &[Template]| {
            let filled = list.iter().map(|text| text.fill(file, ground));
            filled.collect::<Result<Vec<String>>>()
        };
        let number = |formula: &Option<Formula>| ground.optional(file, formula);
        let formula = |given: &Option<Formula>| {
            let text = given.as_ref().map(|f| f.text.get_ref().clone());
            text.unwrap_or_default()
        };
        let holds = |when: &Option<Formula>| number(when).map(|v| v != Some(0));
        let mut expect = Vec::new();
        for entry in &self.expect {
            if holds(&entry.when)? {
                let value = match &entry.value {
                    Some(value) => Some((entry.signal.clone(), value.fill(file, ground)?)),
                    None => None,
                };
                expect.push(Expect {
                    text: entry.text.fill(file, ground)?,
                    signal: value,
                    after: number(&entry.after)?,
                    formula: formula(&entry.after),
                    tolerance: number(&entry.tolerance)?.unwrap_or(0),
                });
            }
        }
        let mut measure = Vec::new();
        for entry in &self.measure {
            if holds(&entry.when)? {
                let limit = match &entry.limit {
                    Some(limit) => limit.fill(file, ground)?,
                    None => String::new(),
                };
                measure.push(Measure {
                    text: entry.text.fill(file, ground)?,
                    unit: entry.unit.fill(file, ground)?,
                    limit,
                });
            }
        }
        Ok(Test {
            id: self.id.fill(file, ground)?,
            part: self.part,
            title: self.title.fill(file, ground)?,
            axis: ground.axis.map(|a| a.name.clone()),
            req: self.req.clone(),
            requires: texts(&self.requires)?,
            steps: texts(&self.steps)?,
            expect,
            measure,
            simulated: match &self.simulate {
                SimulatePlan::Hardware(reason) => Simulated::Not(reason.fill(file, ground)?),
                SimulatePlan::Scenario { pieces, unfit } => {
                    let mut reason = None;
                    for (when, text) in unfit {
                        if reason.is_none() && holds(when)? {
                            reason = Some(text.fill(file, ground)?);
                        }
                    }
                    let mut scenario = String::new();
                    for (when, text) in pieces {
                        if reason.is_none() && holds(when)? {
                            scenario.push_str(&text.fill_lines(file, ground)?);
                        }
                    }
                    reason.map_or(Simulated::Scenario(scenario), Simulated::Not)
                }
            },
            depends: self.dependence(ground),
        })
    }

    /// What the test reads of this subject: parameters, the functions enabled, what a door gives access to.
    fn dependence(&self, ground: &Ground<'_>) -> BTreeMap<String, String> {
        let family = &ground.machine.basis.family;
        let mut found = BTreeMap::new();
        for formula in self.formulas() {
            found.extend(ground.reads(&formula.expr));
        }
        for text in self.templates() {
            found.extend(text.values(ground));
        }
        for name in family.resolved(self.reads()) {
            if let Some(formula) = family.named(&name) {
                found.extend(ground.reads(&formula.expr));
            }
            if let (PATH, Some(axis)) = (name.as_str(), ground.axis) {
                found.insert(name.clone(), partners(axis));
            }
            if name == "monitoring_cycle" {
                found.extend(ground.reads(&family.monitoring_cycle.expr));
            }
            for function in family.functions.iter().filter(|f| f.variable == name) {
                found.extend([ground.enabled(&function.name)]);
            }
        }
        // An array named as a whole.
        for formula in &self.depends {
            found.extend(ground.elements(formula.text.get_ref()));
        }
        if let (true, Some(axes)) = (
            ground.axis.is_none(),
            ground.group.and(ground.title("axes")),
        ) {
            found.insert("axes".to_owned(), axes);
        }
        if let Some(door) = ground.door {
            let axes: Vec<&str> = door.axes.iter().map(|a| a.get_ref().as_str()).collect();
            found.insert("axes".to_owned(), axes.join(", "));
        }
        found
    }
}
