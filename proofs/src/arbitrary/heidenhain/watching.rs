//! The monitors of position and speed.

use stillpoint_monitors::heidenhain::position_limit::Lock;
use stillpoint_monitors::heidenhain::types::{GroupState, Unit};
use stillpoint_monitors::heidenhain::{
    axis_count, comparison, deceleration, operating_stop, position_limit, revolutions, speed,
    stop_path,
};
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

/// Any step of the operating stop.
pub fn operating_stop<S: Source>(
    source: &mut S,
) -> Option<(
    operating_stop::State,
    operating_stop::Config,
    operating_stop::Inputs,
)> {
    let config = operating_stop::Config::new(distance(source, 2), velocity(source, 2)).ok()?;
    let on = source.any_bool();
    let state = operating_stop::State {
        on,
        begin: if on { position(source, 2) } else { Position(0) },
    };
    let inputs = operating_stop::Inputs {
        watched: source.any_bool(),
        self_test: source.any_bool(),
        position: position(source, 4),
        speed: velocity(source, 3),
    };
    Some((state, config, inputs))
}

/// Any step of the path of an SS2.
pub fn stop_path<S: Source>(
    source: &mut S,
) -> Option<(stop_path::State, stop_path::Config, stop_path::Inputs)> {
    let config = stop_path::Config::new(distance(source, 2)).ok()?;
    let on = source.any_bool();
    let before = stop_path::State {
        on,
        begin: if on { position(source, 2) } else { Position(0) },
    };
    let inputs = stop_path::Inputs {
        braking: source.any_bool(),
        state: state(source),
        position: position(source, 4),
    };
    Some((before, config, inputs))
}

/// Any step of the limited position.
pub fn position_limit<S: Source>(
    source: &mut S,
) -> Option<(
    position_limit::State,
    position_limit::Config,
    position_limit::Inputs,
)> {
    let config = position_limit::Config::new(position(source, 1), position(source, 1)).ok()?;
    let state = position_limit::State {
        lock: source.any_of(&[Lock::None, Lock::ReturnAllowed, Lock::Locked]),
        last: position(source, 3),
    };
    let inputs = position_limit::Inputs {
        checked: source.any_bool(),
        changed: source.any_bool(),
        stopping: source.any_bool(),
        position: position(source, 3),
    };
    Some((state, config, inputs))
}

/// Any step of the two revolutions.
pub fn revolutions<S: Source>(
    source: &mut S,
) -> Option<(revolutions::State, revolutions::Config, revolutions::Inputs)> {
    let turns = source.any_u32(3, (1 << 30) - 1);
    let config = revolutions::Config::new(turns).ok()?;
    let angle = source.any_i32(4);
    let before = revolutions::State {
        // The ends of 32 bits are outside; halved they are the ends of the range.
        angle: if source.enumerates() {
            angle >> 1
        } else {
            angle
        },
    };
    if !before.invariant(&config) {
        return None;
    }
    let inputs = revolutions::Inputs {
        state: state(source),
        step: source.any_i32(5),
    };
    Some((before, config, inputs))
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

/// Any step of the dv/dt monitoring.
pub fn deceleration<S: Source>(
    source: &mut S,
) -> Option<(
    deceleration::State,
    deceleration::Config,
    deceleration::Inputs,
)> {
    let wait = source.any_delay(Cycles::new(u32::MAX));
    let config = deceleration::Config::new(source.any_bool(), wait, source.any_bool()).ok()?;
    let before = if source.any_bool() {
        deceleration::State {
            on: true,
            timer: source.any_cycles(wait),
            last: velocity(source, 2),
        }
    } else {
        deceleration::State::INITIAL
    };
    let inputs = deceleration::Inputs {
        braking: source.any_bool(),
        speed: velocity(source, 3),
    };
    Some((before, config, inputs))
}

/// Any step of the number of moving axes.
pub fn axis_count<S: Source>(
    source: &mut S,
) -> Option<(axis_count::State, axis_count::Config, axis_count::Inputs)> {
    let inputs = axis_count::Inputs {
        state: state(source),
        unit: source.any_of(&Unit::ALL),
        moving: source.any_u32(3, u32::from(u8::MAX)) as u8,
        ungrouped: source.any_u32(3, u32::from(u8::MAX)) as u8,
    };
    Some((axis_count::State::INITIAL, axis_count::Config, inputs))
}
