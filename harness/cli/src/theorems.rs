//! `stillpoint theorems`.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use stillpoint_engine::theorems::{FILE, Theorems};
use stillpoint_harness::export::write_atomically;
use stillpoint_harness::report::counted;
use stillpoint_harness::theorems::certificates::{self, Certificates};
use stillpoint_harness::theorems::{
    All, Failed, Proving, check, count, is_family, prove, text, told, unknown,
};
use stillpoint_model::proof::Budget;

use super::interrupt::Interruptible;
use super::{Failure, emit, show, values};

#[derive(Args)]
pub struct Arguments {
    /// The folder of a family
    #[arg(value_name = "FAMILY")]
    family: PathBuf,
    /// Prove those whose tables have changed, and write the family's theorems.toml and theorems.cert
    #[arg(long)]
    prove: bool,
    /// Check the certificates of all theorems, without the engines that have found them
    #[arg(long, conflicts_with = "prove")]
    check: bool,
    /// Ask also those again that were not proved before, and those for more values that are known for fewer
    #[arg(long, requires = "prove")]
    open: bool,
    /// Only about this system; may be given several times
    #[arg(long, value_name = "NAME")]
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
    if let Some(name) = unknown(folder, &arguments.system)? {
        return Err(Failure::Other(format!(
            "--system {name}: the machines of this family are explored with no such system; its theorems name all of them: stillpoint theorems {}",
            folder.display()
        )));
    }
    let mut known = Theorems::load(folder)?;
    if !arguments.prove && !arguments.check {
        let asked = |name: &String| {
            let own = name.rsplit('/').next().unwrap_or_default();
            arguments.system.is_empty() || arguments.system.iter().any(|asked| asked == own)
        };
        known.systems.retain(|name, _| asked(name));
        show(&told(&known));
        return Ok(0);
    }
    let certificates = Certificates::load(folder).map_err(Failure::Other)?;
    let known = (known, certificates);
    if arguments.check {
        return checked(folder, &known, &arguments.system);
    }
    let interrupt = Interruptible::begin()?;
    let proving = Proving {
        each: arguments.time,
        open: arguments.open,
        systems: arguments.system.clone(),
        interrupt: Some(interrupt.handle()),
    };
    let path = folder.join(FILE);
    let mut keep = |all: &All| {
        let certificates = folder.join(certificates::FILE);
        for (path, text) in [(&certificates, all.1.text()), (&path, text(&all.0))] {
            write_atomically(path, &text)
                .map_err(|e| format!("{} cannot be written: {e}", path.display()))?;
        }
        Ok(())
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
    emit(&format!("{}: {}\n", path.display(), count(&now.0)));
    Ok(0)
}

/// Checks the certificates: 0 if all theorems are confirmed, 1 if not.
fn checked(folder: &Path, known: &All, only: &[String]) -> Result<u8, Failure> {
    let interrupt = Interruptible::begin()?;
    let budget = Budget {
        until: None,
        interrupt: Some(interrupt.handle()),
    };
    let (mut confirmed, mut other, mut wrong) = (0, 0, 0);
    check(folder, known, only, &budget, &mut |system, found| {
        let line = match found {
            Ok(found) => {
                (confirmed, other) = (confirmed + found.confirmed, other + found.other);
                let other = match found.other {
                    0 => String::new(),
                    n => format!("; {n} not of these tables: prove them anew"),
                };
                let fails = match found.fails {
                    0 => String::new(),
                    n => format!(", {n} shown to fail for some values"),
                };
                format!(
                    "{system}: {} confirmed{fails}, {}, {}{other}",
                    found.confirmed,
                    counted(found.clauses as u64, "clause"),
                    counted(found.lemmas as u64, "lemma")
                )
            }
            Err(what) => {
                wrong += 1;
                format!("{system}: REJECTED: {what}")
            }
        };
        emit(&format!("{line}\n"));
    })?;
    if budget.spent() {
        emit("ended from outside: not all were looked at\n");
        return Ok(3);
    }
    emit(&format!(
        "{}: {} confirmed\n",
        folder.display(),
        counted(confirmed as u64, "theorem")
    ));
    Ok(match wrong + other {
        0 => 0,
        _ => 1,
    })
}
