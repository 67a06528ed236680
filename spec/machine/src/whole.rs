//! The values of what has parts: of a group its axes and the doors to it, of a door what is behind it, of the machine
//! everything. A value of a part is a list there, with one cell for each part that has it, in the order of the file.

use super::eval::Values;
use super::family::Family;
use super::plausible::{evaluate, insert};
use super::read::Draft;
use super::{Door, Group};
use stillpoint_lang::diag::Result;

/// What the values are taken from.
pub(super) struct Whole<'a> {
    family: &'a Family,
    draft: &'a Draft,
    /// The values of each axis, in the order of the draft.
    axes: &'a [Values],
    /// The values of the control and the names that mean the same everywhere.
    common: Values,
    cycle: i64,
}

impl<'a> Whole<'a> {
    pub fn new(
        family: &'a Family,
        draft: &'a Draft,
        axes: &'a [Values],
        control: &Values,
        cycle: i64,
    ) -> Self {
        let mut common = control.clone();
        let constants = [("LINEAR", 0), ("ROTARY", 1), ("monitoring_cycle", cycle)];
        common.extend(constants.map(|(name, value)| (name.to_owned(), vec![value])));
        Self {
            family,
            draft,
            axes,
            common,
            cycle,
        }
    }

    /// The values of a group.
    ///
    /// # Errors
    /// A named expression without a value, which is a fault of the family's data.
    pub fn group(&self, group: &Group) -> Result<Values> {
        let mut values = self.common.clone();
        let member = |name: &String| group.has(name);
        self.add_axes(&mut values, &member);
        let doors = self.draft.doors.iter();
        let doors = doors.filter(|door| door.axes.iter().any(|a| member(a.get_ref())));
        self.add_doors(&mut values, doors);
        insert(&mut values, &group.values);
        for (name, formula) in &self.family.group_lets {
            let value = evaluate(self.family, formula, &values, self.cycle)?;
            values.insert(name.clone(), vec![value]);
        }
        Ok(values)
    }

    /// The values of a door; `groups` are those of all groups.
    pub fn door(&self, door: &Door, groups: &[Values]) -> Values {
        let mut values = self.common.clone();
        let behind = |name: &String| door.has(name);
        self.add_axes(&mut values, &behind);
        let groups = self.draft.groups.iter().zip(groups);
        let groups = groups.filter(|(g, _)| g.axes.iter().any(|a| behind(a.get_ref())));
        self.add_groups(&mut values, groups.map(|(_, values)| values));
        insert(&mut values, &door.values);
        values
    }

    /// The values of the machine; `groups` are those of all groups.
    pub fn machine(&self, groups: &[Values]) -> Values {
        let mut values = self.common.clone();
        self.add_axes(&mut values, &|_| true);
        self.add_groups(&mut values, groups.iter());
        self.add_doors(&mut values, self.draft.doors.iter());
        values
    }

    fn add_axes(&self, values: &mut Values, wanted: &dyn Fn(&String) -> bool) {
        let family = self.family;
        let axes = self.draft.axes.iter().zip(self.axes);
        let axes: Vec<&Values> = axes
            .filter(|(a, _)| wanted(&a.name))
            .map(|(_, v)| v)
            .collect();
        let own = ["kind", "spindle", "enabled_any"].into_iter();
        let names = own
            .chain(family.axis.keys().map(String::as_str))
            .chain(family.functions.iter().map(|f| f.variable.as_str()))
            .chain(family.lets.iter().map(|(name, _)| name.as_str()));
        for name in names {
            values.insert(name.to_owned(), list(axes.iter().copied(), name));
        }
    }

    fn add_groups<'v>(
        &self,
        values: &mut Values,
        groups: impl Iterator<Item = &'v Values> + Clone,
    ) {
        let params = self.family.group.iter().flat_map(|g| g.keys());
        let lets = self.family.group_lets.iter().map(|(name, _)| name);
        for name in params.chain(lets) {
            values.insert(name.clone(), list(groups.clone(), name));
        }
    }

    fn add_doors<'d>(&self, values: &mut Values, doors: impl Iterator<Item = &'d Door> + Clone) {
        for name in self.family.door.keys() {
            let cells = doors
                .clone()
                .filter_map(|d| d.values.get(name)?.cells.first());
            values.insert(name.clone(), cells.copied().collect());
        }
    }
}

/// The values of a name in all `parts` that have it as a single value.
fn list<'v>(parts: impl Iterator<Item = &'v Values>, name: &str) -> Vec<i64> {
    let single = |values: &'v Values| match values.get(name).map(Vec::as_slice) {
        Some([one]) => Some(*one),
        _ => None,
    };
    parts.filter_map(single).collect()
}
