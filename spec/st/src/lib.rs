//! Programs of safe PLCs in IEC 61131-3 Structured Text, translated to the tables of the specification language.
//!
//! A program takes the place of one machine of the tables: its inputs and outputs are those of that machine
//! ([`Signature`]). [`compile`] runs it once with names in place of values. Each assignment becomes a named expression with
//! its line, what branches leave behind is chosen by SEL, loops are unrolled, blocks are taken in where they are called. What
//! a cycle reads of the cycle before is the state; what nothing reads is left out. So a program is explored, proved and
//! certified as any table is. The book says what it may contain: chapter "Structured Text".
//!
//! **Invariant.** The table that comes out does in each cycle what the program does, or the program is refused with a place.

mod ast;
mod fault;
mod lex;
mod lower;
mod parse;
#[cfg(test)]
mod peer;
mod signature;
mod term;

use std::sync::Arc;

use stillpoint_lang::Written;
use stillpoint_lang::diag::{Diagnostics, Result};

pub use signature::Signature;

/// No program of a safe PLC is that long, in bytes.
const LONGEST: usize = 512 << 10;

/// The standard function blocks, in the language that they belong to.
pub const STANDARD: &str = include_str!("standard.st");

/// A program as a table.
#[derive(Clone)]
pub struct Compiled {
    /// The name of the program.
    pub name: String,
    /// What takes the machine's place. The texts in it have their places in the program.
    pub machine: Written,
    /// The durations that it has as parameters: name, and length in microseconds.
    pub durations: Vec<(String, u64)>,
}

/// Translates a program; `file` names it in errors and in the texts of the table.
///
/// # Errors
/// Everything that is wrong in it, in its order; after an error of form only that one.
pub fn compile(file: &str, source: &Arc<str>, signature: &Signature) -> Result<Compiled> {
    let told = |fault: fault::Fault| fault.told(file, source);
    if source.len() > LONGEST {
        let message = format!(
            "a program of {} bytes is too long to be explored",
            source.len()
        );
        let fault = fault::Fault::new(
            &(0..0),
            message,
            format!("at most {LONGEST} bytes are taken"),
        );
        return Err(told(fault).into());
    }
    let tree = parse::parse(source).map_err(|fault| Diagnostics::from(told(fault)))?;
    lower::lower(file, source, &tree, signature)
        .map_err(|faults| Diagnostics(faults.into_iter().map(told).collect()))
}
