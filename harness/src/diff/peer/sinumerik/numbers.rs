//! The values of the monitors as the numbers of the tables, and back.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{Cycles, Distance, Speed};
use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop, Level};
use stillpoint_monitors::sinumerik::selection::{FactorIndex, Mode, Monitored, Stage};
use stillpoint_monitors::sinumerik::{fault, path_test, pulses, reference, stop};

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
pub(super) const TESTS: [path_test::Phase; 3] = [
    path_test::Phase::Idle,
    path_test::Phase::Run,
    path_test::Phase::RunOk,
];
pub(super) const PULSES: [pulses::Phase; 4] = [
    pulses::Phase::Enabled,
    pulses::Phase::CancelInt,
    pulses::Phase::Cancelled,
    pulses::Phase::CancelExt,
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

/// The value with this number; the first one for a number that none has.
pub(super) fn value<T: Copy>(all: &[T], ordinal: i32) -> T {
    let found = usize::try_from(ordinal).ok().and_then(|k| all.get(k));
    *found.unwrap_or(&all[0])
}

/// The number of a value.
pub(super) fn ordinal<T: PartialEq>(all: &[T], value: T) -> i32 {
    all.iter().position(|v| *v == value).unwrap_or(0) as i32
}

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

pub(super) fn cycles(cell: i32) -> Cycles {
    Cycles::new(u32::try_from(cell).unwrap_or(0))
}

pub(super) fn cell(cycles: Cycles) -> i32 {
    i32::try_from(cycles.count()).unwrap_or(i32::MAX)
}

pub(super) fn stage(ordinal: i32) -> Stage {
    Stage::from_bits(ordinal & 2 != 0, ordinal & 1 != 0)
}

pub(super) fn factor(index: i32) -> FactorIndex {
    let index = u8::try_from(index).ok();
    index.and_then(FactorIndex::new).unwrap_or_default()
}

pub(super) fn monitored(ordinal: i32) -> Monitored {
    value(
        &[Monitored::Nothing, Monitored::Speed, Monitored::Standstill],
        ordinal,
    )
}

pub(super) fn watched(monitored: Monitored) -> i64 {
    match monitored {
        Monitored::Nothing => 0,
        Monitored::Speed => 1,
        Monitored::Standstill => 2,
    }
}

pub(super) fn speed(value: i32) -> Speed {
    Speed(u32::try_from(value).unwrap_or(0))
}

pub(super) fn increments(speed: Speed) -> i32 {
    i32::try_from(speed.0).unwrap_or(i32::MAX)
}

pub(super) fn distance(value: i32) -> Distance {
    Distance(u32::try_from(value).unwrap_or(0))
}

pub(super) fn small(value: i32) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}

pub(super) fn bit(b: bool) -> i64 {
    i64::from(b)
}

pub(super) fn truth() -> Domain {
    Domain { lo: 0, hi: 1 }
}

pub(super) fn upto(hi: i32) -> Domain {
    Domain { lo: 0, hi }
}
