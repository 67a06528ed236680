//! Recoverability where most states are saved, and some are not: more states than one sweep begins with, more properties than are judged
//! together.

use crate::common::padding;
use stillpoint_model::{
    Choices, Domain, Fault, Form, Limits, Options, Property, System, Verdict, explore,
};

const SIZE: i32 = 20_000;

/// A place on a line. A cycle goes one place on, or back to half of the way, which is not possible from `trap` on, or the same by switching
/// off, which always is.
struct Line {
    domains: Vec<Domain>,
    trap: i32,
}

/// It is at the start; it was not switched off.
const START: usize = 0;
const STAYS_ON: usize = 1;

impl System for Line {
    type Work = (i32, u32);
    fn work(&self) -> (i32, u32) {
        (0, 0)
    }
    fn domains(&self) -> &[Domain] {
        &self.domains
    }
    fn combinations(&self) -> u128 {
        3
    }
    fn initial<C: Choices>(&self, _: &mut (i32, u32), _: &mut C, state: &mut [i32]) {
        state.fill(5);
        state[0] = 0;
    }
    fn next<C: Choices>(
        &self,
        work: &mut (i32, u32),
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        let choice = choices.choose(0, 3);
        let place = match choice {
            0 => (before[0] + 1).min(SIZE - 1),
            1 if before[0] >= self.trap => before[0],
            _ => before[0] / 2,
        };
        after.fill(5);
        after[0] = place;
        *work = (place, choice);
        Ok(())
    }
    fn atom<C: Choices>(
        &self,
        work: &mut (i32, u32),
        atom: usize,
        _: &mut C,
    ) -> Result<bool, Fault> {
        Ok(match atom {
            START => work.0 == 0,
            _ => work.1 != 2,
        })
    }
}

#[test]
fn what_is_saved_and_what_is_lost() {
    // More than are judged together, by turns with and without switching off.
    let stays_on = |n: usize| n % 2 == 1;
    let properties: Vec<Property> = (0..19)
        .map(|n| Property {
            id: n.to_string(),
            form: Form::CanAlwaysReach {
                goal: START,
                using: stays_on(n).then_some(STAYS_ON),
            },
        })
        .collect();
    for (padded, threads, trap) in [
        (0, 1, 15_000),
        (0, 2, 5_000),
        (1, 2, 15_000),
        (1, 5, 3),
        (3, 2, 15_000),
        (0, 2, SIZE),
        (1, 2, SIZE),
    ] {
        let place = Domain {
            lo: 0,
            hi: SIZE - 1,
        };
        let system = Line {
            domains: [place].into_iter().chain(padding(padded)).collect(),
            trap,
        };
        let options = Options {
            limits: Limits {
                threads,
                ..Limits::default()
            },
            ..Options::default()
        };
        let report = explore(&system, &properties, &options, &mut ()).unwrap();
        assert_eq!((report.states, report.complete), (SIZE as u64, true));
        for (n, judgement) in report.properties.iter().enumerate() {
            // The first lost place is reached after as many cycles as it has places before it.
            let expected = match stays_on(n) && trap < SIZE {
                true => (Verdict::Violated, Some(trap as u64)),
                false => (Verdict::Holds, judgement.length),
            };
            let found = (judgement.verdict, judgement.length);
            assert_eq!(found, expected, "{padded} {threads} {trap} {n}");
        }
    }
}
