//! Responses without a bound: a measure, asked of the engines.
//!
//! Runs that are no run of a measure say what to count in its place: a number that moves one way in them, or one round more.

use std::cmp::Reverse;

use stillpoint_model::proof::{Lit, Netlist, Problem, Rank, Run, Word, value};

use super::decide::Decision;
use super::monitor::{Forever, measured};
use super::question::Asked;
use super::{Judge, Judged, Measured, Proof};

/// How many idle rounds a measure begins with, and the most that it has.
const ROUNDS: i64 = 2;
const MOST: i64 = 16;

impl Judge<'_> {
    /// Whether a measure shows that the goal always comes.
    pub(super) fn forever(&self, asked: &Asked, entry: &mut Judged, response: &Forever) -> bool {
        let (translated, fault) = (&asked.translated, asked.translated.fault);
        let counting = asked.numbers();
        let words: Vec<Word> = counting.iter().map(|k| translated.variable(*k).0).collect();
        let begin = Measured {
            rounds: ROUNDS,
            numbers: Vec::new(),
        };
        let (mut measure, mut without) = (begin.clone(), Vec::new());
        loop {
            let numbers = measure.numbers.iter();
            let numbers: Vec<(&Word, bool)> =
                numbers.map(|r| (&words[r.number], r.rises)).collect();
            let mut netlist = translated.netlist.clone();
            let (broken, duty) = measured(&mut netlist, fault, response, measure.rounds, &numbers);
            let run = match self.ask(&netlist, broken) {
                Decision::Never(proof) => {
                    let known = [&[duty.keeps()][..], &self.known].concat();
                    entry.engine = Some(self.engine(&proof));
                    let mut shown = asked.shown(&netlist, &proof, known);
                    shown.measure = Some(asked.measure(&measure));
                    entry.shown = Some(shown);
                    entry.proof = Some(Proof::Measured(measure, Box::new(proof)));
                    self.first(asked, entry, response.first);
                    return true;
                }
                Decision::Open(why) => {
                    entry.reason = Some(why);
                    return false;
                }
                Decision::Seen(run) => run,
            };
            let known = measure.numbers.iter().map(|rank| rank.number);
            let known: Vec<usize> = known.chain(without.iter().copied()).collect();
            match moves(&netlist, (broken, duty.pending), &run, &words, &known) {
                Some(number) => measure.numbers.push(number),
                None if measure.rounds < MOST => measure.rounds *= 2,
                // Perhaps one of them spoils it: anew without the first.
                None => match measure.numbers.first() {
                    Some(rank) => {
                        without.push(rank.number);
                        measure = begin.clone();
                    }
                    None => break,
                },
            }
        }
        entry.reason = Some("no measure was found that shows it".to_owned());
        false
    }
}

/// The number, of those that are not named, that moves most often one way in the last cycles of a run, while the duty is open.
fn moves(
    netlist: &Netlist,
    (broken, pending): (Lit, Lit),
    run: &Run,
    words: &[Word],
    known: &[usize],
) -> Option<Rank> {
    let mut netlist = netlist.clone();
    let each: Vec<[Lit; 2]> = words.iter().map(|word| netlist.moves(word)).collect();
    let mut seen = vec![[0, 0]; words.len()];
    Problem::new(&netlist, broken).play(run, |values| {
        if !value(values, pending) {
            seen.fill([0, 0]);
        }
        for (seen, lits) in seen.iter_mut().zip(&each) {
            for (seen, lit) in seen.iter_mut().zip(lits) {
                *seen += usize::from(value(values, *lit));
            }
        }
    });
    let mut best = None;
    for (k, ways) in seen.iter().enumerate() {
        for (way, other) in [(0, 1), (1, 0)] {
            if !known.contains(&k) && ways[way] > ways[other] {
                best = best.max(Some((ways[way] - ways[other], Reverse(k), way == 1)));
            }
        }
    }
    best.map(|(_, Reverse(number), rises)| Rank { number, rises })
}
