//! The languages of safe programs, translated to the tables of the specification language.
//!
//! A program takes the place of one machine of the tables and is then explored, proved and certified as any table is.
//! [`st`] is IEC 61131-3 Structured Text, [`spf`] the synchronous actions of SAFE.SPF, [`stl`] the statement lists of the PLC.
//!
//! **Invariant.** The table that comes out does in each cycle what the program does, or the program is refused with a place.

mod fault;
pub mod spf;
pub mod st;
pub mod stl;
mod tree;

use stillpoint_lang::Written;

/// The input of a machine that tells a program when it is scanned.
pub const SCAN: &str = "scan";

/// A program as a table.
#[derive(Clone)]
pub struct Compiled {
    /// The name of the program.
    pub name: String,
    /// What takes the machine's place. The texts in it have their places in the program.
    pub machine: Written,
    /// The durations that it has as parameters: name, and length in microseconds.
    pub durations: Vec<(String, u64)>,
    /// What it reads beside the inputs of the machine that it takes the place of: further inputs of the table.
    pub inputs: Vec<Input>,
    /// The times that are inputs of the table too, by their names in the program: see [`st::Signature::loose`].
    pub loose: Vec<String>,
}

/// An input that a program adds to those of the machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// Its name in the table: `inse_3`.
    pub name: String,
    /// Its type in the table: `BOOL`, `INT(0..255)`.
    pub ty: String,
    /// As the language names it: `INSE[3]`.
    pub variable: String,
}
