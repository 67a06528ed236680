//! The crane in a simulation: its encoders, loads and drives, and the person who operates it.

use stillpoint_machine::Machine;

use super::blocks::{Blocks, Said, Start as Begin, Stop};
use super::converter::Converter;
use super::signals::{self, Flag, Input, Number, Read};
use super::values;
use crate::families::{Monitors, Now, Start};
use crate::plant;
use crate::recording::Value;

/// The encoders of an axis, by their places among the words of the family.
const POS1: usize = 0;
pub(super) const POSSI: usize = 1;
const POS2: usize = 2;

/// The blocks of the machine, axis by axis, with the drives.
pub(super) struct Simulated<'a> {
    machine: &'a Machine,
    limited: bool,
    running: bool,
    axes: Vec<OfAxis<'a>>,
}

struct OfAxis<'a> {
    inputs: Vec<Input>,
    /// None before the first cycle.
    blocks: Option<Blocks<'a>>,
    converter: Converter,
    encoders: Sampler,
    /// The CPU has been switched on.
    powered: bool,
    /// RELEASE.
    release: bool,
    read: Read,
    said: Said,
}

/// The encoders as the drive samples them, in its monitoring cycle: all at the same time.
struct Sampler {
    /// That cycle, ms.
    cycle: i64,
    /// Cycles until the last sample.
    count: i64,
    /// What the encoders showed then, nm.
    shown: [i64; plant::ENCODERS],
    /// The counter of the telegram, and what it brought of POSSI, nm.
    telegram: (i64, i64),
    /// The position in the call before, nm.
    before: i64,
    /// Where POSSI counts from, nm: a relative encoder begins at 0.
    zero: i64,
}

impl Sampler {
    /// A call at this time, ms, a call of `t_sample` after the one before.
    fn read(&mut self, axis: &plant::Axis, time: i64, t_sample: i64) {
        let position = axis.plant.position;
        let count = time / self.cycle;
        if count != self.count {
            // Where it was at that time, between the two calls; no machine file has a cycle that is longer than both.
            let since = (time - count * self.cycle).clamp(0, t_sample);
            let back = i128::from(position - self.before) * i128::from(since);
            let back = i64::try_from(back / i128::from(t_sample)).unwrap_or(0);
            for (encoder, shown) in self.shown.iter_mut().enumerate() {
                let fault = axis.faults[encoder].0;
                *shown = match fault {
                    plant::Fault::Freeze | plant::Fault::Telegram => axis.shown(encoder),
                    _ => axis.shown(encoder) - back,
                };
            }
            self.count = count;
            if axis.faults[POSSI].0 != plant::Fault::Telegram {
                self.telegram = (count, self.shown[POSSI] - self.zero);
            }
        }
        self.before = position;
    }
}

impl<'a> Simulated<'a> {
    pub(super) fn new(machine: &'a Machine, axes: &[plant::Axis], start: &Start) -> Self {
        let of_axis = |(k, axis): (usize, &plant::Axis)| {
            let known = &machine.axes[k];
            let converter = Converter::new(machine, known);
            let cycle = i64::from(values::safe_pos(known, 1).possi_t_sample).max(1);
            OfAxis {
                inputs: signals::inputs(known),
                blocks: None,
                converter: match start.running {
                    true => converter.running(),
                    false => converter,
                },
                encoders: Sampler {
                    cycle,
                    count: -1,
                    shown: [axis.plant.position; plant::ENCODERS],
                    telegram: (0, 0),
                    before: axis.plant.position,
                    zero: match start.running {
                        true => 0,
                        false => axis.plant.position,
                    },
                },
                powered: start.running,
                release: false,
                read: Read::default(),
                said: Said::default(),
            }
        };
        Self {
            machine,
            limited: !start.acceptance_mode,
            running: start.running,
            axes: axes.iter().enumerate().map(of_axis).collect(),
        }
    }

    /// What the program reads of an axis: what is simulated, unless an input is forced.
    fn read(&mut self, k: usize, now: &Now<'_>) -> Read {
        let t_sample = i64::from(values::t_sample(self.machine));
        let known = &self.machine.axes[k];
        let axis = &now.axes[k];
        let own = &mut self.axes[k];
        let pulse = axis.pulse;
        let switched = pulse.power_on && now.cycle > 0;
        own.powered |= switched;
        if switched {
            own.encoders.zero = axis.plant.position;
            own.release = false;
        }
        own.release = (own.release || pulse.give) && !pulse.withdraw;
        own.encoders
            .read(axis, i64::from(now.cycle) * t_sample, t_sample);
        let mm = |encoder: usize| own.encoders.shown[encoder].div_euclid(1_000_000);
        let (count, possi) = own.encoders.telegram;
        let most = i64::from(values::safe_pos(known, 1).pos_max);
        let on_rope = axis.load.on_rope(axis.plant.position);
        let run_up = axis.run_up(now.cycle);
        let mut read = Read::default()
            .flags(&[
                (Flag::Run, own.powered && !switched),
                (Flag::Pos1Valid, own.powered),
                (Flag::Pos2Valid, own.powered),
                (Flag::PossiValid, run_up),
                (Flag::Reference, pulse.reference),
                (Flag::Ack, pulse.reset),
                (Flag::Release, own.release),
                (Flag::MaxloadMode, axis.selected == Some(1)),
            ])
            .numbers(&[
                (Number::Pos1, mm(POS1)),
                // It counts the other way.
                (Number::Pos2, most - mm(POS2)),
                (Number::Possi, possi.div_euclid(1_000)),
                (Number::PossiCount, i64::from(count as i16)),
                (Number::Load1, on_rope),
                (Number::Load2, on_rope),
            ]);
        read.asked = axis.asked[0].map_or(Stop::None, |place| Stop::of(place + 1));
        read = own.converter.told(axis, read);
        for forced in now.forced.iter().filter(|f| f.owner == k && f.side == 0) {
            // The scenario has been checked.
            let _ = read.set(own.inputs[forced.input], &forced.value);
        }
        read
    }
}

impl Monitors for Simulated<'_> {
    fn step(&mut self, now: Now<'_>) {
        for k in 0..self.axes.len() {
            let read = self.read(k, &now);
            let (machine, known) = (self.machine, &self.machine.axes[k]);
            let own = &mut self.axes[k];
            let begin = Begin {
                referenced: self.running.then_some(read.number(Number::Pos1)),
                tested: true,
                measures: true,
            };
            let blocks = own
                .blocks
                .get_or_insert_with(|| Blocks::begin(machine, known, &begin, &read));
            own.read = read;
            own.said = blocks.step(&read);
            let run_up = now.axes[k].run_up(now.cycle) && own.powered;
            own.converter
                .step(&own.said, &mut now.axes[k], run_up, self.limited);
        }
    }

    /// A crane has no doors with a lock of its own.
    fn released(&self, _door: usize) -> bool {
        false
    }

    fn told(&self, owner: usize, _side: usize) -> Vec<Value> {
        let (known, own) = (&self.machine.axes[owner], &self.axes[owner]);
        let inputs = own.inputs.iter().map(|input| own.read.get(*input));
        let outputs = signals::outputs(known, &own.said, values::t_sample(self.machine));
        let outputs = outputs.into_iter().map(|(_, value)| value);
        inputs.chain(outputs).collect()
    }
}
