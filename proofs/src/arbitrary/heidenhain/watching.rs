//! The monitors of position and speed.

use stillpoint_monitors::heidenhain::types::GroupState;
use stillpoint_monitors::heidenhain::{comparison, speed};
use stillpoint_monitors::kernel::{Cycles, Distance, Percent, Position, Speed};

use super::left;
use crate::source::Source;

/// Any position; the enumeration takes those near 0 and the ends of the range.
fn position<S: Source>(source: &mut S, reach: u32) -> Position {
    Position(source.any_i32(reach))
}

/// Any speed; the enumeration takes low ones and the highest.
fn velocity<S: Source>(source: &mut S, reach: u32) -> Speed {
    Speed(source.any_u32(reach, u32::MAX))
}

/// Any distance; the enumeration takes short ones and the longest.
fn distance<S: Source>(source: &mut S, reach: u32) -> Distance {
    Distance(source.any_u32(reach, u32::MAX))
}

fn state<S: Source>(source: &mut S) -> GroupState {
    source.any_of(&GroupState::ALL)
}

/// The highest limit whose 5 % more fits 32 bits.
pub const HIGHEST_LIMIT: u32 = u32::MAX / 105 * 100;

/// Any step of the limited speed. The enumeration takes low speeds, and those around each limit.
pub fn speed<S: Source>(source: &mut S) -> Option<(speed::State, speed::Config, speed::Inputs)> {
    let limits = speed::Limits {
        som_2: Speed(source.any_cut(1, HIGHEST_LIMIT, 10)),
        som_3: Speed(source.any_cut(1, HIGHEST_LIMIT, 10)),
        som_4: Speed(source.any_cut(0, HIGHEST_LIMIT, 10)),
        restricted: velocity(source, 1),
    };
    let config = speed::Config::new(limits, source.any_bool()).ok()?;
    let state = state(source);
    let left = left(source);
    let limit = config.limit(state, left).unwrap_or_default().0;
    // Those around each limit for the enumeration, which takes low ones only.
    let kind = if source.leaves_out() {
        0
    } else {
        source.any_in(0, 2)
    };
    let speed = match kind {
        0 => Speed(source.any_cut(3, u32::MAX, 11)),
        1 => Speed(
            (limit.saturating_add(limit / 20))
                .saturating_sub(1)
                .saturating_add(source.any_in(0, 2)),
        ),
        _ => Speed(limit.saturating_add(source.any_in(0, 1))),
    };
    let inputs = speed::Inputs { state, left, speed };
    Some((speed::State::INITIAL, config, inputs))
}

/// Any step of the comparison of nominal and actual value.
pub fn comparison<S: Source>(
    source: &mut S,
) -> Option<(comparison::State, comparison::Config, comparison::Inputs)> {
    let percent = Percent::new(100 - source.any_u32(1, 100) as u8).ok()?;
    let window = source.any_delay(Cycles::new(u32::MAX));
    let config =
        comparison::Config::new(source.any_bool(), distance(source, 1), percent, window).ok()?;
    let config = if source.any_bool() {
        config.without_group()
    } else {
        config
    };
    let before = comparison::State {
        outside: source.any_cycles(window),
    };
    let inputs = comparison::Inputs {
        state: state(source),
        deviation: distance(source, 2),
        nominal: source.any_cut_i32(1, 12),
        actual: source.any_cut_i32(2, 12),
    };
    Some((before, config, inputs))
}
