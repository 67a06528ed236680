//! What is compared with what: machines and systems of the tables that have a monitor, and their parameters.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use stillpoint_engine::subject::Subject;
use stillpoint_lang::Spec;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::files;
use stillpoint_lang::ir::System;

use crate::families;

use super::random::Random;
use super::{DiffError, peer};

/// A machine or system of the specification under the parameters of one or more runs.
#[derive(Debug, Clone)]
pub struct Pairing {
    /// Machine or system.
    pub machine: String,
    /// Several machines together: too many inputs at once to be explored in one piece, see [`super::slices`].
    pub composed: bool,
    /// Inputs that keep one value in an exploration.
    pub held: Vec<(String, i32)>,
    /// The axes these parameters stand for.
    pub axes: Vec<String>,
    /// It with its parameters; every input of a machine is free.
    pub bound: Bound,
}

/// The specification files read so far.
#[derive(Default)]
struct Files(BTreeMap<PathBuf, Spec>);

impl Files {
    fn get(&mut self, path: &Path) -> Result<&Spec, DiffError> {
        if !self.0.contains_key(path) {
            self.0.insert(path.to_owned(), Spec::load(path)?);
        }
        Ok(&self.0[path])
    }
}

/// Every machine and system with a monitor that the subject's runs use, once for each set of parameters. For a machine file
/// also those of its family that no run uses, with their default parameters.
///
/// # Errors
/// A specification that does not load.
pub fn pairings(subject: &Subject) -> Result<Vec<Pairing>, DiffError> {
    let mut out: Vec<Pairing> = Vec::new();
    let mut files = Files::default();
    for (k, task) in subject.tasks.iter().enumerate() {
        let file = match &subject.machine {
            Some(machine) => machine.runs[k].file.clone(),
            None => subject.path.clone(),
        };
        let Some(family) = families::of_table(&task.bound.system.name) else {
            continue;
        };
        let spec = files.get(&file)?;
        for (name, _) in family.peers.machines() {
            let mut instances = task.bound.system.instances.iter();
            if instances.any(|i| i.machine == name) {
                let system = spec.open_machine(name)?;
                let given = parameters_of(&task.bound, &system);
                add(&mut out, name, false, &task.axes, system, given)?;
            }
        }
        for (name, _) in family.peers.systems() {
            if task.bound.system.name.ends_with(&format!("/{name}")) {
                let system = task.bound.system.clone();
                let given = parameters_of(&task.bound, &system);
                add(&mut out, name, true, &task.axes, system, given)?;
            }
        }
    }
    if let Some(folder) = family_folder(subject) {
        add_unused(&mut out, &mut files, &folder)?;
    }
    Ok(out)
}

/// The values that a run gives to the parameters of `system`, by their names.
pub(super) fn parameters_of(run: &Bound, system: &System) -> BTreeMap<String, Vec<i64>> {
    let mut given = BTreeMap::new();
    for param in system.params.iter().filter(|p| p.reading.is_none()) {
        let name = &param.var.name;
        if let Some(k) = run.system.params.iter().position(|p| p.var.name == *name) {
            given.insert(name.clone(), vec![i64::from(run.values[k])]);
        }
    }
    given
}

/// Gives the parameters that the monitor has as constants their values.
fn fix(name: &str, system: &System, given: &mut BTreeMap<String, Vec<i64>>) {
    let family = families::of_table(&system.name);
    let fixed = family.map_or(&[][..], |family| family.peers.fixed);
    for (_, param, value) in fixed.iter().filter(|(machine, ..)| *machine == name) {
        given.insert((*param).to_owned(), vec![*value]);
    }
}

fn add(
    out: &mut Vec<Pairing>,
    name: &str,
    composed: bool,
    axes: &[String],
    system: System,
    mut given: BTreeMap<String, Vec<i64>>,
) -> Result<(), DiffError> {
    fix(name, &system, &mut given);
    let bound = Bound::new(system, &given, &BTreeMap::new())
        .map_err(|e| DiffError::Sides(format!("{name}: {e}")))?;
    let same = |p: &&mut Pairing| p.machine == name && p.bound.values == bound.values;
    match out.iter_mut().find(same) {
        Some(pairing) => {
            for axis in axes {
                if !pairing.axes.contains(axis) {
                    pairing.axes.push(axis.clone());
                }
            }
        }
        None => out.push(Pairing {
            machine: name.to_owned(),
            composed,
            held: Vec::new(),
            axes: axes.to_vec(),
            bound,
        }),
    }
    Ok(())
}

/// The folder with the tables of a machine file's family.
fn family_folder(subject: &Subject) -> Option<PathBuf> {
    let run = subject.machine.as_ref()?.runs.first()?;
    run.file.parent().map(Path::to_owned)
}

/// Adds what has a monitor and is in no run, with default parameters.
fn add_unused(out: &mut Vec<Pairing>, files: &mut Files, folder: &Path) -> Result<(), DiffError> {
    let fault = |e: std::io::Error| DiffError::Sides(format!("{}: {e}", folder.display()));
    let mut paths = files::list(folder).map_err(fault)?;
    paths.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let Some(family) = families::of_table(&name) else {
        return Ok(());
    };
    let machines: Vec<_> = family.peers.machines().collect();
    let systems: Vec<_> = family.peers.systems().collect();
    let kinds = [("machine", &machines[..]), ("system", &systems[..])];
    for path in paths {
        let text = files::read_to_string(&path).map_err(fault)?;
        for (kind, names) in kinds {
            for (name, _) in names {
                let head = format!("[{kind}.{name}]");
                let here = text.lines().any(|line| line.trim_end() == head);
                if !here || out.iter().any(|p| p.machine == *name) {
                    continue;
                }
                let spec = files.get(&path)?;
                let composed = kind == "system";
                let system = match composed {
                    true => spec.system(name, None)?,
                    false => spec.open_machine(name)?,
                };
                add(out, name, composed, &[], system, BTreeMap::new())?;
            }
        }
    }
    Ok(())
}

/// The same with random parameters: small times so that they expire within a run, else any value of the range. None if the
/// draws are contradictory or the monitor refuses them: what it refuses at construction needs no comparison.
pub fn vary(pairing: &Pairing, random: &mut Random) -> Option<Pairing> {
    (0..64).find_map(|_| draw(pairing, random))
}

fn draw(pairing: &Pairing, random: &mut Random) -> Option<Pairing> {
    let system = &pairing.bound.system;
    // In one draw everything is small, so that the sides meet often; in another any width goes.
    let narrow = random.below(2) == 0;
    let mut given: BTreeMap<String, Vec<i64>> = BTreeMap::new();
    for param in system.params.iter().filter(|p| p.reading.is_none()) {
        let name = &param.var.name;
        let lo = pairing.bound.constant(&param.var.lo);
        let hi = pairing.bound.constant(&param.var.hi);
        let time = name.starts_with("t_") || name == "interval";
        let (lo, hi) = match time {
            true if random.below(8) > 0 => (lo, hi.min(lo + 12)),
            false if narrow => (lo.max(-8).min(hi), hi.min(8).max(lo)),
            _ => (lo, hi),
        };
        let value = match random.below(4) {
            0 => lo,
            1 if !time => hi,
            _ => lo + random.below(usize::try_from(hi - lo + 1).unwrap_or(1)) as i64,
        };
        given.insert(name.clone(), vec![value]);
    }
    fix(&pairing.machine, system, &mut given);
    let bound = Bound::new(system.clone(), &given, &BTreeMap::new()).ok()?;
    peer::peer(&pairing.machine, &bound, None).ok()?;
    Some(Pairing {
        bound,
        ..pairing.clone()
    })
}
