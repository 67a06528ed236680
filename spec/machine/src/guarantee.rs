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
use super::family::{Explore, Family, Known, Param, Quantity};
use super::family_file::{Check, ExploreData, ParamData};
use super::ground::DataFile;
use super::plausible::{Judged, insert};
use super::runs::Parts;
use super::{Place, Settings};
use stillpoint_lang::diag::Result;

/// The file of the patterns in the folder of a family.
pub(super) const FILE: &str = "guarantees.toml";

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
    /// With `{door}`, `{axes}` and the arguments.
    pub text: String,
    pub source: String,
    pub arguments: IndexMap<String, Param>,
    /// The arguments without a default.
    pub required: Vec<String>,
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
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    pattern: IndexMap<String, PatternData>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PatternData {
    about: About,
    text: String,
    source: String,
    #[serde(default)]
    argument: IndexMap<String, ParamData>,
    #[serde(default)]
    required: Vec<Spanned<String>>,
    explore: Vec<ExploreData>,
}

/// Reads the patterns of a family; a family without the file has none.
///
/// # Errors
/// Everything in the file that is not as described here.
pub(super) fn load(folder: &Path, known: &Known) -> Result<IndexMap<String, Pattern>> {
    if !stillpoint_lang::files::is_file(&folder.join(FILE)) {
        return Ok(IndexMap::new());
    }
    let file = DataFile::read(folder, FILE, "guarantees")?;
    let data: File = file.parse()?;
    let mut check = file.check();
    let mut patterns = IndexMap::new();
    for (name, data) in data.pattern {
        let pattern = pattern(&mut check, data, known);
        patterns.insert(name, pattern);
    }
    check.findings.finish(patterns)
}

fn pattern(check: &mut Check, data: PatternData, known: &Known) -> Pattern {
    let arguments = check.params(data.argument);
    let mut names = match data.about {
        About::Axis => known.axis.clone(),
        About::Door => known.door.clone(),
    };
    names.extend(arguments.keys().cloned());
    let mut roundings = known.roundings.clone();
    let times = arguments
        .iter()
        .filter(|(_, a)| a.quantity == Quantity::Time);
    roundings.extend(times.map(|(name, a)| (name.clone(), vec![a.cycles])));
    let known = Known {
        axis: names,
        roundings,
        ..Known::default()
    };
    for name in &data.required {
        if !arguments.contains_key(name.get_ref()) {
            let message = format!("'{}' is no argument here", name.get_ref());
            let help = "name one of the keys of argument";
            check.findings.add(name.span(), message, "", help);
        }
    }
    let explore = data.explore.into_iter();
    Pattern {
        about: data.about,
        text: data.text,
        source: data.source,
        required: data.required.into_iter().map(Spanned::into_inner).collect(),
        explore: explore.filter_map(|e| check.explore(e, &known)).collect(),
        arguments,
    }
}

impl Pattern {
    /// What is guaranteed, in words.
    pub fn told(&self, door: Option<&str>, axes: &[Spanned<String>], values: &Settings) -> String {
        let axes: Vec<&str> = axes.iter().map(|a| a.get_ref().as_str()).collect();
        let mut text = self.text.replace("{axes}", &axes.join(", "));
        text = text.replace("{door}", door.unwrap_or_default());
        for (name, setting) in values {
            let shown = setting.shown.join(", ").replace('"', "");
            text = text.replace(&format!("{{{name}}}"), &shown);
        }
        text
    }
}

/// Values of one axis for one guarantee.
pub(super) struct Asked<'a> {
    pub guarantee: &'a Guarantee,
    pub axis: &'a str,
    pub values: Values,
    pub pattern: &'a Pattern,
}

/// Every axis of every guarantee with its values, in the order of the file.
pub(super) fn asked<'a>(
    family: &'a Family,
    guarantees: &'a [Guarantee],
    parts: Parts<'a>,
    judged: &Judged,
) -> Vec<Asked<'a>> {
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
        for axis in &guarantee.axes {
            let axis = axis.get_ref().as_str();
            let Some(values) = values.get(axis) else {
                continue;
            };
            let mut values = (*values).clone();
            if let Some(door) = door {
                insert(&mut values, &door.values);
            }
            insert(&mut values, &guarantee.values);
            list.push(Asked {
                guarantee,
                axis,
                values,
                pattern,
            });
        }
    }
    list
}
