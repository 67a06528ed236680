//! The monitors of the blocks as peers of their tables.

use crate::diff::peer::Peers;

/// None yet: machine files cannot name the family, and no code is made of its tables.
pub(super) const PEERS: Peers = Peers {
    machines: &[],
    systems: &[],
    fixed: &[],
    slices: &[],
    calm: &[],
    make: |_, _, _| Ok(None),
};
