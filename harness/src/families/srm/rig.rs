//! One axis alone, driven by its signals: its blocks, for a replay. The tables of the blocks have values of their own for positions and
//! velocities; none steps beside them.

use stillpoint_machine::Machine;

use super::blocks::{Blocks, Start};
use super::signals::{self, Flag, Input, Number, Read};
use super::values;
use crate::families::Rig;
use crate::recording::Value;

/// Drives the blocks of an axis.
pub(super) fn play(machine: &Machine, axis: usize, play: &mut dyn FnMut(&mut dyn Rig)) {
    let known = &machine.axes[axis];
    play(&mut Bench {
        machine,
        axis,
        inputs: signals::inputs(known),
        blocks: Blocks::new(machine, known),
        read: Read::default(),
        calls: 0,
        told: Vec::new(),
    });
}

struct Bench<'a> {
    machine: &'a Machine,
    axis: usize,
    inputs: Vec<Input>,
    blocks: Blocks<'a>,
    read: Read,
    calls: i64,
    /// The outputs.
    told: Vec<Value>,
}

impl Rig for Bench<'_> {
    /// At the lower end of its range, or at 0; every encoder valid, the counter of the telegram moves, half of the full load hangs on the
    /// rope, the drive is on.
    fn rest(&mut self, first: bool) {
        self.calls = if first { 0 } else { self.calls + 1 };
        let known = &self.machine.axes[self.axis];
        let config = values::safe_pos(known, values::t_sample(self.machine));
        let place = i64::from(config.pos_min.max(0));
        let time = self.calls * i64::from(config.t_sample);
        let count = time / i64::from(config.possi_t_sample.max(1));
        let given = [
            Flag::Run,
            Flag::Pos1Valid,
            Flag::Pos2Valid,
            Flag::PossiValid,
        ];
        self.read = Read::default()
            .flags(&given.map(|flag| (flag, true)))
            .flags(&[(Flag::FdbackDrive, true)])
            .numbers(&[
                (Number::Pos1, place),
                (Number::Pos2, i64::from(config.pos_max) - place),
                (Number::Possi, place * 1_000),
                (Number::PossiCount, i64::from(count as i16)),
                (Number::Load1, 5_000),
                (Number::Load2, 5_000),
            ]);
    }

    fn set(&mut self, _owner: usize, side: usize, input: usize, value: &Value) -> bool {
        match self.inputs.get(input) {
            Some(input) if side == 0 => self.read.set(*input, value),
            _ => false,
        }
    }

    fn get(&self, _owner: usize, _side: usize, input: usize) -> Value {
        let input = self.inputs.get(input);
        input.map_or(Value::Bool(false), |input| self.read.get(*input))
    }

    /// Referenced where SAFE_POS of the first cycle is, unless REFERENCED says that it is not.
    fn resume(&mut self, said: &dyn Fn(usize, usize, &str) -> Option<Value>) {
        let told = |name| said(self.axis, 0, name);
        let is = |name| told(name) != Some(Value::Bool(false));
        let place = match told(signals::SAFE_POS) {
            Some(Value::Int(mm)) => i32::try_from(mm).unwrap_or(i32::MAX),
            _ => self.read.number(Number::Pos1),
        };
        let start = Start {
            referenced: is(signals::REFERENCED).then_some(place),
            tested: is(signals::TEST_OK),
            measures: is(signals::MEASURES),
        };
        let known = &self.machine.axes[self.axis];
        self.blocks = Blocks::begin(self.machine, known, &start, &self.read);
    }

    fn step(&mut self) {
        let known = &self.machine.axes[self.axis];
        let said = self.blocks.step(&self.read);
        let outputs = signals::outputs(known, &said, values::t_sample(self.machine));
        self.told = outputs.into_iter().map(|(_, value)| value).collect();
    }

    fn output(&self, _owner: usize, _side: usize, output: usize) -> Value {
        let told = self.told.get(output);
        told.cloned().unwrap_or(Value::Bool(false))
    }
}
