//! One axis alone, driven by its signals: the pair of both channels, with the tables of each beside it.

use stillpoint_machine::Machine;
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::axis::{self, Local};
use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::pair::{Config, Inputs, Outputs, Pair, State};

use super::production;
use super::table::{Basis, Tables};
use super::vocabulary::{self, Input, Output};
use crate::families::{Coding, Feed, Rig};
use crate::recording::Value;

/// The inputs of the tables that are signals of a channel.
pub(super) static FEEDS: [Feed; 21] = [
    pulse("power_on", &["power_on"]),
    pulse("reset", &["reset"]),
    state("run_up", &["run_up"]),
    state("spl_started", &["spl_started"]),
    state("spl_error", &["spl_error"]),
    user("a", &["SGE_EXT_STOP_A"]),
    user("c", &["SGE_EXT_STOP_C"]),
    user("d", &["SGE_EXT_STOP_D"]),
    user("e", &["SGE_EXT_STOP_E"]),
    user("sge_a", &["SGE_EXT_STOP_A"]),
    user("sge_c", &["SGE_EXT_STOP_C"]),
    user("sge_d", &["SGE_EXT_STOP_D"]),
    user("sge_e", &["SGE_EXT_STOP_E"]),
    user("sge_sbh_sg", &["SGE_SVSS_DISABLE"]),
    user("sge_sbh", &["SGE_SS_DISABLE"]),
    user("sg_select", &["SGE_VELO_SELECT_0", "SGE_VELO_SELECT_1"]),
    user(
        "over",
        &["SGE_OVR_0", "SGE_OVR_1", "SGE_OVR_2", "SGE_OVR_3"],
    ),
    user("se_select", &["SGE_POS_SELECT"]),
    user("test_select", &["SGE_STOP_REQUEST"]),
    user("test.select", &["SGE_STOP_REQUEST"]),
    state("feedback", &["pulses_cancelled"]),
];

const fn state(table: &'static str, signals: &'static [&'static str]) -> Feed {
    Feed {
        table,
        signals,
        user: false,
        pulse: false,
        wired: false,
        coding: Coding::Bits,
    }
}

const fn pulse(table: &'static str, signals: &'static [&'static str]) -> Feed {
    Feed {
        pulse: true,
        ..state(table, signals)
    }
}

const fn user(table: &'static str, signals: &'static [&'static str]) -> Feed {
    Feed {
        user: true,
        ..state(table, signals)
    }
}

/// Drives the monitors of an axis.
pub(super) fn play(
    machine: &Machine,
    axis: usize,
    tables: bool,
    play: &mut dyn FnMut(&mut dyn Rig),
) -> Result<(), String> {
    let all = production::axes(machine)?;
    let produced = all.get(axis).ok_or("the machine has no such axis")?;
    let basis = match tables {
        true => Basis::new(machine, axis, produced)?,
        false => None,
    };
    let config = Config::new(produced.configuration);
    let mut bench = Bench {
        axis,
        config,
        pair: Pair::new(config),
        inputs: Inputs::default(),
        said: Outputs::default(),
        tables: Tables::new(basis.as_ref(), produced)?,
        known: vocabulary::inputs(),
        written: vocabulary::outputs(),
    };
    play(&mut bench);
    Ok(())
}

struct Bench<'a> {
    axis: usize,
    config: Config,
    pair: Pair,
    inputs: Inputs,
    said: Outputs,
    tables: Tables<'a>,
    known: Vec<Input>,
    written: Vec<Output>,
}

impl Rig for Bench<'_> {
    fn rest(&mut self, first: bool) {
        self.inputs = Inputs::both(Local {
            power_on: first,
            run_up: true,
            spl_started: true,
            sge: Sge::UNUSED,
            ..Local::default()
        });
    }

    fn set(&mut self, _owner: usize, side: usize, input: usize, value: &Value) -> bool {
        let local = match side {
            0 => &mut self.inputs.nck,
            _ => &mut self.inputs.drive,
        };
        self.known[input].set(local, value)
    }

    fn get(&self, _owner: usize, side: usize, input: usize) -> Value {
        self.known[input].get(side_of(&self.inputs, &self.said, side).0)
    }

    fn resume(&mut self, said: &dyn Fn(usize, usize, &str) -> Option<Value>) {
        let channel = |side: usize| {
            let agreed = said(self.axis, side, "user_agreement") == Some(Value::Bool(true));
            let Position(at) = side_of(&self.inputs, &self.said, side).0.position;
            axis::State::restored(agreed, agreed.then_some(Position(at)))
        };
        // The state is made here, and consistent; an initial one would be, too.
        let kept = State::restored(channel(0), channel(1));
        self.pair = Pair::resume(self.config, kept).unwrap_or_else(|_| Pair::new(self.config));
    }

    fn step(&mut self) {
        let before = *self.pair.state();
        self.said = self.pair.step(&self.inputs);
        self.tables
            .step(&before, self.pair.state(), &self.inputs, &self.said);
    }

    fn output(&self, _owner: usize, side: usize, output: usize) -> Value {
        let (local, own) = side_of(&self.inputs, &self.said, side);
        self.written[output].get(side, local, own)
    }

    fn specified(&self, _owner: usize, side: usize, output: usize) -> Option<Value> {
        self.tables.output(side, self.written[output].name)
    }

    fn table_cycles(&self) -> u64 {
        self.tables.cycles()
    }
}

/// What a channel sees and says.
pub(super) fn side_of<'a>(
    inputs: &'a Inputs,
    outputs: &'a Outputs,
    side: usize,
) -> (&'a Local, &'a axis::Outputs) {
    match side {
        0 => (&inputs.nck, &outputs.nck),
        _ => (&inputs.drive, &outputs.drive),
    }
}
