//! `stillpoint export`.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use stillpoint_engine::subject::{self, Task};
use stillpoint_harness::export::{
    btor2, dot, json, murphi, promela, select, smv, tla, write_atomically,
};
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
    /// With btor2: only this `always` or `never` property, for checkers that take one (`range`: no value leaves its range)
    #[arg(long, value_name = "ID")]
    property: Option<String>,
    /// Write to this file instead of stdout
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    /// Model for SPIN: cycles, ranges, `always` and `never` properties
    Promela,
    /// Model for rumur (Murphi): cycles, ranges, `always`, `never` and `reachable` properties
    Murphi,
    /// Model for nuXmv and NuSMV: cycles, ranges, `always`, `never` and `reachable` properties
    Smv,
    /// Bit-vectors for word-level checkers: `always` and `never` properties as `bad`, `reachable` ones as `output`
    Btor2,
    /// TLA+ module with TLC's configurations (beside FILE.tla FILE.cfg with all that must hold, and FILE.PROPERTY.cfg for each
    /// property alone): `always`, `never` and `reachable` properties
    Tla,
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
    if arguments.property.is_some() && !matches!(arguments.to, Format::Btor2) {
        return Err(Failure::Other(
            "--property is for --to btor2; the other formats carry all properties side by side"
                .to_owned(),
        ));
    }
    let (bound, title) = (&task.bound, task.title.as_str());
    let text = match arguments.to {
        Format::Promela => promela::promela(bound, title)
            .map(|p| p.text)
            .map_err(|e| fail(&e))?,
        Format::Murphi => murphi::murphi(bound, title).map_err(|e| fail(&e))?,
        Format::Smv => smv::smv(bound, title).map_err(|e| fail(&e))?,
        Format::Btor2 => {
            btor2::btor2(bound, title, arguments.property.as_deref()).map_err(|e| fail(&e))?
        }
        Format::Tla => return tla(arguments, task),
        Format::Dot => dot::dot(bound, title, &Options::default()).map_err(|e| fail(&e))?,
        Format::Json => format!("{:#}\n", json::json(bound)),
    };
    match &arguments.output {
        None => emit(&text),
        Some(path) => write(path, &text)?,
    }
    Ok(0)
}

/// The module and its configurations: a file each, or all on stdout, where TLA+ ignores what stands after the module.
fn tla(arguments: &Arguments, task: &Task) -> Result<u8, Failure> {
    let system = &task.bound.system.name;
    let name = match &arguments.output {
        None => system.rsplit('/').next().map(ToOwned::to_owned),
        Some(path) => path.file_stem().map(|s| s.to_string_lossy().into_owned()),
    };
    let name = name.unwrap_or_default();
    let made = tla::tla(&task.bound, &task.title, &name)
        .map_err(|e| Failure::Other(format!("{system}: {e}")))?;
    match &arguments.output {
        None => {
            let mut text = format!(
                "{}\nConfiguration, {name}.cfg:\n\n{}",
                made.module, made.config
            );
            for (property, config) in &made.single {
                text.push_str(&format!(
                    "\nConfiguration, {name}.{property}.cfg:\n\n{config}"
                ));
            }
            emit(&text);
        }
        Some(path) => {
            write(path, &made.module)?;
            write(&path.with_extension("cfg"), &made.config)?;
            for (property, config) in &made.single {
                write(&path.with_extension(format!("{property}.cfg")), config)?;
            }
        }
    }
    Ok(0)
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    write_atomically(path, text)
        .map_err(|e| Failure::Other(format!("{} cannot be written: {e}", path.display())))
}
