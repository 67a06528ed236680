//! Duties over several cycles, as numbers beside the state.
//!
//! `@pending` says that one is open. `@rest` are the cycles left to a bounded response, of which the oldest one counts: it begins with
//! the bound less one, counts down, and at 0 the goal must come.
//!
//! A response without a bound is broken by a run on which the goal never comes, the assumption always holds and each fairness
//! condition holds again and again. That no run is one of these is shown by a measure: some numbers, each of which is to fall or to
//! rise, and how often at most something else happens as long as the duty is open. A round ends when every fairness condition has been
//! seen in it, and it is idle if no number has moved as it is to. Idle rounds, and cycles in which a number moves back, are what
//! `@rest` counts. After the last of them no number ever moves back, and one moves in each round: as ranges let no number do so for
//! ever, there are no more rounds. Bit n of `@seen` says that condition n has been seen in the round, `@moved` that a number has moved.

use stillpoint_lang::ir::System;

use super::clause::written;
use super::gates::Bit;
use super::question::Question;
use super::symbolic::Cycle;
use super::target::Target;
use super::ways::Rank;
use super::word::Word;

/// More rounds are no measure that anybody wants to read.
const ROUNDS: i64 = 1000;

/// What shows that a goal without a bound comes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Measure {
    /// How often at most a round is idle or a number moves back.
    pub rounds: i64,
    /// The numbers.
    pub numbers: Vec<Rank>,
}

/// The same, by places of state variables.
#[derive(Clone, Debug, Default)]
pub(super) struct Measured {
    pub(super) rounds: i64,
    numbers: Vec<(usize, bool)>,
}

impl Measured {
    pub(super) fn new(
        system: &System,
        target: &Target,
        measure: Option<&Measure>,
    ) -> Result<Self, String> {
        let measure = match (target, measure) {
            (Target::Forever { .. }, Some(measure)) => measure,
            (Target::Forever { .. }, None) => return Err("it has no measure".to_owned()),
            (_, Some(_)) => return Err("it has a measure, but nothing to measure".to_owned()),
            (_, None) => return Ok(Measured::default()),
        };
        if !(0..=ROUNDS).contains(&measure.rounds) {
            return Err(format!("its measure is not one of 0 to {ROUNDS} rounds"));
        }
        let numbers = measure.numbers.iter().map(|rank| {
            let mut states = system.states.iter();
            let place = states.position(|state| written(&state.var.name) == rank.name);
            let place = place.ok_or_else(|| format!("there is no state variable `{}`", rank.name));
            Ok((place?, rank.rises))
        });
        Ok(Measured {
            rounds: measure.rounds,
            numbers: numbers.collect::<Result<_, String>>()?,
        })
    }
}

/// The duty at the start of a cycle.
#[derive(Clone)]
pub(super) struct Duty {
    pending: Bit,
    rest: Word,
    seen: Vec<Bit>,
    moved: Bit,
}

impl Duty {
    pub(super) fn none() -> Self {
        Duty {
            pending: Bit::FALSE,
            rest: Word::constant(0),
            seen: Vec::new(),
            moved: Bit::FALSE,
        }
    }

    /// A number of it by its name.
    pub(super) fn number(&self, name: &str) -> Option<Word> {
        Some(match name {
            "@pending" => Word::truth(self.pending),
            "@rest" => self.rest.clone(),
            "@seen" => Word::new([&self.seen[..], &[Bit::FALSE]].concat()),
            "@moved" => Word::truth(self.moved),
            _ => return None,
        })
    }

    /// What is no number of several bits.
    pub(super) fn flags(&self) -> impl Iterator<Item = Bit> + '_ {
        let own = [self.pending, self.moved].into_iter();
        own.chain(self.seen.iter().copied())
    }

    pub(super) fn rest(&self) -> &Word {
        &self.rest
    }

    pub(super) fn bits(&self) -> impl Iterator<Item = Bit> + '_ {
        self.flags().chain(self.rest.bits().iter().copied())
    }
}

impl Question<'_> {
    /// The one at the start.
    pub(super) fn no_duty(&self) -> Duty {
        let mut duty = Duty::none();
        if let Target::Forever { fair, .. } = self.target {
            duty.seen = vec![Bit::FALSE; fair.len()];
        }
        duty
    }

    pub(super) fn any_duty(&mut self) -> Duty {
        let mut duty = self.no_duty();
        if matches!(self.target, Target::Late { .. } | Target::Forever { .. }) {
            // As many bits as the bound has; one of 0 or less opens no duty.
            let mut bits = vec![Bit::FALSE; self.within.bits().len()];
            let size = bits.len() - 1;
            bits[..size].fill_with(|| self.system.gates.free());
            duty.rest = Word::new(bits);
        }
        if matches!(self.target, Target::Forever { .. }) {
            duty.seen.fill_with(|| self.system.gates.free());
            duty.moved = self.gates().free();
        }
        if matches!(
            self.target,
            Target::Until { .. } | Target::Late { .. } | Target::Forever { .. }
        ) {
            duty.pending = self.gates().free();
        }
        duty
    }

    /// Whether a cycle shows what must not be seen, and the duty after it.
    pub(super) fn judge(&mut self, cycle: &mut Cycle, duty: Duty) -> Result<(Bit, Duty), String> {
        let system = &mut self.system;
        Ok(match &self.target {
            Target::Range | Target::Way { .. } => (Bit::FALSE, duty),
            Target::Goal(goal) => (system.atom(*goal, cycle)?, duty),
            Target::Broken(when, then) => {
                let when = system.condition(*when, cycle)?;
                let then = system.atom(*then, cycle)?;
                (system.gates.and(when, !then), duty)
            }
            Target::Until {
                when,
                holds,
                unless,
            } => {
                let (when, holds) = (system.atom(*when, cycle)?, system.atom(*holds, cycle)?);
                let unless = system.atom(*unless, cycle)?;
                let gates = &mut system.gates;
                let begun = gates.or(duty.pending, when);
                let open = gates.and(begun, !unless);
                let pending = gates.and(open, holds);
                (gates.and(open, !holds), Duty { pending, ..duty })
            }
            Target::Late { when, goal, .. } => {
                let (when, goal) = (system.atom(*when, cycle)?, system.atom(*goal, cycle)?);
                let (gates, one) = (&mut system.gates, Word::constant(1));
                let at_once = self.within.less(gates, &one);
                let used_up = !duty.rest.is_true(gates);
                let begins = gates.and(!duty.pending, when);
                // Where the bound is 0 the goal must come with the trigger.
                let broken = gates.choice(duty.pending, used_up, at_once);
                let broken = gates.all([broken, !goal]);
                let asked = gates.or(duty.pending, when);
                let broken = gates.and(broken, asked);
                let opens = gates.and(begins, !at_once);
                let lasts = gates.and(duty.pending, !used_up);
                let pending = gates.or(opens, lasts);
                let pending = gates.and(pending, !goal);
                let less = duty.rest.minus(gates, &one);
                let whole = self.within.minus(gates, &one);
                let rest = less.choice(gates, duty.pending, &whole);
                let rest = rest.choice(gates, pending, &Word::constant(0));
                (
                    broken,
                    Duty {
                        pending,
                        rest,
                        ..duty
                    },
                )
            }
            Target::Forever {
                when,
                goal,
                assuming,
                fair,
            } => {
                let (when, goal) = (system.atom(*when, cycle)?, system.atom(*goal, cycle)?);
                let assumed = system.condition(*assuming, cycle)?;
                let mut seen = Vec::new();
                for (seen_before, condition) in duty.seen.iter().zip(*fair) {
                    let now = system.atom(*condition, cycle)?;
                    seen.push(system.gates.or(*seen_before, now));
                }
                let gates = &mut system.gates;
                let (mut forth, mut back) = (Bit::FALSE, Bit::FALSE);
                for (place, rises) in &self.measured.numbers {
                    let (now, then) = (&cycle.before[*place], &cycle.now[*place]);
                    let (falls, rise) = (then.less(gates, now), now.less(gates, then));
                    let (to, from) = if *rises { (rise, falls) } else { (falls, rise) };
                    (forth, back) = (gates.or(forth, to), gates.or(back, from));
                }
                let lasts = gates.all([duty.pending, assumed, !goal]);
                let ends = gates.all(seen.iter().copied());
                let moved = gates.or(duty.moved, forth);
                let idle = gates.and(ends, !moved);
                let counts = gates.or(idle, back);
                let used_up = !duty.rest.is_true(gates);
                let broken = gates.all([lasts, counts, used_up]);
                let asked = gates.and(when, !goal);
                let pending = gates.or(lasts, asked);
                let less = duty.rest.minus(gates, &Word::constant(1));
                let fewer = gates.and(counts, !used_up);
                let rest = less.choice(gates, fewer, &duty.rest);
                let rest = rest.choice(gates, lasts, &self.within);
                let rest = rest.choice(gates, pending, &Word::constant(0));
                let goes_on = gates.and(lasts, !ends);
                let seen = seen.into_iter().map(|bit| gates.and(goes_on, bit));
                let seen = seen.collect();
                let moved = gates.and(goes_on, moved);
                let duty = Duty {
                    pending,
                    rest,
                    seen,
                    moved,
                };
                (broken, duty)
            }
        })
    }
}
