//! Harnesses of SINAMICS S120.

mod braking;
mod control;
mod encoder;
mod limits;
mod stops;
mod telegram;
mod testing;

/// The lists of this family.
#[cfg(not(kani))]
pub(super) static ENTRIES: [&[super::Entry]; 7] = [
    stops::ENTRIES,
    braking::ENTRIES,
    limits::ENTRIES,
    encoder::ENTRIES,
    testing::ENTRIES,
    control::ENTRIES,
    telegram::ENTRIES,
];
