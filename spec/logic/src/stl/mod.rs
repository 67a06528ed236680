//! Statement lists of STEP 7 (STL, AWL): the safe logic of the SINUMERIK 840D on the side of the PLC (PLC-SPL).
//!
//! [`parse`] reads a program; [`Program::compile`] makes the table that takes the place of a machine ([`Interface`]). The program becomes
//! a syntax tree of [`crate::st`]: the result of the logic operation is a temporary variable, a jump a condition around what it
//! leaves out, a timer a clock, a called block stands where it is called. The book says what a program may contain: chapter
//! "Statement lists".

mod ast;
mod interface;
mod known;
mod lex;
mod lower;
mod operand;
mod parse;
#[cfg(test)]
mod peer;
mod words;

use std::collections::BTreeMap;
use std::sync::Arc;

use stillpoint_lang::diag::{Diagnostics, Result};

use crate::fault::Fault;
use ast::Unit;

pub use interface::{Interface, Output, Used};
pub use operand::Bit;

/// The blocks of the control, in Structured Text.
pub(crate) const BLOCKS: &str = include_str!("blocks.st");

/// No safe logic is that long, in bytes.
const LONGEST: usize = 512 << 10;

/// The line of a byte of a text, from 1.
fn line_of(source: &str, at: usize) -> usize {
    source
        .get(..at)
        .map_or(0, |before| before.matches('\n').count())
        + 1
}

/// Instructions that stand on lines of their own, on one: `U M 1.0; = M 1.1`.
pub(crate) fn on_one_line(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let code = line.split("//").next().unwrap_or_default();
        let words: Vec<&str> = code.split_whitespace().collect();
        words.join(" ")
    });
    let lines = lines.map(|line| line.trim_end_matches(';').trim().to_owned());
    let lines: Vec<String> = lines.filter(|line| !line.is_empty()).collect();
    lines.join("; ")
}

/// A program that was read.
#[derive(Debug, Clone)]
pub struct Program {
    file: String,
    source: Arc<str>,
    /// Its mnemonics are German.
    german: bool,
    units: Vec<Unit>,
    /// What the symbol table calls bits.
    names: BTreeMap<Bit, String>,
}

/// Reads a program; `file` names it in errors and in the texts of its table.
///
/// # Errors
/// Everything that is wrong in its form, in its order.
pub fn parse(file: &str, source: &Arc<str>) -> Result<Program> {
    let told = |fault: Fault| fault.told(file, source);
    if source.len() > LONGEST {
        let message = format!(
            "a program of {} bytes is too long to be explored",
            source.len()
        );
        let help = format!("at most {LONGEST} bytes are taken");
        return Err(told(Fault::new(&(0..0), message, help)).into());
    }
    parse::program(file, source)
        .map_err(|faults| Diagnostics(faults.into_iter().map(told).collect()))
}

impl Program {
    /// The name of the block that runs in each cycle, else `PLC`.
    #[must_use]
    pub fn name(&self) -> String {
        let mut units = self.units.iter();
        let main = units.find(|unit| unit.block == ast::Block::Ob(1));
        let main = main.or(self.units.first());
        main.map_or_else(|| "PLC".to_owned(), |unit| unit.name.text.clone())
    }

    /// What a reader of the program calls a bit.
    fn title(&self, bit: Bit) -> String {
        if let Some(name) = self.names.get(&bit) {
            return name.clone();
        }
        let text = bit.to_string();
        match (self.german, bit.area) {
            (false, operand::Area::Input) => text.replacen('E', "I", 1),
            (false, operand::Area::Output) => text.replacen('A', "Q", 1),
            _ => text,
        }
    }
}
