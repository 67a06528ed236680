//! Proves the theorems of a family: every property of the systems that its machines are explored with, for every value of the parameters.

mod attempt;
pub mod certificates;
mod conditions;
mod text;
mod wider;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

use stillpoint_certify::proof::format::System as Certificate;
use stillpoint_engine::label;
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_engine::theorems::{OfSystem, RANGE, Theorems, fingerprint, tables};
use stillpoint_lang::diag::{Diagnostics, Result};
use stillpoint_lang::files;
use stillpoint_lang::ir::{Form, System};
use stillpoint_model::Interrupt;
use stillpoint_model::proof::Budget;

use attempt::of_system;
use certificates::{Certificates, Confirmed};

pub use attempt::ranges;
pub use text::{count, text, told};
pub use wider::{Ranges, is_more};

/// How to prove.
pub struct Proving {
    /// Wall time for a property.
    pub each: Duration,
    /// Ask again what was not proved before, and for more values what is known for fewer.
    pub open: bool,
    /// Only about these systems, by their names in their files; none: about all.
    pub systems: Vec<String>,
    /// Ends everything from outside.
    pub interrupt: Option<Interrupt>,
}

/// The systems that the machines of a family are explored with, whatever they guarantee: file and name, each once, in the order of the data.
///
/// # Errors
/// The family's data cannot be read.
pub fn systems(folder: &Path) -> Result<Vec<(PathBuf, String)>> {
    let mut list: Vec<(PathBuf, String)> = Vec::new();
    for (file, system) in stillpoint_machine::data::explored(folder)? {
        let pair = (folder.join(file), system);
        if !list.contains(&pair) {
            list.push(pair);
        }
    }
    Ok(list)
}

/// All theorems of a family, with their certificates.
pub type All = (Theorems, Certificates);

/// Proves what of the theorems of a family belongs to other tables by now, or has no certificate. `told` gets a line for each system that
/// was asked, `keep` all theorems after each of them: what was proved before something ends it is not lost.
///
/// # Errors
/// Data that cannot be read, theorems that cannot be kept, a proof that the checker of certificates does not confirm.
pub fn prove(
    folder: &Path,
    known: &All,
    proving: &Proving,
    told: &mut dyn FnMut(&str),
    keep: &mut dyn FnMut(&All) -> std::result::Result<(), String>,
) -> std::result::Result<All, Failed> {
    let mut all = known.clone();
    let mut names = BTreeSet::new();
    for (file, name) in systems(folder)? {
        let Some((subject, full)) = loaded(&file, &name)? else {
            continue;
        };
        names.insert(full.clone());
        if !asked(&proving.systems, &name) {
            continue;
        }
        let known = all.0.systems.get(&full).map(|own| {
            let certificates = all.1.systems.get(&full);
            (own.clone(), certificates.cloned().unwrap_or_default())
        });
        let known = known.filter(|(own, certificates)| whole(own, certificates));
        let place = file.strip_prefix(folder).unwrap_or(&file);
        let own = of_system(&subject, place, known.as_ref(), proving, told)?;
        if known.as_ref() != Some(&own) {
            all.0.systems.insert(full.clone(), own.0);
            all.1.systems.insert(full, own.1);
            keep(&all).map_err(Failed::Other)?;
        }
    }
    let before = (all.0.systems.len(), all.1.systems.len());
    all.0.systems.retain(|name, _| names.contains(name));
    all.1.systems.retain(|name, _| names.contains(name));
    if before != (all.0.systems.len(), all.1.systems.len()) {
        keep(&all).map_err(Failed::Other)?;
    }
    Ok(all)
}

/// Whether each theorem has its certificate.
fn whole(own: &OfSystem, certificates: &[Certificate]) -> bool {
    let both = own.proved.iter().zip(certificates);
    let claimed = |certificate: &Certificate| -> BTreeSet<String> {
        certificate.claims.iter().map(|c| c.id.clone()).collect()
    };
    let mut same = both.map(|(p, c)| p.found().cloned().collect::<BTreeSet<_>>() == claimed(c));
    own.proved.len() == certificates.len() && same.all(|same| same)
}

/// Whether a system is one of those named, or none is.
fn asked(only: &[String], name: &String) -> bool {
    only.is_empty() || only.contains(name)
}

/// A name of which the family explores no system.
///
/// # Errors
/// The family's data cannot be read.
pub fn unknown<'a>(folder: &Path, names: &'a [String]) -> Result<Option<&'a String>> {
    let list = systems(folder)?;
    let known = |name: &&String| list.iter().any(|(_, own)| own == *name);
    Ok(names.iter().find(|name| !known(name)))
}

/// A system by itself, and its full name.
fn loaded(file: &Path, name: &str) -> Result<Option<(Subject, String)>> {
    let mut subject = subject::load(file, &Readings::new())?;
    let wanted = |task: &subject::Task| task.bound.system.name.rsplit('/').next() == Some(name);
    subject.tasks.retain(wanted);
    let full = subject.tasks.first().map(|t| t.bound.system.name.clone());
    Ok(full.map(|full| (subject, full)))
}

/// Checks the certificates of a family, or of some of its systems; `told` gets the name of each system with what is confirmed of it, or
/// what is not shown.
///
/// # Errors
/// Data that cannot be read.
pub fn check(
    folder: &Path,
    (theorems, certificates): &All,
    only: &[String],
    budget: &Budget,
    told: &mut dyn FnMut(&str, std::result::Result<Confirmed, String>),
) -> Result<()> {
    let mut names = BTreeSet::new();
    for (file, name) in systems(folder)? {
        let Some((subject, full)) = loaded(&file, &name)?.filter(|_| asked(only, &name)) else {
            continue;
        };
        if budget.spent() {
            return Ok(());
        }
        names.insert(full.clone());
        let known = theorems.systems.get(&full).cloned().unwrap_or_default();
        let own = certificates.systems.get(&full).cloned().unwrap_or_default();
        let bound = &subject.tasks[0].bound;
        let found = certificates::check(bound, &known, &own, budget);
        if budget.spent() {
            return Ok(());
        }
        told(&full, found);
    }
    for (name, _) in theorems.systems.iter().filter(|_| only.is_empty()) {
        if !names.contains(name) {
            let none = "the machines of the family are explored with no such system".to_owned();
            told(name, Err(none));
        }
    }
    Ok(())
}

/// Why not all is proved.
pub enum Failed {
    /// Data of the family.
    Input(Diagnostics),
    /// One sentence.
    Other(String),
    /// Ended from outside: what was proved before is kept.
    Ended,
}

impl From<Diagnostics> for Failed {
    fn from(diagnostics: Diagnostics) -> Self {
        Failed::Input(diagnostics)
    }
}

/// The fingerprints of all that can be a theorem: a witness is a run of some machine, and says nothing about all of them.
pub fn prints(system: &System) -> BTreeMap<String, String> {
    let tables = tables(system);
    let properties = system.properties.iter();
    let claims = properties.filter(|p| !matches!(p.form, Form::Reachable { .. }));
    let mut prints: BTreeMap<String, String> = claims
        .map(|p| (label(p), fingerprint(&tables, system, Some(p))))
        .collect();
    prints.insert(RANGE.to_owned(), fingerprint(&tables, system, None));
    prints
}

/// Whether a folder is that of a family.
pub fn is_family(folder: &Path) -> bool {
    files::is_file(&folder.join("family.toml"))
}
