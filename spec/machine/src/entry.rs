//! What the entries of a family's further data (reaction chains, acceptance tests) have in common: when and how often one
//! stands for a subject, and the formulas and texts in it.

use indexmap::IndexMap;
use toml::Spanned;

use super::family::{Family, Formula};
use super::family_file::Check;
use super::ground::{About, DataFile, Ground, Subjects};
use super::guarantee::About as Named;
use super::template::{Template, Words};
use stillpoint_lang::diag::Result;

/// When an entry stands for a subject, for which `k`, and the names that it adds to the values there.
#[derive(Debug)]
pub(super) struct Premise {
    pub of: About,
    /// The patterns of the guarantees that it is about.
    patterns: Vec<String>,
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
        patterns: Vec<Spanned<String>>,
        each: Vec<i64>,
        when: Spanned<String>,
        lets: IndexMap<String, Spanned<String>>,
    ) -> Option<(Self, Vec<String>)> {
        let mut known = of.known(family);
        known.extend(arguments(check, family, of, &patterns, when.span())?);
        let when = check.formula(when, &known)?;
        let mut formulas = Vec::new();
        for (name, text) in lets {
            let formula = check.formula(text, &known)?;
            known.push(name.clone());
            formulas.push((name, formula));
        }
        let premise = Self {
            of,
            patterns: patterns.into_iter().map(Spanned::into_inner).collect(),
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
    pub fn grounds<'a>(
        &self,
        file: &DataFile,
        subjects: &mut Subjects<'a>,
    ) -> Result<Vec<Ground<'a>>> {
        let mut list = Vec::new();
        let of_pattern = |subject: &&mut Ground<'_>| {
            let guarantee = subject.guarantee;
            guarantee.is_none_or(|g| self.patterns.contains(&g.pattern))
        };
        for subject in subjects.about(self.of).filter(of_pattern) {
            for k in &self.each {
                subject.count_to(*k);
                if subject.value(file, &self.when)? == 0 {
                    continue;
                }
                let mut ground = subject.clone();
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

/// The names that all patterns have which an entry about guarantees names: their arguments, and of patterns about doors the values of
/// a door. `None` leaves a finding.
fn arguments(
    check: &mut Check,
    family: &Family,
    of: About,
    patterns: &[Spanned<String>],
    place: super::Place,
) -> Option<Vec<String>> {
    if (of == About::Guarantee) == patterns.is_empty() {
        let message = "`patterns` stands where an entry is about guarantees, and only there";
        let help = "write of = \"guarantee\" and patterns = [\"...\"], or neither";
        check.findings.add(place, message, "this entry", help);
        return None;
    }
    let mut common: Option<Vec<String>> = None;
    for name in patterns {
        let Some(pattern) = family.patterns.get(name.get_ref()) else {
            let known: Vec<&str> = family.patterns.keys().map(String::as_str).collect();
            let message = format!("\"{}\" is no pattern of guarantees", name.get_ref());
            let help = format!("patterns of this family: {}", known.join(", "));
            check
                .findings
                .add(name.span(), message, "no such pattern", help);
            return None;
        };
        let of_door = family.door.keys().filter(|_| pattern.about == Named::Door);
        let names: Vec<&String> = pattern.arguments.keys().chain(of_door).collect();
        common = Some(match common {
            None => names.into_iter().cloned().collect(),
            Some(known) => (known.into_iter().filter(|n| names.contains(&n))).collect(),
        });
    }
    Some(common.unwrap_or_default())
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
