//! One value of a machine file that can be turned: what it may be, and the file with another one in its place.

use indexmap::{IndexMap, IndexSet};
use stillpoint_lang::diag::nearest;

use super::family::{Param, Quantity};
use super::{AxisKind, Machine, Place, Settings};

/// A value of a machine file.
#[derive(Debug, Clone)]
pub struct Knob {
    /// Where it stands: `axis.X.STANDSTILL_TOL`, `axis.X.VELO_LIMIT[0]`.
    pub name: String,
    /// What it is in the file, in base units.
    pub given: i64,
    param: Param,
    kind: AxisKind,
    place: Place,
}

impl Machine {
    /// The value of that name: `control.`, `axis.X.`, `group.G.`, `door.D.` or `guarantee.G.` and a parameter that the file gives, an
    /// element of a list with its index.
    ///
    /// # Errors
    /// There is none, and what there is.
    pub fn knob(&self, name: &str) -> Result<Knob, String> {
        let knobs = self.knobs();
        if let Some(knob) = knobs.iter().find(|knob| knob.name == name) {
            return Ok(knob.clone());
        }
        let names = || knobs.iter().map(|knob| knob.name.as_str());
        if let Some(near) = nearest(name, names()) {
            return Err(format!(
                "the file gives no value '{name}'; did you mean '{near}'?"
            ));
        }
        // What its owner has, or which owners there are.
        let owner = |name: &str| name.rsplit_once('.').map(|(owner, _)| owner.to_owned());
        let beside: Vec<&str> = names().filter(|n| owner(n) == owner(name)).collect();
        let owners: IndexSet<String> = names().filter_map(owner).collect();
        Err(match beside.is_empty() {
            true => {
                let list: Vec<&str> = owners.iter().map(String::as_str).collect();
                format!(
                    "the file gives no value '{name}'; it gives values of {}",
                    list.join(", ")
                )
            }
            false => format!(
                "the file gives no value '{name}', a default has to be written into it first; it gives {}",
                beside.join(", ")
            ),
        })
    }

    /// Every value that the file gives and that can be turned.
    pub fn knobs(&self) -> Vec<Knob> {
        let family = &self.basis.family;
        let mut list = Vec::new();
        let mut add = |owner: String, params: Params<'_>, settings: &Settings, kind: AxisKind| {
            for (name, setting) in settings {
                let Some(param) = params.get(name) else {
                    continue;
                };
                if param.quantity == Quantity::Groups {
                    continue;
                }
                let several = param.count > 0;
                let cells = setting.cells.iter().zip(&setting.places).enumerate();
                list.extend(cells.map(|(k, (cell, place))| Knob {
                    name: match several {
                        true => format!("{owner}.{name}[{k}]"),
                        false => format!("{owner}.{name}"),
                    },
                    given: *cell,
                    param: param.clone(),
                    kind,
                    place: place.clone(),
                }));
            }
        };
        add(
            "control".to_owned(),
            &family.control,
            &self.control,
            AxisKind::Linear,
        );
        for axis in &self.axes {
            add(
                format!("axis.{}", axis.name),
                &family.axis,
                &axis.values,
                axis.kind,
            );
        }
        for group in &self.axis_groups {
            if let Some(params) = &family.group {
                add(
                    format!("group.{}", group.name),
                    params,
                    &group.values,
                    AxisKind::Linear,
                );
            }
        }
        for door in &self.doors {
            add(
                format!("door.{}", door.name),
                &family.door,
                &door.values,
                AxisKind::Linear,
            );
        }
        for guarantee in &self.guarantees {
            let of = guarantee.axes.first().map(|a| a.get_ref());
            let kind = self.axes.iter().find(|a| Some(&a.name) == of);
            if let (Some(pattern), Some(axis)) = (family.patterns.get(&guarantee.pattern), kind) {
                let owner = format!("guarantee.{}", guarantee.name);
                add(owner, &pattern.arguments, &guarantee.values, axis.kind);
            }
        }
        list
    }
}

type Params<'a> = &'a IndexMap<String, Param>;

impl Knob {
    /// The values it may have, in rising order: all of a choice, else the ends of its range and the finest step between them.
    pub fn range(&self) -> Range {
        match self.param.quantity {
            Quantity::Choice | Quantity::Signal => {
                Range::All(self.param.choices.iter().map(|(_, code)| *code).collect())
            }
            Quantity::Bool => Range::All(vec![0, 1]),
            _ => {
                let limits = self.param.limits(self.kind);
                Range::Between(limits.min, limits.max, self.param.step.max(1))
            }
        }
    }

    /// A value as users write it.
    pub fn show(&self, value: i64) -> String {
        self.param.show(value, self.kind).replace('"', "")
    }

    /// The text of the machine file with this value in the place of the given one.
    pub fn turned(&self, source: &str, value: i64) -> String {
        let shown = self.param.show(value, self.kind);
        let named = matches!(
            self.param.quantity,
            Quantity::Bool | Quantity::Choice | Quantity::Signal
        );
        let plain = named || self.param.quantity.dimension(self.kind).units().is_empty();
        let text = match plain {
            true => shown,
            false => format!("\"{shown}\""),
        };
        let (before, after) = (source.get(..self.place.start), source.get(self.place.end..));
        format!(
            "{}{text}{}",
            before.unwrap_or_default(),
            after.unwrap_or_default()
        )
    }
}

/// What values a knob has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Range {
    /// These.
    All(Vec<i64>),
    /// From, to, and the finest step.
    Between(i64, i64, i64),
}

#[cfg(test)]
mod tests {
    use crate::{Machine, families, load, load_bytes};

    fn milling() -> (std::path::PathBuf, String, Machine) {
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../machines/milling-840d.toml");
        let source = std::fs::read_to_string(&path).expect("the machine");
        let machine = load(&path, &families(&path)).expect("a machine");
        (path, source, machine)
    }

    /// Each value that is turned is the one that was asked for, and nothing else of the file has changed.
    #[test]
    fn every_given_value_can_be_turned() {
        let (path, source, machine) = milling();
        let knobs = machine.knobs();
        assert!(knobs.len() > 60, "{}", knobs.len());
        for knob in &knobs {
            let text = knob.turned(&source, knob.given);
            let again =
                load_bytes(&path, text.into_bytes(), &families(&path)).expect("the same machine");
            let same: Vec<i64> = again.knobs().iter().map(|k| k.given).collect();
            let given: Vec<i64> = knobs.iter().map(|k| k.given).collect();
            assert_eq!(same, given, "{}", knob.name);
        }
        let knob = machine.knob("axis.X.STANDSTILL_TOL").expect("a knob");
        let text = knob.turned(&source, 1_500);
        let again = load_bytes(&path, text.into_bytes(), &families(&path)).expect("plausible");
        assert_eq!(
            again.knob("axis.X.STANDSTILL_TOL").expect("a knob").given,
            1_500
        );
        assert!(
            machine
                .knob("axis.X.STANDSTIL_TOL")
                .expect_err("none")
                .contains("did you mean")
        );
    }
}
