//! The values of these monitors as the numbers of their tables, and back.

use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::selection::{FactorIndex, Mode, Monitored, Stage};
use stillpoint_monitors::sinumerik::{fault, reference, stop};

pub(super) use crate::diff::peer::numbers::*;
use crate::diff::product::Values;

/// What an internal stop can be; never a test stop or STOP F.
pub(super) const INTERNAL: Values = Values::List(&[0, 2, 3, 4, 6, 7]);
/// What an external stop can be; never STOP B.
pub(super) const EXTERNAL: Values = Values::List(&[0, 2, 3, 4, 7]);

pub(super) const MODES: [Mode; 6] = [
    Mode::Nsb,
    Mode::Sg,
    Mode::SgDown,
    Mode::SbhPend,
    Mode::Sbh,
    Mode::SbhForced,
];
pub(super) const FAULTS: [fault::FaultState; 4] = [
    fault::FaultState::None,
    fault::FaultState::Latched,
    fault::FaultState::Delay,
    fault::FaultState::Expired,
];
pub(super) const STOPS: [stop::Phase; 6] = [
    stop::Phase::Idle,
    stop::Phase::Braking,
    stop::Phase::SbhInt,
    stop::Phase::BBraking,
    stop::Phase::PulsesOff,
    stop::Phase::Testing,
];
pub(super) const AXES: [reference::AxisState; 4] = [
    reference::AxisState::Off,
    reference::AxisState::NotRef,
    reference::AxisState::Ref,
    reference::AxisState::SafeRef,
];
const LEVELS: [Level; 8] = [
    Level::None,
    Level::F,
    Level::E,
    Level::D,
    Level::C,
    Level::Test,
    Level::B,
    Level::A,
];

pub(super) fn level(ordinal: i32) -> Level {
    value(&LEVELS, ordinal)
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

pub(super) fn watched(monitored: Monitored) -> i64 {
    match monitored {
        Monitored::Nothing => 0,
        Monitored::Speed => 1,
        Monitored::Standstill => 2,
    }
}
