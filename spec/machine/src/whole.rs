//! The values of what has parts: of a group its axes and the doors to it, of a door what is behind it, of the machine
//! everything. A value of a part is a list there, with one cell for each part that has it, in the order of the file.

use super::eval::Values;
use super::family::{Family, Quantity};
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

/// The name of the greatest sum of a named expression of a group along the groups that come before it.
pub(super) fn before(name: &str) -> String {
    format!("{name}_before")
}

/// Adds these sums to the values of each group, in the order of the file: 0 where no group comes before.
pub(super) fn add_before(family: &Family, groups: &[Group], values: &mut [Values]) {
    let params = family.group.iter().flatten();
    let lists: Vec<&String> = params
        .filter(|(_, param)| param.quantity == Quantity::Groups)
        .map(|(name, _)| name)
        .collect();
    let first: Vec<Vec<usize>> = (groups.iter().enumerate())
        .map(|(of, group)| {
            let listed = |k: &usize| {
                let cells = lists.iter().filter_map(|name| group.values.get(*name));
                *k != of && cells.flat_map(|s| &s.cells).any(|bits| bits >> k & 1 == 1)
            };
            (0..groups.len()).filter(listed).collect()
        })
        .collect();
    for (name, _) in &family.group_lets {
        let cell = |group: &Values| {
            group
                .get(name)
                .and_then(|c| c.first().copied())
                .unwrap_or(0)
        };
        let own: Vec<i64> = values.iter().map(cell).collect();
        for (k, values) in values.iter_mut().enumerate() {
            values.insert(before(name), vec![sum_before(&own, &first, k, own.len())]);
        }
    }
}

/// The greatest sum of `own` along the groups before this one; groups that wait for one another are an error of the file, so `depth` ends it.
fn sum_before(own: &[i64], first: &[Vec<usize>], of: usize, depth: usize) -> i64 {
    if depth == 0 {
        return 0;
    }
    let sums = first[of].iter();
    let sums = sums.map(|k| own[*k].saturating_add(sum_before(own, first, *k, depth - 1)));
    sums.max().unwrap_or(0)
}

/// The values of a name in all `parts` that have it as a single value.
fn list<'v>(parts: impl Iterator<Item = &'v Values>, name: &str) -> Vec<i64> {
    let single = |values: &'v Values| match values.get(name).map(Vec::as_slice) {
        Some([one]) => Some(*one),
        _ => None,
    };
    parts.filter_map(single).collect()
}

#[cfg(test)]
mod tests {
    use super::sum_before;

    #[test]
    fn groups_that_come_before_add_up_along_the_longest_way() {
        // 0 waits for 1 and 2, and 2 for 3.
        let first = [vec![1, 2], vec![], vec![3], vec![]];
        let own = [1, 50, 20, 40];
        let of = |k| sum_before(&own, &first, k, own.len());
        assert_eq!([of(0), of(1), of(2), of(3)], [60, 0, 40, 0]);
        // Groups that wait for one another come to an end too.
        sum_before(&[1, 1], &[vec![1], vec![0]], 0, 2);
    }
}
