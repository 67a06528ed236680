//! `stillpoint new`.

use std::path::PathBuf;

use clap::Args;
use stillpoint_machine::begin::{Wanted, has, written};
use stillpoint_machine::{load_bytes, names};

use super::params::folder;
use super::{Failure, emit, write};

#[derive(Args)]
pub struct Arguments {
    /// The family, such as sinumerik-840d, or its folder
    family: PathBuf,
    /// Name of the machine
    #[arg(long, default_value = "machine")]
    name: String,
    /// Linear axes
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "X,Z"
    )]
    linear: Vec<String>,
    /// Rotary axes
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    rotary: Vec<String>,
    /// Spindles
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    spindles: Vec<String>,
    /// Guard doors; all axes are behind each of them
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "front"
    )]
    doors: Vec<String>,
    /// Write to this file, which must not exist yet
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let folder = folder(&arguments.family)?;
    let families = folder.parent().unwrap_or(&folder);
    if !has(&folder) {
        let with = names(families)
            .into_iter()
            .filter(|name| has(&families.join(name)));
        return Err(Failure::Other(format!(
            "{} has no machine file to begin with; these have: {}",
            arguments.family.display(),
            with.collect::<Vec<_>>().join(", ")
        )));
    }
    if let Some(path) = arguments.output.as_ref().filter(|path| path.exists()) {
        return Err(Failure::Other(format!(
            "--output {}: this file exists, and nothing of it is overwritten; name another one",
            path.display()
        )));
    }
    let given = |names: &[String]| names.iter().filter(|n| !n.is_empty()).cloned().collect();
    let wanted = Wanted {
        name: arguments.name.clone(),
        linear: given(&arguments.linear),
        rotary: given(&arguments.rotary),
        spindles: given(&arguments.spindles),
        doors: given(&arguments.doors),
    };
    wanted.check().map_err(Failure::Other)?;
    let text = written(&folder, &wanted)?;
    // What the family refuses is told before the file is written.
    load_bytes(
        &PathBuf::from("the new machine file"),
        text.clone().into_bytes(),
        families,
    )?;
    match &arguments.output {
        Some(path) => write(Some(path), |out| out.write_all(text.as_bytes()))?,
        None => emit(&text),
    }
    Ok(0)
}
