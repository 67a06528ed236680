//! From the values of the axes to the explorations that cover the machine.

use std::collections::BTreeMap;
use std::path::PathBuf;

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
pub(super) fn plan(family: &Family, axes: &[Axis], judged: &Judged) -> Result<Plan> {
    let groups = groups(family, axes, judged)?;
    let mut runs: Vec<Run> = Vec::new();
    for explore in &family.explore {
        let scaled = is_scaled(family, explore)?;
        let singles: Vec<Vec<usize>> = (0..axes.len()).map(|k| vec![k]).collect();
        let candidates = if explore.each == Scope::Group { &groups } else { &singles };
        for members in candidates {
            let mut taking = Vec::new();
            for k in members {
                let Some(values) = judged.axes.get(*k) else { continue };
                if evaluate(family, &explore.when, values, judged.cycle)? != 0 {
                    taking.push((*k, values));
                }
            }
            let least = if explore.each == Scope::Group { 2 } else { 1 };
            if taking.len() < least {
                continue;
            }
            let name = |k: &usize| axes.get(*k).map(|a| a.name.clone());
            let names: Vec<String> = taking.iter().filter_map(|(k, _)| name(k)).collect();
            // Each member's values once: a group whose members differ is explored with the values of each.
            for (_, values) in taking {
                let run = bind(family, explore, scaled, judged.cycle, names.clone(), values)?;
                merge(&mut runs, run, explore.each);
            }
        }
    }
    for run in &mut runs {
        let axes = if run.axes.len() == 1 { "axis" } else { "axes" };
        run.title = format!("{}, {axes} {}", run.title, run.axes.join(", "));
    }
    let name = |k: &usize| axes.get(*k).map(|a| a.name.clone());
    Ok(Plan {
        groups: groups.iter().map(|g| g.iter().filter_map(name).collect()).collect(),
        runs,
    })
}

/// Enabled functions and doors that no run contains, in words.
pub(super) fn not_explored(family: &Family, axes: &[Axis], doors: &[Door]) -> Vec<String> {
    let mut list = Vec::new();
    for function in family.functions.iter().filter(|f| !f.explored) {
        let with: Vec<&str> = axes
            .iter()
            .filter(|a| a.functions.contains(&function.name))
            .map(|a| a.name.as_str())
            .collect();
        if !with.is_empty() {
            list.push(format!("{} of {}: parameters checked, not explored", function.name, with.join(", ")));
        }
    }
    list.extend(doors.iter().map(|d| format!("door {}: parameters checked, not explored", d.name)));
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
            let named = axis.interpolates_with.iter().any(|n| *n.get_ref() == other.name);
            if everyone || named {
                let (from, to) = (label[i].max(label[j]), label[i].min(label[j]));
                label.iter_mut().filter(|l| **l == from).for_each(|l| *l = to);
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
    let file: toml::Table = toml::from_str(&text)
        .map_err(|e| fault(format!("{} is not valid TOML: {}", path.display(), e.message())))?;
    let system = file
        .get("system")
        .and_then(|s| s.get(&explore.system))
        .ok_or_else(|| fault(format!("{} has no system '{}'", path.display(), explore.system)))?;
    Ok(system.get("timers").and_then(toml::Value::as_str) == Some("scaled"))
}

/// A time bound to a parameter, before and after rounding.
struct Time {
    name: String,
    exact: bool,
    cycles: i64,
}

/// The run of `explore` with the values of one axis.
fn bind(
    family: &Family,
    explore: &Explore,
    scaled: bool,
    cycle: i64,
    axes: Vec<String>,
    values: &Values,
) -> Result<Run> {
    let mut run = Run {
        title: explore.text.clone(),
        file: family.folder.join(&explore.file),
        system: explore.system.clone(),
        params: BTreeMap::new(),
        abstractions: Vec::new(),
        axes,
    };
    let mut times = Vec::new();
    for (name, binding) in &explore.params {
        let cells = match binding {
            Binding::Value(formula) => vec![evaluate(family, formula, values, cycle)?],
            Binding::Axes => vec![i64::try_from(run.axes.len()).unwrap_or(i64::MAX)],
            Binding::Rank(list) => {
                let (ranks, text) = ranks(name, values.get(list).map_or(&[], Vec::as_slice));
                run.abstractions.push(text);
                ranks
            }
            Binding::Time(formula) => {
                let time = evaluate(family, formula, values, cycle)?;
                let exact = time % cycle == 0;
                let cycles = time / cycle + i64::from(!exact);
                times.push(Time { name: name.clone(), exact, cycles });
                continue;
            }
        };
        run.params.insert(name.clone(), cells);
    }
    let longest = times.iter().map(|t| t.cycles).max().unwrap_or(0);
    let step = if scaled { up(longest, STEPS).max(1) } else { 1 };
    run.abstractions.extend(times_text(&times, step, cycle));
    let steps = times.into_iter().map(|t| (t.name, vec![up(t.cycles, step)]));
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
fn ranks(name: &str, values: &[i64]) -> (Vec<i64>, String) {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let rank = |v: &i64| sorted.iter().take_while(|s| *s < v).count();
    let ranks: Vec<i64> = values.iter().map(|v| i64::try_from(rank(v)).unwrap_or(i64::MAX)).collect();
    let shown: Vec<String> = ranks.iter().map(i64::to_string).collect();
    (ranks, format!("{name} by the order of the values only: {}", shown.join(", ")))
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
