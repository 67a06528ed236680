//! The peer of a monitor that its table describes in the same words: each number of the monitor goes to the port, state variable
//! or parameter of its name. What is called otherwise, or is not on both sides, is said one by one.

use stillpoint_lang::ir::LazyKind;
use stillpoint_model::Domain;
use stillpoint_monitors::contract::{Contract, Next};
use stillpoint_monitors::fields::{Fields, Kind, get, set};
use stillpoint_monitors::mutant::Mutant;

use super::adapter::Adapter;
use super::cells::{Number, cell, load, numbers, stored};
use super::{Params, Refusable, Refusal, chosen};
use crate::diff::product::{Values, is};

/// Where the number of an input comes from.
#[derive(Clone, Copy)]
enum Feed {
    Port(usize),
    Constant(i64),
    /// From several ports, the first of which is this one.
    Made(usize, Make),
}

/// A number from the values of ports.
type Make = fn(&[i32]) -> i64;

/// An output that the table has and the monitor does not: what it is made of.
type Told<M> = fn(&<M as Contract>::State, &<M as Contract>::Outputs) -> i64;

/// A word of the outputs of a monitor.
type Word<M> = fn(&<M as Contract>::Outputs) -> u16;

/// The peer of `M` as far as it is known.
pub(crate) struct Same<'a, M: Contract> {
    params: &'a Params<'a>,
    next: Next<M>,
    /// Names of the table, each with that of the monitor.
    named: &'static [(&'static str, &'static str)],
    constants: &'static [(&'static str, i64)],
    hidden: &'static [&'static str],
    unused: &'static [&'static str],
    /// Why the table is too small.
    lacks: Option<&'static str>,
    /// Where it is not made of the parameters by their names.
    config: Option<M::Config>,
    told: Vec<(&'static str, Told<M>)>,
    /// Outputs that are each a bit of a word.
    bits: Vec<(&'static str, Word<M>, u32)>,
    made: Vec<(&'static str, &'static [&'static str], Make)>,
    cells: Vec<(&'static str, Domain)>,
    kept: Vec<(&'static str, &'static str, &'static str)>,
    only: Vec<(&'static [&'static str], Values)>,
    explored: Vec<(&'static [&'static str], Values)>,
    decided: Vec<(&'static str, Decide<M>)>,
    /// Parameters that the table has as inputs, each with the port.
    live: Vec<(&'static str, &'static str)>,
}

/// An input of the table that the parameters of the monitor decide.
type Decide<M> = fn(&<M as Contract>::Config) -> bool;

impl<'a, M: Contract> Same<'a, M> {
    /// The monitor under the parameters of a table, or its wrong variant.
    pub(crate) fn new(params: &'a Params<'a>, mutant: Option<Mutant>) -> Self {
        Self {
            params,
            next: chosen::<M>(mutant),
            named: &[],
            constants: &[],
            hidden: &[],
            unused: &[],
            lacks: None,
            config: None,
            told: Vec::new(),
            bits: Vec::new(),
            made: Vec::new(),
            cells: Vec::new(),
            kept: Vec::new(),
            only: Vec::new(),
            explored: Vec::new(),
            decided: Vec::new(),
            live: Vec::new(),
        }
    }

    /// Names of the table that are others in the monitor. A part of the monitor's name is enough that stands in no other.
    pub(crate) fn named(mut self, named: &'static [(&'static str, &'static str)]) -> Self {
        self.named = named;
        self
    }

    /// Parameters and inputs of the monitor that the table does not have.
    pub(crate) fn constants(mut self, constants: &'static [(&'static str, i64)]) -> Self {
        self.constants = constants;
        self
    }

    /// The configuration, where its parameters are not those of the table.
    pub(crate) fn config(mut self, config: M::Config) -> Self {
        self.config = Some(config);
        self
    }

    /// What the parameters of the table must be, because it is smaller than the monitor.
    pub(crate) fn needs(mut self, holds: bool, text: &'static str) -> Self {
        self.lacks = self.lacks.or((!holds).then_some(text));
        self
    }

    /// Outputs of the monitor that the table does not have, and states that are not to be compared.
    pub(crate) fn hidden(mut self, hidden: &'static [&'static str]) -> Self {
        self.hidden = hidden;
        self
    }

    /// Inputs that only the table has, for other readings than the recommended ones.
    pub(crate) fn without(mut self, unused: &'static [&'static str]) -> Self {
        self.unused = unused;
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
        self.made.push((name, ports, make));
        self
    }

    /// The values of a state that the table does not have.
    pub(crate) fn cell(mut self, name: &'static str, domain: Domain) -> Self {
        self.cells.push((name, domain));
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
        self.kept.push((name, variable, condition));
        self
    }

    /// Restricts inputs to the values they have at this interface.
    pub(crate) fn only(mut self, inputs: &'static [&'static str], values: Values) -> Self {
        self.only.push((inputs, values));
        self
    }

    /// Restricts wide inputs to some of their values in an exploration; random runs have all.
    pub(crate) fn explored(mut self, inputs: &'static [&'static str], values: Values) -> Self {
        self.explored.push((inputs, values));
        self
    }

    /// An input that only the table has: what the parameters make of it.
    pub(crate) fn decided(mut self, name: &'static str, decide: Decide<M>) -> Self {
        self.decided.push((name, decide));
        self
    }

    /// A parameter of the monitor that the table has as an input: it may change from cycle to cycle.
    pub(crate) fn live(mut self, parameter: &'static str, port: &'static str) -> Self {
        self.live.push((parameter, port));
        self
    }

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
    fn changing(&self) -> Vec<(usize, &'static str)> {
        let numbers = numbers::<M::Config>("config");
        let numbers = numbers.iter().enumerate();
        let found = numbers.filter_map(|(k, number)| {
            let live = self.live.iter().find(|(name, _)| has(&number.name, name));
            live.map(|(_, port)| (k, *port))
        });
        found.collect()
    }

    /// The configuration, from the parameters of the table.
    fn configuration(&self) -> Result<M::Config, Refusal> {
        if let Some(config) = self.config {
            return Ok(config);
        }
        let mut values = Vec::new();
        for number in &numbers::<M::Config>("config") {
            let live = self.live.iter().any(|(name, _)| has(&number.name, name));
            values.push(match self.constant(&number.name) {
                Some(value) => value,
                None if live => 0,
                None => i64::from(self.params.known(self.table_name(number))?),
            });
        }
        let config = set(values.iter().copied());
        // A number that the type does not have has become another one.
        let mut same = true;
        let mut given = values.iter();
        get(config, |number| same &= given.next() == Some(&number));
        if same && M::accepted(&config) {
            Ok(config)
        } else {
            Err(Refusal::Values(format!("{values:?}")))
        }
    }

    /// A name given for a number that the monitor does not have.
    fn unknown(&self) -> Option<&'static str> {
        let parts = [
            numbers::<M::Config>("config"),
            numbers::<M::Inputs>("inputs"),
            numbers::<M::Outputs>("outputs"),
            numbers::<M::State>("state"),
        ];
        let all = parts.concat();
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
        given.find(|name| !all.iter().any(|number| has(&number.name, name)))
    }

    /// Whether the table has a state variable or an output of this name.
    fn shows(&self, name: &str) -> bool {
        let system = &self.params.bound.system;
        system.states.iter().any(|s| is(&s.var.name, name))
            || (system.lazies.iter()).any(|l| l.kind == LazyKind::Output && is(&l.name, name))
    }

    /// The values of a state.
    fn domain(&self, number: &Number) -> Result<Domain, Refusal> {
        if let Some((_, domain)) = self.cells.iter().find(|(n, _)| has(&number.name, n)) {
            return Ok(*domain);
        }
        let (low, high) = number.kind.ends();
        if !matches!(number.kind, Kind::Whole(..)) || high.saturating_sub(low) < 256 {
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
    pub(crate) fn peer(self) -> Refusable {
        if let Some(text) = self.lacks {
            return Err(Refusal::Table(text));
        }
        if let Some(name) = self.unknown() {
            return Err(Refusal::Name(name));
        }
        let config = self.configuration()?;
        let mut ports = Vec::new();
        let mut feeds = Vec::new();
        for number in &numbers::<M::Inputs>("inputs") {
            let made = self.made.iter().find(|(n, ..)| has(&number.name, n));
            feeds.push(match (self.constant(&number.name), made) {
                (Some(value), _) => Feed::Constant(value),
                (None, Some((_, parts, make))) => {
                    let first = ports.len();
                    ports.extend(*parts);
                    Feed::Made(first, *make)
                }
                (None, None) => {
                    ports.push(self.table_name(number));
                    Feed::Port(ports.len() - 1)
                }
            });
        }
        let mut live = Vec::new();
        for (number, port) in self.changing() {
            live.push((number, ports.len()));
            ports.push(port);
        }
        // Which of the numbers are compared, outputs first.
        let mut outputs = Vec::new();
        let mut from_outputs = Vec::new();
        for number in &numbers::<M::Outputs>("outputs") {
            let compared = !self.is_hidden(&number.name);
            from_outputs.push(compared);
            if compared {
                outputs.push(self.table_name(number));
            }
        }
        let mut from_state = Vec::new();
        let mut domains = Vec::new();
        let mut kept = Vec::new();
        for (cell, number) in numbers::<M::State>("state").iter().enumerate() {
            domains.push(self.domain(number)?);
            let name = self.table_name(number);
            let known = outputs.contains(&name);
            let compared = !known && !self.is_hidden(&number.name) && self.shows(name);
            from_state.push(compared);
            if compared {
                outputs.push(name);
            }
            let own = self.kept.iter().find(|(n, ..)| has(&number.name, n));
            kept.extend(own.map(|(_, variable, condition)| (cell, *variable, *condition)));
        }
        let told: Vec<Told<M>> = self.told.iter().map(|(_, told)| *told).collect();
        outputs.extend(self.told.iter().map(|(name, _)| *name));
        let bits = self.bits;
        outputs.extend(bits.iter().map(|(name, ..)| *name));
        let next = self.next;
        let step = move |cells: &mut [i32], ports: &[i32], said: &mut super::Numbers| {
            let state = load(cells);
            let inputs = set(feeds.iter().map(|feed| match feed {
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
            get(outputs, |number| {
                said.extend(compared.next().filter(|c| **c).map(|_| number))
            });
            let (mut compared, mut own) = (from_state.iter(), cells.iter_mut());
            get(after, |number| {
                said.extend(compared.next().filter(|c| **c).map(|_| number));
                if let Some(place) = own.next() {
                    *place = cell(number);
                }
            });
            said.extend(told.iter().map(|told| told(&after, &outputs)));
            let bit = |(_, word, place): &(_, Word<M>, u32)| i64::from(word(&outputs) >> place & 1);
            said.extend(bits.iter().map(bit));
        };
        let mut adapter =
            Adapter::of(ports, outputs, domains, stored(M::INITIAL), step).without(self.unused);
        for (inputs, values) in self.only {
            adapter = adapter.only(inputs, values);
        }
        for (inputs, values) in self.explored {
            adapter = adapter.explored(inputs, values);
        }
        for (name, decide) in self.decided {
            adapter = adapter.with(name, i32::from(decide(&config)));
        }
        for (cell, variable, condition) in kept {
            adapter = adapter.kept_where(cell, variable, condition);
        }
        Ok(adapter)
    }
}

/// The configuration with some of its numbers from ports.
fn changed<C: Fields>(config: C, live: &[(usize, usize)], ports: &[i32]) -> C {
    let mut values = Vec::new();
    get(config, |number| values.push(number));
    for (number, port) in live {
        values[*number] = i64::from(ports[*port]);
    }
    set(values.into_iter())
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

/// Whether a number, with the names of the fields it is in, is the one of this name or one of those below it.
fn has(path: &str, name: &str) -> bool {
    let (path, name) = (format!(".{path}."), format!(".{name}."));
    path.contains(&name)
}
