//! That something can always be reached: a ranking function in pieces.
//!
//! Every state of the invariant is in a region, a cube of states. With the inputs given for a region a cycle from it shows the goal, or
//! ends in an earlier region, or stays in it while a number falls or rises, which ranges let no number do for ever. A region is about
//! the states that are in none before.

use std::collections::BTreeMap;

use super::clause::{Clause, Literal, written};
use super::gates::Bit;
use super::question::{Obligation, Place, Question, Unshown, opposite};
use super::target::Target;

/// A region and the way out of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Step {
    /// All of these hold in its states.
    pub region: Vec<Literal>,
    /// Inputs by their written names; those that are not named do not matter.
    pub inputs: Vec<(String, i64)>,
    /// A number that falls, or rises, until the region is left; by its written name.
    pub rank: Option<Rank>,
}

/// A number that falls with each cycle, or rises.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rank {
    /// Its written name.
    pub name: String,
    /// It rises.
    pub rises: bool,
}

impl Question<'_> {
    /// That each state of the invariant is in a region; and that each region has a way out.
    pub(super) fn ways(&mut self, steps: &[Step]) -> Result<[Obligation; 2], String> {
        Ok([self.cover(steps)?, self.way(steps)?])
    }

    fn cover(&mut self, steps: &[Step]) -> Result<Obligation, String> {
        let (place, given) = self.anywhere()?;
        let mut goal = Vec::new();
        for step in steps {
            goal.push(!self.inside(step, &place)?);
        }
        Ok(self.obligation(given, vec![(goal, Unshown::Cover)]))
    }

    fn way(&mut self, steps: &[Step]) -> Result<Obligation, String> {
        let (place, mut given) = self.anywhere()?;
        let Target::Way { goal, using } = self.target else {
            return Err("there are regions, but nothing that they lead to".to_owned());
        };
        let mut goals = Vec::new();
        let mut outside: Vec<Bit> = Vec::new();
        for (k, step) in steps.iter().enumerate() {
            let chosen = self.chosen(step)?;
            let before = place.state.clone();
            let (mut cycle, ranges) = self.system.cycle_with(before, &chosen)?;
            let mut region = outside.clone();
            let here = self.inside(step, &place)?;
            region.push(here);
            let mut legal = Vec::new();
            for (number, keeps) in ranges.into_iter().enumerate() {
                // The others may have any value of theirs.
                match chosen.contains_key(&number) {
                    true => legal.push(keeps),
                    false => given.push(vec![keeps]),
                }
            }
            let mut ends = self.system.atom(goal, &mut cycle)?;
            let used = self.system.condition(using, &mut cycle)?;
            let after = Place {
                state: cycle.now.clone(),
                duty: place.duty.clone(),
            };
            for earlier in &steps[..k] {
                let there = self.inside(earlier, &after)?;
                ends = self.gates().or(ends, there);
            }
            if let Some(rank) = &step.rank {
                let there = self.inside(step, &after)?;
                let now = self.number(&rank.name, &place)?;
                let then = self.number(&rank.name, &after)?;
                let (small, great) = if rank.rises { (now, then) } else { (then, now) };
                let moves = small.less(self.gates(), &great);
                let stays = self.gates().and(there, moves);
                ends = self.gates().or(ends, stays);
            }
            let legal = self.gates().all(legal);
            for (fine, what) in [
                (legal, Unshown::Input(k)),
                (!cycle.fault, Unshown::Way(k)),
                (used, Unshown::Way(k)),
                (ends, Unshown::Way(k)),
            ] {
                goals.push(([&region[..], &[!fine]].concat(), what));
            }
            outside.push(!here);
        }
        Ok(self.obligation(given, goals))
    }

    /// The values of inputs by their places.
    fn chosen(&self, step: &Step) -> Result<BTreeMap<usize, i64>, String> {
        let own = &self.system.bound.system.inputs;
        let one = |(name, value): &(String, i64)| {
            let place = own.iter().position(|var| written(&var.name) == *name);
            let place = place.ok_or_else(|| format!("there is no input `{name}`"))?;
            Ok((place, *value))
        };
        step.inputs.iter().map(one).collect()
    }

    fn inside(&mut self, step: &Step, place: &Place) -> Result<Bit, String> {
        let all = self.clause(&Clause(step.region.clone()), place)?;
        Ok(!self.gates().any(opposite(&all)))
    }
}
