//! The whole machine, driven by its signals: both channels, for a replay and for a walk. No table steps beside them: the safe PLC program
//! is that of the tables and runs in the channels themselves.

use stillpoint_machine::Machine;

use super::channel::Channels;
use super::names::{self, Bit};
use super::read::Read;
use crate::families::{Coding, Feed, Rig};
use crate::recording::Value;

/// The inputs of the tables that are signals of the machine: ports of the safe PLC program and of the keylock, wherever a system
/// takes them from.
pub(super) static FEEDS: [Feed; 19] = [
    low("splc.door_open", &["SD"]),
    low("splc.t_open", &["SD_MAGAZINE"]),
    user("splc.pb_panel", &["PB"]),
    user("splc.pb_wheel", &["PB_HANDWHEEL"]),
    user("splc.pb_magazine", &["PB_MAGAZINE"]),
    user("splc.axis_key", &["AXIS_KEY"]),
    user("splc.nc_start", &["NC_START"]),
    user("splc.jog", &["JOG"]),
    user("splc.spindle_start", &["SPINDLE_START"]),
    user("splc.stop_key", &["STOP_KEY"]),
    user("splc.magazine_key", &["MAGAZINE_KEY"]),
    user("splc.confirm", &["CONFIRM"]),
    user("som.key_2", &["KEY_SOM_2"]),
    user("som.key_3", &["KEY_SOM_3"]),
    user("som.key_4", &["KEY_SOM_4"]),
    Feed {
        coding: Coding::OneOf,
        ..user("splc.unit", &["PROGRAM", "HANDWHEEL", "HOMING"])
    },
    state("splc.restricted", &["RESTRICTED"]),
    state("splc.holder_open", &["HOLDER_OPEN"]),
    state("splc.gen_safe", &["NN_GenSafe"]),
];

const fn state(table: &'static str, signals: &'static [&'static str]) -> Feed {
    Feed {
        table,
        signals,
        user: false,
        pulse: false,
        wired: true,
        coding: Coding::Bits,
    }
}

const fn user(table: &'static str, signals: &'static [&'static str]) -> Feed {
    Feed {
        user: true,
        ..state(table, signals)
    }
}

const fn low(table: &'static str, signals: &'static [&'static str]) -> Feed {
    Feed {
        coding: Coding::Low,
        ..user(table, signals)
    }
}

/// Drives both channels.
pub(super) fn play(machine: &Machine, play: &mut dyn FnMut(&mut dyn Rig)) -> Result<(), String> {
    let rest = Read::rest(machine, true);
    let mut bench = Bench {
        channels: Channels::new(machine, &positions(&rest), true)?,
        voltage_given: [false; 2],
        reads: [rest.clone(), rest],
        said: Vec::new(),
        machine,
    };
    play(&mut bench);
    Ok(())
}

fn positions(read: &Read) -> Vec<i64> {
    read.axes.iter().map(|axis| axis.position).collect()
}

struct Bench<'a> {
    machine: &'a Machine,
    channels: Channels<'a>,
    /// What each channel reads.
    reads: [Read; 2],
    /// Somebody has told whether `PP_GenCVO` is on; else it is on while the control voltage is latched.
    voltage_given: [bool; 2],
    /// What the channels have told of each owner in the last cycle.
    said: Vec<[Vec<Value>; 2]>,
}

impl Bench<'_> {
    /// What a channel has told of an owner: signal by its place, inputs first.
    fn told(&self, owner: usize, side: usize, signal: usize) -> Value {
        let found = self.said.get(owner).and_then(|said| said[side].get(signal));
        found.cloned().unwrap_or(Value::Bool(false))
    }
}

impl Rig for Bench<'_> {
    fn rest(&mut self, _first: bool) {
        for side in 0..2 {
            self.reads[side] = Read::rest(self.machine, self.channels.latched(side));
        }
        self.voltage_given = [false; 2];
    }

    fn set(&mut self, owner: usize, side: usize, input: usize, value: &Value) -> bool {
        let read = &mut self.reads[side];
        if let Some(axis) = read.axes.get_mut(owner) {
            return axis.set(input, value);
        }
        let (Some(bit), Value::Bool(on)) = (read.bits.get_mut(input), value) else {
            return false;
        };
        *bit = *on;
        self.voltage_given[side] |= input == Bit::Cvo as usize;
        true
    }

    /// Of the machine as it is now; of an axis, where the program decides some, as it was read in the last cycle.
    fn get(&self, owner: usize, side: usize, input: usize) -> Value {
        match self.reads[side].axes.get(owner) {
            Some(_) => self.told(owner, side, input),
            None => Value::Bool(self.reads[side].bits[input]),
        }
    }

    fn resume(&mut self, said: &dyn Fn(usize, usize, &str) -> Option<Value>) {
        let axes = self.machine.axes.len();
        let either = |owner: usize, name: &str| (0..2).find_map(|side| said(owner, side, name));
        let state = || (0..axes).find_map(|owner| either(owner, names::STATE));
        let running = match (either(axes, names::VOLTAGE), state()) {
            (Some(Value::Bool(on)), _) => on,
            (None, Some(Value::Text(name))) => name != names::OFF,
            _ => true,
        };
        for side in 0..2 {
            if !self.voltage_given[side] {
                self.reads[side].bits[Bit::Cvo as usize] = running;
            }
        }
        // The values have been accepted when the bench was made.
        if let Ok(fresh) = Channels::new(self.machine, &positions(&self.reads[0]), running) {
            self.channels = fresh;
        }
    }

    fn step(&mut self) {
        self.channels.step(&self.reads);
        let owners = 0..=self.machine.axes.len();
        let told = owners.map(|owner| [0, 1].map(|side| self.channels.told(owner, side)));
        self.said = told.collect();
    }

    fn output(&self, owner: usize, side: usize, output: usize) -> Value {
        let inputs = match self.reads[side].axes.get(owner) {
            Some(_) => names::AXIS_INPUTS.len(),
            None => Bit::COUNT,
        };
        self.told(owner, side, inputs + output)
    }
}
