//! A peer made of a step function and the way its state lies in cells.

use stillpoint_model::Domain;

use super::{Numbers, Peer};
use crate::diff::product::Values;

/// A state as numbers.
pub(super) trait Cells: Copy + Send + Sync + 'static {
    /// How many.
    const COUNT: usize;
    /// The state in cells.
    fn load(cells: &[i32]) -> Self;
    /// Writes the state to cells.
    fn store(self, cells: &mut [i32]);
}

/// A monitor with its configuration.
pub(super) struct Adapter {
    inputs: Vec<&'static str>,
    unused: &'static [&'static str],
    outputs: Vec<&'static str>,
    allowed: Vec<(usize, Values)>,
    domains: Vec<Domain>,
    initial: Vec<i32>,
    kept: Vec<(usize, &'static str, &'static str)>,
    step: Box<Step>,
}

/// One step: cells, inputs, outputs.
type Step = dyn Fn(&mut [i32], &[i32], &mut Numbers) + Send + Sync;

impl Adapter {
    /// A monitor with these ports, as the table calls them, and a state of these cells.
    pub(super) fn new<S: Cells>(
        inputs: &'static [&'static str],
        outputs: &'static [&'static str],
        domains: Vec<Domain>,
        initial: S,
        step: impl Fn(S, &[i32], &mut Numbers) -> S + Send + Sync + 'static,
    ) -> Self {
        let mut cells = vec![0; S::COUNT];
        initial.store(&mut cells);
        let step = move |cells: &mut [i32], i: &[i32], o: &mut Numbers| {
            step(S::load(cells), i, o).store(cells);
        };
        Self::of(inputs.to_vec(), outputs.to_vec(), domains, cells, step)
    }

    /// A monitor whose state is in cells, with these ports.
    pub(super) fn of(
        inputs: Vec<&'static str>,
        outputs: Vec<&'static str>,
        domains: Vec<Domain>,
        initial: Vec<i32>,
        step: impl Fn(&mut [i32], &[i32], &mut Numbers) + Send + Sync + 'static,
    ) -> Self {
        Self {
            inputs,
            unused: &[],
            outputs,
            allowed: Vec::new(),
            domains,
            initial,
            kept: Vec::new(),
            step: Box::new(step),
        }
    }

    /// A monitor without a state.
    pub(super) fn stateless(
        inputs: &'static [&'static str],
        outputs: &'static [&'static str],
        step: impl Fn(&[i32], &mut Numbers) + Send + Sync + 'static,
    ) -> Self {
        Self::new(inputs, outputs, Vec::new(), (), move |(), i, o| step(i, o))
    }

    /// Names the inputs that only the table has, for other readings than the recommended ones.
    pub(super) fn without(mut self, unused: &'static [&'static str]) -> Self {
        self.unused = unused;
        self
    }

    /// Restricts inputs to the values they have at this interface.
    pub(super) fn only(mut self, inputs: &[&str], values: Values) -> Self {
        for (port, name) in self.inputs.iter().enumerate() {
            if inputs.contains(name) {
                self.allowed.push((port, values));
            }
        }
        self
    }

    /// A cell that starts with the value of a state variable of the table: non-volatile state.
    pub(super) fn kept(self, cell: usize, state: &'static str) -> Self {
        self.kept_where(cell, state, state)
    }

    /// The same where another state variable of the table is not 0; else the cell keeps its initial value.
    pub(super) fn kept_where(
        mut self,
        cell: usize,
        state: &'static str,
        condition: &'static str,
    ) -> Self {
        self.kept.push((cell, state, condition));
        self
    }
}

/// Implements [`Cells`]: the fields of a state in their order, each with its way from a number and back.
macro_rules! cells {
    ($($state:ty, $count:literal { $($field:ident = $load:expr, $store:expr;)+ })+) => {$(
        impl $crate::diff::peer::adapter::Cells for $state {
            const COUNT: usize = $count;

            fn load(cells: &[i32]) -> Self {
                let mut cells = cells.iter().copied();
                let mut next = || cells.next().unwrap_or(0);
                Self { $($field: ($load)(next()),)+ }
            }

            fn store(self, cells: &mut [i32]) {
                for (cell, value) in cells.iter_mut().zip([$(($store)(self.$field)),+]) {
                    *cell = value;
                }
            }
        }
    )+};
}

pub(super) use cells;

/// The state in the first of the cells; they are then the others.
pub(super) fn take<S: Cells>(rest: &mut &[i32]) -> S {
    let (own, others) = rest.split_at(S::COUNT.min(rest.len()));
    *rest = others;
    S::load(own)
}

/// Writes the state to the first of the cells; the others.
pub(super) fn put<S: Cells>(state: S, cells: &mut [i32]) -> &mut [i32] {
    let (own, others) = cells.split_at_mut(S::COUNT.min(cells.len()));
    state.store(own);
    others
}

impl Cells for () {
    const COUNT: usize = 0;

    fn load(_: &[i32]) -> Self {}

    fn store(self, _: &mut [i32]) {}
}

impl Peer for Adapter {
    fn inputs(&self) -> &[&'static str] {
        &self.inputs
    }

    fn unused(&self) -> &'static [&'static str] {
        self.unused
    }

    fn allowed(&self, k: usize) -> Option<Values> {
        let found = self.allowed.iter().find(|(port, _)| *port == k);
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
