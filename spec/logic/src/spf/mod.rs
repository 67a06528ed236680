//! SAFE.SPF: the safe logic of the SINUMERIK 840D (NCK-SPL), synchronous actions over system variables.
//!
//! [`parse`] reads and checks a program; [`Program::compile`] makes the table that takes the place of a machine ([`Interface`]).
//! The program becomes a syntax tree of [`crate::st`], whose translation runs it once with names in place of values: timers,
//! edge memories, markers and outputs are its variables. The book says what a program may contain, which reading was chosen where
//! the manual leaves one open, and how printed programs are repaired: chapter "SAFE.SPF".

mod ast;
mod check;
mod definitions;
mod interface;
mod lex;
mod lines;
mod listing;
mod lower;
mod names;
mod parse;
#[cfg(test)]
mod peer;
mod show;
mod variable;

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::diag::{Diagnostics, Result};

use crate::fault::Fault;
use ast::{Action, Name, Relay};

pub use interface::{Interface, Output, Readings, Used};
pub use variable::Variable;

/// The safety relay, as a block in Structured Text.
pub(crate) const RELAY: &str = include_str!("relay.st");

/// No safe logic is that long, in bytes.
const LONGEST: usize = 512 << 10;

/// How a text is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// As the language is.
    Strict,
    /// As manuals print it: damage of the print is repaired, and each repair noted.
    Listing,
}

/// Something worth telling of a program that is right, or was made right.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Note {
    /// From 1.
    pub line: usize,
    /// Which repair (`R1` to `R13`), check (`C6`, `C7`, `C10`) or choice (`DUP_REPLACE`, `DEFINE`, `ID`, `27097`) it is.
    pub rule: &'static str,
    /// What was found or done.
    pub text: String,
}

impl Note {
    fn new(source: &str, at: usize, rule: &'static str, text: String) -> Self {
        Self {
            line: line_of(source, at),
            rule,
            text,
        }
    }
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: {}: {}", self.line, self.rule, self.text)
    }
}

/// The line of a byte of a text, from 1.
fn line_of(source: &str, at: usize) -> usize {
    source
        .get(..at)
        .map_or(0, |before| before.matches('\n').count())
        + 1
}

/// A program that was read and checked.
#[derive(Debug, Clone)]
pub struct Program {
    file: String,
    source: Arc<str>,
    name: String,
    names: Vec<Name>,
    /// In ascending order of their ids, as they run: S840D-LANG-704.
    actions: Vec<Action>,
    relays: BTreeMap<u8, Relay>,
    notes: Vec<Note>,
    fragment: bool,
}

/// Reads a program; `file` names it in errors and in the texts of its table.
///
/// # Errors
/// Everything that is wrong in it, in its order.
pub fn parse(file: &str, source: &Arc<str>, mode: Mode) -> Result<Program> {
    let told = |fault: Fault| fault.told(file, source);
    if source.len() > LONGEST {
        let message = format!(
            "a program of {} bytes is too long to be explored",
            source.len()
        );
        let help = format!("at most {LONGEST} bytes are taken");
        return Err(told(Fault::new(&(0..0), message, help)).into());
    }
    parse::program(file, source, mode)
        .map_err(|faults| Diagnostics(faults.into_iter().map(told).collect()))
}

impl Program {
    /// Its name: of its header, else of PROC, else `SAFE`.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Repairs, repeated ids and definitions, warnings; by line.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Whether it is a part of a program, without header and end: names may be undefined, and it has no table.
    #[must_use]
    pub const fn is_fragment(&self) -> bool {
        self.fragment
    }

    /// The smallest and the largest id of its actions that survive a change of the mode: what MD11500 has to enclose: S840D-LANG-710.
    #[must_use]
    pub fn protected(&self) -> Option<(u8, u8)> {
        let mut kept = self.actions.iter().filter(|action| !action.modal);
        let first = kept.next()?;
        Some((first.id, kept.next_back().unwrap_or(first).id))
    }
}
