//! What a command works on: the systems of a specification file, or the runs of a machine file.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use stillpoint_lang::analysis::{Analysis, Known};
use stillpoint_lang::bind::{BindError, Bound};
use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result};
use stillpoint_lang::ir::Form;
use stillpoint_lang::{Spec, read_text};
use stillpoint_machine::{self as machine, Abstraction, Machine, Run, families};

/// Chosen options of readings, by id; what is missing has the recommended one.
pub type Readings = BTreeMap<String, String>;

/// One exploration.
#[derive(Debug, Clone)]
pub struct Task {
    /// What it shows.
    pub title: String,
    /// The axes it stands for; empty for a specification file.
    pub axes: Vec<String>,
    /// The guarantee of the machine file that it decides.
    pub guarantee: Option<String>,
    /// The classes of single faults that it answers, in words.
    pub faults: Vec<String>,
    /// A time in microseconds that passes before what is explored begins; no bound has it.
    pub before: u64,
    /// The speed, in base units a minute, at which a bound is told as a way too; 0: at none.
    pub travel: i64,
    /// A way in base units that is added to the one at that speed.
    pub window: i64,
    /// Where it is coarser than the machine.
    pub abstractions: Vec<Abstraction>,
    /// The system with its parameter values.
    pub bound: Bound,
    /// What static analysis found.
    pub analysis: Analysis,
    /// The specification file of the system.
    pub file: PathBuf,
    /// For parameters that a machine file decides: the expression over its values.
    pub sources: BTreeMap<String, String>,
    /// The same for less effort, where what holds there holds here.
    pub loose: Option<Box<Loose>>,
    /// Whether `bound` is the loose system, and the own one stands in its place.
    pub loosely: bool,
}

/// A system in which more may happen than in that of its task, and fewer states are told apart.
#[derive(Debug, Clone)]
pub struct Loose {
    /// The system with its parameter values.
    pub bound: Bound,
    /// What static analysis found.
    pub analysis: Analysis,
    /// What is left open, in words.
    pub text: String,
}

impl Task {
    /// The system that the file describes, whichever was explored.
    pub fn own(&self) -> &Bound {
        let loose = self.loose.as_ref().filter(|_| self.loosely);
        loose.map_or(&self.bound, |other| &other.bound)
    }

    /// Changes the system for the loose one, or back.
    pub fn change(&mut self) {
        if let Some(loose) = &mut self.loose {
            self.loosely = !self.loosely;
            std::mem::swap(&mut self.bound, &mut loose.bound);
            std::mem::swap(&mut self.analysis, &mut loose.analysis);
        }
    }
}

/// A file and everything to be explored for it.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The file.
    pub path: PathBuf,
    /// Name of the machine or specification.
    pub name: String,
    /// One line about it.
    pub title: String,
    /// The machine, for a machine file.
    pub machine: Option<Machine>,
    /// The explorations.
    pub tasks: Vec<Task>,
}

/// Reads a specification or machine file, resolves and analyses everything to be explored.
///
/// # Errors
/// Whatever is wrong with the file; nothing has been run then.
pub fn load(path: &Path, readings: &Readings) -> Result<Subject> {
    let text = read_text(path, "machine or specification file")?;
    if has_key(&text, "spec") {
        of_spec(path, text, readings)
    } else {
        of_machine(path, readings)
    }
}

/// Whether the file sets this key at its top: `spec` marks a specification file, `family` a machine file.
pub fn has_key(text: &str, key: &str) -> bool {
    text.lines()
        .map(str::trim_start)
        .take_while(|l| !l.starts_with('['))
        .any(|l| {
            l.strip_prefix(key)
                .is_some_and(|rest| rest.trim_start().starts_with('='))
        })
}

/// The guards that this process has examined: a machine file with one value changed has those of the file.
static EXAMINED: LazyLock<Known> = LazyLock::new(Known::default);

fn of_spec(path: &Path, text: Arc<str>, readings: &Readings) -> Result<Subject> {
    let spec = Spec::from_text(path, text.clone())?;
    let names: Vec<String> = spec.systems().map(str::to_owned).collect();
    let mut tasks = Vec::new();
    let mut errors = Vec::new();
    for name in &names {
        let system = match spec.system(name, None) {
            Ok(system) => system,
            Err(Diagnostics(list)) => {
                errors.extend(list);
                continue;
            }
        };
        let bound = bind(path, &text, system, &BTreeMap::new(), readings)?;
        match spec.analyse(&bound, &EXAMINED) {
            Ok(analysis) => tasks.push(Task {
                title: bound.system.text.clone(),
                axes: Vec::new(),
                guarantee: None,
                faults: Vec::new(),
                before: 0,
                travel: 0,
                window: 0,
                abstractions: Vec::new(),
                bound,
                analysis,
                file: path.to_owned(),
                sources: BTreeMap::new(),
                loose: None,
                loosely: false,
            }),
            Err(Diagnostics(list)) => errors.extend(list),
        }
    }
    if !errors.is_empty() {
        return Err(Diagnostics(errors));
    }
    if tasks.is_empty() {
        let file = path.display().to_string();
        return Err(
            Diagnostic::new(&file, &text, None, "declares no system to check")
                .help("add [system.NAME] with instances, or check a file that uses this one")
                .into(),
        );
    }
    Ok(Subject {
        path: path.to_owned(),
        name: spec.name.clone(),
        title: spec.title.clone(),
        machine: None,
        tasks,
    })
}

fn of_machine(path: &Path, readings: &Readings) -> Result<Subject> {
    let machine = machine::load(path, &families(path))?;
    let runs = machine.runs.clone();
    of_runs(path, machine, &runs, readings)
}

/// The specification of runs, and the one in which these times of their programs are loose.
type Made = (Spec, Option<(Spec, Vec<String>)>);

/// A machine with explorations that need not be its own ones, such as those of its reaction times.
///
/// # Errors
/// As [`load`].
pub fn of_runs(
    path: &Path,
    machine: Machine,
    runs: &[Run],
    readings: &Readings,
) -> Result<Subject> {
    let mut tasks = Vec::new();
    let mut specs: BTreeMap<_, Made> = BTreeMap::new();
    for run in runs {
        let (spec, loose) = match specs.entry((
            &run.file,
            &run.wiring,
            run.half,
            run.asks.as_ref().map(|asks| &asks.own.name),
        )) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => new.insert((machine.spec(run)?, machine.loose_spec(run)?)),
        };
        let cycle = u64::try_from(run.cycle).ok();
        let system = spec.system(&run.system, cycle)?;
        let source: Arc<str> = Arc::from("");
        let bound = bind(&run.file, &source, system, &run.params, readings)?;
        let analysis = spec.analyse(&bound, &EXAMINED)?;
        let loose = match loose.as_ref().filter(|_| is_of_paths(&bound)) {
            Some((spec, times)) => {
                let system = spec.system(&run.system, cycle)?;
                let open = bind(&run.file, &source, system, &run.params, readings)?;
                let few = combinations(&open) <= combinations(&bound).saturating_mul(OPEN);
                let loose = few.then(|| loosely(spec, open, times)).transpose()?;
                loose.map(Box::new)
            }
            None => None,
        };
        tasks.push(Task {
            title: run.title.clone(),
            axes: run.axes.clone(),
            guarantee: run.guarantee.clone(),
            faults: run.faults.clone(),
            before: u64::try_from(run.before).unwrap_or(0),
            travel: run.travel,
            window: run.window,
            abstractions: run.abstractions.clone(),
            bound,
            analysis,
            file: run.file.clone(),
            sources: run.sources.clone(),
            loose,
            loosely: false,
        });
    }
    Ok(Subject {
        path: path.to_owned(),
        name: machine.name.clone(),
        title: machine.title.clone(),
        machine: Some(machine),
        tasks,
    })
}

/// With more values of open times than these a cycle costs more than the states that they spare.
const OPEN: u128 = 400;

/// How many combinations of inputs a system has.
fn combinations(bound: &Bound) -> u128 {
    let sizes = bound.inputs.iter();
    let sizes = sizes.map(|(low, high)| u128::from(high.abs_diff(*low)) + 1);
    sizes.fold(1, u128::saturating_mul)
}

/// The loose system of an exploration whose programs have these times.
fn loosely(spec: &Spec, bound: Bound, times: &[String]) -> Result<Loose> {
    let analysis = spec.analyse(&bound, &EXAMINED)?;
    let text = format!(
        "Nothing that this exploration tells the program starts {}: whether such a time is over is left open in each cycle, and what holds so holds.",
        times.join(", ")
    );
    Ok(Loose {
        bound,
        analysis,
        text,
    })
}

/// Whether all that is asked of the system is true of each path by itself: then more paths cannot make it true.
fn is_of_paths(bound: &Bound) -> bool {
    let properties = bound.system.properties.iter();
    properties.map(|property| &property.form).all(|form| {
        matches!(
            form,
            Form::Always { .. } | Form::LeadsTo { .. } | Form::Unless { .. }
        )
    })
}

fn bind(
    path: &Path,
    source: &Arc<str>,
    system: stillpoint_lang::ir::System,
    params: &BTreeMap<String, Vec<i64>>,
    readings: &Readings,
) -> Result<Bound> {
    Bound::new(system, params, readings).map_err(|e: BindError| {
        let help = match e {
            BindError::Reading(_) => "write --readings ID=OPTION with one of these options",
            _ => "give the parameter a value of its range, or correct the mapping in the family's file",
        };
        Diagnostic::new(&path.display().to_string(), source, None, e.to_string())
            .help(help)
            .into()
    })
}
