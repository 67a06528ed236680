//! What an engine has found, in the words of a certificate.

use stillpoint_certify::proof::clause::{Clause, Literal, written};
use stillpoint_certify::proof::duty::Measure;
use stillpoint_certify::proof::question::Induction;
use stillpoint_certify::proof::ways::{Rank, Step};
use stillpoint_model::Trace;
use stillpoint_model::proof::{self, Invariant, Netlist};

use super::question::Asked;
use super::{Measured, Proof};

/// What shows that something is never seen.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Shown {
    /// Each holds in every reachable state.
    pub invariant: Vec<Clause>,
    /// Where that alone is not enough.
    pub induction: Option<Induction>,
    /// Of a response without a bound.
    pub measure: Option<Measure>,
    /// Of what can always be reached: regions and the ways out of them.
    pub ways: Vec<Step>,
    /// Of two runs as one system: the shortest pair that it is about. The invariant is one of both, too.
    pub both: Option<Trace>,
}

impl Asked<'_> {
    /// A proof, beside what was known beforehand.
    pub(super) fn shown(&self, netlist: &Netlist, proof: &Proof, known: Vec<Clause>) -> Shown {
        let mut shown = Shown {
            invariant: known,
            ..Shown::default()
        };
        match proof {
            Proof::Induction(cycles, differ) => {
                shown.induction = Some(Induction {
                    cycles: *cycles,
                    differ: differ.clone(),
                });
            }
            Proof::Invariant(invariant) => shown.invariant.extend(self.clauses(netlist, invariant)),
            Proof::Ways(ways) => {
                shown
                    .invariant
                    .extend(self.clauses(netlist, &ways.invariant));
                shown.ways = ways
                    .steps
                    .iter()
                    .map(|step| self.step(netlist, step))
                    .collect();
            }
            // A measure is told beside what shows it.
            Proof::Measured(..) | Proof::Nothing | Proof::States(_) | Proof::Reached { .. } => {}
        }
        shown
    }

    /// The numbers of a measure by their names.
    pub(super) fn measure(&self, measure: &Measured) -> Measure {
        let numbers = measure.numbers.iter().map(|rank| self.rank(rank));
        Measure {
            rounds: measure.rounds,
            numbers: numbers.collect(),
        }
    }

    fn rank(&self, rank: &proof::Rank) -> Rank {
        Rank {
            name: self.name(self.numbers()[rank.number]),
            rises: rank.rises,
        }
    }

    fn clauses<'s>(
        &'s self,
        netlist: &'s Netlist,
        invariant: &'s Invariant,
    ) -> impl Iterator<Item = Clause> + 's {
        let clauses = invariant.clauses.iter();
        clauses.map(|clause| Clause(self.bits(netlist, clause)))
    }

    fn bits(&self, netlist: &Netlist, values: &[(usize, bool)]) -> Vec<Literal> {
        let bits = values.iter();
        bits.map(|(latch, set)| self.bit(netlist, *latch, *set))
            .collect()
    }

    fn step(&self, netlist: &Netlist, step: &proof::Step) -> Step {
        let system = &self.translated.bound.system;
        let inputs = self.translated.chosen(&step.inputs).into_iter();
        let rank = step.rank.as_ref().map(|rank| self.rank(rank));
        Step {
            region: self.bits(netlist, &step.region),
            inputs: inputs
                .map(|(k, value)| (written(&system.inputs[k].name), value))
                .collect(),
            rank,
        }
    }

    /// A latch with this value.
    fn bit(&self, netlist: &Netlist, latch: usize, set: bool) -> Literal {
        let (name, bit) = match self.translated.place(latch) {
            Some((variable, bit)) => (self.name(variable), bit),
            None => {
                // A latch of a monitor: `monitor.pending`, or bit n of a counter, `monitor.rest.n`.
                let name = &netlist.latches[latch].name;
                let name = name.strip_prefix("monitor.").unwrap_or(name);
                let (name, bit) = name.split_once('.').unwrap_or((name, "0"));
                (format!("@{name}"), bit.parse().unwrap_or(0))
            }
        };
        Literal::Bit { name, bit, set }
    }
}
