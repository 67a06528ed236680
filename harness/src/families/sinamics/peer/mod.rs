//! The monitors as peers of their tables: those of the functions, those of the control part.

mod control;
mod functions;

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::{Made, Params, Peers};

pub(super) const PEERS: Peers = Peers {
    machines: &[
        functions::MACHINES,
        control::SAME,
        control::APART,
        control::TELEGRAMS,
    ],
    systems: control::SYSTEMS,
    // The cycle count of the telegrams has 16 bits: a smaller one only keeps a system small.
    fixed: &[("cycle_count", "top", 32_767)],
    slices: control::SLICES,
    calm: &[],
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    match functions::make(machine, params, mutant)? {
        None => control::make(machine, params, mutant),
        made => Ok(made),
    }
}
