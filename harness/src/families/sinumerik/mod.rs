//! The SINUMERIK 840D with Safety Integrated: what its production monitors are to a simulation, a recording and a replay.

mod door;
mod peer;
pub mod production;
mod reason;
mod rig;
mod simulated;
mod table;
pub mod vocabulary;

use stillpoint_machine::{Axis as MachineAxis, Machine};
use stillpoint_monitors::sinumerik::alarm::Alarm;

use super::{Drive, Family, Feed, Monitors, Owner, Rig, Said, Start, Windows, Words};
use crate::plant::Axis;
use crate::recording::vocabulary::POSITION;

/// The family.
pub(super) static FAMILY: Family = Family {
    name: "sinumerik-840d",
    module: "sinumerik",
    peers: peer::PEERS,
    mutants: || stillpoint_monitors::sinumerik::mutant::all().collect(),
    drive: Some(&Sinumerik),
};

/// Its whole machines.
struct Sinumerik;

const WORDS: Words = Words {
    channels: &vocabulary::CHANNELS,
    encoders: &vocabulary::CHANNELS,
    telegram: None,
    brakes: None,
    load: None,
    resolution: 1,
    stops: &["NONE", "F", "E", "D", "C", "TEST", "B", "A"],
    stops_listed: &["A", "B", "C", "D", "E", "F", "TEST", "NONE"],
    stop: "STOP ",
    selections: (&["SBH", "SG1", "SG2", "SG3", "SG4"], Some("SBH/SG")),
    of_machine: false,
    limits: (&["SE1", "SE2"], Some("SE")),
    asked: &[
        ("A", Some("external stops")),
        ("C", Some("external stops")),
        ("D", Some("external stops")),
        ("E", Some("STOP E")),
    ],
    stages: &["SG1", "SG2", "SG3", "SG4"],
    position: POSITION,
    told: &["power_on", "run_up", "spl_started"],
    example: "SGE_SS_DISABLE",
    events: &["power_on", "referenced", "set_agreement", "reset"],
    lanes: &[
        "stop",
        "mode",
        "Safety.SLS.SelectionState",
        "Safety.SLP.ActivationState",
        "axis_state",
        "user_agreement",
        "fault",
    ],
    curves: ["SG limit", "SG backwards", "SBH", "SE"],
};

impl Drive for Sinumerik {
    fn words(&self) -> &'static Words {
        &WORDS
    }

    fn accepts(&self, machine: &Machine) -> Result<(), String> {
        production::axes(machine).map(drop)
    }

    fn owners(&self, machine: &Machine) -> Vec<Owner> {
        let owner = |axis: &MachineAxis| {
            let inputs = vocabulary::inputs().iter().map(|i| i.port()).collect();
            let outputs = vocabulary::outputs().iter().map(|o| o.port()).collect();
            Owner::of_axis(axis, inputs, outputs)
        };
        machine.axes.iter().map(owner).collect()
    }

    fn alarms(&self) -> Vec<(String, usize)> {
        let nck = Alarm::ALL.into_iter().map(|alarm| Some(alarm.nck().number));
        let drive = Alarm::ALL
            .into_iter()
            .map(|alarm| alarm.drive().map(|entry| entry.number));
        let named = |side| move |number: u32| (number.to_string(), side);
        let nck = nck.flatten().map(named(0));
        nck.chain(drive.flatten().map(named(1))).collect()
    }

    fn windows(&self, axis: &MachineAxis) -> Windows {
        let cells = |name: &str| axis.values.get(name).map_or(&[][..], |v| &v.cells);
        let pair = |name| {
            let cell = |k: usize| cells(name).get(k).and_then(|v| i32::try_from(*v).ok());
            [cell(0).unwrap_or(0), cell(1).unwrap_or(0)]
        };
        Windows {
            standstill: cells("STANDSTILL_TOL").first().copied().unwrap_or(0),
            plus: pair("POS_LIMIT_PLUS"),
            minus: pair("POS_LIMIT_MINUS"),
            limited: axis.has("SE"),
        }
    }

    fn stage(&self, _machine: &Machine, axis: &MachineAxis, stage: usize) -> Option<i64> {
        axis.values.get("VELO_LIMIT")?.cells.get(stage).copied()
    }

    fn reason(&self, said: &Said<'_>) -> String {
        reason::reason(said)
    }

    fn power<'a>(
        &self,
        machine: &'a Machine,
        axes: &[Axis],
        start: &Start,
    ) -> Result<Box<dyn Monitors + 'a>, String> {
        Ok(Box::new(simulated::Simulated::new(machine, axes, start)?))
    }

    fn play(
        &self,
        machine: &Machine,
        owners: &[usize],
        tables: bool,
        play: &mut dyn FnMut(&mut dyn Rig),
    ) -> Result<(), String> {
        let axis = owners.first().ok_or("no axis is named")?;
        rig::play(machine, *axis, tables, play)
    }

    fn feeds(&self) -> &'static [Feed] {
        &rig::FEEDS
    }
}
