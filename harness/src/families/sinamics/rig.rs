//! One drive alone, driven by its signals: both channels, for a replay. The tables of the functions have values of their own for positions
//! and speeds; none steps beside them.

use stillpoint_machine::Machine;

use super::channel::Pair;
use super::outputs;
use super::signals::{self, Flag, Input, Read};
use super::values::{self, Values};
use crate::families::Rig;
use crate::recording::Value;

/// Drives the channels of an axis.
///
/// # Errors
/// The monitors refuse a value.
pub(super) fn play(
    machine: &Machine,
    axis: usize,
    play: &mut dyn FnMut(&mut dyn Rig),
) -> Result<(), String> {
    let all = values::axes(machine)?;
    let values = all.get(axis).ok_or("the machine has no such axis")?;
    let read = [Read::at_rest(0); 2];
    play(&mut Bench {
        machine,
        axis,
        values,
        inputs: signals::inputs(&machine.axes[axis]),
        pair: Pair::new(values, false, &read),
        read,
        told: Default::default(),
    });
    Ok(())
}

struct Bench<'a> {
    machine: &'a Machine,
    axis: usize,
    values: &'a Values,
    inputs: Vec<Input>,
    pair: Pair,
    read: [Read; 2],
    /// The outputs of both channels.
    told: [Vec<Value>; 2],
}

impl Rig for Bench<'_> {
    fn rest(&mut self, _first: bool) {
        self.read = [Read::at_rest(0); 2];
    }

    fn set(&mut self, _owner: usize, side: usize, input: usize, value: &Value) -> bool {
        match (self.inputs.get(input), self.read.get_mut(side)) {
            (Some(input), Some(read)) => read.set(*input, value),
            _ => false,
        }
    }

    fn get(&self, _owner: usize, side: usize, input: usize) -> Value {
        match (self.inputs.get(input), self.read.get(side)) {
            (Some(input), Some(read)) => read.get(*input),
            _ => Value::Bool(false),
        }
    }

    /// It runs where it has run up and is switched on in the first cycle.
    fn resume(&mut self, _said: &dyn Fn(usize, usize, &str) -> Option<Value>) {
        let on = |read: &Read| read.is(Flag::On) && read.is(Flag::PoweredUp);
        self.pair = Pair::new(self.values, self.read.iter().all(on), &self.read);
    }

    fn step(&mut self) {
        let known = &self.machine.axes[self.axis];
        let said = self.pair.step(&self.read);
        self.told = [0, 1].map(|side| {
            let outputs = outputs::outputs(known, side, &said[side]).into_iter();
            outputs.map(|(_, value)| value).collect()
        });
    }

    fn output(&self, _owner: usize, side: usize, output: usize) -> Value {
        let told = self.told.get(side).and_then(|told| told.get(output));
        told.cloned().unwrap_or(Value::Bool(false))
    }
}
