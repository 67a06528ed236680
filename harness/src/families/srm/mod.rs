//! Fail-safe blocks for storage and retrieval machines: their monitors, and what a crane with them is to a simulation, a recording and a
//! replay. Each axis has its blocks, which the safety program calls in the order of the machine file: one channel, for the CPU sees to its
//! own faults.

mod blocks;
mod converter;
mod peer;
mod rig;
mod signals;
mod simulated;
mod values;
mod wiring;

use stillpoint_machine::{Axis as MachineAxis, Machine};

use self::blocks::Said as Told;
use super::{Drive, Family, Monitors, Owner, Rig, Said, Start, Windows, Words};
use crate::plant::Axis;

/// The family.
pub(super) static FAMILY: Family = Family {
    name: "srm-fblocks",
    module: "srm",
    peers: peer::PEERS,
    mutants: || stillpoint_monitors::srm::mutant::all().collect(),
    drive: Some(&Crane),
};

/// Its whole machines.
struct Crane;

const WORDS: Words = Words {
    channels: &["cpu"],
    encoders: &["POS1", "POSSI", "POS2"],
    telegram: Some(simulated::POSSI),
    brakes: Some(values::BRAKE_TEST),
    load: Some(values::LOAD),
    resolution: 1_000,
    stops: &signals::STOPS,
    stops_listed: &["STO", "SS1", "NONE"],
    stop: "",
    selections: (&["STATIC", "DYNAMIC"], Some(values::LOAD)),
    of_machine: false,
    limits: (&[], None),
    asked: &[("SS1", None), ("STO", None)],
    stages: &["VMAX_RELEASE"],
    position: signals::POS1,
    told: &[],
    example: "POS1_VALID",
    events: &["REFERENCE", "SYNC", "ACK", "EXECUTE", "CALIBRATE"],
    lanes: &[
        "RELEASE",
        "stop",
        "alarms",
        "POS_VALID",
        signals::REFERENCED,
        "V_VALID",
        "SBR_BUSY",
        "S_STW3B",
        "S_ZSW3B",
        "FDBACK_BR_1",
        "FDBACK_BR_2",
        "LOAD1",
        signals::TEST_OK,
        "SDI_POSITIVE",
        "SDI_NEGATIVE",
    ],
    curves: ["SLS limit", "SLS backwards", "", "range"],
};

impl Drive for Crane {
    fn words(&self) -> &'static Words {
        &WORDS
    }

    /// The blocks take every value; those that they would report are errors of the machine file.
    fn accepts(&self, _machine: &Machine) -> Result<(), String> {
        Ok(())
    }

    fn owners(&self, machine: &Machine) -> Vec<Owner> {
        let owner = |axis: &MachineAxis| {
            let inputs = signals::inputs(axis).into_iter();
            let outputs = signals::outputs(axis, &Told::default(), 1).into_iter();
            let inputs = inputs.map(|input| input.port()).collect();
            Owner::of_axis(axis, inputs, outputs.map(|(port, _)| port).collect())
        };
        machine.axes.iter().map(owner).collect()
    }

    fn alarms(&self) -> Vec<(String, usize)> {
        signals::diags().into_iter().map(|name| (name, 0)).collect()
    }

    fn windows(&self, axis: &MachineAxis) -> Windows {
        let [minus, plus] = values::ends(axis).map(|mm| [mm.saturating_mul(1_000); 2]);
        Windows {
            standstill: 0,
            plus,
            minus,
            limited: axis.has(values::SLP) || axis.has(values::END_ZONE),
        }
    }

    fn stage(&self, _machine: &Machine, axis: &MachineAxis, _stage: usize) -> Option<i64> {
        let name = match axis.has(values::END_ZONE) {
            true => "EZ_VMAX_RELEASE",
            false => "VMAX_RELEASE",
        };
        axis.values.get(name)?.cells.first().copied()
    }

    /// The ramp of the drive, and four fifths of it for the control, which has to stay below the envelope before the ends.
    fn ramps(&self, axis: &MachineAxis) -> Option<[String; 2]> {
        let known = axis.has(values::RAMP).then(|| values::ramp_rate(axis))?;
        let text = |rate: i64| format!("{}.{:03} mm/s2", rate / 1_000, rate % 1_000);
        known.map(|rate| [text(rate * 4 / 5), text(rate)])
    }

    fn reason(&self, said: &Said<'_>) -> String {
        said.text(signals::CAUSE)
    }

    fn power<'a>(
        &self,
        machine: &'a Machine,
        axes: &[Axis],
        start: &Start,
    ) -> Result<Box<dyn Monitors + 'a>, String> {
        Ok(Box::new(simulated::Simulated::new(machine, axes, start)))
    }

    fn play(
        &self,
        machine: &Machine,
        owners: &[usize],
        _tables: bool,
        play: &mut dyn FnMut(&mut dyn Rig),
    ) -> Result<(), String> {
        rig::play(machine, *owners.first().ok_or("no axis is named")?, play);
        Ok(())
    }
}
