//! Harnesses of SINAMICS S120.

mod control;
mod telegram;

/// The lists of this family.
pub(super) static ENTRIES: [&[super::Entry]; 2] = [control::ENTRIES, telegram::ENTRIES];
