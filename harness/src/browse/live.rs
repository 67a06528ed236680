//! Properties along a walk: what they say about its cycles.

use std::collections::BTreeSet;

use stillpoint_engine::Cycle;
use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Form, Property};

use super::truth::truth;

/// What a walk shows about a property, from its begin to one of its cycles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Live {
    /// Where the property stands.
    pub standing: Standing,
    /// The first cycle that breaks it, from 1.
    pub broken: Option<usize>,
    /// Its statements as written and what they say in the last cycle; an input on which one depends is named by number.
    pub says: Vec<Said>,
}

/// A statement of a property: the key under which it stands, its text, its value in the last cycle. The value is missing
/// before the first cycle.
pub type Said = (String, String, Option<Result<bool, BTreeSet<u32>>>);

/// Where a property stands after a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// No cycle was made yet.
    Begin,
    /// Nothing is asked: no condition holds, no duty is pending.
    Idle,
    /// The last cycle meets what is asked.
    Met,
    /// The last cycle breaks it.
    Broken,
    /// A duty is pending.
    Pending {
        /// The cycle in which it began, from 1.
        since: usize,
        /// Cycles that are left, where they are bounded.
        left: Option<usize>,
    },
    /// What is looked for has not been seen yet.
    Unseen,
    /// What is looked for was seen first in this cycle, from 1.
    Seen(usize),
    /// It depends on inputs that a cycle did not read.
    Open,
    /// It speaks of all runs or of pairs of runs; one walk says nothing about it.
    NotOne,
}

/// A condition of one cycle: TRUE, FALSE, or open.
type Truth = Option<bool>;

/// All properties after these cycles.
pub fn live(bound: &Bound, cycles: &[Cycle]) -> Vec<Live> {
    let all = bound.system.properties.iter();
    all.map(|property| one(bound, property, cycles)).collect()
}

fn one(bound: &Bound, property: &Property, cycles: &[Cycle]) -> Live {
    let ask = |cycle: &Cycle, atom: usize| truth(bound, &cycle.frame, &cycle.choices, atom);
    let is = |cycle: &Cycle, atom: usize| -> Truth { ask(cycle, atom).ok() };
    let mut broken = None;
    let mut standing = Standing::Begin;
    for (before, cycle) in cycles.iter().enumerate() {
        let now = before + 1;
        standing = match &property.form {
            Form::Always { when, then } => {
                let asked = when.map_or(Some(true), |when| is(cycle, when));
                match (asked, is(cycle, *then)) {
                    (Some(false), _) => Standing::Idle,
                    (_, Some(true)) => Standing::Met,
                    (Some(true), Some(false)) => Standing::Broken,
                    _ => Standing::Open,
                }
            }
            Form::LeadsTo {
                when,
                goal,
                within,
                assuming,
                ..
            } => {
                let within = within.as_ref().map(|n| bound.constant(n));
                let duty = Duty {
                    since: pending(standing),
                    open: standing == Standing::Open,
                    within: within.map(|n| usize::try_from(n).unwrap_or(0)),
                };
                // Runs on which the assumption fails after the trigger do not count.
                let counts = assuming.is_none_or(|a| is(cycle, a) != Some(false));
                duty.response(now, is(cycle, *when), is(cycle, *goal), counts)
            }
            Form::Unless {
                when,
                holds,
                unless,
            } => {
                let since = pending(standing);
                let open = standing == Standing::Open;
                let asked = is(cycle, *when);
                match (since, asked, is(cycle, *unless), is(cycle, *holds)) {
                    (None, Some(false), ..) if !open => Standing::Idle,
                    (_, _, Some(true), _) => Standing::Met,
                    (None, None, ..) => Standing::Open,
                    (None, Some(false), ..) => Standing::Open,
                    (_, _, Some(false), Some(false)) => Standing::Broken,
                    (_, _, Some(false), Some(true)) => Standing::Pending {
                        since: since.unwrap_or(now),
                        left: None,
                    },
                    _ => Standing::Open,
                }
            }
            Form::Reachable { goal } => match (standing, is(cycle, *goal)) {
                (Standing::Seen(first), _) => Standing::Seen(first),
                (_, Some(true)) => Standing::Seen(now),
                (_, None) => Standing::Open,
                (_, Some(false)) => Standing::Unseen,
            },
            Form::CanAlwaysReach { .. } | Form::Independent { .. } => Standing::NotOne,
        };
        if standing == Standing::Broken {
            broken = broken.or(Some(now));
        }
    }
    let says = atoms(property)
        .into_iter()
        .map(|(key, text, atom, negated)| {
            let value = cycles.last().map(|cycle| ask(cycle, atom));
            (key, text, value.map(|v| v.map(|v| v != negated)))
        })
        .collect();
    Live {
        standing,
        broken,
        says,
    }
}

fn pending(standing: Standing) -> Option<usize> {
    match standing {
        Standing::Pending { since, .. } => Some(since),
        _ => None,
    }
}

/// The duty of a response before a cycle.
struct Duty {
    since: Option<usize>,
    /// Whether a duty may be pending, for all that is known.
    open: bool,
    within: Option<usize>,
}

impl Duty {
    fn response(self, now: usize, when: Truth, goal: Truth, counts: bool) -> Standing {
        let idle = self.since.is_none() && !self.open;
        if goal == Some(true) {
            return match (idle, when) {
                (true, Some(false)) => Standing::Idle,
                _ => Standing::Met,
            };
        }
        let since = match self.since {
            // The assumption speaks of the cycles after the trigger, so a new trigger in this cycle stands.
            Some(_) if !counts => None,
            since => since,
        };
        let since = match (since, when) {
            (Some(since), _) => since,
            (None, Some(true)) => now,
            (None, Some(false)) if !self.open || !counts => return Standing::Idle,
            (None, _) => return Standing::Open,
        };
        if goal.is_none() {
            return Standing::Open;
        }
        match self.within {
            None => Standing::Pending { since, left: None },
            Some(within) if now - since >= within => Standing::Broken,
            Some(within) => Standing::Pending {
                since,
                left: Some(within - (now - since)),
            },
        }
    }
}

/// The statements of a property: key, text, atom, and whether the atom says the opposite of the text.
fn atoms(property: &Property) -> Vec<(String, String, usize, bool)> {
    let mut listed: Vec<(&str, usize, bool)> = Vec::new();
    match &property.form {
        Form::Always { when, then } => {
            listed.extend(when.map(|when| ("when", when, false)));
            let never = property.written.iter().any(|(key, _)| key == "never");
            let key = match (never, when) {
                (true, _) => "never",
                (false, None) => "always",
                (false, Some(_)) => "then",
            };
            listed.push((key, *then, never));
        }
        Form::LeadsTo {
            when,
            goal,
            fair,
            assuming,
            ..
        } => {
            listed.push(("when", *when, false));
            listed.push(("leads_to", *goal, false));
            listed.extend(fair.iter().map(|atom| ("fair", *atom, false)));
            listed.extend(assuming.map(|atom| ("assuming", atom, false)));
        }
        Form::Unless {
            when,
            holds,
            unless,
        } => listed.extend([
            ("when", *when, false),
            ("holds", *holds, false),
            ("unless", *unless, false),
        ]),
        Form::CanAlwaysReach { goal, using } => {
            listed.push(("can_always_reach", *goal, false));
            listed.extend(using.map(|atom| ("using", atom, false)));
        }
        Form::Reachable { goal } => listed.push(("reachable", *goal, false)),
        Form::Independent { condition, .. } => {
            listed.extend(condition.map(|atom| ("while", atom, false)));
        }
    }
    // Several statements under one key stand in the order in which they are written.
    let mut taken: Vec<&str> = Vec::new();
    let mut out = Vec::new();
    for (key, atom, negated) in listed {
        let nth = taken.iter().filter(|k| **k == key).count();
        taken.push(key);
        let mut texts = property.written.iter().filter(|(k, _)| k == key);
        let text = texts.nth(nth).map(|(_, t)| t.clone()).unwrap_or_default();
        out.push((key.to_owned(), text, atom, negated));
    }
    out
}
