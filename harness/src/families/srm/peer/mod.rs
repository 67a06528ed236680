//! The monitors of the blocks as peers of their tables.

mod arithmetic;
mod brake;
mod first_call;
mod position;
mod same;
mod slices;

use crate::diff::peer::Peers;

pub(super) const PEERS: Peers = Peers {
    machines: &[
        same::MACHINES,
        position::MACHINES,
        brake::MACHINES,
        arithmetic::MACHINES,
        first_call::MACHINES,
    ],
    systems: &[&[brake::SYSTEM, position::SYSTEM]],
    // Constants of the monitors: the width of a DInt and of a counter, full load, um in a mm. Smaller values only keep a system small.
    fixed: &[
        ("arithmetic", "low", -2_147_483_647),
        ("arithmetic", "high", 2_147_483_647),
        ("load", "full", 10_000),
        ("position", "um", 1_000),
        ("safe_pos_block", "um", 1_000),
        ("safe_pos_block", "counts", 65_536),
        ("safe_pos_block", "v_top", 2_147_483_647),
    ],
    slices: &[slices::SLICES],
    calm: slices::CALM,
    make: &[
        same::make,
        position::make,
        brake::make,
        arithmetic::make,
        first_call::make,
    ],
};
