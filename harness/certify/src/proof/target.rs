//! What must never be seen so that a verdict is true.

use stillpoint_lang::ir::{Form, Node};

use crate::format::Verdict;

/// What must never be seen.
#[derive(Clone, Debug)]
pub enum Target<'a> {
    /// A value leaves its range.
    Range,
    /// An atom is TRUE.
    Goal(usize),
    /// One atom is TRUE (none: always) and another one FALSE.
    Broken(Option<usize>, usize),
    /// After `when` and before `unless`, a cycle without `holds`.
    Until {
        /// What begins it.
        when: usize,
        /// The duty.
        holds: usize,
        /// What ends it.
        unless: usize,
    },
    /// After `when` no `goal` for too long.
    Late {
        /// What begins it.
        when: usize,
        /// What ends it.
        goal: usize,
        /// After how many cycles at most.
        within: &'a Node,
    },
    /// After `when` no `goal` ever, with `assuming` in each cycle and each of `fair` again and again: no single cycle shows it, but one
    /// shows that its measure is none.
    Forever {
        /// What begins it.
        when: usize,
        /// What ends it.
        goal: usize,
        /// What holds in each cycle after the first.
        assuming: Option<usize>,
        /// What holds infinitely often.
        fair: &'a [usize],
    },
    /// A state from which no inputs lead to the goal.
    Way {
        /// The goal.
        goal: usize,
        /// What holds in each cycle of the way.
        using: Option<usize>,
    },
}

impl<'a> Target<'a> {
    /// What must never be seen for a verdict to be true; none if this cannot show it.
    pub fn of(form: &'a Form, verdict: Verdict) -> Option<Self> {
        Some(match (form, verdict) {
            (Form::Always { when, then }, Verdict::Holds) => Target::Broken(*when, *then),
            (
                Form::Unless {
                    when,
                    holds,
                    unless,
                },
                Verdict::Holds,
            ) => Target::Until {
                when: *when,
                holds: *holds,
                unless: *unless,
            },
            (
                Form::LeadsTo {
                    when,
                    goal,
                    within: Some(within),
                    ..
                },
                Verdict::Holds,
            ) => Target::Late {
                when: *when,
                goal: *goal,
                within,
            },
            (
                Form::LeadsTo {
                    when,
                    goal,
                    within: None,
                    fair,
                    assuming,
                },
                Verdict::Holds,
            ) => Target::Forever {
                when: *when,
                goal: *goal,
                assuming: *assuming,
                fair,
            },
            (
                Form::Always {
                    when: Some(when), ..
                }
                | Form::Unless { when, .. }
                | Form::LeadsTo { when, .. },
                Verdict::Vacuous,
            ) => Target::Goal(*when),
            (Form::Reachable { goal }, Verdict::Unreachable) => Target::Goal(*goal),
            (Form::CanAlwaysReach { goal, using }, Verdict::Holds) => Target::Way {
                goal: *goal,
                using: *using,
            },
            _ => return None,
        })
    }
}
