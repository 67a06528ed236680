//! The values of these monitors as the numbers of their tables, and back.

use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::selection::{FactorIndex, Stage};

pub(super) use crate::diff::peer::numbers::*;
use crate::diff::product::Values;

/// What an internal stop can be; never a test stop or STOP F.
pub(super) const INTERNAL: Values = Values::List(&[0, 2, 3, 4, 6, 7]);
/// What an external stop can be; never STOP B.
pub(super) const EXTERNAL: Values = Values::List(&[0, 2, 3, 4, 7]);

pub(super) fn level(ordinal: i32) -> Level {
    value(&Level::ALL, ordinal)
}

pub(super) fn internal(ordinal: i32) -> InternalStop {
    InternalStop::from_level(level(ordinal)).unwrap_or(InternalStop::A)
}

pub(super) fn external_stop(ordinal: i32) -> ExternalStop {
    ExternalStop::from_level(level(ordinal)).unwrap_or(ExternalStop::A)
}

pub(super) fn rank(level: Level) -> i64 {
    i64::from(level.rank())
}

pub(super) fn stage(ordinal: i32) -> Stage {
    Stage::from_bits(ordinal & 2 != 0, ordinal & 1 != 0)
}

pub(super) fn factor(index: i32) -> FactorIndex {
    let index = u8::try_from(index).ok();
    index.and_then(FactorIndex::new).unwrap_or_default()
}
