//! The values of the monitors as the numbers of the tables, and back.

pub(super) use stillpoint_monitors::heidenhain::types::{
    GroupState, Kind, Left, Phase, Som, Stop, Unit,
};

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

/// The stop with this number.
pub(super) fn stop(ordinal: i32) -> Stop {
    value(&Stop::ALL, ordinal)
}

/// The number of a stop.
pub(super) fn stop_rank(stop: Stop) -> i64 {
    rank(&Stop::ALL, stop)
}

/// The number of a safe operating mode.
pub(super) fn som_rank(som: Som) -> i64 {
    rank(&Som::ALL, som)
}

/// The machine operating mode with this number.
pub(super) fn unit(ordinal: i32) -> Unit {
    value(&Unit::ALL, ordinal)
}

/// The kind of group with this number.
pub(super) fn kind(ordinal: i32) -> Kind {
    value(&Kind::ALL, ordinal)
}

/// The safe operating mode with this number.
pub(super) fn som(ordinal: i32) -> Som {
    value(&Som::ALL, ordinal)
}

/// The phase with this number.
pub(super) fn phase(ordinal: i32) -> Phase {
    value(&Phase::ALL, ordinal)
}
