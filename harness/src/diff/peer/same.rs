//! The peer of a monitor that its table describes in the same words: each number of the monitor goes to the port, state variable
//! or parameter of its name. What is called otherwise, or is not on both sides, is said one by one.

use stillpoint_model::Domain;
use stillpoint_monitors::contract::{Contract, Next};
use stillpoint_monitors::fields::{Fields, Kind, Visitor};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_spec::ir::LazyKind;

use super::adapter::Adapter;
use super::{Params, Refusable, Refusal, chosen};
use crate::diff::product::{Values, is};

/// A number of a type: its name, that with the names of the fields it is in, and its values.
struct Number {
    short: &'static str,
    name: String,
    kind: Kind,
}

/// Collects the numbers of a type.
#[derive(Default)]
struct Numbers {
    path: Vec<&'static str>,
    all: Vec<Number>,
}

impl Visitor for Numbers {
    fn number(&mut self, name: &'static str, kind: Kind, value: i64) -> i64 {
        self.path.push(name);
        let name = self.path[1..].join(".");
        let short = self.path.pop().unwrap_or_default();
        self.all.push(Number { short, name, kind });
        value
    }

    fn open(&mut self, name: &'static str) {
        self.path.push(name);
    }

    fn close(&mut self) {
        self.path.pop();
    }
}

fn numbers<T: Fields>() -> Vec<Number> {
    let mut numbers = Numbers::default();
    T::ANY.clone().visit("", &mut numbers);
    numbers.all
}

/// Sets each number to the next one of a list.
struct Set<I>(I);

impl<I: Iterator<Item = i64>> Visitor for Set<I> {
    fn number(&mut self, _: &'static str, _: Kind, value: i64) -> i64 {
        self.0.next().unwrap_or(value)
    }
}

fn set<T: Fields>(numbers: impl Iterator<Item = i64>) -> T {
    let mut value = T::ANY;
    value.visit("", &mut Set(numbers));
    value
}

/// Hands each number on.
struct Get<F>(F);

impl<F: FnMut(i64)> Visitor for Get<F> {
    fn number(&mut self, _: &'static str, _: Kind, value: i64) -> i64 {
        (self.0)(value);
        value
    }
}

fn get<T: Fields>(mut value: T, each: impl FnMut(i64)) {
    value.visit("", &mut Get(each));
}

/// Where the number of an input comes from.
#[derive(Clone, Copy)]
enum Feed {
    Port(usize),
    Constant(i64),
}

/// An output that the table has and the monitor does not: what it is made of.
type Told<M> = fn(&<M as Contract>::State, &<M as Contract>::Outputs) -> i64;

/// The peer of `M` as far as it is known.
pub(super) struct Same<'a, M: Contract> {
    params: &'a Params<'a>,
    next: Next<M>,
    /// Names of the table, each with that of the monitor.
    named: &'static [(&'static str, &'static str)],
    constants: &'static [(&'static str, i64)],
    hidden: &'static [&'static str],
    unused: &'static [&'static str],
    told: Vec<(&'static str, Told<M>)>,
    cells: Vec<(&'static str, Domain)>,
    kept: Vec<(&'static str, &'static str, &'static str)>,
    only: Vec<(&'static [&'static str], Values)>,
}

impl<'a, M: Contract> Same<'a, M> {
    /// The monitor under the parameters of a table, or its wrong variant.
    pub(super) fn new(params: &'a Params<'a>, mutant: Option<Mutant>) -> Self {
        Self {
            params,
            next: chosen::<M>(mutant),
            named: &[],
            constants: &[],
            hidden: &[],
            unused: &[],
            told: Vec::new(),
            cells: Vec::new(),
            kept: Vec::new(),
            only: Vec::new(),
        }
    }

    /// Names of the table that are others in the monitor. A part of the monitor's name is enough that stands in no other.
    pub(super) fn named(mut self, named: &'static [(&'static str, &'static str)]) -> Self {
        self.named = named;
        self
    }

    /// Parameters and inputs of the monitor that the table does not have.
    pub(super) fn constants(mut self, constants: &'static [(&'static str, i64)]) -> Self {
        self.constants = constants;
        self
    }

    /// Outputs of the monitor that the table does not have, and states that are not to be compared.
    pub(super) fn hidden(mut self, hidden: &'static [&'static str]) -> Self {
        self.hidden = hidden;
        self
    }

    /// Inputs that only the table has, for other readings than the recommended ones.
    pub(super) fn without(mut self, unused: &'static [&'static str]) -> Self {
        self.unused = unused;
        self
    }

    /// An output that the table has in other words.
    pub(super) fn told(mut self, name: &'static str, told: Told<M>) -> Self {
        self.told.push((name, told));
        self
    }

    /// The values of a state that the table does not have.
    pub(super) fn cell(mut self, name: &'static str, domain: Domain) -> Self {
        self.cells.push((name, domain));
        self
    }

    /// A state that starts with the value of a state variable of the table, which is not 0: non-volatile state.
    pub(super) fn kept(self, name: &'static str, variable: &'static str) -> Self {
        self.kept_where(name, variable, variable)
    }

    /// The same where another state variable of the table is not 0; else the state starts as ever.
    pub(super) fn kept_where(
        mut self,
        name: &'static str,
        variable: &'static str,
        condition: &'static str,
    ) -> Self {
        self.kept.push((name, variable, condition));
        self
    }

    /// Restricts inputs to the values they have at this interface.
    pub(super) fn only(mut self, inputs: &'static [&'static str], values: Values) -> Self {
        self.only.push((inputs, values));
        self
    }

    /// What the table calls a number of the monitor.
    fn table_name(&self, number: &Number) -> &'static str {
        let named = (self.named.iter()).find(|(_, name)| ends(&number.name, name));
        named.map_or(number.short, |(table, _)| table)
    }

    fn constant(&self, own: &str) -> Option<i64> {
        let found = self.constants.iter().find(|(name, _)| ends(own, name));
        found.map(|(_, value)| *value)
    }

    fn is_hidden(&self, own: &str) -> bool {
        self.hidden.iter().any(|name| ends(own, name))
    }

    /// The configuration, from the parameters of the table.
    fn config(&self) -> Result<M::Config, Refusal> {
        let mut values = Vec::new();
        for number in &numbers::<M::Config>() {
            values.push(match self.constant(&number.name) {
                Some(value) => value,
                None => i64::from(self.params.known(self.table_name(number))?),
            });
        }
        let config = set(values.into_iter());
        if M::accepted(&config) {
            Ok(config)
        } else {
            Err(Refusal::Values(format!("{config:?}")))
        }
    }

    /// Whether the table has a state variable or an output of this name.
    fn shows(&self, name: &str) -> bool {
        let system = &self.params.bound.system;
        system.states.iter().any(|s| is(&s.var.name, name))
            || (system.lazies.iter()).any(|l| l.kind == LazyKind::Output && is(&l.name, name))
    }

    /// The values of a state.
    fn domain(&self, number: &Number) -> Result<Domain, Refusal> {
        if let Some((_, domain)) = self.cells.iter().find(|(n, _)| ends(&number.name, n)) {
            return Ok(*domain);
        }
        let (low, high) = number.kind.ends();
        if !matches!(number.kind, Kind::Whole(..)) || high - low < 256 {
            let (lo, hi) = (low as i32, high as i32);
            return Ok(Domain { lo, hi });
        }
        let bound = self.params.bound;
        let name = self.table_name(number);
        let found = (bound.system.states.iter()).position(|s| is(&s.var.name, name));
        match found.map(|k| bound.states[k]) {
            Some((lo, hi)) => Ok(Domain { lo, hi }),
            None => Err(Refusal::Unknown(format!(
                "the values of the state `{name}`"
            ))),
        }
    }

    /// The peer.
    pub(super) fn peer(self) -> Refusable {
        let config = self.config()?;
        let mut ports = Vec::new();
        let mut feeds = Vec::new();
        for number in &numbers::<M::Inputs>() {
            feeds.push(match self.constant(&number.name) {
                Some(value) => Feed::Constant(value),
                None => {
                    ports.push(self.table_name(number));
                    Feed::Port(ports.len() - 1)
                }
            });
        }
        // Which of the numbers are compared, outputs first.
        let mut outputs = Vec::new();
        let mut from_outputs = Vec::new();
        for number in &numbers::<M::Outputs>() {
            let compared = !self.is_hidden(&number.name);
            from_outputs.push(compared);
            if compared {
                outputs.push(self.table_name(number));
            }
        }
        let mut from_state = Vec::new();
        let mut domains = Vec::new();
        let mut kept = Vec::new();
        for (cell, number) in numbers::<M::State>().iter().enumerate() {
            domains.push(self.domain(number)?);
            let name = self.table_name(number);
            let known = outputs.contains(&name);
            let compared = !known && !self.is_hidden(&number.name) && self.shows(name);
            from_state.push(compared);
            if compared {
                outputs.push(name);
            }
            let own = self.kept.iter().find(|(n, ..)| ends(&number.name, n));
            kept.extend(own.map(|(_, variable, condition)| (cell, *variable, *condition)));
        }
        let told: Vec<Told<M>> = self.told.iter().map(|(_, told)| *told).collect();
        outputs.extend(self.told.iter().map(|(name, _)| *name));
        let mut initial = Vec::new();
        get(M::INITIAL, |number| initial.push(number as i32));
        let next = self.next;
        let step = move |cells: &mut [i32], ports: &[i32], said: &mut super::Numbers| {
            let state = set(cells.iter().map(|cell| i64::from(*cell)));
            let inputs = set(feeds.iter().map(|feed| match feed {
                Feed::Port(k) => i64::from(ports[*k]),
                Feed::Constant(value) => *value,
            }));
            let (after, outputs) = next(state, &config, &inputs);
            let mut compared = from_outputs.iter();
            get(outputs, |number| {
                said.extend(compared.next().filter(|c| **c).map(|_| number))
            });
            let (mut compared, mut own) = (from_state.iter(), cells.iter_mut());
            get(after, |number| {
                said.extend(compared.next().filter(|c| **c).map(|_| number));
                if let Some(cell) = own.next() {
                    *cell = i32::try_from(number).unwrap_or(i32::MAX);
                }
            });
            said.extend(told.iter().map(|told| told(&after, &outputs)));
        };
        let mut adapter = Adapter::of(ports, outputs, domains, initial, step).without(self.unused);
        for (inputs, values) in self.only {
            adapter = adapter.only(inputs, values);
        }
        for (cell, variable, condition) in kept {
            adapter = adapter.kept_where(cell, variable, condition);
        }
        Ok(adapter)
    }
}

/// Whether a name with the names of the fields it is in ends in this one.
fn ends(path: &str, name: &str) -> bool {
    path == name || (path.strip_suffix(name)).is_some_and(|rest| rest.ends_with('.'))
}
