//! Harnesses of the monitors of HEIDENHAIN Functional Safety.

mod composing;
mod groups;
mod interface;
mod machine;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 4] = [
    interface::ENTRIES,
    groups::ENTRIES,
    machine::ENTRIES,
    composing::ENTRIES,
];
