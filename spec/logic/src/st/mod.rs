//! Programs of safe PLCs in IEC 61131-3 Structured Text.
//!
//! A program takes the place of one machine of the tables: its inputs and outputs are those of that machine
//! ([`Signature`]), or are connected to them by an [`Interface`]. [`compile`] runs it once with names in place of values. Each assignment becomes a named expression with
//! its line, what branches leave behind is chosen by SEL, loops are unrolled, blocks are taken in where they are called. What
//! a cycle reads of the cycle before is the state; what nothing reads is left out. So a program is explored, proved and
//! certified as any table is. The book says what it may contain: chapter "Structured Text".

pub(crate) mod ast;
mod lex;
pub(crate) mod lower;
mod parse;
#[cfg(test)]
mod peer;
pub(crate) mod program;
pub(crate) mod signature;
pub(crate) mod term;

use std::sync::Arc;

use stillpoint_lang::diag::{Diagnostics, Result};

use crate::Compiled;
use crate::fault::Fault;

pub use program::{Interface, Output, Program};
pub use signature::Signature;

/// No program of a safe PLC is that long, in bytes.
const LONGEST: usize = 512 << 10;

/// The standard function blocks, in the language that they belong to.
pub const STANDARD: &str = include_str!("standard.st");

/// Translates a program whose inputs and outputs are those of the machine; `file` names it in errors and in the texts of the table.
///
/// # Errors
/// Everything that is wrong in it, in its order; after an error of form only that one.
pub fn compile(file: &str, source: &Arc<str>, signature: &Signature) -> Result<Compiled> {
    let tree = read(file, source)?;
    lowered(file, source, &tree, signature)
}

/// The syntax tree of a program.
fn read(file: &str, source: &Arc<str>) -> Result<ast::File> {
    let told = |fault: Fault| Diagnostics::from(fault.told(file, source));
    if source.len() > LONGEST {
        let message = format!(
            "a program of {} bytes is too long to be explored",
            source.len()
        );
        let help = format!("at most {LONGEST} bytes are taken");
        return Err(told(Fault::new(&(0..0), message, help)));
    }
    parse::parse(source).map_err(told)
}

/// The table that a program is.
fn lowered(
    file: &str,
    source: &Arc<str>,
    tree: &ast::File,
    signature: &Signature,
) -> Result<Compiled> {
    lower::lower(file, source, tree, signature).map_err(|faults| {
        let told = |fault: Fault| fault.told(file, source);
        Diagnostics(faults.into_iter().map(told).collect())
    })
}
