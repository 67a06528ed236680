//! Harnesses of the monitors of HEIDENHAIN Functional Safety.

mod groups;
mod interface;
mod machine;
mod service;
mod watching;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 5] = [
    interface::ENTRIES,
    groups::ENTRIES,
    machine::ENTRIES,
    watching::ENTRIES,
    service::ENTRIES,
];
