//! `diff --trace`, a passive conformance test: the inputs of a recording on the monitors and on the tables, its outputs against
//! theirs.
//!
//! The monitors of all channels get what each channel saw and tell each other what they tell, as in a machine. The tables,
//! where a family has some that describe the same, get the same inputs of a channel; what no table says comes from the monitors. A recorded output agrees within a tolerance of n cycles if its value is there within n cycles on the other
//! side, and the other way round.

mod report;

use stillpoint_machine::Machine;
use stillpoint_show::diagram::Diagram;

use crate::families::{self, Owner, Rig, Words};
use crate::recording::{Recording, Role, Value};

/// What has come of a replay.
#[derive(Debug, Clone)]
pub struct Replayed {
    /// The machine.
    pub machine: String,
    /// Cycles of the recording.
    pub cycles: u64,
    /// The declared tolerance in cycles.
    pub tolerance: u32,
    /// The number of channels.
    pub channels: usize,
    /// The axes replayed.
    pub axes: Vec<AxisReplayed>,
    /// The axes that were not: no position of a channel is recorded, or no output.
    pub left_out: Vec<String>,
    /// Values compared, of all axes and cycles, on both sides.
    pub outputs_compared: u128,
    /// Every signal that differs, the earliest first.
    pub divergences: Vec<Divergence>,
    /// The first divergence, both sides.
    pub diagram: Option<Diagram>,
}

/// What was replayed of an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AxisReplayed {
    /// Its name.
    pub name: String,
    /// Outputs of the recording that were compared.
    pub outputs: usize,
    /// Cycles in which the tables stepped too, of all channels.
    pub table_cycles: u64,
    /// Inputs that the recording does not have, in neither channel: they kept their value at rest.
    pub missing: Vec<String>,
}

/// Which side a recording is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Against {
    /// The tables.
    Specification,
    /// The production monitors.
    Monitors,
}

impl Against {
    /// The word for it.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::Specification => "specification",
            Self::Monitors => "monitor",
        }
    }
}

/// A signal that differs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Divergence {
    /// The row of the recording in which it differs first.
    pub row: usize,
    /// The number of that cycle.
    pub cycle: u64,
    /// The signal.
    pub signal: String,
    /// Who says something else.
    pub against: Against,
    /// What is recorded.
    pub recorded: Value,
    /// What the other side says.
    pub replayed: Value,
}

/// The values of an output in each cycle, on one side; none where that side does not tell it.
struct Column {
    /// The place of the signal in the recording.
    signal: usize,
    against: Against,
    values: Vec<Option<Value>>,
}

/// Replays a recording of this machine.
///
/// # Errors
/// A sentence: no production monitors, nothing to replay, tables and monitors that do not fit each other.
pub fn replay(
    machine: &Machine,
    recording: &Recording,
    tolerance: u32,
) -> Result<Replayed, String> {
    let drive = families::of(machine)?;
    drive.accepts(machine)?;
    let mut axes = Vec::new();
    let mut left_out = Vec::new();
    let mut columns = Vec::new();
    let owners = drive.owners(machine);
    for places in drive.together(machine) {
        let parts = places.iter();
        let parts: Vec<Recorded> = parts
            .map(|k| Recorded::new(recording, *k, &owners[*k], drive.words()))
            .collect();
        let not = parts.iter().filter(|part| !part.is_compared());
        left_out.extend(not.map(|part| part.owner.name.clone()));
        if !parts
            .iter()
            .any(|p| p.owner.axis.is_some() && p.is_compared())
        {
            continue;
        }
        drive.play(machine, &places, true, &mut |rig| {
            let (replayed, own) = run(recording, &parts, rig);
            axes.extend(replayed);
            columns.extend(own);
        })?;
    }
    if axes.is_empty() {
        return Err(format!(
            "the recording has no axis of {} with `{}` of a channel and an output: nothing can be replayed",
            machine.name,
            drive.words().position
        ));
    }
    let mut divergences: Vec<Divergence> = columns
        .iter()
        .filter_map(|column| diverges(recording, column, tolerance as usize))
        .collect();
    divergences.sort_by(|a, b| (a.row, &a.signal, a.against).cmp(&(b.row, &b.signal, b.against)));
    let told = |column: &Column| column.values.iter().flatten().count() as u128;
    Ok(Replayed {
        machine: machine.name.clone(),
        cycles: recording.rows.len() as u64,
        tolerance,
        channels: drive.words().channels.len(),
        outputs_compared: columns.iter().map(told).sum(),
        diagram: report::diagram(recording, &columns, &divergences),
        axes,
        left_out,
        divergences,
    })
}

/// The first cycle in which the two sides of a column differ beyond the tolerance.
fn diverges(recording: &Recording, column: &Column, tolerance: usize) -> Option<Divergence> {
    let recorded: Vec<Option<&Value>> = recording.column(column.signal).collect();
    let other = &column.values;
    let last = recorded.len().checked_sub(1)?;
    let row = (0..recorded.len()).find(|k| {
        let (Some(a), Some(b)) = (recorded[*k], other[*k].as_ref()) else {
            return false;
        };
        let near = k.saturating_sub(tolerance)..=(k + tolerance).min(last);
        let there = near.clone().any(|n| other[n].as_ref() == Some(a));
        let here = near.into_iter().any(|n| recorded[n] == Some(b));
        !(there && here)
    })?;
    Some(Divergence {
        row,
        cycle: recording.cycle(row),
        signal: recording.signals[column.signal].name.clone(),
        against: column.against,
        recorded: recorded[row]?.clone(),
        replayed: other[row].clone()?,
    })
}

/// The signals of an owner in a recording.
struct Recorded<'a> {
    place: usize,
    owner: &'a Owner,
    /// Its position is recorded, if it is an axis.
    has_position: bool,
    /// For each input and each channel, its place in the recording.
    inputs: Vec<[Option<usize>; 2]>,
    /// The outputs that the recording has: channel, output, place.
    outputs: Vec<(usize, usize, usize)>,
}

impl<'a> Recorded<'a> {
    fn new(recording: &Recording, place: usize, owner: &'a Owner, words: &Words) -> Self {
        let find = |side: usize, signal: &str, role: Role| {
            let channel = words.channels.get(side)?;
            recording
                .find(&owner.signal(channel, signal))
                .filter(|k| recording.signals[*k].role == role)
        };
        let inputs = owner.inputs.iter();
        let inputs = inputs.map(|port| [0, 1].map(|side| find(side, port.name, Role::Input)));
        let inputs: Vec<[Option<usize>; 2]> = inputs.collect();
        let mut outputs = Vec::new();
        for side in 0..2 {
            for (n, port) in owner.outputs.iter().enumerate() {
                if let Some(k) = find(side, port.name, Role::Output) {
                    outputs.push((side, n, k));
                }
            }
        }
        let mut known = owner.inputs.iter().zip(&inputs);
        let has_position = owner.axis.is_none()
            || known.any(|(port, places)| {
                port.name == words.position && places.iter().any(Option::is_some)
            });
        Self {
            place,
            owner,
            has_position,
            inputs,
            outputs,
        }
    }

    /// Whether anything of it can be compared.
    fn is_compared(&self) -> bool {
        self.has_position && !self.outputs.is_empty()
    }

    fn missing(&self) -> Vec<String> {
        let inputs = self.owner.inputs.iter().zip(&self.inputs);
        let none = inputs.filter(|(_, places)| **places == [None, None]);
        none.map(|(port, _)| port.name.to_owned()).collect()
    }

    /// What the channels saw in a cycle; what is recorded of one channel only counts for both.
    fn see(&self, values: &[Option<Value>], rig: &mut dyn Rig) {
        for side in 0..2 {
            for (input, places) in self.inputs.iter().enumerate() {
                let place = places[side].or(places[1 - side]);
                if let Some(value) = place.and_then(|k| values[k].as_ref()) {
                    // The reader has checked kind and values.
                    let _ = rig.set(self.place, side, input, value);
                }
            }
        }
    }

    /// What a channel says in a cycle.
    fn said(&self, values: &[Option<Value>], side: usize, output: &str) -> Option<Value> {
        let mut outputs = self.outputs.iter();
        let (_, _, k) =
            outputs.find(|(s, n, _)| *s == side && self.owner.outputs[*n].name == output)?;
        values[*k].clone()
    }
}

/// Replays what runs together.
fn run(
    recording: &Recording,
    parts: &[Recorded<'_>],
    rig: &mut dyn Rig,
) -> (Vec<AxisReplayed>, Vec<Column>) {
    let compared: Vec<&Recorded> = parts.iter().filter(|part| part.is_compared()).collect();
    let outputs = || {
        let parts = compared.iter();
        parts.flat_map(|part| part.outputs.iter().map(|output| (part.place, *output)))
    };
    let columns = |against| -> Vec<Column> {
        let columns = outputs().map(|(_, (.., k))| Column {
            signal: k,
            against,
            values: Vec::new(),
        });
        columns.collect()
    };
    let mut monitors = columns(Against::Monitors);
    let mut specified = columns(Against::Specification);
    for (row, values) in recording.rows.iter().enumerate() {
        rig.rest(row == 0);
        parts.iter().for_each(|part| part.see(values, rig));
        if row == 0 {
            rig.resume(&|owner, side, output| {
                let part = parts.iter().find(|part| part.place == owner)?;
                part.said(values, side, output)
            });
        }
        rig.step();
        for (n, (owner, (side, output, _))) in outputs().enumerate() {
            monitors[n]
                .values
                .push(Some(rig.output(owner, side, output)));
            specified[n].values.push(rig.specified(owner, side, output));
        }
    }
    let replayed = compared.iter().map(|part| AxisReplayed {
        name: part.owner.name.clone(),
        outputs: part.outputs.len(),
        table_cycles: rig.table_cycles(),
        missing: part.missing(),
    });
    let replayed = replayed.collect();
    specified.retain(|column| column.values.iter().any(Option::is_some));
    monitors.extend(specified);
    (replayed, monitors)
}
