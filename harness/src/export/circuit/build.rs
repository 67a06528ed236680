//! From rules to terms: the cycle is run once with terms for values.

use stillpoint_lang::ir::{BinaryOp, Form, Node, Space, Stmt, Ty};

use super::{Circuit, Claim, Id, Op, Terms};
use crate::export::Unsupported;
use crate::export::folded::Folded;

/// The circuit of a system, if `whole` with the atoms of all properties.
pub(super) fn circuit<'a>(folded: &Folded<'a>, whole: bool) -> Result<Circuit<'a>, Unsupported> {
    let bound = folded.bound;
    let system = &bound.system;
    let mut terms = Terms::default();
    let state = |k: usize| {
        let truth = system.states[k].var.ty == Ty::Bool;
        terms.variable(Op::State(k), truth, bound.states[k])
    };
    let now: Vec<Id> = (0..bound.states.len()).map(state).collect();
    let fault = terms.truth(false);
    let mut builder = Builder {
        folded,
        terms,
        values: Values {
            now: now.clone(),
            fault,
        },
        named: vec![None; folded.lazies.len()],
        stepped: vec![false; bound.states.len()],
    };
    for k in 0..system.instances.len() {
        builder.rules(k)?;
    }
    builder.properties(now, whole)
}

/// The state as the rules have changed it, and whether a value has left its range.
#[derive(Clone)]
pub(super) struct Values {
    pub(super) now: Vec<Id>,
    pub(super) fault: Id,
}

pub(super) struct Builder<'a, 'b> {
    pub(super) folded: &'b Folded<'a>,
    pub(super) terms: Terms,
    pub(super) values: Values,
    /// Named expressions that have their term.
    pub(super) named: Vec<Option<Id>>,
    /// State cells of the instances that have made their step.
    pub(super) stepped: Vec<bool>,
}

impl<'a> Builder<'a, '_> {
    /// The rules of an instance: the first whose guard holds fires.
    fn rules(&mut self, instance: usize) -> Result<(), Unsupported> {
        let folded = self.folded;
        let written = &folded.bound.system.instances[instance];
        let before = self.values.clone();
        let mut outcomes = Vec::new();
        for (place, rule) in &folded.rules[instance] {
            let guard = self.truth(&rule.when)?;
            self.terms.name(guard, "when_", &written.rules[*place].name);
            self.values = before.clone();
            self.statements(&rule.then)?;
            outcomes.push((guard, self.values.clone()));
        }
        self.values = before;
        for (guard, outcome) in outcomes.into_iter().rev() {
            self.join(guard, &outcome)?;
        }
        for k in written.states.clone() {
            let k = k as usize;
            let name = &folded.bound.system.states[k].var.name;
            self.terms.name(self.values.now[k], "next_", name);
            self.stepped[k] = true;
        }
        Ok(())
    }

    /// Where the condition holds, the values are `other`.
    fn join(&mut self, condition: Id, other: &Values) -> Result<(), Unsupported> {
        for (now, other) in self.values.now.iter_mut().zip(&other.now) {
            *now = self.terms.choice(condition, *other, *now)?;
        }
        self.values.fault = self
            .terms
            .choice(condition, other.fault, self.values.fault)?;
        Ok(())
    }

    fn statements(&mut self, list: &[Stmt]) -> Result<(), Unsupported> {
        for statement in list {
            match statement {
                Stmt::Assign {
                    base, index, value, ..
                } => self.assign(*base, index.as_ref(), value)?,
                Stmt::If(branches, rest) => self.branches(branches, rest)?,
            }
        }
        Ok(())
    }

    fn branches(
        &mut self,
        branches: &[(Node, Vec<Stmt>)],
        rest: &[Stmt],
    ) -> Result<(), Unsupported> {
        let Some(((guard, body), others)) = branches.split_first() else {
            return self.statements(rest);
        };
        let guard = self.truth(guard)?;
        let before = self.values.clone();
        self.statements(body)?;
        let then = std::mem::replace(&mut self.values, before);
        self.branches(others, rest)?;
        self.join(guard, &then)
    }

    fn assign(
        &mut self,
        base: u32,
        index: Option<&(Node, i64, u32)>,
        value: &Node,
    ) -> Result<(), Unsupported> {
        let value = self.like(value, self.holds_truth(Space::Now, base))?;
        let Some((index, lo, len)) = index else {
            let always = self.terms.truth(true);
            return self.write(base as usize, value, always);
        };
        let index = self.number(index)?;
        for n in 0..*len {
            let place = self.terms.number(lo + i64::from(n));
            let here = self.terms.binary(BinaryOp::Eq, index, place)?;
            self.write((base + n) as usize, value, here)?;
        }
        Ok(())
    }

    /// Writes a value where the condition holds. One that leaves the range is a fault, and the cell keeps within it: what
    /// a cycle with a fault does further does not matter, but every term keeps to its range.
    fn write(&mut self, cell: usize, value: Id, condition: Id) -> Result<(), Unsupported> {
        let mut value = value;
        if !self.terms.is_truth(value) {
            let folded = self.folded;
            let (lo, hi) = &folded.limits[cell];
            let (lo, hi) = (self.number(lo)?, self.number(hi)?);
            let below = self.terms.binary(BinaryOp::Lt, value, lo)?;
            let above = self.terms.binary(BinaryOp::Gt, value, hi)?;
            let outside = self.terms.or(below, above);
            let fault = self.terms.and(condition, outside);
            self.values.fault = self.terms.or(self.values.fault, fault);
            value = self.terms.greatest(value, lo)?;
            value = self.terms.least(value, hi)?;
        }
        let now = &mut self.values.now[cell];
        *now = self.terms.choice(condition, value, *now)?;
        Ok(())
    }

    fn properties(mut self, now: Vec<Id>, whole: bool) -> Result<Circuit<'a>, Unsupported> {
        let bound = self.folded.bound;
        let next = self.values.now.clone();
        let fault = self.values.fault;
        self.terms.name(fault, "", "fault");
        let (mut claims, mut goals) = (Vec::new(), Vec::new());
        for property in &bound.system.properties {
            match &property.form {
                Form::Always { when, then } => {
                    let mut term = self.atom(*then)?;
                    if let Some(when) = when {
                        let when = self.atom(*when)?;
                        let not = self.terms.not(when);
                        term = self.terms.or(not, term);
                    }
                    // A cycle with a fault is judged by none.
                    let term = self.terms.or(fault, term);
                    claims.push(Claim { property, term });
                }
                Form::Reachable { goal } => {
                    let goal = self.atom(*goal)?;
                    let none = self.terms.not(fault);
                    let term = self.terms.and(none, goal);
                    goals.push(Claim { property, term });
                }
                _ => {}
            }
        }
        let all = 0..if whole { self.folded.atoms.len() } else { 0 };
        let atoms = all.map(|k| self.atom(k).ok()).collect();
        let fault = (self.terms.op(fault) != Op::Truth(false)).then_some(fault);
        Ok(Circuit {
            bound,
            terms: self.terms,
            now,
            next,
            fault,
            claims,
            goals,
            atoms,
        })
    }

    fn atom(&mut self, k: usize) -> Result<Id, Unsupported> {
        let folded = self.folded;
        self.truth(&folded.atoms[k])
    }
}
