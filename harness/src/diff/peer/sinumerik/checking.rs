//! Tests of the shutdown paths, pulse cancellation, cross comparison, slip, stored position, forced checking.

use stillpoint_model::Domain;
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::{
    compare, forced_check, history, path_test, pulses, shutdown_test, slip, test_stop,
};

use super::numbers::{PULSES, bit, distance, ordinal, rank, truth, upto};
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, Refusal, chosen};
use crate::diff::product::Values;

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "test" => test(p, mutant)?,
        "shutdown_test" => shutdown_test(p, mutant)?,
        "pulses" => pulses(p, mutant)?,
        "compare" => compare(p, mutant)?,
        "slip" => slip(p, mutant)?,
        "history" => history(p, mutant)?,
        "test_interval" => test_interval(p, mutant)?,
        _ => return Ok(None),
    }))
}

fn test_cells(p: &Params) -> Vec<Domain> {
    vec![upto(2), upto(p.value("t_chk")), truth()]
}

fn test_inputs(i: &[i32]) -> path_test::Inputs {
    path_test::Inputs {
        power_on: i[0] != 0,
        select: i[1] != 0,
        pulses_cancelled: i[2] != 0,
        internal_ab: i[3] != 0,
    }
}

fn test(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = test_stop::Config::new(p.time("t_chk"))?;
    let next = chosen::<test_stop::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "select", "pulses_cancelled", "internal_ab"],
        &["active", "demand", "refused", "code", "passed", "message"],
        test_cells(p),
        path_test::State::INITIAL,
        move |state, i, o| {
            let (after, out) = next(state, &config, &test_inputs(i));
            o.extend([
                bit(out.active),
                rank(out.demand.level()),
                bit(out.refused),
                i64::from(out.code.number()),
                bit(out.passed),
                bit(out.active),
            ]);
            after
        },
    )
    .without(&["external_a", "standstill"]))
}

fn shutdown_test(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = shutdown_test::Config::new(p.time("t_chk"))?;
    let next = chosen::<shutdown_test::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "select", "pulses_cancelled", "internal_ab"],
        &[
            "active",
            "enable_external",
            "demand",
            "code",
            "passed",
            "message",
        ],
        test_cells(p),
        path_test::State::INITIAL,
        move |state, i, o| {
            let (after, out) = next(state, &config, &test_inputs(i));
            o.extend([
                bit(out.active),
                bit(out.enable_external),
                rank(out.demand.level()),
                i64::from(out.code.number()),
                bit(out.passed),
                bit(out.active),
            ]);
            after
        },
    ))
}

fn pulses(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = pulses::Config::new(p.is("internal"), true, p.time("t_chk"))?;
    let next = chosen::<pulses::Monitor>(mutant);
    Ok(Adapter::new(
        &["power_on", "run_up", "cancel", "external_test", "feedback"],
        &["enable", "enable_external", "phase"],
        vec![upto(3), upto(p.value("t_chk"))],
        pulses::State::INITIAL,
        move |state, i, o| {
            let inputs = pulses::Inputs {
                power_on: i[0] != 0,
                run_up: i[1] != 0,
                cancel: i[2] != 0,
                external_test: i[3] != 0,
                feedback: i[4] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.enable),
                bit(out.enable_external),
                i64::from(ordinal(&PULSES, after.phase)),
            ]);
            after
        },
    ))
}

fn compare(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = compare::Config::new(p.time("t_chg"), &compare::list::CLASSES)?;
    let next = chosen::<compare::Monitor>(mutant);
    let t_chg = p.value("t_chg");
    Ok(Adapter::new(
        &[
            "power_on",
            "change",
            "other_changing",
            "diff_1",
            "diff_2",
            "diff_3",
            "diff_4",
            "diff_5",
            "diff_6",
        ],
        &["discrepancy", "code", "changing", "suspended"],
        vec![
            upto(5),
            upto(t_chg),
            upto(t_chg.saturating_mul(10)),
            truth(),
        ],
        compare::State::INITIAL,
        move |state, i, o| {
            // The other channel presents whatever the monitor says is due.
            let due = state.due(&config, i[0] != 0);
            let class = compare::list::CLASSES.iter().position(|item| *item == due);
            let inputs = compare::Inputs {
                power_on: i[0] != 0,
                change: i[1] != 0,
                other_changing: i[2] != 0,
                differs: class.is_some_and(|class| i[3 + class] != 0),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.discrepancy),
                i64::from(out.code.number()),
                bit(out.changing),
                bit(out.suspended),
            ]);
            after
        },
    ))
}

fn slip(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = slip::Config::new(
        distance(p.value("dead")),
        distance(p.value("tol")),
        true,
        false,
    )?;
    let next = chosen::<slip::Monitor>(mutant);
    let (most, far) = (p.value("off_max"), p.value("pos_max"));
    let offsets = Domain {
        lo: -most,
        hi: most,
    };
    // The table bounds the correction, the monitor does not: positions of the other channel that stay clear of it.
    let near = most.saturating_sub(far);
    if near < far {
        return Err(Refusal::Table("off_max must be at least 2 * pos_max"));
    }
    Ok(Adapter::new(
        &["power_on", "due", "own", "other"],
        &["position", "error"],
        vec![offsets],
        slip::State::INITIAL,
        move |state, i, o| {
            let inputs = slip::Inputs {
                power_on: i[0] != 0,
                due: i[1] != 0,
                own: Position(i[2]),
                other: Position(i[3]),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([i64::from(out.position.0), bit(out.error)]);
            after
        },
    )
    .only(&["other"], Values::Range(-near, near)))
}

fn history(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = history::Config::new(distance(p.value("tol")))?;
    let next = chosen::<history::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "save",
            "position",
            "reached",
            "refpos",
            "travelled",
        ],
        &["exists", "history_ok"],
        vec![truth(), upto(p.value("pos_max"))],
        history::State::INITIAL,
        move |state, i, o| {
            let inputs = history::Inputs {
                power_on: i[0] != 0,
                save: i[1] != 0,
                position: Position(i[2]),
                reached: i[3] != 0,
                refpos: Position(i[4]),
                travelled: i[5],
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([bit(out.stored), bit(out.history_ok)]);
            after
        },
    )
    .without(&["save_sge"])
    .kept(0, "stored")
    // The table may start with a position that is not stored, which nothing reads; the monitor then has none.
    .kept_where(1, "standstill", "stored"))
}

fn test_interval(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = forced_check::Config::new(p.time("interval"))?;
    let next = chosen::<forced_check::Monitor>(mutant);
    let rest = upto(p.value("interval"));
    Ok(Adapter::new(
        &["power_on", "passed_drive", "passed_nck", "failed"],
        &["due", "half", "tested"],
        vec![rest, rest],
        forced_check::State::INITIAL,
        move |state, i, o| {
            let inputs = forced_check::Inputs {
                power_on: i[0] != 0,
                passed_drive: i[1] != 0,
                passed_nck: i[2] != 0,
                failed: i[3] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([bit(out.due), bit(out.half), bit(out.tested)]);
            after
        },
    ))
}
