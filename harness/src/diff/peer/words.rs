//! What is not the same in a monitor and in the table that describes it in the same words: names, and which number goes where.
//!
//! Nothing here depends on the type of the monitor, so it is compiled once for all of them.

use stillpoint_lang::ir::LazyKind;
use stillpoint_model::Domain;
use stillpoint_monitors::contract::Contract;
use stillpoint_monitors::fields::Kind;

use super::adapter::Adapter;
use super::cells::{Number, numbers};
use super::{Params, Refusal};
use crate::diff::product::{Values, is};

/// Where the number of an input comes from.
#[derive(Clone, Copy)]
pub(super) enum Feed {
    Port(usize),
    Constant(i64),
    /// From several ports, the first of which is this one.
    Made(usize, Make),
}

/// A number from the values of ports.
pub(super) type Make = fn(&[i32]) -> i64;

/// The numbers of a monitor.
pub(super) struct Shape {
    pub(super) config: Vec<Number>,
    pub(super) inputs: Vec<Number>,
    pub(super) outputs: Vec<Number>,
    pub(super) state: Vec<Number>,
}

impl Shape {
    pub(super) fn of<M: Contract>() -> Self {
        Self {
            config: numbers::<M::Config>("config"),
            inputs: numbers::<M::Inputs>("inputs"),
            outputs: numbers::<M::Outputs>("outputs"),
            state: numbers::<M::State>("state"),
        }
    }
}

/// Which number goes where.
#[derive(Default)]
pub(super) struct Plan {
    pub(super) ports: Vec<&'static str>,
    /// Where each number of the inputs comes from.
    pub(super) feeds: Vec<Feed>,
    /// Numbers of the configuration that inputs give, each with its port.
    pub(super) live: Vec<(usize, usize)>,
    pub(super) outputs: Vec<&'static str>,
    /// Which of the numbers are compared, outputs first.
    pub(super) from_outputs: Vec<bool>,
    pub(super) from_state: Vec<bool>,
    pub(super) domains: Vec<Domain>,
    pub(super) kept: Vec<(usize, &'static str, &'static str)>,
}

/// What is not the same in table and monitor.
#[derive(Default)]
pub(super) struct Words {
    /// Names of the table, each with that of the monitor.
    pub(super) named: &'static [(&'static str, &'static str)],
    pub(super) constants: &'static [(&'static str, i64)],
    pub(super) hidden: &'static [&'static str],
    pub(super) unused: &'static [&'static str],
    /// Why the table is too small.
    pub(super) lacks: Option<&'static str>,
    pub(super) made: Vec<(&'static str, &'static [&'static str], Make)>,
    pub(super) cells: Vec<(&'static str, Domain)>,
    pub(super) kept: Vec<(&'static str, &'static str, &'static str)>,
    pub(super) only: Vec<(&'static [&'static str], Values)>,
    pub(super) explored: Vec<(&'static [&'static str], Values)>,
    /// Parameters that the table has as inputs, each with the port.
    pub(super) live: Vec<(&'static str, &'static str)>,
}

impl Words {
    /// What the table calls a number of the monitor.
    fn table_name(&self, number: &Number) -> &'static str {
        let named = (self.named.iter()).find(|(_, name)| has(&number.name, name));
        named.map_or(number.short, |(table, _)| table)
    }

    fn constant(&self, own: &str) -> Option<i64> {
        let found = self.constants.iter().find(|(name, _)| has(own, name));
        found.map(|(_, value)| *value)
    }

    fn is_hidden(&self, own: &str) -> bool {
        self.hidden.iter().any(|name| has(own, name))
    }

    /// The numbers of the configuration that inputs give, each with its port.
    fn changing(&self, numbers: &[Number]) -> Vec<(usize, &'static str)> {
        let numbers = numbers.iter().enumerate();
        let found = numbers.filter_map(|(k, number)| {
            let live = self.live.iter().find(|(name, _)| has(&number.name, name));
            live.map(|(_, port)| (k, *port))
        });
        found.collect()
    }

    /// The numbers of the configuration, from the parameters of the table.
    pub(super) fn values(&self, params: &Params, numbers: &[Number]) -> Result<Vec<i64>, Refusal> {
        let value = |number: &Number| {
            let name = number.name.as_str();
            let live = self.live.iter().any(|(live, _)| has(name, live));
            Ok(match self.constant(name) {
                Some(value) => value,
                None if live => 0,
                None => i64::from(params.known(self.table_name(number))?),
            })
        };
        numbers.iter().map(value).collect()
    }

    /// Whether the table is large enough, and each name given one of the monitor.
    pub(super) fn check(&self, shape: &Shape) -> Result<(), Refusal> {
        match (self.lacks, self.unknown(shape)) {
            (Some(text), _) => Err(Refusal::Table(text)),
            (None, Some(name)) => Err(Refusal::Name(name)),
            (None, None) => Ok(()),
        }
    }

    /// A name given for a number that the monitor does not have.
    fn unknown(&self, shape: &Shape) -> Option<&'static str> {
        let Shape {
            config,
            inputs,
            outputs,
            state,
        } = shape;
        let parts = [config, inputs, outputs, state];
        let named = self.named.iter().map(|(_, name)| *name);
        let constants = self.constants.iter().map(|(name, _)| *name);
        let made = self.made.iter().map(|(name, ..)| *name);
        let cells = self.cells.iter().map(|(name, _)| *name);
        let kept = self.kept.iter().map(|(name, ..)| *name);
        let hidden = self.hidden.iter().copied();
        let live = self.live.iter().map(|(name, _)| *name);
        let mut given = named
            .chain(live)
            .chain(constants)
            .chain(made)
            .chain(cells)
            .chain(kept)
            .chain(hidden);
        given.find(|name| {
            !parts
                .into_iter()
                .flatten()
                .any(|number| has(&number.name, name))
        })
    }

    /// Whether the table has a state variable or an output of this name.
    fn shows(params: &Params, name: &str) -> bool {
        let system = &params.bound.system;
        system.states.iter().any(|s| is(&s.var.name, name))
            || (system.lazies.iter()).any(|l| l.kind == LazyKind::Output && is(&l.name, name))
    }

    /// The values of a state.
    fn domain(&self, params: &Params, number: &Number) -> Result<Domain, Refusal> {
        if let Some((_, domain)) = self.cells.iter().find(|(n, _)| has(&number.name, n)) {
            return Ok(*domain);
        }
        let (low, high) = number.kind.ends();
        if !matches!(number.kind, Kind::Whole(..)) || high.saturating_sub(low) < 256 {
            let (lo, hi) = (low as i32, high as i32);
            return Ok(Domain { lo, hi });
        }
        let bound = params.bound;
        let name = self.table_name(number);
        let found = (bound.system.states.iter()).position(|s| is(&s.var.name, name));
        match found.map(|k| bound.states[k]) {
            Some((lo, hi)) => Ok(Domain { lo, hi }),
            None => Err(Refusal::Unknown(format!(
                "the values of the state `{name}`"
            ))),
        }
    }

    /// Which number of the monitor goes where.
    pub(super) fn plan(&self, params: &Params, shape: &Shape) -> Result<Plan, Refusal> {
        let mut plan = Plan::default();
        for number in &shape.inputs {
            let made = self.made.iter().find(|(n, ..)| has(&number.name, n));
            plan.feeds.push(match (self.constant(&number.name), made) {
                (Some(value), _) => Feed::Constant(value),
                (None, Some((_, parts, make))) => {
                    let first = plan.ports.len();
                    plan.ports.extend(*parts);
                    Feed::Made(first, *make)
                }
                (None, None) => {
                    plan.ports.push(self.table_name(number));
                    Feed::Port(plan.ports.len() - 1)
                }
            });
        }
        for (number, port) in self.changing(&shape.config) {
            plan.live.push((number, plan.ports.len()));
            plan.ports.push(port);
        }
        for number in &shape.outputs {
            let compared = !self.is_hidden(&number.name);
            plan.from_outputs.push(compared);
            if compared {
                plan.outputs.push(self.table_name(number));
            }
        }
        for (cell, number) in shape.state.iter().enumerate() {
            plan.domains.push(self.domain(params, number)?);
            let name = self.table_name(number);
            let known = plan.outputs.contains(&name);
            let compared = !known && !self.is_hidden(&number.name) && Self::shows(params, name);
            plan.from_state.push(compared);
            if compared {
                plan.outputs.push(name);
            }
            let own = self.kept.iter().find(|(n, ..)| has(&number.name, n));
            plan.kept
                .extend(own.map(|(_, variable, condition)| (cell, *variable, *condition)));
        }
        Ok(plan)
    }

    /// The adapter with what is not to be explored, or begins otherwise.
    pub(super) fn restricted(
        self,
        adapter: Adapter,
        kept: Vec<(usize, &'static str, &'static str)>,
    ) -> Adapter {
        let mut adapter = adapter.without(self.unused);
        for (inputs, values) in self.only {
            adapter = adapter.only(inputs, values);
        }
        for (inputs, values) in self.explored {
            adapter = adapter.explored(inputs, values);
        }
        for (cell, variable, condition) in kept {
            adapter = adapter.kept_where(cell, variable, condition);
        }
        adapter
    }
}

/// Whether a number, with the names of the fields it is in, is the one of this name or one of those below it.
fn has(path: &str, name: &str) -> bool {
    let (path, name) = (format!(".{path}."), format!(".{name}."));
    path.contains(&name)
}
