//! The monitors of HEIDENHAIN Functional Safety as peers of its tables.

mod numbers;
mod safe_plc;
mod same;
mod slices;

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::{Made, Params, Peers};

pub(super) const PEERS: Peers = Peers {
    machines: &[same::MACHINES, safe_plc::MACHINES],
    systems: &[],
    fixed: &[],
    slices: &[slices::SLICES],
    calm: &[],
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    match same::make(machine, params, mutant)? {
        None => safe_plc::make(machine, params, mutant),
        made => Ok(made),
    }
}
