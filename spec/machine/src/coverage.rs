//! What is explored together, apart, or not at all, in words.

use super::family::{Explore, Family, Scope};
use super::guarantee::Guarantee;
use super::runs::{Parts, Plan};
use super::{Axis, Door, Machine};

/// What the file describes and no run contains, in words: functions, doors, axes without functions, groups.
pub(super) fn not_explored(
    family: &Family,
    parts: Parts<'_>,
    plan: &Plan,
    guarantees: &[Guarantee],
) -> Vec<String> {
    let (axes, doors) = (parts.axes, parts.doors);
    let mut list = Vec::new();
    let enables = !family.functions.is_empty();
    // An axis without one of these functions may have others all the same, such as STO over terminals: then runs are about it.
    let bare = |axis: &&Axis| axis.functions.is_empty() && !plan.about.contains(&axis.name);
    for axis in axes.iter().filter(|a| enables && bare(a)) {
        list.push(format!("axis {}: no safety function is enabled", axis.name));
    }
    let grouped = |axis: &Axis| parts.groups.iter().any(|g| g.has(&axis.name));
    let declares = family.group.is_some();
    for axis in axes.iter().filter(|a| declares && !grouped(a)) {
        let name = &axis.name;
        list.push(format!(
            "axis {name}: it is in no group, nothing monitors it"
        ));
    }
    for function in family.functions.iter().filter(|f| !f.explored) {
        let with: Vec<&str> = axes
            .iter()
            .filter(|a| a.has(&function.name))
            .map(|a| a.name.as_str())
            .collect();
        if !with.is_empty() {
            let with = with.join(", ");
            list.push(format!(
                "{} of {with}: its values are checked, not explored",
                function.name
            ));
        }
    }
    let unfit = |group: &&Vec<String>| !declares && !together(family, group.len());
    for group in plan.groups.iter().filter(unfit) {
        list.push(format!(
            "group {}: its axes are explored one by one; there is no system for {} together",
            group.join(", "),
            group.len()
        ));
    }
    let with_doors = |e: &Explore| matches!(e.each, Scope::Door | Scope::Machine);
    let explored = family.explore.iter().any(with_doors);
    let asked = |door: &Door| {
        guarantees
            .iter()
            .any(|g| g.door.as_ref() == Some(&door.name))
    };
    for door in doors.iter().filter(|door| !explored && !asked(door)) {
        list.push(format!(
            "door {}: its values are checked, not explored",
            door.name
        ));
    }
    list
}

/// Whether a system of the family is for so many axes, each with values of its own.
fn together(family: &Family, size: usize) -> bool {
    let mut all = family.explore.iter().chain(&family.products);
    all.any(|e| e.members.as_ref().is_some_and(|m| m.contains(&size)))
}

impl Machine {
    /// What is judged together and what apart, one sentence each; [`Machine::not_explored`] has the rest.
    pub fn coverage(&self) -> Vec<String> {
        let mut list = Vec::new();
        if self.axis_groups.is_empty() {
            let fit = |group: &&Vec<String>| together(&self.basis.family, group.len());
            for group in self.groups.iter().filter(fit) {
                list.push(format!("Coupled, judged together: {}.", group.join(", ")));
            }
            let coupled = |axis: &&Axis| self.groups.iter().any(|g| g.contains(&axis.name));
            let alone = self.axes.iter().filter(|axis| !coupled(axis));
            let alone: Vec<&str> = alone.map(|a| a.name.as_str()).collect();
            if !alone.is_empty() {
                let alone = alone.join(", ");
                list.push(format!("On its own, explored separately: {alone}."));
            }
        }
        for (group, axes) in self.axis_groups.iter().zip(&self.groups) {
            list.push(format!("Group {}: {}.", group.name, axes.join(", ")));
        }
        for (name, text) in self.logic() {
            list.push(match self.program(name) {
                Some(program) => format!("Logic {name} is program {program}: {text}."),
                None => format!("Logic {name} is that of the machine file: {text}."),
            });
        }
        list.extend(self.logic_missing());
        if let Some((text, guarantees)) = self.half_missing() {
            let names = guarantees.join(", ");
            list.push(format!(
                "The file has one half of the safe logic: {text} ({names})."
            ));
        }
        list.extend(self.logic_notes());
        list
    }
}
