//! Harnesses of the monitors of HEIDENHAIN Functional Safety.

mod composing;
mod groups;
mod interface;
mod link;
mod machine;
mod safe_plc;
mod service;
mod watching;

/// The lists of this family.
#[cfg(not(kani))]
pub(super) static ENTRIES: [&[super::Entry]; 8] = [
    interface::ENTRIES,
    groups::ENTRIES,
    machine::ENTRIES,
    watching::ENTRIES,
    service::ENTRIES,
    link::ENTRIES,
    composing::ENTRIES,
    safe_plc::ENTRIES,
];
