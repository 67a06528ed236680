//! The types of the monitors as cells and ports: every number of theirs in its order.

use stillpoint_monitors::fields::{Fields, Kind, Visitor};

/// A number of a type: its name, that with the names of the fields it is in, and its values.
pub(super) struct Number {
    pub(super) short: &'static str,
    pub(super) name: String,
    pub(super) kind: Kind,
}

/// Collects the numbers of a type.
#[derive(Default)]
struct Collect {
    path: Vec<&'static str>,
    all: Vec<Number>,
}

impl Visitor for Collect {
    fn number(&mut self, short: &'static str, kind: Kind, value: i64) -> i64 {
        self.path.push(short);
        let name = self.path.join(".");
        self.all.push(Number { short, name, kind });
        self.path.pop();
        value
    }

    fn open(&mut self, name: &'static str) {
        self.path.push(name);
    }

    fn close(&mut self) {
        self.path.pop();
    }
}

/// The numbers of a part of a step, which is the first part of their names.
pub(super) fn numbers<T: Fields>(part: &'static str) -> Vec<Number> {
    let mut numbers = Collect::default();
    T::ANY.clone().visit(part, &mut numbers);
    numbers.all
}

/// Sets each number to the next one of a list.
struct Set<I>(I);

impl<I: Iterator<Item = i64>> Visitor for Set<I> {
    fn number(&mut self, _: &'static str, _: Kind, value: i64) -> i64 {
        self.0.next().unwrap_or(value)
    }
}

/// The value with these numbers.
pub(super) fn set<T: Fields>(numbers: impl Iterator<Item = i64>) -> T {
    let mut value = T::ANY;
    value.visit("", &mut Set(numbers));
    value
}

/// Hands each number on.
struct Get<F>(F);

impl<F: FnMut(i64)> Visitor for Get<F> {
    fn number(&mut self, _: &'static str, _: Kind, value: i64) -> i64 {
        (self.0)(value);
        value
    }
}

/// Hands on each number of a value.
pub(super) fn get<T: Fields>(mut value: T, each: impl FnMut(i64)) {
    value.visit("", &mut Get(each));
}

/// The value in cells.
pub(super) fn load<T: Fields>(cells: &[i32]) -> T {
    set(cells.iter().map(|cell| i64::from(*cell)))
}

/// A number in a cell; one that is too large for it is the largest.
pub(super) fn cell(number: i64) -> i32 {
    i32::try_from(number).unwrap_or(if number < 0 { i32::MIN } else { i32::MAX })
}

/// Writes a value to cells.
pub(super) fn store<T: Fields>(value: T, cells: &mut [i32]) {
    let mut cells = cells.iter_mut();
    get(value, |number| {
        if let Some(place) = cells.next() {
            *place = cell(number);
        }
    });
}

/// A value in cells of its own.
pub(super) fn stored<T: Fields>(value: T) -> Vec<i32> {
    let mut cells = Vec::new();
    get(value, |number| cells.push(cell(number)));
    cells
}
