//! Guarantees: what a machine file says must be true of this machine, by patterns of its family.
//!
//! The patterns stand in `<family>/guarantees.toml`. Each has a text, arguments with units, and the systems that decide it, bound to
//! the values of the axis, of the door and of the guarantee itself.

use std::collections::BTreeMap;
use std::path::Path;

use indexmap::IndexMap;
use serde::Deserialize;
use toml::Spanned;

use super::eval::Values;
use super::explore_file::{ExploreData, Shares};
use super::family::{Explore, Family, Formula, Known, Param, Quantity, Rule};
use super::family_file::{Check, ParamData, RuleData};
use super::ground::{About as Subjects, DataFile, grounds, read_with};
use super::own::Own;
use super::plausible::{Judged, evaluate, insert};
use super::runs::Parts;
use super::template::filled;
use super::uses::{of_system, of_wires};
use super::whole::before;
use super::{Machine, Place, Settings};
use stillpoint_lang::diag::Result;
use stillpoint_lang::syntax::ast::Expr;

/// The file of the patterns in the folder of a family.
pub(super) const FILE: &str = "guarantees.toml";

/// The argument that tells what may have failed before; 0 is nothing.
const AFTER: &str = "after";

/// The argument with the time of a property of the machine file.
pub(super) const WITHIN: &str = "within";

/// In the expressions of patterns: whether the machine file has a program whose signals its values connect.
const PROGRAMMED: &str = "programmed";

/// In the expressions of patterns: whether the run is made with the half of the program in the PLC alone.
pub(super) const HALF: &str = "half";

/// What a machine file asks of its machine.
#[derive(Debug, Clone)]
pub struct Guarantee {
    /// Its name in the file.
    pub name: String,
    /// The pattern of the family.
    pub pattern: String,
    /// The door that it is about.
    pub door: Option<String>,
    /// The axes that it is about, all of one kind.
    pub axes: Vec<Spanned<String>>,
    /// What it asks of the safe logic in words of its own.
    pub own: Option<Own>,
    /// A value for every argument of the pattern.
    pub values: Settings,
    /// What is guaranteed, with these values.
    pub text: String,
    /// Where the pattern comes from.
    pub source: String,
    /// Where it stands in the file.
    pub place: Place,
}

/// A pattern of guarantees.
#[derive(Debug)]
pub(super) struct Pattern {
    /// What it is about beside axes.
    pub about: About,
    /// With `{door}`, `{axes}` and the arguments. What stands in brackets is told only where the file gives one of the arguments in it.
    pub text: String,
    pub source: String,
    pub arguments: IndexMap<String, Param>,
    /// The arguments without a default.
    pub required: Vec<String>,
    /// Whether it is about a program of the machine file.
    pub needs_program: bool,
    /// Parameters that count only after a fault.
    pub of_faults: Vec<String>,
    /// What must not be said of such a guarantee.
    pub rules: Vec<Rule>,
    pub explore: Vec<Explore>,
}

/// What a guarantee names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum About {
    /// Axes.
    Axis,
    /// A door, and axes behind it: all of them, where it names none.
    Door,
    /// The safe logic alone: the file says what is looked at and what must be true.
    Logic,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    fault: IndexMap<String, FaultData>,
    /// Parameters that count only after a fault.
    #[serde(default)]
    of_faults: Vec<String>,
    #[serde(default)]
    argument: IndexMap<Spanned<String>, ParamData>,
    /// What several `explore` entries bind alike.
    #[serde(default)]
    share: Shares,
    #[serde(default)]
    pattern: IndexMap<String, PatternData>,
}

/// A class of single faults.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FaultData {
    text: String,
    /// Whether it may take one half of the safe logic, so that the other one must do by itself what is guaranteed.
    #[serde(default)]
    takes_half: bool,
    #[serde(deserialize_with = "stillpoint_lang::catalogue::once")]
    #[allow(dead_code)] // where it comes from, for readers of the data
    id: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PatternData {
    about: About,
    text: Spanned<String>,
    source: String,
    #[serde(default)]
    required: Vec<Spanned<String>>,
    #[serde(default)]
    needs_program: bool,
    #[serde(default)]
    plausibility: Vec<RuleData>,
    explore: Vec<ExploreData>,
}

/// A class of single faults.
#[derive(Debug, Clone)]
pub(super) struct Fault {
    /// What fails, in words.
    pub text: String,
    /// Whether it may take one half of the safe logic.
    pub takes_half: bool,
}

/// The patterns of a family, and its classes of single faults.
type Patterns = (IndexMap<String, Pattern>, IndexMap<String, Fault>);

/// Reads the patterns of a family; a family without the file has none.
///
/// # Errors
/// Everything in the file that is not as described here.
pub(super) fn load(
    folder: &Path,
    known: &Known,
    group_lets: &[(String, Formula)],
) -> Result<Patterns> {
    if !stillpoint_lang::files::is_file(&folder.join(FILE)) {
        return Ok(Patterns::default());
    }
    let file = DataFile::read(folder, FILE, "guarantees")?;
    let data: File = file.parse()?;
    let mut check = file.check();
    check.signals = known.signals.clone();
    check.faults = data.fault.keys().cloned().collect();
    let places: Vec<Place> = data.argument.keys().map(Spanned::span).collect();
    let argument = data.argument.into_iter();
    let argument = argument.map(|(name, data)| (name.into_inner(), data));
    let arguments = check.params(argument.collect());
    let context = Context {
        arguments: &arguments,
        known,
        group_lets,
        of_faults: &data.of_faults,
    };
    let mut patterns = IndexMap::new();
    let explored = || data.pattern.values().flat_map(|pattern| &pattern.explore);
    for name in data.share.keys() {
        if !explored().any(|explore| explore.takes(name.get_ref())) {
            let message = format!("nothing takes what is shared as '{}'", name.get_ref());
            let help = "name it in share = [...] of an explore, or remove it";
            check.findings.add(name.span(), message, "", help);
        }
    }
    for (name, mut entry) in data.pattern {
        for explore in &mut entry.explore {
            check.share(explore, &data.share);
        }
        let pattern = context.pattern(&mut check, entry);
        patterns.insert(name, pattern);
    }
    for (name, place) in arguments.keys().zip(places) {
        if !patterns.values().any(|p| p.arguments.contains_key(name)) {
            let message = format!("no pattern tells '{name}'");
            let help = format!("put {{{name}}} into the text of a pattern, or remove it");
            check.findings.add(place, message, "", help);
        }
    }
    let faults = data.fault.into_iter();
    let faults = faults.map(|(name, fault)| {
        let FaultData {
            text, takes_half, ..
        } = fault;
        (name, Fault { text, takes_half })
    });
    let faults = faults.collect();
    check.findings.finish((patterns, faults))
}

/// What patterns may name.
struct Context<'a> {
    arguments: &'a IndexMap<String, Param>,
    known: &'a Known,
    group_lets: &'a [(String, Formula)],
    of_faults: &'a [String],
}

impl Context<'_> {
    fn pattern(&self, check: &mut Check, data: PatternData) -> Pattern {
        let arguments = self.told(check, &data.text, data.about);
        let mut names = match data.about {
            About::Axis | About::Logic => self.known.axis.clone(),
            About::Door => self.known.door.clone(),
        };
        names.extend(arguments.keys().cloned());
        let lets = self.group_lets.iter();
        names.extend(lets.flat_map(|(name, _)| [name.clone(), before(name)]));
        names.extend([PROGRAMMED, HALF].map(str::to_owned));
        let mut roundings = self.known.roundings.clone();
        let times = arguments
            .iter()
            .filter(|(_, a)| a.quantity == Quantity::Time);
        roundings.extend(times.map(|(name, a)| (name.clone(), vec![a.cycles])));
        let known = Known {
            axis: names,
            roundings,
            signals: self.known.signals.clone(),
            ..Known::default()
        };
        for name in &data.required {
            if !arguments.contains_key(name.get_ref()) {
                let message = format!("'{}' is no argument here", name.get_ref());
                let help = "name one of the places of the text";
                check.findings.add(name.span(), message, "", help);
            }
        }
        let rules = data.plausibility.into_iter();
        let rules = rules.filter_map(|rule| check.rule(rule, &known)).collect();
        Pattern {
            about: data.about,
            text: data.text.into_inner(),
            source: data.source,
            required: data.required.into_iter().map(Spanned::into_inner).collect(),
            needs_program: data.needs_program,
            of_faults: self.of_faults.to_vec(),
            rules,
            explore: check.explores(data.explore, &known),
            arguments,
        }
    }

    /// The arguments of a pattern are what its text tells: each place of it must be one that can be filled in.
    fn told(
        &self,
        check: &mut Check,
        text: &Spanned<String>,
        about: About,
    ) -> IndexMap<String, Param> {
        let mut told = IndexMap::new();
        let place = |place: &str| {
            match self.arguments.get_key_value(place) {
                Some((name, argument)) => {
                    told.insert(name.clone(), argument.clone());
                }
                None if about == About::Logic && (place == "when" || place == "then") => {}
                None if place == "axes" || (place == "door" && about == About::Door) => {}
                None => {
                    let known: Vec<&str> = self.arguments.keys().map(String::as_str).collect();
                    let message = format!("nothing is called '{place}' here");
                    let help = format!(
                        "places: axes, door where it is about one, {}",
                        known.join(", ")
                    );
                    check.findings.add(text.span(), message, "", help);
                }
            }
            Some(String::new())
        };
        // Every place is looked at; there is no text yet.
        let _ = filled(text.get_ref(), place);
        told
    }
}

impl Pattern {
    /// What is guaranteed, in words.
    pub fn told(
        &self,
        door: Option<&str>,
        axes: &[Spanned<String>],
        own: Option<&Own>,
        values: &Settings,
    ) -> String {
        let axes: Vec<&str> = axes.iter().map(|a| a.get_ref().as_str()).collect();
        let place = |name: &str| {
            Some(match (name, values.get(name)) {
                ("when", _) => own.map_or("", |own| &own.when.text).to_owned(),
                ("then", _) => own.map_or("", |own| &own.then.text).to_owned(),
                ("axes", _) => axes.join(", "),
                ("door", _) => door.unwrap_or_default().to_owned(),
                (_, Some(setting)) => setting.shown.join(", ").replace('"', ""),
                // An argument for other kinds of axes.
                (_, None) => format!("{{{name}}}"),
            })
        };
        let given = |name: &str| values.get(name).is_some_and(|s| !s.places.is_empty());
        filled(&without_defaults(&self.text, given), place).unwrap_or_default()
    }
}

/// A text without its brackets, and without the parts in them that have no place of which `given` is true.
fn without_defaults(text: &str, given: impl Fn(&str) -> bool) -> String {
    let mut told = String::new();
    let mut rest = text;
    while let Some((plain, after)) = rest.split_once('[') {
        let (part, tail) = after.split_once(']').unwrap_or((after, ""));
        let mut counts = false;
        let _ = filled(part, |name| {
            counts |= given(name);
            Some(String::new())
        });
        told.push_str(plain);
        told.push_str(if counts { part } else { "" });
        rest = tail;
    }
    told + rest
}

impl Guarantee {
    /// Whether it must hold after a fault too.
    pub fn after_fault(&self) -> bool {
        let after = self.values.get(AFTER);
        after.is_some_and(|setting| setting.cells.iter().any(|cell| *cell != 0))
    }

    /// Whether it is about this axis.
    pub fn has(&self, axis: &str) -> bool {
        self.axes.iter().any(|name| name.get_ref() == axis)
    }
}

impl Machine {
    /// What a guarantee depends on for one of its axes: parameters with their values, functions with whether they are enabled.
    pub fn depends(&self, guarantee: &Guarantee, axis: &str) -> IndexMap<String, String> {
        let family = &self.basis.family;
        let Some(pattern) = family.patterns.get(&guarantee.pattern) else {
            return IndexMap::new();
        };
        let subjects = match pattern.about {
            About::Axis | About::Logic => Subjects::Axis,
            About::Door => Subjects::DoorAxis,
        };
        let all = grounds(self, subjects);
        let ground = all.iter().find(|ground| {
            ground.axis.is_some_and(|a| a.name == axis)
                && ground.door.map(|d| &d.name) == guarantee.door.as_ref()
        });
        let Some(ground) = ground else {
            return IndexMap::new();
        };
        let programmed = self.basis.logic.is_programmed();
        let wires = pattern.explore.iter().filter(|_| programmed);
        let names = wires.flat_map(of_wires);
        let mut values = ground.values.clone();
        insert(&mut values, &guarantee.values);
        let cycle = self.basis.judged.cycle;
        let read = |expr: &Expr| read_with(expr, &values, cycle);
        let names: Vec<String> = names
            .chain(pattern.explore.iter().flat_map(|e| of_system(e, &read)))
            .collect();
        let groups = grounds(self, Subjects::Group);
        let group = groups
            .iter()
            .find(|g| g.group.map(|g| &g.name) == ground.group.map(|g| &g.name));
        let value = |name: String| {
            let counts = guarantee.after_fault() || !pattern.of_faults.contains(&name);
            if guarantee.values.contains_key(&name) || !counts {
                return None;
            }
            let function = family.functions.iter().find(|f| f.variable == name);
            if let Some(function) = function {
                return Some(ground.enabled(&function.name));
            }
            let setting = ground.settings().find_map(|s| s.get(&name))?;
            Some((name, setting.shown.join(", ").replace('"', "")))
        };
        // What a group has from its axes depends on each of them.
        let (whole, own): (Vec<String>, Vec<String>) = (names.into_iter())
            .partition(|name| family.group_lets.iter().any(|(known, _)| known == name));
        let of_group = family.resolved(whole).into_iter();
        let of_group = of_group.filter_map(|name| Some((name.clone(), group?.shown(&name, 0)?)));
        let own = family.resolved_by(own, &read).into_iter().filter_map(value);
        own.chain(of_group).collect()
    }
}

/// Values of one axis for one guarantee.
#[derive(Clone)]
pub(super) struct Asked<'a> {
    pub guarantee: &'a Guarantee,
    pub axis: &'a str,
    /// Its place in the file, from 1.
    pub number: i64,
    pub values: Values,
    pub pattern: &'a Pattern,
}

/// Every axis of every guarantee with its values, in the order of the file.
pub(super) fn asked<'a>(
    family: &'a Family,
    guarantees: &'a [Guarantee],
    parts: Parts<'a>,
    judged: &Judged,
    programmed: bool,
) -> Result<Vec<Asked<'a>>> {
    let mut list = Vec::new();
    let values: BTreeMap<&str, &Values> = (parts.axes.iter().zip(&judged.axes))
        .map(|(axis, values)| (axis.name.as_str(), values))
        .collect();
    for guarantee in guarantees {
        let door = parts
            .doors
            .iter()
            .find(|d| Some(&d.name) == guarantee.door.as_ref());
        let Some(pattern) = family.patterns.get(&guarantee.pattern) else {
            continue;
        };
        // What is asked of the logic has the values of the control, which each axis has.
        let any = parts.axes.first().map(|axis| axis.name.as_str());
        let of_logic = any.filter(|_| pattern.about == About::Logic);
        let named = guarantee.axes.iter().map(|axis| axis.get_ref().as_str());
        for axis in named.chain(of_logic) {
            let Some(values) = values.get(axis) else {
                continue;
            };
            let mut values = (*values).clone();
            let group = parts.groups.iter().zip(&judged.groups);
            let group = group.into_iter().find(|(group, _)| group.has(axis));
            for (name, formula) in &family.group_lets {
                // An axis in no group stops alone.
                let value = match group.and_then(|(_, values)| values.get(name)) {
                    Some(value) => value.clone(),
                    None => vec![evaluate(family, formula, &values, judged.cycle)?],
                };
                values.insert(name.clone(), value);
                let sum = group.and_then(|(_, values)| values.get(&before(name)).cloned());
                values.insert(before(name), sum.unwrap_or(vec![0]));
            }
            if let Some(door) = door {
                insert(&mut values, &door.values);
            }
            insert(&mut values, &guarantee.values);
            values.insert(PROGRAMMED.to_owned(), vec![i64::from(programmed)]);
            values.insert(HALF.to_owned(), vec![0]);
            let number = parts.axes.iter().zip(1..);
            let number = number.into_iter().find(|(known, _)| known.name == axis);
            list.push(Asked {
                guarantee,
                axis,
                number: number.map_or(1, |(_, number)| number),
                values,
                pattern,
            });
        }
    }
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::without_defaults;

    #[test]
    fn a_part_is_told_where_the_file_gives_a_value_in_it() {
        let text = "open[ in {mode}], {axes}[; {signal} and {way}]";
        let told = |names: &[&str]| without_defaults(text, |name| names.contains(&name));
        assert_eq!(told(&[]), "open, {axes}");
        assert_eq!(told(&["mode"]), "open in {mode}, {axes}");
        assert_eq!(told(&["way"]), "open, {axes}; {signal} and {way}");
    }
}
