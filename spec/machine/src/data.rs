//! The data of a family for readers: what its machine files may say.

use std::path::Path;

use super::AxisKind;
use super::family::{Explore, Param, Quantity};
use super::family_file;
use super::guarantee::About;
use stillpoint_lang::diag::Result;

/// What machine files of a family may say.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FamilyData {
    /// The family in words.
    pub title: String,
    /// The functions that can be enabled for an axis.
    pub functions: Vec<Enabled>,
    /// The parameters of the control, of an axis, of a group and of a door, in the order of the data.
    pub parameters: Vec<Datum>,
    /// What a guarantee may say, in the order of its patterns, each once.
    pub arguments: Vec<Datum>,
    /// The patterns of guarantees, in the order of the data.
    pub patterns: Vec<Told>,
}

/// A pattern of guarantees.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Told {
    /// Its name in a machine file.
    pub name: String,
    /// What is guaranteed, with the names of its arguments in braces.
    pub text: String,
    /// Where it comes from.
    pub source: String,
    /// The arguments without a default.
    pub required: Vec<String>,
    /// The other ones.
    pub optional: Vec<String>,
}

/// A function that can be enabled for an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Enabled {
    /// Its name in a machine file.
    pub name: String,
    /// What it is.
    pub text: String,
    /// Requirement ids.
    pub ids: Vec<String>,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Datum {
    /// Its name in a machine file.
    pub name: String,
    /// Where it stands there: `control`, `axis`, `group`, `door` or `guarantee`.
    pub table: &'static str,
    /// The manual's names; empty for what is no machine datum.
    pub manual: String,
    /// What it is, in a few words.
    pub text: String,
    /// What the values of an array are: `SG1 to SG4`; empty for a single value.
    pub elements: String,
    /// The kinds of axes that have it; empty: all.
    pub kinds: Vec<String>,
    /// Range and default on a linear axis.
    pub linear: Allowed,
    /// Range and default on a rotary axis, where they are other ones.
    pub rotary: Option<Allowed>,
    /// Requirement ids.
    pub ids: Vec<String>,
}

/// The allowed values of a parameter, with units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Allowed {
    /// The units that a value may have: `mm, um or inch`; empty for numbers, choices and names.
    pub units: String,
    /// The range, or the names of the choices.
    pub range: String,
    /// The value where a machine file gives none.
    pub default: String,
}

/// The systems that the machines of the family in `folder` are checked with, whatever they guarantee, explored or asked of the proof engines:
/// the specification file and the system's name in it.
///
/// # Errors
/// Everything that is wrong in its `family.toml`.
pub fn explored(folder: &Path) -> Result<Vec<(String, String)>> {
    let family = family_file::load(folder)?;
    let pair = |explore: &Explore| (explore.file.clone(), explore.system.clone());
    let all = family.explore.iter().chain(&family.products);
    Ok(all.map(pair).collect())
}

/// Reads the data of the family in `folder`.
///
/// # Errors
/// Everything that is wrong in its `family.toml`.
pub fn load(folder: &Path) -> Result<FamilyData> {
    let family = family_file::load(folder)?;
    let tables = [
        ("control", Some(&family.control)),
        ("axis", Some(&family.axis)),
        ("group", family.group.as_ref()),
        ("door", Some(&family.door)),
    ];
    let tables = tables.into_iter();
    let tables = tables.filter_map(|(table, params)| Some((table, params?)));
    let parameters = tables.flat_map(|(table, params)| {
        let datum = move |(name, param): (&String, &Param)| datum(name, table, param);
        params.iter().map(datum)
    });
    let mut arguments: Vec<Datum> = Vec::new();
    for (name, param) in family.patterns.values().flat_map(|p| &p.arguments) {
        if !arguments.iter().any(|known| known.name == *name) {
            arguments.push(datum(name, "guarantee", param));
        }
    }
    let patterns = family.patterns.iter().map(|(name, pattern)| {
        let needed = |argument: &&String| pattern.required.contains(argument);
        let all = pattern.arguments.keys();
        let (required, optional) = all.partition::<Vec<_>, _>(needed);
        let (first, then): (&[&str], &[&str]) = match pattern.about {
            About::Axis => (&["axes"], &[]),
            About::Door => (&["door"], &["axes"]),
            About::Logic => (&["when", "then"], &[]),
        };
        let told = |keys: &[&str], arguments: Vec<&String>| {
            let arguments = arguments.into_iter().map(String::as_str);
            let all = keys.iter().copied().chain(arguments);
            all.map(str::to_owned).collect()
        };
        Told {
            name: name.clone(),
            text: pattern.text.clone(),
            source: pattern.source.clone(),
            required: told(first, required),
            optional: told(then, optional),
        }
    });
    Ok(FamilyData {
        parameters: parameters.collect(),
        arguments,
        patterns: patterns.collect(),
        functions: (family.functions.iter())
            .map(|f| Enabled {
                name: f.name.clone(),
                text: f.text.clone(),
                ids: f.id.clone(),
            })
            .collect(),
        title: family.title,
    })
}

fn datum(name: &str, table: &'static str, param: &Param) -> Datum {
    let linear = allowed(param, AxisKind::Linear);
    let rotary = allowed(param, AxisKind::Rotary);
    Datum {
        name: name.to_owned(),
        table,
        manual: param.manual.clone(),
        text: param.text.clone(),
        elements: param.elements.clone(),
        kinds: param.kinds.clone(),
        rotary: (rotary != linear).then_some(rotary),
        linear,
        ids: param.id.clone(),
    }
}

fn allowed(param: &Param, kind: AxisKind) -> Allowed {
    let limits = param.limits(kind);
    let range = match param.quantity {
        Quantity::Bool => "true, false".to_owned(),
        Quantity::Groups => "names of groups".to_owned(),
        Quantity::Signal => param.names(),
        Quantity::Choice => {
            let names = param.choices.iter().map(|(name, _)| format!("\"{name}\""));
            names.collect::<Vec<_>>().join(", ")
        }
        _ => format!(
            "{} to {}",
            param.show(limits.min, kind),
            param.show(limits.max, kind)
        ),
    };
    Allowed {
        units: param.quantity.dimension(kind).unit_list(),
        range,
        default: param.show(limits.default, kind),
    }
}
