//! The monitors of HEIDENHAIN Functional Safety as peers of its tables.

mod numbers;
mod safe_plc;
mod same;
mod slices;

use crate::diff::peer::Peers;

pub(super) const PEERS: Peers = Peers {
    machines: &[same::MACHINES, safe_plc::MACHINES],
    systems: &[],
    fixed: &[],
    slices: &[slices::SLICES],
    calm: &[],
    make: &[same::make, safe_plc::make],
};
