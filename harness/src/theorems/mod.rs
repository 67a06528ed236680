//! Proves the theorems of a family: every property of the systems that its machines are explored with, for every value of the parameters.

pub mod certificates;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use stillpoint_certify::proof::format::System as Certificate;
use stillpoint_engine::label;
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_engine::theorems::{OfSystem, Proved, RANGE, Theorems, fingerprint, tables};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::{Diagnostics, Result};
use stillpoint_lang::files;
use stillpoint_lang::ir::{Form, System};
use stillpoint_model::proof::Budget;
use stillpoint_model::{Interrupt, Verdict};

use crate::proof::{
    Choice, Engine, Every, Judged, Proof, Settings, Shown, Span, Which, judge_every,
};
use crate::report::{counted, wrapped};
use certificates::{Certificates, Confirmed, certified};

/// What stands above the theorems.
const HEAD: &str = "# Properties that hold for every value of the parameters. Written by `stillpoint theorems`; `check` of a machine cites them.
# Behind each stands the fingerprint of what decides it: with other tables it is no theorem any more.
";

/// How to prove.
pub struct Proving {
    /// Wall time for a property.
    pub each: Duration,
    /// Ask again what was not proved before.
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
        let own = of_system(&subject, &file, known.as_ref(), proving, told)?;
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
    let mut same =
        both.map(|(p, c)| p.holds.keys().cloned().collect::<BTreeSet<_>>() == claimed(c));
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

/// A parameter of more values than these is proved for the first few of them, where all of them are too many.
const MANY: i64 = 1 << 20;
const FEW: i64 = 15;

/// The theorems about the one system of a subject.
fn of_system(
    subject: &Subject,
    file: &Path,
    known: Option<&(OfSystem, Vec<Certificate>)>,
    proving: &Proving,
    told: &mut dyn FnMut(&str),
) -> std::result::Result<(OfSystem, Vec<Certificate>), Failed> {
    let bound = &subject.tasks[0].bound;
    let system = &bound.system;
    let prints = prints(system);
    let name = file.file_name().unwrap_or_default();
    let own = OfSystem {
        file: name.to_string_lossy().into_owned(),
        readings: bound.readings().into_iter().collect(),
        proved: Vec::new(),
        open: prints,
    };
    let all = |of: &OfSystem| -> BTreeMap<String, String> {
        let proved = of.proved.iter().flat_map(|proved| &proved.holds);
        let all = proved.chain(&of.open);
        all.map(|(key, value)| (key.clone(), value.clone()))
            .collect()
    };
    let same = |known: &OfSystem| known.readings == own.readings && all(known) == own.open;
    let known = known.filter(|known| same(&known.0)).cloned();
    let mut own = match known {
        Some(known) if !proving.open => return Ok(known),
        known => known.unwrap_or((own, Vec::new())),
    };
    let few = system.params.iter().filter(|p| p.reading.is_none());
    let few = few.filter_map(|param| {
        let (lo, hi) = (bound.constant(&param.var.lo), bound.constant(&param.var.hi));
        (hi - lo >= MANY).then(|| {
            let name = param.var.array();
            (name.to_owned(), (lo, lo + FEW))
        })
    });
    let few: BTreeMap<String, (i64, i64)> = few.collect();
    if !own.0.open.is_empty() {
        proved(subject, &mut own, BTreeMap::new(), proving, told)?;
    }
    if !few.is_empty() && own.0.open.keys().any(|name| name != RANGE) {
        proved(subject, &mut own, few, proving, told)?;
    }
    Ok(own)
}

/// All parameters of a system, each `within` its range there or over the whole documented one.
pub fn ranges(bound: &Bound, within: &BTreeMap<String, (i64, i64)>) -> Which {
    let params = bound.system.params.iter();
    let params = params.filter(|param| param.reading.is_none());
    let spans = params.map(|param| {
        let name = param.var.array().to_owned();
        let values = within.get(&name).copied();
        Span { name, values }
    });
    Which::Named(spans.collect())
}

/// Tries what is open for every value of the parameters, some of them `within` these ranges.
fn proved(
    subject: &Subject,
    (own, certificates): &mut (OfSystem, Vec<Certificate>),
    within: BTreeMap<String, (i64, i64)>,
    proving: &Proving,
    told: &mut dyn FnMut(&str),
) -> std::result::Result<(), Failed> {
    let mut subject = subject.clone();
    let task = &mut subject.tasks[0];
    let open = |label: &String| own.open.contains_key(label);
    task.bound.system.properties.retain(|p| open(&label(p)));
    let system = task.bound.system.name.clone();
    let which = ranges(&task.bound, &within);
    let every = match Every::new(&task.bound, &which) {
        Ok(every) => every,
        Err(why) => {
            told(&format!("{system}: {why}"));
            return Ok(());
        }
    };
    let start = Instant::now();
    let settings = Settings {
        choice: Choice::Pdr,
        depth: 0,
        time: None,
        each: Some(proving.each),
        memory: None,
        threads: 1,
        interrupt: proving.interrupt.clone(),
    };
    let judged = judge_every(&every, &settings);
    if proving.interrupt.as_ref().is_some_and(Interrupt::is_raised) {
        return Err(Failed::Ended);
    }
    let mut proved = Proved {
        every: every.text(),
        within,
        seconds: (start.elapsed().as_secs_f64() * 10.0).round() / 10.0,
        holds: BTreeMap::new(),
    };
    let tried = own.open.len();
    let mut holding: Vec<&Judged> = judged.iter().collect();
    holding.retain(|one| one.verdict == Verdict::Holds && own.open.contains_key(&one.id));
    // A system whose assignments all fit has no such fault.
    let fits = fits();
    if own.open.contains_key(RANGE) && !judged.iter().any(|one| one.id == RANGE) {
        holding.push(&fits);
    }
    let budget = Budget {
        until: None,
        interrupt: proving.interrupt.clone(),
    };
    let certificate = certified(&task.bound, &every, &holding, &budget).map_err(Failed::Other)?;
    if budget.spent() {
        return Err(Failed::Ended);
    }
    let claims = certificate.claims.iter();
    let moved = claims.filter_map(|claim| own.open.remove_entry(&claim.id));
    proved.holds.extend(moved);
    told(&format!(
        "{system}: {} of {tried} for {}; {:.1} s",
        proved.holds.len(),
        proved.every,
        proved.seconds
    ));
    if proved.holds.is_empty() {
        return Ok(());
    }
    own.proved.push(proved);
    certificates.push(certificate);
    Ok(())
}

/// That all assignments fit, whatever happens.
fn fits() -> Judged {
    Judged {
        id: RANGE.to_owned(),
        text: String::new(),
        verdict: Verdict::Holds,
        length: None,
        engine: Some(Engine::Pdr),
        proof: Some(Proof::Nothing),
        shown: Some(Shown::default()),
        trace: None,
        reason: None,
        seconds: 0.0,
    }
}

/// The file of the theorems.
pub fn text(theorems: &Theorems) -> String {
    let mut out = HEAD.to_owned();
    let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
    let table = |list: &BTreeMap<String, String>| {
        let one = |(key, value): (&String, &String)| format!("{} = {}", quoted(key), quoted(value));
        let all: Vec<String> = list.iter().map(one).collect();
        format!("{{ {} }}", all.join(", "))
    };
    for (name, own) in &theorems.systems {
        let name = quoted(name);
        let _ = writeln!(out, "\n[system.{name}]\nfile     = {}", quoted(&own.file));
        let _ = writeln!(out, "readings = {}", table(&own.readings));
        let _ = writeln!(out, "open     = {}", table(&own.open));
        for proved in &own.proved {
            let within = proved.within.iter();
            let within = within.map(|(key, (lo, hi))| format!("{} = [{lo}, {hi}]", quoted(key)));
            let within: Vec<String> = within.collect();
            let _ = writeln!(
                out,
                "\n[[system.{name}.proved]]\nevery   = {}",
                quoted(&proved.every)
            );
            let _ = writeln!(out, "within  = {{ {} }}", within.join(", "));
            let _ = writeln!(out, "seconds = {:?}", proved.seconds);
            let _ = writeln!(out, "holds   = {}", table(&proved.holds));
        }
    }
    out
}

/// A list for readers.
pub fn told(theorems: &Theorems) -> String {
    let mut out = String::new();
    let names = |list: &BTreeMap<String, String>| {
        let names: Vec<&str> = list.keys().map(String::as_str).collect();
        names.join(", ")
    };
    for (name, own) in &theorems.systems {
        let _ = writeln!(out, "{name}");
        for proved in &own.proved {
            wrapped(&mut out, "  for every ", &proved.every);
            wrapped(&mut out, "    holds    ", &names(&proved.holds));
            let _ = writeln!(out, "    {:.1} s", proved.seconds);
        }
        if !own.open.is_empty() {
            wrapped(&mut out, "  not proved ", &names(&own.open));
        }
        out.push('\n');
    }
    let _ = writeln!(out, "{}", count(theorems));
    out
}

/// How many theorems there are, and how many properties are not proved.
pub fn count(theorems: &Theorems) -> String {
    let systems = theorems.systems.values();
    let proved = systems.clone().flat_map(|own| &own.proved);
    format!(
        "{} about {}; {} not proved",
        counted(proved.map(|p| p.holds.len() as u64).sum(), "theorem"),
        counted(theorems.systems.len() as u64, "system"),
        systems.map(|own| own.open.len()).sum::<usize>()
    )
}

/// Whether a folder is that of a family.
pub fn is_family(folder: &Path) -> bool {
    files::is_file(&folder.join("family.toml"))
}
