//! The monitors of the SINUMERIK 840D as peers of its tables.

mod apart;
mod channel;
mod numbers;
mod pair;
mod register;
mod same;
mod slices;

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::{Made, Params, Peers};

pub(super) const PEERS: Peers = Peers {
    machines: &[same::MACHINES, apart::MACHINES],
    systems: &[&[
        ("axis_core", "channel"),
        ("pair_stops", "pair"),
        ("pair_reference", "pair"),
    ]],
    // Constants of the monitors (smaller values only keep a system small), and a variant that a system leaves out.
    fixed: &[("compare", "factor", 10), ("axis_core", "one_encoder", 0)],
    slices: &[slices::SLICES],
    calm: slices::CALM,
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    for make in [same::make, apart::make, channel::make, pair::make] {
        if let Some(adapter) = make(machine, params, mutant)? {
            return Ok(Some(adapter));
        }
    }
    Ok(None)
}
