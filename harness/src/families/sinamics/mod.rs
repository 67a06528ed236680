//! SINAMICS S120: its monitors, and what a machine with them is to a simulation, a recording and a replay. Each axis is a drive in two channels;
//! what they do together is said by its F-CPU.

/// A monitor in a state; that of POWER ON where it does not fit the parameters, which does not come about.
macro_rules! resumed {
    ($module:ident, $config:expr, $state:expr) => {
        $module::Monitor::resume($config, $state).unwrap_or($module::Monitor::new($config))
    };
}

mod bare;
mod basic;
mod channel;
mod functions;
mod link;
mod messages;
pub mod on_bus;
mod outputs;
mod peer;
mod rig;
mod said;
mod service;
mod signals;
mod simulated;
mod values;

use stillpoint_machine::{Axis as MachineAxis, Machine};

use self::said::Said as Told;
use super::values::{cell, nearest};
use super::{Drive, Family, Monitors, Owner, Rig, Said, Start, Windows, Words};
use crate::plant::Axis;

/// The family.
pub(super) static FAMILY: Family = Family {
    name: "sinamics-s120",
    module: "sinamics",
    peers: peer::PEERS,
    mutants: || stillpoint_monitors::sinamics::mutant::all().collect(),
    drive: Some(&Sinamics),
};

/// Its whole machines.
struct Sinamics;

const CHANNELS: [&str; 2] = ["ch1", "ch2"];

const WORDS: Words = Words {
    channels: &CHANNELS,
    encoders: &CHANNELS,
    telegram: None,
    brakes: Some(values::SBC),
    load: None,
    resolution: 1,
    stops: &outputs::STOPS,
    stops_listed: &["A", "B", "C", "D", "E", "F", "LOCKED", "NONE"],
    stop: "STOP ",
    selections: (&simulated::SELECTIONS, Some(values::MOTION)),
    of_machine: false,
    limits: (&["SLP1", "SLP2", "none"], Some(values::SLP)),
    asked: &[("STO", None), ("SS1", None), ("SS2", Some(values::MOTION))],
    stages: &["SLS1", "SLS2", "SLS3", "SLS4"],
    position: signals::PLACE,
    told: &[],
    example: "SLS",
    events: &["power_on"],
    lanes: &[
        "terminal",
        "telegram",
        "function",
        "stop",
        "alarms",
        "STO_active",
        "Safety.SOS.ActivationState",
        "Safety.SLS.ActivationState",
        "SDI_positive_active",
        "SDI_negative_active",
        "SLP_active",
        "safely_referenced",
        "gear_tolerance_active",
        "test_stop_active",
        "SBT_active",
        "SBT_torque",
        "internal_STO",
        "start_window",
        "encoder_fault",
        "ESR",
        "internal_event",
        outputs::TORQUE,
        "brake_open",
    ],
    curves: ["SLS limit", "SLS backwards", "SOS", "SLP"],
};

impl Drive for Sinamics {
    fn words(&self) -> &'static Words {
        &WORDS
    }

    fn accepts(&self, machine: &Machine) -> Result<(), String> {
        values::axes(machine).map(drop)
    }

    fn owners(&self, machine: &Machine) -> Vec<Owner> {
        let owner = |axis: &MachineAxis| {
            let inputs = signals::inputs(axis).into_iter();
            let outputs = outputs::outputs(axis, 0, &Told::default()).into_iter();
            let inputs = inputs.map(|input| input.port()).collect();
            Owner::of_axis(axis, inputs, outputs.map(|(port, _)| port).collect())
        };
        machine.axes.iter().map(owner).collect()
    }

    fn alarms(&self) -> Vec<(String, usize)> {
        messages::numbers()
    }

    fn windows(&self, axis: &MachineAxis) -> Windows {
        let end = |name, k| nearest(cell(&axis.values, name, k));
        Windows {
            standstill: cell(&axis.values, "p9530", 0),
            plus: [0, 1].map(|k| end("p9534", k)),
            minus: [0, 1].map(|k| end("p9535", k)),
            limited: axis.has(values::SLP),
        }
    }

    fn stage(&self, _machine: &Machine, axis: &MachineAxis, stage: usize) -> Option<i64> {
        values::extended(axis).then(|| cell(&axis.values, "p9531", stage))
    }

    /// OFF3 brakes from the fastest limit in p1135, and the control accelerates as fast.
    fn ramps(&self, axis: &MachineAxis) -> Option<[String; 2]> {
        let time = cell(&axis.values, "p1135", 0);
        if time <= 0 || !values::extended(axis) {
            return None;
        }
        // Base units per minute by us: um/s2 or mdeg/s2.
        let rate = i128::from(values::fastest(axis)) * 1_000_000 / 60 / i128::from(time);
        let unit = match axis.kind {
            stillpoint_machine::AxisKind::Linear => "mm/s2",
            stillpoint_machine::AxisKind::Rotary => "deg/s2",
        };
        let text = format!("{}.{:03} {unit}", rate / 1_000, rate % 1_000);
        (rate > 0).then(|| [text.clone(), text])
    }

    fn reason(&self, said: &Said<'_>) -> String {
        said.text(outputs::CAUSE)
    }

    fn power<'a>(
        &self,
        machine: &'a Machine,
        _axes: &[Axis],
        start: &Start,
    ) -> Result<Box<dyn Monitors + 'a>, String> {
        Ok(Box::new(simulated::Simulated::new(machine, start)?))
    }

    fn play(
        &self,
        machine: &Machine,
        owners: &[usize],
        _tables: bool,
        play: &mut dyn FnMut(&mut dyn Rig),
    ) -> Result<(), String> {
        rig::play(machine, *owners.first().ok_or("no axis is named")?, play)
    }
}
