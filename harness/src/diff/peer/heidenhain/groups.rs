//! Stop and monitoring state of an axis group.

use stillpoint_monitors::heidenhain::{
    axis_release, global_sto, group, judge, neighbour, report, startup, stop as stops,
};
use stillpoint_monitors::mutant::Mutant;

use super::numbers::{self, *};
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, chosen};
use crate::diff::product::Values;

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "stop" => stops(p, mutant)?,
        "report" => report(mutant)?,
        "neighbour" => neighbour(p, mutant)?,
        "global_sto" => global_sto(p, mutant)?,
        "judge" => judge(p, mutant)?,
        "group" => group(p, mutant)?,
        "startup" => startup(p, mutant)?,
        "axis" => axis_release(p, mutant)?,
        _ => return Ok(None),
    }))
}

fn stops(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let (t_ss1, t_ss2, t_brake) = (p.time("t_ss1"), p.time("t_ss2"), p.time("t_brake"));
    let config = stops::Config::new(p.is("cc"), t_ss1, t_ss2, t_brake)?;
    let next = chosen::<stops::Monitor>(mutant);
    let longest = p.value("t_ss1").max(p.value("t_ss2")).max(1);
    Ok(Adapter::new(
        &[
            "main_switch",
            "demand",
            "wide_cause",
            "still",
            "listed_still",
            "peer_off",
            "restart",
        ],
        &[
            "level",
            "phase",
            "wide",
            "torque_off",
            "brake_closed",
            "on_contour",
            "emergency_ramp",
            "brake_listed",
            "needs_switch",
            "ss2_ended",
            "restarted",
            "keeps_enable",
        ],
        vec![
            upto(5),
            upto(6),
            upto(longest),
            upto(p.value("t_brake").max(1)),
            truth(),
        ],
        stops::State::INITIAL,
        move |state, i, o| {
            let inputs = stops::Inputs {
                main_switch: i[0] != 0,
                demand: stop(i[1]),
                wide_cause: i[2] != 0,
                still: i[3] != 0,
                listed_still: i[4] != 0,
                peer_off: i[5] != 0,
                restart: i[6] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                stop_rank(out.level),
                rank(&Phase::ALL, out.phase),
                bit(out.wide),
                bit(out.torque_off),
                bit(out.brake_closed),
                bit(out.on_contour),
                bit(out.emergency_ramp),
                bit(out.brake_listed),
                bit(out.needs_switch),
                bit(out.ss2_ended),
                bit(out.restarted),
                bit(out.keeps_enable),
            ]);
            after
        },
    ))
}

fn report(mutant: Option<Mutant>) -> Refusable {
    let config = report::Config::new()?;
    let next = chosen::<report::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["level", "phase", "found"],
        &["told"],
        move |i, o| {
            let inputs = report::Inputs {
                level: stop(i[0]),
                phase: phase(i[1]),
                found: stop(i[2]),
            };
            let (_, out) = next(report::State::INITIAL, &config, &inputs);
            o.push(stop_rank(out.told));
        },
    ))
}

fn neighbour(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = neighbour::Config::new(p.is("listed"))?;
    let next = chosen::<neighbour::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["level", "phase", "wide"],
        &["demand"],
        move |i, o| {
            let inputs = neighbour::Inputs {
                level: stop(i[0]),
                phase: phase(i[1]),
                wide: i[2] != 0,
            };
            let (_, out) = next(neighbour::State::INITIAL, &config, &inputs);
            o.push(stop_rank(out.demand));
        },
    ))
}

fn global_sto(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = global_sto::Config::new(p.time("t_off"))?;
    let next = chosen::<global_sto::Monitor>(mutant);
    Ok(Adapter::new(
        &["ss0", "others_off"],
        &["on"],
        vec![truth(), upto(p.value("t_off"))],
        global_sto::State::INITIAL,
        move |state, i, o| {
            let inputs = global_sto::Inputs {
                ss0: i[0] != 0,
                others_off: i[1] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.push(bit(out.on));
            after
        },
    ))
}

fn judge(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = judge::Config::new(kind(p.value("kind")), p.is("som_4"))?;
    let next = chosen::<judge::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "main_switch",
            "request",
            "stop_request",
            "bad_code",
            "state",
            "moving",
            "unit",
            "permissive",
            "idle",
            "gen_safe",
            "untested",
        ],
        &[
            "asks_ss1f",
            "asks_ss1",
            "asks_ss1d",
            "asks_ss2",
            "stops_axes",
            "demand",
        ],
        vec![upto(2), upto(2)],
        judge::State::INITIAL,
        move |state, i, o| {
            let inputs = judge::Inputs {
                main_switch: i[0] != 0,
                request: numbers::state(i[1]),
                stop_request: stop(i[2]),
                bad_code: i[3] != 0,
                state: numbers::state(i[4]),
                moving: i[5] != 0,
                unit: unit(i[6]),
                permissive: i[7] != 0,
                idle: i[8] != 0,
                gen_safe: i[9] != 0,
                untested: i[10] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.asks_ss1f),
                bit(out.asks_ss1),
                bit(out.asks_ss1d),
                bit(out.asks_ss2),
                bit(out.stops_axes),
                stop_rank(out.demand),
            ]);
            after
        },
    )
    // There is no code for SS0.
    .only(&["stop_request"], Values::List(&[0, 1, 2, 3, 4])))
}

fn group(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = group::Config::new(kind(p.value("kind")))?;
    let next = chosen::<group::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "main_switch",
            "request",
            "activate",
            "moving",
            "gen_safe",
            "demand",
            "phase",
            "soft",
            "ss2_ended",
            "switch_on",
            "spindle_stop",
        ],
        &["state", "with_2", "with_3", "with_4", "may_move"],
        vec![upto(7), upto(7)],
        group::State::INITIAL,
        move |state, i, o| {
            let inputs = group::Inputs {
                main_switch: i[0] != 0,
                request: numbers::state(i[1]),
                activate: i[2] != 0,
                moving: i[3] != 0,
                gen_safe: i[4] != 0,
                demand: stop(i[5]),
                phase: phase(i[6]),
                soft: i[7] != 0,
                ss2_ended: i[8] != 0,
                switch_on: i[9] != 0,
                spindle_stop: i[10] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                state_rank(out.state),
                bit(out.left.sls_2),
                bit(out.left.sls_3),
                bit(out.left.sls_4),
                bit(out.may_move),
            ]);
            after
        },
    ))
}

fn startup(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = startup::Config::new(p.time("t_idle"))?;
    let next = chosen::<startup::Monitor>(mutant);
    Ok(Adapter::new(
        &["limited", "moving", "unit", "permissive"],
        &["idle"],
        vec![upto(p.value("t_idle"))],
        startup::State::INITIAL,
        move |state, i, o| {
            let inputs = startup::Inputs {
                limited: i[0] != 0,
                moving: i[1] != 0,
                unit: unit(i[2]),
                permissive: i[3] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.push(bit(out.idle));
            after
        },
    ))
}

fn axis_release(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = axis_release::Config::new(p.time("t_ss2"))?;
    let next = chosen::<axis_release::Monitor>(mutant);
    Ok(Adapter::new(
        &["group_released", "feed", "moving"],
        &["mode", "asks_ss1", "stands"],
        vec![upto(2), upto(p.value("t_ss2").max(1))],
        axis_release::State::INITIAL,
        move |state, i, o| {
            let inputs = axis_release::Inputs {
                group_released: i[0] != 0,
                feed: i[1] != 0,
                moving: i[2] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(&axis_release::Mode::ALL, out.mode),
                bit(out.asks_ss1),
                bit(out.stands),
            ]);
            after
        },
    ))
}
