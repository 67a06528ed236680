//! Harnesses of the functions of IEC 61800-5-2.

mod places;
mod values;

/// The lists of this family.
#[cfg(not(kani))]
pub(super) static ENTRIES: [&[super::Entry]; 2] = [values::ENTRIES, places::ENTRIES];
