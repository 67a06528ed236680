//! `stillpoint theorems`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use stillpoint_engine::theorems::{FILE, Theorems};
use stillpoint_harness::export::write_atomically;
use stillpoint_harness::theorems::{Failed, Proving, count, is_family, prove, text, told};

use super::interrupt::Interruptible;
use super::{Failure, emit, show, values};

#[derive(Args)]
pub struct Arguments {
    /// The folder of a family
    #[arg(value_name = "FAMILY")]
    family: PathBuf,
    /// Prove those whose tables have changed, and write the family's theorems.toml
    #[arg(long)]
    prove: bool,
    /// Ask also those again that were not proved before
    #[arg(long, requires = "prove")]
    open: bool,
    /// Only about this system; may be given several times
    #[arg(long, value_name = "NAME", requires = "prove")]
    system: Vec<String>,
    /// The most wall time for each property
    #[arg(long, value_name = "DURATION", value_parser = values::duration, default_value = "10s", requires = "prove")]
    time: Duration,
}

pub fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let folder = &arguments.family;
    if !is_family(folder) {
        return Err(Failure::Other(format!(
            "{}: no folder of a family: it holds no family.toml; name one such as spec/families/sinumerik-840d",
            folder.display()
        )));
    }
    let known = Theorems::load(folder)?;
    if !arguments.prove {
        show(&told(&known));
        return Ok(0);
    }
    let interrupt = Interruptible::begin()?;
    let proving = Proving {
        each: arguments.time,
        open: arguments.open,
        systems: arguments.system.clone(),
        interrupt: Some(interrupt.handle()),
    };
    let path = folder.join(FILE);
    let mut keep = |all: &Theorems| {
        write_atomically(&path, &text(all))
            .map_err(|e| format!("{} cannot be written: {e}", path.display()))
    };
    let mut line = |line: &str| emit(&format!("{line}\n"));
    let now = match prove(folder, &known, &proving, &mut line, &mut keep) {
        Ok(now) => now,
        Err(Failed::Input(found)) => return Err(Failure::Input(found)),
        Err(Failed::Other(message)) => return Err(Failure::Other(message)),
        Err(Failed::Ended) => {
            emit("ended from outside: what was proved before is written\n");
            return Ok(3);
        }
    };
    emit(&format!("{}: {}\n", path.display(), count(&now)));
    Ok(0)
}
