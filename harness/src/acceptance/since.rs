//! What changed between two configurations, and which tests have to be repeated because of it.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};
use stillpoint_machine::acceptance::{Protocol, Test};
use stillpoint_machine::{Axis, AxisKind, Machine, Shown};
use toml::Spanned;

/// A difference between two configurations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// What it is about: the control, an axis, a group, a door.
    pub of: String,
    /// The parameter, with the index of an element; or what else differs.
    pub name: String,
    /// Before; empty: there was none.
    pub old: String,
    /// After; empty: there is none.
    pub new: String,
}

/// A test to be repeated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Repeat {
    /// The test.
    pub id: String,
    /// Why, one reason each.
    pub reasons: Vec<String>,
}

/// The comparison of two configurations.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Since {
    /// What differs, in the order of the machine file.
    pub changes: Vec<Change>,
    /// The tests to be repeated, in the order of the protocol.
    pub repeat: Vec<Repeat>,
    /// Tests of the old configuration that no longer apply.
    pub gone: Vec<String>,
    /// Parameters that changed and that no test depends on: (change, why none is needed).
    pub untested: Vec<(Change, String)>,
}

/// Compares two configurations of one family.
pub fn since(old: &Machine, before: &Protocol, new: &Machine, after: &Protocol) -> Since {
    let changes = changes(old, new);
    let known: BTreeMap<&str, &Test> = before.tests.iter().map(|t| (t.id.as_str(), t)).collect();
    let mut repeat = Vec::new();
    for test in &after.tests {
        let reasons = match known.get(test.id.as_str()) {
            None => vec!["it is new: what it tests was not enabled".to_owned()],
            Some(was) => reasons(was, test),
        };
        if !reasons.is_empty() {
            let id = test.id.clone();
            repeat.push(Repeat { id, reasons });
        }
    }
    let now: BTreeSet<&str> = after.tests.iter().map(|t| t.id.as_str()).collect();
    let gone = before.tests.iter().map(|t| &t.id);
    let untested = changes.iter().filter_map(|change| {
        let name = change.name.split('[').next().unwrap_or("");
        let why = after.untested.get(name)?;
        Some((change.clone(), why.clone()))
    });
    Since {
        gone: gone
            .filter(|id| !now.contains(id.as_str()))
            .cloned()
            .collect(),
        untested: untested.collect(),
        changes,
        repeat,
    }
}

/// Why a test has to be repeated; empty: it need not be.
fn reasons(was: &Test, is: &Test) -> Vec<String> {
    let names: BTreeSet<&String> = was.depends.keys().chain(is.depends.keys()).collect();
    let mut reasons = Vec::new();
    for name in names {
        let (old, new) = (was.depends.get(name), is.depends.get(name));
        if old != new {
            let shown = |value: Option<&String>| value.map_or("not used".to_owned(), String::clone);
            reasons.push(format!("{name}: {} -> {}", shown(old), shown(new)));
        }
    }
    // What a text shows can depend on more than the values it names.
    let same = Test {
        depends: is.depends.clone(),
        simulated: is.simulated.clone(),
        ..was.clone()
    };
    if reasons.is_empty() && same != *is {
        reasons.push("its steps or expectations changed".to_owned());
    }
    reasons
}

fn changes(old: &Machine, new: &Machine) -> Vec<Change> {
    let mut list = Vec::new();
    values(
        &mut list,
        "control",
        &old.control_shown(),
        &new.control_shown(),
    );
    for axis in &new.axes {
        let of = format!("axis {}", axis.name);
        match old.axes.iter().find(|a| a.name == axis.name) {
            Some(was) => {
                one(&mut list, &of, "kind", kind(was), kind(axis));
                let names = |a: &Axis| a.functions.join(", ");
                one(&mut list, &of, "functions", &names(was), &names(axis));
                let (before, after) = (&was.interpolates_with, &axis.interpolates_with);
                one(
                    &mut list,
                    &of,
                    "interpolates_with",
                    &joined(before),
                    &joined(after),
                );
                let pair = |a: &Axis| {
                    a.pair
                        .as_ref()
                        .map_or(String::new(), |p| p.get_ref().clone())
                };
                one(&mut list, &of, "pair", &pair(was), &pair(axis));
                values(&mut list, &of, &old.axis_shown(was), &new.axis_shown(axis));
            }
            None => one(&mut list, &of, "axis", "", "new"),
        }
    }
    for axis in &old.axes {
        if new.axes.iter().all(|a| a.name != axis.name) {
            one(
                &mut list,
                &format!("axis {}", axis.name),
                "axis",
                "there",
                "",
            );
        }
    }
    parts(&mut list, "group", &groups(old), &groups(new));
    parts(&mut list, "door", &doors(old), &doors(new));
    list
}

/// A group or door: its name, its axes, its values.
type Part<'a> = (&'a str, &'a [Spanned<String>], Vec<Shown>);

fn groups(machine: &Machine) -> Vec<Part<'_>> {
    let groups = machine.axis_groups.iter();
    groups
        .map(|g| (g.name.as_str(), g.axes.as_slice(), machine.group_shown(g)))
        .collect()
}

fn doors(machine: &Machine) -> Vec<Part<'_>> {
    let doors = machine.doors.iter();
    doors
        .map(|d| (d.name.as_str(), d.axes.as_slice(), machine.door_shown(d)))
        .collect()
}

/// Groups or doors.
fn parts(list: &mut Vec<Change>, noun: &str, old: &[Part<'_>], new: &[Part<'_>]) {
    for (name, axes, shown) in new {
        let of = format!("{noun} {name}");
        match old.iter().find(|(n, _, _)| n == name) {
            Some((_, were, was)) => {
                one(list, &of, "axes", &joined(were), &joined(axes));
                values(list, &of, was, shown);
            }
            None => one(list, &of, noun, "", "new"),
        }
    }
    for (name, _, _) in old {
        if new.iter().all(|(n, _, _)| n != name) {
            one(list, &format!("{noun} {name}"), noun, "there", "");
        }
    }
}

fn kind(axis: &Axis) -> &'static str {
    match (axis.kind, axis.spindle) {
        (_, true) => "spindle",
        (AxisKind::Linear, _) => "linear",
        (AxisKind::Rotary, _) => "rotary",
    }
}

fn joined(names: &[Spanned<String>]) -> String {
    let names: Vec<&str> = names.iter().map(|n| n.get_ref().as_str()).collect();
    names.join(", ")
}

fn one(list: &mut Vec<Change>, of: &str, name: &str, old: &str, new: &str) {
    if old != new {
        list.push(Change {
            of: of.to_owned(),
            name: name.to_owned(),
            old: old.to_owned(),
            new: new.to_owned(),
        });
    }
}

/// Parameters of one owner, element by element.
fn values(list: &mut Vec<Change>, of: &str, old: &[Shown], new: &[Shown]) {
    for is in new {
        let Some(was) = old.iter().find(|s| s.name == is.name) else {
            continue;
        };
        let (before, after): (Vec<&str>, Vec<&str>) = (
            was.value.split(", ").collect(),
            is.value.split(", ").collect(),
        );
        if before.len() != after.len() || before.len() == 1 {
            one(list, of, &is.name, &was.value, &is.value);
            continue;
        }
        for (k, (a, b)) in before.into_iter().zip(after).enumerate() {
            one(list, of, &format!("{}[{k}]", is.name), a, b);
        }
    }
}

impl Since {
    /// As JSON.
    pub fn to_json(&self) -> Value {
        let change = |c: &Change| json!({"of": c.of, "name": c.name, "old": c.old, "new": c.new});
        let changes = self.changes.iter().map(change);
        let repeat = self.repeat.iter();
        let repeat = repeat.map(|r| json!({"id": r.id, "reasons": r.reasons}));
        let untested = self.untested.iter();
        let untested = untested.map(|(c, why)| json!({"change": change(c), "reason": why}));
        json!({
            "changes": changes.collect::<Vec<_>>(), "repeat": repeat.collect::<Vec<_>>(),
            "gone": self.gone, "untested": untested.collect::<Vec<_>>(),
        })
    }
}
