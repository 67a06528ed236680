//! Reads `family.toml` and checks it: names, ranges, expressions.

use std::path::Path;
use std::sync::Arc;

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::AxisKind;
use super::document::Findings;
use super::eval;
use super::explore_file::ExploreData;
use super::family::{
    Family, Formula, Function, Known, Limits, Param, Quantity, Rounding, Rule, Scope, Slot,
};
use super::guarantee;
use super::products;
use super::signal::{Bits, Signals};
use super::value::{Raw, number};
use super::whole::before;
use stillpoint_lang::diag::Result;
use stillpoint_lang::read_text;
use stillpoint_lang::syntax::parse_expr;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FamilyFile {
    name: Spanned<String>,
    title: String,
    max_axes: usize,
    #[serde(default)]
    max_groups: usize,
    monitoring_cycle: Spanned<String>,
    coupled_to_all: Option<Spanned<String>>,
    #[serde(default)]
    function: Vec<Function>,
    #[serde(default)]
    control: IndexMap<String, ParamData>,
    axis: IndexMap<String, ParamData>,
    group: Option<IndexMap<String, ParamData>>,
    #[serde(default)]
    door: IndexMap<String, ParamData>,
    /// The parameters in which two axes that move one thing may differ; none: no axis can be said to.
    #[serde(default)]
    own: Vec<Spanned<String>>,
    #[serde(default, rename = "let")]
    lets: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    group_let: IndexMap<String, Spanned<String>>,
    #[serde(default)]
    signal: IndexMap<String, Bits>,
    #[serde(default)]
    logic: IndexMap<String, Slot>,
    #[serde(default)]
    plausibility: Vec<RuleData>,
    explore: Vec<ExploreData>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParamData {
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
    /// Which numbered signals of the family it can be, and whether also inverted.
    #[serde(default)]
    signals: Vec<Spanned<String>>,
    #[serde(default)]
    inverted: bool,
    #[serde(default)]
    kinds: Vec<String>,
    #[serde(default = "one")]
    step: i64,
    cycles: Option<Spanned<Rounding>>,
    #[serde(deserialize_with = "stillpoint_lang::catalogue::once")]
    id: Vec<String>,
}

const fn one() -> i64 {
    1
}

#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
struct LimitsData {
    range: Option<(Spanned<toml::Value>, Spanned<toml::Value>)>,
    default: Spanned<toml::Value>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RuleData {
    of: Scope,
    #[serde(deserialize_with = "stillpoint_lang::catalogue::once")]
    id: Vec<String>,
    alarm: Option<u32>,
    #[serde(default)]
    each: Vec<i64>,
    unique: Option<Spanned<String>>,
    when: Spanned<String>,
    at: String,
    text: String,
    fix: String,
}

/// What the expressions about an axis may read beside parameters, functions and lets.
const OF_AXIS: [&str; 6] = [
    "kind",
    "LINEAR",
    "ROTARY",
    "spindle",
    "enabled_any",
    "monitoring_cycle",
];

/// The file that makes a folder that of a family.
pub(super) const FILE: &str = "family.toml";

/// A list of groups is one cell.
const MOST_GROUPS: usize = 62;

/// The names of the families under `root`, sorted: folders with a `family.toml`.
pub(super) fn families(root: &Path) -> Vec<String> {
    let folders = stillpoint_lang::files::list(root)
        .unwrap_or_default()
        .into_iter();
    folders
        .filter(|folder| stillpoint_lang::files::is_file(&folder.join(FILE)))
        .filter_map(|folder| folder.file_name()?.to_str().map(str::to_owned))
        .collect()
}

/// Reads the data of the family in `folder`.
///
/// # Errors
/// Everything in the file that is not as [`super::family`] describes it.
pub(super) fn load(folder: &Path) -> Result<Family> {
    let path = folder.join(FILE);
    let file = path.display().to_string();
    let source = read_text(&path, "family file")?;
    let mut check = Check {
        findings: Findings::new(&file, &source),
        signals: Signals::default(),
        faults: Vec::new(),
    };
    let Some(mut family) = check.family(folder, &file, &source) else {
        return Err(check.findings.into_diagnostics());
    };
    (family.patterns, family.faults) = guarantee::load(folder, &family.known, &family.group_lets)?;
    family.products = products::load(folder, &family.known)?;
    check.findings.finish(family)
}

/// Reads one file of a family's data and collects what is wrong in it.
pub(super) struct Check {
    pub findings: Findings,
    /// The numbered signals of the family.
    pub signals: Signals,
    /// The classes of single faults that an exploration can answer.
    pub faults: Vec<String>,
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
        if data.max_groups > MOST_GROUPS {
            let message = format!("max_groups is {}", data.max_groups);
            let help = format!("at most {MOST_GROUPS}: a list of groups has a bit for each");
            self.findings.add(None, message, "", help);
        }
        self.signals = Signals(data.signal);
        let control = self.params(data.control);
        let axis = self.params(data.axis);
        let group = data.group.map(|group| self.params(group));
        let door = self.params(data.door);
        let owned = |params: &IndexMap<String, Param>| params.keys().cloned().collect::<Vec<_>>();
        let mut known = Known {
            control: owned(&control),
            axis: OF_AXIS.map(str::to_owned).to_vec(),
            groups: group.is_some(),
            signals: self.signals.clone(),
            ..Known::default()
        };
        let all = [&control, &axis].into_iter().chain(&group).chain([&door]);
        for (name, param) in all.flatten() {
            if param.quantity == Quantity::Time {
                known.roundings.insert(name.clone(), vec![param.cycles]);
            }
        }
        let own = self.own(data.own, &axis);
        let monitoring_cycle = self.formula(data.monitoring_cycle, &known.control);
        known.axis.extend(owned(&control));
        known.axis.extend(owned(&axis));
        let functions = data.function.iter();
        known.axis.extend(functions.map(|f| f.variable.clone()));
        let lets = self.lets(data.lets, &mut known.axis);
        known.inherit(&lets);
        let coupled_to_all = match data.coupled_to_all {
            Some(text) => Some(self.formula(text, &known.axis)?),
            None => None,
        };
        known.door = known.axis.clone();
        known.door.extend(owned(&door));
        known.whole = known.door.clone();
        known.whole.extend(group.iter().flat_map(owned));
        let group_lets = self.lets(data.group_let, &mut known.whole);
        known.inherit(&group_lets);
        for (name, formula) in &group_lets {
            let roundings = known.roundings(formula);
            known.roundings.insert(before(name), roundings);
            known.whole.push(before(name));
        }
        for names in [&mut known.axis, &mut known.door, &mut known.whole] {
            names.push("k".to_owned());
        }
        let rules = data.plausibility.into_iter();
        let rules = rules.filter_map(|r| self.rule(r, &known)).collect();
        let explore = self.explores(data.explore, &known);
        Some(Family {
            folder: folder.to_owned(),
            file: file.to_owned(),
            source: source.clone(),
            title: data.title,
            max_axes: data.max_axes,
            max_groups: data.max_groups,
            monitoring_cycle: monitoring_cycle?,
            coupled_to_all,
            functions: data.function,
            control,
            axis,
            own,
            group,
            door,
            lets,
            group_lets,
            rules,
            explore,
            products: Vec::new(),
            known,
            logic: data.logic,
            patterns: IndexMap::new(),
            faults: IndexMap::new(),
        })
    }

    /// Parameters of an axis.
    fn own(&mut self, names: Vec<Spanned<String>>, axis: &IndexMap<String, Param>) -> Vec<String> {
        for name in &names {
            if !axis.contains_key(name.get_ref()) {
                let message = format!("there is no parameter '{}'", name.get_ref());
                let help = "name parameters of [axis.NAME]";
                self.findings.add(name.span(), message, "", help);
            }
        }
        names.into_iter().map(Spanned::into_inner).collect()
    }

    /// Named expressions, each of which may read those before it.
    fn lets(
        &mut self,
        data: IndexMap<String, Spanned<String>>,
        known: &mut Vec<String>,
    ) -> Vec<(String, Formula)> {
        let mut lets = Vec::new();
        for (name, text) in data {
            let formula = self.formula(text, known);
            known.push(name.clone());
            lets.extend(formula.map(|f| (name, f)));
        }
        lets
    }

    pub fn params(&mut self, data: IndexMap<String, ParamData>) -> IndexMap<String, Param> {
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
        let mut choices: Vec<(String, i64)> = data.choice.into_iter().collect();
        for name in &data.signals {
            match self.signals.named(name.get_ref(), data.inverted) {
                Some(list) => choices.extend(list),
                None => {
                    let help = format!("signals of the family: {}", self.signals.names());
                    let message = format!("there is no signal '{}'", name.get_ref());
                    self.findings.add(name.span(), message, "", help);
                }
            }
        }
        let mut param = Param {
            quantity: data.quantity.into_inner(),
            manual: manual.trim().to_owned(),
            text: data.text,
            id: data.id,
            count: data.count,
            elements: data.elements,
            choices,
            signals: (data.signals.into_iter())
                .map(Spanned::into_inner)
                .collect(),
            inverted: data.inverted,
            kinds: data.kinds,
            step: data.step.max(1),
            cycles: data
                .cycles
                .as_ref()
                .map_or_else(Rounding::default, |c| *c.get_ref()),
            linear: Limits::default(),
            rotary: Limits::default(),
        };
        if let Some(cycles) = data.cycles.filter(|_| param.quantity != Quantity::Time) {
            let help = "only a time becomes cycles: leave it out";
            self.findings
                .add(cycles.span(), "this is no time", "", help);
        }
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
            (Quantity::Groups, None) => (0, i64::MAX),
            (Quantity::Choice | Quantity::Signal, None) => {
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
            let help = match stillpoint_lang::diag::nearest(&name, known.iter().map(String::as_str))
            {
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

    /// What one entry of `[[plausibility]]` says.
    pub fn rule(&mut self, data: RuleData, known: &Known) -> Option<Rule> {
        let known = match data.of {
            Scope::Control => &known.control,
            Scope::Axis => &known.axis,
            Scope::Door => &known.door,
            Scope::Group | Scope::Machine => &known.whole,
        };
        let unique = data.unique.map(|name| {
            let (at, name) = (name.span(), name.into_inner());
            if data.of != Scope::Axis || !known.contains(&name) {
                let message = format!("'{name}' cannot be unique here");
                let help = "name a parameter of an axis, with of = \"axis\"";
                self.findings.add(at, message, "", help);
            }
            name
        });
        Some(Rule {
            of: data.of,
            unique,
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
}
