//! Sets of states: reachable ones and their number, what can always be reached, runs without an end.

use stillpoint_model::Verdict;
use stillpoint_model::proof::{Condition, Lit, Netlist, Problem, Spent, States};

use super::decide::Decision;
use super::monitor::Forever;
use super::question::Asked;
use super::{Engine, Judge, Judged, Proof};

impl Proof {
    /// All states that were reached.
    pub(super) fn reached(states: &States) -> Self {
        Proof::Reached {
            states: states.count(),
            cycles: states.depth(),
        }
    }
}

/// All variables of a system.
fn whole(asked: &Asked) -> Vec<Lit> {
    let netlist = &asked.translated.netlist;
    let latches = netlist.latches[..asked.latches].iter().map(|l| l.lit);
    latches
        .chain(netlist.inputs.iter().map(|i| i.lit))
        .collect()
}

impl Judge<'_> {
    /// Begins with the states of the whole system, which most properties are asked of.
    pub(super) fn begin_states(&self, asked: &Asked) {
        let whole = Problem::with(&asked.translated.netlist, Lit::FALSE, &whole(asked));
        *self.states.borrow_mut() = States::new(&whole, &self.budget).ok();
    }

    /// How many states are reachable.
    pub(super) fn count_states(&self, entry: &mut Judged) {
        if let Some(states) = &mut *self.states.borrow_mut() {
            states.limit(&self.budget);
            if states.reach(None).is_ok() {
                entry.verdict = Verdict::Holds;
                entry.engine = Some(Engine::Bdd);
                entry.proof = Some(Proof::reached(states));
                return;
            }
        }
        entry.reason = Some("the limit was reached first".to_owned());
    }

    /// An answer of the states of the whole system; where there is none, of those that the conditions and `also` depend on.
    fn ask_states<T>(
        &self,
        netlist: &Netlist,
        conditions: &[Lit],
        also: &[Lit],
        ask: impl Fn(&mut States, &[Condition]) -> Result<T, Spent>,
    ) -> Result<T, Spent> {
        let asked = |states: &mut States| {
            let told = conditions.iter();
            let told = told.map(|lit| states.condition(&netlist.graph, &[*lit]));
            let told: Result<Option<Vec<Condition>>, Spent> = told.collect();
            told?.map(|conditions| ask(states, &conditions)).transpose()
        };
        if let Some(states) = &mut *self.states.borrow_mut() {
            states.limit(&self.budget);
            if let Ok(Some(answer)) = asked(states) {
                return Ok(answer);
            }
        }
        let cone = Problem::with(netlist, Lit::FALSE, &[conditions, also].concat());
        asked(&mut States::new(&cone, &self.budget)?)?.ok_or(Spent)
    }

    /// Whether a cycle with `target` is reachable.
    pub(super) fn reached(&self, netlist: &Netlist, target: Lit) -> Decision {
        let answer = self.ask_states(netlist, &[target], &[], |states, target| {
            Ok(match states.reach(Some(target[0]))? {
                Some(run) => Decision::Seen(run),
                None => Decision::Never(Proof::reached(states)),
            })
        });
        answer.unwrap_or_else(|Spent| Decision::Open("the limit was reached first".to_owned()))
    }

    /// Whether something can always be reached: whether there is an answer.
    pub(super) fn recovers(
        &self,
        asked: &Asked,
        entry: &mut Judged,
        (using, end): (Lit, Lit),
    ) -> bool {
        let netlist = &asked.translated.netlist;
        let answer = self.ask_states(netlist, &[using, end], &[], |states, conditions| {
            let (using, end) = (conditions[0], conditions[1]);
            let lost = states.lost(using, end)?;
            let shown = match lost {
                Some(_) => None,
                None => states.reach(Some(end))?,
            };
            Ok((lost, shown, Proof::reached(states)))
        });
        let Ok((lost, shown, proof)) = answer else {
            return self.spent(entry);
        };
        entry.reason = None;
        if let Some(run) = lost {
            self.found(asked, entry, &run);
            entry.engine = Some(Engine::Bdd);
            entry.verdict = Verdict::Violated;
            return true;
        }
        entry.engine = Some(Engine::Bdd);
        entry.verdict = Verdict::Holds;
        entry.proof = Some(proof);
        if let Some(run) = shown {
            entry.length = Some(run.cycles.len() as u64);
            entry.trace = Some(asked.translated.trace(&run));
        }
        true
    }

    /// Whether a response without a bound comes: whether there is an answer.
    pub(super) fn comes(&self, asked: &Asked, entry: &mut Judged, response: &Forever) -> bool {
        let mut netlist = asked.translated.netlist.clone();
        let fault = asked.translated.fault;
        let open = netlist.graph.and(!response.goal, !fault);
        let begin = netlist.graph.and(response.when, open);
        let stays = netlist.graph.and(response.assuming, open);
        let conditions = [&[begin, stays][..], &response.fair].concat();
        // A run without an end is one of all variables: they come back to where they were.
        let all = whole(asked);
        let answer = self.ask_states(&netlist, &conditions, &all, |states, conditions| {
            let lasso = states.forever(conditions[0], conditions[1], &conditions[2..])?;
            Ok((lasso, Proof::reached(states)))
        });
        let Ok((lasso, proof)) = answer else {
            return self.spent(entry);
        };
        entry.reason = None;
        let Some(lasso) = lasso else {
            entry.engine = Some(Engine::Bdd);
            entry.proof = Some(proof);
            self.first(asked, entry, response.first);
            return true;
        };
        self.found(asked, entry, &lasso.run);
        entry.engine = Some(Engine::Bdd);
        entry.verdict = Verdict::Violated;
        match (&mut entry.trace, lasso.back_to) {
            (Some(trace), Some(cycle)) => trace.loop_start = Some(cycle),
            _ => entry.trace = None,
        }
        true
    }

    fn spent(&self, entry: &mut Judged) -> bool {
        entry.reason = entry
            .reason
            .take()
            .or(Some("the limit was reached first".to_owned()));
        false
    }
}
