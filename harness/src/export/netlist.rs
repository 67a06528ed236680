//! A system as a netlist (bit-blasting): what `export --to aiger` writes and the proof engines work on.
//!
//! A variable has as many bits as its range needs, in two's complement if it goes below zero. Of a variable whose bits can hold more
//! than its range, inputs are assumed to keep to it, and states do by themselves. A cycle with a range fault leaves the state as it
//! is, as in the other formats.

use std::collections::HashMap;

use stillpoint_lang::bind::{Bound, Bounds};
use stillpoint_lang::ir::BinaryOp;
use stillpoint_model::Trace;
use stillpoint_model::proof::{Lit, Netlist, Run, Word, number};

use super::Unsupported;
use super::circuit::{Circuit, Id, Op, Sort};
use super::folded::Folded;

/// A system as a netlist.
pub(crate) struct Translated<'a> {
    pub bound: &'a Bound,
    pub netlist: Netlist,
    /// A value leaves its range in this cycle.
    pub fault: Lit,
    /// Atoms of the properties; none for one that cannot be told.
    pub atoms: Vec<Option<Lit>>,
    /// By state variable, the places of its bits among the latches.
    states: Vec<Vec<usize>>,
    /// By input, the places of its bits among the inputs of the netlist.
    inputs: Vec<Vec<usize>>,
    /// Ids of the properties that are not about single cycles.
    pub left_out: Vec<&'a str>,
    /// By id: the `always` properties with what breaks them, the witnesses with what shows them.
    pub broken: Vec<(String, Lit)>,
    pub shown: Vec<(String, Lit)>,
}

/// The value of a term.
#[derive(Clone)]
enum Value {
    Truth(Lit),
    Number(Word),
}

impl Value {
    fn word(&self) -> Word {
        match self {
            Value::Truth(lit) => Word::truth(*lit),
            Value::Number(word) => word.clone(),
        }
    }

    fn lit(&self) -> Lit {
        match self {
            Value::Truth(lit) => *lit,
            Value::Number(word) => word.bit(0),
        }
    }
}

impl<'a> Translated<'a> {
    /// Translates a system.
    ///
    /// # Errors
    /// Values that need more than 32 bits.
    pub fn new(bound: &'a Bound) -> Result<Self, Unsupported> {
        let folded = Folded::new(bound)?;
        let circuit = Circuit::whole(&folded)?;
        let mut builder = Builder {
            circuit: &circuit,
            netlist: Netlist::default(),
            values: HashMap::new(),
            states: vec![Vec::new(); bound.states.len()],
            inputs: vec![Vec::new(); bound.inputs.len()],
        };
        builder.variables();
        let mut roots = circuit.roots();
        roots.extend(circuit.atoms.iter().flatten());
        for id in circuit.terms.below(&roots) {
            builder.term(id);
        }
        let fault = circuit.fault.map_or(Lit::FALSE, |id| builder.lit(id));
        builder.successors(fault);
        let claims = circuit.claims.iter();
        let broken = claims
            .map(|c| (c.id(), !builder.lit(c.term)))
            .collect::<Vec<_>>();
        let goals = circuit.goals.iter();
        let shown = goals
            .map(|c| (c.id(), builder.lit(c.term)))
            .collect::<Vec<_>>();
        let atoms = circuit.atoms.iter();
        let atoms = atoms.map(|id| id.map(|id| builder.lit(id))).collect();
        Ok(Translated {
            bound,
            fault,
            atoms,
            states: builder.states,
            inputs: builder.inputs,
            left_out: circuit.left_out(),
            netlist: builder.netlist,
            broken,
            shown,
        })
    }

    /// A state variable as a number, with its range.
    pub fn variable(&self, k: usize) -> (Word, (i64, i64)) {
        let range = wide(self.bound.states[k]);
        let word = match range.0 == range.1 {
            true => Word::constant(range.0),
            false => {
                let bits = self.states[k].iter();
                let bits = bits.map(|place| self.netlist.latches[*place].lit);
                Word::variable(bits.collect(), range.0)
            }
        };
        (word, range)
    }

    /// The state variable of which a latch is a bit, and which one.
    pub fn place(&self, latch: usize) -> Option<(usize, usize)> {
        let mut states = self.states.iter().enumerate();
        states.find_map(|(k, bits)| Some((k, bits.iter().position(|place| *place == latch)?)))
    }

    /// Inputs, by their numbers, with the values that these bits give them. An input of which no bit is given is not told.
    pub fn chosen(&self, bits: &[(usize, bool)]) -> Vec<(usize, i64)> {
        let given = |place: &usize| bits.iter().find(|(k, _)| k == place).map(|(_, v)| *v);
        let one = |(k, places): (usize, &Vec<usize>)| {
            let values: Vec<Option<bool>> = places.iter().map(given).collect();
            let any = values.iter().any(Option::is_some);
            let (lo, _) = wide(self.bound.inputs[k]);
            let values = values.into_iter().map(|v| v.unwrap_or(false));
            any.then(|| (k, number(values, lo)))
        };
        self.inputs.iter().enumerate().filter_map(one).collect()
    }

    /// A run of the netlist in the explorer's terms. A variable of which no bit matters has its least value, or is not told.
    pub fn trace(&self, run: &Run) -> Trace {
        let value = |places: &[usize], given: &[Option<bool>], (lo, _): Bounds| {
            let lo = i64::from(lo);
            let any = places.iter().any(|k| given[*k].is_some());
            let bits = places.iter().map(|k| given[*k].unwrap_or(false));
            any.then(|| (number(bits, lo) - lo) as u32)
        };
        let mut trace = Trace::default();
        for (k, places) in self.states.iter().enumerate() {
            if self.bound.initial[k].is_none() {
                let range = self.bound.states[k];
                let chosen = value(places, &run.start, range).unwrap_or(0);
                trace.initial.push((k as u32, chosen));
            }
        }
        for cycle in &run.cycles {
            let inputs = self.inputs.iter().enumerate();
            let step = inputs.filter_map(|(k, places)| {
                let chosen = value(places, cycle, self.bound.inputs[k])?;
                Some((k as u32, chosen))
            });
            trace.steps.push(step.collect());
        }
        trace
    }
}

struct Builder<'a, 'b> {
    circuit: &'b Circuit<'a>,
    netlist: Netlist,
    values: HashMap<Id, Value>,
    states: Vec<Vec<usize>>,
    inputs: Vec<Vec<usize>>,
}

fn wide((lo, hi): Bounds) -> (i64, i64) {
    (i64::from(lo), i64::from(hi))
}

/// The name of a bit of a variable that has so many.
fn bit_name(name: &str, bit: usize, of: usize) -> String {
    let name = name.split_whitespace().collect::<Vec<_>>().join("_");
    match of {
        1 => name,
        _ => format!("{name}.{bit}"),
    }
}

impl Builder<'_, '_> {
    fn variables(&mut self) {
        let bound = self.circuit.bound;
        for k in self.circuit.variables() {
            let (lo, hi) = wide(bound.states[k]);
            let size = Word::needed(lo, hi);
            let name = &bound.system.states[k].var.name;
            let start = bound.initial[k].map(i64::from);
            let bits: Vec<Lit> = (0..size)
                .map(|bit| {
                    self.states[k].push(self.netlist.latches.len());
                    let init = start.map(|v| v >> bit & 1 == 1);
                    self.netlist.latch(bit_name(name, bit, size), init)
                })
                .collect();
            let word = Word::variable(bits, lo);
            let keeps = word.keeps(&mut self.netlist.graph, lo, hi);
            if keeps != Lit::TRUE {
                self.netlist.invariants.push(keeps);
                // A start value keeps to it; any value must be told to.
                self.netlist.start.extend(start.is_none().then_some(keeps));
            }
            self.define(self.circuit.state(k), word);
        }
    }

    /// The value of a variable.
    fn define(&mut self, id: Id, word: Word) {
        let value = match self.circuit.terms.sort(id) {
            Sort::Truth => Value::Truth(word.bit(0)),
            Sort::Number(..) => Value::Number(word),
        };
        self.values.insert(id, value);
    }

    fn input(&mut self, id: Id, k: usize) {
        let bound = self.circuit.bound;
        let (lo, hi) = wide(bound.inputs[k]);
        let size = Word::needed(lo, hi);
        let name = &bound.system.inputs[k].name;
        let bits: Vec<Lit> = (0..size)
            .map(|bit| {
                self.inputs[k].push(self.netlist.inputs.len());
                self.netlist.input(bit_name(name, bit, size))
            })
            .collect();
        let word = Word::variable(bits, lo);
        let keeps = word.keeps(&mut self.netlist.graph, lo, hi);
        if keeps != Lit::TRUE {
            self.netlist.assumed.push(keeps);
        }
        self.define(id, word);
    }

    fn lit(&self, id: Id) -> Lit {
        self.values[&id].lit()
    }

    fn word(&self, id: Id) -> Word {
        self.values[&id].word()
    }

    fn term(&mut self, id: Id) {
        if self.values.contains_key(&id) {
            return;
        }
        let terms = &self.circuit.terms;
        let sort = terms.sort(id);
        let value = match terms.op(id) {
            Op::Truth(v) => Value::Truth(Lit::constant(v)),
            Op::Number(v) => Value::Number(Word::constant(v)),
            // A state variable that has one value only is a constant; all others have their bits.
            Op::State(_) => return,
            Op::Input(k) => return self.input(id, k),
            Op::Not(a) => Value::Truth(!self.lit(a)),
            Op::Neg(a) => Value::Number(self.word(a).negative(&mut self.netlist.graph)),
            Op::Choice(c, a, b) => {
                let c = self.lit(c);
                let graph = &mut self.netlist.graph;
                match sort {
                    Sort::Truth => {
                        Value::Truth(graph.choice(c, self.values[&a].lit(), self.values[&b].lit()))
                    }
                    Sort::Number(..) => Value::Number(self.values[&a].word().choice(
                        graph,
                        c,
                        &self.values[&b].word(),
                    )),
                }
            }
            Op::Binary(op, a, b) => self.operator(op, a, b),
        };
        let value = match (value, sort) {
            (Value::Number(word), Sort::Number(lo, hi)) => Value::Number(word.within(lo, hi)),
            (value, _) => value,
        };
        self.values.insert(id, value);
    }

    fn operator(&mut self, op: BinaryOp, a: Id, b: Id) -> Value {
        use BinaryOp::{Add, And, Div, Eq, Ge, Gt, Le, Lt, Mod, Mul, Ne, Or, Sub, Xor};
        let (x, y) = (self.word(a), self.word(b));
        let (p, q) = (self.lit(a), self.lit(b));
        let graph = &mut self.netlist.graph;
        match op {
            And => Value::Truth(graph.and(p, q)),
            Or => Value::Truth(graph.or(p, q)),
            Eq => Value::Truth(x.equals(graph, &y)),
            Ne | Xor => Value::Truth(!x.equals(graph, &y)),
            Lt => Value::Truth(x.less(graph, &y)),
            Gt => Value::Truth(y.less(graph, &x)),
            Le => Value::Truth(!y.less(graph, &x)),
            Ge => Value::Truth(!x.less(graph, &y)),
            Add => Value::Number(x.plus(graph, &y)),
            Sub => Value::Number(x.minus(graph, &y)),
            Mul => Value::Number(x.times(graph, &y)),
            Div => Value::Number(x.divided(graph, &y).0),
            Mod => Value::Number(x.divided(graph, &y).1),
        }
    }

    /// What the latches become: their value where a value leaves its range.
    fn successors(&mut self, fault: Lit) {
        for k in self.circuit.variables() {
            let (lo, hi) = wide(self.circuit.bound.states[k]);
            let next = self.word(self.circuit.next[k]).within(lo, hi);
            for (bit, place) in self.states[k].iter().enumerate() {
                let latch = &mut self.netlist.latches[*place];
                latch.next = self.netlist.graph.choice(fault, latch.lit, next.bit(bit));
            }
        }
    }
}
