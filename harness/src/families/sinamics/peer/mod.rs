//! The monitors as peers of their tables: those of the functions, those of the control part.

mod apart;
mod control;
mod functions;
mod slices;

use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::{Made, Params, Peers};

pub(super) const PEERS: Peers = Peers {
    machines: &[functions::MACHINES, apart::MACHINES, control::MACHINES],
    systems: &[apart::SYSTEM],
    // Constants of the monitors; smaller values only keep a system small. Without SBC the switches are no business of the monitor.
    fixed: &[
        ("sls", "full", 32_767),
        ("sp", "x_top", 32_767),
        ("sbc", "enabled", 1),
    ],
    slices: slices::SLICES,
    calm: slices::CALM,
    make,
};

fn make(machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    for make in [functions::make, apart::make, control::make] {
        if let Some(adapter) = make(machine, params, mutant)? {
            return Ok(Some(adapter));
        }
    }
    Ok(None)
}
