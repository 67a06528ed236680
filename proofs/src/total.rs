//! Freedom from panics: a call ends, whatever its numbers are.
//!
//! Nothing is said of what a call gives, only that every operation in it has a result: no sum, difference or product leaves its
//! type, no divisor is 0, no index is beyond its list, nothing panics. Kani asserts that of itself, and is given any state,
//! also an inconsistent one, so that the answer leans on no invariant. The other engines take consistent states, since a debug
//! build asserts the contract, and find a panic where one happens.

use std::panic::{AssertUnwindSafe, catch_unwind};

use stillpoint_monitors::contract::{Contract, Next};
use stillpoint_monitors::fields::{Fields, Kind, Visitor};

use crate::draw::{self, Case};
use crate::enumeration::{Count, Domain, enumerate};
use crate::source::{Source, Verdict};

/// The situations that must be met.
pub const COVERS: &[&str] = &["a call in the initial state", "a call in another one"];

/// What the enumeration tries, in words.
pub const DOMAIN: &str = "the initial state; parameters all at their least, all at 0 or all at their greatest, so the inputs; of all \
                          numbers of the step up to two others at the least, 0, 1 or the greatest";

/// Sets each number of a step: two of them apart from all others.
struct Ends {
    place: usize,
    apart: [(usize, u32); 2],
    // What all the others become; they stay where there is nothing.
    others: Option<u32>,
}

/// The value of a kind that a digit stands for: the least, the one nearest to 0, to 1, the greatest.
fn value(kind: Kind, digit: u32) -> i64 {
    let (low, high) = kind.ends();
    match digit {
        0 => low,
        1 => low.max(0),
        2 => low.max(1).min(high),
        _ => high,
    }
}

impl Visitor for Ends {
    fn number(&mut self, _: &'static str, kind: Kind, number: i64) -> i64 {
        let place = self.place;
        self.place += 1;
        let apart = self.apart.iter().find(|(own, _)| *own == place);
        match apart.map(|(_, digit)| *digit).or(self.others) {
            Some(digit) => value(kind, digit),
            None => number,
        }
    }
}

/// How many numbers a type has.
fn count<T: Fields>() -> u32 {
    let mut count = 0;
    stillpoint_monitors::fields::get(T::ANY, |_| count += 1);
    count
}

/// A step of the domain of the enumeration.
pub fn ends<M: Contract>(source: &mut impl Source) -> Option<Case<M>> {
    let numbers = count::<M::State>() + count::<M::Config>() + count::<M::Inputs>();
    // A type without a number has nothing to set: its place stands for none.
    let first = source.any_in(0, numbers);
    let second = source.any_in(first, numbers);
    let digit = |place: u32, source: &mut _| {
        if place == numbers {
            0
        } else {
            Source::any_in(source, 0, 3)
        }
    };
    let apart = [
        (first as usize, digit(first, source)),
        (
            second as usize,
            if second == first {
                0
            } else {
                digit(second, source)
            },
        ),
    ];
    let base = source.any_in(0, 2);
    let mut visitor = Ends {
        place: 0,
        apart,
        others: None,
    };
    let (mut state, mut config, mut inputs) = (M::INITIAL, M::Config::ANY, M::Inputs::ANY);
    state.visit("", &mut visitor);
    visitor.others = Some([0, 1, 3][base as usize]);
    config.visit("", &mut visitor);
    inputs.visit("", &mut visitor);
    (M::accepted(&config) && M::invariant(&state, &config)).then_some((state, config, inputs))
}

/// Any step, from the initial state where the numbers drawn make no consistent one.
fn anything<M: Contract>(source: &mut impl Source) -> Option<Case<M>> {
    let config = draw::any(source);
    if !M::accepted(&config) {
        return None;
    }
    let state = draw::any(source);
    let state = if M::invariant(&state, &config) {
        state
    } else {
        M::INITIAL
    };
    Some((state, config, draw::any(source)))
}

/// Makes a step and says whether it has ended.
fn ended<M: Contract>(source: &mut impl Source, case: Option<Case<M>>, next: Next<M>) -> Verdict {
    let Some((state, config, inputs)) = case else {
        return Verdict::Discarded;
    };
    let initial = state == M::INITIAL;
    source.cover(0, initial);
    source.cover(1, !initial || count::<M::State>() == 0);
    match catch_unwind(AssertUnwindSafe(|| next(state, &config, &inputs))) {
        Ok(_) => Verdict::Held,
        Err(_) => Verdict::Broken("no_call_panics"),
    }
}

/// Tries every step of the domain.
pub fn enumerated<M: Contract>(domain: Domain, next: Next<M>) -> Count {
    enumerate(domain, COVERS.len(), |source| {
        let case = ends::<M>(source);
        ended::<M>(source, case, next)
    })
}

/// Tries one random step.
pub fn sampled<M: Contract>(source: &mut impl Source, next: Next<M>) -> Verdict {
    let case = anything::<M>(source);
    ended::<M>(source, case, next)
}

/// One call from any state, under any parameters that the constructor accepts, with any inputs.
#[cfg(kani)]
pub fn called<M: Contract>(source: &mut impl Source) {
    let (state, config, inputs) = (
        draw::any::<M::State, _>(source),
        draw::any::<M::Config, _>(source),
        draw::any::<M::Inputs, _>(source),
    );
    kani::assume(M::accepted(&config));
    let initial = state == M::INITIAL;
    let result = M::next(state, &config, &inputs);
    // What is not read need not be calculated.
    std::hint::black_box(result);
    // Kani wants the names of `COVERS` in their places.
    kani::cover!(initial, "a call in the initial state");
    kani::cover!(
        !initial || count::<M::State>() == 0,
        "a call in another one"
    );
}
