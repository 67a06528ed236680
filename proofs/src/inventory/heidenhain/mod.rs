//! Harnesses of the monitors of HEIDENHAIN Functional Safety.

mod composing;
mod groups;
mod interface;
mod machine;
mod service;
mod watching;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 6] = [
    interface::ENTRIES,
    groups::ENTRIES,
    machine::ENTRIES,
    watching::ENTRIES,
    service::ENTRIES,
    composing::ENTRIES,
];
