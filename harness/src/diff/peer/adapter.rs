//! A peer made of a step function and the way its state lies in cells.

use stillpoint_model::Domain;
use stillpoint_monitors::fields::Fields;

use super::cells::{load, store, stored};
use super::{Numbers, Peer};
use crate::diff::product::Values;

/// A monitor with its configuration.
pub(crate) struct Adapter {
    inputs: Vec<&'static str>,
    unused: Vec<(&'static str, Option<i32>)>,
    outputs: Vec<&'static str>,
    allowed: Vec<(usize, Values)>,
    explored: Vec<(usize, Values)>,
    domains: Vec<Domain>,
    initial: Vec<i32>,
    kept: Vec<(usize, &'static str, &'static str)>,
    step: Box<Step>,
}

/// One step: cells, inputs, outputs.
type Step = dyn Fn(&mut [i32], &[i32], &mut Numbers) + Send + Sync;

impl Adapter {
    /// A monitor with these ports, as the table calls them, and a state of these cells.
    pub(crate) fn new<S: Fields>(
        inputs: &'static [&'static str],
        outputs: &'static [&'static str],
        domains: Vec<Domain>,
        initial: S,
        step: impl Fn(S, &[i32], &mut Numbers) -> S + Send + Sync + 'static,
    ) -> Self {
        let step = move |cells: &mut [i32], i: &[i32], o: &mut Numbers| {
            store(step(load(cells), i, o), cells);
        };
        let cells = stored(initial);
        Self::of(inputs.to_vec(), outputs.to_vec(), domains, cells, step)
    }

    /// A monitor whose state is in cells, with these ports.
    pub(crate) fn of(
        inputs: Vec<&'static str>,
        outputs: Vec<&'static str>,
        domains: Vec<Domain>,
        initial: Vec<i32>,
        step: impl Fn(&mut [i32], &[i32], &mut Numbers) + Send + Sync + 'static,
    ) -> Self {
        Self {
            inputs,
            unused: Vec::new(),
            outputs,
            allowed: Vec::new(),
            explored: Vec::new(),
            domains,
            initial,
            kept: Vec::new(),
            step: Box::new(step),
        }
    }

    /// A monitor without a state.
    pub(crate) fn stateless(
        inputs: &'static [&'static str],
        outputs: &'static [&'static str],
        step: impl Fn(&[i32], &mut Numbers) + Send + Sync + 'static,
    ) -> Self {
        let step = move |_: &mut [i32], i: &[i32], o: &mut Numbers| step(i, o);
        let (inputs, outputs) = (inputs.to_vec(), outputs.to_vec());
        Self::of(inputs, outputs, Vec::new(), Vec::new(), step)
    }

    /// Names the inputs that only the table has, for other readings than the recommended ones.
    pub(crate) fn without(mut self, unused: &'static [&'static str]) -> Self {
        self.unused.extend(unused.iter().map(|name| (*name, None)));
        self
    }

    /// Gives an input that only the table has the one value it keeps: what the monitor knows from its parameters.
    pub(crate) fn with(mut self, name: &'static str, value: i32) -> Self {
        self.unused.push((name, Some(value)));
        self
    }

    /// Restricts inputs to the values they have at this interface.
    pub(crate) fn only(mut self, inputs: &[&str], values: Values) -> Self {
        let ports = self.ports(inputs);
        self.allowed
            .extend(ports.into_iter().map(|port| (port, values)));
        self
    }

    /// Restricts wide inputs to some of their values in an exploration; random runs have all.
    pub(crate) fn explored(mut self, inputs: &[&str], values: Values) -> Self {
        let ports = self.ports(inputs);
        self.explored
            .extend(ports.into_iter().map(|port| (port, values)));
        self
    }

    /// The numbers of the inputs of these names.
    fn ports(&self, inputs: &[&str]) -> Vec<usize> {
        let ports = self.inputs.iter().enumerate();
        let found = ports.filter(|(_, name)| inputs.contains(name));
        found.map(|(port, _)| port).collect()
    }

    /// A cell that starts with the value of a state variable of the table: non-volatile state.
    pub(crate) fn kept(self, cell: usize, state: &'static str) -> Self {
        self.kept_where(cell, state, state)
    }

    /// The same where another state variable of the table is not 0; else the cell keeps its initial value.
    pub(crate) fn kept_where(
        mut self,
        cell: usize,
        state: &'static str,
        condition: &'static str,
    ) -> Self {
        self.kept.push((cell, state, condition));
        self
    }
}

impl Peer for Adapter {
    fn inputs(&self) -> &[&'static str] {
        &self.inputs
    }

    fn unused(&self) -> &[(&'static str, Option<i32>)] {
        &self.unused
    }

    fn allowed(&self, k: usize) -> Option<Values> {
        let found = self.allowed.iter().find(|(port, _)| *port == k);
        found.map(|(_, values)| *values)
    }

    fn explored(&self, k: usize) -> Option<Values> {
        let found = self.explored.iter().find(|(port, _)| *port == k);
        found.map(|(_, values)| *values)
    }

    fn outputs(&self) -> &[&'static str] {
        &self.outputs
    }

    fn domains(&self) -> Vec<Domain> {
        self.domains.clone()
    }

    fn initial(&self, table: &dyn Fn(&str) -> i32) -> Vec<i32> {
        let mut cells = self.initial.clone();
        for (cell, name, condition) in &self.kept {
            if table(condition) != 0 {
                cells[*cell] = table(name);
            }
        }
        cells
    }

    fn step(&self, cells: &mut [i32], inputs: &[i32], outputs: &mut Numbers) {
        (self.step)(cells, inputs, outputs);
    }
}
