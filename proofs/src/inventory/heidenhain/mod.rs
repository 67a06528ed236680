//! Harnesses of the monitors of HEIDENHAIN Functional Safety.

mod interface;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 1] = [interface::ENTRIES];
