//! Proves the theorems of a family: every property of the systems that its machines are explored with, for every value of the parameters.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use stillpoint_engine::label;
use stillpoint_engine::subject::{self, Readings, Subject};
use stillpoint_engine::theorems::{OfSystem, Proved, RANGE, Theorems, fingerprint, tables};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::diag::{Diagnostics, Result};
use stillpoint_lang::files;
use stillpoint_lang::ir::{Form, System};
use stillpoint_model::{Interrupt, Verdict};

use crate::proof::{Choice, Every, Settings, Span, Which, judge_every};
use crate::report::{counted, wrapped};

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

/// Proves what of the theorems of a family belongs to other tables by now. `told` gets a line for each system that was asked, `keep` all
/// theorems after each of them: what was proved before something ends it is not lost.
///
/// # Errors
/// Data that cannot be read, theorems that cannot be kept.
pub fn prove(
    folder: &Path,
    known: &Theorems,
    proving: &Proving,
    told: &mut dyn FnMut(&str),
    keep: &mut dyn FnMut(&Theorems) -> std::result::Result<(), String>,
) -> std::result::Result<Theorems, Failed> {
    let mut all = known.clone();
    let mut names = BTreeSet::new();
    for (file, name) in systems(folder)? {
        let mut subject = subject::load(&file, &Readings::new())?;
        let wanted =
            |task: &subject::Task| task.bound.system.name.rsplit('/').next() == Some(&name);
        subject.tasks.retain(wanted);
        let Some(task) = subject.tasks.first() else {
            continue;
        };
        let full = task.bound.system.name.clone();
        names.insert(full.clone());
        if !proving.systems.is_empty() && !proving.systems.contains(&name) {
            continue;
        }
        let known = all.systems.get(&full);
        let own = of_system(&subject, &file, known, proving, told)?;
        if known != Some(&own) {
            all.systems.insert(full, own);
            keep(&all).map_err(Failed::Other)?;
        }
    }
    let before = all.systems.len();
    all.systems.retain(|name, _| names.contains(name));
    if all.systems.len() < before {
        keep(&all).map_err(Failed::Other)?;
    }
    Ok(all)
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
    known: Option<&OfSystem>,
    proving: &Proving,
    told: &mut dyn FnMut(&str),
) -> std::result::Result<OfSystem, Failed> {
    let bound = &subject.tasks[0].bound;
    let system = &bound.system;
    let prints = prints(system);
    let name = file.file_name().unwrap_or_default();
    let mut own = OfSystem {
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
    let same = |known: &&OfSystem| known.readings == own.readings && all(known) == own.open;
    if let Some(known) = known.filter(same) {
        if !proving.open {
            return Ok(known.clone());
        }
        own = known.clone();
    }
    let few = system.params.iter().filter(|p| p.reading.is_none());
    let few = few.filter_map(|param| {
        let (lo, hi) = (bound.constant(&param.var.lo), bound.constant(&param.var.hi));
        (hi - lo >= MANY).then(|| {
            let name = param.var.array();
            (name.to_owned(), (lo, lo + FEW))
        })
    });
    let few: BTreeMap<String, (i64, i64)> = few.collect();
    if !own.open.is_empty() {
        proved(subject, &mut own, BTreeMap::new(), proving, told)?;
    }
    if !few.is_empty() && own.open.keys().any(|name| name != RANGE) {
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
    own: &mut OfSystem,
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
    for one in judged.iter().filter(|one| one.verdict == Verdict::Holds) {
        proved.holds.extend(own.open.remove_entry(&one.id));
    }
    // A system whose assignments all fit has no such fault.
    if !judged.iter().any(|one| one.id == RANGE) {
        proved.holds.extend(own.open.remove_entry(RANGE));
    }
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
    Ok(())
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
