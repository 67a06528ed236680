//! The values of the monitors as the numbers of the tables, and back.

pub(super) use stillpoint_monitors::heidenhain::types::{GroupState, Som, Stop, Unit};

pub(super) use crate::diff::peer::numbers::*;

/// The number of a value of a list, as an output.
pub(super) fn rank<T: PartialEq>(all: &[T], value: T) -> i64 {
    i64::from(ordinal(all, value))
}

/// The monitoring state with this number.
pub(super) fn state(ordinal: i32) -> GroupState {
    value(&GroupState::ALL, ordinal)
}

/// The number of a monitoring state.
pub(super) fn state_rank(state: GroupState) -> i64 {
    rank(&GroupState::ALL, state)
}

/// The number of a stop.
pub(super) fn stop_rank(stop: Stop) -> i64 {
    rank(&Stop::ALL, stop)
}

/// The machine operating mode with this number.
pub(super) fn unit(ordinal: i32) -> Unit {
    value(&Unit::ALL, ordinal)
}

/// The safe operating mode with this number.
pub(super) fn som(ordinal: i32) -> Som {
    value(&Som::ALL, ordinal)
}
