//! The language of the tables and catalogues, from outside.

mod catalogue;
mod common;
mod fuzz;
mod language;
mod mistakes;
mod slice;
