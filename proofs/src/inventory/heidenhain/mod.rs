//! Harnesses of the monitors of HEIDENHAIN Functional Safety.

mod composing;
mod groups;
mod interface;
mod link;
mod machine;
mod program;
mod service;
mod watching;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 8] = [
    interface::ENTRIES,
    groups::ENTRIES,
    machine::ENTRIES,
    watching::ENTRIES,
    service::ENTRIES,
    program::ENTRIES,
    link::ENTRIES,
    composing::ENTRIES,
];
