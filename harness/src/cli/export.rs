//! `stillpoint export`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use stillpoint::export::{dot, json, promela, select, write_atomically};
use stillpoint::subject;
use stillpoint_model::Options;

use super::{Failure, emit};

#[derive(Args)]
pub struct Arguments {
    /// Machine or specification file
    file: PathBuf,
    /// Format
    #[arg(long, value_enum)]
    to: Format,
    /// Which system, where the file has several; NAME:AXIS where one system runs for several axes
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
    /// Write to this file instead of stdout
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    /// Model for SPIN: cycles, ranges, `always` and `never` properties
    Promela,
    /// Control-state graph of each machine for Graphviz (explores the system)
    Dot,
    /// The resolved system: states, inputs, parameters, rules with requirement ids, properties
    Json,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let subject = subject::load(&arguments.file, &subject::Readings::new())?;
    let task = select(&subject, arguments.system.as_deref()).map_err(Failure::Other)?;
    let fail =
        |e: &dyn std::fmt::Display| Failure::Other(format!("{}: {e}", task.bound.system.name));
    let text = match arguments.to {
        Format::Promela => {
            promela::promela(&task.bound, &task.title)
                .map_err(|e| fail(&e))?
                .text
        }
        Format::Dot => {
            dot::dot(&task.bound, &task.title, &Options::default()).map_err(|e| fail(&e))?
        }
        Format::Json => format!("{:#}\n", json::json(&task.bound)),
    };
    match &arguments.output {
        None => emit(&text),
        Some(path) => write_atomically(path, &text)
            .map_err(|e| Failure::Other(format!("{} cannot be written: {e}", path.display())))?,
    }
    Ok(0)
}
