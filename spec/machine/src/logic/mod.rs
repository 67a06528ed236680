//! The logic of a machine file: `[logic.NAME]` with the tables of `[machine.NAME]`, or with the key `source` that names a program
//! beside the machine file, and `plc` that names the half of it in a PLC. It takes the place of the machine of that name in the tables of the family, which must be
//! one that the family lets go.

mod machine;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use indexmap::IndexMap;
use serde::Deserialize;
use stillpoint_lang::diag::{Diagnostic, Diagnostics, Result, nearest};
use stillpoint_lang::ir::{System, Ty};
use stillpoint_lang::{Spec, Written, read_text, toml_error};
use stillpoint_logic::st::{Signature, compile};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::document::Findings;
use super::family::{Family, Half, Language, Slot};
use super::own::Own;
use super::wired::{Program, Times, Wired};
use super::{Place, Wiring, own};

/// The machines of a machine file, in its order.
#[derive(Clone, Default)]
pub(super) struct Logic {
    file: String,
    source: Arc<str>,
    machines: Vec<(Spanned<String>, Definition)>,
    /// Programs whose signals each run connects.
    wired: Vec<Wired>,
    /// The same logic after its half in the NCK is gone: that in the PLC stands in its place.
    half: Option<Box<Logic>>,
}

/// One machine, and the file that it was written in.
#[derive(Clone)]
struct Definition {
    machine: Written,
    file: String,
    source: Arc<str>,
    /// A program in Structured Text: its name, and that of its file.
    program: Option<String>,
    /// Times of a program, which each run has in its own cycles: name, and length in microseconds.
    durations: Vec<(String, u64)>,
}

impl std::fmt::Debug for Logic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names = self.machines.iter().map(|(name, _)| name.get_ref());
        let names = names.chain(self.wired.iter().map(|w| w.name.get_ref()));
        f.debug_list().entries(names).finish()
    }
}

/// A machine file as far as its logic goes.
#[derive(Deserialize)]
struct File {
    #[serde(default)]
    logic: IndexMap<Spanned<String>, Written>,
}

/// A logic that stands in a file of its own.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Elsewhere {
    source: Spanned<String>,
    /// The half of it that stands in the PLC.
    plc: Option<Spanned<String>>,
    #[serde(default)]
    #[allow(dead_code)] // a comment for readers of the file
    text: String,
}

impl Logic {
    /// Reads the logic of a machine file whose other tables are known to be right, and checks it in the tables of the family.
    ///
    /// # Errors
    /// Everything wrong with it, each with its place in the machine file.
    pub fn read(file: &str, source: &Arc<str>, family: &Family) -> Result<Self> {
        let wrong = |e: &toml::de::Error| toml_error(file, source, e);
        let (mut root, mut programs) = (DeTable::parse(source).map_err(|e| wrong(&e))?, Vec::new());
        if let Some(DeValue::Table(tables)) = root.get_mut().get_mut("logic").map(Spanned::get_mut)
        {
            let named =
                |table: &DeValue<'_>| table.as_table().is_some_and(|t| t.contains_key("source"));
            let names: Vec<_> = tables
                .iter()
                .filter(|(_, table)| named(table.get_ref()))
                .map(|(name, _)| name.clone())
                .collect();
            for key in names {
                let name = Spanned::new(key.span(), key.get_ref().to_string());
                if let Some(DeValue::Table(table)) = tables.remove(&key).map(Spanned::into_inner) {
                    let table = Deserializer::from(Spanned::new(key.span(), table));
                    programs.push((name, Elsewhere::deserialize(table).map_err(|e| wrong(&e))?));
                }
            }
        }
        let tables = File::deserialize(Deserializer::from(root)).map_err(|e| wrong(&e))?;
        let here = |machine| Definition {
            machine,
            file: file.to_owned(),
            source: source.clone(),
            program: None,
            durations: Vec::new(),
        };
        let mut logic = Self {
            file: file.to_owned(),
            source: source.clone(),
            machines: tables
                .logic
                .into_iter()
                .map(|(name, machine)| (name, here(machine)))
                .collect(),
            wired: Vec::new(),
            half: None,
        };
        let mut findings = Findings::new(file, source);
        let known = || family.logic.keys().map(String::as_str);
        let names = logic.machines.iter().map(|(name, _)| name);
        for name in names.chain(programs.iter().map(|(name, _)| name)) {
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
        let mut all =
            |checked: Result<()>| errors.extend(checked.err().into_iter().flat_map(|e| e.0));
        for (name, program) in programs {
            if let Some(slot) = family.logic.get(name.get_ref()) {
                all(logic.take(name, &program, slot, &family.folder.join(&slot.file)));
            }
        }
        for (name, machine) in &logic.machines {
            if let Some(slot) = family.logic.get(name.get_ref()) {
                all(logic.fits(name.get_ref(), machine, &family.folder.join(&slot.file)));
            }
        }
        logic.half = logic.halved(family).map(Box::new);
        match errors.is_empty() {
            true => Ok(logic),
            false => Err(Diagnostics(errors)),
        }
    }

    /// The programs in the PLC in the places of the others.
    fn halved(&self, family: &Family) -> Option<Self> {
        let place = |wired: &Wired| {
            let mut slots = family.logic.iter();
            let of = |slot: &Slot| {
                slot.half.is_some() && slot.plc.as_ref() == Some(wired.name.get_ref())
            };
            let (name, _) = slots.find(|(_, slot)| of(slot))?;
            let name = Spanned::new(wired.name.span(), name.clone());
            Some(Wired {
                name,
                ..wired.clone()
            })
        };
        let wired: Vec<Wired> = self.wired.iter().filter_map(place).collect();
        (!wired.is_empty()).then(|| Self {
            wired,
            half: None,
            ..self.clone()
        })
    }

    /// The logic that a run is made with: as it is, or its half in the PLC alone.
    pub fn of(&self, half: bool) -> &Self {
        self.half.as_deref().filter(|_| half).unwrap_or(self)
    }

    /// What the half of the PLC has of an axis, where the file has such a half and these machines are those of the other one alone.
    pub fn half<'f>(&self, family: &'f Family, machines: &[String]) -> Option<(&Self, &'f Half)> {
        let logic = self.half.as_deref()?;
        let mut slots = family
            .logic
            .iter()
            .filter(|(name, _)| machines.contains(name));
        let (_, slot) =
            slots.find(|(name, _)| logic.wired.iter().any(|w| w.name.get_ref() == *name))?;
        let both = slot.plc.as_ref().is_some_and(|plc| machines.contains(plc));
        Some((logic, slot.half.as_ref().filter(|_| !both)?))
    }

    /// Whether a program gives this signal of it, `DB31.DBX22.1` or `OUTSI[3]`.
    pub fn gives(&self, signal: &str) -> bool {
        self.wired.iter().any(|wired| wired.gives(signal))
    }

    /// Reads a program that stands beside the machine file, and translates it where its signals are known.
    fn take(
        &mut self,
        name: Spanned<String>,
        program: &Elsewhere,
        slot: &Slot,
        tables: &Path,
    ) -> Result<()> {
        if let Some(half) = &program.plc {
            let Some(machine) = &slot.plc else {
                let message = format!("the logic '{}' has no half in a PLC", name.get_ref());
                let fault = self.fault(Some(half.span()), message).label("no such half");
                return Err(fault.help("leave `plc` out").into());
            };
            let (file, source) = self.beside(half, "plc", Language::StatementList)?;
            let name = Spanned::new(half.span(), machine.clone());
            self.wired.push(Wired::stl(name, file, source)?);
        }
        let (file, source) = self.beside(&program.source, "source", slot.language)?;
        match slot.language {
            Language::SafeSpf => {
                self.wired.push(Wired::spf(name, file, source)?);
                return Ok(());
            }
            Language::StatementList => {
                self.wired.push(Wired::stl(name, file, source)?);
                return Ok(());
            }
            Language::Named => {
                self.wired.push(Wired::st(name, file, source)?);
                return Ok(());
            }
            Language::StructuredText => {}
        }
        let spec = Spec::load(tables)?;
        let signature = Signature::of(&spec, name.get_ref())?;
        let compiled = compile(&file, &source, &signature)?;
        let definition = Definition {
            machine: compiled.machine,
            file,
            source,
            program: Some(format!("{} of {}", compiled.name, program.source.get_ref())),
            durations: compiled.durations,
        };
        self.machines.push((name, definition));
        Ok(())
    }

    /// The text of a program that a key of the machine file names.
    fn beside(
        &self,
        named: &Spanned<String>,
        key: &str,
        language: Language,
    ) -> Result<(String, Arc<str>)> {
        let beside = Path::new(&self.file).parent().unwrap_or(Path::new(""));
        let path: PathBuf = beside.join(named.get_ref());
        let what = match language {
            Language::StructuredText | Language::Named => "program in Structured Text",
            Language::SafeSpf => "program SAFE.SPF",
            Language::StatementList => "statement list",
        };
        let source = read_text(&path, what).map_err(|Diagnostics(list)| {
            let told = |d: Diagnostic| {
                self.fault(Some(named.span()), d.to_string())
                    .label("named here")
                    .help(format!(
                        "`{key}` names a {what}, relative to the machine file"
                    ))
            };
            Diagnostics(list.into_iter().map(told).collect())
        })?;
        Ok((path.display().to_string(), source))
    }

    /// The times of the programs that take part in a system with these machines.
    pub fn durations(&self, machines: &[String]) -> impl Iterator<Item = &(String, u64)> {
        let parts = self
            .machines
            .iter()
            .filter(|(name, _)| machines.contains(name.get_ref()));
        parts.flat_map(|(_, part)| &part.durations)
    }

    /// Whether the machine is right in itself, and has the outputs of the one it replaces with their types.
    fn fits(&self, name: &str, written: &Definition, path: &Path) -> Result<()> {
        let (old, new) = (
            Spec::load(path)?.open_machine(name)?,
            self.spec(path, &Wiring::new(), None)?.open_machine(name)?,
        );
        let mut findings = Findings::new(&written.file, &written.source);
        for key in written.machine.outputs() {
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

    /// Whether a program whose signals a run connects takes the place of one of these machines.
    pub fn takes(&self, machines: &[String]) -> bool {
        self.wired
            .iter()
            .any(|w| machines.contains(w.name.get_ref()))
    }

    /// Whether one of these machines is a half in a PLC that no program takes the place of.
    pub fn lacks_half(&self, family: &Family, machines: &[String]) -> bool {
        let halves = family.logic.values().filter_map(|slot| slot.plc.as_ref());
        let mut halves = halves.filter(|half| machines.contains(half));
        halves.any(|half| !self.wired.iter().any(|w| w.name.get_ref() == half))
    }

    /// Whether there is such a program.
    pub fn is_programmed(&self) -> bool {
        !self.wired.is_empty()
    }

    /// What programs declare by names of their own: each name, and whether it is an output.
    pub fn declared(&self) -> Vec<(String, bool)> {
        let programs = self.wired.iter().map(|wired| &wired.program);
        let declared = programs.filter_map(|program| match program {
            Program::St(program) => Some(program.signals()),
            Program::Spf(_) | Program::Stl(_) => None,
        });
        let declared = declared.flatten();
        declared.map(|signal| (signal.name, signal.given)).collect()
    }

    /// The signals of all programs by all their names: the variable, and whether a program gives it.
    pub fn signals(&self) -> BTreeMap<String, (String, bool)> {
        let all = self.wired.iter().flat_map(Wired::signals);
        all.collect()
    }

    /// An input of a program, for messages.
    pub fn example(&self) -> String {
        let declared = self.declared().into_iter();
        let mut inputs = declared.filter(|(_, given)| !given);
        inputs.next().map_or("INSE[1]".to_owned(), |(name, _)| name)
    }

    /// Whether such a program is told something through this port.
    pub fn is_told(&self, spec: &Spec, port: &str) -> bool {
        self.wired.iter().any(|w| w.is_told(spec, port))
    }

    /// The times of such programs in a specification file with these signals.
    ///
    /// # Errors
    /// A program cannot be explored.
    pub fn times(&self, spec: &Spec, wiring: &Wiring) -> Result<Times> {
        let mut times = Times::default();
        for wired in self.wired.iter().filter(|w| w.takes_part(spec)) {
            let durations = wired.compiled(spec, wiring, false)?.durations;
            match wired.program {
                Program::Spf(_) => times.scanned.extend(durations),
                Program::Stl(_) | Program::St(_) => times.running.extend(durations),
            }
        }
        Ok(times)
    }

    /// The signals of a question in words of the file, at the ports of the machine of the specification file that a program in numbered
    /// signals stands for.
    ///
    /// # Errors
    /// More signals than ports.
    pub fn shown(&self, spec: &Spec, own: &Own, place: &Place) -> Result<Wiring> {
        let Some(wired) = self.wired.iter().find(|w| w.takes_part(spec)) else {
            return Ok(Wiring::new());
        };
        let used = own::used(own, &wired.signals());
        wired.shown(spec, &used).ok_or_else(|| {
            let message = format!(
                "guarantee {}: {} signals are too many for one question",
                own.name,
                used.len()
            );
            let found = self
                .fault(Some(place.clone()), message)
                .label("this guarantee");
            found
                .help("ask two questions, or let the program give a marker of some of them")
                .into()
        })
    }

    /// What the signals of the logic are called in a system: those of a program as it names them, else the inputs, outputs and
    /// states of the machine of the tables.
    fn names(
        &self,
        spec: &Spec,
        system: &str,
        wiring: &Wiring,
        slots: &[&str],
    ) -> BTreeMap<String, String> {
        let outline = spec.outline();
        let parts = outline.systems.iter().find(|s| s.name == system);
        let parts = parts.map_or(&[][..], |s| &s.instances);
        let mut names = BTreeMap::new();
        for (instance, machine) in parts.iter().filter(|(_, m)| slots.contains(&m.as_str())) {
            let mut add =
                |name: String, port: &str| names.insert(name, format!("{instance}.{port}"));
            let wired = self.wired.iter().find(|w| w.name.get_ref() == machine);
            match (wired, outline.machines.iter().find(|m| m.name == *machine)) {
                (Some(wired), _) => {
                    for (name, (variable, _)) in wired.signals() {
                        let port = wiring.iter().find(|(_, signal)| **signal == variable);
                        if let Some((port, _)) = port {
                            add(name, port);
                        }
                    }
                }
                (None, Some(machine)) => {
                    let ports = machine.inputs.iter().chain(&machine.states);
                    let outputs = machine.outputs.iter().map(|output| &output.name);
                    for name in ports.map(|port| &port.name).chain(outputs) {
                        add(name.clone(), name);
                    }
                }
                (None, None) => {}
            }
        }
        names
    }

    /// A fault of the machine file.
    pub fn fault(&self, place: Option<Place>, message: String) -> Diagnostic {
        Diagnostic::new(&self.file, &self.source, place, message)
    }

    /// A specification file of the family with this logic in it, the signals of programs connected so. Where the times of programs that
    /// may be loose are asked for, they are, and named there.
    ///
    /// # Errors
    /// The file cannot be read, or the logic lacks an output of what it replaces.
    pub fn spec(
        &self,
        path: &Path,
        wiring: &Wiring,
        mut loose: Option<&mut Vec<String>>,
    ) -> Result<Spec> {
        let mut spec = Spec::load(path)?;
        let wired = self.wired.iter().filter(|_| !wiring.is_empty());
        let wired: Vec<&Wired> = wired.filter(|w| w.takes_part(&spec)).collect();
        for wired in wired {
            let compiled = wired.compiled(&spec, wiring, loose.is_some())?;
            spec.replace(&wired.file, &wired.source, &wired.name, &compiled.machine)?;
            if let Some(loose) = &mut loose {
                loose.extend(compiled.loose);
            }
        }
        for (name, machine) in &self.machines {
            spec.replace(&machine.file, &machine.source, name, &machine.machine)?;
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
