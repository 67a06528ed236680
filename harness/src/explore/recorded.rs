//! A walk as a recording for `diff --trace`: what it gives to the input signals of an axis, on the production monitors of both
//! channels with the values of the machine, and beside it the state of the walk.
//!
//! A walk goes through a system that is smaller than the machine: other times, few positions, requests of monitors as free
//! inputs. The recording therefore does not tell what the tables said along the walk as if it were the machine's, but what
//! the monitors say to the same signals. Each cycle of the walk is one monitoring cycle.

use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Pair};
use stillpoint_spec::eval::UNSET;
use stillpoint_spec::machine::{AxisKind, Machine};

use super::walk::Walk;
use crate::production;
use crate::recording::{Kind, Recording, Role, Signal, Value, vocabulary};
use crate::subject::Task;

/// The inputs of the tables that are signals of a channel, with these signals, the lowest bit first.
const KNOWN: [(&str, &[&str]); 21] = [
    ("power_on", &["power_on"]),
    ("reset", &["reset"]),
    ("run_up", &["run_up"]),
    ("spl_started", &["spl_started"]),
    ("spl_error", &["spl_error"]),
    ("a", &["SGE_EXT_STOP_A"]),
    ("c", &["SGE_EXT_STOP_C"]),
    ("d", &["SGE_EXT_STOP_D"]),
    ("e", &["SGE_EXT_STOP_E"]),
    ("sge_a", &["SGE_EXT_STOP_A"]),
    ("sge_c", &["SGE_EXT_STOP_C"]),
    ("sge_d", &["SGE_EXT_STOP_D"]),
    ("sge_e", &["SGE_EXT_STOP_E"]),
    ("sge_sbh_sg", &["SGE_SVSS_DISABLE"]),
    ("sge_sbh", &["SGE_SS_DISABLE"]),
    ("sg_select", &["SGE_VELO_SELECT_0", "SGE_VELO_SELECT_1"]),
    (
        "over",
        &["SGE_OVR_0", "SGE_OVR_1", "SGE_OVR_2", "SGE_OVR_3"],
    ),
    ("se_select", &["SGE_POS_SELECT"]),
    ("test_select", &["SGE_STOP_REQUEST"]),
    ("test.select", &["SGE_STOP_REQUEST"]),
    ("feedback", &["pulses_cancelled"]),
];

/// Signals that every recording tells.
const ALWAYS: [&str; 4] = ["power_on", "run_up", "spl_started", vocabulary::POSITION];

/// An input of the system and what it is to the channels.
struct Fed {
    input: usize,
    /// In which channels: NCK, drive.
    sides: [bool; 2],
    signals: &'static [&'static str],
}

/// What the inputs of a system are to the channels of an axis; empty where none is a signal.
fn feeds(task: &Task) -> Vec<Fed> {
    let inputs = task.bound.system.inputs.iter().enumerate();
    let feeds = inputs.filter_map(|(input, var)| {
        let name = var.name.replace("[1]", "").replace("[2]", "");
        let short = name.rsplit('.').next().unwrap_or(&name);
        let known = KNOWN
            .iter()
            .find(|(known, _)| *known == name || *known == short);
        let (_, signals) = known?;
        Some(Fed {
            input,
            sides: [!var.name.contains("[2]"), !var.name.contains("[1]")],
            signals,
        })
    });
    feeds.collect()
}

/// Whether a walk through a system can be recorded: some of its inputs are signals that a user sets.
pub fn recordable(machine: Option<&Machine>, task: &Task) -> bool {
    let sets = |fed: &Fed| fed.signals[0].starts_with("SGE_");
    machine.is_some_and(|m| m.family == production::FAMILY)
        && !task.axes.is_empty()
        && feeds(task).iter().any(sets)
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
    let produced = production::axes(machine)?;
    let axis = task.axes.first().map_or("", String::as_str);
    let Some(place) = machine.axes.iter().position(|a| a.name == axis) else {
        return Err(format!("the machine has no axis {axis}"));
    };
    let feeds = feeds(task);
    let told = |input: &vocabulary::Input| {
        ALWAYS.contains(&input.name) || feeds.iter().any(|fed| fed.signals.contains(&input.name))
    };
    let inputs: Vec<vocabulary::Input> = vocabulary::inputs().into_iter().filter(told).collect();
    let outputs = vocabulary::outputs();
    let mut recording = Recording {
        machine: machine.name.clone(),
        cycle_us: u64::try_from(machine.monitoring_cycle).unwrap_or(1).max(1),
        first: 0,
        signals: signals(machine, place, task, (&inputs, &outputs)),
        rows: Vec::new(),
    };
    let mut pair = Pair::new(Config::new(produced[place].configuration));
    let rest = Local {
        run_up: true,
        spl_started: true,
        sge: Sge::UNUSED,
        ..Local::default()
    };
    let mut seen = Inputs::both(rest);
    for (row, cycle) in walk.cycles.iter().enumerate() {
        for local in [&mut seen.nck, &mut seen.drive] {
            local.reset = false;
            // Every recording begins with power-on.
            local.power_on = row == 0;
        }
        for fed in &feeds {
            let value = cycle.frame.inputs.get(fed.input).copied();
            let Some(value) = value.filter(|v| *v != UNSET) else {
                continue;
            };
            for (side, local) in [&mut seen.nck, &mut seen.drive].into_iter().enumerate() {
                for (bit, name) in fed.signals.iter().enumerate() {
                    let on = value >> bit & 1 == 1 || (row == 0 && *name == "power_on");
                    let input = inputs.iter().find(|i| i.name == *name && fed.sides[side]);
                    // All of them are flags.
                    let _ = input.is_none_or(|i| i.set(local, &Value::Bool(on)));
                }
            }
        }
        let said = pair.step(&seen);
        let mut values: Vec<Option<Value>> = walked(task, walk, row);
        for (side, local, out) in [(0, &seen.nck, &said.nck), (1, &seen.drive, &said.drive)] {
            values.extend(inputs.iter().map(|input| Some(input.get(local))));
            values.extend(told_by(&outputs, side, local, out));
        }
        recording.rows.push(values);
    }
    Ok(recording)
}

fn told_by<'a>(
    outputs: &'a [vocabulary::Output],
    side: usize,
    local: &'a Local,
    said: &'a axis::Outputs,
) -> impl Iterator<Item = Option<Value>> + 'a {
    outputs
        .iter()
        .map(move |output| Some(output.get(side, local, said)))
}

/// The signals: the state of the walk, then of each channel what it sees and says.
fn signals(
    machine: &Machine,
    place: usize,
    task: &Task,
    (inputs, outputs): (&[vocabulary::Input], &[vocabulary::Output]),
) -> Vec<Signal> {
    let states = task.bound.system.states.iter();
    let mut all: Vec<Signal> = states
        .map(|state| Signal {
            name: format!("walk.{}", state.var.name),
            kind: Kind::Text,
            unit: String::new(),
            role: Role::Plant,
        })
        .collect();
    let axis = &machine.axes[place];
    let rotary = axis.kind == AxisKind::Rotary;
    for channel in vocabulary::CHANNELS {
        let signal = |name: &str, kind, unit: vocabulary::Unit, role| Signal {
            name: format!("{}.{channel}.{name}", axis.name),
            kind,
            unit: unit.text(rotary).to_owned(),
            role,
        };
        all.extend(
            inputs
                .iter()
                .map(|i| signal(i.name, i.kind, i.unit, Role::Input)),
        );
        all.extend(
            outputs
                .iter()
                .map(|o| signal(o.name, o.kind, o.unit, Role::Output)),
        );
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
