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

/// The numbers of which Kani takes only some: name, the least and the greatest. What it leaves out so stands in the inventory.
pub type Few = &'static [(&'static str, i64, i64)];

/// Draws each number that it is shown, from all values of its kind, or from few.
struct Any<'a, S> {
    source: &'a mut S,
    few: Few,
    // Numbers of a list have the name of the list: what there are few of is looked up once for all of them.
    of_list: Option<(i64, i64)>,
}

impl<S: Source> Visitor for Any<'_, S> {
    fn open(&mut self, name: &'static str) {
        self.of_list = named(self.few, name);
    }

    fn close(&mut self) {
        self.of_list = None;
    }

    fn number(&mut self, name: &'static str, kind: Kind, _: i64) -> i64 {
        match kind {
            Kind::Truth => i64::from(self.source.any_bool()),
            Kind::Choice(variants) => self.source.any_choice(variants),
            Kind::Whole(low, high) => {
                let few = match self.of_list {
                    None => named(self.few, name),
                    few => few,
                };
                match few {
                    Some((least, greatest)) => self.source.any_few(low, high, least, greatest),
                    None => self.source.any_whole(low, high),
                }
            }
        }
    }
}

/// The least and the greatest of the numbers of this name, where there are few.
fn named(few: Few, name: &str) -> Option<(i64, i64)> {
    let mut place = 0;
    while place < few.len() {
        let (of, least, greatest) = few[place];
        if same(of, name) {
            return Some((least, greatest));
        }
        place += 1;
    }
    None
}

/// Whether two names are the same. By places: Kani executes a hundred steps for `==`, and most names differ in their length.
fn same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    if one.len() != other.len() {
        return false;
    }
    let mut place = 0;
    while place < one.len() {
        if one[place] != other[place] {
            return false;
        }
        place += 1;
    }
    true
}

/// Any value of a type.
pub fn any<T: Fields, S: Source>(source: &mut S) -> T {
    any_but(source, &[])
}

fn any_but<T: Fields, S: Source>(source: &mut S, few: Few) -> T {
    let mut value = T::ANY;
    let of_list = None;
    value.visit(
        "",
        &mut Any {
            source,
            few,
            of_list,
        },
    );
    value
}

/// Any step of a monitor, but for the numbers of which there are few; none where the numbers drawn make none.
pub fn step<M: Contract, S: Source>(source: &mut S, few: Few) -> Option<Case<M>> {
    let config = any_but(source, few);
    if !M::accepted(&config) {
        return None;
    }
    let state = any_but(source, few);
    if !M::invariant(&state, &config) {
        return None;
    }
    Some((state, config, any_but(source, few)))
}
