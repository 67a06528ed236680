//! A system over gates: what the interpreter (`stillpoint_lang::eval`) does with numbers is done with [`Word`]s.
//!
//! Both branches of a choice are followed and joined, so that one walk through the rules makes all cycles at once. Parameters may be
//! words too: numbers of a range that are the same in all cycles.

use std::collections::BTreeMap;

use stillpoint_lang::bind::Bound;
use stillpoint_lang::condition::Condition;
use stillpoint_lang::ir::{BinaryOp, Node, Space, Stmt, Var};

use super::format::Free;
use super::gates::{Bit, Gates};
use super::word::Word;

/// A system, some of whose parameters have every value of a range.
#[derive(Clone)]
pub struct Symbolic<'a> {
    /// The system with the values of the other parameters.
    pub bound: &'a Bound,
    /// All gates so far.
    pub gates: Gates,
    /// The parameters.
    pub params: Vec<Word>,
    /// What the ranges of the free parameters and the conditions say.
    pub given: Vec<Bit>,
    /// Least and greatest value of each state variable.
    ranges: Vec<(Word, Word)>,
}

/// One cycle, or as much of it as has been made.
#[derive(Clone)]
pub struct Cycle {
    /// The state at its start.
    pub before: Vec<Word>,
    /// The state as the rules have changed it.
    pub now: Vec<Word>,
    /// An assignment has left the range of its variable: there is no successor.
    pub fault: Bit,
    /// The inputs.
    pub inputs: Vec<Word>,
    /// Named expressions that were evaluated.
    named: Vec<Option<Word>>,
    /// State variables that have their last value in this cycle.
    stepped: Vec<bool>,
}

impl<'a> Symbolic<'a> {
    /// A system in some configurations; parameters that are not free there have their values.
    ///
    /// # Errors
    /// One sentence: a name, a range or a condition that makes no sense.
    pub fn new(bound: &'a Bound, free: &Free) -> Result<Self, String> {
        let every = &free.every[..];
        let mut own = Symbolic {
            bound,
            gates: Gates::default(),
            params: Vec::new(),
            given: Vec::new(),
            ranges: Vec::new(),
        };
        let params = &bound.system.params;
        for (k, (name, (lo, hi))) in every.iter().enumerate() {
            let known = |p: &&stillpoint_lang::ir::Param| p.var.name == *name;
            if params
                .iter()
                .find(known)
                .is_none_or(|p| p.reading.is_some())
            {
                return Err(format!("there is no parameter `{name}` that can be free"));
            }
            if lo > hi || every[..k].iter().any(|(other, _)| other == name) {
                return Err(format!(
                    "the range {lo}..{hi} of `{name}` says nothing, or is not the only one"
                ));
            }
        }
        for (param, value) in params.iter().zip(&bound.values) {
            let free = every.iter().find(|(name, _)| *name == param.var.name);
            let Some((_, (lo, hi))) = free else {
                own.params.push(Word::constant(i64::from(*value)));
                continue;
            };
            let (lo, hi) = (Word::constant(*lo), Word::constant(*hi));
            let (word, keeps) = Word::between(&mut own.gates, &lo, &hi);
            let (lo, hi) = own.range(&param.var)?;
            let documented = word.keeps(&mut own.gates, &lo, &hi);
            own.given.extend([keeps, documented]);
            own.params.push(word);
        }
        for (k, state) in bound.system.states.iter().enumerate() {
            // Without free parameters the binder knows the range; with some it may depend on them.
            let range = match every {
                [] => {
                    let (lo, hi) = bound.states[k];
                    (Word::constant(i64::from(lo)), Word::constant(i64::from(hi)))
                }
                _ => own.range(&state.var)?,
            };
            own.ranges.push(range);
        }
        for condition in &free.conditions {
            let read = Condition::read(&bound.system, condition).map_err(|why| why.to_string())?;
            let holds = own.constant(&read.node())?.is_true(&mut own.gates);
            own.given.push(holds);
        }
        Ok(own)
    }

    /// An expression of parameters.
    ///
    /// # Errors
    /// Anything else in it.
    pub fn constant(&mut self, node: &Node) -> Result<Word, String> {
        let mut nothing = Cycle {
            before: Vec::new(),
            now: Vec::new(),
            fault: Bit::FALSE,
            inputs: Vec::new(),
            named: Vec::new(),
            stepped: Vec::new(),
        };
        self.value(node, &mut nothing)
    }

    fn range(&mut self, var: &Var) -> Result<(Word, Word), String> {
        Ok((self.constant(&var.lo)?, self.constant(&var.hi)?))
    }

    /// A state of which nothing is known but that its variables keep to their ranges, and what says that they do.
    pub fn any_state(&mut self) -> (Vec<Word>, Vec<Bit>) {
        let ranges = self.ranges.iter();
        ranges
            .map(|(lo, hi)| Word::between(&mut self.gates, lo, hi))
            .unzip()
    }

    /// A state in which runs start, and what says that it is one.
    ///
    /// # Errors
    /// A start value that is no expression of parameters.
    pub fn start(&mut self) -> Result<(Vec<Word>, Vec<Bit>), String> {
        let (mut state, mut given) = self.any_state();
        for (k, variable) in self.bound.system.states.iter().enumerate() {
            if let Some(init) = &variable.init {
                // Configurations whose start values are outside the ranges do not exist.
                let (lo, hi) = self.ranges[k].clone();
                state[k] = self.constant(init)?;
                given[k] = state[k].keeps(&mut self.gates, &lo, &hi);
            }
        }
        Ok((state, given))
    }

    /// A cycle from a state, with any inputs, and what says that these keep to their ranges.
    ///
    /// # Errors
    /// Expressions that cannot be told so: one sentence.
    pub fn cycle(&mut self, before: Vec<Word>) -> Result<(Cycle, Vec<Bit>), String> {
        self.cycle_with(before, &BTreeMap::new())
    }

    /// The same, where some inputs, by their places, have these values: that these keep to their ranges is told with the others.
    ///
    /// # Errors
    /// As [`Symbolic::cycle`].
    pub fn cycle_with(
        &mut self,
        before: Vec<Word>,
        chosen: &BTreeMap<usize, i64>,
    ) -> Result<(Cycle, Vec<Bit>), String> {
        let bound = self.bound;
        let (mut inputs, mut given) = (Vec::new(), Vec::new());
        for (k, input) in bound.system.inputs.iter().enumerate() {
            let (lo, hi) = self.range(input)?;
            let (word, keeps) = match chosen.get(&k) {
                None => Word::between(&mut self.gates, &lo, &hi),
                Some(value) => {
                    let value = Word::constant(*value);
                    let keeps = value.keeps(&mut self.gates, &lo, &hi);
                    (value, keeps)
                }
            };
            inputs.push(word);
            given.push(keeps);
        }
        let mut cycle = Cycle {
            now: before.clone(),
            fault: Bit::FALSE,
            inputs,
            named: vec![None; bound.system.lazies.len()],
            stepped: vec![true; before.len()],
            before,
        };
        for instance in &bound.system.instances {
            let own = instance.states.clone();
            own.for_each(|k| cycle.stepped[k as usize] = false);
        }
        for k in 0..bound.system.instances.len() {
            self.step(k, &mut cycle)?;
        }
        Ok((cycle, given))
    }

    /// The step of an instance: the first rule whose guard holds fires.
    fn step(&mut self, instance: usize, cycle: &mut Cycle) -> Result<(), String> {
        let instance = &self.bound.system.instances[instance];
        let mut effects = Vec::new();
        for rule in &instance.rules {
            let guard = self.truth(&rule.when, cycle)?;
            if guard == Bit::FALSE {
                continue;
            }
            let mut effect = cycle.clone();
            self.run(&rule.then, &mut effect)?;
            // A named expression has the same value whether the rule fires or not.
            cycle.named = std::mem::take(&mut effect.named);
            effects.push((guard, effect));
            if guard == Bit::TRUE {
                break;
            }
        }
        for (guard, effect) in effects.into_iter().rev() {
            self.join(guard, effect, cycle);
        }
        let own = instance.states.clone();
        own.for_each(|k| cycle.stepped[k as usize] = true);
        Ok(())
    }

    /// Where the condition holds, the cycle is the other one.
    fn join(&mut self, condition: Bit, other: Cycle, cycle: &mut Cycle) {
        for (now, other) in cycle.now.iter_mut().zip(other.now) {
            if *now != other {
                *now = other.choice(&mut self.gates, condition, now);
            }
        }
        cycle.fault = self.gates.choice(condition, other.fault, cycle.fault);
    }

    fn run(&mut self, list: &[Stmt], cycle: &mut Cycle) -> Result<(), String> {
        for statement in list {
            match statement {
                Stmt::Assign {
                    base,
                    index,
                    value,
                    checked,
                    ..
                } => {
                    let index = match index {
                        Some((k, lo, len)) => Some((self.value(k, cycle)?, *lo, *len)),
                        None => None,
                    };
                    let value = self.value(value, cycle)?;
                    match index {
                        None => self.assign(*base as usize, &value, *checked, Bit::TRUE, cycle),
                        Some((index, lo, len)) => {
                            for n in 0..len {
                                let place = Word::constant(lo + i64::from(n));
                                let here = index.equals(&mut self.gates, &place);
                                self.assign((base + n) as usize, &value, *checked, here, cycle);
                            }
                        }
                    }
                }
                Stmt::If(branches, rest) => self.branches(branches, rest, cycle)?,
            }
        }
        Ok(())
    }

    fn branches(
        &mut self,
        branches: &[(Node, Vec<Stmt>)],
        rest: &[Stmt],
        cycle: &mut Cycle,
    ) -> Result<(), String> {
        let Some(((guard, body), others)) = branches.split_first() else {
            return self.run(rest, cycle);
        };
        let guard = self.truth(guard, cycle)?;
        let mut then = cycle.clone();
        self.run(body, &mut then)?;
        cycle.named = std::mem::take(&mut then.named);
        self.branches(others, rest, cycle)?;
        self.join(guard, then, cycle);
        Ok(())
    }

    /// Assigns where the condition holds. As the interpreter does, it leaves out the check of a value that keeps to the range of its
    /// variable whatever the parameters are, as the loader knows.
    fn assign(
        &mut self,
        cell: usize,
        value: &Word,
        checked: bool,
        condition: Bit,
        cycle: &mut Cycle,
    ) {
        if checked {
            let (lo, hi) = self.ranges[cell].clone();
            let keeps = value.keeps(&mut self.gates, &lo, &hi);
            let leaves = self.gates.and(condition, !keeps);
            cycle.fault = self.gates.or(cycle.fault, leaves);
        }
        cycle.now[cell] = value.choice(&mut self.gates, condition, &cycle.now[cell]);
    }

    /// Whether an expression is TRUE.
    ///
    /// # Errors
    /// As [`Symbolic::cycle`].
    pub fn truth(&mut self, node: &Node, cycle: &mut Cycle) -> Result<Bit, String> {
        let value = self.value(node, cycle)?;
        Ok(value.is_true(&mut self.gates))
    }

    /// Atom `k` after the step.
    ///
    /// # Errors
    /// As [`Symbolic::cycle`].
    pub fn atom(&mut self, k: usize, cycle: &mut Cycle) -> Result<Bit, String> {
        let bound = self.bound;
        self.truth(&bound.system.atoms[k], cycle)
    }

    /// The same of a condition; without one every cycle satisfies it.
    ///
    /// # Errors
    /// As [`Symbolic::cycle`].
    pub fn condition(&mut self, k: Option<usize>, cycle: &mut Cycle) -> Result<Bit, String> {
        k.map_or(Ok(Bit::TRUE), |k| self.atom(k, cycle))
    }

    fn cells<'c>(&'c self, space: Space, cycle: &'c Cycle) -> &'c [Word] {
        match space {
            Space::Param => &self.params,
            Space::Before => &cycle.before,
            Space::Now => &cycle.now,
            Space::Input => &cycle.inputs,
        }
    }

    fn value(&mut self, node: &Node, cycle: &mut Cycle) -> Result<Word, String> {
        const NO_CELL: &str = "an expression of parameters has something else in it";
        Ok(match node {
            Node::Const(value) => Word::constant(*value),
            Node::Cell(space, k) => {
                let cell = self.cells(*space, cycle).get(*k as usize);
                cell.cloned().ok_or(NO_CELL)?
            }
            Node::Lazy(k) => self.named(*k as usize, cycle)?,
            Node::Element {
                space,
                base,
                lo,
                len,
                index,
            } => {
                let index = self.value(index, cycle)?;
                let cells = *base as usize..(*base + *len) as usize;
                let cells = self
                    .cells(*space, cycle)
                    .get(cells)
                    .ok_or(NO_CELL)?
                    .to_vec();
                self.pick(&index, *lo, cells)
            }
            Node::Not(a) => Word::truth(!self.truth(a, cycle)?),
            Node::Neg(a) => {
                let a = self.value(a, cycle)?;
                Word::constant(0).minus(&mut self.gates, &a)
            }
            Node::Abs(a) => self.value(a, cycle)?.magnitude(&mut self.gates),
            Node::Binary(op, a, b) => self.operator(*op, a, b, cycle)?,
            Node::Sel(g, a, b) => {
                let g = self.truth(g, cycle)?;
                let (a, b) = (self.value(a, cycle)?, self.value(b, cycle)?);
                b.choice(&mut self.gates, g, &a)
            }
            Node::Mux(k, values) => {
                let k = self.value(k, cycle)?;
                let values = self.list(values, cycle)?;
                self.pick(&k, 0, values)
            }
            Node::Min(values) => self.first(values, cycle, Word::less)?,
            Node::Max(values) => self.first(values, cycle, |a, gates, b| b.less(gates, a))?,
        })
    }

    fn list(&mut self, nodes: &[Node], cycle: &mut Cycle) -> Result<Vec<Word>, String> {
        nodes.iter().map(|node| self.value(node, cycle)).collect()
    }

    /// The value whose number is `index`, the first having number `lo`. The loader rules out all other numbers.
    fn pick(&mut self, index: &Word, lo: i64, values: Vec<Word>) -> Word {
        let mut all = values.into_iter().enumerate().rev();
        let mut picked = all.next().map_or(Word::constant(0), |(_, last)| last);
        for (n, value) in all {
            let here = index.equals(&mut self.gates, &Word::constant(lo + n as i64));
            picked = value.choice(&mut self.gates, here, &picked);
        }
        picked
    }

    /// The value that comes before all others in an order.
    fn first(
        &mut self,
        values: &[Node],
        cycle: &mut Cycle,
        before: impl Fn(&Word, &mut Gates, &Word) -> Bit,
    ) -> Result<Word, String> {
        let mut values = self.list(values, cycle)?.into_iter();
        let mut first = values.next().ok_or("a MIN or MAX has no values")?;
        for value in values {
            let sooner = before(&value, &mut self.gates, &first);
            first = value.choice(&mut self.gates, sooner, &first);
        }
        Ok(first)
    }

    fn operator(
        &mut self,
        op: BinaryOp,
        a: &Node,
        b: &Node,
        cycle: &mut Cycle,
    ) -> Result<Word, String> {
        let (x, y) = (self.value(a, cycle)?, self.value(b, cycle)?);
        let gates = &mut self.gates;
        let truth = match op {
            BinaryOp::Add => return Ok(x.plus(gates, &y)),
            BinaryOp::Sub => return Ok(x.minus(gates, &y)),
            BinaryOp::Mul => return Ok(x.times(gates, &y)),
            BinaryOp::Div => return Ok(x.divided(gates, &y).0),
            BinaryOp::Mod => return Ok(x.divided(gates, &y).1),
            BinaryOp::And => {
                let (x, y) = (x.is_true(gates), y.is_true(gates));
                gates.and(x, y)
            }
            BinaryOp::Or => {
                let (x, y) = (x.is_true(gates), y.is_true(gates));
                gates.or(x, y)
            }
            BinaryOp::Eq => x.equals(gates, &y),
            BinaryOp::Xor | BinaryOp::Ne => !x.equals(gates, &y),
            BinaryOp::Lt => x.less(gates, &y),
            BinaryOp::Gt => y.less(gates, &x),
            BinaryOp::Le => !y.less(gates, &x),
            BinaryOp::Ge => !x.less(gates, &y),
        };
        Ok(Word::truth(truth))
    }

    /// A named expression. The interpreter evaluates it once a cycle, when it is first needed. When that is must not matter: each
    /// state that it reads after its change must have its last value by then.
    fn named(&mut self, k: usize, cycle: &mut Cycle) -> Result<Word, String> {
        if let Some(known) = cycle.named.get(k).cloned().flatten() {
            return Ok(known);
        }
        let bound = self.bound;
        let lazy = &bound.system.lazies[k];
        let mut early = cycle.named.len() <= k;
        lazy.value.visit(&mut |node| {
            let mut read = node.cells(Space::Now);
            early |= read.any(|k| cycle.stepped.get(k as usize) != Some(&true));
        });
        if early {
            return Err(format!(
                "`{}` reads a state that may change after it",
                lazy.name
            ));
        }
        let value = self.value(&lazy.value, cycle)?;
        cycle.named[k] = Some(value.clone());
        Ok(value)
    }
}
