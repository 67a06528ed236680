//! The guard doors of a machine file.

use toml::Spanned;
use toml::de::DeValue;

use super::{Owner, Reader};
use crate::{Door, Group};

impl Reader<'_> {
    /// The doors; in a family with axis groups a door names groups, and has their axes.
    pub(super) fn doors(&mut self, value: &Spanned<DeValue<'_>>, groups: &[Group]) -> Vec<Door> {
        let Some(table) = self.findings.table("door", value) else {
            return Vec::new();
        };
        self.names("door", table);
        let by_group = self.family.group.is_some();
        let (list, members) = match by_group {
            true => ("groups", "groups = [\"NC\"]: the groups"),
            false => ("axes", "axes = [\"X\", \"Y\"]: the axes"),
        };
        let mut doors = Vec::new();
        for (key, value) in table.iter() {
            let name = key.get_ref().as_ref();
            let Some(table) = self.findings.table(&format!("door.{name}"), value) else {
                continue;
            };
            let title = table.get("title");
            let title = title.and_then(|t| self.findings.text("title", t));
            let behind = match table.get(list) {
                Some(value) => self.findings.texts(list, value),
                None => Vec::new(),
            };
            if behind.is_empty() {
                self.findings.add(
                    key.span(),
                    format!("door {name} names no {list}"),
                    "this door",
                    format!("add a line such as {members} a person can reach through it"),
                );
            }
            let (axes, named) = match by_group {
                true => (self.axes_of(&behind, groups), behind),
                false => (behind, Vec::new()),
            };
            let place = format!("door {name}");
            let owner = Owner {
                structural: &["title", list],
                ..Owner::of(&place)
            };
            let (values, sound) = self.settings(&self.family.door, table, &owner);
            if sound {
                doors.push(Door {
                    name: name.to_owned(),
                    title: title.unwrap_or_default(),
                    axes,
                    groups: named,
                    values,
                    place: key.span(),
                });
            }
        }
        doors
    }

    /// The axes of the groups named, each at the place of the name.
    fn axes_of(&mut self, named: &[Spanned<String>], groups: &[Group]) -> Vec<Spanned<String>> {
        let mut axes = Vec::new();
        for name in named {
            self.known_group(name);
            let group = groups.iter().find(|g| g.name == *name.get_ref());
            let members = group.map_or(&[][..], |g| &g.axes);
            axes.extend(
                members
                    .iter()
                    .map(|a| Spanned::new(name.span(), a.get_ref().clone())),
            );
        }
        axes
    }
}
