//! The types of the monitors as cells and ports: every number of theirs in its order.
//!
//! What is done with the numbers is behind a pointer: else each type would be compiled once for everything that is done with it.

use stillpoint_monitors::fields::{self, Fields, Kind};

/// Shows each number of a value.
pub(crate) fn get<T: Fields>(value: T, each: &mut dyn FnMut(i64)) {
    fields::get(value, each);
}

/// The value with these numbers, as [`fields::set`] makes it.
pub(crate) fn set<T: Fields>(numbers: &mut dyn Iterator<Item = i64>) -> T {
    fields::set(numbers)
}

/// A number of a type: its name, that with the names of the fields it is in, and its values.
#[derive(Clone)]
pub(crate) struct Number {
    pub(crate) short: &'static str,
    pub(crate) name: String,
    pub(crate) kind: Kind,
}

/// The numbers of a part of a step, which is the first part of their names.
pub(crate) fn numbers<T: Fields>(part: &'static str) -> Vec<Number> {
    let mut numbers = Vec::new();
    let each: &mut dyn FnMut(&[&'static str], Kind) = &mut |path, kind| {
        numbers.push(Number {
            short: path.last().copied().unwrap_or_default(),
            name: path.join("."),
            kind,
        });
    };
    fields::walk::<T>(part, each);
    numbers
}

/// The value in cells.
pub(crate) fn load<T: Fields>(cells: &[i32]) -> T {
    set(&mut cells.iter().map(|cell| i64::from(*cell)))
}

/// A number in a cell; one that is too large for it is the largest.
pub(crate) fn cell(number: i64) -> i32 {
    i32::try_from(number).unwrap_or(if number < 0 { i32::MIN } else { i32::MAX })
}

/// Writes a value to cells.
pub(crate) fn store<T: Fields>(value: T, cells: &mut [i32]) {
    let mut cells = cells.iter_mut();
    get(value, &mut |number| {
        if let Some(place) = cells.next() {
            *place = cell(number);
        }
    });
}

/// A value in cells of its own.
pub(crate) fn stored<T: Fields>(value: T) -> Vec<i32> {
    let mut cells = Vec::new();
    get(value, &mut |number| cells.push(cell(number)));
    cells
}
