//! What has to be shown so that something is never seen, as clauses that nothing satisfies.
//!
//! A duty over several cycles is told by numbers beside the state, see [`super::duty`]. `@within:ID` is the bound of a response.

use std::collections::BTreeMap;
use std::slice::from_ref;

use stillpoint_lang::ir::Form;

use super::clause::{Clause, Literal, written};
use super::duty::{Duty, Measure, Measured};
use super::gates::{Bit, Gates};
use super::symbolic::Symbolic;
use super::target::Target;
use super::ways::Step;
use super::word::Word;
use crate::subject::label;

/// The state and the duty.
#[derive(Clone)]
pub(super) struct Place {
    pub(super) state: Vec<Word>,
    pub(super) duty: Duty,
}

/// A cycle with what is judged in it.
struct Judged {
    before: Place,
    after: Place,
    fault: Bit,
    bad: Bit,
}

/// Clauses, and lists of literals none of which can hold together with them.
#[derive(Clone, Debug, Default)]
pub struct Obligation {
    /// The greatest number of a variable.
    pub variables: usize,
    /// The clauses.
    pub clauses: Vec<Vec<i32>>,
    /// Each of these is to be refuted, and what it says if it is not.
    pub goals: Vec<(Vec<i32>, Unshown)>,
}

/// What is not shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unshown {
    /// A clause of the invariant, by its number, at the start.
    Start(usize),
    /// That a cycle keeps this clause.
    Kept(usize),
    /// That what must not be seen is excluded.
    Bad,
    /// That it is not seen in this cycle of a run.
    Base(usize),
    /// That every state of the invariant is in a region.
    Cover,
    /// That the inputs of this region are possible.
    Input(usize),
    /// That they lead out of it.
    Way(usize),
}

/// k-induction.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Induction {
    /// So many good cycles are followed by another one.
    pub cycles: usize,
    /// Cycles of which it is enough to look at those that begin in different states: on a shortest run all do.
    pub differ: Vec<(usize, usize)>,
}

/// A question: a system, what must never be seen in it, and an invariant.
pub struct Question<'a> {
    pub(super) system: Symbolic<'a>,
    pub(super) target: Target<'a>,
    /// The bound of a response, in cycles or in what is counted in their place.
    pub(super) within: Word,
    pub(super) measured: Measured,
    clauses: &'a [Clause],
    /// State variables, parameters and bounds by their written names.
    names: BTreeMap<String, Named>,
}

enum Named {
    State(usize),
    Param(usize),
    /// The bound of a response.
    Within(Word),
}

impl<'a> Question<'a> {
    /// A question; a response without a bound needs a measure, and nothing else does.
    ///
    /// # Errors
    /// Names of which there are two; a bound that is no expression of parameters; a measure that is none.
    pub fn new(
        system: &Symbolic<'a>,
        target: Target<'a>,
        clauses: &'a [Clause],
        measure: Option<&Measure>,
    ) -> Result<Self, String> {
        let mut system = system.clone();
        let measured = Measured::new(&system.bound.system, &target, measure)?;
        let within = match &target {
            Target::Late { within, .. } => system.constant(within)?,
            _ => Word::constant(measured.rounds),
        };
        let mut named = Vec::new();
        let own = &system.bound.system;
        for (k, state) in own.states.iter().enumerate() {
            named.push((written(&state.var.name), Named::State(k)));
        }
        for (k, param) in own.params.iter().enumerate() {
            named.push((written(&param.var.name), Named::Param(k)));
        }
        for property in &own.properties {
            if let Form::LeadsTo {
                within: Some(within),
                ..
            } = &property.form
            {
                let bound = system.constant(within)?;
                named.push((format!("@within:{}", label(property)), Named::Within(bound)));
            }
        }
        let mut names = BTreeMap::new();
        for (name, place) in named {
            if names.insert(name.clone(), place).is_some() {
                return Err(format!("there are two variables `{name}`"));
            }
        }
        Ok(Question {
            system,
            target,
            within,
            measured,
            clauses,
            names,
        })
    }

    /// The first clause, by its number, that speaks of something that there is not, and what is wrong with it.
    pub fn unknown(&self) -> Option<(usize, String)> {
        let names = |literal: &'a Literal| match literal {
            Literal::Bit { name, .. } | Literal::Is { name, .. } => (from_ref(name), &[][..]),
            Literal::Most { sum, most, .. } => (&sum[..], &most[..]),
        };
        let known =
            |name: &String| Duty::none().number(name).is_some() || self.names.contains_key(name);
        self.clauses.iter().enumerate().find_map(|(k, clause)| {
            let all = clause.0.iter().map(names);
            let mut all = all.flat_map(|(sum, most)| sum.iter().chain(most));
            let name = all.find(|name| !known(name))?;
            Some((k, format!("there is no `{name}`")))
        })
    }

    /// What has to be refuted, one after the other: that the invariant is false at the start; that a cycle leads out of it or has in it
    /// what must not be seen.
    ///
    /// With induction the second one is about cycles alone, the third about the first cycles of a run, the last about a cycle after
    /// good ones. For what can always be reached the last two are about regions, see [`super::ways`].
    ///
    /// # Errors
    /// What cannot be told in clauses: one sentence.
    pub fn obligations(
        &mut self,
        induction: Option<&Induction>,
        steps: &[Step],
    ) -> Result<Vec<Obligation>, String> {
        if matches!(self.target, Target::Way { .. }) {
            let [cover, way] = self.ways(steps)?;
            return Ok(vec![self.start()?, self.step(false)?, cover, way]);
        }
        let mut all = vec![self.start()?, self.step(induction.is_none())?];
        if let Some(induction) = induction {
            all.push(self.base(induction)?);
            all.push(self.path(induction)?);
        }
        Ok(all)
    }

    pub(super) fn gates(&mut self) -> &mut Gates {
        &mut self.system.gates
    }

    fn start(&mut self) -> Result<Obligation, String> {
        let mut given = self.system.given.clone();
        let (state, starts) = self.system.start()?;
        given.extend(starts);
        let place = Place {
            state,
            duty: self.no_duty(),
        };
        let mut goals = Vec::new();
        for (k, clause) in self.clauses.iter().enumerate() {
            let bits = self.clause(clause, &place)?;
            goals.push((opposite(&bits), Unshown::Start(k)));
        }
        Ok(self.obligation(units(given), goals))
    }

    fn step(&mut self, bad: bool) -> Result<Obligation, String> {
        let (place, mut given) = self.anywhere()?;
        let cycle = self.cycle(place, &mut given)?;
        let mut goals = Vec::new();
        for (k, clause) in self.clauses.iter().enumerate() {
            let mut goal = opposite(&self.clause(clause, &cycle.after)?);
            goal.push(!cycle.fault);
            goals.push((goal, Unshown::Kept(k)));
        }
        if bad {
            goals.push((vec![cycle.bad], Unshown::Bad));
        }
        Ok(self.obligation(given, goals))
    }

    /// The first cycles of a run, of which none is bad.
    fn base(&mut self, induction: &Induction) -> Result<Obligation, String> {
        let (state, starts) = self.system.start()?;
        let mut given = units(self.system.given.clone());
        given.extend(units(starts));
        let mut place = Place {
            state,
            duty: self.no_duty(),
        };
        let (mut fine, mut goals) = (Vec::new(), Vec::new());
        for k in 0..induction.cycles {
            given.extend(self.invariant(&place)?);
            let cycle = self.cycle(place, &mut given)?;
            let mut goal: Vec<Bit> = fine.clone();
            goal.push(cycle.bad);
            goals.push((goal, Unshown::Base(k)));
            fine.push(!cycle.fault);
            place = cycle.after;
        }
        Ok(self.obligation(given, goals))
    }

    /// A cycle after so many good ones.
    fn path(&mut self, induction: &Induction) -> Result<Obligation, String> {
        let (mut place, mut given) = self.anywhere()?;
        let mut begun = Vec::new();
        let mut last = Bit::FALSE;
        for k in 0..=induction.cycles {
            if k > 0 {
                given.extend(self.invariant(&place)?);
            }
            let cycle = self.cycle(place, &mut given)?;
            if k < induction.cycles {
                given.extend([vec![!cycle.fault], vec![!cycle.bad]]);
            }
            last = cycle.bad;
            begun.push(cycle.before);
            place = cycle.after;
        }
        let cone = self.cone()?;
        for (one, other) in &induction.differ {
            let pair = begun.get(*one).zip(begun.get(*other));
            let (one, other) = pair.ok_or("there are not so many cycles")?;
            given.push(vec![self.differ(one, other, &cone)]);
        }
        Ok(self.obligation(given, vec![(vec![last], Unshown::Bad)]))
    }

    /// A place in the invariant, and what is given of it.
    pub(super) fn anywhere(&mut self) -> Result<(Place, Vec<Vec<Bit>>), String> {
        let (state, ranges) = self.system.any_state();
        let place = Place {
            state,
            duty: self.any_duty(),
        };
        let mut given = units(self.system.given.clone());
        given.extend(units(ranges));
        given.extend(self.invariant(&place)?);
        Ok((place, given))
    }

    fn invariant(&mut self, place: &Place) -> Result<Vec<Vec<Bit>>, String> {
        let clauses = self.clauses;
        clauses.iter().map(|c| self.clause(c, place)).collect()
    }

    fn cycle(&mut self, before: Place, given: &mut Vec<Vec<Bit>>) -> Result<Judged, String> {
        let (mut cycle, inputs) = self.system.cycle(before.state.clone())?;
        given.extend(units(inputs));
        let (bad, duty) = self.judge(&mut cycle, before.duty.clone())?;
        let fault = cycle.fault;
        let bad = match self.target {
            Target::Range => fault,
            // A cycle with a fault is judged by no property.
            _ => self.gates().and(!fault, bad),
        };
        let after = Place {
            state: cycle.now,
            duty,
        };
        Ok(Judged {
            before,
            after,
            fault,
            bad,
        })
    }

    /// The literals of a clause at a place.
    pub(super) fn clause(&mut self, clause: &Clause, place: &Place) -> Result<Vec<Bit>, String> {
        let literals = clause.0.iter();
        literals.map(|l| self.literal(l, place)).collect()
    }

    fn literal(&mut self, literal: &Literal, place: &Place) -> Result<Bit, String> {
        Ok(match literal {
            Literal::Bit { name, bit, set } => {
                let bit = self.number(name, place)?.bit(*bit);
                if *set { bit } else { !bit }
            }
            Literal::Is { name, value, equal } => {
                let number = self.number(name, place)?;
                let same = number.equals(self.gates(), &Word::constant(*value));
                if *equal { same } else { !same }
            }
            Literal::Most { sum, most, shift } => {
                let sum = self.sum(Word::constant(0), sum, place)?;
                let most = self.sum(Word::constant(*shift), most, place)?;
                !most.less(self.gates(), &sum)
            }
        })
    }

    /// A number and all of these.
    fn sum(&mut self, first: Word, names: &[String], place: &Place) -> Result<Word, String> {
        names.iter().try_fold(first, |sum, name| {
            let number = self.number(name, place)?;
            Ok(sum.plus(self.gates(), &number))
        })
    }

    pub(super) fn number(&self, name: &str, place: &Place) -> Result<Word, String> {
        if let Some(number) = place.duty.number(name) {
            return Ok(number);
        }
        match self.names.get(name) {
            Some(Named::State(k)) => Ok(place.state[*k].clone()),
            Some(Named::Param(k)) => Ok(self.system.params[*k].clone()),
            Some(Named::Within(bound)) => Ok(bound.clone()),
            None => Err(format!("there is no `{name}`")),
        }
    }

    /// The state variables on which it depends, over any number of cycles, whether something bad is seen. What runs do with them does
    /// not depend on the others.
    fn cone(&mut self) -> Result<Vec<bool>, String> {
        let (place, mut given) = self.anywhere()?;
        let own: Vec<Vec<Bit>> = place.state.iter().map(|w| w.bits().to_vec()).collect();
        let cycle = self.cycle(place, &mut given)?;
        let mut roots = vec![cycle.bad, cycle.fault];
        roots.extend(cycle.after.duty.bits());
        let invariant = self.invariant(&cycle.before)?;
        roots.extend(invariant.concat());
        let mut inside = vec![false; own.len()];
        loop {
            let now = self.system.gates.depend(&roots, &own);
            let new = (0..own.len()).filter(|k| now[*k] && !inside[*k]);
            let new: Vec<usize> = new.collect();
            if new.is_empty() {
                return Ok(inside);
            }
            for k in new {
                inside[k] = true;
                roots.extend(cycle.after.state[k].bits());
            }
        }
    }

    fn differ(&mut self, one: &Place, other: &Place, cone: &[bool]) -> Bit {
        let gates = &mut self.system.gates;
        let mut differ = Bit::FALSE;
        for (a, b) in one.duty.flags().zip(other.duty.flags()) {
            let other = gates.xor(a, b);
            differ = gates.or(differ, other);
        }
        let states = one.state.iter().zip(&other.state).zip(cone);
        let states = states.filter(|(_, inside)| **inside).map(|(pair, _)| pair);
        for (a, b) in states.chain([(one.duty.rest(), other.duty.rest())]) {
            let same = a.equals(gates, b);
            differ = gates.or(differ, !same);
        }
        differ
    }

    pub(super) fn obligation(
        &self,
        given: Vec<Vec<Bit>>,
        goals: Vec<(Vec<Bit>, Unshown)>,
    ) -> Obligation {
        let gates = &self.system.gates;
        let numbers = |bits: &[Bit]| -> Vec<i32> { bits.iter().map(|b| b.number()).collect() };
        let roots = given.iter().chain(goals.iter().map(|(goal, _)| goal));
        let mut clauses = Vec::new();
        gates.clauses(roots.flatten().copied(), |clause| {
            clauses.push(numbers(clause))
        });
        clauses.extend(given.iter().map(|clause| numbers(clause)));
        let goals = goals.into_iter().map(|(goal, what)| (numbers(&goal), what));
        Obligation {
            variables: gates.count(),
            clauses,
            goals: goals.collect(),
        }
    }
}

/// Each holds.
pub(super) fn units(bits: Vec<Bit>) -> Vec<Vec<Bit>> {
    bits.into_iter().map(|bit| vec![bit]).collect()
}

pub(super) fn opposite(bits: &[Bit]) -> Vec<Bit> {
    bits.iter().map(|bit| !*bit).collect()
}
