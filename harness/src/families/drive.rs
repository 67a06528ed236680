//! What whole machines of a family are to the commands: the trait [`Drive`].
//!
//! A simulation, a recording, a replay, the results of an acceptance test and a walk work with any family that implements it.

use stillpoint_machine::{Axis as MachineAxis, AxisKind, Machine};

use crate::plant::{Axis, Door};
use crate::recording::vocabulary::Unit;
use crate::recording::{Allowed, Kind, Role, Signal, Value};

/// A family of drives whose production monitors run whole axes.
pub trait Drive: Sync {
    /// What it calls things.
    fn words(&self) -> &'static Words;

    /// Whether the monitors accept the values of a machine.
    ///
    /// # Errors
    /// A sentence that names the axis.
    fn accepts(&self, machine: &Machine) -> Result<(), String>;

    /// What has signals in the channels: the axes of the machine in their order, then what else there is.
    fn owners(&self, machine: &Machine) -> Vec<Owner>;

    /// The alarms, each with the channel that raises it.
    fn alarms(&self) -> Vec<(String, usize)>;

    /// What is watched of an axis and drawn beside its position.
    fn windows(&self, axis: &MachineAxis) -> Windows;

    /// The limit of a stage of [`Words::stages`], in base units per minute.
    fn stage(&self, machine: &Machine, axis: &MachineAxis, stage: usize) -> Option<i64>;

    /// With which acceleration the control moves an axis and with which the drive brakes along its ramp, where the machine file tells
    /// it: texts as a scenario has them.
    fn ramps(&self, _axis: &MachineAxis) -> Option<[String; 2]> {
        None
    }

    /// Why a channel stops, in words.
    fn reason(&self, said: &Said<'_>) -> String;

    /// The monitors of the machine at the start of a scenario.
    ///
    /// # Errors
    /// Those of [`Drive::accepts`].
    fn power<'a>(
        &self,
        machine: &'a Machine,
        axes: &[Axis],
        start: &Start,
    ) -> Result<Box<dyn Monitors + 'a>, String>;

    /// The owners by their places, those together whose monitors run together: each axis by itself, or the whole machine.
    fn together(&self, machine: &Machine) -> Vec<Vec<usize>> {
        (0..machine.axes.len()).map(|axis| vec![axis]).collect()
    }

    /// Drives the monitors of owners that run together, which are one entry of [`Drive::together`], with their tables beside them
    /// if asked for.
    ///
    /// # Errors
    /// Those of [`Drive::accepts`]; tables and monitors that do not fit each other.
    fn play(
        &self,
        machine: &Machine,
        owners: &[usize],
        tables: bool,
        play: &mut dyn FnMut(&mut dyn Rig),
    ) -> Result<(), String>;

    /// What the inputs of the tables are to the channels: what a walk through them gives to the monitors.
    /// Empty where the tables have values of their own for positions and speeds: no walk can be recorded.
    fn feeds(&self) -> &'static [Feed] {
        &[]
    }
}

/// What a family calls things, in scenarios, in reports and in diagrams.
pub struct Words {
    /// The channels, one or two, in the order in which they are stored.
    pub channels: &'static [&'static str],
    /// The encoders of an axis, at most [`crate::plant::ENCODERS`]: those of the channels, or others.
    pub encoders: &'static [&'static str],
    /// Which of them comes by a telegram that may stand, by its place.
    pub telegram: Option<usize>,
    /// The function that an axis needs for brakes that are simulated; none: there are no such brakes.
    pub brakes: Option<&'static str>,
    /// The same for the load on its rope.
    pub load: Option<&'static str>,
    /// How fine a channel sees a position, in um or thousandths of a degree.
    pub resolution: i64,
    /// The stops in rising order, from none on.
    pub stops: &'static [&'static str],
    /// The same for a reader who looks for one.
    pub stops_listed: &'static [&'static str],
    /// What a sentence puts before the name of a stop.
    pub stop: &'static str,
    /// What a mode can select, and the function that an axis needs for it.
    pub selections: (&'static [&'static str], Option<&'static str>),
    /// It is selected for the whole machine.
    pub of_machine: bool,
    /// The pairs of limit positions that can be selected, and the function that an axis needs for it.
    pub limits: (&'static [&'static str], Option<&'static str>),
    /// The stops that can be asked for from outside, each with the function that an axis needs for it.
    pub asked: &'static [(&'static str, Option<&'static str>)],
    /// The stages of the speed, of whose limit a setpoint may be a share.
    pub stages: &'static [&'static str],
    /// The input that is the position of an axis: without it nothing of an axis can be replayed.
    pub position: &'static str,
    /// The inputs that every recording of a walk tells, beside the position.
    pub told: &'static [&'static str],
    /// An input, as an example.
    pub example: &'static str,
    /// Inputs that are true for a cycle: lanes of their own.
    pub events: &'static [&'static str],
    /// Outputs that are shown where they change: all channels in one lane while they agree.
    pub lanes: &'static [&'static str],
    /// What is drawn beside a curve: limit of the speed, the same backwards, window of the standstill, limit positions.
    pub curves: [&'static str; 4],
}

/// What has signals: an axis, or a part of the machine that is none.
pub struct Owner {
    /// Its name, the first part of the names of its signals.
    pub name: String,
    /// The kind of the axis; none for what is no axis.
    pub axis: Option<AxisKind>,
    /// The signals that a channel reads.
    pub inputs: Vec<Port>,
    /// The signals that a channel writes.
    pub outputs: Vec<Port>,
}

impl Owner {
    /// An axis.
    pub fn of_axis(axis: &MachineAxis, inputs: Vec<Port>, outputs: Vec<Port>) -> Self {
        Self {
            name: axis.name.clone(),
            axis: Some(axis.kind),
            inputs,
            outputs,
        }
    }

    /// The full name of a signal in a channel.
    pub fn signal(&self, channel: &str, name: &str) -> String {
        format!("{}.{channel}.{name}", self.name)
    }

    /// Its signals in a channel, as a recording declares them.
    pub fn signals(&self, channel: &str) -> Vec<Signal> {
        let rotary = self.axis == Some(AxisKind::Rotary);
        let declared = |port: &Port, role| Signal {
            name: self.signal(channel, port.name),
            kind: port.kind,
            unit: port.unit.text(rotary).to_owned(),
            role,
            allowed: port.allowed,
        };
        let inputs = self.inputs.iter().map(|port| declared(port, Role::Input));
        let outputs = self.outputs.iter().map(|port| declared(port, Role::Output));
        inputs.chain(outputs).collect()
    }
}

/// A signal of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port {
    /// Its name within the channel.
    pub name: &'static str,
    /// What its values are.
    pub kind: Kind,
    /// What a number counts.
    pub unit: Unit,
    /// Its values.
    pub allowed: Allowed,
}

impl Port {
    /// One that is true or false.
    pub const fn flag(name: &'static str) -> Self {
        Self {
            name,
            kind: Kind::Bool,
            unit: Unit::None,
            allowed: Allowed::All,
        }
    }

    /// A text.
    pub const fn text(name: &'static str) -> Self {
        Self {
            kind: Kind::Text,
            ..Self::flag(name)
        }
    }

    /// A number.
    pub const fn number(name: &'static str, unit: Unit) -> Self {
        Self {
            kind: Kind::Int,
            unit,
            ..Self::flag(name)
        }
    }

    /// Whether it can have this value.
    pub fn admits(&self, value: &Value) -> bool {
        self.kind.admits(value) && self.allowed.admits(value)
    }
}

/// What is watched of an axis, in um or thousandths of a degree.
#[derive(Clone, Debug)]
pub struct Windows {
    /// How far it may get from where it stood.
    pub standstill: i64,
    /// The upper limit positions.
    pub plus: [i32; 2],
    /// The lower limit positions.
    pub minus: [i32; 2],
    /// The limit positions are watched at all.
    pub limited: bool,
}

/// What a channel says of an axis in the cycle of a stop, and in the one before.
pub struct Said<'a> {
    /// The channel.
    pub side: usize,
    /// The value of one of its signals, so many cycles before.
    pub value: &'a dyn Fn(&str, usize) -> Option<Value>,
}

impl Said<'_> {
    /// A name; empty where there is none.
    pub fn text(&self, name: &str) -> String {
        match (self.value)(name, 0) {
            Some(Value::Text(text)) => text.into_owned(),
            _ => String::new(),
        }
    }
}

/// How a scenario begins.
pub struct Start {
    /// Running and safely referenced.
    pub running: bool,
    /// As in the acceptance test mode: the limit of the speed setpoint is off.
    pub acceptance_mode: bool,
}

/// An input that keeps a value.
pub struct Forced {
    /// Whose it is, by the place of the owner.
    pub owner: usize,
    /// In which channel.
    pub side: usize,
    /// Which one, by its place among those of the owner.
    pub input: usize,
    /// The value, one that the input admits.
    pub value: Value,
}

/// A cycle of a simulation.
pub struct Now<'a> {
    /// Its number.
    pub cycle: u32,
    /// The axes. What they do in this cycle is set in them.
    pub axes: &'a mut [Axis],
    /// The doors.
    pub doors: &'a [Door],
    /// The inputs that keep a value.
    pub forced: &'a [Forced],
}

/// The monitors of a whole machine.
pub trait Monitors {
    /// One cycle.
    fn step(&mut self, now: Now<'_>);

    /// Whether a door could be opened in this cycle.
    fn released(&self, door: usize) -> bool;

    /// What a channel has read and written of an owner in this cycle, in the order of its signals.
    fn told(&self, owner: usize, side: usize) -> Vec<Value>;
}

/// Monitors that run together, driven and observed by their signals. An owner is named by its place in [`Drive::owners`]; it is
/// one of those that run together.
pub trait Rig {
    /// Every input at rest: run up, nothing selected, no stop asked for; `first`: in the first cycle of all.
    fn rest(&mut self, first: bool);

    /// Gives an input of a channel a value. False: it is none of its values.
    fn set(&mut self, owner: usize, side: usize, input: usize, value: &Value) -> bool;

    /// The value of an input.
    fn get(&self, owner: usize, side: usize, input: usize) -> Value;

    /// Takes over how it begins and what was kept through power-off, from the inputs given and from what the channels say in the
    /// first cycle: `said` gives it the value of an output, by owner, channel and name.
    fn resume(&mut self, said: &dyn Fn(usize, usize, &str) -> Option<Value>);

    /// One cycle.
    fn step(&mut self);

    /// What a channel says in this cycle.
    fn output(&self, owner: usize, side: usize, output: usize) -> Value;

    /// What the table of the channel says to it; none where it says nothing, or no table steps beside the monitors.
    fn specified(&self, _owner: usize, _side: usize, _output: usize) -> Option<Value> {
        None
    }

    /// Cycles of both channels in which a table has stepped.
    fn table_cycles(&self) -> u64 {
        0
    }
}

/// An input of the tables that is one or more signals of a channel, the lowest bit first.
pub struct Feed {
    /// The input.
    pub table: &'static str,
    /// The signals.
    pub signals: &'static [&'static str],
    /// They are set by a user.
    pub user: bool,
    /// They hold for one cycle only.
    pub pulse: bool,
    /// It is a port by its full name, which counts also where a system wires it to something else.
    pub wired: bool,
    /// What its value is to the signals.
    pub coding: Coding,
}

/// What the value of an input is to the signals that it is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// Signal k is bit k.
    Bits,
    /// The same for a signal that is 0 where the input is 1.
    Low,
    /// Signal k is on where the value is k + 1; none is on where it is 0.
    OneOf,
}

impl Coding {
    /// Whether signal `k` is on.
    pub const fn is_on(self, value: i32, k: usize) -> bool {
        match self {
            Self::Bits => value >> k & 1 == 1,
            Self::Low => value >> k & 1 == 0,
            Self::OneOf => value == k as i32 + 1,
        }
    }
}
