//! The acceptance test of a machine: one test for each enabled function and limit.
//!
//! The catalogue of tests stands in `acceptance.toml` in the folder of the family: texts with places for the parameters,
//! and conditions on what is enabled.

mod plan;

use std::collections::BTreeMap;

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::Machine;
use super::family::Family;
use super::family_file::Check;
use super::ground::{DataFile, Subjects};
use plan::{Plan, TestData, plan};
use stillpoint_lang::diag::Result;

/// The protocol of one machine.
#[derive(Debug, Clone)]
pub struct Protocol {
    /// Where the manual describes the acceptance test.
    pub source: String,
    /// What holds for all tests: one sentence each.
    pub before: Vec<String>,
    /// What is written down about the machine: to be filled in by hand.
    pub records: Vec<String>,
    /// What is written down about each axis: to be filled in by hand.
    pub axis_records: Vec<String>,
    /// The parts, in order.
    pub parts: Vec<Part>,
    /// What is done after the tests: one sentence each.
    pub after: Vec<String>,
    /// Who signs.
    pub signatures: Vec<String>,
    /// What has to be repeated after which measure: heads, then rows.
    pub measures: Vec<Vec<String>>,
    /// The tests, in the order of the catalogue.
    pub tests: Vec<Test>,
    /// Parameters that no test depends on, with the reason.
    pub untested: BTreeMap<String, String>,
}

/// A part of the protocol.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The name that tests call it by.
    pub name: String,
    /// The heading.
    pub title: String,
    /// A sentence about it; may be empty.
    #[serde(default)]
    pub text: String,
}

/// One test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Test {
    /// Unique in the protocol: `SG1-X`.
    pub id: String,
    /// Index of its part.
    pub part: usize,
    /// What is tested.
    pub title: String,
    /// The axis, if it is about one.
    pub axis: Option<String>,
    /// Requirements of the manual.
    pub req: Vec<String>,
    /// What must be so before.
    pub requires: Vec<String>,
    /// What is done.
    pub steps: Vec<String>,
    /// What must be seen.
    pub expect: Vec<Expect>,
    /// What is measured.
    pub measure: Vec<Measure>,
    /// Whether it can be run on a simulated axis.
    pub simulated: Simulated,
    /// What the test depends on: parameter and value.
    pub depends: BTreeMap<String, String>,
}

/// How a test is run on a simulated axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Simulated {
    /// By this scenario, the text of a scenario file.
    Scenario(String),
    /// Not: only the real machine shows it. One sentence says why.
    Not(String),
}

/// Something that must be seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Expect {
    /// In words.
    pub text: String,
    /// The signal and the value it takes; empty for what is no signal.
    pub signal: Option<(String, String)>,
    /// Microseconds after the event that the test provokes; none: whenever it comes.
    pub after: Option<i64>,
    /// The formula of `after`; empty without.
    pub formula: String,
    /// Monitoring cycles that it may come later than `after`.
    pub tolerance: i64,
}

/// A value to be measured.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Measure {
    /// What.
    pub text: String,
    /// Its unit.
    pub unit: String,
    /// What it may be; empty: the machine builder decides.
    pub limit: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileData {
    source: String,
    before: Vec<String>,
    records: Vec<String>,
    axis_records: Vec<String>,
    after: Vec<String>,
    signatures: Vec<String>,
    measures: Vec<Vec<String>>,
    #[serde(default)]
    words: IndexMap<String, Vec<String>>,
    untested: IndexMap<Spanned<String>, String>,
    /// Why a test that says nothing about it is not simulated; none: each test has to say.
    not_simulated: Option<Spanned<String>>,
    part: Vec<Part>,
    test: Vec<TestData>,
}

impl Machine {
    /// The acceptance test of this machine.
    ///
    /// # Errors
    /// The family has no `acceptance.toml`, or the file is wrong: a parameter that no test depends on and that has no reason
    /// under `untested` is wrong too.
    pub fn acceptance(&self) -> Result<Protocol> {
        let family = &self.basis.family;
        let file = DataFile::read(&family.folder, "acceptance.toml", "acceptance tests")?;
        let data: FileData = file.parse()?;
        let mut check = file.check();
        let words: Vec<_> = data.words.into_iter().collect();
        let mut plans = Vec::new();
        for test in data.test {
            let not = data.not_simulated.as_ref();
            plans.extend(plan(&mut check, test, family, &words, &data.part, not));
        }
        complete(&mut check, family, &plans, &data.untested);
        check.findings.finish(())?;
        let mut tests = Vec::new();
        let mut subjects = Subjects::of(self);
        for plan in &plans {
            for ground in plan.premise.grounds(&file, &mut subjects)? {
                tests.push(plan.test(&file, &ground)?);
            }
        }
        let mut check = file.check();
        unique(&mut check, &tests);
        check.findings.finish(())?;
        let untested = data.untested.into_iter();
        Ok(Protocol {
            source: data.source,
            before: data.before,
            records: data.records,
            axis_records: data.axis_records,
            parts: data.part,
            after: data.after,
            signatures: data.signatures,
            measures: data.measures,
            tests,
            untested: untested.map(|(k, v)| (k.into_inner(), v)).collect(),
        })
    }
}

/// A test is named in results and in what has to be repeated: no name stands for two.
fn unique(check: &mut Check, tests: &[Test]) {
    for (place, test) in tests.iter().enumerate() {
        if tests[..place].iter().any(|other| other.id == test.id) {
            check.findings.add(
                None,
                format!(
                    "two acceptance tests of this machine are called {}",
                    test.id
                ),
                "",
                "call one of them otherwise, or let their `when` exclude each other",
            );
        }
    }
}

/// Every parameter of the family is read by a test, or there is a reason why not.
fn complete(
    check: &mut Check,
    family: &Family,
    plans: &[Plan],
    untested: &IndexMap<Spanned<String>, String>,
) {
    let read = family.resolved(plans.iter().flat_map(Plan::reads).collect());
    let all = [&family.control, &family.axis, &family.door];
    let all = all.into_iter().chain(&family.group);
    let all: Vec<&String> = all.flat_map(IndexMap::keys).collect();
    for name in &all {
        let excused = untested.keys().any(|key| key.get_ref() == *name);
        if !excused && !read.contains(*name) {
            check.findings.add(
                None,
                format!("no acceptance test depends on {name}"),
                "",
                "name it in a test, in `depends` at least, or give the reason why none is needed under [untested]",
            );
        }
    }
    for key in untested.keys() {
        if !all.contains(&key.get_ref()) || read.contains(key.get_ref()) {
            check.findings.add(
                key.span(),
                format!("'{}' is no parameter without a test", key.get_ref()),
                "this entry",
                "remove it, or correct the name",
            );
        }
    }
}
