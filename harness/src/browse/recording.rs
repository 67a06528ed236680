//! A walk as a recording for `diff --trace`: what it gives to the input signals of an axis or of the machine, on the production
//! monitors of both channels with the values of the machine, and beside it the state of the walk.
//!
//! A walk goes through a system that is smaller than the machine: other times, few positions, requests of monitors as free
//! inputs. The recording therefore does not tell what the tables said along the walk as if it were the machine's, but what
//! the monitors say to the same signals. Each cycle of the walk is one monitoring cycle, or as many of them as one of the system
//! takes.

use stillpoint_engine::subject::Task;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::eval::{Frame, UNSET};
use stillpoint_lang::ir::LazyKind;
use stillpoint_machine::Machine;

use super::walk::Walk;
use crate::families::{self, Drive, Feed, Owner, Rig};
use crate::recording::{Allowed, Kind, Recording, Role, Signal, Value};

/// Where the value of an input of the tables stands in a cycle of a walk.
#[derive(Clone, Copy)]
enum At {
    /// Among the inputs of the system.
    Input(usize),
    /// Among its named expressions: it is wired.
    Wire(usize),
}

/// An input of the tables and what it is to the channels.
struct Fed {
    at: At,
    /// In which channels.
    sides: [bool; 2],
    feed: &'static Feed,
}

impl Fed {
    /// Its value in a cycle; none where it is that of an input that nothing has asked for.
    fn value(&self, bound: &Bound, frame: &Frame) -> Option<i32> {
        match self.at {
            At::Input(k) => frame.inputs.get(k).copied().filter(|v| *v != UNSET),
            At::Wire(k) => {
                let mut known = true;
                // What is wired to an input alone is never worked out in a step.
                let value = bound.lazy(k, &mut frame.clone(), &mut |input| {
                    known = false;
                    bound.inputs[input].0
                });
                i32::try_from(value).ok().filter(|_| known)
            }
        }
    }
}

/// What the inputs of a system are to the channels; empty where none is a signal.
fn feeds(drive: &dyn Drive, task: &Task) -> Vec<Fed> {
    let system = &task.bound.system;
    let inputs = system.inputs.iter().enumerate();
    let inputs = inputs.map(|(k, var)| (At::Input(k), var.name.as_str()));
    let wires = system.lazies.iter().enumerate();
    let wires = wires.filter(|(_, lazy)| lazy.kind == LazyKind::Wire);
    let wires = wires.map(|(k, lazy)| (At::Wire(k), lazy.name.as_str()));
    let feeds = inputs.chain(wires).filter_map(|(at, full)| {
        let name = full.replace("[1]", "").replace("[2]", "");
        let short = name.rsplit('.').next().unwrap_or(&name);
        let counts = |feed: &&Feed| match (feed.wired, at) {
            (true, _) => feed.table == name,
            (false, At::Input(_)) => feed.table == name || feed.table == short,
            (false, At::Wire(_)) => false,
        };
        Some(Fed {
            at,
            sides: [!full.contains("[2]"), !full.contains("[1]")],
            feed: drive.feeds().iter().find(counts)?,
        })
    });
    feeds.collect()
}

/// Whether a walk through a system can be recorded: some of its inputs are signals that a user sets.
pub fn recordable(machine: Option<&Machine>, task: &Task) -> bool {
    let drive = machine.and_then(|machine| families::of(machine).ok());
    drive.is_some_and(|drive| {
        !task.axes.is_empty() && feeds(drive, task).iter().any(|fed| fed.feed.user)
    })
}

/// Records a walk.
///
/// # Errors
/// A sentence: not a machine with production monitors, or a system without signals of an axis.
pub fn recording(machine: Option<&Machine>, task: &Task, walk: &Walk) -> Result<Recording, String> {
    let (Some(machine), true) = (machine, recordable(machine, task)) else {
        return Err(
            "no input of this system is a signal of an axis with production monitors: there is nothing to be recorded"
                .to_owned(),
        );
    };
    let drive = families::of(machine)?;
    drive.accepts(machine)?;
    let axis = task.axes.first().map_or("", String::as_str);
    let Some(place) = machine.axes.iter().position(|a| a.name == axis) else {
        return Err(format!("the machine has no axis {axis}"));
    };
    let all = drive.owners(machine);
    let mut together = drive.together(machine).into_iter();
    let places = together.find(|places| places.contains(&place));
    let places = places.ok_or_else(|| format!("no monitors run the axis {axis}"))?;
    let owners: Vec<(usize, &Owner)> = places.iter().map(|k| (*k, &all[*k])).collect();
    let words = drive.words();
    let feeds = feeds(drive, task);
    let told = |name: &str| {
        name == words.position
            || words.told.contains(&name)
            || feeds.iter().any(|fed| fed.feed.signals.contains(&name))
    };
    // A system whose cycle is longer than that of the monitors waits for them.
    let cycle_us = u64::try_from(machine.monitoring_cycle).unwrap_or(1).max(1);
    let repeats = (task.bound.system.cycle_us / cycle_us).max(1);
    let mut recording = Recording {
        machine: machine.name.clone(),
        cycle_us,
        first: 0,
        signals: signals(&owners, words.channels, task, &told),
        rows: Vec::new(),
    };
    drive.play(machine, &places, false, &mut |rig| {
        let mut last: Vec<Option<i32>> = vec![None; feeds.len()];
        for (row, cycle) in walk.cycles.iter().enumerate() {
            for repeat in 0..repeats {
                rig.rest(row == 0 && repeat == 0);
                for (fed, last) in feeds.iter().zip(&mut last) {
                    let value = fed.value(&task.bound, &cycle.frame).filter(|_| repeat == 0);
                    if !fed.feed.pulse {
                        *last = value.or(*last);
                    }
                    if let Some(value) = value.or(*last) {
                        give(rig, &owners, fed, value);
                    }
                }
                rig.step();
                let mut values = walked(task, walk, row);
                for (place, owner) in &owners {
                    for side in 0..2 {
                        let inputs = owner.inputs.iter().enumerate();
                        let inputs = inputs.filter(|(_, port)| told(port.name));
                        values.extend(inputs.map(|(k, _)| Some(rig.get(*place, side, k))));
                        let outputs = 0..owner.outputs.len();
                        values.extend(outputs.map(|k| Some(rig.output(*place, side, k))));
                    }
                }
                recording.rows.push(values);
            }
        }
    })?;
    Ok(recording)
}

/// Gives the value of an input to the signals that it is. A pulse that comes at rest stays: every recording begins with
/// power-on.
fn give(rig: &mut dyn Rig, owners: &[(usize, &Owner)], fed: &Fed, value: i32) {
    for (place, owner) in owners {
        for (k, name) in fed.feed.signals.iter().enumerate() {
            let Some(input) = owner.inputs.iter().position(|i| i.name == *name) else {
                continue;
            };
            for side in (0..2).filter(|side| fed.sides[*side]) {
                let stays = fed.feed.pulse && rig.get(*place, side, input) == Value::Bool(true);
                let on = fed.feed.coding.is_on(value, k) || stays;
                // All of them are flags.
                let _ = rig.set(*place, side, input, &Value::Bool(on));
            }
        }
    }
}

/// The signals: the state of the walk, then of each channel what it sees and says.
fn signals(
    owners: &[(usize, &Owner)],
    channels: &[&str],
    task: &Task,
    told: &dyn Fn(&str) -> bool,
) -> Vec<Signal> {
    let states = task.bound.system.states.iter();
    let mut all: Vec<Signal> = states
        .map(|state| Signal {
            name: format!("walk.{}", state.var.name),
            kind: Kind::Text,
            unit: String::new(),
            role: Role::Plant,
            allowed: Allowed::All,
        })
        .collect();
    for (_, owner) in owners {
        let names = || owner.inputs.iter().chain(&owner.outputs).map(|p| p.name);
        for channel in channels {
            let signals = owner.signals(channel).into_iter().zip(names());
            let known = signals.filter(|(s, name)| s.role == Role::Output || told(name));
            all.extend(known.map(|(signal, _)| signal));
        }
    }
    all
}

/// The state of the walk after a cycle; a cycle that met a fault has none.
fn walked(task: &Task, walk: &Walk, row: usize) -> Vec<Option<Value>> {
    let system = &task.bound.system;
    let after = walk.states.get(row + 1);
    let states = system.states.iter().enumerate();
    states
        .map(|(k, state)| {
            let value = after?.get(k)?;
            let shown = system.show(state.var.ty, i64::from(*value));
            Some(Value::Text(shown.into()))
        })
        .collect()
}
