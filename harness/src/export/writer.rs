//! A circuit as text: names for variables and for terms that stand several times, expressions in the target's syntax.

use std::collections::{BTreeMap, HashMap};

use stillpoint_lang::ir::{Ty, Var};

use super::about::one_line;
use super::circuit::{Circuit, Claim, Id, Op};
use super::names::Names;
use super::syntax::Syntax;

/// Which terms get a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Naming {
    /// Those that stand for something with a name in the specification, and larger ones that are used several times.
    Readable,
    /// Only those that are long and used several times, and the next states: where a name is a variable that costs time.
    Sparing,
}

/// Terms of at most so many parts are written out again at each use where names cost time.
const LONG: usize = 16;

/// Writes the expressions of a circuit.
pub struct Writer<'a, S> {
    pub circuit: &'a Circuit<'a>,
    pub syntax: S,
    /// Names of the state variables.
    pub states: Vec<String>,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of terms.
    given: BTreeMap<Id, String>,
    /// Requirement ids of rules and named expressions, by name.
    requirements: HashMap<&'a str, &'a [String]>,
    names: Names,
}

impl<'a, S: Syntax> Writer<'a, S> {
    /// Gives the names.
    pub fn new(circuit: &'a Circuit<'a>, syntax: S, naming: Naming) -> Self {
        let system = &circuit.bound.system;
        let mut names = Names::default();
        let states = (system.states.iter())
            .map(|s| names.give("s_", &s.var.name))
            .collect();
        let inputs = (system.inputs.iter())
            .map(|v| names.give("in_", &v.name))
            .collect();
        let rules = system.rules().map(|r| (r.name.as_str(), &r.ids[..]));
        let lazies = (system.lazies.iter()).map(|l| (l.name.as_str(), &l.ids[..]));
        let mut writer = Self {
            circuit,
            syntax,
            states,
            inputs,
            given: BTreeMap::new(),
            requirements: rules.chain(lazies).collect(),
            names,
        };
        writer.name_terms(naming);
        writer
    }

    fn name_terms(&mut self, naming: Naming) {
        let terms = &self.circuit.terms;
        let roots = self.circuit.roots();
        let below = terms.below(&roots);
        let mut uses: HashMap<Id, usize> = HashMap::new();
        let parts = below.iter().flat_map(|id| terms.op(*id).parts());
        parts
            .chain(roots)
            .for_each(|id| *uses.entry(id).or_default() += 1);
        // Parts of a term as it is written, where a name counts as one.
        let mut sizes: HashMap<Id, usize> = HashMap::new();
        for id in below {
            let op = terms.op(id);
            let size = 1 + op
                .parts()
                .map(|p| sizes.get(&p).map_or(1, |n| *n))
                .sum::<usize>();
            let several = uses.get(&id).is_some_and(|n| *n > 1);
            let label = terms.label(id);
            let named = !op.is_leaf()
                && match naming {
                    Naming::Readable => {
                        let small =
                            matches!(op, Op::Not(_) | Op::Neg(_) | Op::Binary(..)) && size <= 3;
                        label.is_some() || (several && !small)
                    }
                    Naming::Sparing => (several && size > LONG) || self.circuit.next.contains(&id),
                };
            if named {
                let (prefix, name) = match label {
                    Some((prefix, name)) => (prefix, name.to_owned()),
                    None => ("t_", id.to_string()),
                };
                self.given.insert(id, self.names.give(prefix, &name));
            }
            sizes.insert(id, if named { 1 } else { size });
        }
    }

    /// Another name, used by nothing else.
    pub fn another(&mut self, prefix: &str, name: &str) -> String {
        self.names.give(prefix, name)
    }

    /// The named terms that `roots` consist of, themselves included; each after those it consists of.
    pub fn definitions(&self, roots: &[Id]) -> Vec<(Id, &str)> {
        let below = self.circuit.terms.below(roots);
        below
            .into_iter()
            .filter_map(|id| self.given.get(&id).map(|name| (id, name.as_str())))
            .collect()
    }

    /// The inputs that `roots` depend on.
    pub fn read(&self, roots: &[Id]) -> Vec<usize> {
        let terms = &self.circuit.terms;
        let inputs = terms
            .below(roots)
            .into_iter()
            .filter_map(|id| match terms.op(id) {
                Op::Input(k) => Some(k),
                _ => None,
            });
        let mut inputs: Vec<usize> = inputs.collect();
        inputs.sort_unstable();
        inputs
    }

    /// The value of a term, by its name if it has one.
    pub fn show(&self, id: Id) -> String {
        match self.given.get(&id) {
            Some(name) => name.clone(),
            None => self.value(id),
        }
    }

    /// The value of a term, not by its own name.
    pub fn value(&self, id: Id) -> String {
        let syntax = &self.syntax;
        match self.circuit.terms.op(id) {
            Op::Truth(v) => syntax.truth(v).to_owned(),
            Op::Number(v) => syntax.number(v),
            Op::State(k) => self.states[k].clone(),
            Op::Input(k) => self.inputs[k].clone(),
            Op::Not(a) => syntax.not(&self.show(a)),
            Op::Neg(a) => syntax.negative(&self.show(a)),
            Op::Binary(op, a, b) => syntax.binary(op, &self.show(a), &self.show(b)),
            Op::Choice(c, a, b) => syntax.choice(&self.show(c), &self.show(a), &self.show(b)),
        }
    }

    /// A value of a variable, in the target's syntax.
    pub fn constant(&self, var: &Var, value: i32) -> String {
        match var.ty {
            Ty::Bool => self.syntax.truth(value != 0).to_owned(),
            _ => self.syntax.number(i64::from(value)),
        }
    }

    /// What a named term stands for and which requirements it carries; empty for one without a name of its own.
    pub fn remark(&self, id: Id) -> String {
        let Some((_, name)) = self.circuit.terms.label(id) else {
            return String::new();
        };
        match self.requirements.get(name) {
            Some(ids) if !ids.is_empty() => format!("{name} ({})", ids.join(", ")),
            _ => name.to_owned(),
        }
    }
}

/// What a variable is: its name, and what its numbers mean or what the specification says of it.
pub fn meaning(circuit: &Circuit, var: &Var) -> String {
    let enums = &circuit.bound.system.enums;
    match var.ty {
        Ty::Enum(e) => {
            let values = enums.get(e).map_or(&[][..], |e| &e.values[..]);
            let values: Vec<String> = (values.iter().enumerate())
                .map(|(n, v)| format!("{n} {v}"))
                .collect();
            format!("{}: {}", var.name, values.join(", "))
        }
        _ if var.text.is_empty() => var.name.clone(),
        _ => one_line(&format!("{}: {}", var.name, var.text)),
    }
}

/// What a property says.
pub fn statement(claim: &Claim) -> String {
    one_line(&format!("{}: {}", claim.id(), claim.property.text))
}
