//! Recoverability (`AG EF goal`): from every reachable state some inputs lead to a cycle with the goal.
//!
//! The proof is a ranking function in pieces: a list of regions, cubes of states, with inputs for each. With these inputs a cycle from a
//! region shows the goal, or ends in an earlier region, or stays in it while a number falls (or rises: it is bounded). Every state of an
//! inductive invariant is in a region. So from each reachable state the inputs of the regions lead to the goal, however long a timer
//! is, and whatever parameters are part of the state.
//!
//! Regions are found from states that are in none yet: the inputs of a short run from there into the regions, and then all states that
//! these inputs lead there alike. Where no short run does, inputs under which some number falls and nothing else changes. What this does
//! not help waits until there are more regions.

mod check;
mod search;

use super::graph::Lit;
use super::invariant::Invariant;
use super::netlist::{Netlist, Problem};
use super::pdr::{Reachability, attempt};
use super::sat::{Budget, Spent};
use super::word::Word;
use search::Search;

/// States that are looked at for the sake of one before it is asked whether it is reached at all.
const FEW: usize = 20;

/// Obligations of the question whether it is reached: a state that is, but late, would take many.
const ATTEMPT: usize = 1000;

/// A proof of more regions is none that anybody wants to read.
const REGIONS: usize = 2000;

/// Values of bits, by the place of a latch or an input in the netlist.
pub type Values = Vec<(usize, bool)>;

/// A region and the way out of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// The states with these latches.
    pub region: Values,
    /// The inputs.
    pub inputs: Values,
    /// What falls as long as the region is not left.
    pub rank: Option<Rank>,
}

/// A number that falls with each cycle, or rises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rank {
    /// Its place in the list of numbers.
    pub number: usize,
    /// It rises.
    pub rises: bool,
}

/// Ways to the goal from all reachable states.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ways {
    /// What holds in every reachable state, beside the invariants of the netlist.
    pub invariant: Invariant,
    /// The regions, each of the states that are in none before.
    pub steps: Vec<Step>,
}

/// What a proof is looked for.
pub struct Recovery<'a> {
    /// The system.
    pub netlist: &'a Netlist,
    /// What must stay possible, over the state and the inputs of a cycle.
    pub goal: Lit,
    /// What must hold in each cycle on the way, the last one with the goal included.
    pub using: Lit,
    /// Numbers over the latches that may fall or rise.
    pub numbers: &'a [Word],
    /// Latches that may change while one of them does, by their places in the netlist.
    pub timers: &'a [usize],
}

/// Ways to the goal from all reachable states; none if they are not found, which says nothing.
///
/// # Errors
/// The budget is spent.
pub fn ways(recovery: &Recovery, budget: &Budget) -> Result<Option<Ways>, Spent> {
    let mut netlist = recovery.netlist.clone();
    let end = netlist.graph.and(recovery.goal, recovery.using);
    if end == Lit::FALSE {
        return Ok(None);
    }
    let problem = Problem::new(&netlist, end);
    let mut search = Search::new(&problem, recovery, budget);
    // A state from which no way is found soon is put off, with all that differ from it in numbers only: regions found for the sake of others
    // may lead on from it. Only when there are no others, more is done about one.
    let mut hard = false;
    loop {
        let (mut off, mut found) = (Vec::new(), false);
        while let Some(state) = search.uncovered(&off)? {
            if search.ways.steps.len() > REGIONS {
                return Ok(None);
            }
            // A state that is not reached needs no way. Whatever its numbers are, that is told soonest.
            let done = match hard {
                false => {
                    search.within(&state, Some(FEW))?
                        || excluded(&netlist, &mut search, (&state, false), budget)?
                }
                true => {
                    search.within(&state, None)?
                        || excluded(&netlist, &mut search, (&state, true), budget)?
                        || search.far(&state)?
                }
            };
            match done {
                true => found = true,
                false => off.push(search.others(&state)),
            }
            if done && hard {
                break;
            }
        }
        match found {
            true => hard = false,
            false if off.is_empty() => return Ok(Some(search.ways)),
            false if hard => return Ok(None),
            false => hard = true,
        }
    }
}

/// Whether a state, with its numbers or with any, is not reached; then the invariant excludes it.
fn excluded(
    netlist: &Netlist,
    search: &mut Search,
    (state, numbers): (&[bool], bool),
    budget: &Budget,
) -> Result<bool, Spent> {
    let mut netlist = netlist.clone();
    let known = &search.ways.invariant;
    let clauses = known.over(&mut netlist.graph, |k| netlist.latches[k].lit);
    netlist.invariants.extend(clauses);
    let cube = search.cube(state, numbers);
    let here = cube.iter();
    let here = here.map(|(k, value)| netlist.latches[*k].lit.flipped(!value));
    let bad = netlist.graph.all(here.collect::<Vec<_>>());
    let Some(Reachability::Proved(invariant)) =
        attempt(&Problem::new(&netlist, bad), ATTEMPT, budget)?
    else {
        return Ok(false);
    };
    // Where no inputs are possible the invariant need not exclude it.
    let excludes = search.excludes(&invariant, state);
    if excludes {
        search.learn(invariant);
    }
    Ok(excludes)
}

#[cfg(test)]
mod tests {
    use super::super::graph::value;
    use super::*;

    /// A stop that ends when its timer has run down and a reset comes. The timer begins with a limit, which has any value and never
    /// changes. A machine that is locked stays so.
    struct Stop {
        netlist: Netlist,
        free: Lit,
        numbers: Vec<Word>,
        timers: Vec<usize>,
    }

    const BITS: usize = 12;

    fn stop(lockable: bool) -> Stop {
        let mut netlist = Netlist::default();
        let stopped = netlist.latch("stopped".to_owned(), Some(false));
        let locked = netlist.latch("locked".to_owned(), Some(false));
        let word = |netlist: &mut Netlist, name: &str, init| -> Vec<Lit> {
            (0..BITS)
                .map(|k| netlist.latch(format!("{name}.{k}"), init))
                .collect()
        };
        let timer = word(&mut netlist, "timer", Some(false));
        let limit = word(&mut netlist, "limit", None);
        let inputs = ["stop", "reset", "lock"].map(|name| netlist.input(name.to_owned()));
        let [stop, reset, lock] = inputs;
        let graph = &mut netlist.graph;
        let number = |bits: &[Lit]| Word::variable(bits.to_vec(), 0);
        let zero = number(&timer).equals(graph, &Word::constant(0));
        let less = number(&timer).minus(graph, &Word::constant(1));
        let ends = graph.all([reset, zero, !locked]);
        let begins = graph.and(stop, !stopped);
        let stays = graph.and(stopped, !ends);
        let next = graph.or(begins, stays);
        let locks = match lockable {
            true => graph.and(lock, stopped),
            false => Lit::FALSE,
        };
        let locks = graph.or(locks, locked);
        let timers: Vec<Lit> = (0..BITS)
            .map(|k| {
                let run = graph.choice(zero, Lit::FALSE, less.bit(k));
                graph.choice(begins, limit[k], run)
            })
            .collect();
        let mut places = netlist.latches.iter_mut();
        places.next().expect("stopped").next = next;
        places.next().expect("locked").next = locks;
        places
            .zip(timers)
            .for_each(|(latch, next)| latch.next = next);
        Stop {
            free: !stopped,
            numbers: vec![Word::variable(timer, 0)],
            timers: (2..2 + 2 * BITS).collect(),
            netlist,
        }
    }

    fn recovery(stop: &Stop) -> Recovery<'_> {
        Recovery {
            netlist: &stop.netlist,
            goal: stop.free,
            using: Lit::TRUE,
            numbers: &stop.numbers,
            timers: &stop.timers,
        }
    }

    fn ways_of(stop: &Stop) -> Option<Ways> {
        ways(&recovery(stop), &Budget::default()).expect("no limit")
    }

    /// Whatever the limit is: 4096 configurations, none of them looked at by itself.
    #[test]
    fn a_timer_of_any_length_runs_down() {
        let ways = ways_of(&stop(false)).expect("there is a way");
        assert!(ways.steps.iter().any(|step| step.rank.is_some()));
        assert!(ways.steps.len() < 12, "{}", ways.steps.len());
        // Other code agrees; a region less, and a state is left out or not led anywhere.
        let stop = stop(false);
        let check = |ways: &Ways| ways.check(&recovery(&stop), &Budget::default());
        assert_eq!(check(&ways), Ok(true));
        let (mut needed, mut falling) = (0, 0);
        for k in 0..ways.steps.len() {
            let mut less = ways.clone();
            less.steps.remove(k);
            needed += usize::from(check(&less) == Ok(false));
            let mut still = ways.clone();
            if still.steps[k].rank.take().is_some() {
                falling += usize::from(check(&still) == Ok(false));
            }
        }
        assert!(needed > 1 && falling > 0, "{needed} {falling}");
        let mut unknown = ways.clone();
        unknown.invariant.clauses.clear();
        assert_eq!(check(&unknown), Ok(false));
        // What is locked is never reached, and has no way.
        assert!(!ways.invariant.clauses.is_empty());
    }

    #[test]
    fn a_state_that_nothing_leaves_has_no_way() {
        assert_eq!(ways_of(&stop(true)), None);
    }

    /// Every state of the invariant is led to the goal by its region, one after the other.
    #[test]
    fn the_ways_lead_to_the_goal() {
        let stop = stop(false);
        let ways = ways_of(&stop).expect("there is a way");
        let netlist = &stop.netlist;
        for limit in [0, 1, 2, 77, 4095] {
            for timer in [0, 1, limit / 2, limit] {
                let bit = |k: usize, number: usize| number >> (k % BITS) & 1 == 1;
                let mut state = vec![true, false];
                state.extend((0..BITS).map(|k| bit(k, timer)));
                state.extend((0..BITS).map(|k| bit(k, limit)));
                let mut cycles = 0;
                while state[0] {
                    let inside = |step: &&Step| step.region.iter().all(|(k, v)| state[*k] == *v);
                    let step = ways.steps.iter().find(inside).expect("a region");
                    let mut leaves = vec![false; netlist.graph.size()];
                    for (latch, value) in netlist.latches.iter().zip(&state) {
                        leaves[latch.lit.node()] = *value;
                    }
                    for (k, value) in &step.inputs {
                        leaves[netlist.inputs[*k].lit.node()] = *value;
                    }
                    let values = netlist.graph.values(|node| leaves[node]);
                    let next = netlist.latches.iter();
                    state = next.map(|latch| value(&values, latch.next)).collect();
                    cycles += 1;
                    assert!(cycles <= timer + 2, "{limit} {timer}");
                }
            }
        }
    }
}
