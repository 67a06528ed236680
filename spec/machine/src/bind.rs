//! The run of one subject: what an exploration binds, with the values of an axis, group or door.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::eval::Values;
use super::family::{BEFORE, Binding, Explore, Family, MEMBERS, Rounding, Target};
use super::plausible::evaluate;
use super::runs::{Declared, Planned, Subject};
use super::{Abstraction, Run, Wiring};
use stillpoint_lang::cells::together;
use stillpoint_lang::diag::Result;

/// A scaled system has at most this many steps in its longest time.
const STEPS: i64 = 2;

/// A time bound to a parameter, before and after rounding.
struct Time {
    name: String,
    /// The member whose cell it is; none: the parameter is no array.
    member: Option<usize>,
    exact: bool,
    cycles: i64,
    rounding: Rounding,
}

impl Time {
    /// Its name, of an array that of the cell.
    fn cell(&self) -> String {
        match self.member {
            Some(k) => format!("{}[{}]", self.name, k + 1),
            None => self.name.clone(),
        }
    }
}

/// Times with what is told of each.
fn list<'t>(times: impl Iterator<Item = &'t Time>, told: impl Fn(&Time) -> String) -> String {
    let all = together(times.map(|time| (time.cell(), told(time))));
    let all: Vec<String> = all.into_iter().map(|(name, text)| name + &text).collect();
    all.join(", ")
}

/// The run of `explore` for a subject, with the values of the member at `of`.
pub(super) fn bind(
    family: &Family,
    explore: &Explore,
    system: &Declared,
    cycle: i64,
    subject: &Subject<'_>,
    of: usize,
) -> Result<Planned> {
    let members = &subject.members;
    let mut run = Run {
        title: explore.text.clone(),
        axes: subject.axes.clone(),
        guarantee: None,
        asks: None,
        faults: Vec::new(),
        file: family.folder.join(&explore.file),
        system: explore.system.clone(),
        cycle,
        before: 0,
        travel: 0,
        window: 0,
        half: false,
        wiring: Wiring::new(),
        params: BTreeMap::new(),
        sources: BTreeMap::new(),
        abstractions: Vec::new(),
    };
    let planned = |run| Planned {
        run,
        each: explore.each,
        of_member: explore.members.is_some(),
        names: members.iter().map(|(name, _)| (*name).to_owned()).collect(),
    };
    let Some((_, values)) = members.get(of) else {
        return Ok(planned(run));
    };
    let values = *values;
    let cycle = match &explore.cycle {
        Some(formula) => evaluate(family, formula, values, cycle)?.max(1),
        None => cycle,
    };
    run.cycle = cycle;
    let mut beside = Vec::new();
    if let Some(formula) = &explore.before {
        run.before = evaluate(family, formula, values, cycle)?;
        beside.push((BEFORE, run.before));
    }
    if explore.members.is_some() {
        let count = i64::try_from(members.len()).unwrap_or(i64::MAX);
        beside.push((MEMBERS, count));
    }
    if let Some(formula) = &explore.travel {
        run.travel = evaluate(family, formula, values, cycle)?;
    }
    if let Some(formula) = &explore.window {
        run.window = evaluate(family, formula, values, cycle)?;
    }
    let all = members.iter().map(|(_, values)| *values);
    let all: Vec<Cow<'_, Values>> = all.map(|values| with(values, &beside)).collect();
    let of_target = |target: &Target| if target.each { &all[..] } else { &all[of..=of] };
    let notes = [
        (&explore.note, Abstraction::of_system as fn(String) -> _),
        (&explore.chosen, Abstraction::of_values),
    ];
    for (text, kind) in notes.into_iter().filter(|(text, _)| !text.is_empty()) {
        run.abstractions.push(kind(text.clone()));
    }
    let mut times = Vec::new();
    for binding in &explore.params {
        match binding {
            Binding::Value(target, formula) => {
                let values = of_target(target).iter();
                let values = values.map(|v| evaluate(family, formula, v, cycle));
                let values = values.collect::<Result<Vec<i64>>>()?;
                run.params.insert(target.name.clone(), values);
                let source = formula.text.get_ref().clone();
                run.sources.insert(target.name.clone(), source);
            }
            Binding::Time(target, formula, rounding) => {
                let source = formula.text.get_ref().clone();
                run.sources.insert(target.name.clone(), source);
                for (k, values) in of_target(target).iter().enumerate() {
                    let time = evaluate(family, formula, values, cycle)?;
                    times.push(Time {
                        name: target.name.clone(),
                        member: target.each.then_some(k),
                        exact: time % cycle == 0,
                        cycles: rounding.cycles(time, cycle),
                        rounding: *rounding,
                    });
                }
            }
            Binding::Rank(list, names) => {
                let ranks = ranks(values.get(list).map_or(&[], Vec::as_slice));
                let cells = ranks.into_iter().map(|rank| vec![rank]);
                run.params.extend(names.iter().cloned().zip(cells));
                let sources = names.iter().map(|name| (name.clone(), list.clone()));
                run.sources.extend(sources);
                let text = format!("{list} by the order of its values only");
                run.abstractions.push(Abstraction::of_values(text));
            }
        }
    }
    let durations = system.durations.iter().map(|d| (d, cycle));
    let scanned = system.scanned.iter().map(|(d, scan)| (d, *scan));
    for ((name, us), cycle) in durations.chain(scanned) {
        let time = i64::try_from(*us).unwrap_or(i64::MAX);
        run.sources.insert(name.clone(), format!("T#{us}us"));
        times.push(Time {
            name: name.clone(),
            member: None,
            exact: time % cycle == 0,
            cycles: Rounding::Up.cycles(time, cycle),
            rounding: Rounding::Up,
        });
    }
    let longest = times.iter().map(|t| t.cycles).max().unwrap_or(0);
    let step = if system.scaled {
        up(longest, STEPS).max(1)
    } else {
        1
    };
    let coarser = times_text(&times, step, cycle).map(Abstraction::of_values);
    run.abstractions.extend(coarser);
    let mut steps: BTreeMap<String, Vec<i64>> = BTreeMap::new();
    for time in times {
        let cells = steps.entry(time.name).or_default();
        cells.push(up(time.cycles, step));
    }
    run.params.extend(steps);
    let most = explore.members.as_ref().map_or(0, |members| *members.end());
    for name in explore.params.iter().filter_map(Binding::array) {
        if let Some(cells) = run.params.get_mut(name) {
            // Cells beyond the members say nothing: copies of the first one are in its range.
            let first = cells.first().copied().unwrap_or_default();
            cells.resize(most, first);
        }
    }
    Ok(planned(run))
}

/// The values of a member, and those that stand beside them under names of their own.
fn with<'v>(values: &'v Values, beside: &[(&str, i64)]) -> Cow<'v, Values> {
    let mut all = Cow::Borrowed(values);
    for (name, value) in beside {
        all.to_mut().insert((*name).to_owned(), vec![*value]);
    }
    all
}

/// `a / b`, rounded up; both positive or 0.
fn up(a: i64, b: i64) -> i64 {
    a / b + i64::from(a % b != 0)
}

/// What the times lost, by the rule of each: `None` when each is a whole number of cycles and not scaled.
fn times_text(times: &[Time], step: i64, cycle: i64) -> Option<String> {
    let cycle = super::units::Dimension::Time.show(cycle);
    if step > 1 {
        let told = |t: &Time| format!(" {} cycles = {}", t.cycles, up(t.cycles, step));
        return Some(format!(
            "times in steps of {step} cycles of {cycle}, rounded up: {}",
            list(times.iter(), told)
        ));
    }
    let mut texts = Vec::new();
    for (rounding, word) in [(Rounding::Up, "up"), (Rounding::Down, "down")] {
        let rounded = times.iter().filter(|t| !t.exact && t.rounding == rounding);
        let text = list(rounded, |t| format!(" = {} cycles", t.cycles));
        if !text.is_empty() {
            texts.push(format!("times rounded {word} to cycles of {cycle}: {text}"));
        }
    }
    (!texts.is_empty()).then(|| texts.join("; "))
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
