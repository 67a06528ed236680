//! What runs show: they are replayed by the interpreter.

use stillpoint_lang::bind::Bound;
use stillpoint_lang::ir::{Form, Node};

use crate::cycle::Player;

/// The bound of a response.
pub(crate) fn cycles(bound: &Bound, node: &Node) -> u32 {
    u32::try_from(bound.constant(node).max(0)).unwrap_or(u32::MAX)
}

/// A run in whose last cycle `shown` is true; it is called in each cycle.
///
/// # Errors
/// The run is none, or does not show it.
pub(crate) fn ends(
    mut player: Player,
    mut shown: impl FnMut(&mut Player) -> bool,
) -> Result<(), String> {
    let mut is = false;
    while player.step()?.is_some() {
        is = shown(&mut player);
    }
    is.then_some(())
        .ok_or_else(|| "its run does not end in the cycle that is claimed".to_owned())
}

/// A run that violates a property of single cycles, a duty until something comes, or a response: with a loop from step `repeats` on, if
/// it has no bound.
///
/// # Errors
/// The run is none, or does not show it.
pub(crate) fn violates(
    bound: &Bound,
    form: &Form,
    player: Player,
    repeats: Option<usize>,
) -> Result<(), String> {
    match form {
        Form::Always { when, then } => {
            ends(player, |p| when.is_none_or(|w| p.atom(w)) && !p.atom(*then))
        }
        Form::Unless {
            when,
            holds,
            unless,
        } => {
            let mut duty = false;
            ends(player, |p| {
                duty = (duty || p.atom(*when)) && !p.atom(*unless);
                duty && !p.atom(*holds)
            })
        }
        Form::LeadsTo {
            when,
            goal,
            within,
            fair,
            assuming,
        } => {
            let response = Response {
                when: *when,
                goal: *goal,
                within: within.as_ref().map(|n| cycles(bound, n)),
                fair,
                assuming: *assuming,
            };
            response.late(player, repeats)
        }
        _ => Err("one run does not violate such a property".to_owned()),
    }
}

struct Response<'a> {
    when: usize,
    goal: usize,
    within: Option<u32>,
    fair: &'a [usize],
    assuming: Option<usize>,
}

impl Response<'_> {
    /// A run on which the goal does not come in time, or a loop on which it never comes.
    fn late(&self, mut player: Player, repeats: Option<usize>) -> Result<(), String> {
        // Cycles since the oldest `when` that waits for the goal.
        let mut waiting: Option<u32> = None;
        // The state in which the loop starts, as long as the same `when` waits in all of it.
        let mut entry = None;
        let mut met = vec![false; self.fair.len()];
        for number in 0.. {
            if repeats == Some(number) {
                entry = waiting.map(|_| player.state.clone());
            }
            if player.step()?.is_none() {
                break;
            }
            let goal = player.atom(self.goal);
            let lasts = !goal && self.assuming.is_none_or(|a| player.atom(a));
            waiting = match waiting {
                Some(n) if lasts => Some(n.saturating_add(1)),
                _ => {
                    entry = None;
                    (!goal && player.atom(self.when)).then_some(0)
                }
            };
            for (met, condition) in met.iter_mut().zip(self.fair) {
                *met |= entry.is_some() && player.atom(*condition);
            }
        }
        let late = match self.within {
            Some(within) => waiting.is_some_and(|n| n >= within),
            None => {
                entry.is_some_and(|entry| entry == player.state)
                    && repeats.is_some_and(|start| start < player.steps())
                    && met.iter().all(|m| *m)
            }
        };
        late.then_some(())
            .ok_or_else(|| "its run does not miss the goal".to_owned())
    }
}

/// The place of the assignment that leaves its range at the end of a run, by its number; none if none does.
///
/// # Errors
/// The run is none.
pub(crate) fn fault(mut player: Player) -> Result<Option<u32>, String> {
    let mut end = None;
    while let Some(made) = player.attempt()? {
        end = made.err();
        if end.is_some() {
            break;
        }
    }
    Ok(end)
}
