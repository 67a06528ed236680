//! The logic that a machine file carries in the specification language: `[logic.NAME]` with the tables of `[machine.NAME]`.
//! It takes the place of the machine of that name in the tables of the family, which must be one that the family lets go.

use std::path::Path;
use std::sync::Arc;

use indexmap::IndexMap;
use serde::Deserialize;
use stillpoint_lang::diag::{Diagnostics, Result, nearest};
use stillpoint_lang::ir::{System, Ty};
use stillpoint_lang::{Spec, Written, toml_error};
use toml::Spanned;

use super::document::Findings;
use super::family::Family;
use super::{Basis, Machine};

/// The machines of a machine file, in its order.
#[derive(Clone, Default)]
pub(super) struct Logic {
    file: String,
    source: Arc<str>,
    machines: Vec<(Spanned<String>, Written)>,
}

impl std::fmt::Debug for Logic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names = self.machines.iter().map(|(name, _)| name.get_ref());
        f.debug_list().entries(names).finish()
    }
}

/// A machine file as far as its logic goes.
#[derive(Deserialize)]
struct File {
    #[serde(default)]
    logic: IndexMap<Spanned<String>, Written>,
}

impl Logic {
    /// Reads the logic of a machine file whose other tables are known to be right, and checks it in the tables of the family.
    ///
    /// # Errors
    /// Everything wrong with it, each with its place in the machine file.
    pub fn read(file: &str, source: &Arc<str>, family: &Family) -> Result<Self> {
        let tables: File = toml::from_str(source).map_err(|e| toml_error(file, source, &e))?;
        let logic = Self {
            file: file.to_owned(),
            source: source.clone(),
            machines: tables.logic.into_iter().collect(),
        };
        let mut findings = Findings::new(file, source);
        let known = || family.logic.keys().map(String::as_str);
        for (name, _) in &logic.machines {
            if !family.logic.contains_key(name.get_ref()) {
                let message = format!("the family has no logic '{}' to replace", name.get_ref());
                let help = match nearest(name.get_ref(), known()) {
                    Some(near) => format!("did you mean '{near}'?"),
                    None => format!(
                        "logic that can stand here: {}",
                        known().collect::<Vec<_>>().join(", ")
                    ),
                };
                findings.add(name.span(), message, "no such logic", help);
            }
        }
        findings.finish(())?;
        let mut errors = Vec::new();
        for (name, machine) in &logic.machines {
            if let Some(slot) = family.logic.get(name.get_ref()) {
                let checked = logic.fits(name.get_ref(), machine, &family.folder.join(&slot.file));
                errors.extend(checked.err().into_iter().flat_map(|e| e.0));
            }
        }
        match errors.is_empty() {
            true => Ok(logic),
            false => Err(Diagnostics(errors)),
        }
    }

    /// Whether the machine is right in itself, and has the outputs of the one it replaces with their types.
    fn fits(&self, name: &str, machine: &Written, path: &Path) -> Result<()> {
        let (old, new) = (
            Spec::load(path)?.open_machine(name)?,
            self.spec(path)?.open_machine(name)?,
        );
        let mut findings = Findings::new(&self.file, &self.source);
        for key in machine.outputs() {
            let full = format!("{name}.{}", key.get_ref());
            let of = |system: &System| {
                let found = system.lazies.iter().find(|l| l.name == full)?;
                Some(type_name(system, found.ty).to_owned())
            };
            if let (Some(was), Some(is)) = (of(&old), of(&new)) {
                if was != is {
                    let message = format!("output '{}' is of type {is}, not {was}", key.get_ref());
                    let help =
                        format!("give it a value of type {was}: the systems of the family read it");
                    findings.add(key.span(), message, "another type", help);
                }
            }
        }
        findings.finish(())
    }

    /// A specification file of the family with this logic in it.
    ///
    /// # Errors
    /// The file cannot be read, or the logic lacks an output of what it replaces.
    pub fn spec(&self, path: &Path) -> Result<Spec> {
        let mut spec = Spec::load(path)?;
        for (name, machine) in &self.machines {
            spec.replace(&self.file, &self.source, name, machine)?;
        }
        Ok(spec)
    }
}

/// A type as the language names it; numbers differ by their ranges only, which are looked at where they are used.
fn type_name(system: &System, ty: Ty) -> &str {
    match ty {
        Ty::Bool => "BOOL",
        Ty::Int => "INT",
        Ty::Enum(e) => system.enums.get(e).map_or("", |e| e.name.as_str()),
    }
}

impl Machine {
    /// A specification file of its family, with the logic of the machine file in the place of the family's own.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn spec(&self, path: &Path) -> Result<Spec> {
        self.basis.logic.spec(path)
    }

    /// The machines of the tables that the machine file replaces by its own logic: name, and what it is.
    pub fn logic(&self) -> impl Iterator<Item = (&str, &str)> {
        let Basis { family, logic, .. } = &*self.basis;
        let slots = logic.machines.iter();
        slots.filter_map(|(name, _)| {
            let slot = family.logic.get(name.get_ref())?;
            Some((name.get_ref().as_str(), slot.text.as_str()))
        })
    }
}
