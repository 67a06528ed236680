//! The machine in a simulation: in each channel the safe PLC program, the groups and the axes, wired as an embedding wires
//! them.

mod group;

use stillpoint_machine::Machine;
use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Phase, Stop, Unit};
use stillpoint_monitors::heidenhain::{axis_release, channel, output_enable, som, stop, switch_on};

use super::axis::{Axis, OfGroup, Seen};
use super::names::{self, Bit};
use super::program::Program;
use super::values;
use crate::families::{Monitors, Now, Start};
use crate::plant::{self, Actuation};
use crate::recording::Value;
use group::Group;

/// The monitors of the machine, by channel: MC, CC.
pub(super) struct Simulated<'a> {
    machine: &'a Machine,
    channels: [Channel; 2],
    released: Vec<bool>,
}

/// One channel.
struct Channel {
    side: usize,
    program: Program,
    keylock: som::Monitor,
    voltage: switch_on::Monitor,
    enable: output_enable::Monitor,
    axes: Vec<Axis>,
    groups: Vec<Group>,
    /// The inputs of the machine, and what they are for each axis.
    bits: [bool; Bit::COUNT],
    feeds: Vec<bool>,
    positions: Vec<i64>,
    /// No group had torque in the cycle before.
    all_off: bool,
    said: Said,
}

/// What a channel says of the machine.
#[derive(Clone, Copy, Default)]
struct Said {
    som: som::Outputs,
    voltage: switch_on::Outputs,
    enabled: bool,
}

/// What both channels said at the start of a cycle: groups, and the axes that are checked.
struct Before {
    groups: [Vec<channel::Outputs>; 2],
    checked: [Vec<bool>; 2],
}

impl<'a> Simulated<'a> {
    pub(super) fn new(
        machine: &'a Machine,
        axes: &[plant::Axis],
        start: &Start,
    ) -> Result<Self, String> {
        Ok(Self {
            machine,
            channels: [
                Channel::new(machine, axes, start.running, 0)?,
                Channel::new(machine, axes, start.running, 1)?,
            ],
            released: vec![true; machine.doors.len()],
        })
    }

    /// What moves an axis: the strictest of what both channels ask for.
    fn obeyed(&self, k: usize, axis: &mut plant::Axis) {
        let mut asked = Actuation::Follow;
        let mut may_not_start = false;
        for channel in &self.channels {
            let Some(group) = channel.groups.iter().find(|g| g.axes.contains(&k)) else {
                continue;
            };
            let of_axis = &channel.axes[k].said.release;
            let without = match group.kind {
                Kind::Spindle => !channel.said.voltage.stos_a_g,
                _ => !channel.said.voltage.sto_a_g,
            };
            let stop = &group.said.stop;
            asked = asked.max(if group.said.torque_off || without {
                Actuation::Coast
            } else if stop.emergency_ramp || stop.brake_closed {
                Actuation::CurrentLimit
            } else if stop.on_contour || of_axis.mode == axis_release::Mode::Ss2 {
                Actuation::Path
            } else {
                Actuation::Follow
            });
            may_not_start |= !group.said.group.may_move
                || of_axis.mode != axis_release::Mode::Released
                || stop.phase != Phase::Run;
        }
        axis.obey(asked, may_not_start);
    }
}

impl Monitors for Simulated<'_> {
    fn step(&mut self, now: Now<'_>) {
        let before = Before {
            groups: [0, 1].map(|c: usize| self.channels[c].groups.iter().map(|g| g.said).collect()),
            checked: [0, 1].map(|c: usize| {
                let axes = self.channels[c].axes.iter();
                axes.map(|axis| axis.said.reference.checked).collect()
            }),
        };
        for channel in &mut self.channels {
            channel.step(self.machine, &before, &now);
        }
        for k in 0..now.axes.len() {
            self.obeyed(k, &mut now.axes[k]);
        }
    }

    fn released(&self, door: usize) -> bool {
        self.released[door]
    }

    fn told(&self, owner: usize, side: usize) -> Vec<Value> {
        let channel = &self.channels[side];
        let Some(axis) = channel.axes.get(owner) else {
            let read = channel.bits.iter().map(|bit| Value::Bool(*bit));
            let said = &channel.said;
            let written = [
                Value::Text(names::SOMS[said.som.som as usize].into()),
                Value::Bool(said.voltage.sto_a_g),
                Value::Bool(said.voltage.stos_a_g),
                Value::Bool(said.enabled),
            ];
            return read.chain(written).collect();
        };
        let mut all = vec![
            Value::Bool(channel.feeds[owner]),
            Value::Int(channel.positions[owner].div_euclid(10)),
        ];
        let group = channel.groups.iter().find(|g| g.axes.contains(&owner));
        all.extend(names::axis(&axis.said, group.map(|g| (&g.said, g.cause))));
        all
    }
}

impl Channel {
    fn new(
        machine: &Machine,
        axes: &[plant::Axis],
        running: bool,
        side: usize,
    ) -> Result<Self, String> {
        let mut monitored = Vec::new();
        for (known, axis) in machine.axes.iter().zip(axes) {
            let config = values::axis(machine, known)?;
            let position = tenths(axis.plant.position);
            monitored.push(Axis::new(config, side, running, position));
        }
        let mut groups = Vec::new();
        for known in &machine.axis_groups {
            let kind = values::kind(machine, known);
            let config = values::group(machine, known)?[side];
            groups.push(Group::new(
                kind,
                values::members(machine, known),
                config,
                running,
            ));
        }
        let on = switch_on::State {
            voltage: switch_on::Voltage::On,
            ..switch_on::State::INITIAL
        };
        let standard = switch_on::Config::STANDARD;
        let voltage = match running {
            true => switch_on::Monitor::resume(standard, on),
            false => Ok(switch_on::Monitor::new(standard)),
        };
        let keylock = som::Config::new(values::som_4(machine));
        Ok(Self {
            side,
            program: Program::new(machine, side)?,
            keylock: som::Monitor::new(keylock.map_err(|e| e.to_string())?),
            voltage: voltage.unwrap_or_else(|_| switch_on::Monitor::new(standard)),
            enable: output_enable::Monitor::new(values::outputs(machine)?),
            feeds: vec![false; monitored.len()],
            positions: vec![0; monitored.len()],
            axes: monitored,
            groups,
            bits: [false; Bit::COUNT],
            all_off: false,
            said: Said {
                voltage: switch_on::Outputs {
                    voltage: if running {
                        switch_on::Voltage::On
                    } else {
                        switch_on::Voltage::Off
                    },
                    sto_a_g: running,
                    stos_a_g: running,
                    ..switch_on::Outputs::default()
                },
                ..Said::default()
            },
        })
    }

    fn is(&self, bit: Bit) -> bool {
        self.bits[bit as usize]
    }

    /// The machine operating mode.
    fn unit(&self) -> Unit {
        if self.is(Bit::Homing) {
            Unit::Reference
        } else if self.is(Bit::Handwheel) {
            Unit::Handwheel
        } else if self.is(Bit::Program) {
            Unit::Program
        } else {
            Unit::Panel
        }
    }

    fn step(&mut self, machine: &Machine, before: &Before, now: &Now<'_>) {
        self.read(machine, now);
        // Off and on: the main switch of a machine that was not running before.
        let main_switch = now.axes.iter().any(|axis| axis.pulse.power_on) && now.cycle > 0;
        if main_switch {
            self.program.power_on();
        }
        if self.program.is_due() {
            self.said.som = self.keylock.step(&som::Inputs {
                power_on: main_switch,
                key_2: self.is(Bit::Key2),
                key_3: self.is(Bit::Key3),
                key_4: self.is(Bit::Key4),
                deselected: false,
            });
        }
        self.run_program();
        self.step_axes(before, now, main_switch);
        for g in 0..self.groups.len() {
            self.step_group(g, machine, before, now, main_switch);
        }
        self.step_voltage(main_switch);
    }

    /// What the channel reads: what is simulated, unless an input is forced.
    fn read(&mut self, machine: &Machine, now: &Now<'_>) {
        let any = |test: &dyn Fn(&plant::Axis) -> bool| now.axes.iter().any(test);
        let open = |magazine: bool| {
            let doors = now.doors.iter().enumerate();
            let mut own = doors.filter(|(k, _)| values::of_magazine(machine, *k) == magazine);
            own.any(|(_, door)| door.open)
        };
        let key = |k: usize| any(&|axis| axis.selected == Some(k));
        let run_up = now.axes.iter().all(|axis| axis.run_up(now.cycle));
        let reset = any(&|axis| axis.pulse.reset);
        let latched = self.said.voltage.voltage != switch_on::Voltage::Off;
        for (bit, value) in [
            (Bit::Es, true),
            (Bit::Sd, !open(false)),
            (Bit::SdMagazine, !open(true)),
            (Bit::Key2, key(1)),
            (Bit::Key3, key(2)),
            (Bit::Key4, key(3)),
            (Bit::Cvo, reset || latched),
            (Bit::Permit, reset),
            (Bit::Chain, true),
            (Bit::GenSafe, run_up),
        ] {
            self.bits[bit as usize] = value;
        }
        for bit in Bit::PRESSED {
            self.bits[bit as usize] = false;
        }
        let machine_owner = machine.axes.len();
        for forced in now.forced.iter().filter(|f| f.side == self.side) {
            if forced.owner == machine_owner {
                self.bits[forced.input] = forced.value;
            }
        }
    }

    fn run_program(&mut self) {
        let of = |kind: Kind| self.groups.iter().filter(move |g| g.kind == kind);
        let state = |kind: Kind| {
            let states = of(kind).map(|g| g.said.group.state);
            states.fold(GroupState::Auto, GroupState::stricter) as i64
        };
        let moving = |kind: Kind| {
            let mut axes = of(kind).flat_map(|g| &g.axes);
            i64::from(axes.any(|k| self.axes[*k].said.moving))
        };
        let values = [
            ("door_open", i64::from(!self.is(Bit::Sd))),
            ("t_open", i64::from(!self.is(Bit::SdMagazine))),
            ("unit", self.unit() as i64),
            ("state_a", state(Kind::NcAxes)),
            ("state_s", state(Kind::Spindle)),
            ("state_t", state(Kind::Auxiliary)),
            ("moving_a", moving(Kind::NcAxes)),
            ("moving_s", moving(Kind::Spindle)),
            ("moving_t", moving(Kind::Auxiliary)),
        ];
        let bits = [
            ("key_2", Bit::Key2),
            ("key_3", Bit::Key3),
            ("key_4", Bit::Key4),
            ("pb_panel", Bit::Pb),
            ("pb_wheel", Bit::PbHandwheel),
            ("pb_magazine", Bit::PbMagazine),
            ("axis_key", Bit::AxisKey),
            ("nc_start", Bit::NcStart),
            ("jog", Bit::Jog),
            ("spindle_start", Bit::SpindleStart),
            ("stop_key", Bit::StopKey),
            ("magazine_key", Bit::MagazineKey),
            ("confirm", Bit::Confirm),
            ("restricted", Bit::Restricted),
            ("holder_open", Bit::HolderOpen),
            ("gen_safe", Bit::GenSafe),
        ];
        let bits = bits.map(|(name, bit)| (name, i64::from(self.is(bit))));
        let seen = |wanted: &str| {
            let mut all = values.iter().chain(&bits);
            all.find(|(name, _)| *name == wanted).map_or(0, |(_, v)| *v)
        };
        self.program.step(&seen);
    }

    fn step_axes(&mut self, before: &Before, now: &Now<'_>, power_on: bool) {
        let (som, unit) = (self.said.som.som, self.unit());
        for (k, plant) in now.axes.iter().enumerate() {
            let group = self.groups.iter().find(|g| g.axes.contains(&k));
            let kind = group.map_or(Kind::NcAxes, |g| g.kind);
            let of_group = group.map_or(OfGroup::FREE, |g| OfGroup {
                state: g.said.group.state,
                left: g.said.group.left,
                level: g.said.stop.level,
                on_contour: g.said.stop.on_contour,
                emergency_ramp: g.said.stop.emergency_ramp,
            });
            let mut feed = match kind {
                Kind::NcAxes => self.program.output("feed_a", 0) != 0,
                Kind::Auxiliary => self.program.output("feed_t", 0) != 0,
                // Only axes have a feed enable.
                Kind::Spindle => true,
            };
            let mut forced = now.forced.iter();
            if let Some(kept) = forced.find(|f| f.owner == k && f.side == self.side) {
                feed = kept.value;
            }
            let door = match kind {
                Kind::Auxiliary => Bit::SdMagazine,
                _ => Bit::Sd,
            };
            let shown = [0, 1].map(|side| tenths(plant.shown(side)));
            self.feeds[k] = feed;
            self.positions[k] = shown[self.side];
            let seen = Seen {
                position: shown[self.side],
                peer: shown[1 - self.side],
                nominal: tenths(plant.plant.position),
                feed,
                power_on,
                homed: plant.referenced,
                confirm: plant.pulse.give,
                peer_checked: before.checked[1 - self.side][k],
                som,
                unit,
                door_open: !self.is(door),
            };
            self.axes[k].step(of_group, &seen);
        }
    }

    fn step_voltage(&mut self, main_switch: bool) {
        let stops = || self.groups.iter().map(|g| &g.said.stop);
        let all_off = stops().all(|stop| stop.phase == Phase::TorqueOff);
        let braking =
            |stop: &stop::Outputs| matches!(stop.phase, Phase::EmergencyBrake | Phase::BrakeCloses);
        let mut spindles = self.groups.iter().filter(|g| g.kind == Kind::Spindle);
        let spindle_rests = !self.is(Bit::Sd)
            && spindles
                .all(|g| g.said.torque_off && g.axes.iter().all(|k| !self.axes[*k].said.moving));
        let inputs = switch_on::Inputs {
            cvo: self.is(Bit::Cvo),
            chain: self.is(Bit::Chain),
            t_brk: false,
            // It falls as the last group loses its torque.
            dropped: main_switch || (all_off && !self.all_off),
            may_on: self.is(Bit::Es)
                && self.is(Bit::GenSafe)
                && !stops().any(|stop| braking(stop) || stop.needs_switch),
            testing: false,
            spindle_rests,
        };
        let highest = stops().map(|stop| stop.level).fold(Stop::None, Stop::max);
        let still = self.axes.iter().all(|axis| !axis.said.moving);
        self.all_off = all_off;
        self.said.voltage = self.voltage.step(&inputs);
        let outputs = self.enable.step(&output_enable::Inputs {
            ready: self.is(Bit::GenSafe) && self.said.voltage.sto_a_g,
            stop: highest,
            emergency: !self.is(Bit::Es),
            still,
        });
        self.said.enabled = outputs.enabled;
    }
}

/// Tenths of a micrometre, or ten-thousandths of a degree, rounded down.
fn tenths(thousandths: i64) -> i64 {
    thousandths.div_euclid(100)
}
