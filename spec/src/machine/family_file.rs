//! Reads `family.toml` and checks it: names, ranges, expressions.

use std::path::Path;
use std::sync::Arc;

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::AxisKind;
use super::document::Findings;
use super::eval;
use super::family::{
    Binding, Explore, Family, Formula, Function, Limits, Param, Quantity, Rule, Scope,
};
use super::value::{Raw, number};
use crate::diag::Result;
use crate::lang::parse_expr;
use crate::text::read_text;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FamilyFile {
    name: Spanned<String>,
    title: String,
    max_axes: usize,
    monitoring_cycle: Spanned<String>,
    coupled_to_all: Spanned<String>,
    function: Vec<Function>,
    control: IndexMap<String, ParamData>,
    axis: IndexMap<String, ParamData>,
    door: IndexMap<String, ParamData>,
    #[serde(default, rename = "let")]
    lets: IndexMap<String, Spanned<String>>,
    plausibility: Vec<RuleData>,
    explore: Vec<ExploreData>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ParamData {
    #[serde(default)]
    md: Vec<u32>,
    #[serde(default)]
    name: String,
    text: String,
    quantity: Spanned<Quantity>,
    #[serde(default)]
    count: usize,
    #[serde(default)]
    elements: String,
    range: Option<(Spanned<toml::Value>, Spanned<toml::Value>)>,
    default: Option<Spanned<toml::Value>>,
    linear: Option<LimitsData>,
    rotary: Option<LimitsData>,
    #[serde(default)]
    choice: IndexMap<String, i64>,
    id: Vec<String>,
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
struct LimitsData {
    range: Option<(Spanned<toml::Value>, Spanned<toml::Value>)>,
    default: Spanned<toml::Value>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RuleData {
    of: Scope,
    id: Vec<String>,
    alarm: Option<u32>,
    #[serde(default)]
    each: Vec<i64>,
    when: Spanned<String>,
    at: String,
    text: String,
    fix: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExploreData {
    file: String,
    system: String,
    each: Scope,
    when: Spanned<String>,
    text: String,
    #[serde(default)]
    time: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    param: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    rank: IndexMap<Spanned<String>, Vec<String>>,
    #[serde(default)]
    member: IndexMap<Spanned<String>, Vec<String>>,
    #[serde(default)]
    members: usize,
    #[serde(default)]
    note: String,
}

/// The names of the families under `root`, sorted: folders with a `family.toml`.
pub(super) fn families(root: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(root)
        .into_iter()
        .flatten()
        .filter_map(std::result::Result::ok)
        .filter(|entry| entry.path().join("family.toml").is_file())
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    names.sort();
    names
}

/// Reads the data of the family in `folder`.
///
/// # Errors
/// Everything in the file that is not as [`super::family`] describes it.
pub(super) fn load(folder: &Path) -> Result<Family> {
    let path = folder.join("family.toml");
    let file = path.display().to_string();
    let source = read_text(&path, "family file")?;
    let mut check = Check {
        findings: Findings::new(&file, &source),
    };
    match check.family(folder, &file, &source) {
        Some(family) => check.findings.finish(family),
        None => Err(check.findings.into_diagnostics()),
    }
}

/// The names that expressions of each scope may read.
struct Known {
    control: Vec<String>,
    axis: Vec<String>,
    door: Vec<String>,
}

/// Reads one file of a family's data and collects what is wrong in it.
pub(super) struct Check {
    pub findings: Findings,
}

impl Check {
    /// `None` leaves at least one finding.
    fn family(&mut self, folder: &Path, file: &str, source: &Arc<str>) -> Option<Family> {
        let data: FamilyFile = match toml::from_str(source) {
            Ok(data) => data,
            Err(error) => {
                let help = "compare with the other entries of this file";
                self.findings
                    .add(error.span(), error.message(), "here", help);
                return None;
            }
        };
        if folder
            .file_name()
            .is_some_and(|n| *n != *data.name.get_ref().as_str())
        {
            self.findings.add(
                data.name.span(),
                format!(
                    "the family '{}' stands in another folder",
                    data.name.get_ref()
                ),
                "",
                "give the folder the name of the family",
            );
        }
        let control = self.params(data.control);
        let axis = self.params(data.axis);
        let door = self.params(data.door);
        let owned = |params: &IndexMap<String, Param>| params.keys().cloned().collect::<Vec<_>>();
        let mut known = Known {
            control: owned(&control),
            axis: [
                "kind",
                "LINEAR",
                "ROTARY",
                "enabled_any",
                "monitoring_cycle",
            ]
            .map(str::to_owned)
            .to_vec(),
            door: Vec::new(),
        };
        let monitoring_cycle = self.formula(data.monitoring_cycle, &known.control);
        known.axis.extend(owned(&control));
        known.axis.extend(owned(&axis));
        known
            .axis
            .extend(data.function.iter().map(|f| f.variable.clone()));
        let mut lets = Vec::new();
        for (name, text) in data.lets {
            let formula = self.formula(text, &known.axis);
            known.axis.push(name.clone());
            lets.extend(formula.map(|f| (name, f)));
        }
        let coupled_to_all = self.formula(data.coupled_to_all, &known.axis);
        known.door = known.axis.clone();
        known.door.extend(owned(&door));
        known.axis.push("k".to_owned());
        let rules = data.plausibility.into_iter();
        let rules = rules.filter_map(|r| self.rule(r, &known)).collect();
        let explore = data.explore.into_iter();
        let explore = explore
            .filter_map(|e| self.explore(e, &known.axis))
            .collect();
        Some(Family {
            folder: folder.to_owned(),
            file: file.to_owned(),
            source: source.clone(),
            title: data.title,
            max_axes: data.max_axes,
            monitoring_cycle: monitoring_cycle?,
            coupled_to_all: coupled_to_all?,
            functions: data.function,
            control,
            axis,
            door,
            lets,
            rules,
            explore,
        })
    }

    fn params(&mut self, data: IndexMap<String, ParamData>) -> IndexMap<String, Param> {
        let mut params = IndexMap::new();
        for (key, data) in data {
            params.insert(key, self.param(data));
        }
        params
    }

    fn param(&mut self, data: ParamData) -> Param {
        let numbers: Vec<String> = data.md.iter().map(|n| format!("MD{n}")).collect();
        let manual = format!("{} {}", numbers.join("/"), data.name);
        let common = data.default.map(|default| LimitsData {
            range: data.range,
            default,
        });
        let mut param = Param {
            quantity: data.quantity.into_inner(),
            manual: manual.trim().to_owned(),
            text: data.text,
            id: data.id,
            count: data.count,
            elements: data.elements,
            choices: data.choice.into_iter().collect(),
            linear: Limits::default(),
            rotary: Limits::default(),
        };
        if let Some(limits) = data.linear.or_else(|| common.clone()) {
            param.linear = self.limits(&param, limits, AxisKind::Linear);
        }
        if let Some(limits) = data.rotary.or(common) {
            param.rotary = self.limits(&param, limits, AxisKind::Rotary);
        }
        param
    }

    fn limits(&mut self, param: &Param, data: LimitsData, kind: AxisKind) -> Limits {
        let codes = param.choices.iter().map(|(_, code)| *code);
        let (min, max) = match (param.quantity, &data.range) {
            (Quantity::Bool, None) => (0, 1),
            (Quantity::Choice, None) => {
                (codes.clone().min().unwrap_or(0), codes.max().unwrap_or(0))
            }
            (_, Some((min, max))) => (self.value(param, min, kind), self.value(param, max, kind)),
            (_, None) => {
                let help = "write range = [least, greatest]";
                self.findings
                    .add(data.default.span(), "the range is missing", "", help);
                (0, 0)
            }
        };
        let default = self.value(param, &data.default, kind);
        if !(min..=max).contains(&default) {
            let help = "the least value, the default and the greatest value must rise";
            self.findings.add(
                data.default.span(),
                "the default is outside the range",
                "",
                help,
            );
        }
        Limits { min, max, default }
    }

    fn value(&mut self, param: &Param, value: &Spanned<toml::Value>, kind: AxisKind) -> i64 {
        match number(&Raw::from(value.get_ref()), param, kind) {
            Ok(value) => value,
            Err(refusal) => {
                self.findings
                    .add(value.span(), refusal.message, refusal.label, refusal.help);
                0
            }
        }
    }

    /// Parses an expression and checks that the names in it are `known`.
    pub fn formula(&mut self, text: Spanned<String>, known: &[String]) -> Option<Formula> {
        let expr = match parse_expr(text.get_ref()) {
            Ok(expr) => expr,
            Err(error) => {
                self.findings
                    .add(text.span(), error.message, "in this expression", error.help);
                return None;
            }
        };
        let mut unknown = None;
        eval::names(&expr, &mut |name| {
            if !known.iter().any(|k| k == name) {
                unknown.get_or_insert(name.to_owned());
            }
        });
        if let Some(name) = unknown {
            let help = match crate::diag::nearest(&name, known.iter().map(String::as_str)) {
                Some(near) => format!("did you mean '{near}'?"),
                None => "parameters, functions and lets of this file can be read".to_owned(),
            };
            let message = format!("unknown name '{name}'");
            self.findings
                .add(text.span(), message, "in this expression", help);
            return None;
        }
        Some(Formula { text, expr })
    }

    fn rule(&mut self, data: RuleData, known: &Known) -> Option<Rule> {
        let known = match data.of {
            Scope::Control => &known.control,
            Scope::Axis => &known.axis,
            Scope::Door => &known.door,
            Scope::Group => {
                let help = "write of = \"control\", \"axis\" or \"door\"";
                self.findings
                    .add(data.when.span(), "no rules are judged for groups", "", help);
                return None;
            }
        };
        Some(Rule {
            of: data.of,
            id: data.id,
            alarm: data.alarm,
            each: if data.each.is_empty() {
                vec![0]
            } else {
                data.each
            },
            when: self.formula(data.when, known)?,
            at: data.at,
            text: data.text,
            fix: data.fix,
        })
    }

    /// What one entry of `[[explore]]` says; its expressions may read `known`.
    pub fn explore(&mut self, data: ExploreData, known: &[String]) -> Option<Explore> {
        if matches!(data.each, Scope::Control | Scope::Door) {
            let help = "write each = \"axis\" or \"group\"";
            self.findings.add(
                data.when.span(),
                "systems are explored for axes and groups",
                "",
                help,
            );
        }
        let mut params = Vec::new();
        for (name, text) in data.param {
            params.push(Binding::Value(name, self.formula(text, known)?));
        }
        for (name, text) in data.time {
            params.push(Binding::Time(name, self.formula(text, known)?));
        }
        for (list, names) in data.rank {
            if !known.contains(list.get_ref()) {
                let message = format!("unknown name '{}'", list.get_ref());
                self.findings
                    .add(list.span(), message, "", "name a list of values");
            }
            params.push(Binding::Rank(list.into_inner(), names));
        }
        for (text, names) in data.member {
            params.push(Binding::Member(self.formula(text, known)?, names));
        }
        Some(Explore {
            file: data.file,
            system: data.system,
            each: data.each,
            when: self.formula(data.when, known)?,
            text: data.text,
            note: data.note,
            members: data.members,
            params,
        })
    }
}
