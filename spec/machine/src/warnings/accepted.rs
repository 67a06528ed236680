//! What a machine file accepts of the warnings, with its reasons.

use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use toml::Spanned;

use super::Warning;
use crate::Machine;
use crate::document::Findings;
use crate::ground::Ground;
use stillpoint_lang::diag::{Result, nearest, position};
use stillpoint_lang::toml_error;

/// The warning about an acceptance that nothing needs.
const WITHOUT_EFFECT: &str = "accepted-without-effect";

/// A machine file as far as it accepts warnings.
#[derive(Deserialize)]
struct File {
    #[serde(default)]
    accepted: Vec<Spanned<Entry>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    warning: Spanned<String>,
    reason: Spanned<String>,
    /// Only for this axis, group, door or guarantee; without any of them wherever the warning comes up.
    axis: Option<Spanned<String>>,
    group: Option<Spanned<String>>,
    door: Option<Spanned<String>>,
    guarantee: Option<Spanned<String>>,
}

/// The acceptances, each with whether it was needed.
pub(super) struct Accepted(Vec<(Entry, bool)>);

impl Accepted {
    /// Reads `[[accepted]]`; `known` are the warnings of the family.
    ///
    /// # Errors
    /// Unknown warnings, axes, groups, doors and guarantees; an empty reason.
    pub fn read(path: &Path, source: &Arc<str>, machine: &Machine, known: &[&str]) -> Result<Self> {
        let file = path.display().to_string();
        let tables: File = toml::from_str(source).map_err(|e| toml_error(&file, source, &e))?;
        let mut findings = Findings::new(&file, source);
        let axes: Vec<&str> = machine.axes.iter().map(|a| a.name.as_str()).collect();
        let groups: Vec<&str> = (machine.axis_groups.iter())
            .map(|g| g.name.as_str())
            .collect();
        let doors: Vec<&str> = machine.doors.iter().map(|d| d.name.as_str()).collect();
        let guarantees = machine.guarantees.iter();
        let guarantees: Vec<&str> = guarantees.map(|g| g.name.as_str()).collect();
        let mut list = Vec::new();
        for entry in tables.accepted {
            let entry = entry.into_inner();
            let mut exists = |what: &str, name: Option<&Spanned<String>>, known: &[&str]| {
                let Some(name) = name else { return };
                let word = name.get_ref().as_str();
                if known.contains(&word) {
                    return;
                }
                let help = match nearest(word, known.iter().copied()) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None if known.is_empty() => "remove it: the machine has none".to_owned(),
                    None => format!("known: {}", known.join(", ")),
                };
                let message = format!("there is no {what} \"{word}\"");
                findings.add(name.span(), message, format!("no such {what}"), help);
            };
            exists("warning", Some(&entry.warning), known);
            exists("axis", entry.axis.as_ref(), &axes);
            exists("group", entry.group.as_ref(), &groups);
            exists("door", entry.door.as_ref(), &doors);
            exists("guarantee", entry.guarantee.as_ref(), &guarantees);
            if entry.reason.get_ref().trim().is_empty() {
                let message = format!("'{}' is accepted without a reason", entry.warning.get_ref());
                let help = "say why the value is right for this machine: the report shows it";
                findings.add(entry.reason.span(), message, "no reason", help);
            }
            list.push((entry, false));
        }
        findings.finish(Self(list))
    }

    /// The reason for which a warning is accepted here, if it is.
    pub fn reason(&mut self, id: &str, ground: &Ground<'_>) -> Option<String> {
        let fits = |only: &Option<Spanned<String>>, name: Option<&String>| {
            only.as_ref().is_none_or(|o| Some(o.get_ref()) == name)
        };
        let mut reason = None;
        for (entry, needed) in &mut self.0 {
            let here = entry.warning.get_ref() == id
                && fits(&entry.axis, ground.axis.map(|a| &a.name))
                && fits(&entry.group, ground.group.map(|g| &g.name))
                && fits(&entry.door, ground.door.map(|d| &d.name))
                && fits(&entry.guarantee, ground.guarantee.map(|g| &g.name));
            if here {
                *needed = true;
                reason.get_or_insert_with(|| entry.reason.get_ref().clone());
            }
        }
        reason
    }

    /// A warning for each acceptance that nothing needed.
    pub fn without_effect(self, source: &str) -> impl Iterator<Item = (usize, Warning)> {
        let unneeded = self.0.into_iter().filter(|(_, needed)| !needed);
        unneeded.map(move |(entry, _)| {
            let at = entry.warning.span().start;
            let (line, column) = position(source, at).unwrap_or((1, 1));
            let id = entry.warning.get_ref();
            let only = [
                ("axis", entry.axis),
                ("group", entry.group),
                ("door", entry.door),
                ("guarantee", entry.guarantee),
            ];
            let only = only.into_iter();
            let only: Vec<String> = only
                .filter_map(|(what, name)| Some(format!("{what} {}", name?.get_ref())))
                .collect();
            let of = match only.is_empty() {
                true => "the machine".to_owned(),
                false => only.join(", "),
            };
            let warning = Warning {
                id: WITHOUT_EFFECT.to_owned(),
                of,
                text: format!("'{id}' is accepted, and nothing here gives this warning"),
                reason:
                    "An acceptance that nothing needs hides the warning as soon as a value changes."
                        .to_owned(),
                better: "Remove it, or correct the axis, group, door or guarantee that it names."
                    .to_owned(),
                source: String::new(),
                req: Vec::new(),
                values: Vec::new(),
                line,
                column,
                accepted: None,
            };
            (at, warning)
        })
    }
}
