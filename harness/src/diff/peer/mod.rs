//! The production monitors as peers (test oracles) of the tables: the same ports, in the numbers of the specification.
//!
//! What they are made of is here; which monitors a family has, and what is not the same in its tables, stands in its own module
//! below [`crate::families`].

pub(crate) mod adapter;
pub(crate) mod cells;
pub(crate) mod numbers;
pub(crate) mod same;
mod words;

use std::cell::RefCell;
use std::collections::BTreeSet;

use stillpoint_lang::bind::Bound;
use stillpoint_model::Domain;
use stillpoint_monitors::contract::{Contract, Next};
use stillpoint_monitors::kernel::{ConfigError, Cycles, Speed};
use stillpoint_monitors::mutant::{Mutant, Wrong};

use super::product::Values;
use super::slices::Slice;
use crate::families;
use adapter::Adapter;

/// Numbers in the order of a list of names.
pub type Numbers = Vec<i64>;

/// A production monitor with its configuration, driven and observed in the numbers of its table.
pub trait Peer: Send + Sync {
    /// Names of the inputs, as the table calls them.
    fn inputs(&self) -> &[&'static str];
    /// Names of the inputs that only the table has, each with the value it keeps; none for its least one.
    fn unused(&self) -> &[(&'static str, Option<i32>)];
    /// The values input `k` can have at this interface; none where every value of the table's type is possible.
    fn allowed(&self, k: usize) -> Option<Values>;
    /// The values input `k` has in an exploration, which cannot try all of a wide one; none where it tries all.
    fn explored(&self, k: usize) -> Option<Values>;
    /// Names of the outputs; each is an output or a state variable of the table.
    fn outputs(&self) -> &[&'static str];
    /// Ranges of the cells of the state.
    fn domains(&self) -> Vec<Domain>;
    /// The initial cells; `table` gives the initial value of a table's state variable, for what is non-volatile.
    fn initial(&self, table: &dyn Fn(&str) -> i32) -> Vec<i32>;
    /// One step from and to cells, with the outputs.
    fn step(&self, cells: &mut [i32], inputs: &[i32], outputs: &mut Numbers);
}

/// The monitors of a family as peers of its tables.
pub struct Peers {
    /// The machines that have a monitor, each with the name of its module; list by list.
    pub(crate) machines: &'static [&'static [(&'static str, &'static str)]],
    /// The systems that have a monitor, several machines together; list by list.
    pub(crate) systems: &'static [&'static [(&'static str, &'static str)]],
    /// Parameters of the tables with the only value for which a comparison means something.
    pub fixed: &'static [(&'static str, &'static str, i64)],
    /// What is explored of a system, or of a machine with too many inputs for one exploration.
    pub(crate) slices: &'static [&'static [Slice]],
    /// The values of inputs that a slice holds, where they are not the least ones.
    pub(crate) calm: &'static [(&'static str, i32)],
    /// What makes the peers.
    pub(crate) make: &'static [Make],
}

/// Makes the peer of a machine or a system that it knows.
pub(crate) type Make = fn(&str, &Params, Option<Mutant>) -> Made;

/// The peer of a machine or a system, by the first that knows it.
pub(crate) fn first(all: &[Make], machine: &str, params: &Params, mutant: Option<Mutant>) -> Made {
    for make in all {
        if let Some(adapter) = make(machine, params, mutant)? {
            return Ok(Some(adapter));
        }
    }
    Ok(None)
}

impl Peers {
    /// The machines that have a monitor, each with the name of its module.
    pub fn machines(&self) -> impl Iterator<Item = (&'static str, &'static str)> + use<> {
        self.machines.iter().flat_map(|list| list.iter().copied())
    }

    /// The systems that have a monitor, each with the name of its module.
    pub fn systems(&self) -> impl Iterator<Item = (&'static str, &'static str)> + use<> {
        self.systems.iter().flat_map(|list| list.iter().copied())
    }
}

/// A name that is no mutant's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownMutant;

impl std::fmt::Display for UnknownMutant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("no mutant has this name; the names are")?;
        for mutant in families::mutants() {
            write!(f, " {}", mutant.name)?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownMutant {}

/// The wrong monitor of a name.
///
/// # Errors
/// [`UnknownMutant`], which lists the names.
pub fn mutant(name: &str) -> Result<Mutant, UnknownMutant> {
    families::mutants()
        .find(|mutant| mutant.name == name)
        .ok_or(UnknownMutant)
}

/// The step function of a monitor, or that of its wrong variant where it has this one.
pub(crate) fn chosen<M: Contract>(mutant: Option<Mutant>) -> Next<M> {
    one_of(M::next, M::wrong(), mutant)
}

/// The step function of the wrong variant, if it is among these; else the right one.
pub(crate) fn one_of<N: Copy>(right: N, wrong: &[Wrong<N>], mutant: Option<Mutant>) -> N {
    let found = wrong.iter().find(|wrong| Some(wrong.mutant) == mutant);
    found.map_or(right, |wrong| wrong.next)
}

/// Why there is no peer under some parameters.
pub(crate) enum Refusal {
    /// The monitor does not accept them.
    Monitor(ConfigError),
    /// The monitor does not accept this configuration.
    Values(String),
    /// A name stands for a number that the monitor does not have.
    Name(&'static str),
    /// The table does not have what the monitor needs.
    Unknown(String),
    /// The table is too small for what the monitor does.
    Table(&'static str),
}

impl From<ConfigError> for Refusal {
    fn from(error: ConfigError) -> Self {
        Self::Monitor(error)
    }
}

/// What comes of making a peer: none for a machine without a monitor, or why there is none under these parameters.
pub(crate) type Made = Result<Option<Adapter>, Refusal>;

/// An adapter, or why there is none under these parameters.
pub(crate) type Refusable = Result<Adapter, Refusal>;

/// The parameters of a machine or system, and which of them the monitor has been given.
pub(crate) struct Params<'a> {
    bound: &'a Bound,
    read: RefCell<BTreeSet<usize>>,
}

impl<'a> Params<'a> {
    pub(crate) fn new(bound: &'a Bound) -> Self {
        Self {
            bound,
            read: RefCell::default(),
        }
    }

    /// A value; 0 for a name that the table does not have.
    pub(crate) fn value(&self, name: &str) -> i32 {
        let mut params = self.bound.system.params.iter();
        let Some(k) = params.position(|p| p.var.name == name) else {
            return 0;
        };
        self.read.borrow_mut().insert(k);
        self.bound.values[k]
    }

    /// A value of a name that the table has.
    pub(crate) fn known(&self, name: &str) -> Result<i32, Refusal> {
        if self.bound.system.params.iter().any(|p| p.var.name == name) {
            Ok(self.value(name))
        } else {
            Err(Refusal::Unknown(format!("the parameter `{name}`")))
        }
    }

    pub(crate) fn is(&self, name: &str) -> bool {
        self.value(name) != 0
    }

    pub(crate) fn time(&self, name: &str) -> Cycles {
        numbers::cycles(self.value(name))
    }

    pub(crate) fn speed(&self, name: &str) -> Speed {
        numbers::speed(self.value(name))
    }
}

/// The monitor that implements `machine`, the name of a machine or system, under the parameters of `bound`, with `mutant` in
/// it if one of that family is given. None if there is no such monitor.
///
/// # Errors
/// The monitor's own refusal of the parameters, or a table too small for it.
pub fn peer(
    machine: &str,
    bound: &Bound,
    mutant: Option<Mutant>,
) -> Result<Option<Box<dyn Peer>>, String> {
    let Some(family) = families::of_table(&bound.system.name) else {
        return Ok(None);
    };
    let made =
        first(family.peers.make, machine, &Params::new(bound), mutant).map_err(|e| match e {
            Refusal::Monitor(e) => {
                format!("the monitor of `{machine}` refuses these parameters: {e:?}")
            }
            Refusal::Values(config) => format!("the monitor of `{machine}` refuses {config}"),
            Refusal::Name(name) => format!("the monitor of `{machine}` has no number `{name}`"),
            Refusal::Unknown(what) => format!("machine `{machine}`: the table does not say {what}"),
            Refusal::Table(text) => format!("machine `{machine}`: {text}"),
        })?;
    Ok(made.map(|adapter| Box::new(adapter) as Box<dyn Peer>))
}

/// The names of the parameters that the monitor of `machine` is given none of, under the values of `bound`: the table has its way
/// with them alone. Empty for what has no monitor; readings aside.
pub fn unread(machine: &str, bound: &Bound) -> Vec<String> {
    let params = Params::new(bound);
    let Some(family) = families::of_table(&bound.system.name) else {
        return Vec::new();
    };
    if !matches!(
        first(family.peers.make, machine, &params, None),
        Ok(Some(_))
    ) {
        return Vec::new();
    }
    let read = params.read.borrow();
    let all = bound.system.params.iter().enumerate();
    all.filter(|(k, p)| p.reading.is_none() && !read.contains(k))
        .map(|(_, p)| p.var.name.clone())
        .collect()
}
