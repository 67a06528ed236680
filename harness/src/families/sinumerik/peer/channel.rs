//! The monitors of one channel together.

use stillpoint_monitors::kernel::{ConfigError, Position};

use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::sinumerik::level::{ExternalStop, InternalStop};
use stillpoint_monitors::sinumerik::{
    channel, external, fault, pulses, ramp, standstill, stop, test_stop, threshold,
};

use super::numbers::*;
use super::same::{limit_switch_config, selection_config, speed_config};
use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusable, Refusal, chosen};

/// The monitors of a system of this topic.
pub(super) fn make(system: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    match system {
        "axis_core" => Ok(Some(core(p, mutant)?)),
        _ => Ok(None),
    }
}

fn config(p: &Params) -> Result<channel::Config, ConfigError> {
    Ok(channel::Config {
        external: external::Config::new(p.is("enable_ext"), p.is("enable_e"), p.is("spl_stop_e"))?,
        test: test_stop::Config::new(p.time("t_chk"))?,
        selection: selection_config(p)?,
        standstill: standstill::Config::new(distance(p.value("sbh_tol")))?,
        speed: speed_config(p, "sg_mode")?,
        limit_switch: limit_switch_config(p, "se", "se_mode")?,
        ramp: ramp::Config::new(p.speed("velo_x"), p.speed("ramp_tol"))?,
        threshold: threshold::Config::new(p.speed("velo_x"))?,
        fault: fault::Config::new(p.time("t_f"))?,
        stop: stop::Config::new(p.time("t_b"), p.time("t_c"), p.time("t_d"), p.time("t_e"))?,
        pulses: pulses::Config::new(p.is("internal"), true, p.time("t_chk"))?,
        standstill_speed: p.speed("velo_tol"),
        se_sn_enabled: p.is("se") || p.is("sn"),
    })
}

/// One channel against system `axis_core`. What the system leaves out (terminals that are not wired, the test, the other
/// channel) is left out here in the same way.
fn core(p: &Params, mutant: Option<Mutant>) -> Refusable {
    if p.value("v_max") < p.value("pos_max") {
        return Err(Refusal::Table("v_max must be at least pos_max"));
    }
    let config = config(p)?;
    let next = chosen::<channel::Monitor>(mutant);
    let times = ["t_b", "t_c", "t_d", "t_e"].map(|name| p.value(name));
    let longest = times.into_iter().max().unwrap_or(0);
    let (use_c, use_d) = (p.is("use_c"), p.is("use_d"));
    let (tested, peer) = (p.is("tested"), p.is("peer"));
    let (factor_cell, position) = (upto(p.value("over_max")), upto(p.value("pos_max")));
    let (t_chk, t_vel) = (upto(p.value("t_chk")), upto(p.value("t_vel")));
    let domains = [
        vec![truth(), truth()],
        vec![position, truth(), position],
        vec![upto(2), t_chk, truth()],
        vec![
            upto(5),
            upto(3),
            factor_cell,
            upto(3),
            factor_cell,
            t_vel,
            position,
        ],
        vec![upto(p.value("v_max"))],
        vec![upto(3), upto(p.value("t_f"))],
        vec![upto(7), upto(7), upto(7), upto(5), upto(longest)],
        vec![upto(3), t_chk],
    ];
    Ok(Adapter::new(
        &[
            "power_on",
            "reset",
            "terminals.a",
            "terminals.c",
            "terminals.d",
            "terminals.e",
            "selection.sge_sbh_sg",
            "selection.sge_sbh",
            "sg_select",
            "selection.over",
            "se_active",
            "se_select",
            "position",
            "test_select",
            "feedback",
            "discrepancy",
            "rx_fault",
            "rx_internal",
            "rx_external",
            "set_anew",
        ],
        &[
            "stop.level",
            "stop.internal",
            "stop.phase",
            "stop.cancel_pulses",
            "stop.sga_stop_ab",
            "stop.sga_stop_c",
            "stop.sga_stop_d",
            "stop.sga_stop_e",
            "stop.stopsi",
            "selection.mode",
            "selection.monitored",
            "selection.speed_limit",
            "selection.reference",
            "shown.sga_active",
            "shown.sga_sbh_active",
            "shown.sga_sg",
            "standstill.demand",
            "speed.demand",
            "end_stop.demand",
            "ramp.violated",
            "ramp.limit",
            "threshold.below",
            "fault.fault",
            "test.active",
            "test.code",
            "pulses.enable",
            "pulses.enable_external",
        ],
        domains.concat(),
        channel::State::INITIAL,
        move |state, i, o| {
            let inputs = channel::Inputs {
                power_on: i[0] != 0,
                run_up: true,
                reset: i[1] != 0,
                spl_started: true,
                spl_error: false,
                sge_a: i[2] != 0,
                sge_c: !use_c || i[3] != 0,
                sge_d: !use_d || i[4] != 0,
                sge_e: i[5] != 0,
                sge_sbh_sg: i[6] != 0,
                sge_sbh: i[7] != 0,
                sg_select: stage(i[8]),
                over: factor(i[9]),
                se_active: i[10] != 0,
                se_select: i[11] != 0,
                position: Position(i[12]),
                encoder_speed: speed(0),
                parking: false,
                set_anew: i[19] != 0,
                test_select: tested && i[13] != 0,
                feedback: i[14] != 0,
                external_test: false,
                demand: InternalStop::None,
                discrepancy: i[15] != 0,
                rx_fault: peer && i[16] != 0,
                rx_internal: if peer {
                    internal(i[17])
                } else {
                    InternalStop::None
                },
                rx_external: if peer {
                    external_stop(i[18])
                } else {
                    ExternalStop::None
                },
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                rank(out.stop.level),
                rank(out.stop.internal.level()),
                out.stop.phase as i64,
                bit(out.stop.cancel_pulses),
                bit(out.stop.sga_stop_ab),
                bit(out.stop.sga_stop_c),
                bit(out.stop.sga_stop_d),
                bit(out.stop.sga_stop_e),
                i64::from(out.stop.stopsi),
                out.selection.mode as i64,
                out.selection.monitored as i64,
                i64::from(out.selection.limit.0),
                i64::from(out.selection.reference.0),
                bit(out.sbh_sg_active),
                bit(out.sbh_active),
                i64::from(out.sg_active.index()),
                rank(out.standstill.demand.level()),
                rank(out.speed.demand.level()),
                rank(out.limit_switch.demand.level()),
                bit(out.ramp.violated),
                i64::from(out.ramp.limit.0),
                bit(out.threshold.below),
                out.fault.fault as i64,
                bit(out.test.active),
                i64::from(out.test.code.number()),
                bit(out.pulses.enable),
                bit(out.pulses.enable_external),
            ]);
            after
        },
    )
    .only(&["rx_internal"], INTERNAL)
    .only(&["rx_external"], EXTERNAL))
}
