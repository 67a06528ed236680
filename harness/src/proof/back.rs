//! What can always be reached: ways back, asked of the engine.

use stillpoint_model::Verdict;
use stillpoint_model::proof::{Lit, Recovery, Spent, Ways, Word, ways};

use super::decide::{Decision, LIMITED};
use super::question::Asked;
use super::{Choice, Engine, Judge, Judged, Proof};

impl Judge<'_> {
    /// Whether ways to the goal are found from every reachable state.
    pub(super) fn ways(
        &self,
        asked: &Asked,
        entry: &mut Judged,
        (goal, using, end): (Lit, Lit, Lit),
    ) -> bool {
        if !matches!(self.settings.choice, Choice::Auto | Choice::Pdr) {
            entry.reason = Some("what can always be reached needs pdr or bdd".to_owned());
            return false;
        }
        let translated = &asked.translated;
        let counting = asked.numbers();
        let numbers: Vec<Word> = counting.iter().map(|k| translated.variable(*k).0).collect();
        let timer = |latch: &usize| {
            let place = translated.place(*latch);
            place.is_some_and(|(k, _)| k >= asked.own || counting.contains(&k))
        };
        let timers: Vec<usize> = (0..translated.netlist.latches.len())
            .filter(timer)
            .collect();
        let recovery = Recovery {
            netlist: &translated.netlist,
            goal,
            using,
            numbers: &numbers,
            timers: &timers,
        };
        let checked = |ways: Option<Ways>| match ways {
            Some(ways) => Ok(Some((ways.check(&recovery, &self.budget)?, ways))),
            None => Ok(None),
        };
        match ways(&recovery, &self.budget).and_then(checked) {
            Ok(Some((false, _))) => {
                entry.reason =
                    Some("the engine's ways lead nowhere: please report this".to_owned());
            }
            Ok(Some((true, ways))) => {
                // The shortest way from the start shows what it is about.
                let Decision::Seen(run) = self.decide(asked, end) else {
                    entry.reason = Some(LIMITED.to_owned());
                    return false;
                };
                entry.length = Some(run.cycles.len() as u64);
                entry.trace = Some(asked.trace(&run));
                entry.verdict = Verdict::Holds;
                entry.engine = Some(Engine::Pdr);
                let proof = Proof::Ways(ways);
                entry.shown =
                    Some(asked.shown(&asked.translated.netlist, &proof, self.known.clone()));
                entry.proof = Some(proof);
                return true;
            }
            Ok(None) => {
                entry.reason = Some("no way to the goal was found from some states".to_owned())
            }
            Err(Spent) => entry.reason = Some(LIMITED.to_owned()),
        }
        false
    }
}
