//! From the values of the axes to the explorations that cover the machine.

use std::collections::BTreeMap;

use super::eval::Values;
use super::family::{Binding, Explore, Family, Scope};
use super::plausible::{Judged, evaluate};
use super::{Axis, Door, Run};
use crate::diag::{Diagnostic, Diagnostics, Result};

/// A scaled system has at most this many steps in its longest time.
const STEPS: i64 = 2;

/// The groups of coupled axes and the runs.
pub(super) struct Plan {
    pub groups: Vec<Vec<String>>,
    pub runs: Vec<Run>,
}

/// Plans the runs of a machine.
///
/// # Errors
/// Faults of the family's data.
pub(super) fn plan(
    family: &Family,
    explored: &[Explore],
    axes: &[Axis],
    judged: &Judged,
) -> Result<Plan> {
    let groups = groups(family, axes, judged)?;
    let singles: Vec<Vec<usize>> = (0..axes.len()).map(|k| vec![k]).collect();
    let mut runs: Vec<Run> = Vec::new();
    for explore in explored {
        let scaled = is_scaled(family, explore)?;
        let (candidates, size) = match explore.each {
            Scope::Group => (&groups, explore.members),
            _ => (&singles, 1),
        };
        for candidate in candidates {
            let members = members(family, explore, axes, judged, candidate)?;
            if members.len() != size {
                continue;
            }
            // A group whose members differ is explored with the values of each.
            for of in 0..members.len() {
                let run = bind(family, explore, scaled, judged.cycle, &members, of)?;
                merge(&mut runs, run, explore.each);
            }
        }
    }
    for run in &mut runs {
        let axes = if run.axes.len() == 1 { "axis" } else { "axes" };
        run.title = format!("{}, {axes} {}", run.title, run.axes.join(", "));
    }
    let name = |k: &usize| axes.get(*k).map(|a| a.name.clone());
    let groups = groups.iter().map(|g| g.iter().filter_map(name).collect());
    Ok(Plan {
        groups: groups.collect(),
        runs,
    })
}

/// An axis and its values.
type Member<'a> = (&'a str, &'a Values);

/// The axes of `candidate` that `explore` is meant for.
fn members<'a>(
    family: &Family,
    explore: &Explore,
    axes: &'a [Axis],
    judged: &'a Judged,
    candidate: &[usize],
) -> Result<Vec<Member<'a>>> {
    let mut members = Vec::new();
    for k in candidate {
        if let (Some(axis), Some(values)) = (axes.get(*k), judged.axes.get(*k)) {
            if evaluate(family, &explore.when, values, judged.cycle)? != 0 {
                members.push((axis.name.as_str(), values));
            }
        }
    }
    Ok(members)
}

/// What the file describes and no run contains, in words: functions, doors, axes without functions, groups.
pub(super) fn not_explored(
    family: &Family,
    axes: &[Axis],
    doors: &[Door],
    groups: &[Vec<String>],
) -> Vec<String> {
    let mut list = Vec::new();
    for axis in axes.iter().filter(|a| a.functions.is_empty()) {
        list.push(format!("axis {}: no safety function is enabled", axis.name));
    }
    for function in family.functions.iter().filter(|f| !f.explored) {
        let with: Vec<&str> = axes
            .iter()
            .filter(|a| a.functions.contains(&function.name))
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
    let sizes: Vec<usize> = family
        .explore
        .iter()
        .map(|e| e.members)
        .filter(|n| *n > 0)
        .collect();
    for group in groups.iter().filter(|g| !sizes.contains(&g.len())) {
        list.push(format!(
            "group {}: its axes are explored one by one; there is no system for {} together",
            group.join(", "),
            group.len()
        ));
    }
    for door in doors {
        list.push(format!(
            "door {}: its values are checked, not explored",
            door.name
        ));
    }
    list
}

/// The connected groups of axes: those that interpolate, and those whose stop acts on the whole channel.
fn groups(family: &Family, axes: &[Axis], judged: &Judged) -> Result<Vec<Vec<usize>>> {
    let mut label: Vec<usize> = (0..axes.len()).collect();
    for (i, axis) in axes.iter().enumerate() {
        let everyone = match judged.axes.get(i) {
            Some(values) => evaluate(family, &family.coupled_to_all, values, judged.cycle)? != 0,
            None => false,
        };
        for (j, other) in axes.iter().enumerate() {
            let named = axis
                .interpolates_with
                .iter()
                .any(|n| *n.get_ref() == other.name);
            if everyone || named {
                let (from, to) = (label[i].max(label[j]), label[i].min(label[j]));
                label
                    .iter_mut()
                    .filter(|l| **l == from)
                    .for_each(|l| *l = to);
            }
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (k, l) in label.into_iter().enumerate() {
        groups.entry(l).or_default().push(k);
    }
    Ok(groups.into_values().filter(|g| g.len() > 1).collect())
}

/// Whether the specification file declares the system with scaled timers.
///
/// # Errors
/// The file or the system does not exist.
fn is_scaled(family: &Family, explore: &Explore) -> Result<bool> {
    let fault = |message: String| -> Diagnostics {
        Diagnostic::new(&family.file, &family.source, None, message)
            .help("this is an error of the family's data, not of the machine file")
            .into()
    };
    let path = family.folder.join(&explore.file);
    let text = std::fs::read_to_string(&path)
        .map_err(|e| fault(format!("cannot read {}: {e}", path.display())))?;
    let file: toml::Table = toml::from_str(&text).map_err(|e| {
        fault(format!(
            "{} is not valid TOML: {}",
            path.display(),
            e.message()
        ))
    })?;
    let system = file
        .get("system")
        .and_then(|s| s.get(&explore.system))
        .ok_or_else(|| {
            fault(format!(
                "{} has no system '{}'",
                path.display(),
                explore.system
            ))
        })?;
    Ok(system.get("timers").and_then(toml::Value::as_str) == Some("scaled"))
}

/// A time bound to a parameter, before and after rounding.
struct Time {
    name: String,
    exact: bool,
    cycles: i64,
}

/// The run of `explore` for `members`, with the values of the one at `of`.
fn bind(
    family: &Family,
    explore: &Explore,
    scaled: bool,
    cycle: i64,
    members: &[Member<'_>],
    of: usize,
) -> Result<Run> {
    let mut run = Run {
        title: explore.text.clone(),
        axes: members.iter().map(|(name, _)| (*name).to_owned()).collect(),
        file: family.folder.join(&explore.file),
        system: explore.system.clone(),
        params: BTreeMap::new(),
        abstractions: Vec::new(),
    };
    let Some((_, values)) = members.get(of) else {
        return Ok(run);
    };
    if !explore.note.is_empty() {
        run.abstractions.push(explore.note.clone());
    }
    let mut times = Vec::new();
    for binding in &explore.params {
        match binding {
            Binding::Value(name, formula) => {
                let value = evaluate(family, formula, values, cycle)?;
                run.params.insert(name.clone(), vec![value]);
            }
            Binding::Time(name, formula) => {
                let time = evaluate(family, formula, values, cycle)?;
                times.push(Time {
                    name: name.clone(),
                    exact: time % cycle == 0,
                    cycles: up(time, cycle),
                });
            }
            Binding::Rank(list, names) => {
                let ranks = ranks(values.get(list).map_or(&[], Vec::as_slice));
                let cells = ranks.into_iter().map(|rank| vec![rank]);
                run.params.extend(names.iter().cloned().zip(cells));
                let text = format!("{list} by the order of its values only");
                run.abstractions.push(text);
            }
            Binding::Member(formula, names) => {
                for (name, (_, values)) in names.iter().zip(members) {
                    let value = evaluate(family, formula, values, cycle)?;
                    run.params.insert(name.clone(), vec![value]);
                }
            }
        }
    }
    let longest = times.iter().map(|t| t.cycles).max().unwrap_or(0);
    let step = if scaled { up(longest, STEPS).max(1) } else { 1 };
    run.abstractions.extend(times_text(&times, step, cycle));
    let steps = times
        .into_iter()
        .map(|t| (t.name, vec![up(t.cycles, step)]));
    run.params.extend(steps);
    Ok(run)
}

/// `a / b`, rounded up; both positive or 0.
fn up(a: i64, b: i64) -> i64 {
    a / b + i64::from(a % b != 0)
}

/// What the times lost: `None` when each is a whole number of cycles and not scaled.
fn times_text(times: &[Time], step: i64, cycle: i64) -> Option<String> {
    let cycle = super::units::Dimension::Time.show(cycle);
    let list = |times: &mut dyn Iterator<Item = String>| times.collect::<Vec<_>>().join(", ");
    if step > 1 {
        let entry = |t: &Time| format!("{} {} cycles = {}", t.name, t.cycles, up(t.cycles, step));
        return Some(format!(
            "times in steps of {step} cycles of {cycle}, rounded up: {}",
            list(&mut times.iter().map(entry))
        ));
    }
    let rounded = times.iter().filter(|t| !t.exact);
    let text = list(&mut rounded.map(|t| format!("{} = {} cycles", t.name, t.cycles)));
    (!text.is_empty()).then(|| format!("times rounded up to cycles of {cycle}: {text}"))
}

/// The position of each value among the different values, from 0.
fn ranks(values: &[i64]) -> Vec<i64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    values
        .iter()
        .map(|v| sorted.iter().take_while(|s| *s < v).fold(0, |n, _| n + 1))
        .collect()
}

/// Adds a run, or its axes to the one that explores the same.
fn merge(runs: &mut Vec<Run>, run: Run, each: Scope) {
    let same = runs.iter_mut().find(|r| {
        r.file == run.file
            && r.system == run.system
            && r.params == run.params
            && (each != Scope::Group || r.axes == run.axes)
    });
    let Some(known) = same else {
        runs.push(run);
        return;
    };
    for axis in run.axes {
        if !known.axes.contains(&axis) {
            known.axes.push(axis);
        }
    }
    for text in run.abstractions {
        if !known.abstractions.contains(&text) {
            known.abstractions.push(text);
        }
    }
}
