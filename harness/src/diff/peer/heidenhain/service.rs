//! Referencing, outputs, self-test.

use stillpoint_monitors::heidenhain::reference::AxisRef;
use stillpoint_monitors::heidenhain::{
    acceptance, agreement, brakes, cut_out, holding_brake, reference, self_test, tool_holder,
};
use stillpoint_monitors::mutant::Mutant;

use super::numbers::*;
use crate::diff::peer::adapter::{Adapter, cells};
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "reference" => reference(p, mutant)?,
        "agreement" => agreement(p, mutant)?,
        "brakes" => brakes(mutant),
        "tool_holder" => tool_holder(mutant),
        "acceptance" => acceptance(p, mutant)?,
        "self_test" => self_test(p, mutant)?,
        "cut_out" => cut_out(p, mutant)?,
        "holding_brake" => holding_brake(p, mutant)?,
        _ => return Ok(None),
    }))
}

fn count(cell: i32) -> u16 {
    u16::try_from(cell).unwrap_or(0)
}

cells! {
    cut_out::State, 3 {
        step = |c| value(&cut_out::Phase::ALL, c), |s| ordinal(&cut_out::Phase::ALL, s);
        timer = cycles, cell;
        ask = truthy, i32::from;
    }
    holding_brake::State, 1 {
        step = |c| value(&holding_brake::Phase::ALL, c), |s| ordinal(&holding_brake::Phase::ALL, s);
    }
    reference::State, 2 {
        axis = |c| value(&AxisRef::ALL, c), |a| ordinal(&AxisRef::ALL, a);
        saved = truthy, i32::from;
    }
    agreement::State, 1 {
        cycles = cycles, cell;
    }
    tool_holder::State, 2 {
        open = truthy, i32::from;
        asked = truthy, i32::from;
    }
    acceptance::State, 2 {
        phase = |c| value(&acceptance::Phase::ALL, c), |p| ordinal(&acceptance::Phase::ALL, p);
        open = count, i32::from;
    }
    self_test::State, 3 {
        phase = |c| value(&self_test::Phase::ALL, c), |p| ordinal(&self_test::Phase::ALL, p);
        repeated = truthy, i32::from;
        rest = cycles, cell;
    }
}

fn reference(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = reference::Config::new(p.is("safe_axis"))?;
    let next = chosen::<reference::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "check_cause",
            "homed",
            "own_matches",
            "peer_matches",
            "own_at_mark",
            "peer_at_mark",
            "confirm",
            "som",
            "unit",
            "door_open",
            "moving",
            "peer_checked",
        ],
        &["ax_safe", "checked", "may_move", "untested", "ref"],
        vec![upto(3), truth()],
        reference::State::INITIAL,
        move |state, i, o| {
            let inputs = reference::Inputs {
                power_on: i[0] != 0,
                check_cause: i[1] != 0,
                homed: i[2] != 0,
                own_matches: i[3] != 0,
                peer_matches: i[4] != 0,
                own_at_mark: i[5] != 0,
                peer_at_mark: i[6] != 0,
                confirm: i[7] != 0,
                som: som(i[8]),
                unit: unit(i[9]),
                door_open: i[10] != 0,
                moving: i[11] != 0,
                peer_checked: i[12] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.ax_safe),
                bit(out.checked),
                bit(out.may_move),
                bit(out.untested),
                rank(&AxisRef::ALL, after.axis),
            ]);
            after
        },
    )
    .kept(1, "saved"))
}

fn agreement(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = agreement::Config::new(p.time("window"))?;
    let config = if p.is("fatal") {
        config.fatal()
    } else {
        config
    };
    let next = chosen::<agreement::Monitor>(mutant);
    Ok(Adapter::new(
        &["differ"],
        &["fault", "demand"],
        vec![upto(p.value("window"))],
        agreement::State::INITIAL,
        move |state, i, o| {
            let inputs = agreement::Inputs { differ: i[0] != 0 };
            let (after, out) = next(state, &config, &inputs);
            o.extend([bit(out.fault), stop_rank(out.demand)]);
            after
        },
    ))
}

fn brakes(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<brakes::Monitor>(mutant);
    Adapter::stateless(
        &[
            "test",
            "release_1",
            "release_2",
            "release_3",
            "drive_1",
            "drive_2",
            "drive_3",
        ],
        &["own", "collected"],
        move |i, o| {
            let axis = |k: usize| brakes::Axis {
                release: i[k] != 0,
                drive: i[k + 3] != 0,
            };
            let inputs = brakes::Inputs {
                test: i[0] != 0,
                own: axis(1),
                shared: [axis(2), axis(3)],
            };
            let (_, out) = next(brakes::State::INITIAL, &brakes::Config, &inputs);
            o.extend([bit(out.own), bit(out.collected)]);
        },
    )
}

fn tool_holder(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<tool_holder::Monitor>(mutant);
    Adapter::new(
        &["request", "door_open", "moving", "state"],
        &["open", "no_torque"],
        vec![truth(), truth()],
        tool_holder::State::INITIAL,
        move |before, i, o| {
            let inputs = tool_holder::Inputs {
                request: i[0] != 0,
                door_open: i[1] != 0,
                moving: i[2] != 0,
                state: state(i[3]),
            };
            let (after, out) = next(before, &tool_holder::Config, &inputs);
            o.extend([bit(out.open), bit(out.no_torque)]);
            after
        },
    )
}

fn acceptance(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = acceptance::Config::new(count(p.value("most")))?;
    let next = chosen::<acceptance::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "boot",
            "matches",
            "changes",
            "password",
            "cancel",
            "permissive",
        ],
        &["in_service", "demand", "accepted"],
        vec![upto(3), upto(p.value("most"))],
        acceptance::State::INITIAL,
        move |state, i, o| {
            let inputs = acceptance::Inputs {
                boot: i[0] != 0,
                matches: i[1] != 0,
                changes: count(i[2]),
                password: i[3] != 0,
                cancel: i[4] != 0,
                permissive: i[5] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.in_service),
                stop_rank(out.demand),
                rank(&acceptance::Phase::ALL, after.phase),
            ]);
            after
        },
    ))
}

fn self_test(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = self_test::Config::new(
        p.time("interval"),
        p.is("doors_free"),
        p.is("no_control"),
        p.is("cc"),
    )?;
    let next = chosen::<self_test::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "start",
            "configured",
            "done",
            "fault",
            "es_closed",
            "cvo",
            "keys_free",
            "doors_shut",
            "omitted",
            "brake_good",
        ],
        &[
            "gen_safe",
            "running",
            "brake_test",
            "path_only",
            "ask_voltage",
            "cut_out_done",
            "demand",
            "step",
        ],
        vec![upto(13), truth(), upto(p.value("interval"))],
        self_test::State::INITIAL,
        move |state, i, o| {
            let inputs = self_test::Inputs {
                power_on: i[0] != 0,
                start: i[1] != 0,
                configured: i[2] != 0,
                done: i[3] != 0,
                fault: i[4] != 0,
                es_closed: i[5] != 0,
                cvo: i[6] != 0,
                keys_free: i[7] != 0,
                doors_shut: i[8] != 0,
                omitted: i[9] != 0,
                brake_good: i[10] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.gen_safe),
                bit(out.running),
                bit(out.brake_test),
                bit(out.path_only),
                bit(out.ask_voltage),
                bit(out.cut_out_done),
                stop_rank(out.demand),
                rank(&self_test::Phase::ALL, after.phase),
            ]);
            after
        },
    ))
}

fn cut_out(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = cut_out::Config::new(
        p.time("t_relay"),
        p.time("t_ready"),
        p.time("t_off"),
        p.is("no_control"),
        p.is("no_outputs"),
    )?;
    let next = chosen::<cut_out::Monitor>(mutant);
    let longest = p
        .value("t_relay")
        .max(p.value("t_ready"))
        .max(p.value("t_off"));
    Ok(Adapter::new(
        &[
            "power_on", "start", "t_brk", "chain", "ready", "outputs", "moved",
        ],
        &[
            "step",
            "brake_a",
            "brake_b",
            "sto_a_g",
            "stos_a_g",
            "on_mc",
            "on_cc",
            "watch_mc",
            "watch_cc",
            "ask_place",
            "done",
            "fault",
            "tested",
            "others",
        ],
        vec![upto(11), upto(longest), truth()],
        cut_out::State::INITIAL,
        move |state, i, o| {
            let inputs = cut_out::Inputs {
                power_on: i[0] != 0,
                start: i[1] != 0,
                t_brk: i[2] != 0,
                chain: i[3] != 0,
                ready: i[4] != 0,
                outputs: i[5] != 0,
                moved: i[6] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(&cut_out::Phase::ALL, out.step),
                bit(out.brake_a),
                bit(out.brake_b),
                bit(out.sto_a_g),
                bit(out.stos_a_g),
                bit(out.on_mc),
                bit(out.on_cc),
                bit(out.watch_mc),
                bit(out.watch_cc),
                bit(out.ask_place),
                bit(out.done),
                bit(out.fault),
                stop_rank(out.tested),
                stop_rank(out.others),
            ]);
            after
        },
    ))
}

fn holding_brake(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = holding_brake::Config::new(count(p.value("factor")))?;
    let next = chosen::<holding_brake::Monitor>(mutant);
    Ok(Adapter::new(
        &["start", "done", "too_far", "current", "safe_now"],
        &["hold", "closed", "controlled", "passed"],
        vec![upto(7)],
        holding_brake::State::INITIAL,
        move |state, i, o| {
            let inputs = holding_brake::Inputs {
                start: i[0] != 0,
                done: i[1] != 0,
                too_far: i[2] != 0,
                current: i[3] != 0,
                safe_now: i[4] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(&holding_brake::Phase::ALL, out.step),
                bit(out.closed),
                bit(out.controlled),
                bit(out.passed),
            ]);
            after
        },
    ))
}
