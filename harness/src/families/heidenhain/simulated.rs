//! The machine in a simulation: what its channels read of the axes, the doors and the person at the panel.

use stillpoint_machine::Machine;

use super::channel::Channels;
use super::names::Bit;
use super::read::{OfAxis, Read};
use super::values;
use crate::families::{Monitors, Now, Start};
use crate::plant;
use crate::recording::Value;

/// The monitors of the machine.
pub(super) struct Simulated<'a> {
    machine: &'a Machine,
    channels: Channels<'a>,
    released: Vec<bool>,
}

impl<'a> Simulated<'a> {
    pub(super) fn new(
        machine: &'a Machine,
        axes: &[plant::Axis],
        start: &Start,
    ) -> Result<Self, String> {
        let positions: Vec<i64> = axes.iter().map(|a| tenths(a.plant.position)).collect();
        Ok(Self {
            machine,
            channels: Channels::new(machine, &positions, start.running)?,
            released: vec![true; machine.doors.len()],
        })
    }

    /// What a channel reads: what is simulated, unless an input is forced.
    fn read(&self, side: usize, now: &Now<'_>) -> Read {
        let any = |test: &dyn Fn(&plant::Axis) -> bool| now.axes.iter().any(test);
        let open = |magazine: bool| {
            let doors = now.doors.iter().enumerate();
            let mut own = doors.filter(|(k, _)| values::of_magazine(self.machine, *k) == magazine);
            own.any(|(_, door)| door.open)
        };
        let key = |k: usize| any(&|axis| axis.selected == Some(k));
        let run_up = now.axes.iter().all(|axis| axis.run_up(now.cycle));
        let reset = any(&|axis| axis.pulse.reset);
        let mut bits = [false; Bit::COUNT];
        for (bit, value) in [
            (Bit::Es, true),
            (Bit::Sd, !open(false)),
            (Bit::SdMagazine, !open(true)),
            (Bit::Key2, key(1)),
            (Bit::Key3, key(2)),
            (Bit::Key4, key(3)),
            (Bit::Cvo, reset || self.channels.latched(side)),
            (Bit::Permit, reset),
            (Bit::Chain, true),
            (Bit::GenSafe, run_up),
            // Off and on: the main switch of a machine that was not running before.
            (
                Bit::MainSwitch,
                any(&|axis| axis.pulse.power_on) && now.cycle > 0,
            ),
        ] {
            bits[bit as usize] = value;
        }
        let axes = now.axes.iter().map(|axis| OfAxis {
            feed: None,
            position: tenths(axis.shown(side)),
            nominal: Some(tenths(axis.plant.position)),
            homed: axis.referenced,
            confirm: axis.pulse.give,
            stop: axis.asked[side].and_then(|k| u8::try_from(k + 1).ok()),
        });
        let mut read = Read {
            bits,
            axes: axes.collect(),
        };
        for forced in now.forced.iter().filter(|f| f.side == side) {
            match read.axes.get_mut(forced.owner) {
                // The scenario has been checked.
                Some(axis) => drop(axis.set(forced.input, &forced.value)),
                None => read.bits[forced.input] = forced.value == Value::Bool(true),
            }
        }
        read
    }
}

impl Monitors for Simulated<'_> {
    fn step(&mut self, now: Now<'_>) {
        let reads = [self.read(0, &now), self.read(1, &now)];
        self.channels.step(&reads);
        for (k, axis) in now.axes.iter_mut().enumerate() {
            let (asked, may_not_start) = self.channels.asked(k);
            axis.obey(asked, may_not_start);
        }
    }

    fn released(&self, door: usize) -> bool {
        self.released[door]
    }

    fn told(&self, owner: usize, side: usize) -> Vec<Value> {
        self.channels.told(owner, side)
    }
}

/// Tenths of a micrometre, or ten-thousandths of a degree, rounded down.
fn tenths(thousandths: i64) -> i64 {
    thousandths.div_euclid(100)
}
