//! Theorems of a family: properties of its tables that hold for every value of their parameters, of the ranges and under the conditions
//! that stand beside them. They are shown once, by the proof engines, and stand in the family's `theorems.toml`; a check of a machine cites them.
//!
//! A theorem belongs to its tables: a fingerprint of all that decides it stands beside it. Where one rule, range or expression is another
//! one, the theorem is none, and the property is explored.

use std::collections::BTreeMap;
use std::hash::Hash;
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::Condition;
use stillpoint_lang::diag::{Diagnostic, Result};
use stillpoint_lang::ir::{Property, Stated, System, Ty};
use stillpoint_lang::{files, toml_error};
use stillpoint_model::{Judgement, Verdict};

use crate::digest::All;
use crate::outcome::{Outcome, label, undecided};
use crate::subject::Task;

/// The file in a family's folder.
pub const FILE: &str = "theorems.toml";

/// What stands there for the ranges of all assignments, in the place of a property.
pub const RANGE: &str = "range";

/// The theorems of a family.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Theorems {
    /// By the name of the system.
    #[serde(default, rename = "system")]
    pub systems: BTreeMap<String, OfSystem>,
}

/// The theorems about one system.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OfSystem {
    /// The specification file, in the family's folder.
    pub file: String,
    /// The options of readings that were chosen.
    #[serde(default)]
    pub readings: BTreeMap<String, String>,
    /// What was found, first over the widest ranges.
    #[serde(default)]
    pub proved: Vec<Proved>,
    /// By the label of a property the fingerprint of what decides it, where the engines have not proved it.
    #[serde(default)]
    pub open: BTreeMap<String, String>,
}

/// What was found for every value of some ranges.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Proved {
    /// The parameters with their ranges, and how many configurations these are.
    pub every: String,
    /// Parameters of which not the whole documented range is meant: least and greatest value.
    #[serde(default)]
    pub within: BTreeMap<String, (i64, i64)>,
    /// What the values satisfy that are meant.
    #[serde(default, rename = "where")]
    pub conditions: Vec<String>,
    /// Wall time of all proofs, in seconds.
    pub seconds: f64,
    /// By the label of a property the fingerprint of what decides it.
    #[serde(default)]
    pub holds: BTreeMap<String, String>,
    /// By the label of a property values for which it does not hold.
    #[serde(default)]
    pub fails: BTreeMap<String, Failing>,
}

/// A configuration in which a property does not hold.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Failing {
    /// The length of a shortest run that breaks it.
    pub cycles: u64,
    /// The values of the parameters that it depends on, by their names.
    pub with: BTreeMap<String, String>,
}

impl Proved {
    /// The labels of the properties of which something was found.
    pub fn found(&self) -> impl Iterator<Item = &String> {
        self.holds.keys().chain(self.fails.keys())
    }

    /// Whether these are all values that are documented.
    fn is_whole(&self) -> bool {
        self.within.is_empty() && self.conditions.is_empty()
    }

    /// Whether the values of a system are among these.
    fn covers(&self, bound: &Bound) -> bool {
        let params = bound.system.params.iter().zip(&bound.values);
        let mut named = params.filter(|(p, _)| p.reading.is_none());
        let inside = named.all(|(param, value)| {
            let name = param.var.array();
            let within = self.within.get(name);
            within.is_none_or(|(lo, hi)| (*lo..=*hi).contains(&i64::from(*value)))
        });
        let value = |k: usize| bound.values.get(k).copied().map_or(0, i64::from);
        let mut conditions = self.conditions.iter();
        inside
            && conditions.all(|text| {
                Condition::read(&bound.system, text).is_ok_and(|condition| condition.holds(value))
            })
    }
}

impl Theorems {
    /// Reads the theorems of the family in `folder`; none if it has no such file.
    ///
    /// # Errors
    /// A file that cannot be read or is not of this form.
    pub fn load(folder: &Path) -> Result<Self> {
        let path = folder.join(FILE);
        if !files::is_file(&path) {
            return Ok(Self::default());
        }
        let name = path.display().to_string();
        let text = files::read_to_string(&path).map_err(|e| {
            Diagnostic::new(&name, &Arc::from(""), None, format!("cannot be read: {e}"))
                .help("write it anew: stillpoint theorems FAMILY --prove")
        })?;
        toml::from_str(&text).map_err(|e| toml_error(&name, &Arc::from(text), &e).into())
    }

    /// What of a system with these values is a theorem.
    pub fn of(&self, bound: &Bound) -> Known {
        let system = &bound.system;
        let Some(known) = self.systems.get(&system.name) else {
            return Known::default();
        };
        if bound.readings().into_iter().collect::<BTreeMap<_, _>>() != known.readings {
            return Known::default();
        }
        let tables = tables(system);
        let covering: Vec<&Proved> = known.proved.iter().filter(|p| p.covers(bound)).collect();
        // Whether it holds whatever the values are, if it is a theorem for these.
        let holds = |label: &str, property| -> Option<bool> {
            let own = covering.iter();
            let mut own = own
                .filter_map(|proved| Some((proved.is_whole(), proved.holds.get(label)?)))
                .peekable();
            own.peek()?;
            let print = fingerprint(&tables, system, property);
            own.filter_map(|(whole, own)| (*own == print).then_some(whole))
                .max()
        };
        let properties = system.properties.iter().enumerate();
        let cited = properties.filter(|(_, property)| property.stated == Stated::default());
        let cited: Vec<(usize, bool)> = cited
            .filter_map(|(k, property)| Some((k, holds(&label(property), Some(property))?)))
            .collect();
        let range = holds(RANGE, None);
        Known {
            range: range.is_some(),
            everywhere: range == Some(true) && cited.iter().all(|(_, whole)| *whole),
            properties: cited.into_iter().map(|(k, _)| k).collect(),
        }
    }
}

/// What of a system with its values is a theorem.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Known {
    /// The numbers of its properties that are.
    pub properties: Vec<usize>,
    /// It is one too that no value leaves its range.
    pub range: bool,
    /// All of that holds for the whole ranges of the parameters without a condition: what these values are is no matter.
    pub everywhere: bool,
}

/// What of a task need not be asked, as it is known.
pub struct Cited {
    /// Its properties that are theorems, by number.
    pub properties: Vec<usize>,
    /// Whether there is nothing else to be known about it.
    pub all: bool,
    /// Whether there is not, and all of it holds for the whole ranges of the parameters.
    pub everywhere: bool,
    /// All properties of the task, while some are taken out.
    whole: Vec<Property>,
}

impl Cited {
    /// Takes out of a task what is known of it; its own guarantees never are.
    pub fn take(theorems: Option<&Theorems>, task: &mut Task) -> Self {
        let own = task.guarantee.is_some() || task.loose.is_some();
        let known = theorems.filter(|_| !own).map(|all| all.of(&task.bound));
        let Known {
            properties,
            range,
            everywhere,
        } = known.unwrap_or_default();
        let list = &mut task.bound.system.properties;
        let all = range && !list.is_empty() && properties.len() == list.len();
        let mut whole = Vec::new();
        if !properties.is_empty() {
            let numbered = list.iter().enumerate();
            let left = numbered.filter(|(k, _)| properties.binary_search(k).is_err());
            let left = left.map(|(_, property)| property.clone()).collect();
            whole = std::mem::replace(list, left);
        }
        Cited {
            properties,
            all,
            everywhere: all && everywhere,
            whole,
        }
    }

    /// Puts back what was taken out, with its verdict.
    pub fn put_back(&mut self, task: &mut Task, outcome: &mut Outcome) {
        if self.properties.is_empty() {
            return;
        }
        let whole = std::mem::take(&mut self.whole);
        let known = |k: &usize| self.properties.binary_search(k).is_ok();
        let left: Vec<usize> = (0..whole.len()).filter(|k| !known(k)).collect();
        let place = |k: &usize| left.get(*k).copied().unwrap_or(*k);
        outcome.pairs = std::mem::take(&mut outcome.pairs)
            .into_iter()
            .map(|(k, pair)| (place(&k), pair))
            .collect();
        outcome.refuted = std::mem::take(&mut outcome.refuted)
            .into_iter()
            .map(|(k, why)| (place(&k), why))
            .collect();
        let mut judged = std::mem::take(&mut outcome.report.properties).into_iter();
        let all = whole.iter().enumerate().map(|(k, property)| {
            let other = if known(&k) { None } else { judged.next() };
            other.unwrap_or_else(|| Judgement {
                verdict: if known(&k) {
                    Verdict::Holds
                } else {
                    Verdict::Inconclusive
                },
                ..undecided(property)
            })
        });
        outcome.report.properties = all.collect();
        task.bound.system.properties = whole;
    }
}

/// Stands for all that decides what a system does, whatever the values of its parameters.
pub struct Tables([u8; 32]);

/// What decides what a system does.
pub fn tables(system: &System) -> Tables {
    let mut all = All::default();
    for param in &system.params {
        (
            &param.var.name,
            param.var.ty,
            &param.var.lo,
            &param.var.hi,
            &param.reading,
        )
            .hash(&mut all);
        // Conditions name their values.
        if let Ty::Enum(e) = param.var.ty {
            (system.enums.get(e).map(|e| &e.values)).hash(&mut all);
        }
    }
    for state in &system.states {
        (
            &state.var.name,
            state.var.ty,
            &state.var.lo,
            &state.var.hi,
            &state.init,
        )
            .hash(&mut all);
    }
    for input in &system.inputs {
        (&input.name, input.ty, &input.lo, &input.hi).hash(&mut all);
    }
    for lazy in &system.lazies {
        (lazy.ty, &lazy.value).hash(&mut all);
    }
    for instance in &system.instances {
        (&instance.name, &instance.states).hash(&mut all);
        for rule in &instance.rules {
            (&rule.when, &rule.then).hash(&mut all);
        }
    }
    Tables(all.digest())
}

/// Stands for all that decides whether a property of a system holds; without one, whether no value leaves its range.
pub fn fingerprint(tables: &Tables, system: &System, property: Option<&Property>) -> String {
    let mut all = All::default();
    tables.0.hash(&mut all);
    if let Some(property) = property {
        (&property.id, property.index, &property.form).hash(&mut all);
        let (atoms, observed) = property.form.expressions();
        for (list, numbers) in [(&system.atoms, atoms), (&system.observed, observed)] {
            numbers.iter().for_each(|k| (k, &list[*k]).hash(&mut all));
        }
    }
    let bytes = all.digest();
    bytes[..8]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
