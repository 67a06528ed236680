//! Values that every family has, as the numbers of the tables, and back.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{Cycles, Distance, Speed};

/// The value with this number; the first one for a number that none has.
pub(super) fn value<T: Copy>(all: &[T], ordinal: i32) -> T {
    let found = usize::try_from(ordinal).ok().and_then(|k| all.get(k));
    *found.unwrap_or(&all[0])
}

/// The number of a value.
pub(super) fn ordinal<T: PartialEq>(all: &[T], value: T) -> i32 {
    all.iter().position(|v| *v == value).unwrap_or(0) as i32
}

/// A duration of that many cycles; none for a negative number.
pub(super) fn cycles(cell: i32) -> Cycles {
    Cycles::new(u32::try_from(cell).unwrap_or(0))
}

/// The number of cycles.
pub(super) fn cell(cycles: Cycles) -> i32 {
    i32::try_from(cycles.count()).unwrap_or(i32::MAX)
}

/// A speed; 0 for a negative number.
pub(super) fn speed(value: i32) -> Speed {
    Speed(u32::try_from(value).unwrap_or(0))
}

/// The number of a speed.
pub(super) fn increments(speed: Speed) -> i32 {
    i32::try_from(speed.0).unwrap_or(i32::MAX)
}

/// A distance; 0 for a negative number.
pub(super) fn distance(value: i32) -> Distance {
    Distance(u32::try_from(value).unwrap_or(0))
}

/// The number as a byte; the highest for one that is none.
pub(super) fn small(value: i32) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}

/// A truth value as an output.
pub(super) fn bit(b: bool) -> i64 {
    i64::from(b)
}

/// The domain of a truth value.
pub(super) fn truth() -> Domain {
    Domain { lo: 0, hi: 1 }
}

/// The domain from 0 to `hi`.
pub(super) fn upto(hi: i32) -> Domain {
    Domain { lo: 0, hi }
}

/// A cell as a truth value.
pub(super) const fn truthy(cell: i32) -> bool {
    cell != 0
}
