//! Harnesses of the monitors of the SINUMERIK 840D.

mod base;
mod checking;
mod composing;
mod service;
mod watching;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 5] = [
    base::ENTRIES,
    checking::ENTRIES,
    watching::ENTRIES,
    composing::ENTRIES,
    service::ENTRIES,
];
