//! The command line.

mod cli;

use std::process::ExitCode;

/// The data of the families, so that a machine file can lie anywhere.
const FAMILIES: &[stillpoint_lang::files::Carried] =
    include!(concat!(env!("OUT_DIR"), "/family_data.rs"));

fn main() -> ExitCode {
    stillpoint_lang::files::provide(FAMILIES);
    cli::main()
}
