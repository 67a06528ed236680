//! Functions of IEC 61800-5-2: their monitors.

mod peer;

use super::Family;

/// The family.
pub(super) static FAMILY: Family = Family {
    name: "iec-61800-5-2",
    module: "iec",
    peers: peer::PEERS,
    mutants: || stillpoint_monitors::iec::mutant::all().collect(),
    drive: None,
};
