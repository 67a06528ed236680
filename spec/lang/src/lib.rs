//! Loads, type-checks and analyses specifications of safety functions; interprets them and generates Rust from them.
//!
//! The language is defined in the book, chapter "The specification language".
//!
//! The way of a specification: [`Spec::load`] reads the TOML files, [`Spec::system`] resolves one system to an
//! [`ir::System`], [`bind::Bound`] gives it parameter values, and [`bind::Bound::step`] runs it.

pub mod analysis;
mod assemble;
pub mod bind;
pub mod catalogue;
pub mod cells;
pub mod codegen;
pub mod compile;
pub mod condition;
pub mod diag;
pub mod eval;
mod excerpt;
pub mod files;
pub mod fold;
mod interval;
pub mod ir;
pub mod outline;
pub mod parts;
mod property;
mod replace;
mod schema;
mod scope;
pub mod slice;
mod spec;
pub mod symmetry;
pub mod syntax;
mod text;
pub mod timers;
pub mod twice;
mod written;

pub use spec::{Spec, toml_error};
pub use text::{decode, read_text};
pub use written::Written;
