//! What the formulas and texts of a family's further data (reaction chains, acceptance tests) are about: one axis, a group of
//! axes, a door, a door and an axis behind it, or the whole machine, with the values that can be read there.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;

use super::document::Findings;
use super::eval::{Values, deciding, eval, given, names};
use super::family::{Family, Formula, Quantity};
use super::family_file::Check;
use super::guarantee::Guarantee;
use super::plausible::insert;
use super::signal::Signals;
use super::whole::before;
use super::{Axis, AxisKind, Door, Group, Machine, Settings};
use stillpoint_lang::diag::{Diagnostic, Result};
use stillpoint_lang::read_text;
use stillpoint_lang::syntax::ast::{Expr, Kind};

/// A file of a family's data, for diagnostics about it.
#[derive(Debug)]
pub(super) struct DataFile {
    pub file: String,
    pub source: Arc<str>,
}

impl DataFile {
    /// Reads `name` in the folder of the family.
    ///
    /// # Errors
    /// The family has no such file, or it cannot be read.
    pub fn read(folder: &Path, name: &str, what: &str) -> Result<Self> {
        let path = folder.join(name);
        let source = read_text(&path, what)?;
        let file = path.display().to_string();
        Ok(Self { file, source })
    }

    /// Deserialises the file.
    ///
    /// # Errors
    /// It is not TOML of this form.
    pub fn parse<T: for<'de> Deserialize<'de>>(&self) -> Result<T> {
        toml::from_str(&self.source).map_err(|e| {
            Diagnostic::new(&self.file, &self.source, e.span(), e.message())
                .label("here")
                .help("compare with the other entries of this file")
                .into()
        })
    }

    /// Collects what is wrong in it.
    pub fn check(&self) -> Check {
        Check {
            findings: Findings::new(&self.file, &self.source),
            signals: Signals::default(),
            faults: Vec::new(),
        }
    }
}

/// As a number how many axes an axis moves with on one path, as a text which ones.
pub(super) const PATH: &str = "interpolates_with";
/// As a number how many axes of the machine do not move with an axis, as a text which ones.
const OTHERS: &str = "others";
/// How many doors the axis or group is behind, or the machine has.
const DOORS: &str = "doors";
/// How many declared groups the axis is in: 1 or none.
const GROUPS: &str = "groups";

/// How many guarantees the file has.
const GUARANTEES: &str = "guarantees";
/// How many of them ask about the axis, or about it behind the door.
const ASKED: &str = "asked";
/// How many of them hold after a fault.
const ASKED_AFTER_FAULT: &str = "asked_after_fault";
/// Whether the file has a program of the safe logic whose signals its values connect.
const PROGRAMMED: &str = "programmed";
/// How many guarantees assume something of a half of the safe logic that the file has not.
const HALF_ASSUMED: &str = "half_assumed";
/// As a number how many inputs of the safe logic no guarantee looks at, as a text which ones.
const UNASKED: &str = "unasked";
/// As a number in how many values an axis differs from the one that moves the same thing, as a text in which ones.
const DIFFERS: &str = "differs";
/// How many other axes move the same thing.
const PAIRED: &str = "paired";

/// The name under which formulas read how many guarantees of one pattern ask about the axis, or about it behind the door.
fn asked_by(pattern: &str) -> String {
    format!("{ASKED}_{pattern}")
}

/// What an entry of the data is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum About {
    /// Once for the machine.
    Machine,
    /// Once for each axis.
    Axis,
    /// Once for each axis group that the machine file declares.
    Group,
    /// Once for each door.
    Door,
    /// Once for each door and each axis behind it.
    DoorAxis,
    /// Once for each axis of each guarantee of the patterns that the entry names.
    Guarantee,
}

impl About {
    /// The names that formulas may read.
    pub fn known(self, family: &Family) -> Vec<String> {
        let mut known: Vec<String> = ["monitoring_cycle", "k", "n"].map(str::to_owned).to_vec();
        if self != Self::Door {
            let counts = [DOORS, GROUPS, GUARANTEES, ASKED, ASKED_AFTER_FAULT];
            known.extend(counts.map(str::to_owned));
            known.extend([PROGRAMMED, HALF_ASSUMED].map(str::to_owned));
            known.extend(family.patterns.keys().map(|name| asked_by(name)));
        }
        known.extend(family.control.keys().cloned());
        known.extend(family.functions.iter().map(|f| f.variable.clone()));
        known.extend(family.lets.iter().map(|(name, _)| name.clone()));
        known.push("enabled_any".to_owned());
        if matches!(self, Self::Axis | Self::DoorAxis | Self::Guarantee) {
            known.extend(["kind", "spindle", "LINEAR", "ROTARY", PATH, OTHERS].map(str::to_owned));
            known.extend([DIFFERS, PAIRED].map(str::to_owned));
            // What the groups that stop before its own take.
            known.extend(family.group_lets.iter().map(|(name, _)| before(name)));
            known.extend(family.axis.keys().cloned());
        }
        if self == Self::Machine {
            known.push(UNASKED.to_owned());
        }
        if matches!(self, Self::Group | Self::Machine) {
            known.extend(family.known.whole.iter().cloned());
        }
        if matches!(self, Self::Door | Self::DoorAxis) {
            known.extend(family.door.keys().cloned());
        }
        known
    }

    /// The names of things that texts may show beside values.
    pub fn titles(self) -> &'static [&'static str] {
        match self {
            Self::Machine => &["machine", "axes", UNASKED],
            Self::Axis => &[
                "machine", "axis", "group", "partners", OTHERS, "pair", DIFFERS,
            ],
            Self::Group => &["machine", "group", "axes"],
            Self::Door => &["machine", "door", "axes"],
            Self::DoorAxis => &["machine", "door", "axis", "group", "axes"],
            Self::Guarantee => &["machine", "guarantee", "axis", "group"],
        }
    }
}

/// One subject and its values.
#[derive(Debug, Clone)]
pub(super) struct Ground<'a> {
    pub machine: &'a Machine,
    pub axis: Option<&'a Axis>,
    /// The group itself, or that of the axis.
    pub group: Option<&'a Group>,
    pub door: Option<&'a Door>,
    pub guarantee: Option<&'a Guarantee>,
    /// Values by name: also functions, named expressions and `k`.
    pub values: Values,
}

/// The subjects of a machine, those of a kind made once for all entries about them.
pub(super) struct Subjects<'a> {
    machine: &'a Machine,
    made: Vec<(About, Vec<Ground<'a>>)>,
}

impl<'a> Subjects<'a> {
    pub fn of(machine: &'a Machine) -> Self {
        let made = Vec::new();
        Self { machine, made }
    }

    /// Those of a kind, in the order of the machine file.
    pub fn about(&mut self, about: About) -> impl Iterator<Item = &mut Ground<'a>> {
        if !self.made.iter().any(|(kind, _)| *kind == about) {
            self.made.push((about, grounds(self.machine, about)));
        }
        let known = self.made.iter_mut().filter(move |(kind, _)| *kind == about);
        known.flat_map(|(_, list)| list)
    }
}

/// All subjects of a kind, in the order of the machine file.
pub(super) fn grounds<'a>(machine: &'a Machine, about: About) -> Vec<Ground<'a>> {
    let whole = Ground {
        machine,
        axis: None,
        group: None,
        door: None,
        guarantee: None,
        values: common(machine),
    };
    let axes = || machine.axes.iter().zip(&machine.basis.judged.axes);
    let of_axis = |(axis, values): (&'a Axis, &Values)| {
        let partners = i64::try_from(axis.interpolates_with.len()).unwrap_or(i64::MAX);
        let mut ground = Ground {
            axis: Some(axis),
            group: machine.axis_groups.iter().find(|g| g.has(&axis.name)),
            values: values.clone(),
            ..whole.clone()
        };
        ground.set(PATH, partners);
        let groups = machine.axis_groups.iter().zip(&machine.basis.judged.groups);
        let own = groups.into_iter().find(|(group, _)| group.has(&axis.name));
        for (name, _) in &machine.basis.family.group_lets {
            let sum = own.and_then(|(_, values)| values.get(&before(name)).cloned());
            ground.values.insert(before(name), sum.unwrap_or(vec![0]));
        }
        let others = others(machine, axis).count();
        ground.set(OTHERS, i64::try_from(others).unwrap_or(i64::MAX));
        let differs = machine.differences(axis).len();
        ground.set(DIFFERS, i64::try_from(differs).unwrap_or(i64::MAX));
        let paired = machine.paired(axis);
        ground.set(PAIRED, i64::try_from(paired).unwrap_or(i64::MAX));
        ground
    };
    let mut list = Vec::new();
    match about {
        About::Machine => {
            // What axes, groups and doors have is a list here.
            let mut values = machine.basis.judged.machine.clone();
            values.extend(whole.values.clone());
            let mut ground = Ground { values, ..whole };
            let unasked = machine.unasked().len();
            ground.set(UNASKED, i64::try_from(unasked).unwrap_or(i64::MAX));
            list.push(ground);
        }
        About::Axis => list.extend(axes().map(of_axis)),
        About::Group => {
            let groups = machine.axis_groups.iter().zip(&machine.basis.judged.groups);
            list.extend(groups.map(|(group, values)| Ground {
                group: Some(group),
                values: values.clone(),
                ..whole.clone()
            }));
        }
        About::Door => list.extend(machine.doors.iter().map(|door| whole.clone().behind(door))),
        About::DoorAxis => {
            for door in &machine.doors {
                let inside = axes().filter(|(axis, _)| door.has(&axis.name));
                list.extend(inside.map(|pair| of_axis(pair).behind(door)));
            }
        }
        About::Guarantee => {
            for guarantee in &machine.guarantees {
                let mut doors = machine.doors.iter();
                let door = doors.find(|d| Some(&d.name) == guarantee.door.as_ref());
                let named = axes().filter(|(axis, _)| guarantee.has(&axis.name));
                list.extend(named.map(|pair| {
                    let ground = of_axis(pair);
                    let ground = door.into_iter().fold(ground, Ground::behind);
                    ground.asked_by(guarantee)
                }));
            }
        }
    }
    list.iter_mut().for_each(Ground::count);
    list
}

/// The values of the control, and of functions and named expressions the greatest of all axes: whether any has them.
fn common(machine: &Machine) -> Values {
    let family = &machine.basis.family;
    let mut values = Values::new();
    insert(&mut values, &machine.control);
    values.insert(
        "monitoring_cycle".to_owned(),
        vec![machine.monitoring_cycle],
    );
    let functions = family.functions.iter().map(|f| f.variable.as_str());
    let lets = family.lets.iter().map(|(name, _)| name.as_str());
    for name in functions.chain(lets).chain(["enabled_any"]) {
        let mut greatest: Vec<i64> = Vec::new();
        for cells in machine.basis.judged.axes.iter().filter_map(|v| v.get(name)) {
            greatest.resize(greatest.len().max(cells.len()), i64::MIN);
            for (g, cell) in greatest.iter_mut().zip(cells) {
                *g = (*g).max(*cell);
            }
        }
        values.insert(name.to_owned(), greatest);
    }
    values
}

impl<'a> Ground<'a> {
    /// Sets how many doors and groups there are, and which parameters the file gives.
    fn count(&mut self) {
        let doors = self.machine.doors.iter();
        let reached = |door: &&Door| self.members().any(|a| door.has(&a.name));
        let doors = doors.filter(reached).count();
        let groups = match self.axis {
            Some(_) => usize::from(self.group.is_some()),
            None => self.machine.axis_groups.len(),
        };
        let given: Vec<(String, bool)> = self
            .settings()
            .flatten()
            .map(|(name, setting)| (given(name), setting.is_given()))
            .collect();
        let asked: Vec<&Guarantee> = self
            .machine
            .guarantees
            .iter()
            .filter(|g| self.is_asked(g))
            .collect();
        let patterns = self.machine.basis.family.patterns.keys();
        let by_pattern: Vec<(String, usize)> = patterns
            .map(|name| {
                (
                    asked_by(name),
                    asked.iter().filter(|g| g.pattern == *name).count(),
                )
            })
            .collect();
        let after = asked.iter().filter(|g| g.after_fault()).count();
        let programmed = self.machine.basis.logic.is_programmed();
        let asked = asked.len();
        let guarantees = self.machine.guarantees.len();
        let assumed = self
            .machine
            .half_missing()
            .map_or(0, |(_, names)| names.len());
        for (name, n) in [
            (DOORS, doors),
            (GROUPS, groups),
            (GUARANTEES, guarantees),
            (ASKED, asked),
            (ASKED_AFTER_FAULT, after),
            (PROGRAMMED, usize::from(programmed)),
            (HALF_ASSUMED, assumed),
        ] {
            self.set(name, i64::try_from(n).unwrap_or(i64::MAX));
        }
        for (name, n) in by_pattern {
            self.set(&name, i64::try_from(n).unwrap_or(i64::MAX));
        }
        for (name, given) in given {
            self.set(&name, i64::from(given));
        }
    }

    /// Whether a guarantee is about it: it has the axis, and is about the door or about none.
    fn is_asked(&self, guarantee: &Guarantee) -> bool {
        let door = self
            .door
            .is_none_or(|d| guarantee.door.as_ref() == Some(&d.name));
        door && self.axis.is_none_or(|axis| guarantee.has(&axis.name))
    }

    fn behind(mut self, door: &'a Door) -> Self {
        insert(&mut self.values, &door.values);
        self.door = Some(door);
        self
    }

    fn asked_by(mut self, guarantee: &'a Guarantee) -> Self {
        insert(&mut self.values, &guarantee.values);
        self.guarantee = Some(guarantee);
        self
    }

    /// Sets `k` (from 0) and `n` (from 1).
    pub fn count_to(&mut self, k: i64) {
        self.set("k", k);
        self.set("n", k + 1);
    }

    /// Gives a name a value.
    pub fn set(&mut self, name: &str, value: i64) {
        self.values.insert(name.to_owned(), vec![value]);
    }

    /// Linear where there is no axis.
    pub fn kind(&self) -> AxisKind {
        self.axis.map_or(AxisKind::Linear, |a| a.kind)
    }

    /// Evaluates an expression of `file`.
    ///
    /// # Errors
    /// It has no value here, which is a fault of the family's data.
    pub fn value(&self, file: &DataFile, formula: &Formula) -> Result<i64> {
        self.eval(file, &formula.expr, formula.text.span())
    }

    /// [`Self::value`] of a formula that may be missing.
    ///
    /// # Errors
    /// As [`Self::value`].
    pub fn optional(&self, file: &DataFile, formula: &Option<Formula>) -> Result<Option<i64>> {
        let formula = formula.as_ref();
        formula.map(|f| self.value(file, f)).transpose()
    }

    /// [`Self::value`] of a part of the text at `span`.
    ///
    /// # Errors
    /// As [`Self::value`].
    pub fn eval(&self, file: &DataFile, expr: &Expr, span: super::Place) -> Result<i64> {
        eval(expr, &self.values, self.machine.monitoring_cycle).map_err(|message| {
            let message = format!("this expression cannot be evaluated: {message}");
            Diagnostic::new(&file.file, &file.source, Some(span), message)
                .help("this is an error of the family's data, not of the machine file")
                .into()
        })
    }

    /// A name that texts may show: of the machine, the axis, the door, or the axes behind it.
    pub fn title(&self, name: &str) -> Option<String> {
        match name {
            "machine" => Some(self.machine.name.clone()),
            "axis" => self.axis.map(|a| a.name.clone()),
            "group" => self.group.map(|g| g.name.clone()),
            "door" => self.door.map(|d| d.name.clone()),
            "guarantee" => self.guarantee.map(|g| g.name.clone()),
            UNASKED => Some(self.machine.unasked().join(", ")),
            "partners" => self.axis.map(partners),
            "pair" => Some(self.axis?.pair.as_ref()?.get_ref().clone()),
            DIFFERS => Some(self.machine.differences(self.axis?).join(", ")),
            OTHERS => {
                let names: Vec<&str> = others(self.machine, self.axis?).collect();
                Some(names.join(", "))
            }
            "axes" => {
                let names: Vec<&str> = self.members().map(|a| a.name.as_str()).collect();
                Some(names.join(", "))
            }
            _ => None,
        }
    }

    /// The axis, the axes of the group or behind the door, or all of them.
    pub fn members(&self) -> impl Iterator<Item = &'a Axis> {
        let (machine, axis, group, door) = (self.machine, self.axis, self.group, self.door);
        machine.axes.iter().filter(move |a| match (axis, door) {
            (Some(axis), _) => axis.name == a.name,
            (None, Some(door)) => door.has(&a.name),
            (None, None) => group.is_none_or(|g| g.has(&a.name)),
        })
    }

    /// The values of parameters that can be read here: of the guarantee, the door, the axis, the group, the control.
    pub fn settings(&self) -> impl Iterator<Item = &'a Settings> {
        let guarantee = self.guarantee.map(|g| &g.values);
        let door = self.door.map(|d| &d.values);
        let axis = self.axis.map(|a| &a.values);
        let group = self.group.map(|g| &g.values);
        let control = &self.machine.control;
        let own = guarantee.into_iter().chain(door);
        own.chain(axis).chain(group).chain([control])
    }

    /// The value of a parameter as its user writes it; that of an axis, where there are several, for each that has it.
    pub fn shown(&self, name: &str, index: usize) -> Option<String> {
        let plain = |text: &String| text.replace('"', "");
        if let Some(setting) = self.settings().find_map(|s| s.get(name)) {
            return setting.shown.get(index).map(plain);
        }
        if self.axis.is_some() {
            return None;
        }
        let of_member = |a: &Axis| {
            let shown = a.values.get(name)?.shown.get(index).map(plain)?;
            Some(format!("{} {shown}", a.name))
        };
        let all: Vec<String> = self.members().filter_map(of_member).collect();
        (!all.is_empty()).then(|| all.join(", "))
    }

    /// All elements of an array by name: `VELO_OVR_FACTOR[3]` and `80 %`. Nothing for what is no array.
    pub fn elements(&self, name: &str) -> Vec<(String, String)> {
        let setting = self.settings().find_map(|s| s.get(name));
        let shown = setting.map_or(&[][..], |s| s.shown.as_slice());
        let entry = |(k, value): (usize, &String)| (format!("{name}[{k}]"), value.replace('"', ""));
        match shown {
            [_] => Vec::new(),
            all => all.iter().enumerate().map(entry).collect(),
        }
    }

    /// Whether a function is enabled, as a dependence of a test: on the axis, or on which axes.
    pub fn enabled(&self, function: &str) -> (String, String) {
        let has = |axis: &&Axis| axis.has(function);
        let value = match self.axis {
            Some(axis) if has(&axis) => "enabled".to_owned(),
            Some(_) => "not enabled".to_owned(),
            None => {
                let with = self.machine.axes.iter().filter(has);
                let with: Vec<&str> = with.map(|a| a.name.as_str()).collect();
                with.join(", ")
            }
        };
        (format!("function {function}"), value)
    }

    /// A number as a value of this quantity.
    pub fn quantity(&self, quantity: Quantity, value: i64) -> String {
        quantity.dimension(self.kind()).show(value)
    }

    /// The parameters that an expression reads, with their values: `STOP_SWITCH_TIME_C` and `300 ms`.
    pub fn reads(&self, expr: &Expr) -> BTreeMap<String, String> {
        let mut list = BTreeMap::new();
        self.collect(expr, &mut list);
        list
    }

    fn collect(&self, expr: &Expr, list: &mut BTreeMap<String, String>) {
        match &expr.kind {
            Kind::Name(name) if self.elements(name).is_empty() => {
                list.extend(self.shown(name, 0).map(|value| (name.clone(), value)));
            }
            Kind::Index(base, index) => {
                let k = eval(index, &self.values, 1).ok();
                let k = k.and_then(|k| usize::try_from(k).ok());
                if let (Kind::Name(name), Some(k)) = (&base.kind, k) {
                    let shown = self.shown(name, k);
                    list.extend(shown.map(|value| (format!("{name}[{k}]"), value)));
                }
            }
            Kind::Unary(_, a) => self.collect(a, list),
            Kind::Binary(_, a, b) => {
                self.collect(a, list);
                self.collect(b, list);
            }
            Kind::Call(_, args) => args.iter().for_each(|a| self.collect(a, list)),
            _ => {}
        }
    }
}

/// The axes that an axis moves with on one path.
pub(super) fn partners(axis: &Axis) -> String {
    let names = axis.interpolates_with.iter().map(|n| n.get_ref().as_str());
    names.collect::<Vec<_>>().join(", ")
}

/// The axes that do not move on one path with an axis.
fn others<'a>(machine: &'a Machine, axis: &'a Axis) -> impl Iterator<Item = &'a str> {
    let with = |a: &Axis, b: &Axis| a.interpolates_with.iter().any(|n| *n.get_ref() == b.name);
    let others = machine.axes.iter();
    let others = others
        .filter(move |other| other.name != axis.name && !with(axis, other) && !with(other, axis));
    others.map(|other| other.name.as_str())
}

/// The names that an expression reads.
pub(super) fn read_names(expr: &Expr) -> Vec<String> {
    let mut list = Vec::new();
    names(expr, &mut |name| list.push(name.to_owned()));
    list
}

/// The names that decide the value of an expression with these values: of `SEL` the condition and what it selects.
pub(super) fn read_with(expr: &Expr, values: &Values, cycle: i64) -> Vec<String> {
    let mut list = Vec::new();
    deciding(expr, values, cycle, &mut |name| list.push(name.to_owned()));
    list
}
