//! Monitors: latches that turn a duty over several cycles into something that must not be seen in one.
//!
//! In a cycle in which a value leaves its range nothing is judged and a monitor stays as it is, as the state does.

use stillpoint_certify::proof::clause::{Clause, Literal};
use stillpoint_model::proof::{Graph, Lit, Netlist, Word};

use super::linear::Linear;

/// The latches of a bounded response: whether a duty is open, and the cycles left to it.
#[derive(Clone)]
pub(super) struct Duty {
    pub pending: Lit,
    pub rest: Word,
    /// The greatest number of cycles left.
    pub most: i64,
    /// What its bound is made of.
    pub about: Linear,
}

impl Duty {
    /// That the cycles left keep to their range, for a certificate.
    pub(super) fn keeps(&self) -> Clause {
        let (sum, most) = (vec!["@rest".to_owned()], Vec::new());
        let shift = self.most;
        Clause(vec![Literal::Most { sum, most, shift }])
    }
}

/// Gives latches their next values, which they keep where a value leaves its range.
fn set(netlist: &mut Netlist, fault: Lit, first: usize, next: &[Lit]) {
    for (latch, next) in netlist.latches[first..].iter_mut().zip(next) {
        latch.next = netlist.graph.choice(fault, latch.lit, *next);
    }
}

/// The next values of a latch that says whether something is counted and of the counter behind it, from 0 to `most`: this count while it
/// is, else 0.
fn keep(netlist: &mut Netlist, fault: Lit, first: usize, counts: Lit, count: &Word, most: i64) {
    let count = count
        .choice(&mut netlist.graph, counts, &Word::constant(0))
        .within(0, most);
    let mut list = vec![counts];
    list.extend((0..Word::needed(0, most)).map(|k| count.bit(k)));
    set(netlist, fault, first, &list);
}

/// A counter from 0 to `most`, 0 at the start; its latches are the last ones.
fn counter(netlist: &mut Netlist, name: &str, most: i64) -> Word {
    let size = Word::needed(0, most);
    let bits = (0..size).map(|k| netlist.latch(format!("{name}.{k}"), Some(false)));
    let word = Word::variable(bits.collect(), 0);
    let keeps = word.keeps(&mut netlist.graph, 0, most);
    if keeps != Lit::TRUE {
        netlist.invariants.push(keeps);
    }
    word
}

fn is_zero(graph: &mut Graph, word: &Word) -> Lit {
    word.equals(graph, &Word::constant(0))
}

/// A weak until: what breaks `holds` before `unless`, from a cycle with `when` on.
pub(super) fn until(
    netlist: &mut Netlist,
    fault: Lit,
    (when, holds, unless): (Lit, Lit, Lit),
) -> Lit {
    let first = netlist.latches.len();
    let pending = netlist.latch("monitor.pending".to_owned(), Some(false));
    let graph = &mut netlist.graph;
    let duty = graph.or(pending, when);
    let open = graph.and(duty, !unless);
    let kept = graph.and(open, holds);
    let broken = graph.all([open, !holds, !fault]);
    set(netlist, fault, first, &[kept]);
    broken
}

/// A bound in cycles, known or over parameters that are part of the state, the greatest value that it can have, and what it is made of.
#[derive(Clone)]
pub(super) struct Cycles {
    pub word: Word,
    pub most: i64,
    pub about: Linear,
}

impl Cycles {
    pub(super) fn constant(cycles: i64) -> Self {
        Cycles {
            word: Word::constant(cycles),
            most: cycles,
            about: Linear::default(),
        }
    }
}

/// A bounded response: what breaks `goal` in one of the cycles k ..= k + within. Of several duties the oldest one counts; the cycles
/// left are counted down.
pub(super) fn within(
    netlist: &mut Netlist,
    fault: Lit,
    (when, goal): (Lit, Lit),
    within: &Cycles,
) -> (Lit, Duty) {
    let first = netlist.latches.len();
    let pending = netlist.latch("monitor.pending".to_owned(), Some(false));
    let most = (within.most - 1).max(0);
    let rest = counter(netlist, "monitor.rest", most);
    let graph = &mut netlist.graph;
    let over = is_zero(graph, &rest);
    // A bound below 1 leaves the cycle of the trigger itself.
    let one = Word::constant(1);
    let at_once = within.word.less(graph, &one);
    let late = graph.and(pending, over);
    let now = graph.and(at_once, when);
    let ends = graph.or(late, now);
    let broken = graph.all([ends, !goal, !fault]);
    let starts = graph.all([!at_once, !pending, when]);
    let stays = graph.and(pending, !over);
    let open = graph.or(starts, stays);
    let next = graph.and(open, !goal);
    let less = rest.minus(graph, &one);
    let whole = within.word.minus(graph, &one);
    let count = less.choice(graph, pending, &whole);
    keep(netlist, fault, first, next, &count, most);
    let duty = Duty {
        pending,
        rest,
        most,
        about: within.about.clone(),
    };
    (broken, duty)
}

/// A response without a bound.
pub(super) struct Forever {
    /// What must be seen for it to say something.
    pub first: Lit,
    pub when: Lit,
    pub goal: Lit,
    /// Holds in each cycle after the first.
    pub assuming: Lit,
    /// Each holds infinitely often.
    pub fair: Vec<Lit>,
}

/// The measure of a response without a bound. A round ends when each fairness condition has been seen in it; it is idle if no number
/// has moved in it as it is to. If what is counted, idle rounds and cycles in which a number moves back, is never more than `rounds`,
/// then no run is without the goal for ever: after the last one a number moves in each round, and none back. The answer is what shows
/// one too many. Of each number: whether it is to rise.
pub(super) fn measured(
    netlist: &mut Netlist,
    fault: Lit,
    response: &Forever,
    rounds: i64,
    numbers: &[(&Word, bool)],
) -> (Lit, Duty) {
    let (mut forth, mut back) = (Lit::FALSE, Lit::FALSE);
    for (number, rises) in numbers {
        let [falls, rise] = netlist.moves(number);
        let (to, from) = if *rises { (rise, falls) } else { (falls, rise) };
        let graph = &mut netlist.graph;
        (forth, back) = (graph.or(forth, to), graph.or(back, from));
    }
    let first = netlist.latches.len();
    let pending = netlist.latch("monitor.pending".to_owned(), Some(false));
    let rest = counter(netlist, "monitor.rest", rounds);
    let latch = |netlist: &mut Netlist, name| netlist.latch(name, Some(false));
    let seen: Vec<Lit> = (0..response.fair.len())
        .map(|k| latch(netlist, format!("monitor.seen.{k}")))
        .collect();
    let moved = latch(netlist, "monitor.moved".to_owned());
    let graph = &mut netlist.graph;
    let lasts = graph.all([pending, response.assuming, !response.goal]);
    let seen: Vec<Lit> = (seen.iter().zip(&response.fair))
        .map(|(before, now)| graph.or(*before, *now))
        .collect();
    let ends = graph.all(seen.iter().copied());
    let moved = graph.or(moved, forth);
    let idle = graph.and(ends, !moved);
    let any = graph.or(idle, back);
    let counts = graph.all([lasts, any, !fault]);
    let over = is_zero(graph, &rest);
    let broken = graph.and(counts, over);
    let starts = graph.and(response.when, !response.goal);
    let open = graph.or(lasts, starts);
    let less = rest.minus(graph, &Word::constant(1));
    let fewer = graph.and(counts, !over);
    let left = less.choice(graph, fewer, &rest);
    let count = left.choice(graph, lasts, &Word::constant(rounds));
    let goes_on = graph.and(lasts, !ends);
    let next: Vec<Lit> = (seen.iter().chain([&moved]))
        .map(|bit| graph.and(goes_on, *bit))
        .collect();
    keep(netlist, fault, first, open, &count, rounds);
    let behind = netlist.latches.len() - next.len();
    set(netlist, fault, behind, &next);
    let duty = Duty {
        pending,
        rest,
        most: rounds,
        about: Linear::default(),
    };
    (broken, duty)
}

/// The fastest response: what shows a cycle with the goal fewer than `cycles`, and one exactly so many after one with `when`, with no
/// goal between. Of several duties the youngest one counts.
pub(super) fn fastest(
    netlist: &mut Netlist,
    fault: Lit,
    (when, goal): (Lit, Lit),
    cycles: i64,
) -> (Lit, Lit) {
    let first = netlist.latches.len();
    let waiting = netlist.latch("monitor.waiting".to_owned(), Some(false));
    // Cycles since the trigger; `most` says that they are more than `cycles`.
    let most = cycles + 1;
    let age = counter(netlist, "monitor.age", most);
    let graph = &mut netlist.graph;
    let limit = Word::constant(cycles);
    let (less, exactly) = (age.less(graph, &limit), age.equals(graph, &limit));
    let at_once = graph.all([when, goal, !fault]);
    let later = graph.all([waiting, goal, !when, !fault]);
    let (sooner, just) = (graph.and(later, less), graph.and(later, exactly));
    let (early, right) = match cycles {
        0 => (Lit::FALSE, at_once),
        _ => (graph.or(at_once, sooner), just),
    };
    let begun = graph.or(waiting, when);
    let next = graph.and(begun, !goal);
    let last = age.equals(graph, &Word::constant(most));
    let older = age.plus(graph, &Word::constant(1));
    let older = age.choice(graph, last, &older);
    let count = Word::constant(1).choice(graph, when, &older);
    keep(netlist, fault, first, next, &count, most);
    (early, right)
}
