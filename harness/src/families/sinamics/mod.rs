//! SINAMICS S120: its monitors.

mod peer;

use super::Family;

/// The family.
pub(super) static FAMILY: Family = Family {
    name: "sinamics-s120",
    module: "sinamics",
    peers: peer::PEERS,
    mutants: || stillpoint_monitors::sinamics::mutant::all().collect(),
    drive: None,
};
