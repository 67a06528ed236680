//! The cycles of a simulation.

use stillpoint_monitors::sinumerik::group;
use stillpoint_spec::machine::Machine;

use super::axes::{Axis, Logic, Pulse, increments};
use super::door::{Door, Seen};
use super::plant::Drive;
use super::scenario::{DoorChange, Event, Scenario, Selection, What};
use super::summary::{Simulation, summarise};
use crate::production::{self, Produced};
use crate::recording::{Recording, Value, vocabulary};

/// Runs a scenario for this machine from power-on.
///
/// # Errors
/// A sentence: the machine has no production monitors, or an axis leaves the range of positions.
pub fn run(machine: &Machine, scenario: &Scenario) -> Result<Simulation, String> {
    let produced = production::axes(machine)?;
    let mut simulator = Simulator::new(machine, &produced, scenario);
    let mut recording = Recording {
        machine: machine.name.clone(),
        cycle_us: u64::try_from(machine.monitoring_cycle).unwrap_or(1).max(1),
        first: 0,
        signals: super::signals(machine),
        rows: Vec::new(),
    };
    let mut events = scenario.events.iter().peekable();
    for cycle in 0..scenario.cycles {
        let mut now = Vec::new();
        while let Some(event) = events.next_if(|event| event.cycle <= cycle) {
            now.push(event);
        }
        recording.rows.push(simulator.cycle(cycle, &now));
        if let Some(axis) = simulator.lost() {
            return Err(format!(
                "axis {} leaves the range of positions, {} to {} increments, in cycle {cycle}; let it stop before",
                machine.axes[axis].name,
                i32::MIN,
                i32::MAX
            ));
        }
    }
    Ok(summarise(machine, scenario, recording, &produced))
}

/// What monitors the axes behind a door while it is open.
fn opened(door: &stillpoint_spec::machine::Door) -> Selection {
    let code = door.values.get("open");
    let code = code.and_then(|v| v.cells.first().copied());
    match code.and_then(|code| u8::try_from(code).ok()) {
        Some(stage @ 1..=4) => Selection::Stage(stage - 1),
        _ => Selection::Standstill,
    }
}

struct Simulator<'a> {
    machine: &'a Machine,
    axes: Vec<Axis>,
    doors: Vec<Door>,
    inputs: Vec<vocabulary::Input>,
    outputs: Vec<vocabulary::Output>,
    /// The machine was running before the scenario began, so its first cycle is power-on.
    running: bool,
}

impl<'a> Simulator<'a> {
    fn new(machine: &'a Machine, produced: &[Produced], scenario: &Scenario) -> Self {
        let axes = produced.iter().zip(&scenario.axes);
        Self {
            machine,
            axes: axes
                .map(|(p, start)| Axis::new(p, start, scenario))
                .collect(),
            doors: vec![Door::default(); machine.doors.len()],
            inputs: vocabulary::inputs(),
            outputs: vocabulary::outputs(),
            running: scenario.running,
        }
    }

    /// An axis that has left the range of positions.
    fn lost(&self) -> Option<usize> {
        let range = i64::from(i32::MIN) * 1_000..=i64::from(i32::MAX) * 1_000;
        self.axes
            .iter()
            .position(|axis| !range.contains(&axis.plant.position))
    }

    fn cycle(&mut self, cycle: u32, events: &[&Event]) -> Vec<Option<Value>> {
        let first = Pulse {
            power_on: self.running && cycle == 0,
            ..Pulse::default()
        };
        let mut pulses = vec![first; self.axes.len()];
        for event in events {
            self.happen(cycle, event, &mut pulses);
        }
        if pulses.iter().any(|pulse| pulse.power_on) {
            self.doors.iter_mut().for_each(Door::power_on);
        }
        for (k, pulse) in pulses.into_iter().enumerate() {
            let logic = self.logic(k);
            let axis = &mut self.axes[k];
            axis.see(cycle, logic, pulse, &self.inputs);
            axis.step();
        }
        self.react();
        self.axes.iter_mut().for_each(Axis::obey);
        let row = self.record();
        for axis in &mut self.axes {
            axis.plant.advance(axis.drive);
        }
        self.step_doors();
        row
    }

    fn happen(&mut self, cycle: u32, event: &Event, pulses: &mut [Pulse]) {
        if let What::Door { door, change } = &event.what {
            let door = &mut self.doors[*door];
            match *change {
                DoorChange::Asked(asked) => door.asked = asked,
                DoorChange::Open(open) => door.open = open,
            }
            return;
        }
        for k in &event.axes {
            let (axis, pulse) = (&mut self.axes[*k], &mut pulses[*k]);
            let sides = (0..2).filter(|side| event.sides[*side]);
            match &event.what {
                What::Door { .. } => {}
                What::Motion(setpoint) => axis.plant.setpoint = *setpoint,
                What::Select(selection) => axis.selected = *selection,
                What::Limits(second) => axis.second_limits = *second,
                What::Force { input, value } => {
                    axis.forced
                        .retain(|(i, side, _)| i != input || !event.sides[*side]);
                    if let Some(value) = value {
                        axis.forced.extend(sides.map(|side| (*input, side, *value)));
                    }
                }
                What::Stop(letter) => sides.for_each(|side| axis.external[side] = *letter),
                What::Reset => pulse.reset = true,
                What::Power(delay) => {
                    pulse.power_on = true;
                    axis.run_up_at = Some(cycle.saturating_add(*delay));
                    axis.referenced = false;
                    axis.powered_at = axis.position();
                    axis.plant.setpoint = super::plant::Setpoint::default();
                }
                What::Agreement { give, key } => {
                    pulse.give = *give;
                    pulse.withdraw = !*give;
                    pulse.key = *key;
                }
                What::Moved(by) => axis.plant.shift(*by),
                What::Reference => {
                    axis.referenced = true;
                    axis.refpos = axis.position();
                }
                What::Fault(fault) => {
                    let at = increments(axis.plant.position);
                    sides.for_each(|side| axis.faults[side] = (*fault, at));
                }
            }
        }
    }

    /// What the safe logic selects for an axis: the strictest of its mode and of the doors in front of it, and the tests of
    /// its shutdown paths.
    fn logic(&self, k: usize) -> Logic {
        let (axis, name) = (&self.axes[k], &self.machine.axes[k].name);
        let mut logic = Logic {
            selection: axis.selected,
            test: [false; 2],
        };
        for (door, state) in self.machine.doors.iter().zip(&self.doors) {
            if door.has(name) {
                if state.selects() {
                    logic.selection = axis.stricter(logic.selection, opened(door));
                }
                if let Some(side) = state.tests() {
                    logic.test[side] = true;
                }
            }
        }
        logic
    }

    /// The logic of the doors reads what the monitors have told.
    fn step_doors(&mut self) {
        for (door, state) in self.machine.doors.iter().zip(&mut self.doors) {
            let axes = self.machine.axes.iter().zip(&self.axes);
            let behind = axes.filter(|(known, _)| door.has(&known.name));
            let seen: Vec<Seen> = behind.map(|(_, axis)| axis.seen(opened(door))).collect();
            state.step(&seen);
        }
    }

    /// The stops of each axis reach the others as its stop group says.
    fn react(&mut self) {
        let machine = self.machine;
        let together = |a: usize, b: usize| {
            let has = |a: usize, b: usize| {
                machine.axes[a]
                    .interpolates_with
                    .iter()
                    .any(|n| *n.get_ref() == machine.axes[b].name)
            };
            has(a, b) || has(b, a)
        };
        let reactions: Vec<group::Reaction> = (0..self.axes.len())
            .map(|k| {
                let others = (0..self.axes.len()).filter(|other| *other != k);
                let acts: Vec<group::Reaction> = others
                    .map(|other| self.axes[other].acts(together(other, k)))
                    .collect();
                group::worst(&acts)
            })
            .collect();
        for (axis, reaction) in self.axes.iter_mut().zip(reactions) {
            axis.reaction = reaction;
        }
    }

    fn record(&self) -> Vec<Option<Value>> {
        let doors = self.doors.iter();
        let doors = doors.flat_map(|door| [door.open, door.asked, door.released()]);
        let mut row: Vec<Option<Value>> = doors.map(|d| Some(Value::Bool(d))).collect();
        for axis in &self.axes {
            let plant = &axis.plant;
            row.extend([
                Some(Value::Int(plant.position)),
                Some(Value::Int(plant.speed)),
                Some(Value::Int(match axis.drive {
                    Drive::Follow => plant.wanted(),
                    _ => 0,
                })),
                Some(Value::Text(axis.drive.keyword().into())),
            ]);
            let sides = [
                (&axis.inputs.nck, &axis.outputs.nck),
                (&axis.inputs.drive, &axis.outputs.drive),
            ];
            for (side, (local, outputs)) in sides.into_iter().enumerate() {
                row.extend(self.inputs.iter().map(|input| Some(input.get(local))));
                row.extend(
                    self.outputs
                        .iter()
                        .map(|output| Some(output.get(side, local, outputs))),
                );
            }
        }
        row
    }
}
