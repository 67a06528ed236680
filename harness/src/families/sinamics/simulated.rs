//! The machine in a simulation: what the F-CPU selects, the drives, and the person who operates it.

use stillpoint_machine::{Axis as MachineAxis, Door as Guard, Machine};

use super::channel::Pair;
use super::outputs;
use super::said::Said;
use super::signals::{self, Flag, Input, Number, Read};
use super::values::{self, Values};
use crate::families::values::cell;
use crate::families::{Monitors, Now, Start};
use crate::plant::{Actuation, Axis, Door, increments};
use crate::recording::Value;

/// What a mode selects: SOS, the levels of SLS, SS2, both directions of SDI.
pub(super) const SELECTIONS: [&str; 8] =
    ["SOS", "SLS1", "SLS2", "SLS3", "SLS4", "SS2", "SDI+", "SDI-"];

/// For so many cycles a button is pressed, so that both channels have seen it; then the faults are acknowledged for as long, and ON/OFF1 is off
/// for as long.
const PRESSED: u32 = 4;

/// What the F-CPU selects for an axis.
#[derive(Clone, Copy, Default)]
struct Selection {
    sto: bool,
    ss1: bool,
    ss2: bool,
    sos: bool,
    /// The level of SLS, 0 to 3.
    sls: Option<usize>,
    sdi: [bool; 2],
}

impl Selection {
    /// What a door of the machine file or its enabling device selects, by the code of its parameter.
    fn of_door(code: i64) -> Self {
        let mut selection = Self::default();
        match code {
            0 => selection.sto = true,
            1 => selection.ss1 = true,
            3 => selection.ss2 = true,
            4..=7 => selection.sls = usize::try_from(code - 4).ok(),
            _ => selection.sos = true,
        }
        selection
    }

    /// What the mode of the axis selects.
    fn of_mode(place: Option<usize>) -> Self {
        let mut selection = Self::default();
        match place {
            None => {}
            Some(0) => selection.sos = true,
            Some(level @ 1..=4) => selection.sls = Some(level - 1),
            Some(5) => selection.ss2 = true,
            Some(direction) => selection.sdi[usize::from(direction > 6)] = true,
        }
        selection
    }

    /// Both: of two levels that with the lower limit.
    fn and(self, other: Self, values: &Values) -> Self {
        let limit = |level: &usize| values.extended.as_ref().map(|e| e.limits[(*level).min(3)]);
        let levels = [self.sls, other.sls].into_iter().flatten();
        Self {
            sto: self.sto || other.sto,
            ss1: self.ss1 || other.ss1,
            ss2: self.ss2 || other.ss2,
            sos: self.sos || other.sos,
            sls: levels.min_by_key(limit),
            sdi: [0, 1].map(|k| self.sdi[k] || other.sdi[k]),
        }
    }

    /// A channel says that it is there: of SLS not above the limit of the level that is asked for, whatever level is active.
    fn is_active(&self, said: &Said, values: &Values) -> bool {
        let stands = said.sto || said.sos;
        let limit = |level: usize| values.extended.as_ref().map(|e| e.limits[level.min(3)]);
        match (self.sto || self.ss1, self.sos || self.ss2) {
            (true, _) => said.sto,
            (false, true) => stands,
            (false, false) => {
                let asked = self.sls.and_then(limit);
                stands || said.sls && asked.is_none_or(|limit| said.sls_limit <= limit)
            }
        }
    }
}

/// A door as the F-CPU sees it.
#[derive(Clone, Copy, Default)]
struct Seen {
    /// Cycles from its contact to the input of the drive.
    delay: u32,
    open: bool,
    asked: bool,
    /// Cycles for which it has been otherwise.
    since: u32,
    released: bool,
}

/// The monitors of the machine.
pub(super) struct Simulated<'a> {
    machine: &'a Machine,
    limited: bool,
    running: bool,
    axes: Vec<OfAxis>,
    doors: Vec<Seen>,
}

struct OfAxis {
    values: Values,
    inputs: Vec<Input>,
    /// In so many cycles its brake opens or closes; none: it has no brake.
    brake: Option<u32>,
    /// None before the first cycle.
    pair: Option<Pair>,
    /// The drive has been switched on once.
    powered: bool,
    /// Somebody holds the enabling device.
    enabling: bool,
    /// Cycles until the drive is switched on again after an acknowledgement.
    pressed: u32,
    /// ON/OFF1.
    on: bool,
    first: bool,
    read: [Read; 2],
    said: [Said; 2],
}

impl<'a> Simulated<'a> {
    pub(super) fn new(machine: &'a Machine, start: &Start) -> Result<Self, String> {
        let of_axis = |(values, known): (Values, &MachineAxis)| OfAxis {
            values,
            inputs: signals::inputs(known),
            brake: (known.has(values::SBC)).then(|| values::brake_cycles(machine, known)),
            pair: None,
            powered: start.running,
            enabling: false,
            pressed: 0,
            on: start.running,
            first: true,
            read: [Read::default(); 2],
            said: [Said::default(); 2],
        };
        let values = values::axes(machine)?.into_iter();
        let doors = machine.doors.iter().map(|guard| Seen {
            delay: values::door_cycles(machine, &guard.values),
            ..Seen::default()
        });
        Ok(Self {
            machine,
            limited: !start.acceptance_mode,
            running: start.running,
            axes: values.zip(&machine.axes).map(of_axis).collect(),
            doors: doors.collect(),
        })
    }

    /// The contacts of the doors reach the drives after the time of the machine file.
    fn see_doors(&mut self, doors: &[Door]) {
        for (door, seen) in doors.iter().zip(&mut self.doors) {
            let now = (door.open, door.asked);
            if now == (seen.open, seen.asked) {
                seen.since = 0;
            } else if seen.since >= seen.delay {
                (seen.open, seen.asked) = now;
                seen.since = 0;
            } else {
                seen.since += 1;
            }
        }
    }

    /// What a door selects for an axis behind it.
    fn behind(&self, guard: &Guard, enabling: bool) -> Selection {
        let code = |name| cell(&guard.values, name, 0);
        match (enabling, code("enabling")) {
            (true, held @ 1..) => Selection::of_door(held),
            _ => Selection::of_door(code("open")),
        }
    }

    /// What the F-CPU selects for an axis.
    fn selection(&self, k: usize, axis: &Axis) -> Selection {
        let own = &self.axes[k];
        let mut selection = Selection::of_mode(axis.selected);
        let name = &self.machine.axes[k].name;
        for (guard, seen) in self.machine.doors.iter().zip(&self.doors) {
            if guard.has(name) && (seen.open || seen.asked) {
                let door = self.behind(guard, own.enabling);
                selection = selection.and(door, &own.values);
            }
        }
        selection
    }

    /// What both channels read of an axis: what is simulated, unless an input is forced.
    fn read(&mut self, k: usize, now: &Now<'_>) {
        let axis = &now.axes[k];
        let pulse = axis.pulse;
        let switched = pulse.power_on && now.cycle > 0;
        let own = &mut self.axes[k];
        own.powered |= switched;
        own.enabling = (own.enabling || pulse.give) && !pulse.withdraw;
        if switched {
            (own.on, own.pressed) = (false, 0);
        }
        let torque = own.said.iter().all(|said| said.torque);
        if pulse.reset {
            own.pressed = 3 * PRESSED;
        }
        // Who acknowledges a drive without torque switches it off and on again.
        if own.pressed > 0 && !torque {
            own.on = own.pressed > PRESSED || own.pressed == 1;
        }
        let acknowledges = own.pressed > 2 * PRESSED;
        let general = own.pressed > PRESSED && !acknowledges;
        own.pressed = own.pressed.saturating_sub(1);
        let selection = self.selection(k, axis);
        let known = &self.machine.axes[k];
        let limited = self.limited;
        let own = &mut self.axes[k];
        let by_terminal = !values::bits(known);
        for side in 0..2 {
            let mut selection = selection;
            match axis.asked[side] {
                Some(0) => selection.sto = true,
                Some(1) => selection.ss1 = true,
                Some(2) => selection.ss2 = true,
                _ => {}
            }
            let stops = selection.sto || selection.ss1;
            let level = selection.sls.and_then(|level| i32::try_from(level).ok());
            let mut read = Read::at_rest(increments(axis.shown(side)))
                .number(Number::Level, level.unwrap_or(0))
                .flags(&[
                    (Flag::PowerOn, switched),
                    (Flag::PoweredUp, own.powered && axis.run_up(now.cycle)),
                    (Flag::Terminal, !(by_terminal && stops)),
                    (Flag::Telegram, own.powered),
                    (Flag::Sto, !selection.sto),
                    (Flag::Ss1, !selection.ss1),
                    (Flag::Ss2, !selection.ss2),
                    (Flag::Sos, !selection.sos),
                    (Flag::Sls, selection.sls.is_none()),
                    (Flag::SdiPositive, !selection.sdi[0]),
                    (Flag::SdiNegative, !selection.sdi[1]),
                    (Flag::Slp, axis.limits > 1),
                    (Flag::SlpRange, axis.limits == 1),
                    (Flag::Ack, acknowledges),
                    (Flag::General, general),
                    (Flag::Declared, pulse.reference),
                    (Flag::ExternalClosed, axis.brakes[1].closed),
                    (Flag::On, own.on),
                    // The mode begins by an edge, once the drive is there.
                    (Flag::Acceptance, !limited && own.powered && !switched),
                ]);
            for forced in now.forced.iter().filter(|f| f.owner == k && f.side == side) {
                // The scenario has been checked.
                let _ = read.set(own.inputs[forced.input], &forced.value);
            }
            own.read[side] = read.only(&own.inputs);
        }
    }

    /// The lock of a door opens where it is asked for and every axis behind it is as safe as it asks for.
    fn release_doors(&mut self) {
        for k in 0..self.doors.len() {
            let guard = &self.machine.doors[k];
            let axes = self.machine.axes.iter().zip(&self.axes);
            let mut behind = axes.filter(|(known, _)| guard.has(&known.name));
            let safe = behind.all(|(_, own)| {
                let selection = self.behind(guard, own.enabling);
                own.said
                    .iter()
                    .all(|said| selection.is_active(said, &own.values))
            });
            self.doors[k].released = self.doors[k].asked && safe;
        }
    }
}

impl OfAxis {
    /// The drive and the control obey both channels.
    fn obeyed(&mut self, axis: &mut Axis) {
        let any = |test: fn(&Said) -> bool| self.said.iter().any(test);
        // Both channels of the test say so.
        let tests = self.said.iter().all(|said| said.service.brake.torque);
        let asked = if any(|s| s.pulses_off || !s.torque) {
            Actuation::Coast
        } else if tests {
            Actuation::BrakeTest
        } else if any(|s| s.off3 || s.control_brakes) {
            Actuation::Path
        } else {
            Actuation::Follow
        };
        axis.obey(asked, any(|s| s.inhibited));
        // r9733 of both channels, in the direction in which the axis is to go.
        let wanted = axis.plant.setpoint;
        let towards = match wanted.target {
            Some(target) => target - axis.plant.position,
            None => wanted.speed,
        };
        let limits = self.said.iter().filter_map(|said| said.directions);
        let limits = limits.map(|both| both[usize::from(towards < 0)].0);
        let limit = limits.min().filter(|limit| *limit < u32::MAX);
        axis.plant.limit = limit.map(|limit| i64::from(limit) * 1_000);
        let braking = axis.plant.braking();
        let [done, ramp] = self.said[0].service.share.map(i64::from);
        let torque = if tests { braking * done / ramp } else { 0 };
        axis.plant.press = match self.said[0].service.negative {
            true => -torque,
            false => torque,
        };
        if let Some(time) = self.brake {
            let open = self.said.iter().all(|said| said.brake_open);
            let external = any(|said| said.service.brake.close_external);
            let time = if self.first { 0 } else { time };
            axis.brakes[0].ask(!open, time);
            // The control closes the external one when it is asked to, in the same time.
            axis.brakes[1].ask(external, time);
            let held = axis.brakes.iter().map(|brake| brake.holds(braking));
            axis.plant.held = Some(held.sum());
        }
        self.first = false;
    }
}

impl Monitors for Simulated<'_> {
    fn step(&mut self, now: Now<'_>) {
        self.see_doors(now.doors);
        for k in 0..self.axes.len() {
            self.read(k, &now);
            let running = self.running;
            let own = &mut self.axes[k];
            let (values, read) = (&own.values, &own.read);
            let pair = own
                .pair
                .get_or_insert_with(|| Pair::new(values, running, read));
            own.said = pair.step(read);
            own.obeyed(&mut now.axes[k]);
        }
        self.release_doors();
    }

    fn released(&self, door: usize) -> bool {
        self.doors[door].released
    }

    fn told(&self, owner: usize, side: usize) -> Vec<Value> {
        let (known, own) = (&self.machine.axes[owner], &self.axes[owner]);
        let inputs = own.inputs.iter().map(|input| own.read[side].get(*input));
        let outputs = outputs::outputs(known, side, &own.said[side]).into_iter();
        inputs.chain(outputs.map(|(_, value)| value)).collect()
    }
}
