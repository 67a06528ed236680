//! Harnesses of SINAMICS S120.

mod braking;
mod encoder;
mod limits;
mod stops;
mod testing;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 5] = [
    stops::ENTRIES,
    braking::ENTRIES,
    limits::ENTRIES,
    encoder::ENTRIES,
    testing::ENTRIES,
];
