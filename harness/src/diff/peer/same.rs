//! The peer of a monitor that its table describes in the same words: each number of the monitor goes to the port, state variable
//! or parameter of its name. What is called otherwise, or is not on both sides, is said one by one.

use stillpoint_model::Domain;
use stillpoint_monitors::contract::{Contract, Next};
use stillpoint_monitors::fields::Fields;
use stillpoint_monitors::mutant::Mutant;

use super::adapter::Adapter;
use super::cells::{Number, cell, get, load, set, stored};
use super::words::{Feed, Make, Plan, Shape, Words};
use super::{Params, Refusable, Refusal, chosen};
use crate::diff::product::Values;

/// An output that the table has and the monitor does not: what it is made of.
type Told<M> = fn(&<M as Contract>::State, &<M as Contract>::Outputs) -> i64;

/// A word of the outputs of a monitor.
type Word<M> = fn(&<M as Contract>::Outputs) -> u16;

/// The peer of `M` as far as it is known.
pub(crate) struct Same<'a, M: Contract> {
    params: &'a Params<'a>,
    next: Next<M>,
    words: Words,
    /// Where it is not made of the parameters by their names.
    config: Option<M::Config>,
    told: Vec<(&'static str, Told<M>)>,
    /// Outputs that are each a bit of a word.
    bits: Vec<(&'static str, Word<M>, u32)>,
    decided: Vec<(&'static str, Decide<M>)>,
}

/// An input of the table that the parameters of the monitor decide.
type Decide<M> = fn(&<M as Contract>::Config) -> bool;

impl<'a, M: Contract> Same<'a, M> {
    /// The monitor under the parameters of a table, or its wrong variant.
    pub(crate) fn new(params: &'a Params<'a>, mutant: Option<Mutant>) -> Self {
        Self {
            params,
            next: chosen::<M>(mutant),
            words: Words::default(),
            config: None,
            told: Vec::new(),
            bits: Vec::new(),
            decided: Vec::new(),
        }
    }

    /// Names of the table that are others in the monitor. A part of the monitor's name is enough that stands in no other.
    pub(crate) fn named(mut self, named: &'static [(&'static str, &'static str)]) -> Self {
        self.words.named = named;
        self
    }

    /// Parameters and inputs of the monitor that the table does not have.
    pub(crate) fn constants(mut self, constants: &'static [(&'static str, i64)]) -> Self {
        self.words.constants = constants;
        self
    }

    /// The configuration, where its parameters are not those of the table.
    pub(crate) fn config(mut self, config: M::Config) -> Self {
        self.config = Some(config);
        self
    }

    /// What the parameters of the table must be, because it is smaller than the monitor.
    pub(crate) fn needs(mut self, holds: bool, text: &'static str) -> Self {
        self.words.lacks = self.words.lacks.or((!holds).then_some(text));
        self
    }

    /// Outputs of the monitor that the table does not have, and states that are not to be compared.
    pub(crate) fn hidden(mut self, hidden: &'static [&'static str]) -> Self {
        self.words.hidden = hidden;
        self
    }

    /// Inputs that only the table has, for other readings than the recommended ones.
    pub(crate) fn without(mut self, unused: &'static [&'static str]) -> Self {
        self.words.unused = unused;
        self
    }

    /// An output that the table has in other words.
    pub(crate) fn told(mut self, name: &'static str, told: Told<M>) -> Self {
        self.told.push((name, told));
        self
    }

    /// Outputs that the table has one by one and the monitor as the bits of a word, each with its place.
    pub(crate) fn bits(mut self, word: Word<M>, places: &'static [(&'static str, u32)]) -> Self {
        let places = places.iter();
        self.bits
            .extend(places.map(|(name, place)| (*name, word, *place)));
        self
    }

    /// An input that the table has in other words: the ports it is made of.
    pub(crate) fn made(
        mut self,
        name: &'static str,
        ports: &'static [&'static str],
        make: Make,
    ) -> Self {
        self.words.made.push((name, ports, make));
        self
    }

    /// The values of a state that the table does not have.
    pub(crate) fn cell(mut self, name: &'static str, domain: Domain) -> Self {
        self.words.cells.push((name, domain));
        self
    }

    /// A state that starts with the value of a state variable of the table, which is not 0: non-volatile state.
    pub(crate) fn kept(self, name: &'static str, variable: &'static str) -> Self {
        self.kept_where(name, variable, variable)
    }

    /// The same where another state variable of the table is not 0; else the state starts as ever.
    pub(crate) fn kept_where(
        mut self,
        name: &'static str,
        variable: &'static str,
        condition: &'static str,
    ) -> Self {
        self.words.kept.push((name, variable, condition));
        self
    }

    /// Restricts inputs to the values they have at this interface.
    pub(crate) fn only(mut self, inputs: &'static [&'static str], values: Values) -> Self {
        self.words.only.push((inputs, values));
        self
    }

    /// Restricts wide inputs to some of their values in an exploration; random runs have all.
    pub(crate) fn explored(mut self, inputs: &'static [&'static str], values: Values) -> Self {
        self.words.explored.push((inputs, values));
        self
    }

    /// An input that only the table has: what the parameters make of it.
    pub(crate) fn decided(mut self, name: &'static str, decide: Decide<M>) -> Self {
        self.decided.push((name, decide));
        self
    }

    /// A parameter of the monitor that the table has as an input: it may change from cycle to cycle.
    pub(crate) fn live(mut self, parameter: &'static str, port: &'static str) -> Self {
        self.words.live.push((parameter, port));
        self
    }

    /// The configuration, from the parameters of the table.
    fn configuration(&self, numbers: &[Number]) -> Result<M::Config, Refusal> {
        if let Some(config) = self.config {
            return Ok(config);
        }
        let values = self.words.values(self.params, numbers)?;
        let config = set(&mut values.iter().copied());
        // A number that the type does not have has become another one.
        let mut same = true;
        let mut given = values.iter();
        get(config, &mut |number| same &= given.next() == Some(&number));
        if same && M::accepted(&config) {
            Ok(config)
        } else {
            Err(Refusal::Values(format!("{values:?}")))
        }
    }

    /// The peer.
    pub(crate) fn peer(self) -> Refusable {
        let shape = Shape::of::<M>();
        self.words.check(&shape)?;
        let config = self.configuration(&shape.config)?;
        let mut plan = self.words.plan(self.params, &shape)?;
        let told: Vec<Told<M>> = self.told.iter().map(|(_, told)| *told).collect();
        let bits = self.bits;
        plan.outputs.extend(self.told.iter().map(|(name, _)| *name));
        plan.outputs.extend(bits.iter().map(|(name, ..)| *name));
        let Plan {
            ports,
            feeds,
            live,
            outputs,
            from_outputs,
            from_state,
            domains,
            kept,
        } = plan;
        let next = self.next;
        let step = move |cells: &mut [i32], ports: &[i32], said: &mut super::Numbers| {
            let state = load(cells);
            let inputs = set(&mut feeds.iter().map(|feed| match feed {
                Feed::Port(k) => i64::from(ports[*k]),
                Feed::Constant(value) => *value,
                Feed::Made(first, make) => make(&ports[*first..]),
            }));
            let config = match live.is_empty() {
                true => config,
                false => changed(config, &live, ports),
            };
            let (after, outputs) = next(state, &config, &inputs);
            let mut compared = from_outputs.iter();
            get(outputs, &mut |number| {
                said.extend(compared.next().filter(|c| **c).map(|_| number))
            });
            let (mut compared, mut own) = (from_state.iter(), cells.iter_mut());
            get(after, &mut |number| {
                said.extend(compared.next().filter(|c| **c).map(|_| number));
                if let Some(place) = own.next() {
                    *place = cell(number);
                }
            });
            said.extend(told.iter().map(|told| told(&after, &outputs)));
            let bit = |(_, word, place): &(_, Word<M>, u32)| i64::from(word(&outputs) >> place & 1);
            said.extend(bits.iter().map(bit));
        };
        let adapter = Adapter::of(ports, outputs, domains, stored(M::INITIAL), step);
        let mut adapter = self.words.restricted(adapter, kept);
        for (name, decide) in self.decided {
            adapter = adapter.with(name, i32::from(decide(&config)));
        }
        Ok(adapter)
    }
}

/// The configuration with some of its numbers from ports.
fn changed<C: Fields>(config: C, live: &[(usize, usize)], ports: &[i32]) -> C {
    let mut values = Vec::new();
    get(config, &mut |number| values.push(number));
    for (number, port) in live {
        values[*number] = i64::from(ports[*port]);
    }
    set(&mut values.into_iter())
}

/// The monitors of a family that its tables describe in the same words: the machine of the table, the module of the monitor, and
/// what is not the same.
macro_rules! peers {
    ($family:ident |$params:ident| $($machine:literal => $monitor:ident $(.$what:ident($($how:expr),* $(,)?))*;)+) => {
        /// The machines of these tables, each with the module of its monitor.
        pub(crate) const MACHINES: &[(&str, &str)] = &[$(($machine, stringify!($monitor))),+];

        /// The monitor of a machine.
        pub(crate) fn make(machine: &str, $params: &Params, mutant: Option<Mutant>) -> Made {
            Ok(Some(match machine {
                $($machine => Same::<stillpoint_monitors::$family::$monitor::Monitor>::new($params, mutant)
                    $(.$what($($how),*))*
                    .peer()?,)+
                _ => return Ok(None),
            }))
        }
    };
}

pub(crate) use peers;
