//! The monitors of position and speed.

use stillpoint_monitors::heidenhain::types::GroupState;
use stillpoint_monitors::heidenhain::{comparison, speed};
use stillpoint_monitors::kernel::{Cycles, Distance, Percent, Speed};

use crate::draw::any;
use crate::source::Source;

/// Any distance; the enumeration takes short ones and the longest.
fn distance<S: Source>(source: &mut S, reach: u32) -> Distance {
    Distance(source.any_u32(reach, u32::MAX))
}

fn state<S: Source>(source: &mut S) -> GroupState {
    source.any_of(&GroupState::ALL)
}

/// The highest limit whose 5 % more fits 32 bits.
pub const HIGHEST_LIMIT: u32 = u32::MAX / 105 * 100;

/// Any step of the limited speed. By hand, since the enumeration takes low speeds and those around the limit in force, Kani few
/// bits.
pub fn speed<S: Source>(source: &mut S) -> Option<(speed::State, speed::Config, speed::Inputs)> {
    let limits = speed::Limits {
        som_2: Speed(source.any_cut(1, HIGHEST_LIMIT, 10)),
        som_3: Speed(source.any_cut(1, HIGHEST_LIMIT, 10)),
        som_4: Speed(source.any_cut(0, HIGHEST_LIMIT, 10)),
        restricted: Speed(source.any_u32(1, u32::MAX)),
    };
    let config = speed::Config::new(limits, source.any_bool()).ok()?;
    let state = state(source);
    let left = any(source);
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

/// Any step of the comparison of nominal and actual value. By hand, since Kani takes few bits of the speeds.
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
