//! HEIDENHAIN Functional Safety: what its production monitors are to a simulation, a recording and a replay. A machine of groups and axes runs as a
//! whole: each channel has the safe PLC program, a kernel for every group and the monitors of every axis.

mod axis;
mod channel;
mod names;
mod peer;
mod program;
mod read;
mod rig;
mod simulated;
mod values;

use stillpoint_machine::{Axis as MachineAxis, Machine};

use super::{Drive, Family, Feed, Monitors, Owner, Rig, Said, Start, Windows, Words};
use crate::plant::Axis;

/// The family.
pub(super) static FAMILY: Family = Family {
    name: "heidenhain-fs",
    module: "heidenhain",
    peers: peer::PEERS,
    mutants: || stillpoint_monitors::heidenhain::mutant::all().collect(),
    drive: Some(&Heidenhain),
};

/// Its whole machines.
struct Heidenhain;

/// What has the signals of the whole machine.
const MACHINE: &str = "machine";

const WORDS: Words = Words {
    channels: &["mc", "cc"],
    encoders: &["mc", "cc"],
    telegram: None,
    brakes: None,
    load: None,
    resolution: 1,
    stops: &["NONE", "SS2", "SS1D", "SS1", "SS1F", "SS0"],
    stops_listed: &["SS0", "SS1F", "SS1", "SS1D", "SS2", "NONE"],
    stop: "",
    selections: (&names::SOMS, None),
    of_machine: true,
    limits: (&[], None),
    asked: &[("SS2", None), ("SS1D", None), ("SS1", None), ("SS1F", None)],
    stages: &["SOM_2", "SOM_3", "SOM_4"],
    position: names::SEEN,
    told: &[],
    example: "SD",
    events: &[],
    lanes: &[
        "stop",
        "stop_phase",
        "NN_AxGrpState",
        "axis_release",
        "axis_state",
        "BRK_REL",
        "STO",
    ],
    curves: ["SLS limit", "SLS backwards", "SOS", "SLP"],
};

impl Drive for Heidenhain {
    fn words(&self) -> &'static Words {
        &WORDS
    }

    fn accepts(&self, machine: &Machine) -> Result<(), String> {
        for axis in &machine.axes {
            let _ = values::axis(machine, axis)?;
        }
        for group in &machine.axis_groups {
            let _ = values::group(machine, group)?;
        }
        values::outputs(machine).map(drop)
    }

    fn owners(&self, machine: &Machine) -> Vec<Owner> {
        let axis = |axis: &MachineAxis| {
            let (inputs, outputs) = (names::AXIS_INPUTS.to_vec(), names::AXIS_OUTPUTS.to_vec());
            Owner::of_axis(axis, inputs, outputs)
        };
        let whole = Owner {
            name: MACHINE.to_owned(),
            axis: None,
            inputs: names::machine_inputs(),
            outputs: names::MACHINE_OUTPUTS.to_vec(),
        };
        machine.axes.iter().map(axis).chain([whole]).collect()
    }

    fn alarms(&self) -> Vec<(String, usize)> {
        Vec::new()
    }

    fn windows(&self, axis: &MachineAxis) -> Windows {
        let cell = |name: &str| axis.values.get(name).and_then(|v| v.cells.first().copied());
        let end = |name| cell(name).and_then(|v| i32::try_from(v).ok()).unwrap_or(0);
        Windows {
            standstill: cell("SMP545").unwrap_or(0),
            plus: [end("SMP650"); 2],
            minus: [end("SMP670"); 2],
            limited: !axis.spindle && cell("MP100") == Some(0),
        }
    }

    fn stage(&self, machine: &Machine, axis: &MachineAxis, stage: usize) -> Option<i64> {
        let names = match axis.spindle {
            true => ["SMP591", "SMP541", "SMP551"],
            false => ["SMP590", "SMP540", "SMP552"],
        };
        let name = names.get(stage)?;
        let value = axis.values.get(*name).or(machine.control.get(*name))?;
        value.cells.first().copied()
    }

    fn reason(&self, said: &Said<'_>) -> String {
        said.text("cause")
    }

    fn power<'a>(
        &self,
        machine: &'a Machine,
        axes: &[Axis],
        start: &Start,
    ) -> Result<Box<dyn Monitors + 'a>, String> {
        Ok(Box::new(simulated::Simulated::new(machine, axes, start)?))
    }

    /// The axes run as groups of a whole machine.
    fn together(&self, machine: &Machine) -> Vec<Vec<usize>> {
        vec![(0..=machine.axes.len()).collect()]
    }

    fn play(
        &self,
        machine: &Machine,
        _owners: &[usize],
        _tables: bool,
        play: &mut dyn FnMut(&mut dyn Rig),
    ) -> Result<(), String> {
        rig::play(machine, play)
    }

    fn feeds(&self) -> &'static [Feed] {
        &rig::FEEDS
    }
}
