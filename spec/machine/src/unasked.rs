//! Inputs of the safe logic that no guarantee looks at.
//!
//! In every exploration they are free: what is decided holds whatever they tell, and so nothing shows what they are there for. An enabling
//! device or a second emergency stop that the program ignores would be found by nobody.

use std::collections::{BTreeMap, BTreeSet};

use super::Machine;

impl Machine {
    /// The inputs that programs of the file read and that no guarantee looks at, with the names that the programs give them:
    /// `INSE[4] (ENABLING)`. None where the file has no guarantees: then nothing is looked at.
    pub(super) fn unasked(&self) -> Vec<String> {
        let programs = self.basis.logic.signals();
        let known = &self.basis.family.known.signals;
        // `INSE[9]` before `INSE[10]`.
        let order = |variable: &'_ str| (variable.len(), variable.to_owned());
        let mut names: BTreeMap<(usize, String), BTreeSet<&str>> = BTreeMap::new();
        let inputs = programs.iter().filter(|(_, (variable, given))| {
            !given && !self.guarantees.is_empty() && known.is_input(variable)
        });
        for (name, (variable, _)) in inputs {
            let names = names.entry(order(variable)).or_default();
            names.extend(Some(name.as_str()).filter(|name| name != variable));
        }
        let asked = self.runs.iter().filter(|run| run.guarantee.is_some());
        for signal in asked.flat_map(|run| run.wiring.values()) {
            names.remove(&order(signal.strip_prefix("NOT ").unwrap_or(signal)));
        }
        let shown = names.into_iter().map(|((_, variable), names)| {
            match names.into_iter().collect::<Vec<_>>().join(", ") {
                names if names.is_empty() => variable,
                names => format!("{variable} ({names})"),
            }
        });
        shown.collect()
    }
}
