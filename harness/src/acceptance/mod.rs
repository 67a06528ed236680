//! `acceptance`: the protocol of the acceptance test of a machine, and what of it has to be repeated after a change.

mod document;
mod expected;
mod guaranteed;
mod results;
mod run;
mod since;

use std::io;
use std::path::Path;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use stillpoint_lang::files;
use stillpoint_machine::Machine;
use stillpoint_machine::acceptance::{Expect, Protocol, Simulated, Test};

pub use document::document;
pub use expected::expected;
pub use guaranteed::{Decided, Undecided, decide};
pub use run::{Ran, Unfit, on_the_machine, run};
pub use since::{Change, Repeat, Since, since};

/// What the protocol belongs to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checksums {
    /// Name of the machine file.
    pub file: String,
    /// SHA-256 of the machine file.
    pub machine: String,
    /// SHA-256 over names and contents of the family's data and specifications.
    pub family: String,
}

/// Hashes the machine file and every `.toml` file in the folder of its family, in the order of their names.
///
/// # Errors
/// A file that cannot be read.
pub fn checksums(path: &Path, machine: &Machine) -> io::Result<Checksums> {
    let names = files::list(machine.family_folder())?.into_iter();
    let mut all = Sha256::new();
    for name in names.filter(|n| n.extension().is_some_and(|e| e == "toml")) {
        let short = name.file_name().unwrap_or_default().to_string_lossy();
        all.update(short.as_bytes());
        all.update([0]);
        all.update(Sha256::digest(files::read(&name)?));
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Ok(Checksums {
        file: name.into_owned(),
        machine: format!("{:x}", Sha256::digest(std::fs::read(path)?)),
        family: format!("{:x}", all.finalize()),
    })
}

/// The tests that are to be carried out: all, or those to be repeated.
pub fn selected<'a>(protocol: &'a Protocol, since: Option<&Since>) -> Vec<&'a Test> {
    let wanted =
        |test: &&Test| since.is_none_or(|since| since.repeat.iter().any(|r| r.id == test.id));
    protocol.tests.iter().filter(wanted).collect()
}

/// The latest time of something expected, in microseconds and monitoring cycles, tolerance included.
fn latest(expect: &Expect, cycle: i64) -> Option<(i64, i64)> {
    let us = expect
        .after?
        .saturating_add(expect.tolerance.saturating_mul(cycle));
    Some((us, us / cycle.max(1) + i64::from(us % cycle.max(1) != 0)))
}

/// The protocol as JSON.
pub fn to_json(
    machine: &Machine,
    protocol: &Protocol,
    checksums: &Checksums,
    since: Option<&Since>,
    ran: Option<&[Ran]>,
    decided: Option<&Decided>,
) -> Value {
    let cycle = machine.monitoring_cycle;
    let selected = selected(protocol, since);
    let not = on_the_machine(&selected);
    let tests = selected.into_iter().map(|test| {
        let expect = test.expect.iter().map(|e| {
            let (us, cycles) = latest(e, cycle).unzip();
            json!({
                "text": e.text, "signal": e.signal.as_ref().map(|(s, _)| s),
                "value": e.signal.as_ref().map(|(_, v)| v), "after_us": e.after, "formula": e.formula,
                "tolerance_cycles": e.tolerance, "latest_us": us, "latest_cycles": cycles,
            })
        });
        let reason = match &test.simulated {
            Simulated::Scenario(_) => None,
            Simulated::Not(reason) => Some(reason),
        };
        let measure = test.measure.iter();
        let measure = measure.map(|m| json!({"text": m.text, "unit": m.unit, "limit": m.limit}));
        json!({
            "id": test.id, "part": protocol.parts.get(test.part).map(|p| &p.name),
            "title": test.title, "axis": test.axis, "requirements": test.req,
            "requires": test.requires, "steps": test.steps,
            "expect": expect.collect::<Vec<_>>(), "measure": measure.collect::<Vec<_>>(),
            "simulated": reason.is_none(), "not_simulated": reason, "depends": test.depends,
        })
    });
    let mut value = json!({
        "machine": machine.name, "file": checksums.file, "sha256": checksums.machine,
        "family": machine.family, "family_sha256": checksums.family,
        "stillpoint": env!("CARGO_PKG_VERSION"), "monitoring_cycle_us": cycle,
        "tests": tests.collect::<Vec<_>>(),
    });
    if let Some(decided) = decided {
        value["guarantees"] = decided.json.clone().into();
    }
    if let Some(ran) = ran {
        value["simulated"] = run::json(ran);
        let not = not.into_iter();
        let not = not.map(|(id, reason)| json!({"id": id, "reason": reason}));
        value["not_simulated"] = not.collect::<Vec<_>>().into();
    }
    if let Some(since) = since {
        value["since"] = since.to_json();
    }
    value
}
