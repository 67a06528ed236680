//! What a simulation has shown: stops with their reason, standstill and over-travel, and whether the expectations hold.

use stillpoint_machine::units::Dimension;
use stillpoint_machine::{Axis, AxisKind, Machine};

use super::scenario::{Expect, Scenario};
use crate::families::{Drive, Said, Windows, Words};
use crate::recording::{Kind, Recording, Value, vocabulary};

/// A finished simulation.
#[derive(Clone)]
pub struct Simulation {
    /// What it shows.
    pub title: String,
    /// Every signal in every cycle.
    pub recording: Recording,
    /// The stops, in the order in which they came.
    pub stops: Vec<Stop>,
    /// The expectations, in the order of the file.
    pub judged: Vec<Judged>,
    /// Times that are no whole number of cycles, and what became of them.
    pub roundings: Vec<String>,
    /// The axes, as the machine has them.
    pub(super) axes: Vec<Shown>,
    /// What has signals beside the axes: its name, and which.
    pub(super) others: Vec<(String, Vec<&'static str>)>,
    /// What its family calls things.
    pub(super) words: &'static Words,
}

/// An axis as it is shown.
#[derive(Clone)]
pub(super) struct Shown {
    pub name: String,
    pub kind: AxisKind,
    pub windows: Windows,
    /// Inputs that are true or false.
    pub flags: Vec<&'static str>,
}

/// A stop of an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stop {
    /// The axis.
    pub axis: String,
    /// Its name: `STOP A`, `SS1`.
    pub name: String,
    /// The cycle in which it took effect in the first channel.
    pub cycle: u64,
    /// The channels in which it took effect in that cycle: one, or both with `and` between.
    pub channels: String,
    /// Why, in words.
    pub reason: String,
    /// The speed in that cycle, in thousandths of an increment per cycle, with its sign.
    pub speed: i64,
    /// The cycle from which the axis stands until its stops are acknowledged or the simulation ends; none: it does not stand
    /// by then.
    pub stands: Option<u64>,
    /// How far the axis went from that cycle on until it stood, at most, in thousandths of an increment.
    pub travel: i64,
    /// The same in the unit of the axis: `1.234 mm`.
    pub travel_shown: String,
}

/// An expectation and what came of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Judged {
    /// The expectation in words.
    pub text: String,
    /// Whether it holds.
    pub holds: bool,
    /// The first cycle in which it was the case, within the time.
    pub cycle: Option<u64>,
}

pub(super) fn summarise(
    machine: &Machine,
    drive: &'static dyn Drive,
    scenario: &Scenario,
    recording: Recording,
) -> Simulation {
    let mut stops: Vec<Stop> = machine
        .axes
        .iter()
        .flat_map(|axis| stops_of(drive, axis, &recording))
        .collect();
    stops.sort_by_key(|stop| stop.cycle);
    let judged = scenario
        .expects
        .iter()
        .map(|e| judge(e, &recording))
        .collect();
    let mut owners = drive.owners(machine);
    let others = owners.split_off(machine.axes.len()).into_iter();
    let others = others.map(|owner| {
        let ports = owner.inputs.iter().chain(&owner.outputs);
        (owner.name, ports.map(|port| port.name).collect())
    });
    let axes = machine.axes.iter().zip(owners);
    let axes = axes.map(|(axis, owner)| {
        let flags = owner.inputs.iter().filter(|i| i.kind == Kind::Bool);
        Shown {
            name: axis.name.clone(),
            kind: axis.kind,
            windows: drive.windows(axis),
            flags: flags.map(|i| i.name).collect(),
        }
    });
    Simulation {
        title: scenario.title.clone(),
        stops,
        judged,
        roundings: scenario.roundings.clone(),
        axes: axes.collect(),
        others: others.collect(),
        words: drive.words(),
        recording,
    }
}

/// The values of a signal as texts; empty where it has none.
fn texts<'a>(recording: &'a Recording, name: &str) -> Vec<&'a str> {
    let Some(signal) = recording.find(name) else {
        return vec![""; recording.rows.len()];
    };
    let text = |value: Option<&'a Value>| match value {
        Some(Value::Text(text)) => text.as_ref(),
        _ => "",
    };
    recording.column(signal).map(text).collect()
}

/// The values of a signal as numbers; 0 where it has none.
pub(super) fn numbers(recording: &Recording, name: &str) -> Vec<i64> {
    let Some(signal) = recording.find(name) else {
        return vec![0; recording.rows.len()];
    };
    let number = |value: Option<&Value>| match value {
        Some(Value::Int(n)) => *n,
        _ => 0,
    };
    recording.column(signal).map(number).collect()
}

fn stops_of(drive: &dyn Drive, axis: &Axis, recording: &Recording) -> Vec<Stop> {
    let words = drive.words();
    let rank = |letter: &str| words.stops.iter().position(|l| *l == letter).unwrap_or(0);
    let channel =
        |channel: &str, name: &str| texts(recording, &format!("{}.{channel}.{name}", axis.name));
    let channels = words.channels.iter();
    let stops: Vec<Vec<&str>> = channels.map(|c| channel(c, vocabulary::STOP)).collect();
    let plant = |name: &str| numbers(recording, &format!("{}.{name}", axis.name));
    let (positions, speeds) = (plant(vocabulary::POSITION), plant(vocabulary::VELOCITY));
    // The first of the highest.
    let higher = |k: usize| {
        let stops = stops.iter().rev().map(|of_channel| of_channel[k]);
        stops.max_by_key(|stop| rank(stop)).unwrap_or("")
    };
    let changes: Vec<usize> = (0..recording.rows.len())
        .filter(|k| rank(higher(*k)) > 0 && (*k == 0 || higher(*k) != higher(k - 1)))
        .collect();
    let mut out = Vec::new();
    for row in changes.iter().copied() {
        let letter = higher(row);
        // Until the stops are acknowledged; a higher stop that follows belongs to the same way to standstill.
        let end = (row..recording.rows.len()).find(|k| rank(higher(*k)) == 0);
        let end = end.unwrap_or(recording.rows.len());
        // It stands once it stands until something else happens to it, or for good.
        let next = |k: usize| {
            changes
                .iter()
                .copied()
                .find(|c| *c > k)
                .unwrap_or(end)
                .min(end)
        };
        let stands = (row..end).find(|k| speeds[*k..next(*k)].iter().all(|s| *s == 0));
        let until = stands.map_or(end, |k| k + 1);
        let travel = positions[row..until]
            .iter()
            .map(|p| (p - positions[row]).abs())
            .max();
        let travel = travel.unwrap_or(0);
        let channels = words.channels.iter().zip(&stops);
        let channels: Vec<&str> = channels
            .filter_map(|(name, stops)| (stops[row] == letter).then_some(*name))
            .collect();
        let mut sides = words.channels.iter();
        let side = sides.position(|name| Some(name) == channels.first());
        let side = side.unwrap_or(0);
        out.push(Stop {
            axis: axis.name.clone(),
            name: format!("{}{letter}", words.stop),
            cycle: recording.cycle(row),
            channels: channels.join(" and "),
            reason: drive.reason(&Said {
                side,
                value: &|name, before| {
                    let side = words.channels[side];
                    let signal = recording.find(&format!("{}.{side}.{name}", axis.name))?;
                    recording
                        .rows
                        .get(row.checked_sub(before)?)?
                        .get(signal)?
                        .clone()
                },
            }),
            speed: speeds[row],
            stands: stands.map(|k| recording.cycle(k)),
            travel,
            travel_shown: length(travel, axis.kind),
        });
    }
    out
}

/// A length in thousandths of an increment, rounded up to whole increments, in the unit of the axis.
fn length(thousandths: i64, kind: AxisKind) -> String {
    let increments = thousandths.div_euclid(1_000) + i64::from(thousandths.rem_euclid(1_000) != 0);
    match kind {
        AxisKind::Linear => Dimension::Length.show(increments),
        AxisKind::Rotary => Dimension::Angle.show(increments),
    }
}

fn judge(expect: &Expect, recording: &Recording) -> Judged {
    let window = expect.after as usize..=expect.by as usize;
    let condition = &expect.condition;
    let signals = condition.names.iter().map(|name| recording.find(name));
    let signals: Vec<Option<usize>> = signals.collect();
    let holds_in = |row: usize| {
        let is = |signal: &Option<usize>| {
            let value = signal.and_then(|s| recording.rows[row].get(s)?.as_ref());
            value.is_some_and(|value| condition.is.fits(value))
        };
        match expect.never {
            true => signals.iter().any(is),
            false => signals.iter().all(is),
        }
    };
    let row = window
        .filter(|row| *row < recording.rows.len())
        .find(|row| holds_in(*row));
    Judged {
        text: expect.text.clone(),
        holds: row.is_some() != expect.never,
        cycle: row.map(|row| recording.cycle(row)),
    }
}
