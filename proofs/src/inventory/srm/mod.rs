//! Harnesses of the fail-safe blocks for storage and retrieval machines.

mod brakes;
mod braking;
mod encoders;
mod functions;
mod load;
mod range;

/// The lists of this family.
#[cfg(not(kani))]
pub(super) static ENTRIES: [&[super::Entry]; 6] = [
    functions::ENTRIES,
    encoders::ENTRIES,
    range::ENTRIES,
    braking::ENTRIES,
    brakes::ENTRIES,
    load::ENTRIES,
];
