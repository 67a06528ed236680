//! Actual value and the monitors that compare it with limits.

use stillpoint_monitors::kernel::{Distance, Position};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::{
    sinumerik::{cam, limit_switch, motion, ramp, results, speed, standstill, threshold},
    units,
};

use super::numbers::{self, bit, distance, monitored, rank, small, stage, truth, upto};
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "motion" => motion(p, mutant),
        "standstill" => standstill(p, mutant)?,
        "speed" => speed(p, mutant)?,
        "end_stop" => end_stop(p, mutant)?,
        "ramp" => ramp(p, mutant)?,
        "threshold" => threshold(p, mutant)?,
        "cam" => cam(p, mutant)?,
        "results" => results(mutant)?,
        _ => return Ok(None),
    }))
}

fn motion(p: &Params, mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<motion::Monitor>(mutant);
    Adapter::new(
        &["power_on", "position", "parking", "set_anew"],
        &["actual", "speed"],
        vec![upto(p.value("pos_max")), truth(), upto(p.value("pos_max"))],
        motion::State::INITIAL,
        move |state, i, o| {
            let inputs = motion::Inputs {
                power_on: i[0] != 0,
                position: Position(i[1]),
                parking: i[2] != 0,
                set_anew: i[3] != 0,
            };
            let (after, out) = next(state, &motion::Config, &inputs);
            o.extend([i64::from(out.position.0), i64::from(out.speed.0)]);
            after
        },
    )
}

fn standstill(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = standstill::Config::new(distance(p.value("tol")))?;
    let next = chosen::<standstill::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["monitored", "position", "reference"],
        &["upper", "lower", "violated", "demand"],
        move |i, o| {
            let inputs = standstill::Inputs {
                monitored: monitored(i[0]),
                position: Position(i[1]),
                reference: Position(i[2]),
            };
            let (_, out) = next(standstill::State::INITIAL, &config, &inputs);
            o.extend([
                bit(out.upper),
                bit(out.lower),
                bit(out.violated),
                rank(out.demand.level()),
            ]);
        },
    ))
}

fn speed(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let reactions = ["reaction_1", "reaction_2", "reaction_3", "reaction_4"];
    let config = speed::Config::new(
        small(p.value("stop_mode")),
        reactions.map(|name| small(p.value(name))),
        p.is("one_encoder").then(|| p.speed("encoder_max")),
        small(p.value("setpoint_percent")),
    )?;
    let next = chosen::<speed::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["monitored", "speed", "limit", "stage", "encoder_speed"],
        &[
            "violated",
            "encoder_violated",
            "demand",
            "setpoint_limited",
            "setpoint_limit",
        ],
        move |i, o| {
            let inputs = speed::Inputs {
                monitored: monitored(i[0]),
                speed: numbers::speed(i[1]),
                limit: numbers::speed(i[2]),
                stage: stage(i[3]),
                encoder_speed: numbers::speed(i[4]),
            };
            let (_, out) = next(speed::State::INITIAL, &config, &inputs);
            o.extend([
                bit(out.violated),
                bit(out.encoder_violated),
                rank(out.demand.level()),
                bit(out.setpoint_limited),
                i64::from(out.setpoint_limit.0),
            ]);
        },
    ))
}

fn end_stop(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let pair = |names: [&str; 2]| names.map(|name| Position(p.value(name)));
    let config = limit_switch::Config::new(
        p.is("enabled"),
        pair(["plus_1", "plus_2"]),
        pair(["minus_1", "minus_2"]),
        small(p.value("stop_mode")),
    )?;
    let next = chosen::<limit_switch::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["active", "select", "position"],
        &["watched", "upper", "lower", "demand"],
        move |i, o| {
            let inputs = limit_switch::Inputs {
                active: i[0] != 0,
                select: i[1] != 0,
                position: Position(i[2]),
            };
            let (_, out) = next(limit_switch::State::INITIAL, &config, &inputs);
            o.extend([
                bit(out.watched),
                bit(out.upper),
                bit(out.lower),
                rank(out.demand.level()),
            ]);
        },
    ))
}

fn ramp(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = ramp::Config::new(p.speed("velo_x"), p.speed("tol"))?;
    let next = chosen::<ramp::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "on", "speed"],
        &["violated", "limit", "frozen", "demand"],
        vec![upto(p.value("v_max"))],
        ramp::State::INITIAL,
        move |state, i, o| {
            let inputs = ramp::Inputs {
                power_on: i[0] != 0,
                on: i[1] != 0,
                speed: numbers::speed(i[2]),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.violated),
                i64::from(out.limit.0),
                bit(out.frozen),
                rank(out.demand.level()),
            ]);
            after
        },
    )
    .without(&["restart"]))
}

fn threshold(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = threshold::Config::new(p.speed("velo_x"))?;
    let next = chosen::<threshold::Monitor>(mutant);
    Ok(Adapter::stateless(&["speed"], &["below"], move |i, o| {
        let inputs = threshold::Inputs {
            speed: numbers::speed(i[0]),
        };
        let (_, out) = next(threshold::State::INITIAL, &config, &inputs);
        o.push(bit(out.below));
    }))
}

fn cam(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let range = units::ModuloRange::new(Position(p.value("lower")), Position(p.value("upper")))?;
    let config = cam::Config::new(
        p.is("enabled"),
        Position(p.value("position_of")),
        distance(p.value("tol")),
        p.is("sync"),
        range,
        Distance(0),
    )?;
    let next = chosen::<cam::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "position", "other"],
        &["own", "sga"],
        vec![truth()],
        cam::State::INITIAL,
        move |state, i, o| {
            let inputs = cam::Inputs {
                power_on: i[0] != 0,
                position: Position(i[1]),
                other: i[2] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([bit(out.own), bit(out.sga)]);
            after
        },
    ))
}

fn results(mutant: Option<Mutant>) -> Refusable {
    // The table has result list 1 only.
    let config = results::Config::new([false; 8], false, false)?;
    let next = chosen::<results::Monitor>(mutant);
    Ok(Adapter::stateless(
        &[
            "monitored",
            "stage",
            "sbh_upper",
            "sbh_lower",
            "sg_violated",
            "se_watched",
            "se_select",
            "se_upper",
            "se_lower",
        ],
        &[
            "r_sbh", "r_se1", "r_se2", "r_sg1", "r_sg2", "r_sg3", "r_sg4",
        ],
        move |i, o| {
            let inputs = results::Inputs {
                monitored: monitored(i[0]),
                stage: stage(i[1]),
                standstill_upper: i[2] != 0,
                standstill_lower: i[3] != 0,
                speed_violated: i[4] != 0,
                se_watched: i[5] != 0,
                se_select: i[6] != 0,
                se_upper: i[7] != 0,
                se_lower: i[8] != 0,
                cams: [false; 8],
                below: false,
            };
            let (_, out) = next(results::State::INITIAL, &config, &inputs);
            let list = out.list_1;
            let fields = [list.sbh].into_iter().chain(list.se).chain(list.sg);
            o.extend(fields.map(|field| i64::from(field.bits())));
        },
    ))
}
