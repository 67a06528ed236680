//! Two axes whose drives move one thing, such as the motors on both sides of a bridge.

use super::{Axis, Machine};

impl Machine {
    /// How many other axes move what an axis moves, whichever of them says so.
    pub(super) fn paired(&self, axis: &Axis) -> usize {
        let names = |a: &Axis, b: &Axis| a.pair.as_ref().is_some_and(|p| *p.get_ref() == b.name);
        let others = self.axes.iter().filter(|other| other.name != axis.name);
        others.filter(|o| names(axis, o) || names(o, axis)).count()
    }

    /// In what an axis differs from the one that moves the same thing: parameters, `functions`, `doors`, `kind`. Parameters that each drive
    /// has of its own, such as an address, do not count. Empty for an axis that is no pair.
    pub(super) fn differences<'a>(&self, axis: &'a Axis) -> Vec<&'a str> {
        let Some(pair) = &axis.pair else {
            return Vec::new();
        };
        let mut others = self.axes.iter();
        let Some(other) = others.find(|a| a.name == *pair.get_ref()) else {
            return Vec::new();
        };
        if axis.kind != other.kind {
            return vec!["kind"];
        }
        let own = &self.basis.family.own;
        let values = axis.values.iter().filter(|(name, _)| !own.contains(name));
        let differing = values.filter(|(name, setting)| {
            let theirs = other.values.get(*name).map(|s| &s.cells);
            theirs != Some(&setting.cells)
        });
        let mut list: Vec<&str> = differing.map(|(name, _)| name.as_str()).collect();
        let has = |a: &Axis, b: &Axis| a.functions.iter().all(|f| b.has(f));
        if !has(axis, other) || !has(other, axis) {
            list.push("functions");
        }
        let mut doors = self.doors.iter();
        if doors.any(|door| door.has(&axis.name) != door.has(&other.name)) {
            list.push("doors");
        }
        list
    }
}
