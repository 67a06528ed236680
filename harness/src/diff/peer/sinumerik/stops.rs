//! External stops, STOP F, the arbitration of stops and their effect on other axes.

use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::{external, fault, group, stop};

use super::numbers::*;
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "external" => external(p, mutant)?,
        "fault" => fault(p, mutant)?,
        "stop" => stop(p, mutant)?,
        "group" => group(p, mutant),
        _ => return Ok(None),
    }))
}

pub(super) fn external_config(
    p: &Params,
) -> Result<external::Config, stillpoint_monitors::kernel::ConfigError> {
    external::Config::new(p.is("enable_ext"), p.is("enable_e"), p.is("spl_stop_e"))
}

fn external(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = external_config(p)?;
    let next = chosen::<external::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "reset",
            "spl_started",
            "sge_a",
            "sge_c",
            "sge_d",
            "sge_e",
            "spl_error",
        ],
        &["request", "selected", "spl_stop"],
        vec![truth(), truth()],
        external::State::INITIAL,
        move |state, i, o| {
            let inputs = external::Inputs {
                power_on: i[0] != 0,
                reset: i[1] != 0,
                spl_started: i[2] != 0,
                sge_a: i[3] != 0,
                sge_c: i[4] != 0,
                sge_d: i[5] != 0,
                sge_e: i[6] != 0,
                spl_error: i[7] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(out.request.level()),
                rank(out.selected.level()),
                bit(out.spl_stop),
            ]);
            after
        },
    ))
}

fn fault(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = fault::Config::new(p.time("t_f"))?;
    let next = chosen::<fault::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "reset",
            "discrepancy",
            "rx_fault",
            "monitoring",
            "cde_before",
            "ab_before",
        ],
        &["fault", "alarm", "stop_b", "bit1", "interlock"],
        vec![upto(3), upto(p.value("t_f"))],
        fault::State::INITIAL,
        move |state, i, o| {
            let inputs = fault::Inputs {
                power_on: i[0] != 0,
                reset: i[1] != 0,
                discrepancy: i[2] != 0,
                rx_fault: i[3] != 0,
                monitoring: i[4] != 0,
                cde_before: i[5] != 0,
                ab_before: i[6] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                i64::from(ordinal(&FAULTS, out.fault)),
                bit(out.alarm),
                bit(out.stop_b),
                bit(out.bit1),
                bit(out.interlock),
            ]);
            after
        },
    ))
}

/// The longest of the times of the stops.
pub(super) fn longest(p: &Params) -> i32 {
    let times = ["t_b", "t_c", "t_d", "t_e"].map(|name| p.value(name));
    times.into_iter().max().unwrap_or(0)
}

pub(super) fn stop_config(
    p: &Params,
) -> Result<stop::Config, stillpoint_monitors::kernel::ConfigError> {
    stop::Config::new(p.time("t_b"), p.time("t_c"), p.time("t_d"), p.time("t_e"))
}

fn stop(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = stop_config(p)?;
    let next = chosen::<stop::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "reset",
            "demand",
            "f_stop_b",
            "rx_internal",
            "external",
            "rx_external",
            "test",
            "standstill",
            "fault",
            "external_test",
        ],
        &[
            "level",
            "internal",
            "phase",
            "cancel_pulses",
            "n_set_zero",
            "path_brake",
            "esr",
            "sbh_internal",
            "sga_stop_ab",
            "sga_stop_c",
            "sga_stop_d",
            "sga_stop_e",
            "sbr_on",
            "sequence_over",
            "start_inhibit",
            "stopsi",
        ],
        vec![upto(7), upto(7), upto(7), upto(5), upto(longest(p))],
        stop::State::INITIAL,
        move |state, i, o| {
            let inputs = stop::Inputs {
                power_on: i[0] != 0,
                reset: i[1] != 0,
                demand: internal(i[2]),
                f_stop_b: i[3] != 0,
                rx_internal: internal(i[4]),
                external: external_stop(i[5]),
                rx_external: external_stop(i[6]),
                test: i[7] != 0,
                standstill: i[8] != 0,
                fault: i[9] != 0,
                external_test: i[10] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(out.level),
                rank(out.internal.level()),
                i64::from(ordinal(&STOPS, out.phase)),
                bit(out.cancel_pulses),
                bit(out.n_set_zero),
                bit(out.path_brake),
                bit(out.esr),
                bit(out.sbh_internal),
                bit(out.sga_stop_ab),
                bit(out.sga_stop_c),
                bit(out.sga_stop_d),
                bit(out.sga_stop_e),
                bit(out.sbr_on),
                bit(out.ended),
                bit(out.start_inhibit),
                i64::from(out.stopsi),
            ]);
            after
        },
    )
    .only(&["demand", "rx_internal"], INTERNAL)
    .only(&["external", "rx_external"], EXTERNAL))
}

/// The table asks for one axis what two others do to it; the monitor is asked once for each, the higher answer counts.
fn group(p: &Params, mutant: Option<Mutant>) -> Adapter {
    let esr = p.is("esr_active");
    let next = chosen::<group::Monitor>(mutant);
    Adapter::stateless(
        &[
            "stop_1",
            "internal_1",
            "group_1",
            "together_1",
            "stop_2",
            "internal_2",
            "group_2",
            "together_2",
        ],
        &["reaction"],
        move |i, o| {
            let reach = |k: usize| match i[k] {
                0 => group::Reach::Channel,
                _ => group::Reach::Interpolating,
            };
            let of = |first: usize| {
                let inputs = group::Inputs {
                    level: level(i[first]),
                    internal: internal(i[first + 1]),
                    interpolates: i[first + 3] != 0,
                    esr,
                };
                let config = group::Config::new(reach(first + 2));
                next(group::State::INITIAL, &config, &inputs).1.reaction
            };
            let worst = group::worst(&[of(0), of(4)]);
            o.push(i64::from(ordinal(&group::Reaction::ALL, worst)));
        },
    )
    .only(&["internal_1", "internal_2"], INTERNAL)
}
