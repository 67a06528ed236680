//! The monitors of HEIDENHAIN Functional Safety as peers of its tables.

mod numbers;
mod safe_plc;
mod same;

use stillpoint_monitors::mutant::Mutant;

use super::{Family, Made, Params};

pub(super) static FAMILY: Family = Family {
    name: "heidenhain-fs",
    module: "heidenhain",
    machines: &[same::MACHINES, safe_plc::MACHINES],
    systems: &[],
    fixed: &[],
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    match same::make(machine, params, mutant)? {
        None => safe_plc::make(machine, params, mutant),
        made => Ok(made),
    }
}
