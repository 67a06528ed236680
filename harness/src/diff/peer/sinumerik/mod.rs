//! The monitors of the SINUMERIK 840D as peers of its tables.

mod axis;
mod cells;
mod channel;
mod checking;
mod monitoring;
mod numbers;
mod pair;
mod register;
mod stops;

use stillpoint_monitors::mutant::Mutant;

use super::{Family, Made, Params};

pub(super) static FAMILY: Family = Family {
    name: "sinumerik-840d",
    module: "sinumerik",
    machines: &[
        ("external", "external"),
        ("fault", "fault"),
        ("stop", "stop"),
        ("group", "group"),
        ("selection", "selection"),
        ("reference", "reference"),
        ("agreement", "agreement"),
        ("gear", "gear"),
        ("motion", "motion"),
        ("standstill", "standstill"),
        ("speed", "speed"),
        ("end_stop", "limit_switch"),
        ("ramp", "ramp"),
        ("threshold", "threshold"),
        ("cam", "cam"),
        ("results", "results"),
        ("test", "test_stop"),
        ("shutdown_test", "shutdown_test"),
        ("pulses", "pulses"),
        ("compare", "compare"),
        ("slip", "slip"),
        ("history", "history"),
        ("test_interval", "forced_check"),
    ],
    systems: &[
        ("axis_core", "channel"),
        ("pair_stops", "pair"),
        ("pair_reference", "pair"),
    ],
    // Constants of the monitors (smaller values only keep a system small), and a variant that a system leaves out.
    fixed: &[("compare", "factor", 10), ("axis_core", "one_encoder", 0)],
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    for make in [
        stops::make,
        axis::make,
        monitoring::make,
        checking::make,
        channel::make,
        pair::make,
    ] {
        if let Some(adapter) = make(machine, params, mutant)? {
            return Ok(Some(adapter));
        }
    }
    Ok(None)
}
