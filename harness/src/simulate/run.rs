//! The cycles of a simulation.

use stillpoint_machine::Machine;

use super::scenario::{DoorChange, Event, Scenario, What};
use super::summary::{Simulation, summarise};
use crate::families::{self, Drive, Forced, Monitors, Now, Owner, Start};
use crate::plant::{Actuation, Axis, Door, Pulse, Setpoint};
use crate::recording::{Recording, Value};

/// Runs a scenario for this machine from power-on.
///
/// # Errors
/// A sentence: the machine has no production monitors, or an axis leaves the range of positions.
pub fn run(machine: &Machine, scenario: &Scenario) -> Result<Simulation, String> {
    let drive = families::of(machine)?;
    let mut simulator = Simulator::new(machine, drive, scenario)?;
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
    Ok(summarise(machine, drive, scenario, recording))
}

struct Simulator<'a> {
    axes: Vec<Axis>,
    doors: Vec<Door>,
    forced: Vec<Forced>,
    monitors: Box<dyn Monitors + 'a>,
    owners: Vec<Owner>,
    channels: usize,
    /// The machine was running before the scenario began, so its first cycle is power-on.
    running: bool,
}

impl<'a> Simulator<'a> {
    fn new(
        machine: &'a Machine,
        drive: &'static dyn Drive,
        scenario: &Scenario,
    ) -> Result<Self, String> {
        let running = scenario.running;
        let axes = scenario.axes.iter();
        let axes: Vec<Axis> = axes
            .map(|start| Axis::new(start.mechanics, start.position, running))
            .collect();
        let start = Start {
            running,
            acceptance_mode: scenario.acceptance_mode,
        };
        Ok(Self {
            monitors: drive.power(machine, &axes, &start)?,
            axes,
            doors: vec![Door::default(); machine.doors.len()],
            forced: Vec::new(),
            owners: drive.owners(machine),
            channels: drive.words().channels.len(),
            running,
        })
    }

    /// An axis that has left the range of positions.
    fn lost(&self) -> Option<usize> {
        let range = i64::from(i32::MIN) * 1_000..=i64::from(i32::MAX) * 1_000;
        self.axes
            .iter()
            .position(|axis| !range.contains(&axis.plant.position))
    }

    fn cycle(&mut self, cycle: u32, events: &[&Event]) -> Vec<Option<Value>> {
        for axis in &mut self.axes {
            axis.pulse = Pulse {
                power_on: self.running && cycle == 0,
                ..Pulse::default()
            };
        }
        for event in events {
            self.happen(cycle, event);
        }
        self.axes.iter_mut().for_each(Axis::slip);
        self.monitors.step(Now {
            cycle,
            axes: &mut self.axes,
            doors: &self.doors,
            forced: &self.forced,
        });
        let row = self.record();
        for axis in &mut self.axes {
            axis.plant.advance(axis.drive);
        }
        row
    }

    fn happen(&mut self, cycle: u32, event: &Event) {
        match &event.what {
            What::Door { door, change } => {
                let door = &mut self.doors[*door];
                match *change {
                    DoorChange::Asked(asked) => door.asked = asked,
                    DoorChange::Open(open) => door.open = open,
                }
            }
            What::Force { input, value } => self.force(event, *input, value.as_ref()),
            what => {
                for k in &event.axes {
                    befall(&mut self.axes[*k], cycle, event.sides, what);
                }
            }
        }
    }

    fn force(&mut self, event: &Event, input: usize, value: Option<&Value>) {
        for owner in event.axes.iter().copied() {
            let sides = (0..2).filter(|side| event.sides[*side]);
            self.forced
                .retain(|f| f.owner != owner || f.input != input || !event.sides[f.side]);
            if let Some(value) = value {
                self.forced.extend(sides.map(|side| Forced {
                    owner,
                    side,
                    input,
                    value: value.clone(),
                }));
            }
        }
    }

    fn record(&self) -> Vec<Option<Value>> {
        let mut row = Vec::new();
        for (k, door) in self.doors.iter().enumerate() {
            let said = [door.open, door.asked, self.monitors.released(k)];
            row.extend(said.map(Value::Bool));
        }
        for owner in 0..self.owners.len() {
            if let Some(axis) = self.axes.get(owner) {
                let plant = &axis.plant;
                let wanted = match axis.drive {
                    Actuation::Follow => plant.wanted(),
                    _ => 0,
                };
                let of_plant = [plant.position, plant.speed, wanted];
                row.extend(of_plant.map(Value::Int));
                row.push(Value::Text(axis.drive.keyword().into()));
            }
            for side in 0..self.channels {
                row.extend(self.monitors.told(owner, side));
            }
        }
        row.into_iter().map(Some).collect()
    }
}

/// What happens to an axis.
fn befall(axis: &mut Axis, cycle: u32, on: [bool; 2], what: &What) {
    let sides = (0..2).filter(|side| on[*side]);
    match what {
        What::Door { .. } | What::Force { .. } => {}
        What::Motion(setpoint) => axis.plant.setpoint = *setpoint,
        What::Select(selected) => axis.selected = *selected,
        What::Limits(limits) => axis.limits = *limits,
        What::Stop(asked) => sides.for_each(|side| axis.asked[side] = *asked),
        What::Reset => axis.pulse.reset = true,
        What::Power(delay) => {
            axis.pulse.power_on = true;
            axis.run_up_at = Some(cycle.saturating_add(*delay));
            axis.referenced = false;
            axis.powered_at = axis.plant.position;
            axis.plant.setpoint = Setpoint::default();
        }
        What::Agreement { give, key } => {
            axis.pulse.give = *give;
            axis.pulse.withdraw = !*give;
            axis.pulse.key = *key;
        }
        What::Moved(by) => axis.plant.shift(*by),
        What::Reference => {
            axis.referenced = true;
            axis.pulse.reference = true;
            axis.reference = axis.plant.position;
        }
        What::Fault { fault, encoders } => {
            let at = axis.plant.position;
            let all = axis.faults.iter_mut().zip(encoders);
            for (own, _) in all.filter(|(_, meant)| **meant) {
                *own = (*fault, at);
            }
        }
        What::Brake {
            brake,
            torque,
            stuck,
        } => {
            axis.brakes[*brake].torque = *torque;
            axis.brakes[*brake].stuck = *stuck;
        }
        What::Load(load) => axis.load = *load,
    }
}
