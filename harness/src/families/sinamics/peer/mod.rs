//! The monitors as peers of their tables: those of the functions, those of the control part.

mod control;
mod functions;

use crate::diff::peer::Peers;

pub(super) const PEERS: Peers = Peers {
    machines: &[
        functions::SAME,
        functions::APART,
        control::SAME,
        control::APART,
        control::TELEGRAMS,
    ],
    systems: &[functions::SYSTEMS, control::SYSTEMS],
    // Constants of the monitors; smaller values only keep a system small. Without SBC the switches are no business of the monitor.
    fixed: &[
        ("sls", "full", 32_767),
        ("sp", "x_top", 32_767),
        ("cycle_count", "top", 32_767),
        ("sbc", "enabled", 1),
    ],
    slices: &[functions::SLICES, control::SLICES],
    // What a brake test waits for.
    calm: &[("allowed", 1), ("slow", 1), ("known", 1)],
    make: &[functions::make, control::make],
};
