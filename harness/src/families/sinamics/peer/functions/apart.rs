//! The monitors of the functions that are driven otherwise than their tables.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::{ConfigError, Cycles, Distance, Percent, Position, Speed};
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinamics::{
    brake_test, drive_test, path_test, safe_position, setpoint_limit, sls_ramp,
};

use super::same::{first, response, sbr_config};
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::cells::{load, store, stored};
use crate::diff::peer::numbers::{bit, small, truth, upto};
use crate::diff::peer::same::Same;
use crate::diff::peer::{Made, Params, Refusable, chosen};
use crate::diff::product::Values;

/// The machines of these tables, each with the module of its monitor; one table has two of them.
pub(super) const MACHINES: &[(&str, &str)] = &[
    ("setpoint_limit", "setpoint_limit"),
    ("drive_test", "drive_test"),
    ("drive_test", "path_test"),
    ("sbt", "brake_test"),
    ("sp", "safe_position"),
];

/// SLS and the ramp that leads to its lower limit.
pub(super) const SYSTEMS: &[(&str, &str)] = &[("ramped_channel", "sls_ramp")];

/// The monitor of a machine or of that system.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "setpoint_limit" => setpoint_limit(p, mutant)?,
        "drive_test" => drive_test(p, mutant)?,
        "sbt" => brake_test(p, mutant)?,
        "sp" => safe_position(p, mutant)?,
        "ramped_channel" => sls_ramp(p, mutant)?,
        _ => return Ok(None),
    }))
}

/// The table has the limits of all levels and a spindle, the monitor the limit that is selected and one quotient.
fn setpoint_limit(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let limits = ["v_1", "v_2", "v_3", "v_4"].map(|name| p.speed(name));
    let pitch = if p.is("spindle") { p.value("pitch") } else { 1 };
    let quotient = |value: i32| u16::try_from(value).map_err(|_| ConfigError::FactorOutOfRange);
    let config = setpoint_limit::Config::new(
        Percent::new(small(p.value("weight")))?,
        quotient(p.value("den"))?,
        quotient(p.value("num").saturating_mul(pitch))?,
        false,
    )?;
    let next = chosen::<setpoint_limit::Monitor>(mutant);
    Ok(Adapter::stateless(
        &["sls", "level", "up", "down", "acceptance"],
        &["positive", "negative", "absolute"],
        move |i, o| {
            let inputs = setpoint_limit::Inputs {
                sls: i[0] != 0,
                limit: limits[i[1].clamp(0, 3) as usize],
                sdi_positive: i[2] != 0,
                sdi_negative: i[3] != 0,
                acceptance: i[4] != 0,
                stop_f: false,
            };
            let said = next(setpoint_limit::State, &config, &inputs).1;
            // No limit is the greatest number of the parameter.
            let shown = |speed: Speed| i64::from(speed.0.min(i32::MAX as u32));
            o.extend([
                shown(said.positive),
                -shown(said.negative),
                shown(said.absolute),
            ]);
        },
    ))
}

/// The table tests the paths for the Extended and the Basic Functions, the monitors are two.
fn drive_test(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let (t_due, t_basic, t_off) = (p.time("t_due"), p.time("t_basic"), p.time("t_off"));
    let config = drive_test::Config::new(t_due, t_off, p.is("automatic"))?;
    let basic = path_test::Config::new(t_basic)?;
    let output = p.is("output");
    let next = chosen::<drive_test::Monitor>(mutant);
    let next_basic = chosen::<path_test::Monitor>(mutant);
    let own = stored(drive_test::State::INITIAL);
    let split = own.len();
    let step = move |cells: &mut [i32], i: &[i32], o: &mut Vec<i64>| {
        let (first, second) = cells.split_at_mut(split);
        let inputs = drive_test::Inputs {
            power_on: i[0] != 0,
            request: i[1] != 0,
            stop: i[2] != 0 || i[3] != 0,
            allowed: i[4] != 0,
            pulses_off: i[5] != 0,
            path_error: i[6] != 0,
            disturbed: i[7] != 0,
        };
        let (after, said) = next(load(first), &config, &inputs);
        store(after, first);
        let inputs = path_test::Inputs {
            power_on: i[0] != 0,
            selected: i[2] != 0,
            test_stop: said.sto,
            passed: said.passed,
            activated: false,
            path_error: i[6] != 0,
            extended_sto: said.sto,
        };
        let (rest, told) = next_basic(load(second), &basic, &inputs);
        store(rest, second);
        let phase = match after.phase {
            drive_test::Phase::Idle => 0,
            drive_test::Phase::Retry => 1,
            drive_test::Phase::Running => 2,
        };
        o.extend([
            bit(said.sto),
            bit(said.due),
            bit(said.passed),
            bit(said.failed),
            i64::from(after.left.count()),
            i64::from(after.pulses_left.count()),
            bit(after.by_itself),
            phase,
            bit(said.sto && output),
            bit(told.due),
            i64::from(told.left.count()),
            bit(told.tested),
            bit(told.failed),
            bit(told.terminals_checked),
        ]);
    };
    Ok(Adapter::of(
        vec![
            "power_on", "request", "selected", "stop", "enabled", "off", "error", "trouble",
        ],
        vec![
            "testing",
            "due",
            "passed",
            "failed",
            "left",
            "rest",
            "by_itself",
            "phase",
            "output_test",
            "due_basic",
            "left_basic",
            "tested",
            "path_failed",
            "compares",
        ],
        vec![
            upto(2),
            truth(),
            truth(),
            upto(p.value("t_due")),
            upto(p.value("t_off")),
            truth(),
            upto(p.value("t_basic")),
            truth(),
        ],
        [own, stored(path_test::State::INITIAL)].concat(),
        step,
    ))
}

/// Brake 1 is that of the motor, brake 2 an external one. The table is told that the axis has moved, the monitor where it is.
fn brake_test(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let sequence = |duration| brake_test::Sequence {
        duration,
        tolerance: Distance(1),
    };
    let brake = |kind| brake_test::Brake {
        kind,
        ramp: p.time("t_ramp"),
        first: sequence(p.time("t_hold_1")),
        second: sequence(p.time("t_hold_2")),
    };
    // In the table the brake of the motor takes a cycle.
    let config = brake_test::Config::new(
        brake(brake_test::Kind::Motor),
        brake(brake_test::Kind::External),
        p.time("t_brake"),
        Cycles::new(1),
        Cycles::new(1),
    )?;
    let next = chosen::<brake_test::Monitor>(mutant);
    let longest = ["t_brake", "t_ramp", "t_hold_1", "t_hold_2"].map(|name| p.value(name));
    Ok(Adapter::new(
        &[
            "select", "start", "second", "minus", "other", "closed", "allowed", "slow", "higher",
            "known", "moved",
        ],
        &[
            "selected",
            "ready_now",
            "running",
            "good",
            "done",
            "closes_1",
            "closes_2",
            "press",
            "pulls",
            "rejects",
            "breaks",
            "late",
        ],
        vec![
            upto(9),
            upto(longest.into_iter().fold(1, i32::max)),
            truth(),
            truth(),
            truth(),
            Domain { lo: 0, hi: 2 },
            truth(),
            truth(),
            truth(),
        ],
        brake_test::State::INITIAL,
        move |state: brake_test::State, i, o| {
            let moved = state.phase.torque() && i[10] != 0;
            let inputs = brake_test::Inputs {
                select: i[0] != 0,
                start: i[1] != 0,
                choice: brake_test::Choice {
                    second_brake: i[2] != 0,
                    negative: i[3] != 0,
                    second_sequence: i[4] != 0,
                },
                external_closed: i[5] != 0,
                pulses: i[6] != 0,
                slow: i[7] != 0,
                stop: i[8] != 0,
                load_known: i[9] != 0,
                position: Position(state.begin.0 + if moved { 2 } else { 0 }),
            };
            let (after, said) = next(state, &config, &inputs);
            o.extend([
                bit(said.selected),
                bit(said.ready),
                bit(said.runs),
                bit(said.successful),
                bit(said.complete),
                bit(said.close_motor),
                bit(said.close_external),
                bit(said.torque),
                bit(said.torque && after.choice.negative),
                bit(said.refused),
                bit(said.interrupted),
                bit(said.late),
            ]);
            after
        },
    )
    .without(&["load"]))
}

/// The counter of the table has any period: its last value is the last one of the monitor's.
fn safe_position(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let scale = u16::try_from(p.value("scale")).map_err(|_| ConfigError::FactorOutOfRange)?;
    let config =
        safe_position::Config::new(p.is("enabled"), p.is("absolute"), p.is("short"), scale)?;
    let last = p.value("period") - 1;
    let next = chosen::<safe_position::Monitor>(mutant);
    let step = move |cells: &mut [i32], i: &[i32], o: &mut Vec<i64>| {
        let cycle = if cells[0] == last {
            u16::MAX
        } else {
            cells[0] as u16
        };
        let inputs = safe_position::Inputs {
            first: Position(i[0]),
            second: Position(i[1]),
            valid: i[2] != 0,
            referenced: i[3] != 0,
        };
        let (after, said) = next(safe_position::State { cycle }, &config, &inputs);
        cells[0] = i32::from(after.cycle);
        o.extend([
            bit(said.valid),
            bit(said.valid),
            i64::from(said.short),
            i64::from(said.long),
            bit(said.too_wide),
            i64::from(after.cycle),
        ]);
    };
    Ok(Adapter::of(
        vec!["pos_1", "pos_2", "found", "safe"],
        vec!["bit", "valid", "x16", "x32", "wide", "count"],
        vec![upto(last)],
        stored(safe_position::State::INITIAL),
        step,
    )
    .explored(
        &["pos_1", "pos_2"],
        Values::List(&[-32_769, -3, 0, 2, 32_768]),
    ))
}

/// The table has two levels with one stop, A or B, and no speed below the resolution.
fn sls_ramp(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let (higher, lower, stop) = (p.speed("v_1"), p.speed("v_2"), response(p, "code")?);
    let limits = [higher, lower, lower, lower];
    let delay = upto(p.value("t_delay").max(2));
    Same::<sls_ramp::Monitor>::new(p, mutant)
        .config(sls_ramp::Config::new(
            limits,
            [stop; 4],
            sbr_config(p)?,
            false,
        )?)
        .constants(&[("telegram", 0)])
        .made("level", &["second"], first)
        .named(&[
            ("n", "speed"),
            ("act", "active"),
            ("off3", "braking"),
            ("above", "outputs.violated"),
            ("violated", "ramp_violated"),
        ])
        .cell("ramp.left", delay)
        .cell("ramp.ramp", upto(p.value("n_top").max(p.value("n_ref"))))
        .cell("ramp.rest", upto(p.value("t_ref") - 1))
        .cell("settling", delay)
        .hidden(&[
            "outputs.level",
            "outputs.limit",
            "wrong_value",
            "now",
            "next",
            "state.ramp",
        ])
        .told("phase", |state, _| match (state.now, state.next) {
            (_, Some(_)) => 1,
            (Some(_), None) => 2,
            (None, None) => 0,
        })
        .peer()
}
