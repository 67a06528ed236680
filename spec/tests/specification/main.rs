//! The language of the tables, machine files and catalogues, from outside.

mod catalogue;
mod common;
mod fuzz;
mod language;
mod machine;
mod mistakes;
mod slice;
