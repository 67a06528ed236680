//! A machine and its logic: the specification of a run with it, and what is told about it.

use stillpoint_lang::Spec;
use stillpoint_lang::diag::Result;

use super::Logic;
use crate::wired::Program;
use crate::{Basis, Machine, Run, own};

impl Machine {
    /// The specification file of a run, with the logic of the machine file in the place of the family's own.
    ///
    /// # Errors
    /// The file cannot be read, or a program cannot be explored.
    pub fn spec(&self, run: &Run) -> Result<Spec> {
        self.made(run, None)
    }

    /// The same with programs that say less: their times that nothing starts which the run tells them are whatever they may be in each cycle.
    /// With the names of these times; none: there are no such times.
    ///
    /// What such a run does includes all that the run does, so that what holds in each of its paths holds here too.
    ///
    /// # Errors
    /// As [`Machine::spec`].
    pub fn loose_spec(&self, run: &Run) -> Result<Option<(Spec, Vec<String>)>> {
        if run.wiring.is_empty() {
            return Ok(None);
        }
        let mut times = Vec::new();
        let spec = self.made(run, Some(&mut times))?;
        Ok((!times.is_empty()).then_some((spec, times)))
    }

    fn made(&self, run: &Run, loose: Option<&mut Vec<String>>) -> Result<Spec> {
        let Basis { family, logic, .. } = &*self.basis;
        let mut spec = logic.of(run.half).spec(&run.file, &run.wiring, loose)?;
        if let Some(asks) = &run.asks {
            let slots = family.logic.iter();
            let slots = slots.flat_map(|(name, slot)| [Some(name), slot.plc.as_ref()]);
            let slots: Vec<&str> = slots.flatten().map(String::as_str).collect();
            let names = logic.names(&spec, &run.system, &run.wiring, &slots);
            own::ask(&mut spec, &run.system, asks, &names, logic)?;
        }
        Ok(spec)
    }

    /// The times that programs of the machine have as parameters of the systems they take part in: name, and length in microseconds.
    pub fn logic_times(&self) -> impl Iterator<Item = &(String, u64)> {
        let parts = self.basis.logic.machines.iter();
        parts.flat_map(|(_, part)| &part.durations)
    }

    /// The program that a logic is: its name, and that of its file.
    pub(crate) fn program(&self, logic: &str) -> Option<&str> {
        let Logic {
            machines, wired, ..
        } = &self.basis.logic;
        let parts = machines.iter().filter(|(name, _)| name.get_ref() == logic);
        let mut tables = parts.filter_map(|(_, part)| part.program.as_deref());
        let mut wired = wired.iter().filter(|w| w.name.get_ref() == logic);
        tables
            .next()
            .or_else(|| wired.next().map(|w| w.file.as_str()))
    }

    /// Logic that guarantees depend on and that the machine file does not have, with what is assumed of it.
    pub(crate) fn logic_missing(&self) -> impl Iterator<Item = String> + '_ {
        let Basis { family, logic, .. } = &*self.basis;
        let asked = self.runs.iter().any(|run| run.guarantee.is_some());
        let slots = family.logic.iter().filter(move |_| asked);
        slots.filter_map(|(name, slot)| {
            let known = logic.wired.iter().any(|w| w.name.get_ref() == name);
            let known = known || logic.machines.iter().any(|(n, _)| n.get_ref() == name);
            let text = slot.missing.as_ref().filter(|_| !known)?;
            Some(format!("Logic {name} is not in the file: {text}."))
        })
    }

    /// Guarantees that hold after a fault that may take the program of the machine file, which has no other half: what is assumed of that,
    /// and their names.
    pub(crate) fn half_missing(&self) -> Option<(&str, Vec<&str>)> {
        let Basis { family, logic, .. } = &*self.basis;
        let mut slots = family.logic.iter().filter(|_| logic.half.is_none());
        let half = slots.find_map(|(name, slot)| {
            let known = logic.wired.iter().any(|w| w.name.get_ref() == name);
            slot.half.as_ref().filter(|_| known)
        })?;
        let taken: Vec<&str> = family
            .faults
            .values()
            .filter(|fault| fault.takes_half)
            .map(|fault| fault.text.as_str())
            .collect();
        let taken = |run: &Run| run.faults.iter().any(|text| taken.contains(&text.as_str()));
        let asked = |name: &str| {
            let mut runs = self
                .runs
                .iter()
                .filter(|run| run.guarantee.as_deref() == Some(name));
            runs.any(|run| !run.wiring.is_empty() && taken(run))
        };
        let names = self.guarantees.iter().map(|g| g.name.as_str());
        let names: Vec<&str> = names.filter(|name| asked(name)).collect();
        (!names.is_empty()).then_some((half.missing.as_str(), names))
    }

    /// What is worth telling of programs that are right, each with its line.
    pub(crate) fn logic_notes(&self) -> impl Iterator<Item = String> + '_ {
        self.basis.logic.wired.iter().flat_map(|wired| {
            let notes = match &wired.program {
                Program::Spf(program) => program.notes(),
                Program::Stl(_) | Program::St(_) => &[],
            };
            notes.iter().map(|note| format!("{}, {note}.", wired.file))
        })
    }

    /// The machines of the tables that the machine file replaces by its own logic: name, and what it is.
    pub fn logic(&self) -> impl Iterator<Item = (&str, &str)> {
        let Basis { family, logic, .. } = &*self.basis;
        let names = logic.machines.iter().map(|(name, _)| name);
        let names = names.chain(logic.wired.iter().map(|w| &w.name));
        names.filter_map(|name| {
            let slot = family.logic.get(name.get_ref());
            let text = match slot {
                Some(slot) => slot.text.as_str(),
                None => {
                    let mut slots = family.logic.values();
                    slots.find(|slot| slot.plc.as_ref() == Some(name.get_ref()))?;
                    "its half in the PLC"
                }
            };
            Some((name.get_ref().as_str(), text))
        })
    }
}
