//! The axis groups of a machine file: their axes, values, and which of them come before others.

use indexmap::IndexMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Owner, Reader};
use crate::family::{Param, Quantity};
use crate::{Group, Setting};

impl Reader<'_> {
    /// The groups that the file declares; there must be one.
    pub(super) fn read_groups(
        &mut self,
        params: &IndexMap<String, Param>,
        table: &DeTable<'_>,
    ) -> Vec<Group> {
        let Some(value) = table.get("group") else {
            let help =
                "add a table such as [group.NC] with axes = [\"X\", \"Y\"] and its parameters";
            let message = "the machine has no axis group";
            self.findings.add(None, message, "", help);
            return Vec::new();
        };
        let Some(table) = self.findings.table("group", value) else {
            return Vec::new();
        };
        if table.len() > self.family.max_groups {
            let most = self.family.max_groups;
            let message = format!("{} axis groups: a control has at most {most}", table.len());
            let help = "describe each control in a file of its own";
            self.findings
                .add(value.span(), message, "too many groups", help);
            return Vec::new();
        }
        self.names("group", table);
        let mut groups: Vec<Group> = Vec::new();
        for (key, value) in table.iter() {
            let name = key.get_ref().as_ref();
            let Some(table) = self.findings.table(&format!("group.{name}"), value) else {
                continue;
            };
            let title = table.get("title");
            let title = title.and_then(|t| self.findings.text("title", t));
            let axes = match table.get("axes") {
                Some(value) => self.findings.texts("axes", value),
                None => Vec::new(),
            };
            if axes.is_empty() {
                let message = format!("group {name} has no axes");
                let help = "add a line such as axes = [\"X\", \"Y\"]";
                self.findings.add(key.span(), message, "this group", help);
            }
            self.once(name, &axes, &groups);
            let place = format!("group {name}");
            let owner = Owner {
                structural: &["title", "axes"],
                ..Owner::of(&place)
            };
            let (values, sound) = self.settings(params, table, &owner);
            if sound && !axes.is_empty() {
                groups.push(Group {
                    name: name.to_owned(),
                    title: title.unwrap_or_default(),
                    axes,
                    values,
                    place: key.span(),
                });
            }
        }
        let ordered = params.iter();
        let ordered = ordered.filter(|(_, p)| p.quantity == Quantity::Groups);
        for (key, param) in ordered {
            self.no_circle(key, param, &groups);
        }
        groups
    }

    /// An axis belongs to one group, and once.
    fn once(&mut self, name: &str, axes: &[Spanned<String>], before: &[Group]) {
        for (k, axis) in axes.iter().enumerate() {
            let has = |list: &[Spanned<String>]| list.iter().any(|a| a.get_ref() == axis.get_ref());
            let other = before
                .iter()
                .find(|g| has(&g.axes))
                .map(|g| g.name.as_str());
            let other = other.or_else(|| axes.get(..k).filter(|l| has(l)).map(|_| name));
            if let Some(other) = other {
                let message = format!("axis {} belongs to group {other} already", axis.get_ref());
                let help = "name each axis in one group only";
                self.findings.add(axis.span(), message, "named again", help);
            }
        }
    }

    /// Whether there is a group of this name; else there is a finding.
    pub(super) fn known_group(&mut self, name: &Spanned<String>) -> Option<usize> {
        let known = self.groups.iter().position(|g| g == name.get_ref());
        if known.is_none() {
            let message = format!("there is no group '{}'", name.get_ref());
            let help = format!("groups of this machine: {}", self.groups.join(", "));
            self.findings
                .add(name.span(), message, "no such group", help);
        }
        known
    }

    /// A list of groups as a bit for each, in the order of the file.
    pub(super) fn predecessors(
        &mut self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
        place: &str,
    ) -> Option<Setting> {
        let names = self.findings.texts(key, value);
        let mut bits = 0_i64;
        for name in &names {
            let k = self.known_group(name)?;
            if place.strip_prefix("group ") == Some(name.get_ref().as_str()) {
                let message = format!("{place}: {key} names the group itself");
                let help = "name the other groups only";
                self.findings
                    .add(name.span(), message, "this group itself", help);
                return None;
            }
            bits |= 1_i64.checked_shl(u32::try_from(k).ok()?)?;
        }
        let shown: Vec<&str> = names.iter().map(|n| n.get_ref().as_str()).collect();
        Some(Setting {
            cells: vec![bits],
            shown: vec![match shown.is_empty() {
                true => "none".to_owned(),
                false => shown.join(", "),
            }],
            places: vec![value.span()],
        })
    }

    /// Groups that wait for one another never get on.
    fn no_circle(&mut self, key: &str, param: &Param, groups: &[Group]) {
        let value = |name: &String| {
            let group = groups.iter().find(|g| g.name == *name)?;
            group.values.get(key)
        };
        let cell = |name: &String| value(name).and_then(|s| s.cells.first().copied());
        // For each group those it waits for, after as many rounds as there are groups also indirectly.
        let mut waits: Vec<i64> = self.groups.iter().map(|n| cell(n).unwrap_or(0)).collect();
        let has = |bits: i64, k: usize| bits.checked_shr(k as u32).is_some_and(|b| b & 1 == 1);
        for _ in 0..waits.len() {
            let with_theirs = |bits: &i64| {
                let before = (0..waits.len()).filter(|j| has(*bits, *j));
                before.fold(*bits, |bits, j| bits | waits[j])
            };
            waits = waits.iter().map(with_theirs).collect();
        }
        for k in 0..waits.len() {
            let circle: Vec<usize> = (0..waits.len())
                .filter(|j| has(waits[k], *j) && has(waits[*j], k))
                .collect();
            if circle.first() != Some(&k) {
                continue;
            }
            let names: Vec<&str> = circle.iter().map(|j| self.groups[*j].as_str()).collect();
            let message = format!(
                "{key}: groups {} wait for one another, so that none of them ever brakes [{}]",
                names.join(", "),
                param.id.join(", ")
            );
            let place = value(&self.groups[k]).and_then(|s| s.places.first().cloned());
            let help = "let one of these groups wait for none of the others";
            self.findings
                .add(place, message, "part of the circle", help);
        }
    }
}
