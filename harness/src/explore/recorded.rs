//! A walk as a recording for `diff --trace`: what it gives to the input signals of an axis, on the production monitors of both
//! channels with the values of the machine, and beside it the state of the walk.
//!
//! A walk goes through a system that is smaller than the machine: other times, few positions, requests of monitors as free
//! inputs. The recording therefore does not tell what the tables said along the walk as if it were the machine's, but what
//! the monitors say to the same signals. Each cycle of the walk is one monitoring cycle.

use stillpoint_engine::subject::Task;
use stillpoint_lang::eval::UNSET;
use stillpoint_machine::Machine;

use super::walk::Walk;
use crate::families::{self, Drive, Feed, Owner, Rig};
use crate::recording::{Kind, Recording, Role, Signal, Value, vocabulary};

/// An input of the system and what it is to the channels.
struct Fed {
    input: usize,
    /// In which channels.
    sides: [bool; 2],
    feed: &'static Feed,
}

/// What the inputs of a system are to the channels of an axis; empty where none is a signal.
fn feeds(drive: &dyn Drive, task: &Task) -> Vec<Fed> {
    let inputs = task.bound.system.inputs.iter().enumerate();
    let feeds = inputs.filter_map(|(input, var)| {
        let name = var.name.replace("[1]", "").replace("[2]", "");
        let short = name.rsplit('.').next().unwrap_or(&name);
        let mut known = drive.feeds().iter();
        let feed = known.find(|known| known.table == name || known.table == short)?;
        Some(Fed {
            input,
            sides: [!var.name.contains("[2]"), !var.name.contains("[1]")],
            feed,
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
    let mut owners = drive.owners(machine);
    let owner = owners.swap_remove(place);
    let words = drive.words();
    let feeds = feeds(drive, task);
    let told = |name: &str| {
        name == vocabulary::POSITION
            || words.told.contains(&name)
            || feeds.iter().any(|fed| fed.feed.signals.contains(&name))
    };
    let inputs: Vec<usize> = (0..owner.inputs.len())
        .filter(|k| told(owner.inputs[*k].name))
        .collect();
    let mut recording = Recording {
        machine: machine.name.clone(),
        cycle_us: u64::try_from(machine.monitoring_cycle).unwrap_or(1).max(1),
        first: 0,
        signals: signals(&owner, words.channels, task, &inputs),
        rows: Vec::new(),
    };
    drive.play(machine, place, false, &mut |rig| {
        let mut last: Vec<Option<i32>> = vec![None; feeds.len()];
        for (row, cycle) in walk.cycles.iter().enumerate() {
            rig.rest(row == 0);
            for (fed, last) in feeds.iter().zip(&mut last) {
                let value = cycle.frame.inputs.get(fed.input).copied();
                let value = value.filter(|v| *v != UNSET);
                if !fed.feed.pulse {
                    *last = value.or(*last);
                }
                if let Some(value) = value.or(*last) {
                    give(rig, &owner, fed, value);
                }
            }
            rig.step();
            let mut values = walked(task, walk, row);
            for side in 0..2 {
                values.extend(inputs.iter().map(|k| Some(rig.get(side, *k))));
                values.extend((0..owner.outputs.len()).map(|k| Some(rig.output(side, k))));
            }
            recording.rows.push(values);
        }
    })?;
    Ok(recording)
}

/// Gives the value of an input to the signals that it is. A pulse that comes at rest stays: every recording begins with
/// power-on.
fn give(rig: &mut dyn Rig, owner: &Owner, fed: &Fed, value: i32) {
    for side in (0..2).filter(|side| fed.sides[*side]) {
        for (bit, name) in fed.feed.signals.iter().enumerate() {
            let Some(input) = owner.inputs.iter().position(|i| i.name == *name) else {
                continue;
            };
            let stays = fed.feed.pulse && rig.get(side, input) == Value::Bool(true);
            let on = value >> bit & 1 == 1 || stays;
            // All of them are flags.
            let _ = rig.set(side, input, &Value::Bool(on));
        }
    }
}

/// The signals: the state of the walk, then of each channel what it sees and says.
fn signals(owner: &Owner, channels: [&str; 2], task: &Task, inputs: &[usize]) -> Vec<Signal> {
    let states = task.bound.system.states.iter();
    let mut all: Vec<Signal> = states
        .map(|state| Signal {
            name: format!("walk.{}", state.var.name),
            kind: Kind::Text,
            unit: String::new(),
            role: Role::Plant,
        })
        .collect();
    for channel in channels {
        let signals = owner.signals(channel).into_iter().enumerate();
        let told = signals.filter(|(k, s)| s.role == Role::Output || inputs.contains(k));
        all.extend(told.map(|(_, signal)| signal));
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
