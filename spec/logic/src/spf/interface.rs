//! What a program has to do with the machine whose place its table takes.

use std::collections::BTreeMap;

use super::ast::{Expr, ExprKind, Value};
use super::{Program, Variable, line_of};
use crate::fault::Span;
use crate::st::Signature;

/// How the variables of a program are wired to a machine of the tables.
#[derive(Debug, Clone)]
pub struct Interface {
    /// The machine that the table of the program takes the place of.
    pub signature: Signature,
    /// Variables that are inputs of the machine: each with the name of the input. A variable that the program does not read may be named.
    pub inputs: Vec<(Variable, String)>,
    /// All outputs of the machine: each by its name, with what it gives.
    pub outputs: Vec<(String, Output)>,
    /// An input of type BOOL of the machine: the program runs only in cycles in which it is TRUE, those of the interpolation (IPO);
    /// in the others all its values stay, those of outputs too. Timers count the cycles in which it runs, so that
    /// [`crate::Compiled::durations`] are to be given in cycles of the interpolation.
    pub scan: Option<String>,
    /// What the manual leaves open.
    pub readings: Readings,
}

/// Readings of what the manual leaves open; the default is what the requirements recommend.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Readings {
    /// `EDGE_INIT_SAMPLE`: a condition of EVERY that is true in the first cycle is no edge. Else `EDGE_INIT_FIRE`: it fires.
    pub first_sample_is_no_edge: bool,
    /// `TMR_INIT_LARGE`: a timer that was never started has a time above everything it is compared with. Else `TMR_INIT_ZERO`: 0.
    pub timers_begin_large: bool,
    /// `Q_LEVEL`: a relay is acknowledged as long as Q1 or Q2 is 1. Else `Q_EDGE`: when it becomes 1.
    pub relay_acknowledged_by_level: bool,
}

/// What an output of the machine gives.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Output {
    /// Always the same.
    Constant(bool),
    /// A variable that the program may write; one that it never writes is 0.
    Variable {
        /// Which one.
        variable: Variable,
        /// Whether the output is TRUE where the variable is 0.
        inverted: bool,
    },
}

/// A variable of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Used {
    /// Which one.
    pub variable: Variable,
    /// The names that the program defines for it.
    pub names: Vec<String>,
    /// Whether a condition, a value or a relay reads it.
    pub reads: bool,
    /// Whether an action or a relay writes it.
    pub writes: bool,
    /// The line that uses it first, from 1; that of its definition if none does.
    pub line: usize,
}

/// Reading and writing of one variable, with the first place of each.
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    pub read: Option<Span>,
    pub written: Option<Span>,
}

impl Program {
    /// The variables that it reads, writes or names, in their order.
    #[must_use]
    pub fn variables(&self) -> Vec<Used> {
        let mut all = self.places();
        for name in &self.names {
            all.entry(name.variable.clone()).or_default();
        }
        let used = all.into_iter().map(|(variable, places)| {
            let named = self.names.iter().filter(|name| name.variable == variable);
            let first = [&places.read, &places.written].into_iter().flatten();
            let first = first.map(|span| span.start).min();
            let defined = named.clone().map(|name| name.span.start).min();
            Used {
                names: named.map(|name| name.name.clone()).collect(),
                reads: places.read.is_some(),
                writes: places.written.is_some(),
                line: line_of(&self.source, first.or(defined).unwrap_or_default()),
                variable,
            }
        });
        used.collect()
    }

    /// Where each variable is read and written first.
    pub(super) fn places(&self) -> BTreeMap<Variable, Places> {
        let mut all: BTreeMap<Variable, Places> = BTreeMap::new();
        let mut read = |e: &Expr| {
            e.each(&mut |part| {
                if let ExprKind::Variable(variable) = &part.kind {
                    let places = all.entry(variable.clone()).or_default();
                    places.read.get_or_insert_with(|| part.span.clone());
                }
            });
        };
        for action in &self.actions {
            action.condition.iter().for_each(&mut read);
            for assign in &action.assigns {
                if let Value::Expr(value) = &assign.value {
                    read(value);
                }
            }
        }
        let called = self.called();
        for (number, relay) in &self.relays {
            if called.contains_key(number) {
                relay
                    .inputs
                    .iter()
                    .flat_map(|(list, _)| list)
                    .for_each(&mut read);
            }
        }
        let mut written = |e: &Expr| {
            if let ExprKind::Variable(variable) = &e.kind {
                let places = all.entry(variable.clone()).or_default();
                places.written.get_or_insert_with(|| e.span.clone());
            }
        };
        for action in &self.actions {
            action
                .assigns
                .iter()
                .for_each(|assign| written(&assign.target));
        }
        for (number, relay) in &self.relays {
            if called.contains_key(number) {
                relay
                    .outputs
                    .iter()
                    .flat_map(|(list, _)| list)
                    .for_each(&mut written);
            }
        }
        all
    }

    /// The relays that actions call, with the place of the first call.
    pub(super) fn called(&self) -> BTreeMap<u8, Span> {
        let mut called = BTreeMap::new();
        for assign in self.actions.iter().flat_map(|action| &action.assigns) {
            if let Value::Relay(number) = assign.value {
                called.entry(number).or_insert_with(|| assign.span.clone());
            }
        }
        called
    }
}
