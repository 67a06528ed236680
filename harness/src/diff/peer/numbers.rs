//! What the monitors of every family are made of as the numbers of the tables, and back.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{Cycles, Distance, Speed};

/// The value with this number; the first one for a number that none has.
pub(crate) fn value<T: Copy>(all: &[T], ordinal: i32) -> T {
    let found = usize::try_from(ordinal).ok().and_then(|k| all.get(k));
    *found.unwrap_or(&all[0])
}

/// The number of a value.
pub(crate) fn ordinal<T: PartialEq>(all: &[T], value: T) -> i32 {
    all.iter().position(|v| *v == value).unwrap_or(0) as i32
}

pub(crate) fn cycles(cell: i32) -> Cycles {
    Cycles::new(u32::try_from(cell).unwrap_or(0))
}

pub(crate) fn speed(value: i32) -> Speed {
    Speed(u32::try_from(value).unwrap_or(0))
}

pub(crate) fn distance(value: i32) -> Distance {
    Distance(u32::try_from(value).unwrap_or(0))
}

pub(crate) fn small(value: i32) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}

pub(crate) fn bit(b: bool) -> i64 {
    i64::from(b)
}

pub(crate) fn truth() -> Domain {
    Domain { lo: 0, hi: 1 }
}

pub(crate) fn upto(hi: i32) -> Domain {
    Domain { lo: 0, hi }
}
