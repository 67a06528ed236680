//! Values that are legal but unusual, or contradict their purpose. They change no verdict.
//!
//! The catalogue stands in `warnings.toml` in the folder of the family: each rule has an expression like a rule of
//! plausibility, the parameters it points at, the reason, what is better, and where the manual says so. A machine file accepts
//! a warning with a reason of its own under `[[accepted]]`.

mod accepted;

use std::path::Path;
use std::sync::Arc;

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::entry::{Premise, Reader};
use super::family::Family;
use super::family_file::Check;
use super::ground::{About, DataFile, Ground, Subjects, read_names};
use super::place::WORDS;
use super::template::{Template, Words};
use super::{Machine, Shown};
use accepted::Accepted;
use stillpoint_lang::diag::{Result, position};
use stillpoint_lang::syntax::ast::Expr;
use stillpoint_lang::syntax::parse_expr;

/// The file of the catalogue in the folder of a family.
const FILE: &str = "warnings.toml";

/// A value of a machine file that is legal but unusual, or that contradicts its purpose.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Its name in the catalogue: `standstill-window-wide`.
    pub id: String,
    /// What it is about: `axis X`, `door front, axis S`, `the machine`.
    pub of: String,
    /// What is unusual, or what contradicts what.
    pub text: String,
    /// Why it matters.
    pub reason: String,
    /// The better range, or what to do.
    pub better: String,
    /// Where the manual says so; empty: the reason stands for itself.
    pub source: String,
    /// Requirements of the manual.
    pub req: Vec<String>,
    /// The parameters that it points at, with their values.
    pub values: Vec<Shown>,
    /// The line of the first of them that the file gives, else of what it is about; from 1.
    pub line: usize,
    /// The column, from 1.
    pub column: usize,
    /// The reason for which the machine file accepts it.
    pub accepted: Option<String>,
}

/// A rule of the catalogue, for readers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Known {
    /// Its name.
    pub id: String,
    /// What is unusual; in the place of a value stands its parameter, or an ellipsis.
    pub text: String,
    /// When, as the data state it.
    pub when: String,
    /// Why it matters.
    pub reason: String,
    /// The better range, or what to do.
    pub better: String,
    /// Where the manual says so; empty: the reason stands for itself.
    pub source: String,
    /// Requirements of the manual.
    pub req: Vec<String>,
    /// The parameters and other names that it reads, also through named expressions.
    pub reads: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileData {
    /// The manual whose lines are named.
    manual: String,
    warning: Vec<RuleData>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RuleData {
    id: Spanned<String>,
    of: About,
    /// Of guarantees: their patterns, whose common arguments the expressions may read.
    #[serde(default)]
    patterns: Vec<Spanned<String>>,
    #[serde(default)]
    each: Vec<i64>,
    #[serde(default, rename = "let")]
    lets: IndexMap<String, Spanned<String>>,
    when: Spanned<String>,
    at: Vec<Spanned<String>>,
    text: Spanned<String>,
    reason: Spanned<String>,
    better: Spanned<String>,
    /// Lines of the manual; none: the reason is that of an engineer.
    #[serde(default)]
    lines: String,
    #[serde(default, deserialize_with = "stillpoint_lang::catalogue::once")]
    req: Vec<String>,
}

/// A rule, checked.
struct Rule {
    id: String,
    premise: Premise,
    at: Vec<Expr>,
    text: Template,
    reason: Template,
    better: Template,
    source: String,
    req: Vec<String>,
    /// The texts as the data have them.
    written: [String; 3],
}

/// The catalogue of a family.
struct Catalogue {
    file: DataFile,
    rules: Vec<Rule>,
}

/// The catalogue of the family in `folder`; empty where it has none.
///
/// # Errors
/// The files of the family are wrong.
pub fn catalogue(folder: &Path) -> Result<Vec<Known>> {
    let family = super::family_file::load(folder)?;
    let Some(catalogue) = Catalogue::load(&family)? else {
        return Ok(Vec::new());
    };
    let rules = catalogue.rules.into_iter();
    Ok(rules.map(|rule| rule.known(&family)).collect())
}

/// What is to be warned of, in the order of the machine file.
///
/// # Errors
/// The catalogue is wrong, or what the machine file accepts.
pub(super) fn judge(machine: &Machine, path: &Path, source: &Arc<str>) -> Result<Vec<Warning>> {
    let catalogue = Catalogue::load(&machine.basis.family)?;
    let ids = catalogue.iter().flat_map(|c| &c.rules);
    let ids: Vec<&str> = ids.map(|rule| rule.id.as_str()).collect();
    let mut accepted = Accepted::read(path, source, machine, &ids)?;
    let mut found: Vec<(usize, Warning)> = Vec::new();
    if let Some(Catalogue { file, rules }) = &catalogue {
        let mut subjects = Subjects::of(machine);
        for rule in rules {
            for ground in rule.premise.grounds(file, &mut subjects)? {
                let (at, mut warning) = rule.warning(file, &ground, source)?;
                warning.accepted = accepted.reason(&rule.id, &ground);
                found.push((at, warning));
            }
        }
    }
    found.extend(accepted.without_effect(source));
    found.sort_by_key(|(at, _)| *at);
    Ok(found.into_iter().map(|(_, warning)| warning).collect())
}

impl Machine {
    /// Whether its family has warnings at all: without them no warning says nothing.
    pub fn is_warned_of(&self) -> bool {
        has_catalogue(&self.basis.family)
    }
}

fn has_catalogue(family: &Family) -> bool {
    stillpoint_lang::files::is_file(&family.folder.join(FILE))
}

impl Catalogue {
    fn load(family: &Family) -> Result<Option<Self>> {
        if !has_catalogue(family) {
            return Ok(None);
        }
        let file = DataFile::read(&family.folder, FILE, "warnings")?;
        let data: FileData = file.parse()?;
        let mut check = file.check();
        let mut rules: Vec<Rule> = Vec::new();
        for rule in data.warning {
            if rules.iter().any(|r| r.id == *rule.id.get_ref()) {
                let message = format!("there are two warnings '{}'", rule.id.get_ref());
                let help = "give one of them another name";
                check
                    .findings
                    .add(rule.id.span(), message, "the second one", help);
            }
            rules.extend(Rule::read(&mut check, rule, family, &data.manual));
        }
        check.findings.finish(Some(Self { file, rules }))
    }
}

impl Rule {
    /// `None` leaves a finding.
    fn read(check: &mut Check, data: RuleData, family: &Family, manual: &str) -> Option<Self> {
        let written = [&data.text, &data.reason, &data.better].map(|t| t.get_ref().clone());
        let (premise, known) = Premise::read(
            check,
            family,
            data.of,
            data.patterns,
            data.each,
            data.when,
            data.lets,
        )?;
        let names = Words {
            about: data.of,
            known: &known,
            words: &[],
        };
        let mut at = Vec::new();
        for text in data.at {
            at.push(match parse_expr(text.get_ref()) {
                Ok(word) if WORDS.contains(&text.get_ref().as_str()) => word,
                _ => check.formula(text, &known)?.expr,
            });
        }
        let mut reader = Reader {
            check,
            names: &names,
        };
        Some(Self {
            id: data.id.into_inner(),
            premise,
            at,
            text: reader.text(data.text)?,
            reason: reader.text(data.reason)?,
            better: reader.text(data.better)?,
            source: match data.lines.as_str() {
                "" => String::new(),
                lines if lines.contains(['-', ',']) => format!("{manual}, lines {lines}"),
                line => format!("{manual}, line {line}"),
            },
            req: data.req,
            written,
        })
    }

    /// The warning for one subject, and where it stands.
    fn warning(
        &self,
        file: &DataFile,
        ground: &Ground<'_>,
        source: &str,
    ) -> Result<(usize, Warning)> {
        let mut values = Vec::new();
        let mut place = None;
        for at in &self.at {
            let pointed = ground.point(at);
            place = place.or(pointed.place);
            values.extend(pointed.shown);
        }
        let at = place.unwrap_or_else(|| ground.place()).start;
        let (line, column) = position(source, at).unwrap_or((1, 1));
        let warning = Warning {
            id: self.id.clone(),
            of: ground.name(),
            text: self.text.fill(file, ground)?,
            reason: self.reason.fill(file, ground)?,
            better: self.better.fill(file, ground)?,
            source: self.source.clone(),
            req: self.req.clone(),
            values,
            line,
            column,
            accepted: None,
        };
        Ok((at, warning))
    }

    fn known(self, family: &Family) -> Known {
        let lets = self.premise.lets.iter().map(|(_, formula)| formula);
        let formulas = lets.chain([&self.premise.when]);
        let mut reads: Vec<String> = formulas.flat_map(|f| read_names(&f.expr)).collect();
        reads.extend(self.at.iter().flat_map(read_names));
        let [text, reason, better] = self.written.map(|text| readable(&text, family));
        Known {
            id: self.id,
            text,
            when: self.premise.when.text.get_ref().clone(),
            reason,
            better,
            source: self.source,
            req: self.req,
            reads: family.resolved(reads).into_iter().collect(),
        }
    }
}

/// A text without a machine: in the place of a value stands the parameter, in that of a figure an ellipsis.
fn readable(text: &str, family: &Family) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let (inside, tail) = after.split_once('}').unwrap_or((after, ""));
        let name = inside.split('[').next().unwrap_or(inside).trim();
        let mut patterns = family.patterns.values();
        let own = name.len() == 1
            || family.parameter(name).is_some()
            || patterns.any(|pattern| pattern.arguments.contains_key(name));
        out.push_str(before);
        out.push_str(if own { inside.trim() } else { "\u{2026}" });
        rest = tail;
    }
    out + rest
}

impl Ground<'_> {
    /// What it is about, in a few words.
    fn name(&self) -> String {
        let axis = self.axis.map(|a| format!("axis {}", a.name));
        if let (Some(guarantee), Some(axis)) = (self.guarantee, &axis) {
            return format!("guarantee {}, {axis}", guarantee.name);
        }
        let door = self.door.map(|d| format!("door {}", d.name));
        match (door, axis, self.group) {
            (Some(door), Some(axis), _) => format!("{door}, {axis}"),
            (Some(one), None, _) | (None, Some(one), _) => one,
            (None, None, Some(group)) => format!("group {}", group.name),
            (None, None, None) => "the machine".to_owned(),
        }
    }
}
