//! Properties, and what the search watches for on their behalf.

use crate::choices::Odometer;
use crate::process::Process;
use crate::report::Error;
use crate::system::Fault;

/// A property with its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Property {
    /// The name used in reports.
    pub id: String,
    /// What it claims.
    pub form: Form,
}

/// The forms of properties; atoms are given by number. A property speaks about every cycle of every run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Form {
    /// In each cycle (with `when`) `then` holds; vacuous if `when` never does.
    Always {
        /// The condition; none for every cycle.
        when: Option<usize>,
        /// What must hold in such a cycle.
        then: usize,
    },
    /// After a cycle k with `when`, `goal` holds in k or later.
    LeadsTo {
        /// What starts the duty.
        when: usize,
        /// What ends it.
        goal: usize,
        /// With a bound: in one of the cycles k ..= k + within, on every path. Without: on each infinite run.
        within: Option<u32>,
        /// Only runs on which each of these holds infinitely often count (only without a bound).
        fair: Vec<usize>,
        /// Only runs on which this holds in each cycle after k count.
        assuming: Option<usize>,
    },
    /// From a cycle with `when` on, in each cycle `holds` or `unless`; a cycle with `unless` ends the duty.
    Unless {
        /// What starts the duty.
        when: usize,
        /// What must hold.
        holds: usize,
        /// What ends the duty.
        unless: usize,
    },
    /// From each reachable state a path, all of whose cycles satisfy `using`, ends in a cycle with `goal`.
    CanAlwaysReach {
        /// What must stay reachable.
        goal: usize,
        /// What the cycles of the path satisfy, the last one included.
        using: Option<usize>,
    },
    /// A cycle with `goal` exists.
    Reachable {
        /// What is looked for.
        goal: usize,
    },
}

/// The most `fair` conditions of one property.
pub(crate) const MOST_FAIR: usize = 31;

pub(crate) fn validate(properties: &[Property]) -> Result<(), Error> {
    for property in properties {
        if let Form::LeadsTo { within, fair, .. } = &property.form {
            if within.is_some() && !fair.is_empty() {
                return Err(Error::FairWithBound {
                    id: property.id.clone(),
                });
            }
            if fair.len() > MOST_FAIR {
                return Err(Error::TooManyFair {
                    id: property.id.clone(),
                });
            }
        }
    }
    Ok(())
}

/// What one cycle means for one property.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sign {
    /// The condition (or the goal of a form without one) held.
    pub(crate) first: bool,
    /// The cycle violates the property.
    pub(crate) bad: bool,
    /// The cycle leaves a duty pending in the state after it.
    pub(crate) pending: bool,
    /// The cycle starts a response and ends it at once.
    pub(crate) met: bool,
}

/// Evaluates atoms; faults go to a handler and count as FALSE.
pub(crate) struct Eval<'a, P: ?Sized, F> {
    pub(crate) process: &'a mut P,
    pub(crate) choices: &'a mut Odometer,
    pub(crate) fault: F,
}

impl<P: Process + ?Sized, F: FnMut(Fault)> Eval<'_, P, F> {
    #[inline]
    pub(crate) fn atom(&mut self, atom: usize) -> bool {
        match self.process.atom(atom, self.choices) {
            Ok(value) => value,
            Err(fault) => {
                (self.fault)(fault);
                false
            }
        }
    }

    /// An absent condition is TRUE.
    #[inline]
    pub(crate) fn given(&mut self, atom: Option<usize>) -> bool {
        atom.is_none_or(|atom| self.atom(atom))
    }

    /// What the cycle means for a property when no duty is pending before it.
    #[inline]
    pub(crate) fn sign(&mut self, form: &Form) -> Sign {
        let mut sign = Sign::default();
        match form {
            Form::Always { when, then } => {
                sign.first = self.given(*when);
                sign.bad = sign.first && !self.atom(*then);
            }
            Form::LeadsTo { when, goal, .. } => {
                sign.first = self.atom(*when);
                sign.met = sign.first && self.atom(*goal);
                sign.pending = sign.first && !sign.met;
            }
            Form::Unless {
                when,
                holds,
                unless,
            } => {
                sign.first = self.atom(*when);
                if sign.first {
                    let duty = self.duty(*holds, *unless);
                    sign.bad = duty.bad;
                    sign.pending = duty.pending;
                }
            }
            Form::CanAlwaysReach { goal, using } => {
                sign.first = self.given(*using) && self.atom(*goal);
            }
            Form::Reachable { goal } => sign.first = self.atom(*goal),
        }
        sign
    }

    /// One cycle under the duty of a weak until.
    #[inline]
    pub(crate) fn duty(&mut self, holds: usize, unless: usize) -> Sign {
        let ended = self.atom(unless);
        let held = !ended && self.atom(holds);
        Sign {
            bad: !ended && !held,
            pending: held,
            ..Sign::default()
        }
    }
}

impl Form {
    /// The atoms it mentions.
    pub(crate) fn atoms(&self) -> Vec<usize> {
        match self {
            Form::Always { when, then } => when.iter().chain([then]).copied().collect(),
            Form::LeadsTo {
                when,
                goal,
                fair,
                assuming,
                ..
            } => [when, goal]
                .into_iter()
                .chain(fair)
                .chain(assuming)
                .copied()
                .collect(),
            Form::Unless {
                when,
                holds,
                unless,
            } => vec![*when, *holds, *unless],
            Form::CanAlwaysReach { goal, using } => using.iter().chain([goal]).copied().collect(),
            Form::Reachable { goal } => vec![*goal],
        }
    }

    /// Whether nothing more can be learnt from cycles once `first` and `bad` are known.
    pub(crate) fn settled(&self, first: bool, bad: bool) -> bool {
        match self {
            Form::Always { .. } | Form::Unless { .. } => bad,
            Form::LeadsTo { .. } => false,
            Form::CanAlwaysReach { .. } | Form::Reachable { .. } => first,
        }
    }

    /// Whether the search alone gives the verdict.
    pub(crate) fn decided_by(&self, first: bool, bad: bool) -> bool {
        match self {
            Form::CanAlwaysReach { .. } => false,
            _ => self.settled(first, bad),
        }
    }
}
