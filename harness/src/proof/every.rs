//! Every configuration at once: parameters as state variables that start with any value of their range and never change.
//!
//! What depends on them becomes an expression over these variables: ranges, start values, bounds of responses. Which values may stand
//! together is told by conditions, as further atoms of the system. The result is a system like any other.

use stillpoint_lang::bind::{Bound, Bounds};
use stillpoint_lang::cells::together;
use stillpoint_lang::condition::Condition;
use stillpoint_lang::ir::{BinaryOp, Form, Node, Param, Property, Space, State, Stmt, Ty, Var};
use stillpoint_lang::twice::twice;
use stillpoint_model::Trace;

use super::linear::Linear;
use crate::export::range_of;

/// A parameter and the values that it is to have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Span {
    /// Its name; that of an array stands for all its elements.
    pub name: String,
    /// Least and greatest value; none for the whole range that is documented.
    pub values: Option<(i64, i64)>,
}

/// Which parameters are to have every value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Which {
    /// All of them, over their whole range. Readings keep the option that was chosen.
    All,
    /// These, as far as a system has them.
    Named(Vec<Span>),
}

/// A system with all values of some parameters.
pub struct Every {
    /// It, the parameters among its state variables.
    pub bound: Bound,
    /// The parameters: places of their state variables.
    pub parameters: Vec<usize>,
    /// What these values satisfy.
    pub conditions: Vec<Condition>,
    /// The number of the system's own state variables, which stand first.
    pub(super) own: usize,
    /// Atoms that hold at the start, and from then on.
    pub(super) always: Vec<usize>,
    /// Atoms that hold at the start.
    pub(super) start: Vec<usize>,
    /// Atoms that hold of the inputs of each cycle.
    pub(super) assumed: Vec<usize>,
    /// By property the state variable that has its bound, where that depends on the parameters.
    pub(super) within: Vec<Option<usize>>,
    /// By property what its bound is made of.
    pub(super) about: Vec<Linear>,
}

impl Every {
    /// Sets parameters free. Names that the system does not have are passed over.
    ///
    /// # Errors
    /// One sentence: values outside a parameter's range, a system that cannot be told so.
    pub fn new(bound: &Bound, which: &Which) -> Result<Self, String> {
        Self::such(bound, which, &[])
    }

    /// The same for those values alone that satisfy some conditions.
    ///
    /// # Errors
    /// As [`Every::new`].
    pub fn such(bound: &Bound, which: &Which, conditions: &[Condition]) -> Result<Self, String> {
        let mut builder = Builder::new(bound, which)?;
        builder.every.conditions = conditions.to_vec();
        builder.system();
        builder.parameters()?;
        builder.conditions();
        builder.states()?;
        builder.inputs()?;
        builder.bounds()?;
        Ok(builder.every)
    }

    /// Two runs side by side with the same parameters, and the state variables that each has by itself, see
    /// [`stillpoint_lang::twice`].
    pub(crate) fn twice(&self, property: &Property) -> Option<(Self, Vec<(usize, usize)>)> {
        let both = twice(&self.bound, property)?;
        let of_both = |atoms: &[usize]| -> Vec<usize> {
            let second = atoms.iter().map(|k| k + both.atoms);
            atoms.iter().copied().chain(second).collect()
        };
        let every = Every {
            parameters: self.parameters.clone(),
            conditions: self.conditions.clone(),
            own: self.own,
            always: of_both(&self.always),
            start: of_both(&self.start),
            assumed: of_both(&self.assumed),
            within: vec![None],
            about: vec![Linear::default()],
            bound: both.bound,
        };
        Some((every, both.pairs))
    }

    /// The state variable that a parameter has become, by their places.
    pub(super) fn place(&self, param: usize) -> Option<usize> {
        let name = &self.bound.system.params.get(param)?.var.name;
        let mut places = self.parameters.iter();
        let own = places.find(|k| self.bound.system.states[**k].var.name == *name);
        own.copied()
    }

    /// The values that a parameter has.
    pub fn range_of(&self, param: usize) -> (i64, i64) {
        let value = self.bound.values.get(param).copied().unwrap_or_default();
        let (lo, hi) = (self.place(param)).map_or((value, value), |k| self.bound.states[k]);
        (i64::from(lo), i64::from(hi))
    }

    /// The value of each parameter of the system in a run.
    pub fn configuration(&self, trace: &Trace) -> Vec<i64> {
        let value = |param: usize| match self.place(param) {
            Some(place) => begins(&self.bound, trace, place),
            None => self.range_of(param).0,
        };
        (0..self.bound.system.params.len()).map(value).collect()
    }

    /// The parameters with their ranges, and how many configurations there are at most.
    pub fn text(&self) -> String {
        if self.parameters.is_empty() {
            return "no parameter: one configuration".to_owned();
        }
        let mut count = 1.0_f64;
        let one = |k: &usize| {
            let (lo, hi) = self.bound.states[*k];
            count *= f64::from(hi.abs_diff(lo)) + 1.0;
            let var = &self.bound.system.states[*k].var;
            let range = match var.ty {
                Ty::Bool if lo < hi => "any".to_owned(),
                ty => {
                    let show = |v: i32| self.bound.system.show(ty, i64::from(v));
                    format!("= {} .. {}", show(lo), show(hi))
                }
            };
            (var.name.clone(), range)
        };
        let list = together(self.parameters.iter().map(one));
        let list: Vec<String> = (list.into_iter())
            .map(|(name, range)| format!("{name} {range}"))
            .collect();
        let count = match count < 1e6 {
            true => format!("{count}"),
            false => format!("{count:.1e}"),
        };
        format!("{}: {count} configurations", list.join(", "))
    }
}

/// The value with which a state variable starts in a run.
pub(super) fn begins(bound: &Bound, trace: &Trace, k: usize) -> i64 {
    let chosen = trace.initial.iter().find(|(cell, _)| *cell as usize == k);
    i64::from(bound.states[k].0) + chosen.map_or(0, |(_, offset)| i64::from(*offset))
}

struct Builder<'a> {
    /// The system as it was.
    old: &'a Bound,
    every: Every,
    /// By parameter the state variable that it becomes.
    places: Vec<Option<u32>>,
    spans: Vec<Option<(i64, i64)>>,
}

impl<'a> Builder<'a> {
    fn new(old: &'a Bound, which: &Which) -> Result<Self, String> {
        let mut builder = Builder {
            old,
            every: Every {
                bound: old.clone(),
                parameters: Vec::new(),
                conditions: Vec::new(),
                own: old.states.len(),
                always: Vec::new(),
                start: Vec::new(),
                assumed: Vec::new(),
                within: vec![None; old.system.properties.len()],
                about: vec![Linear::default(); old.system.properties.len()],
            },
            places: vec![None; old.system.params.len()],
            spans: vec![None; old.system.params.len()],
        };
        for (k, param) in old.system.params.iter().enumerate() {
            let name = param.var.array();
            let chosen = match which {
                _ if param.reading.is_some() => None,
                Which::All => Some(None),
                Which::Named(list) => {
                    let named = list.iter().find(|span| span.name == name);
                    named.map(|span| span.values)
                }
            };
            if let Some(values) = chosen {
                builder.spans[k] = values;
                let place = old.states.len() + builder.every.parameters.len();
                builder.places[k] = Some(place as u32);
                builder.every.parameters.push(place);
            }
        }
        Ok(builder)
    }

    /// An expression in which the parameters are state variables.
    fn node(&self, node: &Node) -> Node {
        // The elements of an array are set free together, so they stand together.
        let mut place = |space, k: u32| match space {
            Space::Param => self.places[k as usize].map_or((space, k), |k| (Space::Before, k)),
            _ => (space, k),
        };
        node.placed(&mut place, &mut |n| self.node(n))
    }

    fn statements(&self, list: &[Stmt]) -> Vec<Stmt> {
        let one = |statement: &Stmt| match statement {
            Stmt::Assign {
                base,
                index,
                value,
                site,
                ..
            } => Stmt::Assign {
                base: *base,
                index: (index.as_ref()).map(|(k, lo, len)| (self.node(k), *lo, *len)),
                value: self.node(value),
                checked: true,
                site: *site,
            },
            Stmt::If(branches, rest) => Stmt::If(
                (branches.iter())
                    .map(|(guard, body)| (self.node(guard), self.statements(body)))
                    .collect(),
                self.statements(rest),
            ),
        };
        list.iter().map(one).collect()
    }

    /// Everything that is said over the parameters, ranges apart.
    fn system(&mut self) {
        let mut system = self.old.system.clone();
        for instance in &mut system.instances {
            for rule in &mut instance.rules {
                rule.when = self.node(&rule.when);
                rule.then = self.statements(&rule.then);
            }
        }
        for lazy in &mut system.lazies {
            lazy.value = self.node(&lazy.value);
        }
        for node in system.atoms.iter_mut().chain(&mut system.observed) {
            *node = self.node(node);
        }
        for state in &mut system.states {
            state.init = state.init.as_ref().map(|n| self.node(n));
            self.range(&mut state.var);
        }
        for var in &mut system.inputs {
            self.range(var);
        }
        self.every.bound.system = system;
    }

    fn range(&self, var: &mut Var) {
        (var.lo, var.hi) = (self.node(&var.lo), self.node(&var.hi));
    }

    /// All values that an expression over the parameters can have.
    fn hull(&self, node: &Node) -> Result<(i64, i64), String> {
        range_of(&self.every.bound, node).map_err(|e| e.0)
    }

    /// The range of a variable over all configurations, and whether it depends on them.
    fn bounds_of(&self, var: &Var) -> Result<(Bounds, bool), String> {
        let (least, low) = self.hull(&var.lo)?;
        let (high, most) = self.hull(&var.hi)?;
        Ok(((least as i32, most as i32), least < low || high < most))
    }

    /// An atom that says that a variable keeps to its range, whatever that is.
    fn keeps(&mut self, cell: Node, var: &Var) -> usize {
        let pair =
            |op, bound: &Node| Node::Binary(op, Box::new(cell.clone()), Box::new(bound.clone()));
        let both = Node::Binary(
            BinaryOp::And,
            Box::new(pair(BinaryOp::Ge, &var.lo)),
            Box::new(pair(BinaryOp::Le, &var.hi)),
        );
        self.atom(both)
    }

    fn atom(&mut self, node: Node) -> usize {
        let atoms = &mut self.every.bound.system.atoms;
        atoms.push(node);
        atoms.len() - 1
    }

    /// A state variable that never changes.
    fn frozen(&mut self, var: Var, range: Bounds) {
        let bound = &mut self.every.bound;
        bound.system.states.push(State { var, init: None });
        bound.states.push(range);
        bound.initial.push(None);
    }

    fn parameters(&mut self) -> Result<(), String> {
        let old = self.old;
        let chosen: Vec<(usize, &Param)> = (old.system.params.iter().enumerate())
            .filter(|(k, _)| self.places[*k].is_some())
            .collect();
        for (k, param) in chosen {
            let mut var = param.var.clone();
            self.range(&mut var);
            let (range, depends) = self.bounds_of(&var)?;
            let mut given = range;
            if let Some((lo, hi)) = self.spans[k] {
                let (least, most) = (i64::from(range.0), i64::from(range.1));
                if lo < least || hi > most || lo > hi {
                    return Err(format!(
                        "parameter `{}` of {}: {lo}..{hi} is no part of its range {least}..{most}",
                        param.var.name, old.system.name
                    ));
                }
                given = (lo as i32, hi as i32);
            }
            let place = self.every.bound.states.len();
            let cell = Node::Cell(Space::Before, place as u32);
            if depends {
                let atom = self.keeps(cell, &var);
                self.every.always.push(atom);
            }
            // What depends on earlier parameters is told by the condition.
            (var.lo, var.hi) = (
                Node::Const(i64::from(given.0)),
                Node::Const(i64::from(given.1)),
            );
            self.frozen(var, given);
        }
        Ok(())
    }

    fn conditions(&mut self) {
        for condition in self.every.conditions.clone() {
            let node = self.node(&condition.node());
            let atom = self.atom(node);
            self.every.always.push(atom);
        }
    }

    /// Ranges and start values of the system's own state variables.
    fn states(&mut self) -> Result<(), String> {
        for k in 0..self.old.states.len() {
            let state = self.every.bound.system.states[k].clone();
            let (range, depends) = self.bounds_of(&state.var)?;
            self.every.bound.states[k] = range;
            let cell = Node::Cell(Space::Before, k as u32);
            if depends {
                let atom = self.keeps(cell.clone(), &state.var);
                self.every.always.push(atom);
            }
            if let Some(init) = &state.init {
                let (lo, hi) = self.hull(init)?;
                if lo < hi {
                    let starts = Node::Binary(BinaryOp::Eq, Box::new(cell), Box::new(init.clone()));
                    let atom = self.atom(starts);
                    self.every.start.push(atom);
                    self.every.bound.initial[k] = None;
                }
            }
        }
        Ok(())
    }

    fn inputs(&mut self) -> Result<(), String> {
        for k in 0..self.old.inputs.len() {
            let var = self.every.bound.system.inputs[k].clone();
            let (range, depends) = self.bounds_of(&var)?;
            self.every.bound.inputs[k] = range;
            if depends {
                let atom = self.keeps(Node::Cell(Space::Input, k as u32), &var);
                self.every.assumed.push(atom);
            }
        }
        Ok(())
    }

    /// A bound over parameters is a variable of its own. What is recorded of the least bound and the fastest reaction is about one
    /// configuration each, and left out.
    fn bounds(&mut self) -> Result<(), String> {
        for k in 0..self.old.system.properties.len() {
            let property = &mut self.every.bound.system.properties[k];
            property.stated = Default::default();
            let Form::LeadsTo {
                within: Some(within),
                ..
            } = &self.old.system.properties[k].form
            else {
                continue;
            };
            let within = self.node(within);
            let (lo, hi) = self.hull(&within)?;
            if lo == hi {
                continue;
            }
            self.every.about[k] = Linear::of(&within);
            let place = self.every.bound.states.len();
            let cell = Node::Cell(Space::Before, place as u32);
            let is = Node::Binary(BinaryOp::Eq, Box::new(cell), Box::new(within));
            let atom = self.atom(is);
            self.every.always.push(atom);
            self.every.within[k] = Some(place);
            let id = &self.old.system.properties[k].id;
            let var = Var {
                name: format!("{id}.within"),
                ty: Ty::Int,
                lo: Node::Const(lo),
                hi: Node::Const(hi),
                text: String::new(),
                ids: Vec::new(),
            };
            self.frozen(var, (lo as i32, hi as i32));
        }
        Ok(())
    }
}
