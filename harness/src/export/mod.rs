//! Systems in the formats of other tools.
//!
//! [`promela`](fn@promela::promela) gives a model for SPIN, [`dot`](fn@dot::dot) the control-state graphs for Graphviz,
//! [`json`](fn@json::json) the resolved system for anything else.

mod about;
pub mod aiger;
pub mod btor2;
mod circuit;
pub mod dot;
mod folded;
pub mod json;
mod known;
pub mod murphi;
mod names;
mod netlist;
pub mod promela;
mod select;
pub mod smv;
mod syntax;
pub mod text;
pub mod tla;
mod types;
mod writer;

pub(crate) use folded::range_of;
pub(crate) use netlist::Translated;
pub use select::{select, system_names};

use std::path::Path;

use crate::atomic::write_with;

/// Why a system cannot be expressed in a format: one sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unsupported(pub String);

/// Writes a file so that it is there in full or not at all: under a name of its own first, then renamed.
///
/// # Errors
/// As of writing and renaming; nothing is left behind then.
pub fn write_atomically(path: &Path, text: &str) -> std::io::Result<()> {
    write_with(path, |out| out.write_all(text.as_bytes()))
}
