//! The monitors of the SINUMERIK 840D as peers of its tables.

mod apart;
mod channel;
mod numbers;
mod pair;
mod register;
mod same;
mod slices;

use crate::diff::peer::Peers;

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
    make: &[same::make, apart::make, channel::make, pair::make],
};
