//! The data of a family that machine files are read with: parameters, functions, plausibility rules, systems to explore.
//! They stand in `<family>/family.toml`; nothing of them is known to the code.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;

use indexmap::{IndexMap, IndexSet};
use serde::Deserialize;
use toml::Spanned;

use super::AxisKind;
use super::ground::read_names;
use super::guarantee::{Fault, Pattern};
use super::signal::{self, Signals};
use super::units::{Dimension, quoted};
use stillpoint_lang::syntax::ast::Expr;

/// Everything that `family.toml` says, checked.
#[derive(Debug)]
pub(super) struct Family {
    /// Its folder, which holds the specification files too.
    pub folder: PathBuf,
    /// The file and its text, for diagnostics about the data themselves.
    pub file: String,
    pub source: Arc<str>,
    pub title: String,
    pub max_axes: usize,
    /// The greatest number of axis groups that a machine file may declare.
    pub max_groups: usize,
    pub monitoring_cycle: Formula,
    /// TRUE for an axis whose stops act on every axis of the machine; none: there is no such axis.
    pub coupled_to_all: Option<Formula>,
    pub functions: Vec<Function>,
    pub control: IndexMap<String, Param>,
    pub axis: IndexMap<String, Param>,
    /// The parameters in which two axes that move one thing may differ; empty: no axis can be said to.
    pub own: Vec<String>,
    /// Parameters of an axis group. With them a machine file declares its groups, and a door names groups in place of axes.
    pub group: Option<IndexMap<String, Param>>,
    pub door: IndexMap<String, Param>,
    /// Named expressions over the values of an axis, in order.
    pub lets: Vec<(String, Formula)>,
    /// Named expressions over the values of a group and of what belongs to it, in order.
    pub group_lets: Vec<(String, Formula)>,
    pub rules: Vec<Rule>,
    pub explore: Vec<Explore>,
    /// What is too large to be enumerated, and asked of the proof engines beside it.
    pub products: Vec<Explore>,
    /// The names that expressions may read.
    pub known: Known,
    /// Machines of the tables that a machine file may replace by its own `[logic]`.
    pub logic: IndexMap<String, Slot>,
    /// What its machine files can guarantee.
    pub patterns: IndexMap<String, Pattern>,
    /// The classes of single faults, of which a guarantee may be asked to hold after any.
    pub faults: IndexMap<String, Fault>,
}

impl Family {
    /// A named expression over the values of an axis or of a group.
    pub fn named(&self, name: &str) -> Option<&Formula> {
        let mut all = self.lets.iter().chain(&self.group_lets);
        all.find(|(known, _)| known == name)
            .map(|(_, formula)| formula)
    }

    /// Learns the names that the program of a machine file declares: what a signal can be.
    pub fn declare(&mut self, program: &[(String, bool)]) {
        if program.is_empty() {
            return; // the lists of numbered signals are long, and whole already
        }
        let signals = &mut self.known.signals;
        signals.declare(program);
        let all = [&mut self.control, &mut self.axis, &mut self.door].into_iter();
        let all = all.chain(&mut self.group).flat_map(IndexMap::values_mut);
        let patterns = self.patterns.values_mut();
        for param in all.chain(patterns.flat_map(|pattern| pattern.arguments.values_mut())) {
            for name in &param.signals {
                for one in signals.named(name, param.inverted).into_iter().flatten() {
                    if !param.choices.contains(&one) {
                        param.choices.push(one);
                    }
                }
            }
            let greatest = param.choices.iter().map(|(_, code)| *code).max();
            if !param.signals.is_empty() {
                for limits in [&mut param.linear, &mut param.rotary] {
                    limits.max = greatest.unwrap_or(0);
                }
            }
        }
    }

    /// The parameter of this name, of whatever has it.
    pub fn parameter(&self, name: &str) -> Option<&Param> {
        let all = [&self.control, &self.axis, &self.door].into_iter();
        all.chain(&self.group).find_map(|params| params.get(name))
    }

    /// The names with those that the named expressions among them read, each once; of what the family has no parameter too.
    pub fn resolved(&self, names: Vec<String>) -> IndexSet<String> {
        self.resolved_by(names, &read_names)
    }

    /// The same where `read` tells what an expression reads.
    pub fn resolved_by(
        &self,
        names: Vec<String>,
        read: &dyn Fn(&Expr) -> Vec<String>,
    ) -> IndexSet<String> {
        let mut found = IndexSet::from_iter(names);
        let mut at = 0;
        while let Some(name) = found.get_index(at) {
            let more = match self.named(name) {
                Some(formula) => read(&formula.expr),
                None if name == "monitoring_cycle" => read(&self.monitoring_cycle.expr),
                None => Vec::new(),
            };
            found.extend(more);
            at += 1;
        }
        found
    }
}

/// The names that expressions of each scope may read.
#[derive(Debug, Default)]
pub(super) struct Known {
    pub control: Vec<String>,
    pub axis: Vec<String>,
    /// A door and one axis behind it.
    pub door: Vec<String>,
    /// A group, a door with everything behind it, or the machine.
    pub whole: Vec<String>,
    /// Whether machine files declare groups.
    pub groups: bool,
    /// The numbered signals of the family.
    pub signals: Signals,
    /// The times, and what is made of them, by the roundings of the parameters in them.
    pub roundings: BTreeMap<String, Vec<Rounding>>,
}

impl Known {
    /// The different roundings of the times that the expression reads.
    pub fn roundings(&self, formula: &Formula) -> Vec<Rounding> {
        let mut found = Vec::new();
        super::eval::names(&formula.expr, &mut |name| {
            for rounding in self.roundings.get(name).into_iter().flatten() {
                if !found.contains(rounding) {
                    found.push(*rounding);
                }
            }
        });
        found
    }

    /// Named expressions have the roundings of what they read.
    pub fn inherit(&mut self, lets: &[(String, Formula)]) {
        for (name, formula) in lets {
            let roundings = self.roundings(formula);
            self.roundings.insert(name.clone(), roundings);
        }
    }

    /// The names for what is explored.
    pub fn of_explored(&self, each: Scope, of_members: bool) -> &[String] {
        match each {
            Scope::Axis => &self.axis,
            Scope::Group if of_members => &self.axis,
            _ => &self.whole,
        }
    }
}

/// The language of a safe program that stands in a file of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub(super) enum Language {
    /// IEC 61131-3 Structured Text; its inputs and outputs have the names of the machine that it replaces.
    #[default]
    #[serde(rename = "Structured Text")]
    StructuredText,
    /// Synchronous actions with numbered signals, which the values of the machine file connect.
    #[serde(rename = "SAFE.SPF")]
    SafeSpf,
    /// Statement lists of STEP 7, with the same signals as SAFE.SPF.
    #[serde(rename = "STL")]
    StatementList,
    /// Structured Text with names of its own, which the values of the machine file connect.
    #[serde(rename = "Structured Text with own names")]
    Named,
}

/// A machine of the tables that a machine file may replace.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Slot {
    /// The specification file that declares it.
    pub file: String,
    /// The language of programs that can stand in its place.
    #[serde(default)]
    pub language: Language,
    /// The machine that a program of the other half takes the place of, in statement lists: the key `plc` of the logic.
    pub plc: Option<String>,
    /// What that half has of an axis; none: it does nothing to an axis by itself.
    pub half: Option<Half>,
    /// What it is, in a few words.
    pub text: String,
    /// What is assumed of it where the machine file has none.
    pub missing: Option<String>,
}

/// What the half of a logic in a PLC gives an axis, where the values of the machine file say it of the other half.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Half {
    /// What a run is about that is made with this half alone.
    pub text: String,
    /// What is assumed of it where the machine file has none.
    pub missing: String,
    /// The parameter with the number of the axis; 0 is its place in the file.
    pub number: String,
    /// The data block before that of the first axis.
    pub block: i64,
    /// For each parameter that connects an input of the axis, its bit in that block: `DBX22.1`.
    pub bits: IndexMap<String, String>,
}

/// A safety function that can be enabled for an axis.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Function {
    pub name: String,
    /// Its bit in the enable word.
    #[allow(dead_code)] // part of the data; the tests compare it with the machine data table
    pub bit: u32,
    /// The Boolean that expressions know it by, and its index there.
    pub variable: String,
    #[serde(default)]
    pub index: usize,
    /// Whether one of the explored systems contains it.
    pub explored: bool,
    pub text: String,
    #[serde(deserialize_with = "stillpoint_lang::catalogue::once")]
    pub id: Vec<String>,
}

/// What a parameter measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Quantity {
    Length,
    Angle,
    Grid,
    Pitch,
    Speed,
    /// A speed in revolutions, whatever the kind of axis.
    Rotation,
    Acceleration,
    Time,
    Percent,
    Frequency,
    Count,
    Choice,
    /// A safe signal, by the coding of the machine data: `"OUTSI[3]"`, `"NOT INSE[1]"`, `"04010103H"`.
    Signal,
    Bool,
    /// Groups that come before this one, by name; inside a bit for each, in the order of the machine file.
    Groups,
}

impl Quantity {
    /// The dimension for an axis of this kind; choices and Booleans are plain numbers inside.
    pub fn dimension(self, kind: AxisKind) -> Dimension {
        match (self, kind) {
            (Self::Length, AxisKind::Linear) => Dimension::Length,
            (Self::Length, AxisKind::Rotary) | (Self::Angle, _) => Dimension::Angle,
            (Self::Grid, _) => Dimension::Grid,
            (Self::Pitch, _) => Dimension::Pitch,
            (Self::Speed, AxisKind::Linear) => Dimension::Speed,
            (Self::Speed, AxisKind::Rotary) | (Self::Rotation, _) => Dimension::Rotation,
            (Self::Acceleration, AxisKind::Linear) => Dimension::Acceleration,
            (Self::Acceleration, AxisKind::Rotary) => Dimension::AngularAcceleration,
            (Self::Time, _) => Dimension::Time,
            (Self::Percent, _) => Dimension::Percent,
            (Self::Frequency, _) => Dimension::Frequency,
            (Self::Count | Self::Choice | Self::Signal | Self::Bool | Self::Groups, _) => {
                Dimension::Count
            }
        }
    }
}

/// A parameter of the control, an axis, a group or a door.
#[derive(Debug, Clone)]
pub(super) struct Param {
    pub quantity: Quantity,
    /// The manual's names: `MD36930 $MA_SAFE_STANDSTILL_TOL`; empty for what is no machine datum.
    pub manual: String,
    /// What it is, in a few words.
    pub text: String,
    /// Requirement ids.
    pub id: Vec<String>,
    /// Number of values; 0 for a scalar.
    pub count: usize,
    /// What the values of an array are, for messages: `SG1 to SG4`.
    pub elements: String,
    /// The values of a choice; all signals that a signal can be.
    pub choices: Vec<(String, i64)>,
    /// The lists of signals that it can be one of.
    pub signals: Vec<String>,
    /// Whether also inverted.
    pub inverted: bool,
    /// The kinds of axes that have it, as a machine file names them; empty: all.
    pub kinds: Vec<String>,
    /// The finest step that the control takes, in base units; 1 where it is a base unit.
    pub step: i64,
    /// How a time becomes whole cycles.
    pub cycles: Rounding,
    pub linear: Limits,
    pub rotary: Limits,
}

/// How a time becomes whole cycles: one rule for each parameter, wherever its value goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Rounding {
    /// Nothing happens before the time is over.
    #[default]
    Up,
    /// What has to happen in the time does not come later.
    Down,
}

impl Rounding {
    /// `time` in whole cycles; both positive or 0.
    pub fn cycles(self, time: i64, cycle: i64) -> i64 {
        time / cycle + i64::from(self == Self::Up && time % cycle != 0)
    }
}

/// The allowed range and the default of a parameter, in base units.
#[derive(Debug, Clone, Default)]
pub(super) struct Limits {
    pub min: i64,
    pub max: i64,
    pub default: i64,
}

impl Param {
    pub fn limits(&self, kind: AxisKind) -> &Limits {
        match kind {
            AxisKind::Linear => &self.linear,
            AxisKind::Rotary => &self.rotary,
        }
    }

    /// Whether an axis of the kind with this name has it; what is no axis has no kind.
    pub fn is_of(&self, kind: &str) -> bool {
        kind.is_empty() || self.kinds.is_empty() || self.kinds.iter().any(|k| k == kind)
    }

    /// Whether the manual calls it so: `MD36930`, `MD1330` or `$MA_SAFE_STANDSTILL_TOL`.
    pub fn is_called(&self, name: &str) -> bool {
        let mut names = self.manual.split(['/', ' ']).filter(|n| !n.is_empty());
        names.any(|n| n == name)
    }

    /// The names that a choice or a signal can have, for messages.
    pub fn names(&self) -> String {
        let names: Vec<&str> = self.choices.iter().map(|(n, _)| n.as_str()).collect();
        match self.quantity {
            Quantity::Signal => signal::ranges(&names),
            _ => quoted(&names),
        }
    }

    /// The value as a user writes it.
    pub fn show(&self, value: i64, kind: AxisKind) -> String {
        match self.quantity {
            Quantity::Choice | Quantity::Signal => self
                .choices
                .iter()
                .find(|(_, code)| *code == value)
                .map_or_else(|| value.to_string(), |(name, _)| format!("\"{name}\"")),
            Quantity::Bool => (value != 0).to_string(),
            Quantity::Groups if value == 0 => "none".to_owned(),
            _ => self.quantity.dimension(kind).show(value),
        }
    }
}

/// An expression of the data and the place of its text.
#[derive(Debug)]
pub(super) struct Formula {
    pub text: Spanned<String>,
    pub expr: Expr,
}

/// What a rule or a system speaks about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Scope {
    Control,
    Axis,
    Door,
    Group,
    Machine,
}

/// A plausibility rule: `when` must not hold.
#[derive(Debug)]
pub(super) struct Rule {
    pub of: Scope,
    pub id: Vec<String>,
    pub alarm: Option<u32>,
    /// The values of `k`; one pass with k = 0 where there are none.
    pub each: Vec<i64>,
    /// A parameter of which no two axes that `when` holds for may have the same value.
    pub unique: Option<String>,
    pub when: Formula,
    /// The key whose place is shown: `POS_LIMIT_PLUS[k]` or `functions`.
    pub at: String,
    pub text: String,
    pub fix: String,
}

/// The name under which the parameters of an explored system read the time that passes beside it.
pub(super) const BEFORE: &str = "before";

/// The name under which those of a system for a group of axes read how many these are.
pub(super) const MEMBERS: &str = "members";

/// A system to explore for an axis, a group of axes, a door or the machine.
#[derive(Debug)]
pub(super) struct Explore {
    pub file: String,
    pub system: String,
    pub each: Scope,
    pub when: Formula,
    pub text: String,
    /// Where the system is coarser than what it stands for; may be empty.
    pub note: String,
    /// Which values its parameters have in place of those of the machine; may be empty.
    pub chosen: String,
    /// For a group of axes, each with values of its own: how many of them the system is for. None: the group has one value of each.
    pub members: Option<RangeInclusive<usize>>,
    /// The length of a cycle of the system, where it is not the monitoring cycle.
    pub cycle: Option<Formula>,
    /// A time that passes beside what is explored, and that a bound found there does not have. The expressions under `param` read it as `before`.
    pub before: Option<Formula>,
    /// The greatest speed at which the axis may be monitored before, in base units a minute: a bound at this speed is a way.
    pub travel: Option<Formula>,
    /// A way that is added to that one: what the axis may move before its monitor minds.
    pub window: Option<Formula>,
    /// The time from one scan of a program in it to the next, where that is not its cycle.
    pub scan: Option<Formula>,
    /// The ports of the program that takes a machine's place, each with what names its signal.
    pub wires: Vec<Wire>,
    /// The classes of single faults that it answers, each where the expression is TRUE.
    pub covers: Vec<(String, Formula)>,
    pub params: Vec<Binding>,
}

/// Which signal of a program is connected to a port.
#[derive(Debug)]
pub(super) struct Wire {
    pub port: String,
    /// The parameter that names the signal, and the index there.
    pub name: String,
    pub index: usize,
    /// Whether it may name none.
    pub optional: bool,
}

/// The parameter of a system that takes a value.
#[derive(Debug, Clone)]
pub(super) struct Target {
    pub name: String,
    /// Whether it is an array with a cell for each member of the group; `name[]` in the data.
    pub each: bool,
}

/// How parameters of a system follow from the values of an axis.
#[derive(Debug)]
pub(super) enum Binding {
    /// The parameter is the value of the expression.
    Value(Target, Formula),
    /// A time: whole monitoring cycles, rounded as its parameters say, up where there are none; divided by the common step
    /// where the system is scaled.
    Time(Target, Formula, Rounding),
    /// Each of the parameters is the position of one value of a list among its different values, from 0.
    Rank(String, Vec<String>),
}

impl Binding {
    /// The parameter that is an array with a cell for each member of the group; none: it is another one.
    pub fn array(&self) -> Option<&str> {
        match self {
            Binding::Value(target, _) | Binding::Time(target, ..) if target.each => {
                Some(&target.name)
            }
            _ => None,
        }
    }
}
