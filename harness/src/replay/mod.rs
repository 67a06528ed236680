//! `diff --trace`: the inputs of a recording on the monitors and on the tables, its outputs against theirs.
//!
//! The monitors of both channels get what each channel saw and tell each other what they tell, as in a machine. The tables
//! get the same inputs of a channel; what the comparison, the user agreement and the other channel say to it comes from the
//! monitors. A recorded output agrees within a tolerance of n cycles if its value is there within n cycles on the other
//! side, and the other way round.

mod show;

use stillpoint_machine::Machine;
use stillpoint_show::diagram::Diagram;

use crate::families::{self, Owner, Rig};
use crate::recording::{Recording, Role, Value, vocabulary};

/// What has come of a replay.
#[derive(Debug, Clone)]
pub struct Replayed {
    /// The machine.
    pub machine: String,
    /// Cycles of the recording.
    pub cycles: u64,
    /// The declared tolerance in cycles.
    pub tolerance: u32,
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
    /// Cycles in which the tables stepped too, of both channels.
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
    let channels = drive.words().channels;
    let mut axes = Vec::new();
    let mut left_out = Vec::new();
    let mut columns = Vec::new();
    for (k, owner) in drive.owners(machine).iter().enumerate() {
        let recorded = Recorded::new(recording, owner, channels);
        if !recorded.has_position() || recorded.outputs.is_empty() {
            left_out.push(owner.name.clone());
            continue;
        }
        drive.play(machine, k, true, &mut |rig| {
            let (replayed, own) = recorded.replay(rig);
            axes.push(replayed);
            columns.extend(own);
        })?;
    }
    if axes.is_empty() {
        return Err(format!(
            "the recording has no axis of {} with `{}` of a channel and an output: nothing can be replayed",
            machine.name,
            vocabulary::POSITION
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
        outputs_compared: columns.iter().map(told).sum(),
        diagram: show::diagram(recording, &columns, &divergences),
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

/// The signals of one axis in a recording.
struct Recorded<'a> {
    recording: &'a Recording,
    owner: &'a Owner,
    /// For each input and each channel, its place in the recording.
    inputs: Vec<[Option<usize>; 2]>,
    /// The outputs that the recording has: channel, output, place.
    outputs: Vec<(usize, usize, usize)>,
}

impl<'a> Recorded<'a> {
    fn new(recording: &'a Recording, owner: &'a Owner, channels: [&str; 2]) -> Self {
        let place = |side: usize, signal: &str, role: Role| {
            recording
                .find(&owner.signal(channels[side], signal))
                .filter(|k| recording.signals[*k].role == role)
        };
        let inputs = owner.inputs.iter();
        let inputs = inputs.map(|port| [0, 1].map(|side| place(side, port.name, Role::Input)));
        let mut outputs = Vec::new();
        for side in 0..2 {
            for (n, port) in owner.outputs.iter().enumerate() {
                if let Some(k) = place(side, port.name, Role::Output) {
                    outputs.push((side, n, k));
                }
            }
        }
        Self {
            recording,
            owner,
            inputs: inputs.collect(),
            outputs,
        }
    }

    fn has_position(&self) -> bool {
        let mut inputs = self.owner.inputs.iter().zip(&self.inputs);
        inputs.any(|(port, places)| {
            port.name == vocabulary::POSITION && places.iter().any(Option::is_some)
        })
    }

    fn missing(&self) -> Vec<String> {
        let inputs = self.owner.inputs.iter().zip(&self.inputs);
        let none = inputs.filter(|(_, places)| **places == [None, None]);
        none.map(|(port, _)| port.name.to_owned()).collect()
    }

    /// What the channels saw in a cycle; what is recorded of one channel only counts for both.
    fn see(&self, row: usize, rig: &mut dyn Rig) {
        rig.rest(row == 0);
        let values = self.recording.rows[row].as_slice();
        for side in 0..2 {
            for (input, places) in self.inputs.iter().enumerate() {
                let place = places[side].or(places[1 - side]);
                if let Some(value) = place.and_then(|k| values[k].as_ref()) {
                    // The reader has checked the kind; a number outside its range is left at rest.
                    let _ = rig.set(side, input, value);
                }
            }
        }
    }

    /// What a channel says in the first cycle.
    fn first(&self, side: usize, output: &str) -> Option<Value> {
        let mut outputs = self.outputs.iter();
        let (_, _, k) =
            outputs.find(|(s, n, _)| *s == side && self.owner.outputs[*n].name == output)?;
        self.recording.rows.first()?[*k].clone()
    }

    fn replay(&self, rig: &mut dyn Rig) -> (AxisReplayed, Vec<Column>) {
        let columns = |against| -> Vec<Column> {
            let outputs = self.outputs.iter();
            let columns = outputs.map(|(.., k)| Column {
                signal: *k,
                against,
                values: Vec::new(),
            });
            columns.collect()
        };
        let mut monitors = columns(Against::Monitors);
        let mut specified = columns(Against::Specification);
        for row in 0..self.recording.rows.len() {
            self.see(row, rig);
            if row == 0 {
                rig.resume(&|side, output| self.first(side, output));
            }
            rig.step();
            for (n, (side, output, _)) in self.outputs.iter().enumerate() {
                monitors[n].values.push(Some(rig.output(*side, *output)));
                specified[n].values.push(rig.specified(*side, *output));
            }
        }
        let replayed = AxisReplayed {
            name: self.owner.name.clone(),
            outputs: self.outputs.len(),
            table_cycles: rig.table_cycles(),
            missing: self.missing(),
        };
        specified.retain(|column| column.values.iter().any(Option::is_some));
        monitors.extend(specified);
        (replayed, monitors)
    }
}
