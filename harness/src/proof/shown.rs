//! What an engine has found, in the words of a certificate.

use stillpoint_certify::proof::clause::{Clause, Literal};
use stillpoint_certify::proof::question::Induction;

use super::Proof;
use super::question::Asked;

/// What shows that something is never seen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// Each holds in every reachable state.
    pub invariant: Vec<Clause>,
    /// Where that alone is not enough.
    pub induction: Option<Induction>,
}

impl Asked<'_> {
    /// A proof, beside what was known beforehand.
    pub(super) fn shown(&self, proof: &Proof, known: Vec<Clause>) -> Shown {
        let mut shown = Shown {
            invariant: known,
            induction: None,
        };
        match proof {
            Proof::Induction(cycles, differ) => {
                shown.induction = Some(Induction {
                    cycles: *cycles,
                    differ: differ.clone(),
                });
            }
            Proof::Invariant(invariant) => {
                let own = invariant.clauses.iter().map(|clause| {
                    let literals = clause.iter();
                    Clause(
                        literals
                            .map(|(latch, set)| self.bit(*latch, *set))
                            .collect(),
                    )
                });
                shown.invariant.extend(own);
            }
            Proof::Nothing | Proof::States(_) => {}
        }
        shown
    }

    /// A latch with this value.
    fn bit(&self, latch: usize, set: bool) -> Literal {
        let (name, bit) = match self.translated.place(latch) {
            Some((variable, bit)) => (self.name(variable), bit),
            None => {
                // A latch of a monitor: `monitor.pending`, or bit n of a counter, `monitor.rest.n`.
                let name = &self.translated.netlist.latches[latch].name;
                let name = name.strip_prefix("monitor.").unwrap_or(name);
                let (name, bit) = name.split_once('.').unwrap_or((name, "0"));
                (format!("@{name}"), bit.parse().unwrap_or(0))
            }
        };
        Literal::Bit { name, bit, set }
    }
}
