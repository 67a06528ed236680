//! What the engines leave to the explorer.

use stillpoint_engine::{label, run as explore};
use stillpoint_model::{Judgement, Limits, Options, Verdict};

use super::decide::LIMITED;
use super::{Engine, Judge, Judged, Proof};

impl Judge<'_> {
    /// Leaves some properties to the explorer, with `ranges` also those.
    pub(super) fn explore(&mut self, numbers: &[usize], ranges: bool) {
        let mut part = self.bound.clone();
        part.system.properties = (numbers.iter())
            .map(|k| self.bound.system.properties[*k].clone())
            .collect();
        let options = Options {
            limits: Limits {
                memory: self.settings.memory,
                threads: self.settings.threads,
                time: self.left(),
            },
            interrupt: self.settings.interrupt.clone(),
            ..Options::default()
        };
        let properties = &part.system.properties;
        let outcome = match explore(&part, &options, false, &mut ()) {
            Ok(outcome) => outcome,
            Err(error) => {
                for (property, k) in properties.iter().zip(numbers) {
                    let mut entry = self.entry(label(property), &property.text);
                    entry.reason = Some(error.to_string());
                    self.place(*k, entry);
                }
                return;
            }
        };
        let report = &outcome.report;
        for (n, (property, judged)) in properties.iter().zip(&report.properties).enumerate() {
            let mut entry = self.entry(label(property), &property.text);
            entry.seconds = report.seconds;
            self.explored(&mut entry, judged, report.states);
            entry.reason = entry.reason.or(outcome.refuted.get(&n).cloned());
            // A property that the engines have no form for keeps the reason.
            self.place(numbers[n], entry);
        }
        if ranges && !self.bound.system.sites.is_empty() {
            let mut entry = self.entry(
                "range".to_owned(),
                "no assignment leaves the range of its variable",
            );
            entry.engine = Some(Engine::Explorer);
            entry.seconds = report.seconds;
            match report
                .faults
                .iter()
                .filter_map(|f| Some((f.length?, f)))
                .min_by_key(|f| f.0)
            {
                Some((length, fault)) => {
                    entry.verdict = Verdict::Violated;
                    entry.length = Some(length);
                    entry.trace = fault.trace.clone();
                }
                None if report.complete => {
                    entry.verdict = Verdict::Holds;
                    entry.proof = Some(Proof::States(report.states));
                }
                None => entry.reason = Some(LIMITED.to_owned()),
            }
            self.out.push(entry);
        }
    }

    fn explored(&self, entry: &mut Judged, judged: &Judgement, states: u64) {
        entry.verdict = judged.verdict;
        entry.length = judged.length;
        entry.trace = judged.trace.clone();
        match judged.verdict {
            Verdict::Inconclusive => entry.reason = Some(LIMITED.to_owned()),
            Verdict::Holds | Verdict::Vacuous | Verdict::Unreachable => {
                entry.engine = Some(Engine::Explorer);
                entry.proof = Some(Proof::States(states));
            }
            _ => entry.engine = Some(Engine::Explorer),
        }
    }

    fn place(&mut self, k: usize, entry: Judged) {
        match self.out.get_mut(k) {
            Some(old) => *old = entry,
            None => self.out.push(entry),
        }
    }
}
