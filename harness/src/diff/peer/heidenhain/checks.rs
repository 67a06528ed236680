//! Status bits, forced dynamic sampling, the kernel's own checks.

use stillpoint_monitors::heidenhain::sampling::Pulse;
use stillpoint_monitors::heidenhain::start_checks::Start;
use stillpoint_monitors::heidenhain::{sampling, self_checks, start_checks, status_bits};
use stillpoint_monitors::mutant::Mutant;

use super::numbers::*;
use crate::diff::peer::adapter::{Adapter, cells};
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "status_bits" => status_bits(mutant),
        "sampling" => sampling(p, mutant)?,
        "self_checks" => self_checks(p, mutant)?,
        "start_checks" => start_checks(p, mutant)?,
        _ => return Ok(None),
    }))
}

cells! {
    sampling::State, 2 {
        pulse = |c| value(&Pulse::ALL, c), |p| ordinal(&Pulse::ALL, p);
        timer = cycles, cell;
    }
    start_checks::State, 1 {
        start = |c| value(&Start::ALL, c), |s| ordinal(&Start::ALL, s);
    }
}

fn status_bits(mutant: Option<Mutant>) -> Adapter {
    let next = chosen::<status_bits::Monitor>(mutant);
    Adapter::stateless(
        &[
            "es_a",
            "es_b",
            "es_a_hw",
            "es_b_hw",
            "mc_wd",
            "stos_mc",
            "cc_wd",
            "smc_wd",
            "spl_wd",
            "smop_wd",
            "pf_ac",
            "pf_dc",
            "pf_board",
            "n0",
            "req_ss2",
            "masked",
            "spl_fault",
            "smop_fault",
        ],
        &[
            "mc",
            "cc",
            "lift_off",
            "mc_retrigger",
            "spl_off",
            "smop_off",
            "spindle_seen",
        ],
        move |i, o| {
            let inputs = status_bits::Inputs {
                es_a: i[0] != 0,
                es_b: i[1] != 0,
                es_a_hw: i[2] != 0,
                es_b_hw: i[3] != 0,
                mc_wd: i[4] != 0,
                stos_mc: i[5] != 0,
                cc_wd: i[6] != 0,
                smc_wd: i[7] != 0,
                spl_wd: i[8] != 0,
                smop_wd: i[9] != 0,
                pf_ac: i[10] != 0,
                pf_dc: i[11] != 0,
                pf_board: i[12] != 0,
                n0: i[13] != 0,
                req_ss2: i[14] != 0,
                masked: i[15] != 0,
                spl_fault: i[16] != 0,
                smop_fault: i[17] != 0,
            };
            let (_, out) = next(status_bits::State::INITIAL, &status_bits::Config, &inputs);
            o.extend([
                stop_rank(out.mc),
                stop_rank(out.cc),
                bit(out.lift_off),
                bit(out.mc_retrigger),
                bit(out.spl_off),
                bit(out.smop_off),
                bit(out.spindle_seen),
            ]);
        },
    )
}

fn sampling(p: &Params, mutant: Option<Mutant>) -> Refusable {
    // The pair of the table is an emergency stop.
    let config = sampling::Config::new(p.time("t_low"), true)?;
    let next = chosen::<sampling::Monitor>(mutant);
    Ok(Adapter::new(
        &["due", "contact_a", "contact_b", "stuck_a", "stuck_b"],
        &["reads_a", "reads_b", "opened", "short", "demand", "pulse"],
        vec![upto(4), upto(p.value("t_low"))],
        sampling::State::INITIAL,
        move |state, i, o| {
            let inputs = sampling::Inputs {
                due: i[0] != 0,
                contact_a: i[1] != 0,
                contact_b: i[2] != 0,
                stuck_a: i[3] != 0,
                stuck_b: i[4] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                bit(out.reads_a),
                bit(out.reads_b),
                bit(out.opened),
                bit(out.short),
                stop_rank(out.demand),
                rank(&Pulse::ALL, after.pulse),
            ]);
            after
        },
    ))
}

fn self_checks(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = self_checks::Config::new(p.is("cc"), p.is("safe"))?;
    let next = chosen::<self_checks::Monitor>(mutant);
    Ok(Adapter::stateless(
        &[
            "amplitude",
            "frequency",
            "temperature",
            "fan",
            "supply",
            "watchdog",
            "software",
            "fatal",
            "checksum",
            "runtime",
            "internal_es",
            "readback",
        ],
        &["asks_ss1f", "asks_ss1", "asks_ss2", "demand"],
        move |i, o| {
            let inputs = self_checks::Inputs {
                amplitude: i[0] != 0,
                frequency: i[1] != 0,
                temperature: i[2] != 0,
                fan: i[3] != 0,
                supply: i[4] != 0,
                watchdog: i[5] != 0,
                software: i[6] != 0,
                fatal: i[7] != 0,
                checksum: i[8] != 0,
                runtime: i[9] != 0,
                internal_es: i[10] != 0,
                readback: i[11] != 0,
            };
            let (_, out) = next(self_checks::State::INITIAL, &config, &inputs);
            o.extend([
                bit(out.asks_ss1f),
                bit(out.asks_ss1),
                bit(out.asks_ss2),
                stop_rank(out.demand),
            ]);
        },
    ))
}

fn start_checks(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = start_checks::Config::new(p.is("cc"))?;
    let next = chosen::<start_checks::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "power_on",
            "booted",
            "mixed",
            "motor_speed",
            "rated_speed",
            "feed_constant",
        ],
        &["demand", "start"],
        vec![upto(2)],
        start_checks::State::INITIAL,
        move |state, i, o| {
            let inputs = start_checks::Inputs {
                power_on: i[0] != 0,
                booted: i[1] != 0,
                mixed: i[2] != 0,
                motor_speed: i[3],
                rated_speed: i[4],
                feed_constant: i[5] != 0,
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([stop_rank(out.demand), rank(&Start::ALL, after.start)]);
            after
        },
    ))
}
