//! The monitors of the blocks as peers of their tables.

use crate::diff::peer::Peers;

/// None yet: the blocks have their contracts before their tables.
pub(super) const PEERS: Peers = Peers {
    machines: &[],
    systems: &[],
    fixed: &[],
    slices: &[],
    calm: &[],
    make: |_, _, _| Ok(None),
};
