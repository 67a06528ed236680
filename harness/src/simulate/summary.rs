//! What a simulation has shown: stops with their reason, standstill and over-travel, and whether the expectations hold.

use stillpoint_spec::machine::units::Dimension;
use stillpoint_spec::machine::{Axis, AxisKind, Machine};

use super::scenario::{Expect, Scenario};
use crate::production::Produced;
use crate::recording::{Recording, Value, vocabulary};

/// A finished simulation.
#[derive(Debug, Clone)]
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
}

/// An axis as it is shown.
#[derive(Debug, Clone)]
pub(super) struct Shown {
    pub name: String,
    pub kind: AxisKind,
    pub standstill_tol: i64,
    pub plus: [i32; 2],
    pub minus: [i32; 2],
}

/// A stop of an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stop {
    /// The axis.
    pub axis: String,
    /// `A` to `F`, or `TEST`.
    pub letter: String,
    /// The cycle in which it took effect in the first channel.
    pub cycle: u64,
    /// The channels in which it took effect in that cycle: `nck`, `drive` or `nck and drive`.
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
    scenario: &Scenario,
    recording: Recording,
    produced: &[Produced],
) -> Simulation {
    let mut stops: Vec<Stop> = machine
        .axes
        .iter()
        .flat_map(|axis| stops_of(axis, &recording))
        .collect();
    stops.sort_by_key(|stop| stop.cycle);
    let judged = scenario
        .expects
        .iter()
        .map(|e| judge(e, &recording))
        .collect();
    let axes = machine
        .axes
        .iter()
        .zip(produced)
        .map(|(axis, produced)| Shown {
            name: axis.name.clone(),
            kind: axis.kind,
            standstill_tol: i64::from(produced.parameters.standstill_tol),
            plus: produced.parameters.pos_limit_plus,
            minus: produced.parameters.pos_limit_minus,
        });
    Simulation {
        title: scenario.title.clone(),
        stops,
        judged,
        roundings: scenario.roundings.clone(),
        axes: axes.collect(),
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

/// Stops in rising order; a position is a rank.
const LETTERS: [&str; 8] = ["NONE", "F", "E", "D", "C", "TEST", "B", "A"];

fn rank(letter: &str) -> usize {
    LETTERS.iter().position(|l| *l == letter).unwrap_or(0)
}

fn stops_of(axis: &Axis, recording: &Recording) -> Vec<Stop> {
    let channel =
        |channel: &str, name: &str| texts(recording, &format!("{}.{channel}.{name}", axis.name));
    let [nck, drive] = vocabulary::CHANNELS.map(|c| channel(c, "stop"));
    let plant = |name: &str| numbers(recording, &format!("{}.{name}", axis.name));
    let (positions, speeds) = (plant(vocabulary::POSITION), plant(vocabulary::VELOCITY));
    let higher = |k: usize| match rank(nck[k]) >= rank(drive[k]) {
        true => nck[k],
        false => drive[k],
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
        let told = [nck[row] == letter, drive[row] == letter];
        let channels: Vec<&str> = vocabulary::CHANNELS
            .into_iter()
            .zip(told)
            .filter_map(|(name, here)| here.then_some(name))
            .collect();
        out.push(Stop {
            axis: axis.name.clone(),
            letter: letter.to_owned(),
            cycle: recording.cycle(row),
            channels: channels.join(" and "),
            reason: reason(
                recording,
                &axis.name,
                channels.first().unwrap_or(&"nck"),
                row,
            ),
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

/// Why a channel stops: the first cause that its outputs name.
fn reason(recording: &Recording, axis: &str, channel: &str, row: usize) -> String {
    let value = |name: &str| {
        let signal = recording.find(&format!("{axis}.{channel}.{name}"))?;
        recording.rows.get(row)?.get(signal)?.clone()
    };
    let text = |name: &str| match value(name) {
        Some(Value::Text(text)) => text.into_owned(),
        _ => String::new(),
    };
    let stop = text("stop");
    let alarms = text("alarms");
    let alarm = |number: &str| alarms.split(' ').any(|a| a == number);
    let of = |nck: &str, drive: &str, words: &str| {
        let number = if channel == "nck" { nck } else { drive };
        alarm(number).then(|| format!("{words} (alarm {number})"))
    };
    let code = match value("fault_code") {
        Some(Value::Int(code)) if code > 0 => format!(", code {code}"),
        _ => String::new(),
    };
    let found = match stop.as_str() {
        "F" => of("27001", "300911", &format!("cross comparison{code}")),
        "TEST" => Some("test of the shutdown path".to_owned()),
        "B" if text("stop_phase") == "B_BRAKING" && !alarm("27010") && !alarm("300907") => {
            matches!(value("fault"), Some(Value::Bool(true)))
                .then(|| "the delay after STOP F has passed".to_owned())
        }
        _ => None,
    };
    found
        .or_else(|| of("27013", "300906", "braking ramp exceeded"))
        .or_else(|| of("27010", "300907", "standstill tolerance exceeded"))
        .or_else(|| of("27011", "300914", "speed limit exceeded"))
        .or_else(|| of("27012", "300915", "limit position passed"))
        .or_else(|| of("27001", "300911", &format!("cross comparison{code}")))
        .or_else(|| {
            let started = value("spl_started") != Some(Value::Bool(false));
            (!started && stop == "A").then(|| "the safe logic has not been started".to_owned())
        })
        .or_else(|| (text("stop_external") == stop).then(|| "asked for by a signal".to_owned()))
        .or_else(|| {
            let before = row.checked_sub(1)?;
            let signal = recording.find(&format!("{axis}.{channel}.stop"))?;
            let earlier = recording.rows.get(before)?.get(signal)?.clone()?;
            (stop == "A" && earlier == Value::Text("B".into()))
                .then(|| "STOP B has ended".to_owned())
        })
        .unwrap_or_else(|| "told by the other channel".to_owned())
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
