//! `stillpoint export`.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use stillpoint_engine::subject::{self, Task};
use stillpoint_harness::atomic::write_with;
use stillpoint_harness::export::{aiger, btor2, dot, json, murphi, promela, select, smv, tla};
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
    /// With aiger and btor2: only this `always` or `never` property, for checkers that take one (`range`: no value leaves its range)
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
    /// And-inverter graph for bit-level checkers: `always` and `never` properties as `bad`, `reachable` ones as outputs; in the binary
    /// form if the name of --output ends in .aig, else ASCII
    Aiger,
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
    if arguments.property.is_some() && !matches!(arguments.to, Format::Btor2 | Format::Aiger) {
        return Err(Failure::Other(
            "--property is for --to aiger and btor2; the other formats carry all properties side by side"
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
        Format::Aiger => {
            let only = arguments.property.as_deref();
            let path = arguments.output.as_deref();
            let binary = path.is_some_and(|p| p.extension().is_some_and(|e| e == "aig"));
            let file = aiger::aiger(bound, title, only, binary).map_err(|e| fail(&e))?;
            return match path {
                None => {
                    emit(&String::from_utf8_lossy(&file));
                    Ok(0)
                }
                Some(path) => write_bytes(path, &file).map(|()| 0),
            };
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
    write_bytes(path, text.as_bytes())
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    write_with(path, |out| out.write_all(bytes))
        .map_err(|e| Failure::Other(format!("{} cannot be written: {e}", path.display())))
}
