//! Machine files: a machine's axes, functions, limits and doors in user units, checked against the data of its family
//! and mapped to the systems to explore.
//!
//! A machine file is TOML with the key `family`. Everything it may say stands in `<family>/family.toml`: the parameters
//! with range, default and the manual's names, the functions, the plausibility rules and the systems. Values become
//! exact integers in base units (see [`units`]).
//!
//! ```toml
//! family = "sinumerik-840d"
//! [axis.X]
//! kind = "linear"
//! functions = ["SBH/SG", "external stops"]
//! STANDSTILL_TOL = "0.5 mm"
//! ```

pub mod acceptance;
pub mod begin;
mod bind;
mod coverage;
pub mod data;
mod document;
mod entry;
mod eval;
mod explore_file;
mod family;
mod family_file;
#[cfg(test)]
mod family_tests;
mod ground;
pub mod guarantee;
pub mod knob;
mod logic;
pub mod own;
mod pair;
mod place;
mod plausible;
mod products;
pub mod reaction;
mod read;
mod runs;
mod signal;
mod template;
mod unasked;
pub mod units;
pub mod uses;
mod value;
pub mod warnings;
mod whole;
mod wired;

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use document::Findings;
use family::{Family, Param};
use guarantee::Guarantee;
use logic::Logic;
use own::Asks;
use plausible::Judged;
use runs::Parts;
use stillpoint_lang::diag::{Result, nearest};
use stillpoint_lang::files;
use warnings::Warning;

/// A byte range of the machine file.
pub type Place = Range<usize>;

/// Values by the name of their parameter.
pub type Settings = BTreeMap<String, Setting>;

/// A machine that passed all checks, and what is to be explored for it.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Its name: the key `name`, else the name of the file.
    pub name: String,
    /// One line about it; may be empty.
    pub title: String,
    /// Its family: the name of a folder with a `family.toml`.
    pub family: String,
    /// The family in words.
    pub family_title: String,
    /// Values of the control common to all axes.
    pub control: Settings,
    /// The monitoring cycle T_SI in microseconds; one cycle of a check.
    pub monitoring_cycle: i64,
    /// Its axes and spindles, in the order of the file.
    pub axes: Vec<Axis>,
    /// Axes whose stops act on one another, by name; an axis on its own is in none. Each in the order of the file.
    pub groups: Vec<Vec<String>>,
    /// The axis groups that the file declares, in its order; none in a family whose groups follow from the axes.
    pub axis_groups: Vec<Group>,
    /// Its guard doors, in the order of the file.
    pub doors: Vec<Door>,
    /// What it must guarantee, in the order of the file.
    pub guarantees: Vec<Guarantee>,
    /// What has to be explored to cover the machine; first what decides its guarantees.
    pub runs: Vec<Run>,
    /// What the file describes but no run explores, in words.
    pub not_explored: Vec<String>,
    /// Values that are legal but unusual, in the order of the file. They change no verdict.
    pub warnings: Vec<Warning>,
    /// Where the values of the control stand, else the family.
    place: Place,
    basis: Arc<Basis>,
}

/// Linear axis or rotary axis; a spindle is a rotary axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisKind {
    /// Path in mm, speed in mm/min.
    Linear,
    /// Path in degrees, speed in revolutions per minute.
    Rotary,
}

/// An axis or spindle.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Its name in the file.
    pub name: String,
    /// One line about it; may be empty.
    pub title: String,
    /// What it moves.
    pub kind: AxisKind,
    /// Whether it is a spindle.
    pub spindle: bool,
    /// The safety functions enabled for it, in the order of the file.
    pub functions: Vec<String>,
    /// A value for every parameter of an axis.
    pub values: Settings,
    /// The axes it moves with on one path.
    pub interpolates_with: Vec<Spanned<String>>,
    /// The axis whose drive moves the same thing: both have to have the same values.
    pub pair: Option<Spanned<String>>,
    place: Place,
    functions_place: Option<Place>,
}

/// An axis group: axes that are released and stopped together.
#[derive(Debug, Clone)]
pub struct Group {
    /// Its name in the file.
    pub name: String,
    /// One line about it; may be empty.
    pub title: String,
    /// Its axes.
    pub axes: Vec<Spanned<String>>,
    /// A value for every parameter of a group.
    pub values: Settings,
    place: Place,
}

/// A guard door.
#[derive(Debug, Clone)]
pub struct Door {
    /// Its name in the file.
    pub name: String,
    /// One line about it; may be empty.
    pub title: String,
    /// The axes a person can reach through it.
    pub axes: Vec<Spanned<String>>,
    /// The groups that it names in their place, in a family with axis groups.
    pub groups: Vec<Spanned<String>>,
    /// A value for every parameter of a door.
    pub values: Settings,
    place: Place,
}

/// The value of one parameter.
#[derive(Debug, Clone)]
pub struct Setting {
    /// In base units; one cell for a scalar.
    pub cells: Vec<i64>,
    /// As a user writes them, in the usual unit.
    pub shown: Vec<String>,
    /// Where they stand in the file; empty: the family's default.
    pub places: Vec<Place>,
}

/// The signals of a program by the port that each is connected to.
pub type Wiring = BTreeMap<String, String>;

/// One exploration: a system of a specification file under fixed parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// What it shows, with the axes it stands for.
    pub title: String,
    /// The axes it stands for: one, the members of a group, or all axes with the same parameters.
    pub axes: Vec<String>,
    /// The guarantee that it decides; none: what is true of every machine of the family is shown for this one.
    pub guarantee: Option<String>,
    /// What the machine file asks of the system in words of its own, in place of the properties of the family.
    pub asks: Option<Asks>,
    /// The classes of single faults that it answers, in words, where the guarantee must hold after any of them.
    pub faults: Vec<String>,
    /// The specification file.
    pub file: PathBuf,
    /// The system in that file.
    pub system: String,
    /// The length of one cycle of the system in microseconds: the monitoring cycle, where the family says nothing else.
    pub cycle: i64,
    /// A time in microseconds that passes before what it explores begins.
    pub before: i64,
    /// The speed, in base units a minute, at which a bound is told as a way too; 0: at none.
    pub travel: i64,
    /// A way in base units that is added to the one at that speed.
    pub window: i64,
    /// Whether the program is the half of the safe logic in the PLC, alone.
    pub half: bool,
    /// The signals that a program of the machine file has at the ports of the machine it stands for, `OUTSI[3]` or `NOT INSE[1]`.
    pub wiring: Wiring,
    /// Values of the system's parameters; one cell for a scalar. Times in cycles, or in steps.
    pub params: BTreeMap<String, Vec<i64>>,
    /// For each parameter the expression over the values of the file that it was computed from.
    pub sources: BTreeMap<String, String>,
    /// Where the run is coarser than the machine. Empty: exact.
    pub abstractions: Vec<Abstraction>,
}

/// Where a run is coarser than the machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Abstraction {
    /// In words.
    pub text: String,
    /// It is about the values of the parameters alone, which were rounded, scaled, chosen or replaced by their order: no matter for what holds
    /// whatever they are.
    pub of_values: bool,
}

impl Abstraction {
    /// All of them in words.
    pub fn texts(list: &[Self]) -> Vec<&str> {
        list.iter().map(|one| one.text.as_str()).collect()
    }

    pub(crate) fn of_values(text: String) -> Self {
        Self {
            text,
            of_values: true,
        }
    }

    /// One of the system itself, which stands for more than it has.
    pub fn of_system(text: String) -> Self {
        Self {
            text,
            of_values: false,
        }
    }
}

/// What the values of a machine were judged with, for further data of its family.
#[derive(Debug)]
struct Basis {
    family: Family,
    judged: Judged,
    logic: Logic,
}

/// A parameter with its value, for readers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// Its name in the file.
    pub name: String,
    /// The manual's names; empty for what is no machine datum.
    pub manual: String,
    /// What it is, in a few words.
    pub text: String,
    /// The value with its unit, several of an array with commas.
    pub value: String,
    /// Whether the file gives it; else it is the family's default.
    pub given: bool,
}

impl Machine {
    fn parts(&self) -> Parts<'_> {
        Parts {
            axes: &self.axes,
            groups: &self.axis_groups,
            doors: &self.doors,
        }
    }

    /// The folder of the family's data.
    pub fn family_folder(&self) -> &Path {
        &self.basis.family.folder
    }

    /// The files of the family's data that decide what is explored for the machine, beside the specifications.
    pub fn data_files(&self) -> Vec<PathBuf> {
        let asks = !self.guarantees.is_empty();
        let files = [Some(family_file::FILE), asks.then_some(guarantee::FILE)];
        let files = files.into_iter().flatten();
        files.map(|file| self.family_folder().join(file)).collect()
    }

    /// The values of the control, in the order of the family's data.
    pub fn control_shown(&self) -> Vec<Shown> {
        shown(&self.basis.family.control, &self.control)
    }

    /// The values of an axis, in the order of the family's data.
    pub fn axis_shown(&self, axis: &Axis) -> Vec<Shown> {
        shown(&self.basis.family.axis, &axis.values)
    }

    /// The values of a door, in the order of the family's data.
    pub fn door_shown(&self, door: &Door) -> Vec<Shown> {
        shown(&self.basis.family.door, &door.values)
    }

    /// The values of a group, in the order of the family's data.
    pub fn group_shown(&self, group: &Group) -> Vec<Shown> {
        let params = self.basis.family.group.as_ref();
        params.map_or_else(Vec::new, |params| shown(params, &group.values))
    }

    /// The patterns of guarantees that the family has.
    pub fn patterns(&self) -> Vec<&str> {
        let patterns = self.basis.family.patterns.keys();
        patterns.map(String::as_str).collect()
    }

    /// Whether axes of this family have functions to be enabled.
    pub fn has_functions(&self) -> bool {
        !self.basis.family.functions.is_empty()
    }

    /// What a function of an axis is, in words.
    pub fn function_text(&self, name: &str) -> &str {
        let functions = &self.basis.family.functions;
        let found = functions.iter().find(|f| f.name == name);
        found.map_or("", |f| f.text.as_str())
    }
}

fn shown(params: &indexmap::IndexMap<String, Param>, settings: &Settings) -> Vec<Shown> {
    let entry = |(name, param): (&String, &Param)| {
        let setting = settings.get(name)?;
        Some(Shown {
            name: name.clone(),
            manual: param.manual.clone(),
            text: param.text.clone(),
            value: setting.shown.join(", ").replace('"', ""),
            given: setting.is_given(),
        })
    };
    params.iter().filter_map(entry).collect()
}

impl Axis {
    /// Whether a safety function is enabled for it.
    pub fn has(&self, function: &str) -> bool {
        self.functions.iter().any(|name| name == function)
    }
}

impl Group {
    /// Whether the axis belongs to it.
    pub fn has(&self, axis: &str) -> bool {
        self.axes.iter().any(|name| name.get_ref() == axis)
    }
}

impl Door {
    /// Whether the axis can be reached through it.
    pub fn has(&self, axis: &str) -> bool {
        self.axes.iter().any(|name| name.get_ref() == axis)
    }
}

impl Setting {
    /// Whether the machine file gives it.
    pub fn is_given(&self) -> bool {
        !self.places.is_empty()
    }

    fn by_default(param: &Param, kind: AxisKind) -> Self {
        let cells = vec![param.limits(kind).default; param.count.max(1)];
        Self::given(param, kind, cells, Vec::new())
    }

    fn given(param: &Param, kind: AxisKind, cells: Vec<i64>, places: Vec<Place>) -> Self {
        let shown = cells.iter().map(|c| param.show(*c, kind)).collect();
        Self {
            cells,
            shown,
            places,
        }
    }
}

/// The folder with the families for a machine file: the one preferred ([`files::prefer`]); a copy of Stillpoint's sources
/// above the file, where the file of the family is changed there; those that the program carries; else `./spec/families`.
pub fn families(path: &Path) -> PathBuf {
    if let Some(folder) = files::preferred() {
        return folder.to_owned();
    }
    let absolute = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let has_families = |dir: &Path| {
        std::fs::read_dir(dir).is_ok_and(|entries| {
            entries
                .flatten()
                .any(|e| e.path().join("family.toml").is_file())
        })
    };
    for dir in absolute.ancestors().skip(1) {
        for candidate in [dir.to_owned(), dir.join("spec/families")] {
            if has_families(&candidate) {
                return candidate;
            }
        }
    }
    files::built_in().unwrap_or_else(|| PathBuf::from("spec/families"))
}

/// The names of the families in a folder, sorted.
pub fn names(families: &Path) -> Vec<String> {
    family_file::families(families)
}

/// Where the data of a machine's family come from, where it is neither the program nor the folder that the user named: they
/// differ from those that the program carries, and whoever reads its answer must know.
pub fn strange_data(machine: &Machine) -> Option<&Path> {
    let folder = machine.family_folder();
    let root = folder.parent()?;
    let told = files::preferred().is_some() || files::built_in().is_none();
    (!told && !files::is_carried(folder) && !files::same_as_built_in(root, &machine.family))
        .then_some(folder)
}

/// Reads and checks the machine file at `path`; `families` is the folder that holds the families.
///
/// # Errors
/// Everything that is wrong with the file, in its order: unreadable, not TOML, unknown keys, values outside their range
/// or in a wrong unit, names that do not exist, violated plausibility rules.
pub fn load(path: &Path, families: &Path) -> Result<Machine> {
    let source = stillpoint_lang::read_text(path, "machine file")?;
    read_source(path, &source, families)
}

/// [`load`] of bytes that were read already; `path` only names them.
///
/// # Errors
/// As [`load`].
pub fn load_bytes(path: &Path, bytes: Vec<u8>, families: &Path) -> Result<Machine> {
    let source = stillpoint_lang::decode(&path.display().to_string(), bytes, "machine file")?;
    read_source(path, &source, families)
}

fn read_source(path: &Path, source: &Arc<str>, families: &Path) -> Result<Machine> {
    let mut findings = Findings::new(&path.display().to_string(), source);
    let Some(table) = findings.parse(source) else {
        return Err(findings.into_diagnostics());
    };
    let Some(name) = family_name(&table, families, &mut findings) else {
        return Err(findings.into_diagnostics());
    };
    let mut family = family_file::load(&families.join(&name))?;
    let logic = match findings.none() && !family.logic.is_empty() {
        true => Logic::read(&path.display().to_string(), source, &family),
        false => Ok(Logic::default()),
    };
    match &logic {
        Ok(logic) => family.declare(&logic.declared()),
        // Every name of a program that cannot be read would be unknown.
        Err(_) if family.known.signals.are_declared() => {
            findings.take(logic);
            return Err(findings.into_diagnostics());
        }
        Err(_) => {}
    }
    let draft = read::read(&family, &table, &mut findings);
    let judged = plausible::judge(&family, &draft, &mut findings)?;
    let logic = findings.take(logic);
    let (Some(judged), Some(control), Some(logic), true) =
        (judged, draft.control, logic, findings.none())
    else {
        return Err(findings.into_diagnostics());
    };
    let parts = Parts {
        axes: &draft.axes,
        groups: &draft.groups,
        doors: &draft.doors,
    };
    let mut plan = runs::plan(&family, &family.explore, parts, &judged, &logic)?;
    let own = (&*path.display().to_string(), source);
    let guaranteed = runs::guaranteed(&family, own, &draft.guarantees, parts, &judged, &logic)?;
    plan.runs.splice(0..0, guaranteed);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut keys = ["control", "family"].into_iter();
    let place = keys.find_map(|key| Some(table.get_key_value(key)?.0.span()));
    let mut machine = Machine {
        name: draft.name.unwrap_or_else(|| stem.into_owned()),
        title: draft.title.unwrap_or_default(),
        family: name,
        family_title: family.title.clone(),
        monitoring_cycle: judged.cycle,
        not_explored: coverage::not_explored(&family, parts, &plan, &draft.guarantees),
        groups: plan.groups,
        runs: plan.runs,
        basis: Arc::new(Basis {
            family,
            judged,
            logic,
        }),
        control,
        axes: draft.axes,
        axis_groups: draft.groups,
        doors: draft.doors,
        guarantees: draft.guarantees,
        warnings: Vec::new(),
        place: place.unwrap_or(0..0),
    };
    machine.warnings = warnings::judge(&machine, path, source)?;
    Ok(machine)
}

/// The name of the family, when there is such a family.
fn family_name(table: &DeTable<'_>, root: &Path, findings: &mut Findings) -> Option<String> {
    let known = family_file::families(root);
    let list = || known.join(", ");
    let Some(value) = table.get("family") else {
        if let Some(spec) = table.get("spec") {
            findings.add(
                spec.span(),
                "this is a specification file, not a machine file",
                "the key 'spec' makes it one",
                "a machine file starts with: family = \"sinumerik-840d\"",
            );
        } else {
            findings.add(
                None,
                "the key 'family' is missing",
                "",
                format!(
                    "start the file with the family of the control; known: {}",
                    list()
                ),
            );
        }
        return None;
    };
    let name = match value.get_ref() {
        DeValue::String(name) => name.to_string(),
        _ => findings.text("family", value)?,
    };
    if known.contains(&name) {
        return Some(name);
    }
    let help = match nearest(&name, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None if known.is_empty() => format!("no folder in {} holds a family.toml", root.display()),
        None => format!("known families: {} (folders in {})", list(), root.display()),
    };
    findings.add(
        value.span(),
        format!("unknown family \"{name}\""),
        "no such family",
        help,
    );
    None
}
