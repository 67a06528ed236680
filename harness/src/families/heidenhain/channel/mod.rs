//! Both channels of the machine: in each the safe PLC program, the groups and the axes, wired as an embedding wires them. They step
//! by what they [`Read`], simulated or recorded.

mod group;

use stillpoint_machine::Machine;
use stillpoint_monitors::heidenhain::types::{GroupState, Kind, Phase, Stop, Unit};
use stillpoint_monitors::heidenhain::{axis_release, channel, output_enable, som, stop, switch_on};

use super::axis::{Axis, OfGroup, Seen};
use super::names::{self, Bit};
use super::program::Program;
use super::read::Read;
use super::values;
use crate::plant::Actuation;
use crate::recording::Value;
use group::Group;

/// The monitors of the machine, by channel: MC, CC.
pub(super) struct Channels<'a> {
    machine: &'a Machine,
    channels: [Channel; 2],
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
    /// What it has read in this cycle, and whether each axis has feed enable.
    read: Read,
    feeds: Vec<bool>,
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

impl<'a> Channels<'a> {
    /// Both at rest. `running`: the drives are on; else the machine is off. `positions`: those of the axes that are kept through
    /// power-off.
    ///
    /// # Errors
    /// A sentence: the monitors refuse a value of the machine file.
    pub(super) fn new(
        machine: &'a Machine,
        positions: &[i64],
        running: bool,
    ) -> Result<Self, String> {
        Ok(Self {
            machine,
            channels: [
                Channel::new(machine, positions, running, 0)?,
                Channel::new(machine, positions, running, 1)?,
            ],
        })
    }

    /// One cycle of both, by what each reads.
    pub(super) fn step(&mut self, reads: &[Read; 2]) {
        let before = Before {
            groups: [0, 1].map(|c: usize| self.channels[c].groups.iter().map(|g| g.said).collect()),
            checked: [0, 1].map(|c: usize| {
                let axes = self.channels[c].axes.iter();
                axes.map(|axis| axis.said.reference.checked).collect()
            }),
        };
        for channel in &mut self.channels {
            channel.step(self.machine, &before, reads.each_ref());
        }
    }

    /// Whether the control voltage is latched in a channel.
    pub(super) fn latched(&self, side: usize) -> bool {
        self.channels[side].said.voltage.voltage != switch_on::Voltage::Off
    }

    /// What a channel has read and written of an owner in this cycle, in the order of its signals.
    pub(super) fn told(&self, owner: usize, side: usize) -> Vec<Value> {
        self.channels[side].told(owner)
    }

    /// What moves an axis, the strictest of what both channels ask for, and whether it may not start.
    pub(super) fn asked(&self, k: usize) -> (Actuation, bool) {
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
        (asked, may_not_start)
    }
}

impl Channel {
    /// At rest; `positions`: those that are kept through power-off.
    fn new(
        machine: &Machine,
        positions: &[i64],
        running: bool,
        side: usize,
    ) -> Result<Self, String> {
        let mut monitored = Vec::new();
        for (known, position) in machine.axes.iter().zip(positions) {
            let config = values::axis(machine, known)?;
            monitored.push(Axis::new(config, side, running, *position));
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
            axes: monitored,
            groups,
            read: Read::rest(machine, running),
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

    fn step(&mut self, machine: &Machine, before: &Before, reads: [&Read; 2]) {
        self.read.clone_from(reads[self.side]);
        let main_switch = self.read.is(Bit::MainSwitch);
        if main_switch {
            self.program.power_on();
        }
        if self.program.is_due() {
            self.said.som = self.keylock.step(&som::Inputs {
                power_on: main_switch,
                key_2: self.read.is(Bit::Key2),
                key_3: self.read.is(Bit::Key3),
                key_4: self.read.is(Bit::Key4),
                deselected: false,
            });
        }
        self.run_program();
        self.step_axes(before, reads[1 - self.side], main_switch);
        for g in 0..self.groups.len() {
            self.step_group(g, machine, before, main_switch);
        }
        self.step_voltage(main_switch);
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
            ("door_open", i64::from(!self.read.is(Bit::Sd))),
            ("t_open", i64::from(!self.read.is(Bit::SdMagazine))),
            ("unit", unit(&self.read) as i64),
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
        let bits = bits.map(|(name, bit)| (name, i64::from(self.read.is(bit))));
        let seen = |wanted: &str| {
            let mut all = values.iter().chain(&bits);
            all.find(|(name, _)| *name == wanted).map_or(0, |(_, v)| *v)
        };
        self.program.step(&seen);
    }

    fn step_axes(&mut self, before: &Before, peer: &Read, power_on: bool) {
        let (som, unit) = (self.said.som.som, unit(&self.read));
        for (k, seen) in self.read.axes.iter().enumerate() {
            let group = self.groups.iter().find(|g| g.axes.contains(&k));
            let kind = group.map_or(Kind::NcAxes, |g| g.kind);
            let of_group = group.map_or(OfGroup::FREE, |g| OfGroup {
                state: g.said.group.state,
                left: g.said.group.left,
                level: g.said.stop.level,
                on_contour: g.said.stop.on_contour,
                emergency_ramp: g.said.stop.emergency_ramp,
            });
            let asked = match kind {
                Kind::NcAxes => self.program.output("feed_a", 0) != 0,
                Kind::Auxiliary => self.program.output("feed_t", 0) != 0,
                // Only axes have a feed enable.
                Kind::Spindle => true,
            };
            let feed = seen.feed.unwrap_or(asked);
            let door = match kind {
                Kind::Auxiliary => Bit::SdMagazine,
                _ => Bit::Sd,
            };
            self.feeds[k] = feed;
            let seen = Seen {
                position: seen.position,
                peer: peer.axes[k].position,
                nominal: seen.nominal(),
                feed,
                power_on,
                homed: self.read.axes[k].homed,
                confirm: self.read.axes[k].confirm,
                peer_checked: before.checked[1 - self.side][k],
                som,
                unit,
                door_open: !self.read.is(door),
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
        let spindle_rests = !self.read.is(Bit::Sd)
            && spindles
                .all(|g| g.said.torque_off && g.axes.iter().all(|k| !self.axes[*k].said.moving));
        let inputs = switch_on::Inputs {
            cvo: self.read.is(Bit::Cvo),
            chain: self.read.is(Bit::Chain),
            t_brk: false,
            // It falls as the last group loses its torque.
            dropped: main_switch || (all_off && !self.all_off),
            may_on: self.read.is(Bit::Es)
                && self.read.is(Bit::GenSafe)
                && !stops().any(|stop| braking(stop) || stop.needs_switch),
            testing: false,
            spindle_rests,
        };
        let highest = stops().map(|stop| stop.level).fold(Stop::None, Stop::max);
        let still = self.axes.iter().all(|axis| !axis.said.moving);
        self.all_off = all_off;
        self.said.voltage = self.voltage.step(&inputs);
        let outputs = self.enable.step(&output_enable::Inputs {
            ready: self.read.is(Bit::GenSafe) && self.said.voltage.sto_a_g,
            stop: highest,
            emergency: !self.read.is(Bit::Es),
            still,
        });
        self.said.enabled = outputs.enabled;
    }

    /// What it has read and written of an owner, in the order of its signals.
    fn told(&self, owner: usize) -> Vec<Value> {
        let Some(axis) = self.axes.get(owner) else {
            let read = self.read.bits.iter().map(|bit| Value::Bool(*bit));
            let said = &self.said;
            let written = [
                Value::Text(names::SOMS[said.som.som as usize].into()),
                Value::Bool(said.voltage.sto_a_g),
                Value::Bool(said.voltage.stos_a_g),
                Value::Bool(said.enabled),
            ];
            return read.chain(written).collect();
        };
        let seen = &self.read.axes[owner];
        let group = self.groups.iter().find(|g| g.axes.contains(&owner));
        let asked = group.map_or(0, |g| usize::from(g.asked));
        let [.., invalid] = names::STOP_CODES;
        let asked = names::STOP_CODES.get(asked).copied().unwrap_or(invalid);
        let mut all = vec![
            Value::Bool(self.feeds[owner]),
            Value::Int(seen.position),
            Value::Int(seen.nominal()),
            Value::Bool(seen.homed),
            Value::Bool(seen.confirm),
            Value::Text(asked.into()),
            Value::Int(seen.position.div_euclid(10)),
        ];
        all.extend(names::axis(&axis.said, group.map(|g| (&g.said, g.cause))));
        all
    }
}

/// The machine operating mode.
fn unit(read: &Read) -> Unit {
    if read.is(Bit::Homing) {
        Unit::Reference
    } else if read.is(Bit::Handwheel) {
        Unit::Handwheel
    } else if read.is(Bit::Program) {
        Unit::Program
    } else {
        Unit::Panel
    }
}
