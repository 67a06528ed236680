//! What a claim about one property needs: its runs are replayed here, and what has to hold in each cycle is told.

use stillpoint_lang::ir::Form;

use crate::check::{Checker, Duty, Leads, pairing};
use crate::cycle::{Pairing, Player};
use crate::format::{Proof, Run, Verdict};
use crate::replay::{cycles, ends, fault, violates};

impl<'a> Checker<'a> {
    fn player(&self, run: &'a Run) -> Result<Player<'a>, String> {
        Player::new(self.bound, &self.radix, run)
    }

    /// Checks the runs of a claim; what is left to be shown for each cycle.
    pub(crate) fn claim(
        &self,
        form: &'a Form,
        verdict: Verdict,
        proof: &'a Proof,
    ) -> Result<Duty<'a>, String> {
        use Verdict::{Holds, Open, Reached, Unreachable, Vacuous, Violated};
        let all = !self.body.states.is_empty();
        if !all && !matches!(verdict, Violated | Reached | Open) {
            return Err("a claim about all runs needs the set of states".to_owned());
        }
        let (map, pairs) = (&proof.map[..], !proof.pairs.is_empty());
        let runs = &proof.runs[..];
        match (form, verdict, runs, map, pairs) {
            (_, Open, [], [], false) => Ok(Duty::None),
            (Form::Always { when: None, then }, Holds, [], [], false) => {
                Ok(Duty::Implies(None, *then))
            }
            (
                Form::Always {
                    when: Some(when),
                    then,
                },
                Holds,
                [run],
                [],
                false,
            ) => {
                ends(self.player(run)?, |p| p.atom(*when))?;
                Ok(Duty::Implies(Some(*when), *then))
            }
            (
                Form::Always { .. } | Form::Unless { .. } | Form::LeadsTo { .. },
                Violated,
                [run],
                [],
                false,
            ) => {
                violates(self.bound, form, self.player(run)?, run.repeats)?;
                Ok(Duty::None)
            }
            (
                Form::Always {
                    when: Some(when), ..
                }
                | Form::LeadsTo { when, .. }
                | Form::Unless { when, .. }
                | Form::Independent {
                    condition: Some(when),
                    ..
                }
                | Form::Reachable { goal: when },
                Vacuous | Unreachable,
                [],
                [],
                false,
            ) if (verdict == Unreachable) == matches!(form, Form::Reachable { .. }) => {
                Ok(Duty::Never(*when))
            }
            (Form::Reachable { goal }, Reached, [run], [], false) => {
                ends(self.player(run)?, |p| p.atom(*goal))?;
                Ok(Duty::None)
            }
            (
                Form::Unless {
                    when,
                    holds,
                    unless,
                },
                Holds,
                [run],
                [_, ..],
                false,
            ) => {
                ends(self.player(run)?, |p| p.atom(*when))?;
                Ok(Duty::Unless(*when, *holds, *unless, map))
            }
            (
                Form::LeadsTo {
                    when,
                    goal,
                    within,
                    fair,
                    assuming,
                },
                Holds,
                [run],
                [_, ..],
                false,
            ) => {
                ends(self.player(run)?, |p| p.atom(*when))?;
                let within = within.as_ref().map(|n| cycles(self.bound, n));
                Ok(Duty::Leads(Leads {
                    when: *when,
                    goal: *goal,
                    within,
                    fair,
                    assuming: *assuming,
                    rank: map,
                }))
            }
            (Form::CanAlwaysReach { goal, using }, Holds, [], [_, ..], false) => {
                Ok(Duty::Near(*goal, *using, map))
            }
            (Form::CanAlwaysReach { goal, using }, Violated, [run], [_, ..], false) => {
                let mut player = self.player(run)?;
                while player.step()?.is_some() {}
                let end = self.radix.index(&player.state);
                let end = end.and_then(|end| self.body.states.binary_search(&end).ok());
                match end.map(|end| map[end]) {
                    None | Some(0) => Err("its run does not end in a lost state".to_owned()),
                    Some(_) => Ok(Duty::Lost(*goal, *using, map)),
                }
            }
            (Form::Independent { condition, .. }, Holds, [run], [], true) => {
                ends(self.player(run)?, |p| condition.is_none_or(|c| p.atom(c)))?;
                Ok(Duty::None)
            }
            (Form::Independent { .. }, Violated, [one, other], [], false) => {
                self.differ(form, one, other)?;
                Ok(Duty::None)
            }
            _ => Err(format!(
                "what it carries is no proof that this property is {verdict:?}"
            )),
        }
    }

    /// Two runs that differ in no more than they may, at whose end an observed expression differs.
    fn differ(&self, form: &Form, one: &'a Run, other: &'a Run) -> Result<(), String> {
        let Some(Pairing {
            observe,
            of,
            condition,
        }) = pairing(form)
        else {
            return Err("this property is not about two runs".to_owned());
        };
        let (mut one, mut other) = (self.player(one)?, self.player(other)?);
        let mut apart = one.state != other.state;
        let mut shown = false;
        loop {
            match (one.step()?, other.step()?) {
                (Some(_), Some(_)) => {}
                (None, None) => break,
                _ => apart = true,
            }
            let both = condition.is_none_or(|c| one.atom(c) && other.atom(c));
            let inputs = one.inputs.iter().zip(&other.inputs).enumerate();
            for (k, _) in inputs.filter(|(_, (a, b))| a != b) {
                apart |= !both || !of.contains(&k);
            }
            shown = both && observe.iter().any(|k| one.observe(*k) != other.observe(*k));
        }
        (shown && !apart)
            .then_some(())
            .ok_or_else(|| "its runs do not show that the inputs matter".to_owned())
    }

    /// The runs into range faults: each ends in the fault that is claimed.
    pub(crate) fn faults(&self) -> Result<(), String> {
        for (name, run) in self.task.faults.iter().zip(&self.body.faults) {
            let end = fault(self.player(run)?)?;
            let site = end.and_then(|site| self.bound.system.sites.get(site as usize));
            if site.is_none_or(|site| site.name != *name) {
                return Err(format!("no run shows the range fault {name}"));
            }
        }
        Ok(())
    }
}
