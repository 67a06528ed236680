//! The monitors of position and speed.

use stillpoint_model::Domain;
use stillpoint_monitors::heidenhain::mutant::Mutant;
use stillpoint_monitors::heidenhain::position_limit::Lock;
use stillpoint_monitors::heidenhain::{
    axis_count, comparison, deceleration, operating_stop, position_limit, revolutions, speed,
    stop_path,
};
use stillpoint_monitors::kernel::{Percent, Position};

use super::numbers::*;
use crate::diff::peer::adapter::{Adapter, cells};
use crate::diff::peer::{Made, Params, Refusable};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "speed" => speed(p, mutant)?,
        "operating_stop" => operating_stop(p, mutant)?,
        "stop_path" => stop_path(p, mutant)?,
        "position_limit" => position_limit(p, mutant)?,
        "revolutions" => revolutions(p, mutant)?,
        "comparison" => comparison(p, mutant)?,
        "deceleration" => deceleration(p, mutant)?,
        "axis_count" => axis_count(mutant),
        _ => return Ok(None),
    }))
}

fn lock_rank(lock: Lock) -> i32 {
    ordinal(&Lock::ALL, lock)
}

fn place(position: Position) -> i32 {
    position.0
}

cells! {
    operating_stop::State, 2 {
        on = truthy, i32::from;
        begin = Position, place;
    }
    stop_path::State, 2 {
        on = truthy, i32::from;
        begin = Position, place;
    }
    position_limit::State, 2 {
        lock = |c| value(&Lock::ALL, c), lock_rank;
        last = Position, place;
    }
    revolutions::State, 1 {
        angle = i32::from, i32::from;
    }
    comparison::State, 1 {
        outside = cycles, cell;
    }
    deceleration::State, 3 {
        on = truthy, i32::from;
        timer = cycles, cell;
        last = speed_of, increments;
    }
}

/// A speed; 0 for a negative number.
fn speed_of(cell: i32) -> stillpoint_monitors::kernel::Speed {
    super::numbers::speed(cell)
}

fn speed(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let limits = speed::Limits {
        som_2: p.speed("limit_2"),
        som_3: p.speed("limit_3"),
        som_4: p.speed("limit_4"),
        restricted: p.speed("limit_s"),
    };
    let config = speed::Config::new(limits, p.is("cc"))?;
    let next = mutant.map_or(speed::next as speed::Next, Mutant::speed);
    Ok(Adapter::stateless(
        &["state", "with_2", "with_3", "with_4", "v"],
        &["watched", "violated", "not_set", "demand"],
        move |i, o| {
            let inputs = speed::Inputs {
                state: state(i[0]),
                left: Left {
                    sls_2: i[1] != 0,
                    sls_3: i[2] != 0,
                    sls_4: i[3] != 0,
                },
                speed: speed_of(i[4]),
            };
            let (_, out) = next(speed::State::INITIAL, &config, &inputs);
            o.extend([
                bit(out.watched),
                bit(out.violated),
                bit(out.not_set),
                stop_rank(out.demand),
            ]);
        },
    ))
}

fn operating_stop(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = operating_stop::Config::new(distance(p.value("path")), p.speed("still"))?;
    let next = mutant.map_or(
        operating_stop::next as operating_stop::Next,
        Mutant::operating_stop,
    );
    Ok(Adapter::new(
        &["watched", "self_test", "position", "v"],
        &["too_fast", "too_far", "demand", "on", "begin"],
        vec![truth(), upto(p.value("pos_max"))],
        operating_stop::State::INITIAL,
        move |state, i, o| {
            let inputs = operating_stop::Inputs {
                watched: i[0] != 0,
                self_test: i[1] != 0,
                position: Position(i[2]),
                speed: speed_of(i[3]),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.too_fast),
                bit(out.too_far),
                stop_rank(out.demand),
                bit(after.on),
                i64::from(after.begin.0),
            ]);
            after
        },
    ))
}

fn stop_path(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = stop_path::Config::new(distance(p.value("path")))?;
    let next = mutant.map_or(stop_path::next as stop_path::Next, Mutant::stop_path);
    Ok(Adapter::new(
        &["braking", "state", "position"],
        &["demand", "on", "begin"],
        vec![truth(), upto(p.value("pos_max"))],
        stop_path::State::INITIAL,
        move |before, i, o| {
            let inputs = stop_path::Inputs {
                braking: i[0] != 0,
                state: state(i[1]),
                position: Position(i[2]),
            };
            let (after, out) = next(before, &config, &inputs);
            o.extend([
                stop_rank(out.demand),
                bit(after.on),
                i64::from(after.begin.0),
            ]);
            after
        },
    ))
}

fn position_limit(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config =
        position_limit::Config::new(Position(p.value("minus")), Position(p.value("plus")))?;
    let next = mutant.map_or(
        position_limit::next as position_limit::Next,
        Mutant::position_limit,
    );
    Ok(Adapter::new(
        &["checked", "changed", "stopping", "position"],
        &["demand", "lock"],
        vec![upto(2), upto(p.value("pos_max"))],
        position_limit::State::INITIAL,
        move |state, i, o| {
            let inputs = position_limit::Inputs {
                checked: i[0] != 0,
                changed: i[1] != 0,
                stopping: i[2] != 0,
                position: Position(i[3]),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([stop_rank(out.demand), i64::from(lock_rank(after.lock))]);
            after
        },
    )
    .kept(1, "last"))
}

fn revolutions(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let turns = p.value("turns");
    let config = revolutions::Config::new(turns.unsigned_abs())?;
    let next = mutant.map_or(revolutions::next as revolutions::Next, Mutant::revolutions);
    Ok(Adapter::new(
        &["state", "step"],
        &["demand"],
        vec![Domain {
            lo: -turns - 1,
            hi: turns + 1,
        }],
        revolutions::State::INITIAL,
        move |before, i, o| {
            let inputs = revolutions::Inputs {
                state: state(i[0]),
                step: i[1],
            };
            let (after, out) = next(before, &config, &inputs);
            o.push(stop_rank(out.demand));
            after
        },
    )
    .without(&["moving"]))
}

fn comparison(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let percent = Percent::new(small(p.value("percent")))?;
    let config = comparison::Config::new(
        p.is("spindle"),
        distance(p.value("tolerance")),
        percent,
        p.time("window"),
    )?;
    let config = if p.is("grouped") {
        config
    } else {
        config.without_group()
    };
    let next = mutant.map_or(comparison::next as comparison::Next, Mutant::comparison);
    Ok(Adapter::new(
        &["state", "deviation", "nominal", "actual"],
        &["position", "speed", "demand"],
        vec![upto(p.value("window"))],
        comparison::State::INITIAL,
        move |before, i, o| {
            let inputs = comparison::Inputs {
                state: state(i[0]),
                deviation: distance(i[1]),
                nominal: i[2],
                actual: i[3],
            };
            let (after, out) = next(before, &config, &inputs);
            o.extend([bit(out.position), bit(out.speed), stop_rank(out.demand)]);
            after
        },
    ))
}

fn deceleration(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = deceleration::Config::new(p.is("spindle"), p.time("wait"), p.is("off"))?;
    let next = mutant.map_or(
        deceleration::next as deceleration::Next,
        Mutant::deceleration,
    );
    Ok(Adapter::new(
        &["braking", "v"],
        &["demand"],
        vec![truth(), upto(p.value("wait")), upto(p.value("v_max"))],
        deceleration::State::INITIAL,
        move |state, i, o| {
            let inputs = deceleration::Inputs {
                braking: i[0] != 0,
                speed: speed_of(i[1]),
            };
            let (after, out) = next(state, &config, &inputs);
            o.push(stop_rank(out.demand));
            after
        },
    ))
}

fn axis_count(mutant: Option<Mutant>) -> Adapter {
    let next = mutant.map_or(axis_count::next as axis_count::Next, Mutant::axis_count);
    Adapter::stateless(
        &["state", "unit", "moving", "free"],
        &["allowed", "demand"],
        move |i, o| {
            let inputs = axis_count::Inputs {
                state: state(i[0]),
                unit: unit(i[1]),
                moving: small(i[2]),
                ungrouped: small(i[3]),
            };
            let (_, out) = next(axis_count::State::INITIAL, &axis_count::Config, &inputs);
            // The table counts at most three axes: as many as may move without a limit.
            let allowed = if out.one_only { 1 } else { 3 };
            o.extend([allowed, stop_rank(out.demand)]);
        },
    )
}
