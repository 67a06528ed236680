//! What the search has to be told about the cycles of a state, as conditions.

use super::{Condition, MOST_CONDITIONS};
use crate::property::{Form, Property};

/// What a condition that holds in a cycle means to a property: the fields of [`crate::property::Sign`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Event {
    First,
    Bad,
    Pending,
    Met,
}

/// Conditions, and what each of them means to which property.
#[derive(Default)]
pub(crate) struct Watched {
    pub(crate) conditions: Vec<Condition>,
    /// Of the first ones; the others are told for later.
    pub(crate) events: Vec<(usize, Event)>,
    /// The bits of those that make a duty pending, and of the other ones of events.
    pub(crate) pending: u128,
    pub(crate) shown: u128,
}

/// What has to be told of each cycle of a response with this goal, under this assumption: that it waits on, and that it ends.
pub(crate) fn waits(goal: usize, assuming: Option<usize>) -> [Condition; 2] {
    let given = || assuming.iter().map(|atom| (*atom, true));
    [false, true].map(|value| given().chain([(goal, value)]).collect())
}

impl Watched {
    /// Those of the open properties. Of a property whose `first` or `met` (`shown`) is known these are told no more: they show in
    /// a level that is over. None if they are too many.
    pub(crate) fn new(
        properties: &[Property],
        open: &[usize],
        shown: impl Fn(usize) -> (bool, bool),
    ) -> Option<Self> {
        let mut all = Watched::default();
        for property in open.iter().copied() {
            let (first, met) = shown(property);
            for (event, condition) in events(&properties[property].form) {
                let known = match event {
                    Event::First => first,
                    Event::Met => met,
                    Event::Bad | Event::Pending => false,
                };
                if known {
                    continue;
                }
                let bit = 1u128.checked_shl(all.events.len() as u32)?;
                match event {
                    Event::Pending => all.pending |= bit,
                    _ => all.shown |= bit,
                }
                all.events.push((property, event));
                all.conditions.push(condition);
            }
        }
        // What the verdicts on bounded responses ask about, so that they need not learn the stages anew. An assumption is asked about
        // nowhere else: what it reads would have to be kept.
        let bounded = open.iter().filter_map(|p| match properties[*p].form {
            Form::LeadsTo {
                goal,
                assuming: None,
                within: Some(_),
                ..
            } => Some(waits(goal, None)),
            _ => None,
        });
        let mut more: Vec<Condition> = bounded.flatten().collect();
        more.sort_unstable();
        more.dedup();
        if all.events.len() + more.len() <= MOST_CONDITIONS {
            all.conditions.extend(more);
        }
        (all.events.len() <= MOST_CONDITIONS).then_some(all)
    }
}

/// What [`crate::property::Eval::sign`] tells, as conditions.
fn events(form: &Form) -> Vec<(Event, Condition)> {
    let given = |atom: &Option<usize>| -> Condition { atom.iter().map(|a| (*a, true)).collect() };
    let and = |condition: &Condition, more: &[(usize, bool)]| {
        let mut condition = condition.clone();
        condition.extend(more);
        condition
    };
    match form {
        Form::Always { when, then } => {
            let when = given(when);
            let bad = and(&when, &[(*then, false)]);
            vec![(Event::First, when), (Event::Bad, bad)]
        }
        Form::LeadsTo { when, goal, .. } => {
            let when = vec![(*when, true)];
            let met = and(&when, &[(*goal, true)]);
            let pending = and(&when, &[(*goal, false)]);
            vec![
                (Event::First, when),
                (Event::Met, met),
                (Event::Pending, pending),
            ]
        }
        Form::Unless {
            when,
            holds,
            unless,
        } => {
            let when = vec![(*when, true)];
            let bad = and(&when, &[(*unless, false), (*holds, false)]);
            let pending = and(&when, &[(*unless, false), (*holds, true)]);
            vec![
                (Event::First, when),
                (Event::Bad, bad),
                (Event::Pending, pending),
            ]
        }
        Form::CanAlwaysReach { goal, using } => {
            vec![(Event::First, and(&given(using), &[(*goal, true)]))]
        }
        Form::Reachable { goal } => vec![(Event::First, vec![(*goal, true)])],
    }
}
