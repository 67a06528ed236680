//! Harnesses of the monitors of the SINUMERIK 840D.

mod base;
mod checking;
mod composing;
mod profisafe;
mod service;
mod spl;
mod watching;

/// The lists of this family.
#[cfg(not(kani))]
pub(super) static ENTRIES: [&[super::Entry]; 7] = [
    base::ENTRIES,
    checking::ENTRIES,
    spl::ENTRIES,
    watching::ENTRIES,
    composing::ENTRIES,
    profisafe::ENTRIES,
    service::ENTRIES,
];
