//! A system with its parameter values: concrete ranges, ready to run.

use std::collections::BTreeMap;

use crate::diag::nearest;
use crate::eval::{self, Cells, Driven, Frame};
use crate::ir::{Node, Space, System, Var};

/// Inclusive range of a cell.
pub type Bounds = (i32, i32);

/// A system with parameter values.
#[derive(Debug, Clone, PartialEq, Hash)]
pub struct Bound {
    /// The resolved system.
    pub system: System,
    /// Value of each parameter.
    pub values: Vec<i32>,
    /// Range of each state variable.
    pub states: Vec<Bounds>,
    /// Range of each input.
    pub inputs: Vec<Bounds>,
    /// Initial value of each state variable; none means any.
    pub initial: Vec<Option<i32>>,
}

/// A parameter value that does not fit.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BindError {
    /// There is no parameter of this name.
    #[error("system `{system}` has no parameter `{name}`{}", near.as_ref().map(|n| format!("; did you mean `{n}`?")).unwrap_or_default())]
    Unknown {
        /// The system.
        system: String,
        /// The name given.
        name: String,
        /// The nearest name.
        near: Option<String>,
    },
    /// The value is outside the parameter's range.
    #[error("parameter `{name}` is {value}; allowed are {lo}..{hi}")]
    Range {
        /// The parameter.
        name: String,
        /// Value given or defaulted.
        value: i64,
        /// Least value.
        lo: i64,
        /// Greatest value.
        hi: i64,
    },
    /// An array parameter was given the wrong number of values.
    #[error("parameter `{name}` takes {want} values, {got} are given")]
    Length {
        /// The parameter.
        name: String,
        /// Elements of the array.
        want: usize,
        /// Values given.
        got: usize,
    },
    /// A range of a variable is empty for these values.
    #[error("with these parameters the range of `{name}` is {lo}..{hi}, which is empty")]
    Empty {
        /// The variable.
        name: String,
        /// Lower bound.
        lo: i64,
        /// Upper bound.
        hi: i64,
    },
    /// A reading or one of its options does not exist.
    #[error("{0}")]
    Reading(String),
}

impl Bound {
    /// Binds parameters: `params` by name (arrays with one value for each element), `readings` by id.
    /// What is not given has its default; a reading its recommended option.
    ///
    /// # Errors
    /// Unknown names, values outside their ranges.
    pub fn new(
        system: System,
        params: &BTreeMap<String, Vec<i64>>,
        readings: &BTreeMap<String, String>,
    ) -> Result<Self, BindError> {
        let mut given = vec![None; system.params.len()];
        for (name, values) in params {
            let cells = cells_of(&system, name);
            if cells.is_empty() {
                let base = |n: &str| n.split('[').next().unwrap_or(n).to_owned();
                let known: Vec<String> = system.params.iter().map(|p| base(&p.var.name)).collect();
                return Err(BindError::Unknown {
                    system: system.name.clone(),
                    name: name.clone(),
                    near: nearest(name, known.iter().map(String::as_str)).map(str::to_owned),
                });
            }
            if cells.len() != values.len() {
                return Err(BindError::Length {
                    name: name.clone(),
                    want: cells.len(),
                    got: values.len(),
                });
            }
            for (cell, value) in cells.into_iter().zip(values) {
                given[cell] = Some(*value);
            }
        }
        for (id, option) in readings {
            let Some(reading) = system.readings.iter().find(|r| r.id == *id) else {
                continue; // a reading of another system of the same family
            };
            if !reading.options.contains(option) {
                return Err(BindError::Reading(format!(
                    "reading {id} has no option `{option}`; its options are {}",
                    reading.options.join(", ")
                )));
            }
            for (k, p) in system.params.iter().enumerate() {
                if p.reading.as_deref() == Some(id) {
                    given[k] = Some(i64::from(p.var.name == *option));
                }
            }
        }
        let mut values: Vec<i32> = Vec::with_capacity(system.params.len());
        for (k, param) in system.params.iter().enumerate() {
            let value = match given[k] {
                Some(v) => v,
                None => evaluate(&param.default, &values),
            };
            let (lo, hi) = range(&param.var, &values);
            if value < lo || value > hi {
                return Err(BindError::Range {
                    name: param.var.name.clone(),
                    value,
                    lo,
                    hi,
                });
            }
            values.push(value as i32);
        }
        let bounds = |var: &Var| -> Result<Bounds, BindError> {
            let (lo, hi) = range(var, &values);
            if lo > hi || lo <= i64::from(i32::MIN) || hi > i64::from(i32::MAX) {
                return Err(BindError::Empty {
                    name: var.name.clone(),
                    lo,
                    hi,
                });
            }
            Ok((lo as i32, hi as i32))
        };
        let states = system
            .states
            .iter()
            .map(|s| bounds(&s.var))
            .collect::<Result<Vec<_>, _>>()?;
        let inputs = system
            .inputs
            .iter()
            .map(bounds)
            .collect::<Result<Vec<_>, _>>()?;
        let mut initial = Vec::new();
        for (state, (lo, hi)) in system.states.iter().zip(&states) {
            let value = state.init.as_ref().map(|n| evaluate(n, &values));
            if let Some(v) = value {
                if v < i64::from(*lo) || v > i64::from(*hi) {
                    return Err(BindError::Range {
                        name: state.var.name.clone(),
                        value: v,
                        lo: i64::from(*lo),
                        hi: i64::from(*hi),
                    });
                }
            }
            initial.push(value.map(|v| v as i32));
        }
        Ok(Self {
            system,
            values,
            states,
            inputs,
            initial,
        })
    }

    /// Input combinations of one cycle.
    pub fn combinations(&self) -> u128 {
        self.inputs
            .iter()
            .map(|(lo, hi)| (i128::from(*hi) - i128::from(*lo) + 1) as u128)
            .fold(1, u128::saturating_mul)
    }

    /// A constant expression over the parameters, e.g. the bound of a property.
    pub fn constant(&self, node: &Node) -> i64 {
        evaluate(node, &self.values)
    }

    /// The chosen option of each reading: (id, option).
    pub fn readings(&self) -> Vec<(String, String)> {
        let chosen = self
            .system
            .params
            .iter()
            .zip(&self.values)
            .filter(|(_, v)| **v == 1);
        chosen
            .filter_map(|(p, _)| p.reading.clone().map(|id| (id, p.var.name.clone())))
            .collect()
    }
}

/// The parameter cells of `name`: one, or those of an array.
fn cells_of(system: &System, name: &str) -> Vec<usize> {
    let element = format!("{name}[");
    let named = system.params.iter().enumerate().filter(|(_, p)| {
        p.reading.is_none() && (p.var.name == name || p.var.name.starts_with(&element))
    });
    named.map(|(k, _)| k).collect()
}

fn range(var: &Var, values: &[i32]) -> (i64, i64) {
    (evaluate(&var.lo, values), evaluate(&var.hi, values))
}

/// Evaluates an expression of parameters; anything else cannot occur in one.
fn evaluate(node: &Node, values: &[i32]) -> i64 {
    let memory = &mut Driven {
        frame: &mut Frame::empty(),
        read: &mut |_| 0,
    };
    let cells = Cells {
        params: values,
        lazies: &[],
    };
    match node {
        Node::Const(v) => *v,
        Node::Cell(Space::Param, k) => values.get(*k as usize).copied().map_or(0, i64::from),
        other => eval::value(other, cells, memory),
    }
}
