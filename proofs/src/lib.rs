//! Proof harnesses of the monitors: one source for enumeration, property tests and Kani.
//!
//! A property is a plain function over a [`source::Source`] of nondeterministic values and the step functions under test.
//! Three engines run it:
//!
//! * [`enumeration`]: every choice the source can make, one after the other. Domains are finite and the cases are counted,
//!   so a pass is a proof for that domain;
//! * sampling ([`sampling`], driven by proptest in the tests): random choices over the full width, with shrinking. A test,
//!   never a proof;
//! * Kani (`cargo kani`, in the folder of the workspace or in this one): every choice over the full width, symbolically. The
//!   binary `kani` runs it and keeps the answers in `kani.toml` ([`results`]).
//!
//! Every harness has covers: situations that must be met, or the harness proves nothing. [`inventory`] lists the harnesses;
//! the macro that lists one also makes its Kani harness, so that list and harnesses cannot drift apart. The binary
//! `inventory` runs the enumerations and writes the page `docs/src/proofs.md`.

#![cfg_attr(
    kani,
    allow(
        unexpected_cfgs,
        dead_code,
        unused_imports,
        unused_macros,
        reason = "the harnesses that are chosen, by their names; what lists and enumerates them is no part of them"
    )
)]

#[cfg(all(kani, feature = "mutants"))]
mod broken;
pub mod enumeration;
#[macro_use]
pub mod inventory;
pub mod arbitrary;
pub mod complete;
pub mod draw;
#[cfg(kani)]
mod kani_source;
#[cfg(not(kani))]
pub mod page;
pub mod properties;
#[cfg(not(kani))]
pub mod results;
pub mod sampling;
pub mod source;
pub mod total;
pub mod tries;
