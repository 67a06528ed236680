//! The guarantees of a machine file.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Owner, Reader};
use crate::guarantee::{About, Guarantee, Pattern};
use crate::own::{Own, Stated};
use crate::{Axis, AxisKind, Door, Place};
use stillpoint_lang::diag::nearest;

impl<'f> Reader<'f> {
    /// The guarantees, in the order of the file.
    pub(super) fn guarantees(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        axes: &[Axis],
        doors: &[Door],
    ) -> Vec<Guarantee> {
        let Some(table) = self.findings.table("guarantee", value) else {
            return Vec::new();
        };
        self.names("guarantee", table);
        let mut list = Vec::new();
        for (key, value) in table.iter() {
            let name = key.get_ref().as_ref();
            let Some(table) = self.findings.table(&format!("guarantee.{name}"), value) else {
                continue;
            };
            if let Some((pattern, data)) = self.pattern(name, key.span(), table) {
                let of = (pattern.as_str(), data);
                list.extend(self.guarantee(name, key.span(), table, of, axes, doors));
            }
        }
        list
    }

    /// The pattern that a guarantee names.
    fn pattern(
        &mut self,
        name: &str,
        place: Place,
        table: &DeTable<'_>,
    ) -> Option<(String, &'f Pattern)> {
        let family = self.family;
        let known: Vec<&str> = family.patterns.keys().map(String::as_str).collect();
        let list = format!("patterns of this family: {}", known.join(", "));
        let Some(value) = table.get("pattern") else {
            let message = format!("guarantee {name} has no pattern");
            self.findings.add(place, message, "this guarantee", list);
            return None;
        };
        let text = self.findings.text("pattern", value)?;
        let found = family.patterns.get(&text);
        if found.is_none() {
            let help = match nearest(&text, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => list,
            };
            let message = format!("\"{text}\" is no pattern of guarantees");
            self.findings
                .add(value.span(), message, "no such pattern", help);
        }
        Some((text, found?))
    }

    fn guarantee(
        &mut self,
        name: &str,
        at: Place,
        table: &DeTable<'_>,
        (pattern, data): (&str, &Pattern),
        axes: &[Axis],
        doors: &[Door],
    ) -> Option<Guarantee> {
        let door = match data.about {
            About::Axis | About::Logic => None,
            About::Door => Some(self.door_of(name, at.clone(), table, doors)?),
        };
        let mut named = match table.get("axes") {
            Some(value) => self.findings.texts("axes", value),
            None => Vec::new(),
        };
        let behind = door.map_or(&[][..], |door| &door.axes);
        if let Some(door) = door {
            for axis in named.iter().filter(|a| !door.has(a.get_ref())) {
                let message = format!(
                    "guarantee {name}: axis '{}' is not behind door {}",
                    axis.get_ref(),
                    door.name
                );
                let behind: Vec<&str> = behind.iter().map(|a| a.get_ref().as_str()).collect();
                let help = format!("axes behind it: {}", behind.join(", "));
                self.findings
                    .add(axis.span(), message, "not behind it", help);
            }
        }
        if named.is_empty() {
            named = behind.to_vec();
        }
        let own = match data.about {
            About::Logic => Some(self.own(name, at.clone(), table)?),
            _ => None,
        };
        if named.is_empty() && own.is_none() {
            let message = format!("guarantee {name} names no axes");
            let help = "add a line such as axes = [\"X\", \"Y\"]";
            self.findings.add(at, message, "this guarantee", help);
            return None;
        }
        let kind = match own {
            Some(_) => AxisKind::Linear,
            None => self.kind_of(name, &at, &named, axes)?,
        };
        for required in &data.required {
            if !table.contains_key(required.as_str()) {
                let about = data.arguments.get(required).map_or("", |a| a.text.as_str());
                let message = format!("guarantee {name} does not say '{required}': {about}");
                let help = format!("add a line {required} = ...");
                self.findings
                    .add(at.clone(), message, "this guarantee", help);
                return None;
            }
        }
        let place = format!("guarantee {name}");
        let owner = Owner {
            kind,
            structural: match data.about {
                About::Axis => &["pattern", "axes"],
                About::Door => &["pattern", "door", "axes"],
                About::Logic => &["pattern", "when", "then"],
            },
            ..Owner::of(&place)
        };
        let (values, sound) = self.settings(&data.arguments, table, &owner);
        let door = door.map(|d| d.name.clone());
        sound.then(|| Guarantee {
            name: name.to_owned(),
            pattern: pattern.to_owned(),
            source: data.source.clone(),
            text: data.told(door.as_deref(), &named, own.as_ref(), &values),
            own,
            door,
            axes: named,
            values,
            place: at,
        })
    }

    /// The expressions of a guarantee in words of the file.
    fn own(&mut self, name: &str, at: Place, table: &DeTable<'_>) -> Option<Own> {
        let mut stated = |key: &str| {
            let Some(value) = table.get(key) else {
                let message = format!("guarantee {name} does not say '{key}'");
                let help = "write when = \"NOT INSE[1]\", then = \"NOT OUTSI[3]\" or the like, over the signals of the safe logic";
                self.findings
                    .add(at.clone(), message, "this guarantee", help);
                return None;
            };
            let text = self.findings.text(key, value)?;
            let place = value.span();
            Some(Stated { text, place })
        };
        let (when, then) = (stated("when"), stated("then"));
        Some(Own {
            name: name.to_owned(),
            when: when?,
            then: then?,
        })
    }

    fn door_of<'d>(
        &mut self,
        name: &str,
        at: Place,
        table: &DeTable<'_>,
        doors: &'d [Door],
    ) -> Option<&'d Door> {
        let known: Vec<&str> = doors.iter().map(|d| d.name.as_str()).collect();
        let list = format!("doors of this machine: {}", known.join(", "));
        let Some(value) = table.get("door") else {
            let message = format!("guarantee {name} names no door");
            self.findings.add(at, message, "this guarantee", list);
            return None;
        };
        let text = self.findings.text("door", value)?;
        let found = doors.iter().find(|d| d.name == text);
        if found.is_none() {
            let message = format!("there is no door '{text}'");
            self.findings
                .add(value.span(), message, "no such door", list);
        }
        found
    }

    /// The one kind of the axes: a speed of one guarantee cannot be in mm/min and in rev/min.
    fn kind_of(
        &mut self,
        name: &str,
        at: &Place,
        named: &[Spanned<String>],
        axes: &[Axis],
    ) -> Option<AxisKind> {
        let mut kind: Option<(AxisKind, &str)> = None;
        for one in named {
            let axis = axes.iter().find(|a| a.name == *one.get_ref());
            let Some(axis) = axis else {
                self.known_axis(one);
                return None;
            };
            match kind {
                Some((first, of)) if first != axis.kind => {
                    let message = format!(
                        "guarantee {name}: {of} and {} have different units",
                        axis.name
                    );
                    let help = "state a guarantee for linear axes and one for rotary axes and spindles: axes = [...]";
                    self.findings
                        .add(at.clone(), message, "this guarantee", help);
                    return None;
                }
                _ => kind = Some((axis.kind, &axis.name)),
            }
        }
        kind.map(|(kind, _)| kind)
    }
}
