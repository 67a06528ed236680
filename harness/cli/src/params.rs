//! `stillpoint params`.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;
use stillpoint_harness::params;
use stillpoint_lang::catalogue;
use stillpoint_lang::diag::nearest;
use stillpoint_machine::uses::Readers;
use stillpoint_machine::{data, families};

use super::{Failure, emit};

#[derive(Args)]
pub struct Arguments {
    /// The family, such as sinumerik-840d, or its folder
    family: PathBuf,
    /// One parameter, by its name in a machine file or as the manual calls it: STANDSTILL_TOL, MD36930, 1330, SMP525.x; or a pattern of
    /// guarantees, or an argument of one
    name: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let folder = folder(&arguments.family)?;
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let data = data::load(&folder)?;
    let Some(word) = &arguments.name else {
        if arguments.json {
            let list = data.parameters.iter().map(|d| params::to_json(d, None));
            emit_json(list.collect::<Vec<Value>>().into());
        } else {
            emit(&params::list(&name, &data));
        }
        return Ok(0);
    };
    let mut patterns = data.patterns.iter();
    if let Some(told) = patterns.find(|told| told.name == *word) {
        match arguments.json {
            true => emit_json(params::pattern_to_json(told)),
            false => emit(&params::pattern(told)),
        }
        return Ok(0);
    }
    let found = params::find(&data, word)
        .map_err(|help| Failure::Other(format!("{name} has no parameter '{word}'; {help}")))?;
    let catalogue = catalogue::load(folder.parent().unwrap_or(Path::new(".")))?;
    let readers = Readers::load(&folder)?;
    if arguments.json {
        let read = Some((&readers, &catalogue));
        let list = found.into_iter().map(|d| params::to_json(d, read));
        emit_json(list.collect::<Vec<Value>>().into());
        return Ok(0);
    }
    for (n, datum) in found.into_iter().enumerate() {
        if n > 0 {
            emit("\n");
        }
        emit(&params::whole(&readers, datum, &catalogue));
    }
    Ok(0)
}

fn emit_json(value: Value) {
    emit(&format!("{value:#}\n"));
}

/// The folder of the family that is named, or that is given as a folder.
pub(super) fn folder(named: &Path) -> Result<PathBuf, Failure> {
    if named.join("family.toml").is_file() {
        return named
            .canonicalize()
            .map_err(|e| Failure::Other(format!("{} cannot be read: {e}", named.display())));
    }
    let root = families(named);
    let word = named.display().to_string();
    let known = stillpoint_machine::names(&root);
    if known.contains(&word) {
        return Ok(root.join(word));
    }
    let help = match nearest(&word, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean {near}?"),
        None => format!("there are {}", known.join(", ")),
    };
    Err(Failure::Other(format!(
        "there is no family '{word}'; {help}"
    )))
}
