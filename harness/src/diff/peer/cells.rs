//! The types of the monitors as cells and ports: every number of theirs in its order.

use stillpoint_monitors::fields::{Fields, Kind, get, set, walk};

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
    walk::<T>(part, |path, kind| {
        numbers.push(Number {
            short: path.last().copied().unwrap_or_default(),
            name: path.join("."),
            kind,
        });
    });
    numbers
}

/// The value in cells.
pub(crate) fn load<T: Fields>(cells: &[i32]) -> T {
    set(cells.iter().map(|cell| i64::from(*cell)))
}

/// A number in a cell; one that is too large for it is the largest.
pub(crate) fn cell(number: i64) -> i32 {
    i32::try_from(number).unwrap_or(if number < 0 { i32::MIN } else { i32::MAX })
}

/// Writes a value to cells.
pub(crate) fn store<T: Fields>(value: T, cells: &mut [i32]) {
    let mut cells = cells.iter_mut();
    get(value, |number| {
        if let Some(place) = cells.next() {
            *place = cell(number);
        }
    });
}

/// A value in cells of its own.
pub(crate) fn stored<T: Fields>(value: T) -> Vec<i32> {
    let mut cells = Vec::new();
    get(value, |number| cells.push(cell(number)));
    cells
}
