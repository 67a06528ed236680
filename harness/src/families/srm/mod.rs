//! Fail-safe blocks for storage and retrieval machines: their monitors.

mod peer;

use super::Family;

/// The family.
pub(super) static FAMILY: Family = Family {
    name: "srm-fblocks",
    module: "srm",
    peers: peer::PEERS,
    mutants: || stillpoint_monitors::srm::mutant::all().collect(),
    drive: None,
};
