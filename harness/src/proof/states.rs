//! Sets of states: reachable ones and their number, what can always be reached, runs without an end.

use stillpoint_model::Verdict;
use stillpoint_model::proof::{Condition, Lit, Netlist, Problem, Run, Spent, States, value};

use super::decide::{Decision, LIMITED};
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

/// So many questions may use up their time with the states of the whole system.
const PATIENCE: u32 = 3;

/// All variables of a system.
fn whole(asked: &Asked) -> Vec<Lit> {
    let netlist = &asked.translated.netlist;
    let latches = netlist.latches[..asked.latches].iter().map(|l| l.lit);
    latches
        .chain(netlist.inputs.iter().map(|i| i.lit))
        .collect()
}

/// Whether a run has `begin` before the cycle that it comes back to, `stays` in each cycle behind that, each condition from there on,
/// and these latches at its end as they were there.
fn endless(
    (netlist, latches): (&Netlist, usize),
    run: &Run,
    back_to: usize,
    (begin, stays, fair): (Lit, Lit, &[Lit]),
) -> bool {
    let own = &netlist.latches[..latches];
    let all: Vec<Lit> = own.iter().map(|latch| latch.lit).collect();
    let mut cycles = Vec::new();
    let mut states = Vec::new();
    let made = Problem::with(netlist, Lit::TRUE, &all).play(run, |values| {
        let met: Vec<bool> = fair.iter().map(|lit| value(values, *lit)).collect();
        cycles.push((value(values, begin), value(values, stays), met));
        let now: Vec<bool> = own.iter().map(|l| value(values, l.lit)).collect();
        let then: Vec<bool> = own.iter().map(|l| value(values, l.next)).collect();
        states.push((now, then));
    });
    let (Some(last), Some(first)) = (states.last(), states.get(back_to)) else {
        return false;
    };
    let begun = cycles[..back_to].iter().rposition(|cycle| cycle.0);
    made && last.1 == first.0
        && begun.is_some_and(|k| cycles[k + 1..].iter().all(|cycle| cycle.1))
        && (0..fair.len()).all(|k| cycles[back_to..].iter().any(|cycle| cycle.2[k]))
}

impl Judge<'_> {
    /// Begins with the states of the whole system, which most properties are asked of.
    pub(super) fn begin_states(&self, asked: &Asked) {
        let whole = Problem::with(&asked.translated.netlist, Lit::FALSE, &whole(asked));
        let states = States::new(&whole, &self.budget).ok();
        *self.states.borrow_mut() = states.map(|states| (states, 0));
    }

    /// How many states are reachable.
    pub(super) fn count_states(&self, entry: &mut Judged) {
        if let Some((states, _)) = &mut *self.states.borrow_mut() {
            states.limit(&self.budget);
            if states.reach(None).is_ok() {
                entry.verdict = Verdict::Holds;
                entry.engine = Some(Engine::Bdd);
                entry.proof = Some(Proof::reached(states));
                return;
            }
        }
        entry.reason = Some(LIMITED.to_owned());
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
            let told = told.map(|lit| states.condition(&netlist.graph, *lit));
            let told: Result<Option<Vec<Condition>>, Spent> = told.collect();
            told?.map(|conditions| ask(states, &conditions)).transpose()
        };
        let mut whole = self.states.borrow_mut();
        if let Some((states, spent)) = &mut *whole {
            states.limit(&self.budget);
            match asked(states) {
                Ok(Some(answer)) => return Ok(answer),
                Ok(None) => {}
                // The next question goes on from what was reached, unless it leads nowhere: then what it depends on is asked.
                Err(Spent) if self.budget.spent() => {
                    *spent += 1;
                    if *spent == PATIENCE {
                        *whole = None;
                    }
                    return Err(Spent);
                }
                // It has no room for the next question either, nor has the same again.
                Err(Spent) => {
                    *whole = None;
                    if !also.is_empty() {
                        return Err(Spent);
                    }
                }
            }
        }
        let cone = Problem::with(netlist, Lit::FALSE, &[conditions, also].concat());
        asked(&mut States::new(&cone, &self.budget)?)?.ok_or(Spent)
    }

    /// Whether a cycle with `target` is reachable.
    pub(super) fn reached(&self, netlist: &Netlist, target: Lit) -> Decision {
        if target == Lit::FALSE {
            return Decision::Never(Proof::Nothing);
        }
        let answer = self.ask_states(netlist, &[target], &[], |states, target| {
            Ok(match states.reach(Some(target[0]))? {
                Some(run) => Decision::Seen(run),
                None => Decision::Never(Proof::reached(states)),
            })
        });
        match answer {
            // Whatever an engine says is checked by other code.
            Ok(Decision::Seen(run)) if !Problem::new(netlist, target).shows(&run) => {
                Decision::Open("the engine's run is none: please report this".to_owned())
            }
            Ok(decision) => decision,
            Err(Spent) => Decision::Open(LIMITED.to_owned()),
        }
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
            let made = Problem::with(netlist, Lit::TRUE, &[using, end]);
            if !run.cycles.is_empty() && !made.shows(&run) {
                return self.wrong(entry);
            }
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
            entry.trace = Some(asked.trace(&run));
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
        let Some(cycle) = lasso.back_to else {
            entry.reason = Some("a run without an end was not followed to where it was".to_owned());
            return false;
        };
        if !endless(
            (&netlist, asked.latches),
            &lasso.run,
            cycle,
            (begin, stays, &response.fair),
        ) {
            return self.wrong(entry);
        }
        self.found(asked, entry, &lasso.run);
        entry.engine = Some(Engine::Bdd);
        entry.verdict = Verdict::Violated;
        if let Some(trace) = &mut entry.trace {
            trace.loop_start = Some(cycle);
        }
        true
    }

    fn wrong(&self, entry: &mut Judged) -> bool {
        entry.reason = Some("the engine's run is none: please report this".to_owned());
        false
    }

    fn spent(&self, entry: &mut Judged) -> bool {
        entry.reason = entry.reason.take().or(Some(LIMITED.to_owned()));
        false
    }
}
