//! `simulate`: a scenario on the production monitors of all channels, with a simple axis before them.
//!
//! ```text
//! scenario -> inputs of the channels -> monitors -> drive -> axis -> positions of the next cycle
//! ```
//!
//! Everything is an integer; equal files give equal results on every machine. What is simulated is the axis and the
//! encoders; what answers are the monitors of `stillpoint-monitors` as they would be embedded.

mod diagram;
mod file;
mod resolve;
mod run;
mod scenario;
mod summary;

pub use run::run;
pub use scenario::{Condition, DoorChange, Event, Expect, Is, Scenario, Start, What};
pub use summary::{Judged, Simulation, Stop};

use stillpoint_machine::{AxisKind, Machine};

use crate::families;
use crate::recording::{Allowed, Kind, Role, Signal, vocabulary};

/// Signals of the axis itself, with what is told of each cycle.
const OF_AXIS: [(&str, Kind, &str, &str); 4] = [
    (vocabulary::POSITION, Kind::Int, "nm", "udeg"),
    (vocabulary::VELOCITY, Kind::Int, "nm/cycle", "udeg/cycle"),
    (vocabulary::SETPOINT, Kind::Int, "nm/cycle", "udeg/cycle"),
    ("drive", Kind::Text, "", ""),
];

/// Signals of a door: it is open, somebody asks for it, its logic releases it.
const OF_DOOR: [&str; 3] = ["open", "asked", "released"];

/// Every signal that a simulation of this machine records, in the order of its rows.
pub fn signals(machine: &Machine) -> Vec<Signal> {
    let mut all: Vec<Signal> = machine
        .doors
        .iter()
        .flat_map(|door| {
            OF_DOOR.map(|name| Signal {
                name: format!("door.{}.{name}", door.name),
                kind: Kind::Bool,
                unit: String::new(),
                role: Role::Plant,
                allowed: Allowed::All,
            })
        })
        .collect();
    let drive = families::of(machine).ok();
    let owners = drive.map_or_else(Vec::new, |drive| drive.owners(machine));
    let channels = drive.map_or(&[][..], |drive| drive.words().channels);
    for owner in owners {
        if let Some(kind) = owner.axis {
            let rotary = kind == AxisKind::Rotary;
            all.extend(OF_AXIS.iter().map(|(name, kind, linear, turning)| Signal {
                name: format!("{}.{name}", owner.name),
                kind: *kind,
                unit: (if rotary { turning } else { linear }).to_string(),
                role: Role::Plant,
                allowed: Allowed::All,
            }));
        }
        all.extend(channels.iter().flat_map(|channel| owner.signals(channel)));
    }
    all
}
