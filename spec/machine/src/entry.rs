//! What the entries of a family's further data (reaction chains, acceptance tests) have in common: when and how often one
//! stands for a subject, and the formulas and texts in it.

use indexmap::IndexMap;
use toml::Spanned;

use super::Machine;
use super::family::{Family, Formula};
use super::family_file::Check;
use super::ground::{About, DataFile, Ground, grounds};
use super::template::{Template, Words};
use stillpoint_lang::diag::Result;

/// When an entry stands for a subject, for which `k`, and the names that it adds to the values there.
#[derive(Debug)]
pub(super) struct Premise {
    pub of: About,
    each: Vec<i64>,
    pub when: Formula,
    pub lets: Vec<(String, Formula)>,
}

impl Premise {
    /// Checks the keys `of`, `each`, `when` and `let` of an entry; with the names that its formulas and texts may read.
    /// `None` leaves a finding.
    pub fn read(
        check: &mut Check,
        family: &Family,
        of: About,
        each: Vec<i64>,
        when: Spanned<String>,
        lets: IndexMap<String, Spanned<String>>,
    ) -> Option<(Self, Vec<String>)> {
        let mut known = of.known(family);
        let when = check.formula(when, &known)?;
        let mut formulas = Vec::new();
        for (name, text) in lets {
            let formula = check.formula(text, &known)?;
            known.push(name.clone());
            formulas.push((name, formula));
        }
        let premise = Self {
            of,
            each: if each.is_empty() { vec![0] } else { each },
            when,
            lets: formulas,
        };
        Some((premise, known))
    }

    /// The subjects that the entry stands for, with the names it adds; for each of them all values of `k`.
    ///
    /// # Errors
    /// A formula without a value, which is a fault of the family's data.
    pub fn grounds<'a>(&self, file: &DataFile, machine: &'a Machine) -> Result<Vec<Ground<'a>>> {
        let mut list = Vec::new();
        for subject in grounds(machine, self.of) {
            for k in &self.each {
                let mut ground = subject.at(*k);
                if ground.value(file, &self.when)? == 0 {
                    continue;
                }
                for (name, formula) in &self.lets {
                    let value = ground.value(file, formula)?;
                    ground.set(name, value);
                }
                list.push(ground);
            }
        }
        Ok(list)
    }
}

/// Reads the formulas and texts of one entry; `None` leaves a finding.
pub(super) struct Reader<'a> {
    pub check: &'a mut Check,
    pub names: &'a Words<'a>,
}

impl Reader<'_> {
    /// A text that must be there.
    pub fn text(&mut self, text: Spanned<String>) -> Option<Template> {
        Template::parse(text, self.names, &mut self.check.findings)
    }

    /// A list of texts.
    pub fn texts(&mut self, list: Vec<Spanned<String>>) -> Option<Vec<Template>> {
        list.into_iter().map(|text| self.text(text)).collect()
    }

    /// A text that may be missing.
    pub fn optional(&mut self, text: Option<Spanned<String>>) -> Option<Option<Template>> {
        match text {
            Some(text) => self.text(text).map(Some),
            None => Some(None),
        }
    }

    /// A formula that may be missing.
    pub fn formula(&mut self, text: Option<Spanned<String>>) -> Option<Option<Formula>> {
        match text {
            Some(text) => self.check.formula(text, self.names.known).map(Some),
            None => Some(None),
        }
    }
}
