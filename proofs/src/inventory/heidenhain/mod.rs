//! Harnesses of the monitors of HEIDENHAIN Functional Safety.

mod interface;
mod service;
mod watching;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 3] =
    [interface::ENTRIES, watching::ENTRIES, service::ENTRIES];
