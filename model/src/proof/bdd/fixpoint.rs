//! Fixed points backwards: what can be reached from where, and where a run without an end goes on.

use super::super::netlist::Run;
use super::super::sat::Spent;
use super::path::Lasso;
use super::store::Edge;
use super::{Condition, Set, States};

impl States {
    /// A shortest run to a reachable state from which no run of cycles with `using` ends in one with `end`, which is one of them; none if there
    /// is no such state.
    ///
    /// # Errors
    /// The budget was spent.
    pub fn lost(&mut self, using: Condition, end: Condition) -> Result<Option<Run>, Spent> {
        self.reach(None)?;
        let goal = self.permitting(end)?;
        let goal = (self.diagrams).and(goal, self.diagrams.get(self.reached))?;
        let back = self.grown(goal, using, &mut [])?;
        Ok(self.to(!back)?.map(|(run, _)| run))
    }

    /// A run that has `begin` in a cycle and goes on without an end from there, with `stays` in each cycle and each condition of `fair` in infinitely many; the
    /// shortest up to that cycle. None if there is none.
    ///
    /// # Errors
    /// The budget was spent.
    pub fn forever(
        &mut self,
        begin: Condition,
        stays: Condition,
        fair: &[Condition],
    ) -> Result<Option<Lasso>, Spent> {
        self.reach(None)?;
        let mut rounds = Vec::new();
        for condition in fair {
            let condition = self.diagrams.get(condition.0);
            let both = (self.diagrams).and(condition, self.diagrams.get(stays.0))?;
            rounds.push(Condition(self.diagrams.keep(both)));
        }
        if rounds.is_empty() {
            rounds.push(stays);
        }
        // The greatest fixed point of Emerson and Lei: from each state of the set a run leads to each condition and into the set again.
        let mut set = self.diagrams.get(self.reached);
        loop {
            let mut before = set;
            for met in &rounds {
                let met = self.before(set, *met, &mut [&mut before, &mut set])?;
                let met = self.diagrams.and(met, set)?;
                let some = self.grown(met, stays, &mut [&mut before, &mut set])?;
                set = self.diagrams.and(set, some)?;
            }
            if set == before {
                break;
            }
        }
        let kept = self.diagrams.keep(set);
        let from = self.before(set, begin, &mut [])?;
        match self.to(from)? {
            Some((run, state)) => Ok(Some(self.lasso(
                run,
                state,
                (begin, stays, &rounds),
                kept,
            )?)),
            None => Ok(None),
        }
    }

    /// The states, reachable or not, in which some inputs make a condition hold.
    pub(super) fn permitting(&mut self, condition: Condition) -> Result<Set, Spent> {
        let inputs = self.diagrams.cube(&self.levels.inputs)?;
        let condition = self.diagrams.get(condition.0);
        (self.diagrams).and_exists(condition, self.diagrams.get(self.assumed), inputs)
    }

    /// The states from which a cycle with a condition leads into a set.
    pub(super) fn before(
        &mut self,
        set: Set,
        condition: Condition,
        also: &mut [&mut Edge],
    ) -> Result<Set, Spent> {
        let then = self.diagrams.shifted(set, true)?;
        let both = (self.diagrams).and(then, self.diagrams.get(condition.0))?;
        self.backward.apply(&mut self.diagrams, both, also)
    }

    /// Grows a set by the reachable states from which a cycle with a condition leads into it, until there are no more.
    fn grown(&mut self, begin: Set, by: Condition, also: &mut [&mut Edge]) -> Result<Set, Spent> {
        let (mut all, mut new) = (begin, begin);
        while new != Edge::FALSE {
            let mut roots: Vec<&mut Edge> = also.iter_mut().map(|edge| &mut **edge).collect();
            roots.push(&mut all);
            let more = self.before(new, by, &mut roots)?;
            let more = (self.diagrams).and(more, self.diagrams.get(self.reached))?;
            new = self.diagrams.and(more, !all)?;
            all = self.diagrams.or(all, new)?;
        }
        Ok(all)
    }
}
