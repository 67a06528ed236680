//! `diff --trace`: the inputs of a recording on the monitors and on the tables, its outputs against theirs.
//!
//! The monitors of both channels get what each channel saw and tell each other what they tell, as in a machine. The tables
//! get the same inputs of a channel; what the comparison, the user agreement and the other channel say to it comes from the
//! monitors. A recorded output agrees within a tolerance of n cycles if its value is there within n cycles on the other
//! side, and the other way round.

mod show;
mod table;

use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Outputs, Pair, State};
use stillpoint_show::diagram::Diagram;
use stillpoint_spec::machine::Machine;

use crate::production::{self, Produced};
use crate::recording::{Recording, Role, Value, vocabulary};
use table::{Basis, Tables};

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
    let produced = production::axes(machine)?;
    let mut axes = Vec::new();
    let mut left_out = Vec::new();
    let mut columns = Vec::new();
    for (k, produced) in produced.iter().enumerate() {
        let recorded = Recorded::new(recording, &produced.name);
        if !recorded.has_position() || recorded.outputs.is_empty() {
            left_out.push(produced.name.clone());
            continue;
        }
        let basis = Basis::new(machine, k, produced)?;
        let tables = Tables::new(basis.as_ref(), produced)?;
        let (replayed, own) = recorded.replay(produced, tables);
        axes.push(replayed);
        columns.extend(own);
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
    /// For each input of the vocabulary and each channel, its place in the recording.
    inputs: Vec<(vocabulary::Input, [Option<usize>; 2])>,
    /// The outputs that the recording has: channel, output, place.
    outputs: Vec<(usize, vocabulary::Output, usize)>,
    name: String,
}

impl<'a> Recorded<'a> {
    fn new(recording: &'a Recording, name: &str) -> Self {
        let place = |side: usize, signal: &str, role: Role| {
            let full = format!("{name}.{}.{signal}", vocabulary::CHANNELS[side]);
            recording
                .find(&full)
                .filter(|k| recording.signals[*k].role == role)
        };
        let inputs = vocabulary::inputs().into_iter().map(|input| {
            (
                input,
                [0, 1].map(|side| place(side, input.name, Role::Input)),
            )
        });
        let mut outputs = Vec::new();
        for side in 0..2 {
            for output in vocabulary::outputs() {
                if let Some(k) = place(side, output.name, Role::Output) {
                    outputs.push((side, output, k));
                }
            }
        }
        Self {
            recording,
            inputs: inputs.collect(),
            outputs,
            name: name.to_owned(),
        }
    }

    fn has_position(&self) -> bool {
        let mut inputs = self.inputs.iter();
        inputs.any(|(input, places)| {
            input.name == vocabulary::POSITION && places.iter().any(Option::is_some)
        })
    }

    fn missing(&self) -> Vec<String> {
        let none = self
            .inputs
            .iter()
            .filter(|(_, places)| *places == [None, None]);
        none.map(|(input, _)| input.name.to_owned()).collect()
    }

    /// What a channel saw in a cycle; what is recorded of the other channel only counts for both.
    fn local(&self, row: usize, side: usize) -> Local {
        let mut local = Local {
            power_on: row == 0,
            run_up: true,
            spl_started: true,
            sge: Sge::UNUSED,
            ..Local::default()
        };
        for (input, places) in &self.inputs {
            let place = places[side].or(places[1 - side]);
            let values = self.recording.rows[row].as_slice();
            if let Some(value) = place.and_then(|k| values[k].as_ref()) {
                // The reader has checked the kind; a number outside its range is left at rest.
                let _ = input.set(&mut local, value);
            }
        }
        local
    }

    /// What was kept through power-off: the agreement that the first cycle shows, and the first position.
    fn kept(&self) -> State {
        let agreed = |side: usize| {
            let mut outputs = self.outputs.iter();
            let found = outputs.find(|(s, o, _)| *s == side && o.name == "user_agreement");
            let value = found.and_then(|(_, _, k)| self.recording.rows.first()?[*k].clone());
            value == Some(Value::Bool(true))
        };
        let channel = |side: usize| {
            let Position(at) = self.local(0, side).position;
            let kept = agreed(side).then_some(Position(at));
            axis::State::restored(agreed(side), kept)
        };
        State::restored(channel(0), channel(1))
    }

    fn replay(&self, produced: &Produced, mut tables: Tables<'_>) -> (AxisReplayed, Vec<Column>) {
        let config = Config::new(produced.configuration);
        // The state is made here, and consistent; an initial one would be, too.
        let mut pair = Pair::resume(config, self.kept()).unwrap_or_else(|_| Pair::new(config));
        let column = |signal, against| Column {
            signal,
            against,
            values: Vec::new(),
        };
        let monitors = self
            .outputs
            .iter()
            .map(|(.., k)| column(*k, Against::Monitors));
        let specified = self
            .outputs
            .iter()
            .map(|(.., k)| column(*k, Against::Specification));
        let (mut monitors, mut specified): (Vec<Column>, Vec<Column>) =
            (monitors.collect(), specified.collect());
        for row in 0..self.recording.rows.len() {
            let before = *pair.state();
            let inputs = Inputs {
                nck: self.local(row, 0),
                drive: self.local(row, 1),
            };
            let outputs = pair.step(&inputs);
            tables.step(&before, pair.state(), &inputs, &outputs);
            for (n, (side, output, _)) in self.outputs.iter().enumerate() {
                let (local, own) = side_of(&inputs, &outputs, *side);
                monitors[n].values.push(Some(output.get(*side, local, own)));
                specified[n].values.push(tables.output(*side, output.name));
            }
        }
        let replayed = AxisReplayed {
            name: self.name.clone(),
            outputs: self.outputs.len(),
            table_cycles: tables.cycles(),
            missing: self.missing(),
        };
        specified.retain(|column| column.values.iter().any(Option::is_some));
        monitors.extend(specified);
        (replayed, monitors)
    }
}

fn side_of<'a>(
    inputs: &'a Inputs,
    outputs: &'a Outputs,
    side: usize,
) -> (&'a Local, &'a axis::Outputs) {
    match side {
        0 => (&inputs.nck, &outputs.nck),
        _ => (&inputs.drive, &outputs.drive),
    }
}
