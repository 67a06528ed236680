//! The requirement traceability matrix, what the command `trace` prints: for every requirement of the catalogues the evidence for
//! it, typed and at the level of a rule, an item, a clause or a test function.
//!
//! Evidence is one of four things. **Specification**: a rule, property, named expression or declaration of a table, an
//! item of the family's data, a documented item of the languages of safe programs (`spec/logic/src`), or a line of a program that a
//! manual prints, by its comment. **Monitor**: a documented function, type, field, variant or constant of `impl`, or a clause of the
//! contract of its `next`. **Proof**: a clause whose harness stands in the inventory, or a run of the inventory. **Test**: a
//! `#[test]` function whose own documentation names the requirement, a must-fail file by the property that it violates, a refused
//! machine file by the rule that refuses it, a case of the corpus, or an acceptance test that is run on the simulated axis.
//!
//! A requirement is **covered** when it has specification, monitor, and a proof or a test. For one that is not about the
//! behaviour of a monitor the monitor is not asked for: those of scope `support`, and of kind architecture, commissioning,
//! constraint, diagnostic or parameter; for one whose only specification is an item of the languages, which refuse or understand
//! a program before any monitor runs, neither, nor for what a printed program specifies and a test tries; and acceptance tests that are run and reaction chains count as its specification. A
//! requirement whose text states several behaviours has sentences (`sentences.toml`); evidence then names a sentence,
//! `ID/a`, evidence that names the id alone counts for nothing, and each sentence is judged on its own.
//!
//! It is **delegated** when no code can hold it and `exceptions.toml` names the acceptance test that asks for it at the
//! machine; **excepted** when a reason says why not: its scope is hardware, its content is carried by another requirement, or the
//! family's `exceptions.toml` gives one. All others are **open**. A covered requirement is never excepted, whatever the file
//! says. A requirement with sentences has the worst of their statuses.
//!
//! A family may be declared complete in its `status.toml` (`family_complete = true`); then an open requirement of scope
//! `core` is an error of the project, and so is, in any family, an id that no catalogue has.

mod families;
mod ids;
mod read;
mod report;
mod rust;

use std::collections::{BTreeMap, BTreeSet};

pub use read::{ReadError, find_root, read};
pub use report::{html, text, to_json};
use stillpoint_lang::catalogue::{Catalogue, Kind, Requirement, Scope, requirement_id};

/// What a piece of evidence is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum EvidenceKind {
    /// A rule of a machine of the tables.
    Rule,
    /// A property of a system.
    Property,
    /// A named expression, output, or declared state, input or parameter.
    Definition,
    /// An item of a family's data.
    Data,
    /// A documented item of the languages of safe programs.
    Language,
    /// A line of a program that the manual prints.
    Program,
    /// A summand of a reaction time.
    Chain,
    /// A documented item of the monitors.
    Item,
    /// A clause of a contract.
    Clause,
    /// A run of the inventory of proofs.
    Run,
    /// A `#[test]` function.
    Test,
    /// A specification that must fail.
    MustFail,
    /// A machine file that must be refused.
    Refused,
    /// A worked example of the manual.
    Corpus,
    /// An acceptance test that is run on the simulated axis.
    Acceptance,
}

impl EvidenceKind {
    /// The word before the place.
    pub fn name(self) -> &'static str {
        match self {
            EvidenceKind::Rule => "rule",
            EvidenceKind::Property => "property",
            EvidenceKind::Definition => "definition",
            EvidenceKind::Data => "data",
            EvidenceKind::Language => "language",
            EvidenceKind::Program => "program",
            EvidenceKind::Chain => "chain",
            EvidenceKind::Item => "item",
            EvidenceKind::Clause => "clause",
            EvidenceKind::Run => "run",
            EvidenceKind::Test => "test",
            EvidenceKind::MustFail => "must-fail",
            EvidenceKind::Refused => "refused",
            EvidenceKind::Corpus => "corpus",
            EvidenceKind::Acceptance => "acceptance",
        }
    }
}

/// A place that deals with a requirement.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Evidence {
    /// What it is.
    pub kind: EvidenceKind,
    /// Where it is.
    pub place: String,
}

impl std::fmt::Display for Evidence {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.kind.name(), self.place)
    }
}

/// For each requirement id, or sentence of one, the evidence that names it.
pub type Named = BTreeMap<String, BTreeSet<Evidence>>;

/// Why a requirement, or a sentence of one, needs no evidence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exception {
    /// The family whose file says it.
    pub family: String,
    /// The requirement or the sentence.
    pub id: String,
    /// Why.
    pub reason: String,
    /// The acceptance test that it is delegated to.
    pub test: Option<String>,
}

/// What the matrix is made of.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// All requirements.
    pub catalogue: Catalogue,
    /// The sentences of requirements that have several: name and text.
    pub sentences: BTreeMap<String, BTreeMap<String, String>>,
    /// Rules, named expressions, properties and family data.
    pub rules: Named,
    /// Documented items of the languages of safe programs.
    pub languages: Named,
    /// Lines of programs that manuals print.
    pub programs: Named,
    /// Data that no monitor follows: acceptance tests that are run, and reaction chains.
    pub data: Named,
    /// Documented items of the monitors, and clauses.
    pub monitors: Named,
    /// Clauses with a harness, and runs.
    pub proofs: Named,
    /// Tests.
    pub tests: Named,
    /// Exceptions and delegations of the families' files.
    pub exceptions: Vec<Exception>,
    /// The acceptance tests of a family, by their ids, with the requirements that each names.
    pub acceptance: BTreeMap<(String, String), BTreeSet<String>>,
    /// Families declared complete.
    pub complete: BTreeSet<String>,
}

/// What is known of a requirement. The order is that of what is missing: a requirement has the greatest of its sentences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Specified, implemented and shown.
    Covered,
    /// No code can hold it: a named acceptance test asks for it at the machine.
    Delegated,
    /// Not, for a reason.
    Excepted,
    /// Not yet.
    Open,
}

impl Status {
    /// The name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Status::Covered => "covered",
            Status::Delegated => "delegated",
            Status::Excepted => "excepted",
            Status::Open => "open",
        }
    }
}

/// The evidence for a requirement or a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// What is known.
    pub status: Status,
    /// Rules, named expressions, properties, family data.
    pub rules: Vec<String>,
    /// Monitors.
    pub monitors: Vec<String>,
    /// Proofs.
    pub proofs: Vec<String>,
    /// Tests.
    pub tests: Vec<String>,
    /// Why it is excepted, or what it is delegated to and why.
    pub reason: Option<String>,
}

/// A sentence of a requirement with its evidence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sentence {
    /// Its name: `a`.
    pub name: String,
    /// What it states.
    pub text: String,
    /// Its evidence.
    pub shown: Shown,
}

/// A requirement with its evidence.
#[derive(Debug, Clone)]
pub struct Row {
    /// The requirement.
    pub requirement: Requirement,
    /// The evidence of all its sentences, or of itself.
    pub shown: Shown,
    /// Its sentences, if it has several.
    pub sentences: Vec<Sentence>,
    /// Evidence that names the id of a requirement with sentences, and none of them.
    pub vague: Vec<String>,
}

impl Row {
    /// What is known of it.
    pub fn status(&self) -> Status {
        self.shown.status
    }
}

/// The matrix and what is wrong with it.
#[derive(Debug, Clone)]
pub struct Matrix {
    /// One row for each requirement, in the order of the catalogues.
    pub rows: Vec<Row>,
    /// Ids that no catalogue has: (id, the place that names it).
    pub unknown: Vec<(String, String)>,
    /// Delegations to a test that does not exist or does not name the requirement.
    pub nowhere: Vec<String>,
    /// Families declared complete.
    pub complete: BTreeSet<String>,
}

impl Matrix {
    /// Puts the matrix together.
    pub fn new(sources: &Sources) -> Self {
        let exceptions: BTreeMap<&str, &Exception> = sources
            .exceptions
            .iter()
            .map(|e| (e.id.as_str(), e))
            .collect();
        let rows: Vec<Row> = sources
            .catalogue
            .requirements
            .iter()
            .map(|r| row(sources, &exceptions, r))
            .collect();
        Self {
            unknown: unknown(sources, &rows),
            nowhere: nowhere(sources),
            rows,
            complete: sources.complete.clone(),
        }
    }

    /// The open requirements of scope core.
    pub fn open_core(&self) -> impl Iterator<Item = &Row> {
        self.rows
            .iter()
            .filter(|r| r.status() == Status::Open && r.requirement.scope == Scope::Core)
    }

    /// Exit status: 1 if an id is unknown, a delegation leads nowhere or a family declared complete has an open core
    /// requirement, else 0.
    pub fn exit_status(&self) -> u8 {
        let unfinished = self
            .open_core()
            .any(|r| self.complete.contains(&r.requirement.family));
        u8::from(unfinished || !self.unknown.is_empty() || !self.nowhere.is_empty())
    }
}

/// Everything named that is neither a requirement nor a sentence of one.
fn unknown(sources: &Sources, rows: &[Row]) -> Vec<(String, String)> {
    let known: BTreeSet<String> = rows
        .iter()
        .flat_map(|row| {
            let id = &row.requirement.id;
            let sentences = row
                .sentences
                .iter()
                .map(move |s| format!("{id}/{}", s.name));
            std::iter::once(id.clone()).chain(sentences)
        })
        .collect();
    let excepted = sources
        .exceptions
        .iter()
        .map(|e| (e.id.clone(), format!("{}/exceptions.toml", e.family)));
    let divided = sources
        .sentences
        .keys()
        .map(|id| (id.clone(), "a sentences.toml".to_owned()));
    [
        &sources.rules,
        &sources.languages,
        &sources.data,
        &sources.programs,
        &sources.monitors,
        &sources.proofs,
        &sources.tests,
    ]
    .into_iter()
    .flatten()
    .flat_map(|(id, places)| places.iter().map(move |p| (id.clone(), p.to_string())))
    .chain(excepted)
    .chain(divided)
    .filter(|(id, _)| !known.contains(id))
    .collect()
}

/// The delegations that no acceptance test takes up.
fn nowhere(sources: &Sources) -> Vec<String> {
    let mut out = Vec::new();
    for exception in &sources.exceptions {
        let (family, id) = (&exception.family, &exception.id);
        let Some(test) = &exception.test else {
            continue;
        };
        match sources.acceptance.get(&(family.clone(), test.clone())) {
            None => out.push(format!(
                "{id} is delegated to {test}, no acceptance test of {family}"
            )),
            Some(named) if !named.contains(id) && !named.contains(requirement_id(id)) => out.push(
                format!("{id} is delegated to {test}, whose `req` does not name it"),
            ),
            Some(_) => {}
        }
    }
    out
}

fn row(
    sources: &Sources,
    exceptions: &BTreeMap<&str, &Exception>,
    requirement: &Requirement,
) -> Row {
    let id = &requirement.id;
    let Some(sentences) = sources.sentences.get(id) else {
        return Row {
            requirement: requirement.clone(),
            shown: shown(sources, exceptions, requirement, id),
            sentences: Vec::new(),
            vague: Vec::new(),
        };
    };
    let sentences: Vec<Sentence> = sentences
        .iter()
        .map(|(name, text)| Sentence {
            name: name.clone(),
            text: text.clone(),
            shown: shown(sources, exceptions, requirement, &format!("{id}/{name}")),
        })
        .collect();
    let all = |part: fn(&Shown) -> &Vec<String>| -> Vec<String> {
        let set: BTreeSet<&String> = sentences.iter().flat_map(|s| part(&s.shown)).collect();
        set.into_iter().cloned().collect()
    };
    let own = shown(sources, exceptions, requirement, id);
    let worst = sentences.iter().map(|s| s.shown.status).max();
    // A reason for the whole requirement is one for each of its sentences.
    let status = match (worst.unwrap_or(Status::Open), own.status, &own.reason) {
        (Status::Open, whole, Some(_)) => whole,
        (worst, ..) => worst,
    };
    let reasons = sentences
        .iter()
        .filter_map(|s| Some(format!("{}: {}", s.name, s.shown.reason.as_ref()?)));
    let reason = match status {
        Status::Covered | Status::Open => None,
        _ => Some(reasons.collect::<Vec<_>>().join("; "))
            .filter(|text| !text.is_empty())
            .or(own.reason),
    };
    let vague = [own.rules, own.monitors, own.proofs, own.tests].concat();
    Row {
        requirement: requirement.clone(),
        shown: Shown {
            status,
            rules: all(|s| &s.rules),
            monitors: all(|s| &s.monitors),
            proofs: all(|s| &s.proofs),
            tests: all(|s| &s.tests),
            reason,
        },
        sentences,
        vague,
    }
}

/// The evidence that names `id`, a requirement or a sentence of it.
fn shown(
    sources: &Sources,
    exceptions: &BTreeMap<&str, &Exception>,
    requirement: &Requirement,
    id: &str,
) -> Shown {
    let places = |named: &Named| -> Vec<String> {
        named
            .get(id)
            .map(|p| p.iter().map(ToString::to_string).collect())
            .unwrap_or_default()
    };
    let (mut rules, data) = (places(&sources.rules), places(&sources.data));
    let (monitors, proofs) = (places(&sources.monitors), places(&sources.proofs));
    let tests = places(&sources.tests);
    let (languages, programs) = (places(&sources.languages), places(&sources.programs));
    // A program that the manual prints is what it specifies, and no monitor runs it: a test does.
    let printed = !programs.is_empty() && !tests.is_empty();
    // What only the languages are about is settled when a program is read, before any monitor runs.
    let about_programs = rules.is_empty() && !languages.is_empty();
    let behaviour = about_monitors(requirement) && !about_programs && !printed;
    rules.extend(languages);
    let specified = printed || !rules.is_empty() || (!data.is_empty() && !behaviour);
    rules.extend(data);
    rules.extend(programs);
    let covered = specified
        && (!monitors.is_empty() || !behaviour)
        && (!proofs.is_empty() || !tests.is_empty());
    let exception = exceptions.get(id);
    let (status, reason) = match (&requirement.merged_into, requirement.scope, exception) {
        _ if covered => (Status::Covered, None),
        (Some(carrier), ..) => (
            Status::Excepted,
            Some(format!("its content is carried by {carrier}")),
        ),
        (None, Scope::Hardware, _) => (
            Status::Excepted,
            Some("a property of hardware: traced, never implemented here".to_owned()),
        ),
        (None, _, Some(exception)) => match &exception.test {
            Some(test) => (
                Status::Delegated,
                Some(format!("acceptance test {test}: {}", exception.reason)),
            ),
            None => (Status::Excepted, Some(exception.reason.clone())),
        },
        (None, _, None) => (Status::Open, None),
    };
    Shown {
        status,
        rules,
        monitors,
        proofs,
        tests,
        reason,
    }
}

/// Whether a requirement is about the behaviour of a monitor.
fn about_monitors(requirement: &Requirement) -> bool {
    let behaviour = match requirement.kind {
        Kind::Fault
        | Kind::Function
        | Kind::Interface
        | Kind::State
        | Kind::Test
        | Kind::Timing
        | Kind::Transition => true,
        Kind::Architecture
        | Kind::Commissioning
        | Kind::Constraint
        | Kind::Diagnostic
        | Kind::Parameter => false,
    };
    behaviour && requirement.scope == Scope::Core
}

/// The area of an id: `STOP` of `S840D-STOP-021`.
pub(crate) fn area(id: &str) -> &str {
    id.split('-').nth(1).unwrap_or("")
}

#[cfg(test)]
mod tests;
