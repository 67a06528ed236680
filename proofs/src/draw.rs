//! Steps drawn from what the types of a monitor say of themselves: no monitor is named here.
//!
//! Whatever the engine, a step is drawn number by number; it counts only where the constructor accepts the configuration and
//! the state is consistent. So nothing that can happen is missed by a draw, but for the values of wide numbers that an
//! engine does not try: Kani takes every one, the enumeration those of [`Tries`], sampling any of the whole width.

use stillpoint_monitors::contract::Contract;
use stillpoint_monitors::fields::{Fields, Kind, Visitor};

use crate::source::Source;

/// A step before it is made: state, configuration, inputs.
pub type Case<M> = (
    <M as Contract>::State,
    <M as Contract>::Config,
    <M as Contract>::Inputs,
);

/// Draws each number that it is shown, from all values of its kind.
struct Any<'a, S>(&'a mut S);

impl<S: Source> Visitor for Any<'_, S> {
    fn number(&mut self, _: &'static str, kind: Kind, _: i64) -> i64 {
        match kind {
            Kind::Truth => i64::from(self.0.any_bool()),
            Kind::Choice(variants) => self.0.any_choice(variants),
            Kind::Whole(low, high) => self.0.any_whole(low, high),
        }
    }
}

/// Any value of a type.
pub fn any<T: Fields, S: Source>(source: &mut S) -> T {
    let mut value = T::ANY;
    value.visit("", &mut Any(source));
    value
}

/// Any step of a monitor; none where the numbers drawn make none.
pub fn step<M: Contract, S: Source>(source: &mut S) -> Option<Case<M>> {
    let config = any(source);
    if !M::accepted(&config) {
        return None;
    }
    let state = any(source);
    if !M::invariant(&state, &config) {
        return None;
    }
    Some((state, config, any(source)))
}
